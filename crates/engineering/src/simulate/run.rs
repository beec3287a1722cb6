//! One scenario, run.

use std::cell::{Cell, RefCell};

use phea_dynamics::order::sort_by_number;
use phea_dynamics::simulation::{
    Amplification, Attention, Event, Input, InputSchedule, Outcome, Sampler, SimulationSettings, Status,
    StepCounts, Task, UnfollowedKinks,
};
use phea_hydraulics::machine::INDICATORS;
use phea_machine::{Control, ControllerSamples, Digital, DigitalMemory, Waking, Watcher};

use super::adjusted::AdjustmentWork;
use super::bench::ControlledMachine;
use super::columns::SignalParts;
use super::course::PreparedScenario;
use super::divergence::Divergence;
use super::exceeded::Exceeded;
use super::gas::GasRange;
use super::look::Looking;
use super::measured::{Measurement, Overlay};
use super::metrics::Metrics;
use super::record::Record;
use super::repetition::{self, PassPlan, PassResult, Repetition};
use super::run_status::RunStatus;
use super::saved::{self, NotSaved, SavedState};
use super::{NoLedger, RunLedger, RunOutput, RunTable, SimulateError, ToleranceCheck, Window};
use crate::project::Scenario;

/// Longest time between two samples, from which figures are drawn: 1 ms would cut off the peaks of
/// a ringing load cell.
const LONGEST_LOOK_S: f64 = 0.25e-3;
/// Largest number of samples where the project requests fewer rows.
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
    pub work: StepCounts,
    /// Tolerance of the integration.
    pub tolerance: f64,
    /// The passes that were made because errors may be visible; `None` where one was enough.
    pub repetition: Option<Repetition>,
    /// How it diverges, though it ran to its end; `None` if it does not.
    pub divergence: Option<Divergence>,
    /// The record, every [`ScenarioRun::look_s`], or less often in a long run; empty where it was
    /// not asked for.
    pub record: Record,
    /// Number of samples between two rows of the result.
    pub looks_per_row: usize,
    /// Time between two samples, s: shorter events are not drawn.
    pub look_s: f64,
    /// How closely its steps were followed.
    pub attention: Attention,
    /// Each window with its metrics.
    pub windows: Vec<(Window, Metrics)>,
    /// The events of the run, in the order of time.
    pub occurrences: Vec<Occurrence>,
    /// The time from which the equations of the machine do not hold, s.
    pub outside_model_s: Option<f64>,
    /// Percent, of every settling time.
    pub settling_band_percent: f64,
    /// The measured signals and the simulated ones.
    pub measured: Vec<Overlay>,
    /// The difference from a run at a tenth of the tolerance; `None` if it was not requested.
    pub check: Option<ToleranceCheck>,
    /// A mode that grew so much that errors within the tolerance of the first pass may be visible;
    /// `None` if there is none.
    pub errors_amplified: Option<Amplification>,
    /// Kinks along which no deviation was carried, so that what they amplify is not known.
    pub unfollowed: Option<UnfollowedKinks>,
    /// Whether a stated command drove the valve, and no controller.
    pub open_loop: bool,
    /// Chambers whose pressure exceeded that up to which the expansion of their hose was measured.
    pub beyond_expansion: Vec<BeyondExpansion>,
    /// Limits of the rig that it exceeds.
    pub exceeded: Vec<Exceeded>,
    /// Work of accumulators that are adjusted by a valve or as it runs; `None` where there is none.
    pub adjustment: Option<AdjustmentWork>,
    /// The gas at each chamber that has some.
    pub gas: Vec<GasRange>,
    /// The accounts of oil and energy, or why there are none.
    pub ledger: Result<RunLedger, NoLedger>,
    /// Its final state, from which another run can continue, or why it is not saved.
    pub end: Result<SavedState, NotSaved>,
}

/// A chamber above the pressure up to which the expansion of its hose was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeyondExpansion {
    /// `a` or `b`.
    pub chamber: char,
    /// Its highest pressure, Pa.
    pub peak_pa: f64,
    /// Where the expansion is stated, Pa.
    pub stated_pa: f64,
}

/// Something that began or ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// s.
    pub time_s: f64,
    /// One of [`INDICATORS`], `command_limit`, or one of
    /// [`LINE_OCCURRENCES`](super::LINE_OCCURRENCES), which only begin.
    pub kind: &'static str,
    /// Whether it began.
    pub begins: bool,
}

impl Occurrence {
    /// The beginning of the time in which a limit of a line is exceeded.
    pub fn of(exceeded: &Exceeded) -> Option<Occurrence> {
        Some(Occurrence { time_s: exceeded.first_time_s, kind: exceeded.occurrence()?, begins: true })
    }
}

