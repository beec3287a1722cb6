//! Simulation of the nonlinear model under its controller, through the scenarios of a project.

mod adjusted;
mod bench;
mod check;
mod columns;
mod compare;
mod divergence;
mod equilibrium;
mod exceeded;
mod file_names;
mod files;
mod follower;
mod following;
mod force_limits;
mod foreseen;
mod frequency;
mod gas;
mod input_signal;
mod ledgers;
mod line_limits;
mod measured;
mod metric;
mod metrics;
mod motion_file;
mod plausible;
mod prepared_scenario;
mod record;
mod reference_step;
mod repetition;
mod required;
mod requirement;
mod run;
mod run_observer;
mod run_status;
mod saved;
pub(crate) mod shortest_number;
mod step_limits;
mod sum;
mod sums;
mod tally;
pub use file_names::{file_names, state_names};
pub use metrics::stays_settled;

pub use adjusted::AdjustmentWork;
pub use bench::ControlledMachine;
pub use check::{Difference, MetricDifferences, ToleranceCheck, simulate_checked};
pub use columns::SignalParts;
pub use compare::{ScenarioComparison, compare_projects};
pub use divergence::Divergence;
pub use equilibrium::MovingState;
pub use exceeded::{Exceeded, LINE_OCCURRENCES, LimitPlace, RigLimit};
pub use frequency::{
    FrequencyRequest, MachineResponse, MachineResponses, NoClosedLoop, ResponsePoint, frequency_response,
};
pub use gas::GasRange;

pub use ledgers::{AccountSum, NoLedger, RunLedger};
pub(crate) use line_limits::LineWatch;
pub use line_limits::{LAMINAR_UP_TO, LineLimits};
pub use measured::Overlay;
pub use metric::{Metric, PerMetric};
pub use metrics::{Cause, Measured, Metrics, Unmeasured, Window};
pub use record::{ControlSignals, Record, Sample};
pub use repetition::{
    Pass, PassAgreement, PassPlan, PassResult, PassSpread, Repetition, SMALLEST_TOLERANCE, moved, repeated,
};
use run::RunPass;
pub use run::{BeyondExpansion, Occurrence, ScenarioProblem, ScenarioRun, StoppedRun, UnresolvedMode};
pub use run::{COMMAND_LIMIT, ERRORS_AMPLIFIED, REPEATED, amplification};
pub(crate) use run::{outside_model_s, run_status};
pub use run_status::RunStatus;
pub use saved::{NotSaved, SavedState};

pub use bench::machine_of;
pub(crate) use file_names::table_names;
pub use files::{RunTable, files};
pub use follower::Follower;
pub use force_limits::ForceLimit;
pub use force_limits::{BeyondReach, ExceededForce, RestLimit, StepEnd};
pub(crate) use force_limits::{ForceLimits, steps_beyond};
pub use foreseen::{BeyondRig, Foreseen, foreseen, unreadable};
pub(crate) use prepared_scenario::{PreparedScenario, prepared_scenario_of};
pub use prepared_scenario::{ScenarioDrive, driven};
pub use reference_step::{ReferenceStep, SteppedReference, stepped_references};
pub(crate) use required::concerned;
pub use required::{NotJudged, ScenarioRequirement, concerns, required_of_run};
pub use requirement::{RequiredSteps, TimeRequirement, time_requirements};
pub use run::occurrences;
pub use step_limits::{NO_OVERSHOOT_PERCENT, ReachedStep, StepLimits};

use phea_dynamics::linear::LinearError;
use phea_dynamics::simulation::{Attention, EquilibriumError, ProfileError, SimulationError};
use phea_hydraulics::line::LineError;
use phea_hydraulics::machine::MachineError;
use phea_hydraulics::operating_point::OperatingPointError;

