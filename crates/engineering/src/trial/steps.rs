//! Steps of the reference through which a machine is simulated: a step, the step back, and the step
//! again.
//!
//! ```text
//! project, Steps -> stepped project -> ScenarioRun -> metrics and response of each leg
//! ```

use phea_dynamics::time_response::{StepBaseline, step_metrics};
use phea_hydraulics::signal::Signal;

use super::run::{BAND_PERCENT, Leg, TrialStep};
use crate::linear_step::StepResponse;
use crate::project::{InputSignal, Project, Scenario};
use crate::rig::Rig;
use crate::simulate::{RequiredSteps, ScenarioRun, stays_settled};

/// Ratio of the first step to the force that the supply can produce.
const STEP_FRACTION: f64 = 0.1;
/// Fraction of that force within which the reference stays.
pub const REACH: f64 = 0.8;
/// Time before the first step, s.
const BEFORE_S: f64 = 0.05;
/// Number of rows of a scenario for each step.
const ROWS: f64 = 2000.0;
/// Fraction of a step, at its end, over which the remaining oscillation is measured.
const LATE_FRACTION: f64 = 0.2;
/// Range of a force that counts as constant, as a fraction of the step.
const CONSTANT: f64 = 1e-3;
/// Fraction of the estimated largest step that is simulated first: the machine is not linear.
const ESTIMATE_FRACTION: f64 = 0.95;

/// Steps between two references.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steps {
    /// Reference before the first step, N.
    pub(super) from_n: f64,
    /// Reference after the first step, N.
    pub(super) to_n: f64,
    pub(super) legs: HeldLegs,
}

/// Duration of each step, and the last step that is simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeldLegs {
    /// Duration of each step, s.
    pub(super) hold_s: f64,
    pub(super) last: Leg,
}

impl Steps {
    /// The stated steps, or else steps by a tenth of the force that the supply can produce, from
    /// the force of the operating point in the direction with more room.
    pub(super) fn first(rig: &Rig, required: RequiredSteps, legs: HeldLegs) -> Steps {
        let push = push(rig);
        let from_n = required.initial_force_n.unwrap_or(rig.point.hydraulic_force);
        let step = STEP_FRACTION * push;
        let towards = if from_n + step <= REACH * push { step } else { -step };
        Steps { from_n, to_n: from_n + required.amplitude_n.unwrap_or(towards), legs }
    }

    /// Steps of equal size in the opposite direction; `None` if they are beyond the reach of the
    /// supply.
    pub(super) fn reversed(&self, rig: &Rig) -> Option<Steps> {
        let other = self.scaled(-1.0);
        (other.to_n.abs() <= REACH * push(rig)).then_some(other)
    }

    /// True if the steps are between these two references, in either order.
    pub(super) fn are_between(&self, one_n: f64, other_n: f64) -> bool {
        [[one_n, other_n], [other_n, one_n]].contains(&[self.from_n, self.to_n])
    }

    /// Steps in the same direction, as large as is permitted by the supply, the force sensor, and
    /// the margin between command and limit in a run of these steps.
    pub(super) fn enlarged(&self, rig: &Rig, limits: CommandLimits, driven: &ScenarioRun) -> Steps {
        let towards = (self.to_n - self.from_n).signum();
        let reach = (REACH * push(rig)).min(limits.force_n);
        let most = reach - towards * self.from_n;
        let estimated =
            ESTIMATE_FRACTION * room(&driven.record.signal(Signal::Control), limits.command_v) * self.size();
        Steps { to_n: self.from_n + towards * most.min(estimated), ..*self }
    }

    /// Steps multiplied by a factor.
    pub(super) fn scaled(&self, factor: f64) -> Steps {
        Steps { to_n: self.from_n + factor * (self.to_n - self.from_n), ..*self }
    }

    /// Steps that are simulated.
    pub(super) fn driven(&self) -> impl Iterator<Item = Leg> + use<> {
        Leg::up_to(self.legs.last)
    }

    /// Magnitude of a step, N.
    pub(super) fn size(&self) -> f64 {
        (self.to_n - self.from_n).abs()
    }

    /// The project with one scenario: in equilibrium under the first reference, then the steps up
    /// to `last`.
    pub(super) fn project(&self, project: &Project, last: Leg) -> Project {
        let at = |at, value| InputSignal::Step { at, value, published: None };
        let steps = Leg::up_to(last).map(|leg| at(self.begins_s(leg), self.ends(leg)[1]));
        let scenario = Scenario {
            name: "step".to_string(),
            duration: self.begins_s(last) + self.legs.hold_s,
            output_step: self.legs.hold_s / ROWS,
            reference: std::iter::once(at(0.0, self.from_n)).chain(steps).collect(),
            settling_band_percent: BAND_PERCENT,
            ..Scenario::default()
        };
        Project { scenarios: vec![scenario], ..project.clone() }
    }

    fn begins_s(&self, leg: Leg) -> f64 {
        BEFORE_S + leg as usize as f64 * self.legs.hold_s
    }

    /// The reference after a step, N.
    pub(super) fn reference(&self, leg: Leg) -> f64 {
        self.ends(leg)[1]
    }

    /// The reference before and after a step, N.
    fn ends(&self, leg: Leg) -> [f64; 2] {
        match leg {
            Leg::There | Leg::Again => [self.from_n, self.to_n],
            Leg::Back => [self.to_n, self.from_n],
        }
    }

