//! Requirements in time, compared with the steps of one simulated machine.

use phea_dynamics::time_response::{StepBaseline, step_metrics};

use super::run::{BAND_PERCENT, Leg};
use super::steps::Steps;
use crate::simulate::{ReachedStep, RequiredSteps, ScenarioRun, StepLimits, TimeRequirement};

/// A requirement in time, and the worst result of the steps of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldRequirement {
    /// Number of its specification in the file, from 1.
    pub number: usize,
    /// Requirement.
    pub step_limits: StepLimits,
    /// Worst result of all steps, each property separately; infinite if the run ended earlier.
    pub reached: ReachedStep,
    /// Worst result in nine tenths of the band.
    pub reached_with_room: ReachedStep,
    /// True if every step satisfies the requirement.
    pub is_satisfied: bool,
}

/// Fraction of the band at which a design aims on the rig: plants between the simulated ones swing
/// back a little further.
pub(crate) const BAND_WITH_ROOM: f64 = 0.9;

/// Every requirement that is part of the verdict and applies to these steps.
pub(super) fn held(
    requirements: &[TimeRequirement],
    steps: &Steps,
    (required, run): (RequiredSteps, &ScenarioRun),
) -> Vec<HeldRequirement> {
    let concerned = requirements.iter().filter(|one| one.follows && holds_for(one, required));
    let of = |one: &TimeRequirement| {
        let of_limits = |step_limits: &StepLimits| {
            worst(steps.driven().map(|leg| reached(step_limits, steps, run, leg)).collect())
        };
        let reached = of_limits(&one.step_limits);
        let narrower = BAND_WITH_ROOM * one.step_limits.band_percent;
        HeldRequirement {
            number: one.number,
            step_limits: one.step_limits,
            reached,
            reached_with_room: of_limits(&StepLimits { band_percent: narrower, ..one.step_limits }),
            is_satisfied: one.step_limits.is_satisfied(&reached),
        }
    };
    concerned.map(of).collect()
}

/// True if the requirement applies to these steps: one with stated steps applies only to those.
fn holds_for(requirement: &TimeRequirement, steps: RequiredSteps) -> bool {
    !requirement.steps.are_stated() || requirement.steps == steps
}

/// Properties of one step, in the band of the requirement.
fn reached(step_limits: &StepLimits, steps: &Steps, run: &ScenarioRun, leg: Leg) -> ReachedStep {
    let never = ReachedStep {
        overshoot_percent: f64::INFINITY,
        settling_time_s: f64::INFINITY,
        rise_time_s: f64::INFINITY,
    };
    if run.stopped().is_some() {
        return never;
    }
    // from the solution itself, not from its rows
    let known = steps.step(run, leg);
    let response = steps.response(run, leg);
    let baseline = StepBaseline::to_value(1.0);
    let Ok(rows) = step_metrics(&response.times_s, &response.values, baseline, step_limits.band_percent)
    else {
        return never;
    };
    let settles = match step_limits.band_percent.total_cmp(&BAND_PERCENT).is_eq() {
        true => known.settling_time_s,
        false => rows.settling.time_s().filter(|time_s| steps.settles_early(*time_s)),
    };
    ReachedStep {
        overshoot_percent: known.overshoot_percent.unwrap_or(rows.overshoot_percent),
        settling_time_s: settles.unwrap_or(f64::INFINITY),
        rise_time_s: rows.rise_time_10_90_s.unwrap_or(f64::INFINITY),
    }
}

fn worst(legs: Vec<ReachedStep>) -> ReachedStep {
    let most = |of: fn(&ReachedStep) -> f64| legs.iter().map(of).fold(0.0, f64::max);
    ReachedStep {
        overshoot_percent: most(|one| one.overshoot_percent),
        settling_time_s: most(|one| one.settling_time_s),
        rise_time_s: most(|one| one.rise_time_s),
    }
}
