//! Fraction of the runs of a campaign that satisfy the requirements in time.

use super::plan::Plan;
use super::row::{Ran, Row};
use crate::estimate::NORMAL_95;
use crate::simulate::{Metric, NotJudged, ReachedStep, RunStatus, StepLimits, TimeRequirement, concerned};

/// A requirement in time, and the number of runs that satisfy it.
#[derive(Clone, Debug, PartialEq)]
pub struct CampaignRequirement {
    /// Number of its specification in the file, from 1.
    pub number: usize,
    /// Requirement for every step of the reference.
    pub step_limits: StepLimits,
    /// Number of runs that satisfy it, or the reason why it is not known.
    pub judged: Result<SatisfiedRuns, NotJudged>,
}

/// Number of runs that satisfy a requirement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SatisfiedRuns {
    /// Number of runs all of whose steps satisfy it.
    pub satisfied: usize,
    /// Number of simulated runs; one that was not completed does not satisfy it.
    pub runs: usize,
    /// Run that is furthest from the requirement, and the result of its worst step: by the property
    /// that is furthest, and for equal ones by the next property.
    pub worst: Option<(u64, ReachedStep)>,
}

impl SatisfiedRuns {
    /// Bounds of the probability p that a drawn run satisfies the requirement, with 95 percent
    /// confidence, by Wilson's interval: the p with
    ///
    /// ```text
    /// |k/n - p| <= z sqrt(p (1 - p)/n),     z = 1.96
    /// ```
    ///
    /// from 0 to 1; the whole range without a run.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::campaign::SatisfiedRuns;
    /// let runs = SatisfiedRuns { satisfied: 300, runs: 300, worst: None };
    /// let [low, high] = runs.confidence_95();
    /// assert!((low - 1.0/(1.0 + 1.96_f64.powi(2)/300.0)).abs() < 1e-5 && high == 1.0);
    /// ```
    pub fn confidence_95(&self) -> [f64; 2] {
        if self.runs == 0 {
            return [0.0, 1.0];
        }
        let (count, part) = (self.runs as f64, self.satisfied as f64 / self.runs as f64);
        let square = NORMAL_95 * NORMAL_95 / count;
        let middle = (part + 0.5 * square) / (1.0 + square);
        let half = (square * (part * (1.0 - part) + 0.25 * square)).sqrt() / (1.0 + square);
        [
            if self.satisfied == 0 { 0.0 } else { middle - half },
            if self.satisfied == self.runs { 1.0 } else { middle + half },
        ]
    }
}

/// Every requirement that is part of the verdict, over the simulated runs.
pub(super) fn required(plan: &Plan, rows: &[Row]) -> Vec<CampaignRequirement> {
    let of = |one: &TimeRequirement| CampaignRequirement {
        number: one.number,
        step_limits: one.step_limits,
        judged: judged(plan, rows, one),
    };
    plan.requirements.iter().filter(|one| one.follows).map(of).collect()
}

fn judged(plan: &Plan, rows: &[Row], one: &TimeRequirement) -> Result<SatisfiedRuns, NotJudged> {
    let concerned = concerned(one, plan.windows(), plan.scenario.settling_band_percent)?;
    let mut found = SatisfiedRuns { satisfied: 0, runs: 0, worst: None };
    let mut most = [f64::NEG_INFINITY; 3];
    for (run, ran) in rows.iter().filter_map(|row| Some((row.run, row.ran()?))) {
        let reached = reached(ran, &concerned);
        let excesses = one.step_limits.excesses(&reached);
        found.runs += 1;
        found.satisfied += usize::from(one.step_limits.is_satisfied(&reached));
        if excesses > most {
            most = excesses;
            found.worst = Some((run, reached));
        }
    }
    Ok(found)
}

/// Worst of the steps of a run, each property separately; infinite if the run was not completed.
fn reached(ran: &Ran, windows: &[usize]) -> ReachedStep {
    let most = |metric: Metric| {
        let values = windows.iter().map(|window| {
            let number = ran.metrics.get(*window).and_then(|numbers| numbers[metric]);
            number.filter(|_| ran.status == RunStatus::Completed).unwrap_or(f64::INFINITY)
        });
        values.fold(0.0, f64::max)
    };
    ReachedStep {
        overshoot_percent: most(Metric::Overshoot),
        settling_time_s: most(Metric::SettlingTime),
        rise_time_s: most(Metric::RiseTime),
    }
}
