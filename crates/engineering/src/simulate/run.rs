//! Simulation of one scenario.

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
use super::divergence::Divergence;
use super::exceeded::Exceeded;
use super::gas::GasRange;
use super::measured::{Measurement, Overlay};
use super::metrics::Metrics;
use super::prepared_scenario::PreparedScenario;
use super::record::Record;
use super::repetition::{self, PassPlan, PassResult, Repetition};
use super::run_observer::RunObserver;
use super::run_status::RunStatus;
use super::saved::{self, NotSaved, SavedState};
use super::{NoLedger, RunLedger, RunOutput, RunTable, SimulateError, ToleranceCheck, Window};
use crate::project::Scenario;

/// Longest interval between two samples, from which figures are drawn: 1 ms would cut off the peaks
/// of a ringing load cell.
const LONGEST_SAMPLE_INTERVAL_S: f64 = 0.25e-3;
/// Largest number of samples, if the project requests fewer rows.
const MOST_SAMPLES: f64 = 400_000.0;
/// Steps between two reports of progress.
const STEPS_UNWATCHED: u32 = 64;

/// Result of one scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioRun {
    /// Name of the scenario.
    pub name: String,
    /// Status at the end of the integration.
    pub status: Status,
    /// Work of the integration: numbers of steps and evaluations.
    pub work: StepCounts,
    /// Tolerance of the integration.
    pub tolerance: f64,
    /// The passes that were made because errors may be visible; `None` if one was enough.
    pub repetition: Option<Repetition>,
    /// Divergence of a run that reached its end; `None` if it does not diverge.
    pub divergence: Option<Divergence>,
    /// Samples at intervals of [`ScenarioRun::sample_interval_s`], or longer ones in a long run;
    /// empty if no record was requested.
    pub record: Record,
    /// Number of samples between two rows of the result.
    pub samples_per_row: usize,
    /// Time between two samples, s: shorter events do not appear in figures.
    pub sample_interval_s: f64,
    /// Detail in which the steps were evaluated.
    pub attention: Attention,
    /// Every window with its metrics.
    pub windows: Vec<(Window, Metrics)>,
    /// The events of the run, in the order of time.
    pub occurrences: Vec<Occurrence>,
    /// The time from which the equations of the machine do not hold, s.
    pub outside_model_s: Option<f64>,
    /// Settling band of every settling time, percent.
    pub settling_band_percent: f64,
    /// The measured signals and the simulated ones.
    pub measured: Vec<Overlay>,
    /// The difference from a run at a tenth of the tolerance; `None` if it was not requested.
    pub check: Option<ToleranceCheck>,
    /// A mode that grew so much that errors within the tolerance of the first pass may be visible;
    /// `None` if there is none.
    pub errors_amplified: Option<Amplification>,
    /// Kinks across which no deviation was propagated, so that its amplification there is unknown.
    pub unfollowed: Option<UnfollowedKinks>,
    /// True if a stated command drives the valve instead of a controller.
    pub open_loop: bool,
    /// Chambers whose pressure exceeded that up to which the expansion of their hose was measured.
    pub beyond_expansion: Vec<BeyondExpansion>,
    /// Limits of the rig that the run exceeds.
    pub exceeded: Vec<Exceeded>,
    /// Work of accumulators that are adjusted by a valve or during the run; `None` if there are
    /// none.
    pub adjustment: Option<AdjustmentWork>,
    /// Range of the gas at each chamber that contains gas.
    pub gas: Vec<GasRange>,
    /// Balances of oil and energy, or the reason why they are absent.
    pub ledger: Result<RunLedger, NoLedger>,
    /// Final state, from which another run can continue, or the reason why it is not saved.
    pub end: Result<SavedState, NotSaved>,
}

/// A chamber above the pressure up to which the expansion of its hose was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeyondExpansion {
    /// `a` or `b`.
    pub chamber: char,
    /// Highest pressure of the chamber, Pa.
    pub peak_pa: f64,
    /// Pressure up to which the expansion is stated, Pa.
    pub stated_pa: f64,
}

/// Beginning or end of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// Time of the event, s.
    pub time_s: f64,
    /// One of [`INDICATORS`], `command_limit`, or one of
    /// [`LINE_OCCURRENCES`](super::LINE_OCCURRENCES), which only begin.
    pub kind: &'static str,
    /// True at the beginning of the event, false at its end.
    pub begins: bool,
}

impl Occurrence {
    /// Beginning of the time in which a limit of a line is exceeded.
    pub fn of(exceeded: &Exceeded) -> Option<Occurrence> {
        Some(Occurrence { time_s: exceeded.first_time_s, kind: exceeded.occurrence()?, begins: true })
    }
}

/// Early end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoppedRun {
    /// Time of the end, s.
    pub time_s: f64,
    /// Status of the run.
    pub status: RunStatus,
    /// The mode whose oscillation would need more steps than are allowed; `None` for other causes.
    pub mode: Option<UnresolvedMode>,
}