use crate::linear_loop::LoopError;
use crate::number_table::TableFormat;
use crate::project::{Refusal, Scenario};
use crate::quantity::{FORCE, LENGTH, MotionKind, RATIO, TIME, VOLTAGE, display};
use crate::rig::{OfMotion, RigError};
use crate::setup::ControlError;
use crate::setup::Setup;
use crate::source::{Destination, Source, WriteError};
use phea_dynamics::watch::{Progress, Watch};

/// Reason why a valid project is not simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulateError {
    /// The rig cannot be computed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The controller is not a transfer function.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// The project has no scenario.
    #[error(
        "there is nothing to simulate: the project has no [[scenario]]: add one, such as `name = \"step\"`, `duration = \"2 s\"` and `reference = {{ at = \"1 s\", force = \"1 kN\" }}`"
    )]
    NoScenario,
    /// The valve has no command.
    #[error(
        "nothing commands the valve: [controller] gives no transfer function, and a scenario states no `command`: add a [controller], such as `numerator = \"2e-4 s + 3e-3\"` and `denominator = \"s\"`, or drive open loop with `command = {{ at = \"1 s\", voltage = \"1 V\" }}` in the scenario"
    )]
    NoController,
    /// Controller, prefilter or sensor cannot be simulated in time.
    #[error("[controller], [prefilter] or [sensor]: {0}")]
    Loop(#[from] LinearError),
    /// The linear plant cannot be computed.
    #[error("the linear plant: {0}")]
    Plant(LinearError),
    /// The linear loop cannot be closed.
    #[error("the linear loop: {0}")]
    LinearLoop(#[from] LoopError),
    /// The load is in front of a wall but has no mass.
    #[error(
        "[load] model \"wall\" is simulated with the `mass` of what moves beyond the {}: none is stated",
        .0.words().load_cell
    )]
    LoadMass(MotionKind),
    /// The model of a line cannot describe it.
    #[error("[line] model: {0}")]
    Line(#[from] LineError),
    /// The machine is impossible.
    #[error("{0}")]
    Machine(OfMotion<MachineError>),
    /// A scenario cannot start.
    #[error("scenario \"{name}\": {error}")]
    Start {
        /// Name of the scenario.
        name: String,
        /// Fault of its start.
        error: OfMotion<MachineError>,
    },
    /// There is no operating point from which to search for an equilibrium.
    #[error(
        "scenario \"{name}\" states no `start`, and there is no operating point without {} at mid stroke: {error}",
        .error.motion.words().force
    )]
    Equilibrium {
        /// Name of the scenario.
        name: String,
        /// Reason why there is no operating point.
        error: OfMotion<OperatingPointError>,
    },
    /// There is no equilibrium to start from.
    #[error(
        "scenario \"{name}\" states no `start`, and the closed loop has no equilibrium at its reference of {}: where \
         all moves least, {} still moves by {rate:.2e} of its typical magnitude a second",
        display(*reference_n, motion.dimension(&FORCE), 6),
        what.words(*motion)
    )]
    NoRest {
        /// Motion of the rig.
        motion: MotionKind,
        /// Name of the scenario.
        name: String,
        /// Reference at time zero, N.
        reference_n: f64,
        /// State that moves.
        what: MovingState,
        /// Rate of its motion, 1/s.
        rate: f64,
    },
    /// There is an equilibrium, but none at which the piston of a linkage is at the required
    /// position.
    #[error(
        "scenario \"{name}\" states no `start`, and no position of the joint was found at which the closed loop rests at its reference \
         of {} with the piston at {}: state the `start`",
        display(*reference_n, &FORCE, 6), display(*position_m, &LENGTH, 4)
    )]
    NoRestThere {
        /// Name of the scenario.
        name: String,
        /// Reference at time zero, N.
        reference_n: f64,
        /// Position of the piston, m.
        position_m: f64,
    },
    /// The equilibrium needs a command beyond its limit.
    #[error(
        "scenario \"{name}\" states no `start`, and the equilibrium at its reference of {} needs a command of {}, beyond the limit of {}",
        display(*reference_n, motion.dimension(&FORCE), 6), display(*command_v, &VOLTAGE, 4), display(*limit_v, &VOLTAGE, 6)
    )]
    RestBeyondLimit {
        /// Motion of the rig.
        motion: MotionKind,
        /// Name of the scenario.
        name: String,
        /// Reference at time zero, N.
        reference_n: f64,
        /// Required command, V.
        command_v: f64,
        /// Limit of the command, V.
        limit_v: f64,
    },
    /// The search for an equilibrium does not fit the loop.
    #[error("scenario \"{name}\" states no `start`: {error}")]
    Rest {
        /// Name of the scenario.
        name: String,
        /// Mismatch of search and loop.
        error: EquilibriumError,
    },
    /// A reference or motion that is not a function of time.
    #[error("scenario \"{name}\": {error}")]
    Profile {
        /// Name of the scenario.
        name: String,
        /// Fault of the profile.
        error: ProfileError,
    },
    /// A file with a motion, a signal, a state or a measurement was rejected.
    #[error("{0}")]
    Motion(Box<Refusal>),
    /// The setting of an accumulator leaves its range.
    #[error(
        "scenario \"{name}\": its `setting_change` brings the setting of an accumulator to {} at {}, and a setting stays from 0 to \
         1: it is `adjustment.setting` and the `change` of every signal that has begun, one of which must be smaller",
        display(*setting, &RATIO, 4), display(*time_s, &TIME, 4)
    )]
    Setting {
        /// Name of the scenario.
        name: String,
        /// The setting, which is below 0 or above 1.
        setting: f64,
        /// Time, s.
        time_s: f64,
    },
    /// Start, input schedule or settings do not fit the machine.
    #[error("scenario \"{name}\": {error}")]
    Simulation {
        /// Name of the scenario.
        name: String,
        /// Mismatch of input and machine.
        error: SimulationError,
    },
    /// A table cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl SimulateError {
    /// Findings for a file that the project names and that was rejected, each with its place.
    pub fn refusal(&self) -> Option<&Refusal> {
        match self {
            SimulateError::Motion(report) => Some(report),
            _ => None,
        }
    }
}

