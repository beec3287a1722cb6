//! The steps of the scenarios, and the command that they need for one plant.
//!
//! ```text
//! u(t) = u_0 + sum of (r_k - r_(k-1)) w(t - t_k),    u_0 of a plant = u_0 of the nominal one * h/h_nominal,    h = w(inf)
//! ```
//!
//! The command of a plant that holds 1 N is h = F(0)/P(0), with an integrator in the loop: leakage
//! and supply change it in proportion to the command that holds the first reference.

use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};

use crate::design::ProjectDesign;
use crate::design::deployable::limit_value;
use crate::limit_kind::DesignLimitKind;
use crate::linear_step::StepResponse;
use crate::rig::Rig;
use crate::setup::Setup;
use crate::simulate::{ReferenceStep, SteppedReference, stepped_references};

/// Duration of a step in required settling times, if one is required.
const SETTLING_TIMES: f64 = 10.0;
/// Relative difference of two commands that counts as rounding.
const SAME: f64 = 1e-9;

/// Steps of the scenarios, and the limit of their commands.
#[derive(Clone, Debug)]
pub(in crate::design) struct ScenarioSteps {
    scenarios: Vec<CommandedSteps>,
    /// Largest permitted command, V.
    pub(in crate::design) limit_v: f64,
    /// Simulated duration of a step, s.
    pub(in crate::design) duration_s: f64,
}

/// Steps of one scenario, and the command at its beginning.
#[derive(Clone, Debug)]
pub(super) struct CommandedSteps {
    pub(super) reference: SteppedReference,
    /// Commands that hold the declared rig at the references, from the initial one on, V.
    held_v: Vec<f64>,
    /// Command that holds 1 N at the nominal plant, V/N; absent if every plant begins as the
    /// nominal one does.
    nominal_v_per_n: Option<f64>,
}

/// Largest command of a scenario, for one plant.
#[derive(Clone, Copy, Debug)]
pub(super) struct CommandPeak {
    /// Magnitude, V.
    pub(super) value_v: f64,
    /// Time in the scenario, s.
    pub(super) at_s: f64,
    /// Step after which the peak occurs.
    pub(super) step: ReferenceStep,
}

/// Command that holds a rig at a reference, N, at rest, V; that of its operating point if the rig
/// does not reach the reference.
fn resting_command(rig: &Rig, reference_n: f64) -> f64 {
    let held = Condition::Load(SteadyLoad::Force(reference_n));
    let point = operating_point(&rig.actuator, rig.point.position, held);
    point.map_or(rig.point.command, |point| point.command)
}

impl ScenarioSteps {
    /// Steps of a project; `None` if nothing limits their command.
    pub(in crate::design) fn of(setup: &Setup<'_>, project_design: &ProjectDesign) -> Option<ScenarioSteps> {
        let fraction = limit_value(&project_design.limits, DesignLimitKind::CommandOfSteps)?;
        let rig = setup.rig().ok()?;
        let commanded = |reference: SteppedReference| {
            let begins_n = reference.steps.first()?.from_n;
            let levels = std::iter::once(begins_n).chain(reference.steps.iter().map(|step| step.to_n));
            let held_v = levels.map(|level_n| resting_command(rig, level_n)).collect();
            Some(CommandedSteps { reference, held_v, nominal_v_per_n: None })
        };
        let scenarios: Vec<CommandedSteps> =
            stepped_references(setup.project).into_iter().filter_map(commanded).collect();
        let lasts_s = |one: &CommandedSteps| {
            one.reference.steps.first().map_or(0.0, |first| one.reference.end_s - first.at_s)
        };
        let longest_s = scenarios.iter().map(lasts_s).fold(0.0, f64::max);
        let required = project_design
            .designed
            .problem
            .in_time
            .iter()
            .map(|one| SETTLING_TIMES * one.step_limits.horizon_s);
        Some(ScenarioSteps {
            scenarios,
            limit_v: fraction * rig.actuator.components().valve.nominal_voltage,
            duration_s: required.reduce(f64::max).unwrap_or(f64::INFINITY).min(longest_s),
        })
    }

    /// The steps if each plant begins with its own command, in proportion to the command of the
    /// nominal plant that holds 1 N.
    pub(super) fn beginning_at_each_plant(&mut self, nominal_v_per_n: f64) {
        for one in &mut self.scenarios {
            one.nominal_v_per_n = Some(nominal_v_per_n).filter(|nominal| *nominal != 0.0);
        }
    }

    /// True if no scenario has a step.
    pub(super) fn is_empty(&self) -> bool {
        self.scenarios.is_empty()
    }

