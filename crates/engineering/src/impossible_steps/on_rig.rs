//! Required steps that the rig does not reach: beyond the stall force of the piston, beyond the
//! capacity of the force sensor, or beyond the effect of the valve's full voltage within the
//! required time.
//!
//! ```text
//! |u(t)| <= U   gives   |y(t)| <= U integral of |h| over 0 ... t = U V(t)
//! settled within the band b at t_s:   (1 - b) A <= y(t_s) <= U V(t_s - delay)
//! ```
//!
//! h is the impulse response of the plant and V the total variation of its step response; A is the
//! size of the step.

use phea_dynamics::time_response::{step_response, uniform_times};
use phea_dynamics::uncertain_plant::UncertainPlant;
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::verification::PlantPoint;

use super::ImpossibleStep;
use super::in_time::still_s;
use crate::plant_names::NamedPlant;
use crate::robust::{NoPolynomials, RobustProblem};
use crate::setup::Setup;
use crate::simulate::{ReferenceStep, TimeRequirement, stepped_references, steps_beyond};

/// Number of points of a step response.
const POINTS: usize = 1000;
/// Relative addition to the variation of a response that is known at points.
const BETWEEN_POINTS: f64 = 0.02;
/// Largest ratio of flows for which a larger valve is advised: beyond it, time is missing instead.
const LARGER_VALVE: f64 = 3.0;
/// Ratio by which a plant with waves in its lines may reach more than with lumped lines.
const WAVES: f64 = 2.0;

/// Steps of a project that its rig does not reach, for these plants of its family; without those
/// that are required before the force can move at all.
pub(super) fn findings(setup: &Setup<'_>, problem: &RobustProblem, few: &Family) -> Vec<ImpossibleStep> {
    let beyond = steps_beyond(setup, &problem.in_time).into_iter().map(ImpossibleStep::BeyondReach);
    let slow = problem.in_time.iter().filter_map(|required| too_slow(setup, problem, required, few));
    beyond.chain(slow.map(ImpossibleStep::TooSlow)).collect()
}

/// A step that the valve's full voltage does not bring into its band in time.
#[derive(Clone, Debug, PartialEq)]
pub struct SlowStep {
    /// Number of the specification, from 1.
    pub number: usize,
    /// Greatest voltage at the valve, V.
    pub voltage: f64,
    /// Slowest plant.
    pub plant: NamedPlant,
    /// True if the plant has lumped lines but the rig does not.
    pub lumped: bool,
    /// Largest change of the force of the plant, N.
    pub reached: f64,
    /// Size of the step, N.
    pub size: f64,
    /// True if a scenario makes the step.
    pub of_scenario: bool,
    /// Required settling time, s.
    pub settling: f64,
    /// Ratio of the required flow of a valve to that of this valve.
    pub flow_ratio: f64,
}

impl SlowStep {
    /// True if a larger valve could make up for the missing time.
    pub fn is_matter_of_valve(&self) -> bool {
        self.flow_ratio <= LARGER_VALVE
    }
}

/// A required step.
struct SizedStep {
    from_n: f64,
    size_n: f64,
    /// True if a scenario makes it, and the requirement applies to every step.
    of_scenario: bool,
}

/// Step of a requirement, or those of the scenarios if it is part of the verdict and applies to
/// every step.
fn sized_steps(setup: &Setup<'_>, required: &TimeRequirement) -> Option<Vec<SizedStep>> {
    let from_n = required.steps.initial_force_n.unwrap_or(setup.rig().ok()?.point.hydraulic_force);
    if let Some(amplitude_n) = required.steps.amplitude_n {
        return Some(vec![SizedStep { from_n, size_n: amplitude_n.abs(), of_scenario: false }]);
    }
    let is_of_every_step = required.follows && !required.steps.are_stated();
    let scenarios = stepped_references(setup.project).into_iter().filter(|_| is_of_every_step);
    let steps = scenarios.flat_map(|stepped| stepped.steps);
    let of = |step: ReferenceStep| SizedStep {
        from_n: step.from_n,
        size_n: (step.to_n - step.from_n).abs(),
        of_scenario: true,
    };
    Some(steps.map(of).collect())
}

