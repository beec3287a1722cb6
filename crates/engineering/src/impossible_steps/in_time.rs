//! Requirements in time that are shorter than a delay.

use phea_hydraulics::line::{Conduit, StiffeningMember};

use super::ImpossibleStep;
use crate::audit::LoopDeadTime;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::TimeRequirement;

/// Delays before the force moves, s: the dead time between reference and force, and on the rig the
/// travel time of a wave through the shorter line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillTimes {
    /// Delay of the controller, s.
    pub controller_delay: f64,
    /// Dead time of the controller's transfer function, s.
    pub controller_dead_time: f64,
    /// Dead time of the plant, s.
    pub plant_dead_time: f64,
    /// Travel time of a wave through the shorter line, s.
    pub wave: f64,
}

impl StillTimes {
    fn of(setup: &Setup<'_>, problem: &RobustProblem) -> StillTimes {
        let dead_time = LoopDeadTime::of(problem);
        StillTimes {
            controller_delay: problem.compensation.delay_s(),
            controller_dead_time: dead_time.controller_s,
            plant_dead_time: dead_time.plant_s[1],
            wave: wave_s(setup).unwrap_or(0.0),
        }
    }

    /// Sum of the delays, s.
    pub fn total(&self) -> f64 {
        [self.controller_delay, self.controller_dead_time, self.plant_dead_time, self.wave].iter().sum()
    }
}

/// Sum of the delays before the force moves, s.
pub(super) fn still_s(setup: &Setup<'_>, problem: &RobustProblem) -> f64 {
    StillTimes::of(setup, problem).total()
}

/// Requirements to settle before the force has moved.
pub(super) fn findings(setup: &Setup<'_>, problem: &RobustProblem) -> Vec<ImpossibleStep> {
    let still = StillTimes::of(setup, problem);
    let of = |requirement: &TimeRequirement| {
        let settling = requirement.step_limits.settling_time_s.filter(|time_s| *time_s <= still.total())?;
        let key = if requirement.limits.is_some() { "lower.settling_time" } else { "settling_time" };
        Some(ImpossibleStep::BeforeForceMoves { number: requirement.number, key, settling, still })
    };
    problem.in_time.iter().filter_map(of).collect()
}

/// Travel time of a wave through the shorter line, s; `None` without lines, and if the plant's dead
/// time includes it already.
fn wave_s(setup: &Setup<'_>) -> Option<f64> {
    let rig = setup.rig().ok()?;
    let components = rig.actuator.components();
    let delay = |line| {
        Conduit::of_line(line, &components.fluid, rig.actuator.mean_pressure(), StiffeningMember::Nominal)
    };
    let delays = [&components.line_a, &components.line_b].into_iter().map(|line| delay(line).ok());
    let delays: Option<Vec<f64>> = delays.map(|conduit| conduit.map(|one| one.delay())).collect();
    delays?.into_iter().reduce(f64::min)
}