    /// Largest magnitude of the command in any scenario, V, from the command in a unit step, whose
    /// final value holds 1 N.
    pub(in crate::design) fn largest_v(&self, unit: &StepResponse) -> f64 {
        self.largest_held_v(unit, last(unit))
    }

    /// Largest such magnitude for a plant that needs this command to hold 1 N, V.
    pub(super) fn largest_held_v(&self, unit: &StepResponse, held_v_per_n: f64) -> f64 {
        self.peaks(unit, held_v_per_n).map(|(_, peak)| peak.value_v).fold(0.0, f64::max)
    }

    /// The largest command of each scenario.
    pub(super) fn peaks(
        &self,
        unit: &StepResponse,
        held_v_per_n: f64,
    ) -> impl Iterator<Item = (&CommandedSteps, CommandPeak)> {
        self.scenarios.iter().filter_map(move |one| Some((one, one.peak(unit, held_v_per_n)?)))
    }

    /// Largest magnitude of the command at rest, at the beginning of any scenario and between its
    /// steps, V.
    pub(super) fn at_rest_v(&self, held_v_per_n: f64) -> f64 {
        let of = |one: &CommandedSteps| {
            let largest = one.held_v.iter().map(|held| held.abs()).fold(0.0, f64::max);
            largest * one.ratio(held_v_per_n)
        };
        self.scenarios.iter().map(of).fold(0.0, f64::max)
    }
}

impl CommandedSteps {
    /// Largest command: after every step, the sum of the contributions of all steps so far.
    fn peak(&self, unit: &StepResponse, held_v_per_n: f64) -> Option<CommandPeak> {
        let SteppedReference { steps, end_s, .. } = &self.reference;
        let initial_v = self.begins_v(held_v_per_n);
        let first = *steps.first()?;
        let mut peak = CommandPeak { value_v: initial_v.abs(), at_s: first.at_s, step: first };
        for (index, step) in steps.iter().enumerate() {
            let ends_s = steps.get(index + 1).map_or(*end_s, |next| next.at_s) - step.at_s;
            let points = unit.times_s.iter().copied().zip(unit.values.iter().copied());
            let within = points.take_while(|(time_s, _)| *time_s < ends_s);
            for (time_s, value) in within.chain([(ends_s, value_at(unit, ends_s))]) {
                let earlier = steps.iter().take(index);
                let earlier = earlier.map(|one| one.size_n() * value_at(unit, step.at_s - one.at_s + time_s));
                let command_v = initial_v + earlier.sum::<f64>() + step.size_n() * value;
                // the end of one step is the beginning of the next
                if command_v.abs() > (1.0 + SAME) * peak.value_v {
                    let at_s = step.at_s + time_s;
                    peak = CommandPeak { value_v: command_v.abs(), at_s, step: *step };
                }
            }
        }
        Some(peak)
    }

    /// Command at rest before this step, for a plant that needs this command to hold 1 N, V.
    pub(super) fn resting_v(&self, before: &ReferenceStep, held_v_per_n: f64) -> f64 {
        let index = self.reference.steps.iter().position(|step| step == before).unwrap_or(0);
        self.held_v.get(index).copied().unwrap_or(0.0) * self.ratio(held_v_per_n)
    }

    /// Command at the beginning of the scenario, for such a plant, V.
    fn begins_v(&self, held_v_per_n: f64) -> f64 {
        self.held_v.first().copied().unwrap_or(0.0) * self.ratio(held_v_per_n)
    }

    /// Ratio of the command that holds a force at a plant to that of the declared rig.
    fn ratio(&self, held_v_per_n: f64) -> f64 {
        let ratio = self.nominal_v_per_n.map(|nominal| held_v_per_n / nominal);
        ratio.filter(|ratio| ratio.is_finite() && *ratio > 0.0).unwrap_or(1.0)
    }
}

/// Value of a response at a time, s: linear between its points, and constant after the last.
fn value_at(response: &StepResponse, time_s: f64) -> f64 {
    let StepResponse { times_s, values } = response;
    let after = times_s.partition_point(|known_s| *known_s <= time_s);
    let point = |index: usize| Some((*times_s.get(index)?, *values.get(index)?));
    match (after.checked_sub(1).and_then(point), point(after)) {
        (Some((from_s, from)), Some((to_s, to))) => from + (to - from) * (time_s - from_s) / (to_s - from_s),
        (Some((_, last)), None) => last,
        (None, _) => 0.0,
    }
}

