//! One machine driven through a step of its reference, and judged by what the linear loop predicts.

use std::f64::consts::PI;

use phea_dynamics::portable::exp;
use phea_dynamics::time_response::{StepBaseline, step_metrics};
use phea_qft::specification::ClosedLoop;
use phea_qft::verification::Verdict;

use super::TrialError;
use super::prediction::{Prediction, predicted};
use super::rigs::Tried;
use crate::audit::ProjectAudit;
use crate::plant_names::NamedPlant;
use crate::project::{LineMotion, Project, Scenario, Signal};
use crate::quantity::significant;
use crate::quantity::{DisplayUnit, FORCE};
use crate::rig::Rig;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::{ScenarioRun, SimulateError, simulate_project};
use crate::source::Source;
use phea_dynamics::watch::Watch;

/// How well a machine agrees with its linear loop, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Agreement {
    /// It behaves as the linear loop predicts.
    Agrees,
    /// It settles, but not as predicted, or meets a limit on the way.
    Differs,
    /// It does not behave as a met verdict promises.
    Contradicts,
}

/// Properties of a step response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialStep {
    /// Percent of the step.
    pub overshoot_percent: Option<f64>,
    /// s; `None` where it does not settle within the run.
    pub settling_time_s: Option<f64>,
}

/// A step response from the step on: share of the step over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepResponse {
    /// s.
    pub times_s: Vec<f64>,
    /// 0 before, 1 at the new reference.
    pub values: Vec<f64>,
}

/// One machine, one step.
#[derive(Clone, Debug, PartialEq)]
pub struct TrialRun {
    /// Which machine.
    pub what: String,
    /// The plant of the audit from which it was made, if any.
    pub plant: Option<NamedPlant>,
    /// Its status: `completed`, or the word of what ended it.
    pub status: &'static str,
    /// The reference, from and to, N.
    pub reference_n: [f64; 2],
    /// What the linear loop predicts; `None` if it has no known response, or grows without bound.
    pub linear: Option<TrialStep>,
    /// The step response of the machine; `None` if it did not start.
    pub machine: Option<TrialStep>,
    /// The linear loop's response; empty if it is absent.
    pub linear_response: StepResponse,
    /// The machine's; empty where it did not start.
    pub machine_response: StepResponse,
    /// The judgement.
    pub agreement: Agreement,
    /// Why, in a sentence.
    pub reason: String,
    /// Where the lines of a machine with waves begin to oscillate, rad/s; `None` for one without.
    pub quarter_wave_rad_per_s: Option<f64>,
    /// Events on the way, by the names of occurrences: the limit of the command, cavitation, an end
    /// stop.
    pub met: Vec<&'static str>,
}

/// The step over the force that the supply can produce.
const STEP_SHARE: f64 = 0.1;
/// The reference stays within this share of that force.
const REACH: f64 = 0.8;
/// Percent of the step within which the force counts as settled.
pub(super) const BAND_PERCENT: f64 = 2.0;
/// s, before the step.
const BEFORE_S: f64 = 0.05;
/// Duration of a run in settling times of the linear loop, and its bounds in s.
const SETTLING_TIMES: f64 = 5.0;
const DURATION_S: [f64; 2] = [0.5, 20.0];
/// Motion of a force that counts as settled, as a share of the step.
const STILL: f64 = 0.01;
/// Factor by which settling times may differ.
const SETTLING_RATIO: f64 = 2.0;
/// Percent of the step by which an overshoot may differ: friction has an effect of this size on a
/// small step.
const OVERSHOOT_ROOM_PERCENT: f64 = 5.0;