/// How a run ended early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoppedRun {
    /// s.
    pub time_s: f64,
    /// Status of the run.
    pub status: RunStatus,
    /// The mode whose oscillation would need more steps than are allowed.
    pub mode: Option<UnresolvedMode>,
}

/// A mode that grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnresolvedMode {
    /// Magnitude of its eigenvalue in rad/s.
    pub frequency_rad_per_s: f64,
    /// Real part of its eigenvalue in 1/s.
    pub growth_per_s: f64,
}

impl ScenarioRun {
    /// Whether it is so long that it was sampled less often than its figures need.
    pub fn is_coarse(&self) -> bool {
        self.attention == Attention::Everything && self.look_s > LONGEST_LOOK_S * (1.0 + 1e-9)
    }

    /// Whether whoever watched ended it, or a repetition.
    pub fn was_cancelled(&self) -> bool {
        let repeating = self.repetition.as_ref().is_some_and(Repetition::was_cancelled);
        matches!(self.status, Status::Cancelled { .. }) || repeating
    }

    /// Status of the run: completed if its numbers describe the machine.
    pub fn run_status(&self) -> RunStatus {
        let undetermined = self.repetition.as_ref().is_some_and(|passes| !passes.is_determined());
        run_status(self.stopped(), self.outside_model_s, undetermined)
    }

    /// Whether it ran to its end, within the validity of its equations, and to a result that its
    /// tolerance determines.
    pub fn is_reliable(&self) -> bool {
        self.run_status() == RunStatus::Completed
    }

    /// Reason and time of an early end or a divergence; `None` if there is neither.
    pub fn stopped(&self) -> Option<StoppedRun> {
        StoppedRun::of(self.status).or_else(|| self.divergence.as_ref().map(StoppedRun::diverged))
    }
}

impl StoppedRun {
    /// That of a run to its end that diverges.
    pub fn diverged(divergence: &Divergence) -> StoppedRun {
        StoppedRun { time_s: divergence.since_s(), status: RunStatus::Diverged, mode: None }
    }

    /// The meaning of a status; `None` for a run that was completed.
    pub fn of(status: Status) -> Option<StoppedRun> {
        let mut mode = None;
        let time_s = match status {
            Status::Completed => return None,
            Status::Cancelled { time_s }
            | Status::StepTooSmall { time_s }
            | Status::NotFinite { time_s }
            | Status::TooManySteps { time_s } => time_s,
            Status::UnresolvedOscillation { time_s, frequency_rad_per_s, growth_per_s } => {
                mode = Some(UnresolvedMode { frequency_rad_per_s, growth_per_s });
                time_s
            }
        };
        Some(StoppedRun { time_s, status: RunStatus::of(status), mode })
    }
}

/// A pass over a scenario.
pub(super) struct RunPass<'t> {
    pub(super) run: ScenarioRun,
    /// Its rows, to be finished.
    pub(super) table: Option<RunTable<'t>>,
    /// The force at some times, N.
    force_n: Vec<f64>,
    /// The largest growth of errors; `None` where none grew.
    amplification: Option<Amplification>,
}

impl RunPass<'_> {
    /// As passes are compared.
    pub(super) fn result(&self) -> PassResult {
        PassResult {
            status: self.run.status,
            work: self.run.work,
            amplification: self.amplification,
            swings: self.run.divergence.as_ref().is_some_and(Divergence::swings),
            metrics: self.run.windows.clone(),
            force_n: self.force_n.clone(),
        }
    }
}