/// A mode that grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnresolvedMode {
    /// Magnitude of the eigenvalue, rad/s.
    pub frequency_rad_per_s: f64,
    /// Real part of the eigenvalue, 1/s.
    pub growth_per_s: f64,
}

impl ScenarioRun {
    /// True if the run is so long that it was sampled less often than its figures need.
    pub fn is_coarse(&self) -> bool {
        self.attention == Attention::Everything
            && self.sample_interval_s > LONGEST_SAMPLE_INTERVAL_S * (1.0 + 1e-9)
    }

    /// True if the progress callback cancelled the run or one of its repetitions.
    pub fn was_cancelled(&self) -> bool {
        let repeating = self.repetition.as_ref().is_some_and(Repetition::was_cancelled);
        matches!(self.status, Status::Cancelled { .. }) || repeating
    }

    /// Status of the run: completed if its numbers describe the machine.
    pub fn run_status(&self) -> RunStatus {
        let undetermined = self.repetition.as_ref().is_some_and(|passes| !passes.is_determined());
        run_status(self.stopped(), self.outside_model_s, undetermined)
    }

    /// True if the run reached its end, within the validity of its equations, with a result that
    /// its tolerance determines.
    pub fn is_reliable(&self) -> bool {
        self.run_status() == RunStatus::Completed
    }

    /// Reason and time of an early end or a divergence; `None` if there is neither.
    pub fn stopped(&self) -> Option<StoppedRun> {
        StoppedRun::of(self.status).or_else(|| self.divergence.as_ref().map(StoppedRun::diverged))
    }
}

impl StoppedRun {
    /// A run that reaches its end but diverges.
    pub fn diverged(divergence: &Divergence) -> StoppedRun {
        StoppedRun { time_s: divergence.since_s(), status: RunStatus::Diverged, mode: None }
    }

    /// Early end by the status of the integration; `None` for a completed run.
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

/// One pass over a scenario.
pub(super) struct RunPass<'t> {
    pub(super) run: ScenarioRun,
    /// The table with the rows of the pass, still to be finished.
    pub(super) table: Option<RunTable<'t>>,
    /// The force at some times, N.
    force_n: Vec<f64>,
    /// Largest amplification of errors; `None` if none grew.
    amplification: Option<Amplification>,
}

impl RunPass<'_> {
    /// The part of the results by which passes are compared.
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

/// Simulates a scenario once, writes its rows into a table, if one is given, and records its
/// samples, if requested; `watch` is called with the simulated time at intervals.
pub(super) fn run<'t>(
    bench: &ControlledMachine,
    scenario: &Scenario,
    (prepared, measurements): (&PreparedScenario, &[Measurement]),
    (plan, table, output): (PassPlan, Option<RunTable<'t>>, &RunOutput<'_>),
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<RunPass<'t>, SimulateError> {
    let samples_per_row = if output.attention == Attention::Steps { 1 } else { samples_per_row(scenario) };
    let sample_interval_s = scenario.output_step / samples_per_row as f64;
    let (samples, full) = (RefCell::new(ControllerSamples::default()), Cell::new(false));
    let memory = RefCell::new(DigitalMemory::default());
    let mut steps = 0;
    let mut watch = |time_s: f64| {
        steps += 1;
        steps % STEPS_UNWATCHED != 0 || (!full.get() && watch(time_s))
    };
    let inputs = inputs(&bench.control, prepared);
    let drive = InputSchedule { duration_s: scenario.duration, output_step_s: sample_interval_s, inputs };
    let during = (prepared, scenario.settling_band_percent, scenario.duration);
    let looks = scenario.duration / sample_interval_s;
    let looking = RunObserver::new(bench, &samples, (table, samples_per_row), measurements, &full, during);
    let looking = looking.following(output.attention, looks);
    let looking = if output.samples { looking.keeping(looks + 2.0) } else { looking };
    let looking = if output.line_limits { looking } else { looking.without_line_limits() };
    let mut looking = if output.ledger { looking.accounting() } else { looking };
    let sampler = sampler(&bench.control, &prepared.waking, &samples, &memory);
    let observer: Watcher<'_> = Box::new(&mut looking);
    let task = Task { start: start(bench, prepared, plan), schedule: &drive, sampler, observer };
    let settings = SimulationSettings { tolerance: plan.tolerance, ..bench.settings };
    let named = |error| SimulateError::Simulation { name: scenario.name.clone(), error };
    let outcome = bench.control.drive(task, &settings, &mut watch).map_err(named)?;
    let seen = looking.finish()?;
    let occurrences = found((bench, prepared), &outcome, &samples.borrow(), &seen.exceeded);
    let outside_model_s = outside_model_s(&occurrences, bench.machine.has_end_stops());
    let memory = memory.into_inner();
    let memory = matches!(bench.control, Control::Sampled(_)).then_some(&memory);
    let end = saved::of_end(bench, prepared, (outcome.status, &outcome.end, scenario.duration), memory);
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
        samples_per_row,
        sample_interval_s,
        attention: output.attention,
        windows: prepared.windows.iter().copied().zip(seen.metrics).collect(),
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