/// Drives one machine; `None` where the watcher stops it.
pub(super) fn run(
    source: &dyn Source,
    tried: &Tried,
    problem: &RobustProblem,
    view: &ProjectAudit,
    watch: Watch<'_>,
) -> Result<Option<TrialRun>, TrialError> {
    let setup = Setup::new(&tried.project)?;
    let predicted = predicted(tried, &setup, problem)?;
    let grows = matches!(predicted, Prediction::Grows);
    let (linear, linear_response) = match predicted {
        Prediction::Step(metrics, response) => {
            let settling_time_s = metrics.settling.time_s();
            (
                Some(TrialStep { overshoot_percent: Some(metrics.overshoot_percent), settling_time_s }),
                response,
            )
        }
        Prediction::Grows | Prediction::Unknown => (None, StepResponse::default()),
    };
    let [shortest, longest] = DURATION_S;
    let settles_s = linear.and_then(|step| step.settling_time_s).unwrap_or(shortest);
    let duration = BEFORE_S + (SETTLING_TIMES * settles_s).clamp(shortest, longest);
    let reference_n = reference(setup.rig()?);
    let project = stepped(&tried.project, reference_n, duration);
    let (what, plant) = (tried.what.clone(), tried.named.clone());
    let run = |status, met, (machine, machine_response), (agreement, reason)| {
        Some(TrialRun {
            what,
            plant,
            status,
            reference_n,
            linear,
            machine,
            linear_response,
            machine_response,
            agreement,
            reason,
            quarter_wave_rad_per_s: tried.quarter_wave_rad_per_s,
            met,
        })
    };
    match simulate_project(source, &setup.asked(&project), watch) {
        Ok(runs) => {
            let Some(driven) = runs.first().filter(|driven| !driven.was_cancelled()) else { return Ok(None) };
            let machine = step_of(driven, reference_n);
            let mut judged = judge((driven, reference_n), (linear.as_ref(), grows), &machine, problem, view);
            if let (Some(quarter), true) = (tried.quarter_wave_rad_per_s, judged.0 != Agreement::Agrees) {
                judged.1.push_str(&format!(
                    ". The lines are a quarter wave long at {} rad/s: a shorter line,{} or a loop with less gain from there on",
                    significant(quarter, 3),
                    damping_wall(&project)
                ));
            }
            let status = driven.stopped().map_or("completed", |stopped| stopped.word);
            let course = (Some(machine), response_of(driven, reference_n));
            Ok(run(status, met(driven), course, judged))
        }
        Err(error) => {
            Ok(run("not_started", vec![], (None, StepResponse::default()), not_started(&error, view)))
        }
    }
}

/// A step from the force of the operating point, in the direction with more room.
fn reference(rig: &Rig) -> [f64; 2] {
    let components = rig.actuator.components();
    let [area_a, area_b] = components.cylinder.areas_at(rig.point.position);
    let area = 0.5 * (area_a + area_b);
    let push = area * (components.supply.pressure - components.supply.tank_pressure);
    let from = rig.point.hydraulic_force;
    let step = STEP_SHARE * push;
    let towards = if from + step <= REACH * push { step } else { -step };
    [from, from + towards]
}

/// The project with one scenario: in equilibrium under the first reference, then the second.
fn stepped(project: &Project, [from, to]: [f64; 2], duration: f64) -> Project {
    let at = |at, value| Signal::Step { at, value, published: None };
    let scenario = Scenario {
        name: "step".to_string(),
        duration,
        output_step: duration / 2000.0,
        reference: vec![at(0.0, from), at(BEFORE_S, to)],
        settling_band_percent: BAND_PERCENT,
        ..Scenario::default()
    };
    Project { scenarios: vec![scenario], ..project.clone() }
}

/// Properties of the response of what the loop controls: of the force, or with a virtual impedance
/// and a load that yields of the force together with what the impedance makes of the motion.
fn step_of(driven: &ScenarioRun, reference_n: [f64; 2]) -> TrialStep {
    if driven.record.signal("virtual_force_n").iter().any(|force| *force != 0.0) {
        let StepResponse { times_s, values } = response_of(driven, reference_n);
        let metrics = step_metrics(&times_s, &values, StepBaseline::to_value(1.0), BAND_PERCENT).ok();
        return TrialStep {
            overshoot_percent: metrics.as_ref().map(|metrics| metrics.overshoot_percent),
            settling_time_s: metrics.and_then(|metrics| metrics.settling.time_s()),
        };
    }
    let metrics = driven.windows.last().map(|(_, metrics)| metrics);
    TrialStep {
        overshoot_percent: metrics.and_then(|metrics| metrics.overshoot_percent.ok()),
        settling_time_s: metrics.and_then(|metrics| metrics.settling_time_s.ok()),
    }
}

/// What the loop controls, N.
fn controlled(driven: &ScenarioRun) -> Vec<f64> {
    let record = &driven.record;
    let forces = record.signal("force_n");
    if !record.parts.impedance {
        return forces;
    }
    let virtual_forces = record.signal("virtual_force_n");
    forces.into_iter().zip(virtual_forces).map(|(force, virtual_force)| force + virtual_force).collect()
}

/// The controlled force from the step on, as a share of it.
fn response_of(driven: &ScenarioRun, [from, to]: [f64; 2]) -> StepResponse {
    let rows = driven.record.times_s.iter().zip(controlled(driven));
    let after = rows.filter(|(time_s, _)| **time_s >= BEFORE_S);
    let (times_s, values) =
        after.map(|(time_s, force)| (time_s - BEFORE_S, (force - from) / (to - from))).unzip();
    StepResponse { times_s, values }
}

/// A machine without an equilibrium under its controller, or without equations.
fn not_started(error: &SimulateError, view: &ProjectAudit) -> (Agreement, String) {
    let agreement =
        if view.audit.verdict == Verdict::Met { Agreement::Contradicts } else { Agreement::Differs };
    (agreement, format!("the machine does not start: {error}"))
}