/// Runs a scenario once, writes its rows into a table, if one is given, and keeps its samples, if
/// they are asked for; `watch` is called with the simulated time at intervals.
pub(super) fn run<'t>(
    bench: &ControlledMachine,
    scenario: &Scenario,
    (course, measurements): (&PreparedScenario, &[Measurement]),
    (plan, table, output): (PassPlan, Option<RunTable<'t>>, &RunOutput<'_>),
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<RunPass<'t>, SimulateError> {
    let looks_per_row = if output.attention == Attention::Steps { 1 } else { looks_per_row(scenario) };
    let look_s = scenario.output_step / looks_per_row as f64;
    let (samples, full) = (RefCell::new(ControllerSamples::default()), Cell::new(false));
    let memory = RefCell::new(DigitalMemory::default());
    let mut steps = 0;
    let mut watch = |time_s: f64| {
        steps += 1;
        steps % STEPS_UNWATCHED != 0 || (!full.get() && watch(time_s))
    };
    let inputs = inputs(&bench.control, course);
    let drive = InputSchedule { duration_s: scenario.duration, output_step_s: look_s, inputs };
    let during = (course, scenario.settling_band_percent, scenario.duration);
    let looks = scenario.duration / look_s;
    let looking = Looking::new(bench, &samples, (table, looks_per_row), measurements, &full, during);
    let looking = looking.following(output.attention, looks);
    let looking = if output.samples { looking.keeping(looks + 2.0) } else { looking };
    let looking = if output.line_limits { looking } else { looking.without_line_limits() };
    let mut looking = if output.ledger { looking.accounting() } else { looking };
    let sampler = sampler(&bench.control, &course.waking, &samples, &memory);
    let observer: Watcher<'_> = Box::new(&mut looking);
    let task = Task { start: start(bench, course, plan), course: &drive, sampler, observer };
    let settings = SimulationSettings { tolerance: plan.tolerance, ..bench.settings };
    let named = |error| SimulateError::Simulation { name: scenario.name.clone(), error };
    let outcome = bench.control.drive(task, &settings, &mut watch).map_err(named)?;
    let seen = looking.finish()?;
    let occurrences = found((bench, course), &outcome, &samples.borrow(), &seen.exceeded);
    let outside_model_s = outside_model_s(&occurrences, bench.machine.has_end_stops());
    let memory = memory.into_inner();
    let memory = matches!(bench.control, Control::Sampled(_)).then_some(&memory);
    let end = saved::of_end(bench, course, (outcome.status, &outcome.end, scenario.duration), memory);
    let record = Record { units: bench.units, parts: SignalParts::of(bench), ..seen.record };
    let amplification = amplification(&outcome, &samples.borrow());
    let run = ScenarioRun {
        name: scenario.name.clone(),
        status: outcome.status,
        work: outcome.work,
        tolerance: plan.tolerance,
        repetition: None,
        divergence: seen.divergence,
        record,
        looks_per_row,
        look_s,
        attention: output.attention,
        windows: course.windows.iter().copied().zip(seen.metrics).collect(),
        occurrences,
        outside_model_s,
        settling_band_percent: scenario.settling_band_percent,
        measured: seen.measured,
        errors_amplified: amplification.filter(|grown| grown.may_show_errors(plan.tolerance)),
        unfollowed: outcome.unfollowed,
        open_loop: scenario.is_open_loop(),
        beyond_expansion: beyond_expansion(bench, seen.peak_pressures_pa),
        exceeded: seen.exceeded,
        adjustment: seen.adjustment,
        gas: seen.gas,
        ledger: seen.ledger,
        end,
        check: None,
    };
    Ok(RunPass { run, table: seen.table, force_n: seen.force_n, amplification })
}

/// The start of a pass: that of the scenario, or moved by roundings.
fn start(bench: &ControlledMachine, course: &PreparedScenario, plan: PassPlan) -> Vec<f64> {
    let mut start = course.start.clone();
    if plan.moved {
        repetition::moved(&mut start, &bench.control.scales());
    }
    start
}

/// The samples of a sampled controller, which leaves its memory behind.
fn sampler<'a>(
    control: &'a Control,
    waking: &'a Waking,
    samples: &'a RefCell<ControllerSamples>,
    memory: &'a RefCell<DigitalMemory>,
) -> Option<Box<dyn Sampler + 'a>> {
    match control {
        Control::Continuous(_) | Control::Open(_) => None,
        Control::Sampled(sampled) => {
            Some(Box::new(Digital::new(sampled, waking, samples).remembered_in(memory)))
        }
    }
}

/// A scenario as another solver may take it: equations, inputs, and the state at time zero.
#[derive(Clone, Debug)]
pub struct ScenarioProblem {
    /// The machine, with its controller where this is continuous.
    pub control: Control,
    /// Duration, rows and inputs.
    pub course: InputSchedule,
    /// Every state and every wave in transit.
    pub start: Vec<f64>,
}

impl ScenarioProblem {
    pub(super) fn of(bench: &ControlledMachine, scenario: &Scenario, course: &PreparedScenario) -> Self {
        let inputs = inputs(&bench.control, course);
        let (duration_s, output_step_s) = (scenario.duration, scenario.output_step);
        let start = course.start.clone();
        let course = InputSchedule { duration_s, output_step_s, inputs };
        ScenarioProblem { control: bench.control.clone(), course, start }
    }
}

/// Inputs of the loop, then those of its machine.
fn inputs(control: &Control, course: &PreparedScenario) -> Vec<Input> {
    let reference = Input::Value(course.reference.clone());
    let leading = match control {
        Control::Continuous(_) => vec![reference],
        Control::Sampled(_) => vec![Input::Command, reference],
        Control::Open(_) => vec![Input::Value(course.command.clone()), reference],
    };
    leading.into_iter().chain(course.machine_inputs()).collect()
}

