//! One scenario, run.

use std::cell::RefCell;

use phea_dynamics::simulation::{
    ClosedLoop, Course as Drive, Event, HeldPlant, Input, Outcome, Sensed, Simulated, Status, System, Work,
    simulate,
};
use phea_hydraulics::machine::{INDICATORS, Machine, SIGNALS};

use super::bench::{Bench, Control, Sampled};
use super::course::Course;
use super::digital::{Digital, Sample};
use super::metrics::{Metrics, metrics};
use super::{SimulateError, Window};
use crate::project::Scenario;

/// Longest time between two looks at the machine: 1 ms would cut the peaks of a ringing load cell.
const LONGEST_LOOK_S: f64 = 0.25e-3;
/// Most looks where the project asks for fewer rows.
const MOST_LOOKS: f64 = 400_000.0;
/// Steps between two reports of progress.
const STEPS_UNWATCHED: u32 = 64;

/// What came of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioRun {
    /// Its name.
    pub name: String,
    /// How it ended.
    pub status: Status,
    /// What it cost.
    pub work: Work,
    /// What was seen, every [`ScenarioRun::look_s`].
    pub record: Record,
    /// Looks between two rows of the result.
    pub looks_per_row: usize,
    /// Time between two looks, s: what is shorter is not seen.
    pub look_s: f64,
    /// Each window with what is read off it.
    pub windows: Vec<(Window, Metrics)>,
    /// What happened on the way, in the order of time.
    pub occurrences: Vec<Occurrence>,
    /// From when on the machine is where its equations do not hold, s.
    pub outside_model_s: Option<f64>,
    /// Percent, of every settling time.
    pub settling_band_percent: f64,
}

/// The machine and its controller over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// s.
    pub times_s: Vec<f64>,
    /// N; at a step, as it is from then on.
    pub reference_n: Vec<f64>,
    /// N, behind the prefilter.
    pub filtered_reference_n: Vec<f64>,
    /// V, what the controller gives out.
    pub control_v: Vec<f64>,
    /// What the machine tells of itself, each in the order of [`SIGNALS`].
    pub signals: Vec<[f64; SIGNALS.len()]>,
}

/// Something that began or ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// s.
    pub time_s: f64,
    /// One of [`INDICATORS`], or `command_limit`.
    pub kind: &'static str,
    /// Whether it began.
    pub begins: bool,
}

/// How a run ended before its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped {
    /// s.
    pub time_s: f64,
    /// In one word, as in an answer.
    pub word: &'static str,
}

impl Record {
    /// One of [`SIGNALS`] over time; empty for a name that is none.
    pub fn signal(&self, name: &str) -> Vec<f64> {
        let Some(index) = SIGNALS.iter().position(|signal| *signal == name) else { return Vec::new() };
        self.signals.iter().map(|row| row[index]).collect()
    }
}

impl ScenarioRun {
    /// Whether it is so long that it was looked at less often than peaks want.
    pub(crate) fn is_coarse(&self) -> bool {
        self.look_s > LONGEST_LOOK_S * (1.0 + 1e-9)
    }

    /// Whether whoever watched ended it.
    pub fn was_cancelled(&self) -> bool {
        matches!(self.status, Status::Cancelled { .. })
    }

    /// Why and when it ended before its time; `None` if it did not.
    pub fn stopped(&self) -> Option<Stopped> {
        Stopped::of(self.status)
    }
}

impl Stopped {
    /// What a status says; `None` of a run that came to its end.
    pub(crate) fn of(status: Status) -> Option<Stopped> {
        let (time_s, word) = match status {
            Status::Completed => return None,
            Status::Cancelled { time_s } => (time_s, "cancelled"),
            Status::StepTooSmall { time_s } => (time_s, "step_too_small"),
            Status::NotFinite { time_s } => (time_s, "not_finite"),
            Status::TooManySteps { time_s } => (time_s, "too_many_steps"),
            Status::UnresolvedOscillation { time_s, .. } => (time_s, "unresolved_oscillation"),
        };
        Some(Stopped { time_s, word })
    }
}

