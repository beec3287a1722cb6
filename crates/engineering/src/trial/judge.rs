//! Judgement of a simulated machine: comparison of its steps with those that the linear loop
//! predicts, and with the promise of a met verdict.

use std::f64::consts::PI;

use phea_dynamics::portable::exp;
use phea_qft::specification::ClosedLoop;
use phea_qft::verification::Verdict;

use super::reason::{OvershootNote, TrialFinding, UnsettledEnd};
use super::run::{Agreement, BAND_PERCENT, Leg, StepSize, TrialStep};
use super::steps::Steps;
use crate::audit::ProjectAudit;
use crate::robust::RobustProblem;
use crate::simulate::{RunStatus, ScenarioRun, SimulateError, TimeRequirement};

/// Motion of a force that counts as settled, as a fraction of the step.
const STILL: f64 = 0.01;
/// Motion of a force that has come to rest, as a fraction of the step.
const AT_REST: f64 = 1e-3;
/// Fraction by which a settling time may differ from the prediction and still agree: a response
/// that leaves the band by less than the other one stays within it.
pub const SETTLING_ROOM: f64 = 0.25;
/// Ratio of settling times beyond which the behaviour counts as different.
pub const SETTLING_RATIO: f64 = 2.0;
/// Permitted difference of overshoots, percent of the step: friction has an effect of this size on
/// a small step.
pub const OVERSHOOT_ROOM_PERCENT: f64 = 5.0;

/// A run of a machine, its steps, and the known results of the linear loop.
pub(super) struct Driven<'a> {
    pub(super) run: &'a ScenarioRun,
    pub(super) steps: &'a Steps,
    pub(super) size: StepSize,
    /// Each planned leg, with the properties of its step.
    pub(super) legs: &'a [(Leg, TrialStep)],
    /// Prediction of the linear loop.
    pub(super) linear: Option<TrialStep>,
    /// True if the linear loop is unstable.
    pub(super) grows: bool,
}

impl Driven<'_> {
    /// Greatest overshoot and longest settling time; the latter absent if a step does not settle.
    pub(super) fn whole(&self) -> TrialStep {
        let overshoots = self.legs.iter().filter_map(|(_, step)| step.overshoot_percent);
        let settled: Option<Vec<f64>> = self.legs.iter().map(|(_, step)| step.settling_time_s).collect();
        TrialStep {
            overshoot_percent: overshoots.reduce(f64::max),
            settling_time_s: settled.and_then(|times_s| times_s.into_iter().reduce(f64::max)),
        }
    }

    /// Leg with the greatest overshoot, among those that do not settle if there are any; the first
    /// of equals.
    pub(super) fn worst(&self) -> Leg {
        let any = self.legs.iter().any(|(_, step)| step.settling_time_s.is_none());
        self.first_most(|leg| match leg.settling_time_s {
            Some(_) if any => f64::NEG_INFINITY,
            _ => leg.overshoot_percent.unwrap_or(0.0),
        })
    }

    fn first_most(&self, of: impl Fn(&TrialStep) -> f64) -> Leg {
        let values: Vec<(Leg, f64)> = self.legs.iter().map(|(leg, step)| (*leg, of(step))).collect();
        let most = values.iter().map(|(_, value)| *value).fold(f64::NEG_INFINITY, f64::max);
        values.iter().find(|(_, value)| *value >= most).map_or(Leg::There, |(leg, _)| *leg)
    }

    /// Range of the force at the end of the step after which it moves most, N.
    pub(super) fn remains(&self) -> Option<[f64; 2]> {
        let ranges = self.steps.driven().filter_map(|leg| self.steps.remains(self.run, leg));
        ranges.reduce(|widest, range| if width(range) > width(widest) { range } else { widest })
    }
}

/// Judgement of a machine without an equilibrium under its controller, or without equations.
pub(super) fn not_started(error: &SimulateError, view: &ProjectAudit) -> (Agreement, TrialFinding) {
    let agreement =
        if view.audit.verdict == Verdict::Met { Agreement::Contradicts } else { Agreement::Differs };
    (agreement, TrialFinding::NotStarted(error.clone()))
}