    /// Properties of the response of the controlled quantity: the force, or with a virtual
    /// impedance and a load that yields the force together with the contribution of the impedance
    /// from the motion. A force that is still outside the band in the last tenth of the step is not
    /// settled.
    pub(super) fn step(&self, driven: &ScenarioRun, leg: Leg) -> TrialStep {
        let step = self.measured(driven, leg);
        TrialStep {
            settling_time_s: step.settling_time_s.filter(|time_s| self.settles_early(*time_s)),
            ..step
        }
    }

    /// True if the force was observed for long enough after it settled.
    pub(super) fn settles_early(&self, settling_time_s: f64) -> bool {
        stays_settled(settling_time_s, self.legs.hold_s)
    }

    fn measured(&self, driven: &ScenarioRun, leg: Leg) -> TrialStep {
        if driven.record.signal(Signal::VirtualForce).iter().any(|force| *force != 0.0) {
            let StepResponse { times_s, values } = self.response(driven, leg);
            let metrics = step_metrics(&times_s, &values, StepBaseline::to_value(1.0), BAND_PERCENT).ok();
            return TrialStep {
                overshoot_percent: metrics.as_ref().map(|metrics| metrics.overshoot_percent),
                settling_time_s: metrics.and_then(|metrics| metrics.settling.time_s()),
            };
        }
        let metrics = driven.windows.get(leg as usize).map(|(_, metrics)| metrics);
        TrialStep {
            overshoot_percent: metrics.and_then(|metrics| metrics.overshoot_percent.ok()),
            settling_time_s: metrics.and_then(|metrics| metrics.settling_time_s.ok()),
        }
    }

    /// Controlled force during a step, as a fraction of the step.
    pub(super) fn response(&self, driven: &ScenarioRun, leg: Leg) -> StepResponse {
        let [from, to] = self.ends(leg);
        let (begins_s, held) = (self.begins_s(leg), controlled(driven));
        let rows = driven.record.times_s.iter().zip(held);
        let during = rows
            .filter(|(time_s, _)| (begins_s..begins_s + self.legs.hold_s).contains(*time_s))
            .map(|(time_s, force)| (time_s - begins_s, (force - from) / (to - from)));
        let (times_s, values) = during.unzip();
        StepResponse { times_s, values }
    }

    /// True if the force is constant but away from its reference: the supply cannot produce it
    /// there.
    pub(super) fn stalls(&self, driven: &ScenarioRun) -> bool {
        let unsettled = |leg: &Leg| self.step(driven, *leg).settling_time_s.is_none();
        let stands = |leg: Leg| {
            let range = self.remains(driven, leg);
            range.is_some_and(|[low, high]| high - low < CONSTANT * self.size())
        };
        self.driven().filter(unsettled).any(stands)
    }

    /// Range of the controlled force at the end of a step, N; `None` if the run ended earlier.
    pub(super) fn remains(&self, driven: &ScenarioRun, leg: Leg) -> Option<[f64; 2]> {
        let [from, to] = self.ends(leg);
        let StepResponse { times_s, values } = self.response(driven, leg);
        let late_s = (1.0 - LATE_FRACTION) * self.legs.hold_s;
        let late = times_s.iter().zip(values).filter(|(time_s, _)| **time_s >= late_s);
        let widest = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        let forces = late.map(|(_, value)| from + value * (to - from));
        let range = forces.fold([f64::INFINITY, f64::NEG_INFINITY], widest);
        (driven.stopped().is_none() && range[0] <= range[1]).then_some(range)
    }
}

/// Limits of a step: command, V, and force, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CommandLimits {
    command_v: f64,
    force_n: f64,
}

impl CommandLimits {
    /// Limit of the controller, or else of the valve, and capacity of the force sensor.
    pub(super) fn of(project: &Project, rig: &Rig) -> CommandLimits {
        let stated = project.controller.as_ref().and_then(|controller| controller.saturation);
        let capacity = project.actuator.as_ref().and_then(|actuator| actuator.force_sensor.capacity);
        let nominal_v = rig.actuator.components().valve.nominal_voltage;
        CommandLimits { command_v: stated.unwrap_or(nominal_v), force_n: capacity.unwrap_or(f64::INFINITY) }
    }
}

/// Force that the supply can produce, N.
fn push(rig: &Rig) -> f64 {
    let components = rig.actuator.components();
    let [area_a, area_b] = components.cylinder.areas_at(rig.point.position);
    0.5 * (area_a + area_b) * (components.supply.pressure - components.supply.tank_pressure)
}

/// Factor by which a linear loop's command may grow about its first value before it meets the
/// limit, V: at least zero.
fn room(commands_v: &[f64], limit_v: f64) -> f64 {
    let rest_v = commands_v.first().copied().unwrap_or(0.0);
    let factors = commands_v.iter().filter(|command| **command != rest_v).map(|command| {
        let moved = command - rest_v;
        (limit_v - moved.signum() * rest_v) / moved.abs()
    });
    factors.fold(f64::INFINITY, f64::min).max(0.0)
}

/// Controlled force, N.
fn controlled(driven: &ScenarioRun) -> Vec<f64> {
    let record = &driven.record;
    let forces = record.signal(Signal::Force);
    if !record.parts.impedance {
        return forces;
    }
    let virtual_forces = record.signal(Signal::VirtualForce);
    forces.into_iter().zip(virtual_forces).map(|(force, virtual_force)| force + virtual_force).collect()
}
