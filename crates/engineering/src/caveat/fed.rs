//! What a controller feeds forward and back beside the force, in verdicts and models.

use super::{Caveat, is_measured};
use crate::project::{Load, Project};
use crate::rig::limits_load_motion;
use crate::setup::Setup;

/// The load's velocity on the command: a feedback if the load can move under force, otherwise a
/// path of the load motion. The loop of a rig includes both.
pub(super) fn feed_forward(project: &Project) -> Option<Caveat> {
    let controller = project.controller.as_ref()?;
    let declared = controller.load_velocity_feed_forward?;
    let actuator = project.actuator.as_ref();
    let yields = actuator.is_some_and(|actuator| actuator.load != Load::Prescribed);
    let why = match actuator {
        None => "a [plant] declares no load",
        Some(_) if is_measured(project) => "the plants of the family were measured without it",
        Some(_) => return None,
    };
    let what = match yields || actuator.is_none() {
        true => "this is the loop without it, and only a simulation is of the loop with it",
        false => "of all specifications load_motion alone depends on it, and only a simulation has it",
    };
    (declared.gain != Some(0.0)).then(|| Caveat {
        sentence: format!(
            "the load velocity that [controller] feeds forward is not counted, as {why}: {what}"
        ),
        unproven: yields || limits_load_motion(project),
    })
}

/// A virtual impedance: what the specifications of its loop refer to, or that measured plants lack
/// it.
pub(super) fn impedance(setup: &Setup<'_>) -> Option<Caveat> {
    let project = setup.project;
    setup.virtual_impedance?;
    let yields = project.actuator.as_ref().is_some_and(|actuator| actuator.load != Load::Prescribed);
    if is_measured(project) {
        let what = match yields {
            true => "this is the loop without it, and only a simulation is of the loop with it",
            false => "of all specifications load_motion alone depends on it, and only a simulation has it",
        };
        let sentence = format!(
            "controller.impedance is not counted, as the plants of the family were measured without the position of the load: {what}"
        );
        return Some(Caveat { sentence, unproven: yields || limits_load_motion(project) });
    }
    let sentence = match yields {
        true => {
            "controller.impedance is counted, and the load can move under force: loop and specifications are of y = F_e + Z_v (x_L - x_0), \
             which the loop makes follow the reference; load_motion limits by how much y misses it, and only a simulation shows the force \
             itself"
        }
        false => {
            "controller.impedance is counted: load_motion limits y = F_e + Z_v (x_L - x_0) per motion, by which the force misses the impedance \
             that is asked for; all other specifications are those of the force"
        }
    };
    Some(Caveat { sentence: sentence.to_string(), unproven: false })
}

/// The feed-forward of the load velocity, which the models of a linearisation do not include
/// because they describe the rig without its controller.
pub(super) fn fed_in_loop(setup: &Setup<'_>) -> Option<String> {
    let controller = setup.project.controller.as_ref()?;
    let declared = controller.load_velocity_feed_forward?;
    let why = match controller.sample_time {
        None if controller.delay > 0.0 => "as controller.delay delays it",
        None if setup.velocity_sensor.delay_s > 0.0 => "velocity_sensor.delay delays it",
        None => "they have no controller",
        Some(_) => "the controller samples it",
    };
    (declared.gain != Some(0.0) && feed_forward(setup.project).is_none()).then(|| {
        format!(
            "these models leave out the load velocity that [controller] feeds forward, since {why}: verify, design and simulate include it"
        )
    })
}

/// Pressures that are fed back, where the plants of the family were measured without that.
pub(super) fn measured_without_pressures(project: &Project) -> Option<Caveat> {
    let declared = project.controller.as_ref()?.pressure_feedback?;
    (declared.gain != 0.0 && is_measured(project)).then(|| Caveat {
        sentence: "controller.pressure_feedback is not counted, as the plants of the family were measured without it: this is the loop without \
                   it, and only a simulation is of the loop with it"
            .to_string(),
        unproven: true,
    })
}

/// Pressures that are fed back, which the models of a linearisation do not include because they
/// describe the rig without its controller.
pub(super) fn pressures_in_loop(project: &Project) -> Option<String> {
    let declared = project.controller.as_ref()?.pressure_feedback?;
    (declared.gain != 0.0 && !is_measured(project)).then(|| {
        "these models and the asymptotes of the impedance leave out the pressures that [controller] feeds back: verify, design and simulate \
         include them"
            .to_string()
    })
}