/// Initial state of a pass: that of the scenario, or a copy perturbed by rounding errors.
fn start(bench: &ControlledMachine, prepared: &PreparedScenario, plan: PassPlan) -> Vec<f64> {
    let mut start = prepared.start.clone();
    if plan.moved {
        repetition::moved(&mut start, &bench.control.scales());
    }
    start
}

/// Sampler of a sampled controller, which stores the controller's final memory.
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

/// A scenario in the form that another solver needs: equations, inputs, and the state at time zero.
#[derive(Clone, Debug)]
pub struct ScenarioProblem {
    /// The machine, including the controller if it is continuous.
    pub control: Control,
    /// Duration, rows and inputs.
    pub schedule: InputSchedule,
    /// Values of all states and of all waves in transit.
    pub start: Vec<f64>,
}

impl ScenarioProblem {
    pub(super) fn of(bench: &ControlledMachine, scenario: &Scenario, prepared: &PreparedScenario) -> Self {
        let inputs = inputs(&bench.control, prepared);
        let (duration_s, output_step_s) = (scenario.duration, scenario.output_step);
        let start = prepared.start.clone();
        let schedule = InputSchedule { duration_s, output_step_s, inputs };
        ScenarioProblem { control: bench.control.clone(), schedule, start }
    }
}

/// Inputs of the loop, then those of its machine.
fn inputs(control: &Control, prepared: &PreparedScenario) -> Vec<Input> {
    let reference = Input::Value(prepared.reference.clone());
    let leading = match control {
        Control::Continuous(_) => vec![reference],
        Control::Sampled(_) => vec![Input::Command, reference],
        Control::Open(_) => vec![Input::Value(prepared.command.clone()), reference],
    };
    leading.into_iter().chain(prepared.machine_inputs()).collect()
}

/// All events of the run, including the limits of lines that were exceeded.
fn found(
    (bench, prepared): (&ControlledMachine, &PreparedScenario),
    outcome: &Outcome,
    samples: &ControllerSamples,
    exceeded: &[Exceeded],
) -> Vec<Occurrence> {
    let reference = prepared.reference.value(0.0);
    let leading = match &bench.control {
        Control::Continuous(_) => vec![reference],
        Control::Sampled(_) => vec![0.0, reference],
        Control::Open(_) => vec![prepared.command.value(0.0), reference],
    };
    let first = inputs_at_start(prepared, leading, &bench.control);
    let mut found = occurrences(&bench.control, &prepared.start, &first, &outcome.events);
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

/// Time at which a chamber, a line or a transmission first cavitates, a chamber has no volume, or
/// the piston leaves a stroke without end stops.
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

fn samples_per_row(scenario: &Scenario) -> usize {
    let wanted = (scenario.output_step / LONGEST_SAMPLE_INTERVAL_S).ceil().max(1.0);
    let rows = scenario.duration / scenario.output_step;
    wanted.min((MOST_SAMPLES / rows).floor().max(1.0)) as usize
}

/// The name of an [`Occurrence`] while the command is at its limit, in addition to the indicators
/// of a machine.
pub const COMMAND_LIMIT: &str = "command_limit";

/// Name, in a campaign, of a run whose errors may be visible although it was repeated; used with
/// the names of what a machine reports.
pub const ERRORS_AMPLIFIED: &str = "errors_amplified";

/// Name, in a campaign, of a run that was repeated until its metrics agreed.
pub const REPEATED: &str = "repeated";

/// Status of a run; an early end takes precedence.
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

/// Largest amplification of errors between the samples of a controller, or from one sample to the
/// next.
pub fn amplification(outcome: &Outcome, samples: &ControllerSamples) -> Option<Amplification> {
    Amplification::larger([outcome.amplification, samples.amplification])
}

/// Inputs at time zero: those of the loop, the ground, the external force, the setting, and the
/// waves in transit.
fn inputs_at_start(prepared: &PreparedScenario, mut first: Vec<f64>, control: &Control) -> Vec<f64> {
    first.extend([prepared.ground.value(0.0), prepared.ground.rate(0.0)]);
    first.extend(prepared.external_force.as_ref().map(|force| force.value(0.0)));
    let setting = prepared.setting_change.iter();
    first.extend(setting.flat_map(|setting| [setting.value(0.0), setting.rate(0.0)]));
    let [states, _] = control.size();
    first.extend(prepared.start.iter().skip(states));
    first
}

/// The events that exist from the start, and every change of an indicator. Indicators of the
/// machine are positive while nothing is wrong; that of the command limit is positive while the
/// limit is reached.
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
