//! Differences between the steps of the nonlinear rig and those of the linear loop in the trial of
//! a design: the search for the next one adds them to every step that it judges.
//!
//! ```text
//! added(t) = step of the nonlinear rig - step of the linear loop
//! next loop L':   y(t) = linear step + added(t) through (1 + L)/(1 + L')
//! ```
//!
//! Friction and hysteresis disturb similar loops about equally, and each loop suppresses its
//! disturbances by 1/(1 + L), so that a few trials suffice.

use std::sync::Arc;

use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Family, UncertainFamily};

use super::ProjectDesign;
use crate::linear_step::StepResponse;
use crate::plant_names::{NamedPlant, NamedValue};
use crate::trial::TrialRun;

/// Differences of the steps of one plant, nonlinear minus linear.
#[derive(Clone, Debug)]
pub(super) struct AddedByRig {
    /// Parameters of the plant.
    values: Vec<f64>,
    /// Difference in each run, as a fraction of its step.
    pub(super) steps: Vec<StepResponse>,
    /// Loop of the trial.
    pub(super) around: Arc<Compensation>,
}

/// Largest number of runs of a plant whose differences are added.
const MOST_RUNS: usize = 2;

/// Differences in the trial of a design, for each plant those of the runs that are furthest from
/// the requirement, with those of other plants from earlier trials.
pub(super) fn added(project_design: &ProjectDesign, before: &[AddedByRig]) -> Vec<AddedByRig> {
    let Family::Uncertain(family) = &project_design.designed.problem.family else { return vec![] };
    let around = Arc::new(project_design.designed.problem.compensation.clone());
    let mut all: Vec<AddedByRig> = Vec::new();
    let runs = project_design.trial.iter().flat_map(|trial| trial.runs.iter().chain(&trial.corners));
    let mut runs: Vec<&TrialRun> = runs.collect();
    runs.sort_by(|one, other| other.excess_with_room().total_cmp(&one.excess_with_room()));
    for run in runs {
        let (Some(values), Some(step)) = (values(family, run), difference(run)) else { continue };
        match all.iter_mut().find(|known| known.values == values) {
            // a plant may be simulated both as the worst of the family and as a corner
            Some(known) if known.steps.len() >= MOST_RUNS || known.steps.contains(&step) => {}
            Some(known) => known.steps.push(step),
            None => all.push(AddedByRig { values, steps: vec![step], around: around.clone() }),
        }
    }
    let others: Vec<AddedByRig> =
        before.iter().filter(|one| !all.iter().any(|new| new.values == one.values)).cloned().collect();
    all.extend(others);
    all
}

/// Differences to be expected of a plant: those of the nearest one that was simulated.
pub(super) fn added_to<'a>(
    family: &UncertainFamily,
    all: &'a [AddedByRig],
    values: &[f64],
) -> Option<&'a AddedByRig> {
    let own = family.fractions(values);
    let distance = |one: &AddedByRig| {
        let other = family.fractions(&one.values);
        own.iter().zip(other).map(|(own, other)| (own - other) * (own - other)).sum::<f64>()
    };
    all.iter().min_by(|one, other| distance(one).total_cmp(&distance(other)))
}

impl StepResponse {
    /// Values at these times, linear between the given ones and zero outside of them.
    pub(super) fn at_times(&self, times_s: &[f64]) -> Vec<f64> {
        times_s.iter().map(|time_s| self.at(*time_s)).collect()
    }

    /// Time at which the response first reaches a level, linear between its values, so that the
    /// time moves with them; `None` if it does not.
    pub(super) fn first_at(&self, level: f64) -> Option<f64> {
        let StepResponse { times_s, values } = self;
        let next = values.iter().position(|value| *value >= level)?;
        let point = |index: usize| times_s.get(index).copied().zip(values.get(index).copied());
        let (to_s, high) = point(next)?;
        match next.checked_sub(1).and_then(point) {
            Some((from_s, low)) => Some(from_s + (to_s - from_s) * (level - low) / (high - low)),
            None => Some(to_s),
        }
    }

    fn at(&self, time_s: f64) -> f64 {
        let next = self.times_s.partition_point(|known| *known < time_s);
        let point = |index: usize| self.times_s.get(index).copied().zip(self.values.get(index).copied());
        match (next.checked_sub(1).and_then(point), point(next)) {
            (Some((from_s, low)), Some((to_s, high))) => {
                low + (high - low) * (time_s - from_s) / (to_s - from_s)
            }
            (None, Some((first_s, value))) if first_s <= time_s => value,
            _ => 0.0,
        }
    }
}

/// Parameters of the simulated plant; `None` for one that is not in the family.
fn values(family: &UncertainFamily, run: &TrialRun) -> Option<Vec<f64>> {
    if run.quarter_wave_rad_per_s.is_some() {
        return None;
    }
    let Some(NamedPlant(numbers)) = &run.plant else { return Some(family.plant().nominal()) };
    let number = |(_, value): &(String, NamedValue)| match value {
        NamedValue::Number(value, _) => Some(*value),
        NamedValue::Measurement(_) | NamedValue::Added => None,
    };
    numbers.iter().map(number).collect()
}

/// Nonlinear step minus the linear one, at the times of the first, up to the end of the second.
fn difference(run: &TrialRun) -> Option<StepResponse> {
    if run.requirements.is_empty() || run.linear_response.values.is_empty() {
        return None;
    }
    let StepResponse { times_s, values } = &run.machine_response;
    let linear = &run.linear_response;
    let both = times_s.iter().zip(values).take_while(|(time_s, _)| Some(*time_s) <= linear.times_s.last());
    let (times_s, values) = both.map(|(time_s, value)| (*time_s, value - linear.at(*time_s))).unzip();
    Some(StepResponse { times_s, values })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ORIGIN: analytic, a straight line through 0 at 0 s and 0.4 at 2 s reaches 0.1 at 0.5 s.
    #[test]
    fn a_level_is_reached_between_two_values() {
        let step = StepResponse { times_s: vec![0.0, 2.0, 4.0], values: vec![0.0, 0.4, 0.2] };
        assert_eq!(
            [0.0, 0.1, 0.4, 0.5].map(|level| step.first_at(level)),
            [Some(0.0), Some(0.5), Some(2.0), None]
        );
    }

    /// ORIGIN: analytic, straight lines: 0.1 to 0.3 over 2 s, halfway, and zero beyond.
    #[test]
    fn what_is_added_lies_straight_between_its_times() {
        let added = StepResponse { times_s: vec![1.0, 3.0], values: vec![0.1, 0.3] };
        assert_eq!(added.at_times(&[0.0, 2.0, 5.0]), [0.0, 0.2, 0.0]);
    }
}