/// Agreement, and its reason.
pub(super) fn judge(
    driven: &Driven<'_>,
    problem: &RobustProblem,
    view: &ProjectAudit,
) -> (Agreement, TrialFinding) {
    let promised = view.audit.verdict != Verdict::Violated;
    let broken = if promised { Agreement::Contradicts } else { Agreement::Differs };
    if let Some(stopped) = driven.run.stopped() {
        if driven.grows && driven.run.divergence.is_some() {
            return (Agreement::Agrees, TrialFinding::NeitherSettles { overshoots: None });
        }
        let finding = match stopped.status {
            RunStatus::Diverged => TrialFinding::Diverges(stopped.time_s),
            status => TrialFinding::StoppedEarly { time: stopped.time_s, status },
        };
        return (broken, finding);
    }
    let (whole, linear) = (driven.whole(), driven.linear);
    if whole.settling_time_s.is_none() {
        let settles = !driven.grows && linear.is_none_or(|step| step.settling_time_s.is_some());
        return if settles { (broken, unsettled(driven)) } else { neither_settles(driven) };
    }
    let overshoot = whole.overshoot_percent.unwrap_or(0.0);
    let predicted = linear.and_then(|step| step.overshoot_percent);
    let leg = driven.first_most(|leg| leg.overshoot_percent.unwrap_or(0.0));
    let overshoots = |note| TrialFinding::Overshoots { percent: overshoot, leg, linear: predicted, note };
    let more = overshoot - predicted.unwrap_or(overshoot);
    let most = most_overshoot_percent(problem).filter(|_| driven.size != StepSize::Largest);
    // a prefilter may increase the overshoot beyond the limit, in the linear loop too
    let satisfies = |most: f64| predicted.is_none_or(|predicted| predicted <= most);
    if more > OVERSHOOT_ROOM_PERCENT && most.is_some_and(|most| overshoot > most && satisfies(most)) {
        return (broken, overshoots(OvershootNote::BeyondLimit));
    }
    if let Some(range) = driven.remains().filter(|range| width(*range) > STILL * driven.steps.size()) {
        return (Agreement::Differs, overshoots(OvershootNote::Swings(range)));
    }
    if more.abs() > OVERSHOOT_ROOM_PERCENT {
        return (Agreement::Differs, overshoots(OvershootNote::Nothing));
    }
    let settling = settling_agreement(whole.settling_time_s, linear.and_then(|step| step.settling_time_s));
    if let Some((Agreement::Differs, finding)) = settling {
        return (Agreement::Differs, finding);
    }
    if let Some(missed) = missed_in_time(&whole, driven, problem) {
        return (Agreement::Differs, missed);
    }
    if driven.run.run_status() == RunStatus::Undetermined {
        return (Agreement::Differs, overshoots(OvershootNote::Undetermined));
    }
    match met(driven.run).first() {
        Some(kind) => (Agreement::Differs, overshoots(OvershootNote::Meets(kind))),
        None => settling.unwrap_or((Agreement::Agrees, overshoots(OvershootNote::Nothing))),
    }
}

/// Agreement of two settling times, s, that differ by more than [`SETTLING_ROOM`]; `None` for
/// others, and if one of them is not known.
fn settling_agreement(own_s: Option<f64>, predicted_s: Option<f64>) -> Option<(Agreement, TrialFinding)> {
    let (own_s, predicted_s) = own_s.zip(predicted_s)?;
    let is_within = |factor: f64| (predicted_s / factor..=predicted_s * factor).contains(&own_s);
    if is_within(1.0 + SETTLING_ROOM) {
        return None;
    }
    let agreement =
        if is_within(SETTLING_RATIO) { Agreement::AgreesButForSettling } else { Agreement::Differs };
    Some((agreement, TrialFinding::Settles { machine: own_s, linear: predicted_s, required: None }))
}

/// Agreement of two loops that do not settle within the run: both grow, or the overshoot of a slow
/// one is compared, up to the end of the run.
fn neither_settles(driven: &Driven<'_>) -> (Agreement, TrialFinding) {
    let own = driven.whole().overshoot_percent.unwrap_or(0.0);
    let predicted = driven.linear.and_then(|step| step.overshoot_percent);
    match predicted.filter(|predicted| !driven.grows && (own - predicted).abs() > OVERSHOOT_ROOM_PERCENT) {
        Some(predicted) => {
            let overshoots = Some([own, predicted]);
            (Agreement::Differs, TrialFinding::NeitherSettles { overshoots })
        }
        None => (Agreement::Agrees, TrialFinding::NeitherSettles { overshoots: None }),
    }
}