/// Simulates the machine of a project through each of its scenarios, in file order. If `watch`
/// returns `false`, the current scenario ends there with its results so far, and no later one
/// begins.
///
/// # Errors
/// [`SimulateError`] if the project does not describe a machine with a controller and a scenario. A
/// failure during a run is in the status of its scenario.
pub fn simulate_project(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<Vec<ScenarioRun>, SimulateError> {
    simulate_into(source, setup, RunOutput::new(true, None), watch)
}

/// Output of runs in addition to their metrics and events.
#[derive(Clone, Copy)]
pub struct RunOutput<'a> {
    /// True if samples are stored in memory, for figures; otherwise the record is empty.
    pub samples: bool,
    /// Table of each scenario, `SCENARIO.csv` or `SCENARIO.parquet`, whose rows are written as they
    /// are computed: none is stored in memory, however many there are.
    pub table: Option<(&'a dyn Destination, TableFormat)>,
    /// True if the balances of oil and energy are recorded, which costs about as much as the
    /// solution.
    pub ledger: bool,
    /// Detail in which steps are evaluated: in full, or as in a campaign, whose runs under a
    /// sampled controller go from sample to sample by known matrices.
    pub attention: Attention,
    /// True if a run whose errors may be visible is [`repeated`].
    pub repeats: bool,
    /// True if the limits of lines are observed: their pressure, vacuum, flow and vapour.
    pub line_limits: bool,
}

impl<'a> RunOutput<'a> {
    /// Output of samples, and of a table if a destination is given.
    pub fn new(samples: bool, table: Option<(&'a dyn Destination, TableFormat)>) -> RunOutput<'a> {
        RunOutput {
            samples,
            table,
            ledger: false,
            attention: Attention::Everything,
            repeats: true,
            line_limits: true,
        }
    }
}

/// A scenario that is ready to be simulated, as often as needed.
struct PreparedRun<'p> {
    scenario: &'p Scenario,
    bench: ControlledMachine,
    prepared: PreparedScenario,
    measured: Vec<measured::Measurement>,
}

/// Prepares all scenarios of a project.
fn prepared<'p>(source: &dyn Source, setup: &Setup<'p>) -> Result<Vec<PreparedRun<'p>>, SimulateError> {
    let project = setup.project;
    if project.scenarios.is_empty() {
        return Err(SimulateError::NoScenario);
    }
    let prepare = |scenario: &'p Scenario| {
        let bench = ControlledMachine::of_scenario(setup, scenario)?;
        let prepared = prepared_scenario::prepared(source, project, &bench, scenario)?;
        let measured = measured::measurements(source, project, scenario).map_err(SimulateError::Motion)?;
        Ok(PreparedRun { scenario, bench, prepared, measured })
    };
    project.scenarios.iter().map(prepare).collect()
}

