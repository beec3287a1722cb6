//! Feedforward of velocity and feedback of pressures by a controller, in verdicts and models.

use super::{Caveat, FeedForwardObstacle, UncountedEffect, is_measured};
use crate::project::{Load, Project};
use crate::rig::limits_load_motion;
use crate::setup::Setup;

/// Caveat for the feedforward of the load's velocity to the command: it is a feedback if the load
/// can move under force, otherwise a path of the load motion. The loop of a rig includes both.
pub(super) fn feed_forward(project: &Project) -> Option<Caveat> {
    let controller = project.controller.as_ref()?;
    let declared = controller.load_velocity_feed_forward?;
    let measured = is_measured(project);
    if declared.gain == Some(0.0) || (project.actuator.is_some() && !measured) {
        return None;
    }
    let can_yield = yields(project);
    let effect = UncountedEffect::FeedForward {
        measured: project.actuator.is_some(),
        yields: can_yield || project.actuator.is_none(),
    };
    Some(Caveat { effect, unproven: can_yield || limits_load_motion(project) })
}

/// True if the load of an actuator can move under force.
fn yields(project: &Project) -> bool {
    project.actuator.as_ref().is_some_and(|actuator| actuator.load != Load::Prescribed)
}

/// Caveat for a virtual impedance, to which the specifications of its loop refer, or which measured
/// plants lack.
pub(super) fn impedance(setup: &Setup<'_>) -> Option<Caveat> {
    let project = setup.project;
    setup.virtual_impedance?;
    let yields = yields(project);
    Some(match is_measured(project) {
        true => Caveat {
            effect: UncountedEffect::ImpedanceUnmeasured { yields },
            unproven: yields || limits_load_motion(project),
        },
        false => Caveat::noted(UncountedEffect::Impedance { yields }),
    })
}

/// Feedforward of the load velocity, which the models of a linearisation omit because they describe
/// the rig without its controller.
pub(super) fn fed_in_loop(setup: &Setup<'_>) -> Option<UncountedEffect> {
    let controller = setup.project.controller.as_ref()?;
    let declared = controller.load_velocity_feed_forward?;
    let obstacle = match controller.sample_time {
        None if controller.delay > 0.0 => FeedForwardObstacle::ControllerDelay,
        None if setup.velocity_sensor.delay_s > 0.0 => FeedForwardObstacle::SensorDelay,
        None => FeedForwardObstacle::NoController,
        Some(_) => FeedForwardObstacle::Sampling,
    };
    (declared.gain != Some(0.0) && feed_forward(setup.project).is_none())
        .then_some(UncountedEffect::FeedForwardOutsideModels(obstacle))
}

/// Caveat for a pressure feedback, if the plants of the family were measured without it.
pub(super) fn measured_without_pressures(project: &Project) -> Option<Caveat> {
    let declared = project.controller.as_ref()?.pressure_feedback?;
    (declared.gain != 0.0 && is_measured(project))
        .then_some(Caveat { effect: UncountedEffect::PressureFeedbackUnmeasured, unproven: true })
}

/// Pressure feedback, which the models of a linearisation omit because they describe the rig
/// without its controller.
pub(super) fn pressures_in_loop(project: &Project) -> Option<UncountedEffect> {
    let declared = project.controller.as_ref()?.pressure_feedback?;
    (declared.gain != 0.0 && !is_measured(project)).then_some(UncountedEffect::PressureFeedbackOutsideModels)
}
