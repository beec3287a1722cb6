//! Requirements in time, compared with the steps of the reference in a scenario.

use super::step_limits::{ReachedStep, StepLimits};
use super::{Cause, Metrics, RunStatus, ScenarioRun, TimeRequirement, Window, time_requirements};
use crate::project::Project;

/// A requirement in time, and the result of the steps of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioRequirement {
    /// Number of its specification in the file, from 1.
    pub number: usize,
    /// Requirement for every step of the reference.
    pub step_limits: StepLimits,
    /// Worst result of all steps, each property separately; infinite if the run did not complete.
    /// Or the reason why the scenario does not judge the requirement.
    pub reached: Result<ReachedStep, NotJudged>,
}

/// Reason why a run does not judge a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotJudged {
    /// The scenario has no step of the reference, or none of the required size.
    NoStep,
    /// The scenario measures settling in another band.
    OtherBand,
}

/// Relative deviation of a step of the scenario from the required size that counts as zero.
const SAME: f64 = 1e-6;

impl ScenarioRequirement {
    /// True if every step satisfies the requirement; `None` if the scenario does not judge it.
    pub fn is_satisfied(&self) -> Option<bool> {
        self.reached.ok().map(|reached| self.step_limits.is_satisfied(&reached))
    }
}

/// Every requirement of a project that is part of the verdict, compared with a run of one of its
/// scenarios; empty if a stated command drives the valve, or if the specifications are rejected.
pub fn required_of_run(project: &Project, run: &ScenarioRun) -> Vec<ScenarioRequirement> {
    if run.open_loop {
        return vec![];
    }
    let windows: Vec<Window> = run.windows.iter().map(|(window, _)| *window).collect();
    let all = time_requirements(project).unwrap_or_default();
    let of = |one: &TimeRequirement| ScenarioRequirement {
        number: one.number,
        step_limits: one.step_limits,
        reached: concerned(one, &windows, run.settling_band_percent).map(|steps| reached(run, &steps)),
    };
    all.iter().filter(|one| one.follows).map(of).collect()
}

/// Indices of the windows that begin with a step to which a requirement applies.
///
/// # Errors
/// [`NotJudged`] if there is none, or its settling is not comparable.
pub(crate) fn concerned(
    one: &TimeRequirement,
    windows: &[Window],
    band_percent: f64,
) -> Result<Vec<usize>, NotJudged> {
    let concerned: Vec<usize> = (0..windows.len()).filter(|&place| concerns(one, &windows[place])).collect();
    if concerned.is_empty() {
        return Err(NotJudged::NoStep);
    }
    let same_band = band_percent.total_cmp(&one.step_limits.band_percent).is_eq();
    if one.step_limits.settling_time_s.is_some() && !same_band {
        return Err(NotJudged::OtherBand);
    }
    Ok(concerned)
}

/// True if a window is a step to which the requirement applies.
pub fn concerns(one: &TimeRequirement, window: &Window) -> bool {
    let Cause::ReferenceStep { from_n, to_n } = window.cause else { return false };
    let is = |stated: Option<f64>, value: f64| {
        stated.is_none_or(|stated| (stated - value).abs() <= SAME * (stated.abs() + to_n.abs()))
    };
    is(one.steps.amplitude_n, to_n - from_n) && is(one.steps.initial_force_n, from_n)
}

/// Worst result of these steps of a run.
fn reached(run: &ScenarioRun, steps: &[usize]) -> ReachedStep {
    let is_complete = run.run_status() == RunStatus::Completed;
    let most = |of: fn(&Metrics) -> super::Measured| {
        let values = steps.iter().map(|&place| {
            let value = run.windows.get(place).and_then(|(_, metrics)| of(metrics).ok());
            value.filter(|_| is_complete).unwrap_or(f64::INFINITY)
        });
        values.fold(0.0, f64::max)
    };
    ReachedStep {
        overshoot_percent: most(|metrics| metrics.overshoot_percent),
        settling_time_s: most(|metrics| metrics.settling_time_s),
        rise_time_s: most(|metrics| metrics.rise_time_s),
    }
}