/// A step that the valve's full voltage does not bring into its band in time, for the plant that
/// reaches least of it.
fn too_slow(
    setup: &Setup<'_>,
    problem: &RobustProblem,
    required: &TimeRequirement,
    few: &Family,
) -> Option<SlowStep> {
    let Family::Uncertain(few) = few else { return None };
    let settling_s = required.step_limits.settling_time_s?;
    if settling_s <= still_s(setup, problem) {
        return None;
    }
    let rig = setup.rig().ok()?;
    let stated = setup.project.controller.as_ref().and_then(|controller| controller.saturation);
    let limit_v = stated.unwrap_or(rig.actuator.components().valve.nominal_voltage);
    let time_s = settling_s - setup.timing.delay_s;
    let fraction = 1.0 - required.step_limits.band_percent / 100.0;
    let each = sized_steps(setup, required)?.into_iter().filter_map(|step| {
        let (reached_n, values) = least_reached(few, (time_s, step.from_n), limit_v)?;
        Some((fraction * step.size_n / reached_n, step, reached_n, values))
    });
    let (ratio, step, reached_n, values) = each.max_by(|one, other| one.0.total_cmp(&other.0))?;
    let plant = problem.names.named(&PlantPoint::Parameters(values.clone()));
    let lumped = problem.without_polynomials == Some(NoPolynomials::LinesInMotion);
    let most = if lumped { WAVES } else { 1.0 };
    (ratio > most).then_some(SlowStep {
        number: required.number,
        voltage: limit_v,
        plant,
        lumped,
        reached: reached_n,
        size: step.size_n,
        of_scenario: step.of_scenario,
        settling: settling_s,
        flow_ratio: ratio,
    })
}

/// Result of [`reached`] for the plant that reaches least, and its parameters.
fn least_reached(few: &UncertainFamily, during: (f64, f64), limit_v: f64) -> Option<(f64, &Vec<f64>)> {
    let each = few
        .members()
        .iter()
        .filter_map(|values| Some((reached(few.plant(), values, during, limit_v)?, values)));
    each.min_by(|one, other| one.0.total_cmp(&other.0))
}

/// Largest change of the plant with these parameters within a time, s, from an equilibrium at a
/// force, N, by commands of at most this voltage, V; `None` if it is not known. The command that
/// holds the force may be removed too.
fn reached(
    plant: &UncertainPlant,
    values: &[f64],
    (time_s, from_n): (f64, f64),
    limit_v: f64,
) -> Option<f64> {
    let slow = plant.member(values)?.slow();
    let command = slow.command.transfer_function().ok()?;
    let moving_s = time_s - slow.dead_time_s;
    let values = step_response(&command, &uniform_times(moving_s, POINTS).ok()?).ok()?;
    let steps = values.iter().zip(values.iter().skip(1)).map(|(one, next)| (next - one).abs());
    let variation = (1.0 + BETWEEN_POINTS) * (values.first()?.abs() + steps.sum::<f64>());
    let at_rest = command.dc_gain();
    let held_v = if at_rest.is_finite() && at_rest != 0.0 { (from_n / at_rest).abs() } else { 0.0 };
    Some((limit_v + held_v) * variation)
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable;
    use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};

    use super::{BETWEEN_POINTS, reached};

    fn plant(numerator: f64, denominator: &'static [f64], dead_time_s: f64) -> UncertainPlant {
        let recorded = UncertainPlant::record(vec![], |_| PlantCoefficients {
            command: RationalCoefficients {
                numerator: vec![numerator.into()],
                denominator: denominator.iter().map(|one| (*one).into()).collect(),
            },
            disturbance: None,
            dead_time_s: dead_time_s.into(),
            rate: None,
        });
        recorded.unwrap()
    }

    #[track_caller]
    fn assert_reached(plant: &UncertainPlant, (time_s, from_n): (f64, f64), limit_v: f64, expected: f64) {
        let found = reached(plant, &[], (time_s, from_n), limit_v).unwrap() / (1.0 + BETWEEN_POINTS);
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }

    /// An integrator of gain 3 reaches 3 U t, after its dead time; a lag of 2 V to 5 N and 0.1 s
    /// reaches 5 U (1 - e^(-t/0.1)), and may release its holding command; a resonance without
    /// damping is excited every half period, so that 10 periods of 2 pi/w reach 40 U/w^2.
    // ORIGIN: analytic
    #[test]
    fn the_most_that_a_bounded_command_does() {
        assert_reached(&plant(3.0, &[1.0, 0.0], 0.1), (0.6, 8.0), 2.0, 3.0);
        let lag = 1.0 - portable::exp(-2.0);
        assert_reached(&plant(5.0, &[0.1, 1.0], 0.0), (0.2, 0.0), 2.0, 10.0 * lag);
        assert_reached(&plant(5.0, &[0.1, 1.0], 0.0), (0.2, 10.0), 2.0, 20.0 * lag);
        let periods = 10.0 * std::f64::consts::TAU / 50.0;
        assert_reached(&plant(1.0, &[1.0, 0.0, 2500.0], 0.0), (periods, 0.0), 1.0, 40.0 / 2500.0);
    }
}
