//! Effects of the signals that a controller feeds forward and back, and of its sampling.

use num_complex::Complex64;
use phea_dynamics::linear::{Discretization, MovedRoot};
use phea_dynamics::portable;

use super::FeedForwardObstacle;
use crate::quantity::{ANGULAR_FREQUENCY, MotionKind, display, significant};

pub(super) const PRESSURE_FEEDBACK_UNMEASURED: &str = "controller.pressure_feedback is not counted, as the plants of the family were measured without it: this is the loop without \
     it, and only a simulation is of the loop with it";

pub(super) const PRESSURE_FEEDBACK_OUTSIDE_MODELS: &str = "these models and the asymptotes of the impedance leave out the pressures that [controller] feeds back: verify, design and simulate \
     include them";

pub(super) fn feed_forward(measured: bool, yields: bool) -> String {
    let why = match measured {
        true => "the plants of the family were measured without it",
        false => "a [plant] declares no load",
    };
    format!(
        "the load velocity that [controller] feeds forward is not counted, as {why}: {}",
        without_load(yields)
    )
}

/// Words for the loop of a verdict that lacks a path of the load.
fn without_load(yields: bool) -> &'static str {
    match yields {
        true => "this is the loop without it, and only a simulation is of the loop with it",
        false => "of all specifications load_motion alone depends on it, and only a simulation has it",
    }
}

pub(super) fn feed_forward_outside_models(obstacle: FeedForwardObstacle) -> String {
    let why = match obstacle {
        FeedForwardObstacle::ControllerDelay => "as controller.delay delays it",
        FeedForwardObstacle::SensorDelay => "velocity_sensor.delay delays it",
        FeedForwardObstacle::NoController => "they have no controller",
        FeedForwardObstacle::Sampling => "the controller samples it",
    };
    format!(
        "these models leave out the load velocity that [controller] feeds forward, since {why}: verify, design and simulate include it"
    )
}

pub(super) fn impedance_unmeasured(yields: bool, motion: MotionKind) -> String {
    format!(
        "controller.impedance is not counted, as the plants of the family were measured without the {} of the load: {}",
        motion.words().position,
        without_load(yields)
    )
}

pub(super) fn impedance(yields: bool, motion: MotionKind) -> String {
    let force = motion.words().force;
    let output = motion.either("y = F_e + Z_v (x_L - x_0)", "y = T_e + Z_v (θ_L - θ_0)");
    match yields {
        true => format!(
            "controller.impedance is counted, and the load can move under {force}: loop and specifications are of {output}, \
             which the loop makes follow the reference; load_motion limits by how much y misses it, and only a simulation shows the {force} \
             itself"
        ),
        false => format!(
            "controller.impedance is counted: load_motion limits {output} per motion, by which the {force} misses the impedance \
             that is asked for; all other specifications are those of the {force}"
        ),
    }
}

/// A zero or pole that the sampling moves, and the discretisation that retains it.
pub(super) fn moved_root(table: &str, moved: &MovedRoot, discretization: Discretization) -> String {
    let frequency = |root: Complex64| display(portable::magnitude(root), &ANGULAR_FREQUENCY, 4);
    let (name, remedy) = match discretization {
        Discretization::Tustin => {
            let exact = format!(
                "discretization_frequency = \"{}\" keeps it there, and discretization = \"matched\" keeps all",
                frequency(moved.root)
            );
            ("tustin", exact)
        }
        Discretization::PrewarpedTustin { .. } => (
            "tustin",
            "discretization_frequency keeps one frequency alone, and discretization = \"matched\" keeps all"
                .to_string(),
        ),
        Discretization::ZeroOrderHold => {
            ("zero_order_hold", "discretization = \"matched\" keeps it there".to_string())
        }
        Discretization::Matched => ("matched", "a shorter sample_time keeps it there".to_string()),
    };
    format!(
        "{table}: discretization = \"{name}\" moves the {} at {} with a damping ratio of {} to {}, by {} %: {remedy}",
        if moved.is_zero { "zero" } else { "pole" },
        frequency(moved.root),
        significant(-moved.root.re / portable::magnitude(moved.root), 2),
        frequency(moved.image),
        significant(100.0 * moved.shift(), 2)
    )
}