/// The scenarios of a project for another solver.
///
/// # Errors
/// The errors of [`simulate_project`].
pub fn scenario_problems(
    source: &dyn Source,
    setup: &Setup<'_>,
) -> Result<Vec<ScenarioProblem>, SimulateError> {
    let prepared = prepared(source, setup)?;
    let of = |one: &PreparedRun<'_>| ScenarioProblem::of(&one.bench, one.scenario, &one.prepared);
    Ok(prepared.iter().map(of).collect())
}

impl PreparedRun<'_> {
    /// Makes one pass, with its rows in a table of this name.
    fn pass<'t>(
        &self,
        plan: PassPlan,
        (output, name): (&RunOutput<'t>, &str),
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Result<RunPass<'t>, SimulateError> {
        let begin = |(destination, format)| RunTable::begin((destination, name), format, &self.bench);
        let table = output.table.filter(|_| !plan.moved).map(begin).transpose()?;
        run::run(&self.bench, self.scenario, (&self.prepared, &self.measured), (plan, table, output), watch)
    }
}

/// Simulates the machine of a project with the requested output: samples cost more than the
/// solution of the equations. A run whose errors may be visible is [`repeated`]; its table is that
/// of the last pass.
///
/// # Errors
/// The errors of [`simulate_project`], and [`SimulateError::Write`].
pub fn simulate_into(
    source: &dyn Source,
    setup: &Setup<'_>,
    output: RunOutput<'_>,
    watch: Watch<'_>,
) -> Result<Vec<ScenarioRun>, SimulateError> {
    let scenarios = &setup.project.scenarios;
    let prepared = prepared(source, setup)?;
    let whole: f64 = scenarios.iter().map(|scenario| scenario.duration).sum();
    let (mut before, mut runs) = (0.0, Vec::new());
    let ending = output.table.map_or("csv", |(_, format)| format.ending());
    let names = table_names(scenarios.iter().map(|scenario| scenario.name.as_str()), ending);
    for (prepared, name) in prepared.iter().zip(&names) {
        let tolerance = prepared.bench.settings.tolerance;
        let mut pass = |plan: PassPlan| {
            let stage = if plan.is_first(tolerance) { "simulating" } else { "repeating the run" };
            let mut watched = |time_s: f64| watch(Progress { stage, fraction: (before + time_s) / whole });
            prepared.pass(plan, (&output, name), &mut watched)
        };
        let first = pass(PassPlan { tolerance, moved: false })?;
        let errors_amplified = first.run.errors_amplified;
        let (last, repetition) = match output.repeats {
            true => {
                let (last, _, repetition) = repeated((tolerance, first), RunPass::result, pass)?;
                (last, repetition)
            }
            false => (first, None),
        };
        if let Some(table) = last.table {
            table.finish().map_err(SimulateError::Write)?;
        }
        let run = ScenarioRun { repetition, errors_amplified, ..last.run };
        let stopped = run.was_cancelled();
        runs.push(run);
        before += prepared.scenario.duration;
        if stopped {
            break;
        }
    }
    Ok(runs)
}