/// All that happened on the way, limits of lines that were exceeded among it.
fn found(
    (bench, course): (&ControlledMachine, &PreparedScenario),
    outcome: &Outcome,
    samples: &ControllerSamples,
    exceeded: &[Exceeded],
) -> Vec<Occurrence> {
    let reference = course.reference.value(0.0);
    let leading = match &bench.control {
        Control::Continuous(_) => vec![reference],
        Control::Sampled(_) => vec![0.0, reference],
        Control::Open(_) => vec![course.command.value(0.0), reference],
    };
    let first = inputs_at_start(course, leading, &bench.control);
    let mut found = occurrences(&bench.control, &course.start, &first, &outcome.events);
    if matches!(bench.control, Control::Sampled(_)) {
        let limits = samples.limits.iter();
        found.extend(limits.map(|&(time_s, begins)| Occurrence { time_s, kind: COMMAND_LIMIT, begins }));
    }
    let of_lines: Vec<Occurrence> = exceeded.iter().filter_map(Occurrence::of).collect();
    if matches!(bench.control, Control::Sampled(_)) || !of_lines.is_empty() {
        found.extend(of_lines);
        sort_by_number(&mut found, |one| one.time_s);
    }
    found
}

/// When a chamber, a line or a transmission first cavitates, a chamber has no volume, or the piston
/// leaves a stroke without end stops.
pub(crate) fn outside_model_s(occurrences: &[Occurrence], has_end_stops: bool) -> Option<f64> {
    let outside = |kind: &str| match kind {
        "cavitation_a" | "cavitation_b" | "cavitation_line_a" | "cavitation_line_b" => true,
        "cavitation_transmission" | "empty_a" | "empty_b" => true,
        "end_stop_a" | "end_stop_b" => !has_end_stops,
        _ => false,
    };
    occurrences.iter().find(|one| one.begins && outside(one.kind)).map(|one| one.time_s)
}

fn beyond_expansion(bench: &ControlledMachine, peaks_pa: [f64; 2]) -> Vec<BeyondExpansion> {
    let beyond = |((chamber, peak_pa), stated): ((char, f64), Option<f64>)| {
        let stated_pa = stated?;
        (peak_pa > stated_pa * (1.0 + 1e-6)).then_some(BeyondExpansion { chamber, peak_pa, stated_pa })
    };
    ['a', 'b'].into_iter().zip(peaks_pa).zip(bench.expansion_stated_at).filter_map(beyond).collect()
}

fn looks_per_row(scenario: &Scenario) -> usize {
    let wanted = (scenario.output_step / LONGEST_LOOK_S).ceil().max(1.0);
    let rows = scenario.duration / scenario.output_step;
    wanted.min((MOST_LOOKS / rows).floor().max(1.0)) as usize
}

/// The name of an [`Occurrence`] while the command is at its limit, in addition to the indicators
/// of a machine.
pub const COMMAND_LIMIT: &str = "command_limit";

/// What a campaign calls a run whose errors may be visible though it was repeated, with the names
/// of what a machine reports.
pub const ERRORS_AMPLIFIED: &str = "errors_amplified";

/// What a campaign calls a run that was repeated until its metrics agreed.
pub const REPEATED: &str = "repeated";

/// The status of a run: that of its end first.
pub(crate) fn run_status(
    stopped: Option<StoppedRun>,
    outside_model_s: Option<f64>,
    undetermined: bool,
) -> RunStatus {
    match (stopped, outside_model_s) {
        (Some(stopped), _) => stopped.status,
        (None, Some(_)) => RunStatus::OutsideModel,
        (None, None) if undetermined => RunStatus::Undetermined,
        (None, None) => RunStatus::Completed,
    }
}

/// What grew most between the samples of a controller, or from one to the next.
pub fn amplification(outcome: &Outcome, samples: &ControllerSamples) -> Option<Amplification> {
    Amplification::larger([outcome.amplification, samples.amplification])
}

/// Inputs at time zero: those of the loop, the ground, the external force, the setting, and the
/// waves in transit.
fn inputs_at_start(course: &PreparedScenario, mut first: Vec<f64>, control: &Control) -> Vec<f64> {
    first.extend([course.ground.value(0.0), course.ground.rate(0.0)]);
    first.extend(course.external_force.as_ref().map(|force| force.value(0.0)));
    let setting = course.setting_change.iter();
    first.extend(setting.flat_map(|setting| [setting.value(0.0), setting.rate(0.0)]));
    let [states, _] = control.size();
    first.extend(course.start.iter().skip(states));
    first
}

/// The events that exist from the start, and every change of an indicator. Those of the machine are
/// positive while nothing is wrong, that of the command's limit while it is reached.
pub fn occurrences(control: &Control, start: &[f64], first: &[f64], events: &[Event]) -> Vec<Occurrence> {
    let kind = |index: usize| INDICATORS.get(index).copied().unwrap_or(COMMAND_LIMIT);
    let begins = |index: usize, positive: bool| positive != (index < INDICATORS.len());
    let [states, _] = control.size();
    let state: Vec<f64> = start.iter().copied().take(states).collect();
    let indicators = control.indicators(&state, first);
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