/// Final value of a response.
fn last(response: &StepResponse) -> f64 {
    response.values.last().copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable::exp;

    use super::*;

    const TIME_CONSTANT_S: f64 = 0.2;
    const APART_S: f64 = 0.1;
    const BEGINS_V: f64 = 0.5;

    /// Unit step 1 + e^(-t/T): initially twice the value at rest.
    fn unit() -> StepResponse {
        let times_s: Vec<f64> = (0..=10_000).map(|index| f64::from(index) * 1e-3).collect();
        let values = times_s.iter().map(|time_s| 1.0 + exp(-time_s / TIME_CONSTANT_S)).collect();
        StepResponse { times_s, values }
    }

    fn steps(references_n: &[f64]) -> CommandedSteps {
        let step = |(index, pair): (usize, &[f64])| ReferenceStep {
            at_s: 1.0 + index as f64 * APART_S,
            from_n: pair[0],
            to_n: pair[1],
        };
        let steps = references_n.windows(2).enumerate().map(step).collect();
        let reference = SteppedReference { scenario: "steps".to_string(), steps, end_s: 9.0 };
        let held_v = references_n.iter().map(|level_n| BEGINS_V + level_n - references_n[0]).collect();
        CommandedSteps { reference, held_v, nominal_v_per_n: None }
    }

    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }

    /// The second of two steps begins from what the first one has left, in either direction.
    // ORIGIN: analytic
    #[test]
    fn the_command_of_a_scenario_is_the_sum_of_its_steps() {
        let left = exp(-APART_S / TIME_CONSTANT_S);
        let up = steps(&[10.0, 11.0, 12.0]).peak(&unit(), 1.0).unwrap();
        assert_near(up.value_v, BEGINS_V + (1.0 + left) + 2.0);
        assert_near(up.at_s, 1.0 + APART_S);
        assert_eq!((up.step.from_n, up.step.to_n), (11.0, 12.0));
        let back = steps(&[10.0, 11.0, 8.0]).peak(&unit(), 1.0).unwrap();
        assert_near(back.value_v, -(BEGINS_V + (1.0 + left) - 6.0));
        // the larger of them would take 6 V from rest without the other
        assert_near(steps(&[11.0, 8.0]).peak(&unit(), 1.0).unwrap().value_v, 6.0 - BEGINS_V);
        // the value at the end of the first step belongs to that step
        let rising = StepResponse { values: vec![0.0, 1.0], times_s: vec![0.0, APART_S] };
        let there = steps(&[10.0, 14.0, 10.0]).peak(&rising, 1.0).unwrap();
        assert_eq!((there.step.from_n, there.step.to_n), (10.0, 14.0));
        assert_near(there.value_v, BEGINS_V + 4.0);
    }

    /// The largest command is that at rest if no command exceeds its final value.
    #[test]
    fn the_command_at_rest_is_that_of_the_farthest_reference() {
        let monotone = StepResponse { values: vec![0.0, 0.5, 1.0], times_s: vec![0.0, 1.0, 2.0] };
        let one = steps(&[10.0, 13.0, 9.0]);
        let [_, down] = one.reference.steps[..] else { panic!() };
        assert_near(one.resting_v(&down, 1.0), BEGINS_V + 3.0);
        let of = ScenarioSteps { scenarios: vec![one], limit_v: 10.0, duration_s: 2.0 };
        assert_near(of.at_rest_v(1.0), BEGINS_V + 3.0);
        assert!(of.largest_v(&monotone) < of.at_rest_v(1.0));
    }

    /// A plant that needs 1.5 times as much to hold a force needs it at the beginning too.
    // ORIGIN: analytic
    #[test]
    fn a_plant_begins_with_its_own_command() {
        let other = StepResponse { values: vec![0.0, 1.5], times_s: vec![0.0, 1.0] };
        let mut of = ScenarioSteps { scenarios: vec![steps(&[10.0, 13.0])], limit_v: 10.0, duration_s: 2.0 };
        of.beginning_at_each_plant(1.0);
        assert_near(of.at_rest_v(1.0), BEGINS_V + 3.0);
        assert_near(of.at_rest_v(1.5), 1.5 * (BEGINS_V + 3.0));
        assert_near(of.largest_v(&other), 1.5 * (BEGINS_V + 3.0));
    }

    #[test]
    fn a_response_is_linear_between_its_points_and_stays_as_it_ends() {
        let response = StepResponse { values: vec![1.0, 3.0], times_s: vec![0.0, 2.0] };
        assert_eq!(
            [-1.0, 0.0, 0.5, 2.0, 7.0].map(|time_s| value_at(&response, time_s)),
            [0.0, 1.0, 1.5, 3.0, 3.0]
        );
    }
}