/// Settling time that is required of these steps, if the linear loop satisfies it and the machine
/// does not.
fn missed_in_time(machine: &TrialStep, driven: &Driven<'_>, problem: &RobustProblem) -> Option<TrialFinding> {
    let linear = driven.linear;
    let of_verdict = |required: &&TimeRequirement| {
        let holds = !required.steps.are_stated() || driven.size == StepSize::Required;
        required.follows && holds && required.step_limits.band_percent.total_cmp(&BAND_PERCENT).is_eq()
    };
    let most = problem.in_time.iter().find(of_verdict)?.step_limits.settling_time_s?;
    let own = machine.settling_time_s.filter(|time_s| *time_s > most)?;
    let predicted = linear?.settling_time_s.filter(|time_s| *time_s <= most)?;
    Some(TrialFinding::Settles { machine: own, linear: predicted, required: Some(most) })
}

/// Largest ratio of the range of a force at rest to its distance from the reference.
const SWING: f64 = 0.5;

fn unsettled(driven: &Driven<'_>) -> TrialFinding {
    let leg = driven.worst();
    let reference = driven.steps.reference(leg);
    let distance = |[low, high]: [f64; 2]| (0.5 * (low + high) - reference).abs();
    // a swing smaller than the distance from the reference is noise around a force at rest
    let is_still =
        |range: &[f64; 2]| width(*range) <= (AT_REST * driven.steps.size()).max(SWING * distance(*range));
    if let Some([low, high]) = driven.steps.remains(driven.run, leg).filter(is_still) {
        let off_percent = 100.0 * distance([low, high]) / driven.steps.size();
        let end = UnsettledEnd::AtRest { force: 0.5 * (low + high), off_percent };
        return TrialFinding::Unsettled { leg, end: Some(end) };
    }
    TrialFinding::Unsettled { leg, end: driven.remains().map(UnsettledEnd::Swings) }
}

/// Limits and end stops that the machine reached, in order.
pub(super) fn met(driven: &ScenarioRun) -> Vec<&'static str> {
    driven.occurrences.iter().filter(|one| one.begins).map(|one| one.kind).collect()
}

fn width([low, high]: [f64; 2]) -> f64 {
    high - low
}

/// Overshoot of a second-order system whose resonance reaches the least limit on |L/(1+L)|,
/// percent; `None` without such a limit.
///
/// ```text
/// M = 1/(2 zeta sqrt(1 - zeta^2)),     overshoot = exp(-pi zeta/sqrt(1 - zeta^2))
/// ```
fn most_overshoot_percent(problem: &RobustProblem) -> Option<f64> {
    let limits = problem.specifications.iter().filter_map(|one| match one.requirement.closed_loop() {
        ClosedLoop::RobustStability => one.requirement.limits().1.magnitude(0.0),
        _ => None,
    });
    let peak =
        limits.fold(None, |least: Option<f64>, limit| Some(least.map_or(limit, |least| least.min(limit))))?;
    if peak <= 1.0 {
        return Some(0.0);
    }
    let cosine_of_twice = (1.0 - 1.0 / (peak * peak)).sqrt();
    let damping_squared = 0.5 * (1.0 - cosine_of_twice);
    let ratio = (damping_squared / (1.0 - damping_squared)).sqrt();
    Some(100.0 * exp(-PI * ratio))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter more or less agrees; up to a factor of two, all but the settling time agrees.
    // ORIGIN: analytic, predicted 100 ms
    #[test]
    fn a_settling_time_agrees_within_a_quarter() {
        let of = |own_s: f64| settling_agreement(Some(own_s), Some(0.1)).map(|(agreement, _)| agreement);
        assert_eq!([0.081, 0.1, 0.124].map(of), [None; 3]);
        assert_eq!([0.079, 0.126, 0.051, 0.199].map(of), [Some(Agreement::AgreesButForSettling); 4]);
        assert_eq!([0.049, 0.201].map(of), [Some(Agreement::Differs); 2]);
        assert_eq!([settling_agreement(None, Some(0.1)), settling_agreement(Some(0.1), None)], [None, None]);
    }
}