fn judge(
    (driven, reference_n): (&ScenarioRun, [f64; 2]),
    (linear, grows): (Option<&TrialStep>, bool),
    machine: &TrialStep,
    problem: &RobustProblem,
    view: &ProjectAudit,
) -> (Agreement, String) {
    let step_n = reference_n[1] - reference_n[0];
    let promised = view.audit.verdict != Verdict::Violated;
    let broken = if promised { Agreement::Contradicts } else { Agreement::Differs };
    if let Some(stopped) = driven.stopped() {
        let time = DisplayUnit::MILLISECOND.text(stopped.time_s, 3);
        return (broken, format!("the run ended after {time} as {}", stopped.word));
    }
    let settles = !grows && linear.is_none_or(|step| step.settling_time_s.is_some());
    if machine.settling_time_s.is_none() && settles {
        let words = swing(driven).map_or(String::new(), |swing| format!(": {}", swing_words(swing)));
        return (broken, format!("the force does not settle{words}"));
    }
    if machine.settling_time_s.is_none() {
        return (Agreement::Agrees, "neither the linear loop nor the machine settles".to_string());
    }
    let overshoot = machine.overshoot_percent.unwrap_or(0.0);
    let predicted = linear.and_then(|step| step.overshoot_percent);
    let beside = predicted.map_or(String::new(), |predicted| {
        format!(", where the linear loop has {}", percent_words(predicted))
    });
    let told = format!("it overshoots by {}{beside}", percent_words(overshoot));
    let more = overshoot - predicted.unwrap_or(overshoot);
    let most = most_overshoot_percent(problem);
    if more > OVERSHOOT_ROOM_PERCENT && most.is_some_and(|most| overshoot > most) {
        return (broken, format!("{told}: more than the limit on |L/(1+L)| lets a loop overshoot"));
    }
    if let Some(swing) = swing(driven).filter(|[low, high]| high - low > STILL * step_n.abs()) {
        return (Agreement::Differs, format!("{told}, and does not come to rest: {}", swing_words(swing)));
    }
    if let Some((own, predicted)) = machine.settling_time_s.zip(linear.and_then(|step| step.settling_time_s))
        && !(predicted / SETTLING_RATIO..=predicted * SETTLING_RATIO).contains(&own)
    {
        let [own, predicted] = [own, predicted].map(|time_s| DisplayUnit::MILLISECOND.text(time_s, 3));
        return (Agreement::Differs, format!("it settles in {own}, where the linear loop takes {predicted}"));
    }
    match (more.abs() > OVERSHOOT_ROOM_PERCENT, met(driven).first()) {
        (true, _) => (Agreement::Differs, told),
        (false, Some(kind)) => (Agreement::Differs, format!("{told}, and meets {}", kind.replace('_', " "))),
        (false, None) => (Agreement::Agrees, told),
    }
}

/// The limits and ends that the machine reached, in order.
fn met(driven: &ScenarioRun) -> Vec<&'static str> {
    driven.occurrences.iter().filter(|one| one.begins).map(|one| one.kind).collect()
}

/// `2.10 %`; values below a hundredth count as zero.
pub fn percent_words(percent: f64) -> String {
    if percent < 0.01 { "0 %".to_string() } else { format!("{} %", significant(percent, 3)) }
}

/// The range of the force over the last fifth of the run, N.
fn swing(driven: &ScenarioRun) -> Option<[f64; 2]> {
    let force = controlled(driven);
    let last = force.get(force.len() - force.len() / 5..)?;
    let widest = |[low, high]: [f64; 2], force: &f64| [low.min(*force), high.max(*force)];
    (!last.is_empty()).then(|| last.iter().fold([f64::INFINITY, f64::NEG_INFINITY], widest))
}

fn swing_words([low, high]: [f64; 2]) -> String {
    let newton = |force| crate::quantity::display(force, &FORCE, 3);
    format!("at the end it swings between {} and {}", newton(low), newton(high))
}

/// The overshoot of a system of second order whose resonance reaches the least limit on |L/(1+L)|,
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

/// The wall that may damp a wave in these lines, if their models include one; pipes have none.
fn damping_wall(project: &Project) -> &'static str {
    let Some(line) = project.actuator.as_ref().map(|actuator| &actuator.line) else { return "" };
    let mut models = [&line.a, &line.b]
        .into_iter()
        .filter(|side| side.hose().is_some())
        .map(|side| &side.motion)
        .peekable();
    if models.peek().is_none() {
        ""
    } else if models.all(|model| matches!(model, LineMotion::Segments(_) | LineMotion::Creeping { .. })) {
        " a wall that damps (line.relaxation_time)"
    } else {
        " a wall that damps (line.model = \"segments\" with line.relaxation_time)"
    }
}

/// The word of an agreement.
pub fn agreement_word(agreement: Agreement) -> &'static str {
    match agreement {
        Agreement::Agrees => "agrees",
        Agreement::Differs => "differs",
        Agreement::Contradicts => "contradicts",
    }
}