/// Runs a scenario; `watch` is told the simulated time now and then.
pub(super) fn run(
    bench: &Bench,
    scenario: &Scenario,
    course: &Course,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<ScenarioRun, SimulateError> {
    let looks_per_row = looks_per_row(scenario);
    let look_s = scenario.output_step / looks_per_row as f64;
    let mut steps = 0;
    let mut watch = |time_s: f64| {
        steps += 1;
        steps % STEPS_UNWATCHED != 0 || watch(time_s)
    };
    let ground = [Input::Value(course.ground.clone()), Input::Rate(course.ground.clone())];
    let inputs = |first: Vec<Input>| Drive {
        duration_s: scenario.duration,
        output_step_s: look_s,
        inputs: first.into_iter().chain(ground.clone()).collect(),
    };
    let reference = Input::Value(course.reference.clone());
    let named = |error| SimulateError::Simulation { name: scenario.name.clone(), error };
    let (outcome, record, occurrences) = match &bench.control {
        Control::Continuous(closed) => {
            let drive = inputs(vec![reference]);
            let simulated =
                simulate(closed.as_ref(), &course.start, &drive, None, &bench.settings, &mut watch);
            continuous(bench, closed, course, simulated.map_err(named)?)
        }
        Control::Sampled(sampled) => {
            let drive = inputs(vec![Input::Command, reference]);
            let log = RefCell::new(Vec::new());
            let digital = Box::new(Digital::new(sampled, course.holding, &log));
            let simulated =
                simulate(&sampled.held, &course.start, &drive, Some(digital), &bench.settings, &mut watch);
            self::sampled(bench, sampled, course, simulated.map_err(named)?, &log.into_inner())
        }
    };
    let band = scenario.settling_band_percent;
    let windows = course.windows.iter().map(|window| (*window, metrics(&record, *window, band))).collect();
    let Outcome { status, work, .. } = outcome;
    let outside_model_s = outside_model_s(&occurrences, bench.machine.has_end_stops());
    Ok(ScenarioRun {
        name: scenario.name.clone(),
        status,
        work,
        record,
        looks_per_row,
        look_s,
        windows,
        occurrences,
        outside_model_s,
        settling_band_percent: band,
    })
}

/// When a chamber first cavitates or has no volume, or the piston leaves a stroke that nothing limits.
fn outside_model_s(occurrences: &[Occurrence], has_end_stops: bool) -> Option<f64> {
    let outside = |kind: &str| match kind {
        "cavitation_a" | "cavitation_b" | "empty_a" | "empty_b" => true,
        "end_stop_a" | "end_stop_b" => !has_end_stops,
        _ => false,
    };
    occurrences.iter().find(|one| one.begins && outside(one.kind)).map(|one| one.time_s)
}

fn looks_per_row(scenario: &Scenario) -> usize {
    let wanted = (scenario.output_step / LONGEST_LOOK_S).ceil().max(1.0);
    let rows = scenario.duration / scenario.output_step;
    wanted.min((MOST_LOOKS / rows).floor().max(1.0)) as usize
}

fn continuous(
    bench: &Bench,
    closed: &ClosedLoop<Sensed<Machine>>,
    course: &Course,
    simulated: Simulated,
) -> (Outcome, Record, Vec<Occurrence>) {
    let trajectory = simulated.trajectory;
    let mut record = Record { times_s: trajectory.times_s, ..Record::default() };
    for (state, inputs) in trajectory.states.iter().zip(&trajectory.inputs) {
        let signals = closed.signals::<f64, f64>(state, inputs);
        record.reference_n.push(inputs[0]);
        record.filtered_reference_n.push(signals.filtered_reference);
        record.control_v.push(signals.command);
        record.signals.push(bench.machine.outputs(state, &inputs[1..]));
    }
    let first = inputs_at_start(course, vec![course.reference.value(0.0)], closed);
    let occurrences = occurrences(closed, &course.start, &first, &simulated.outcome.events);
    (simulated.outcome, record, occurrences)
}

fn sampled(
    bench: &Bench,
    sampled: &Sampled,
    course: &Course,
    simulated: Simulated,
    log: &[Sample],
) -> (Outcome, Record, Vec<Occurrence>) {
    let held: &HeldPlant<Sensed<Machine>> = &sampled.held;
    let trajectory = simulated.trajectory;
    let mut record = Record { times_s: trajectory.times_s, ..Record::default() };
    let mut samples = log.iter().peekable();
    let mut last = None;
    for ((time_s, state), inputs) in record.times_s.iter().zip(&trajectory.states).zip(&trajectory.inputs) {
        while let Some(sample) = samples.next_if(|sample| sample.time_s <= *time_s) {
            last = Some(sample);
        }
        let filtered = last.map_or(0.0, |sample: &Sample| sample.filtered_reference_n);
        record.reference_n.push(inputs[1]);
        record.filtered_reference_n.push(filtered);
        record.control_v.push(last.map_or(0.0, |sample| sample.command_v));
        record.signals.push(bench.machine.outputs(state, &inputs[2..]));
    }
    let first = inputs_at_start(course, vec![0.0, course.reference.value(0.0)], held);
    let mut occurrences = occurrences(held, &course.start, &first, &simulated.outcome.events);
    let mut limited = false;
    for sample in
        log.iter().filter(|sample| std::mem::replace(&mut limited, sample.limited) != sample.limited)
    {
        let kind = COMMAND_LIMIT;
        occurrences.push(Occurrence { time_s: sample.time_s, kind, begins: sample.limited });
    }
    occurrences.sort_by(|one, other| one.time_s.total_cmp(&other.time_s));
    (simulated.outcome, record, occurrences)
}

/// The limit of the command, beside [`INDICATORS`].
pub(crate) const COMMAND_LIMIT: &str = "command_limit";

/// Inputs at time zero: those before the machine's, its ground, and the waves under way.
fn inputs_at_start(course: &Course, mut first: Vec<f64>, system: &impl System<f64>) -> Vec<f64> {
    first.extend([course.ground.value(0.0), course.ground.rate(0.0)]);
    first.extend(course.start.iter().skip(system.states()));
    first
}

/// What there is from the start, and every change of an indicator. Those of the machine are positive while all is well, that of
/// the command's limit while it is reached.
pub(crate) fn occurrences(
    system: &impl System<f64>,
    start: &[f64],
    first: &[f64],
    events: &[Event],
) -> Vec<Occurrence> {
    let kind = |index: usize| INDICATORS.get(index).copied().unwrap_or(COMMAND_LIMIT);
    let begins = |index: usize, positive: bool| positive != (index < INDICATORS.len());
    let mut indicators = vec![1.0; system.indicators()];
    let state: Vec<f64> = start.iter().copied().take(system.states()).collect();
    system.indicate(&state, first, &mut indicators);
    let from_start = indicators.iter().enumerate().filter(|(index, value)| begins(*index, **value > 0.0));
    let mut found: Vec<Occurrence> =
        from_start.map(|(index, _)| Occurrence { time_s: 0.0, kind: kind(index), begins: true }).collect();
    found.extend(events.iter().map(|event| Occurrence {
        time_s: event.time_s,
        kind: kind(event.indicator),
        begins: begins(event.indicator, event.rising),
    }));
    found
}
