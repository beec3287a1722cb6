//! The JSON objects of `simulate` and `compare`.

use serde::Serialize;

use super::MachineResponses;
use super::check::{self, CheckRow};
use super::frequency;
use super::metrics::MetricsRow;
use super::state_names;
use super::{
    BeyondExpansion, Cause, Exceeded, Metrics, Occurrence, Overlay, ScenarioComparison, ScenarioRun, Window,
};
use crate::answer;
use crate::project::Loaded;
use phea_dynamics::simulation::Amplification;

#[derive(Serialize)]
pub(crate) struct SimulateAnswer<'a> {
    scenarios: Vec<ScenarioRow<'a>>,
    /// Scenarios that were not begun, because the run was stopped.
    not_run: Vec<&'a str>,
}

#[derive(Serialize)]
struct ScenarioRow<'a> {
    name: &'a str,
    status: &'static str,
    /// When it ended before its time.
    ended_s: Option<f64>,
    ended_s_reason: Option<&'static str>,
    unresolved_mode: Option<ModeRow>,
    unresolved_mode_reason: Option<&'static str>,
    work: WorkRow,
    look_s: f64,
    /// Whether a stated command drives the valve, and no controller.
    open_loop: bool,
    /// Name of the file with the state at the end.
    state_file: Option<String>,
    state_file_reason: Option<&'static str>,
    events: Vec<EventAnswer<'a>>,
    occurrences: Vec<OccurrenceAnswer>,
    outside_model_s: Option<f64>,
    outside_model_s_reason: Option<&'static str>,
    measured: Vec<MeasuredRow<'a>>,
    errors_amplified: Option<AmplifiedRow>,
    errors_amplified_reason: Option<&'static str>,
    check: Option<CheckRow>,
    check_reason: Option<&'static str>,
    /// Chambers above the pressure that the expansion of their hose is stated at.
    beyond_expansion: Vec<BeyondRow>,
    /// Limits of the rig that the run goes beyond.
    exceeded: Vec<ExceededRow>,
}

#[derive(Serialize)]
struct ExceededRow {
    what: &'static str,
    limit: f64,
    peak: f64,
    peak_time_s: f64,
    first_time_s: f64,
}

#[derive(Serialize)]
struct BeyondRow {
    chamber: char,
    peak_pressure_pa: f64,
    stated_pressure_pa: f64,
}

#[derive(Serialize)]
struct MeasuredRow<'a> {
    file: &'a str,
    column: &'a str,
    signal: &'static str,
    rows: usize,
    rows_outside: usize,
    /// In the unit of the signal's name.
    rmse: Option<f64>,
    rmse_reason: Option<&'static str>,
    nrmse: Option<f64>,
    nrmse_reason: Option<&'static str>,
}

#[derive(Serialize)]
struct ModeRow {
    frequency_rad_per_s: f64,
    growth_per_s: f64,
}

#[derive(Serialize)]
struct AmplifiedRow {
    from_s: f64,
    until_s: f64,
    frequency_rad_per_s: f64,
}

#[derive(Serialize)]
struct WorkRow {
    steps: u64,
    rejected: u64,
    evaluations: u64,
}

#[derive(Serialize)]
struct EventAnswer<'a> {
    kind: &'static str,
    time_s: f64,
    until_s: f64,
    /// Before and after; of a step.
    reference_n: Option<[f64; 2]>,
    reference_n_reason: Option<&'static str>,
    command_v: Option<[f64; 2]>,
    command_v_reason: Option<&'static str>,
    metrics: MetricsRow<'a>,
}

#[derive(Serialize)]
struct OccurrenceAnswer {
    time_s: f64,
    kind: &'static str,
    begins: bool,
}

#[derive(Serialize)]
struct CompareBody<'a> {
    projects: Vec<ProjectRow<'a>>,
}

#[derive(Serialize)]
struct ProjectRow<'a> {
    path: &'a str,
    title: &'a str,
    project_sha256: &'a str,
    settings: &'a [String],
    catalogue_files: &'a [String],
    #[serde(flatten)]
    body: SimulateAnswer<'a>,
}

/// The JSON object of `simulate`.
pub(crate) fn json(loaded: &Loaded, runs: &[ScenarioRun]) -> String {
    answer::json("simulate", loaded, body(loaded, runs))
}

#[derive(Serialize)]
struct FrequencyBody<'a> {
    frequency_response: frequency::FrequencyAnswer<'a>,
    #[serde(flatten)]
    body: SimulateAnswer<'a>,
}

/// The JSON object of `simulate` where a frequency response is asked for: no scenario is run.
pub(crate) fn frequency_json(loaded: &Loaded, found: &MachineResponses) -> String {
    let (frequency_response, body) = (frequency::body(found), body(loaded, &[]));
    answer::json("simulate", loaded, FrequencyBody { frequency_response, body })
}

/// The JSON object of `compare`, in the envelope of the first project.
pub(crate) fn compare_json(comparison: &ScenarioComparison<'_>) -> String {
    let Some((first, _)) = comparison.projects.first() else { return String::new() };
    let rows = comparison.projects.iter().map(|(loaded, runs)| ProjectRow {
        path: &loaded.path,
        title: &loaded.project.title,
        project_sha256: &loaded.sha256,
        settings: &loaded.settings,
        catalogue_files: &loaded.catalogue_files,
        body: body(loaded, runs),
    });
    answer::json("compare", first, CompareBody { projects: rows.collect() })
}

/// What `simulate` says of a project.
pub(crate) fn body<'a>(loaded: &'a Loaded, runs: &'a [ScenarioRun]) -> SimulateAnswer<'a> {
    let declared = loaded.project.scenarios.iter().map(|scenario| scenario.name.as_str());
    let names = state_names(runs.iter().map(|run| run.name.as_str()));
    let rows = runs.iter().zip(names).map(|(run, name)| scenario(run, name));
    SimulateAnswer { scenarios: rows.collect(), not_run: declared.skip(runs.len()).collect() }
}

fn scenario(run: &ScenarioRun, state_file: String) -> ScenarioRow<'_> {
    let stopped = run.stopped();
    ScenarioRow {
        name: &run.name,
        status: stopped.map_or("completed", |stopped| stopped.word),
        ended_s: stopped.map(|stopped| stopped.time_s),
        ended_s_reason: stopped.is_none().then_some("it ran to its end"),
        unresolved_mode: stopped.and_then(|stopped| stopped.mode).map(|mode| ModeRow {
            frequency_rad_per_s: mode.frequency_rad_per_s,
            growth_per_s: mode.growth_per_s,
        }),
        unresolved_mode_reason: stopped
            .and_then(|stopped| stopped.mode)
            .is_none()
            .then_some("every mode that grew was resolved"),
        work: WorkRow {
            steps: run.work.steps,
            rejected: run.work.rejected,
            evaluations: run.work.evaluations,
        },
        look_s: run.look_s,
        open_loop: run.open_loop,
        state_file: run.end.is_ok().then_some(state_file),
        state_file_reason: run.end.as_ref().err().copied(),
        events: run.windows.iter().map(event).collect(),
        occurrences: run.occurrences.iter().map(occurrence).collect(),
        outside_model_s: run.outside_model_s,
        outside_model_s_reason: run.outside_model_s.is_none().then_some("its equations hold throughout"),
        measured: run.measured.iter().map(measured).collect(),
        errors_amplified: run.errors_amplified.map(amplified),
        errors_amplified_reason: run
            .errors_amplified
            .is_none()
            .then_some("no oscillation grew so much that errors within the tolerance may be visible"),
        check: run.check.as_ref().map(check::row),
        check_reason: run.check.is_none().then_some("it was not checked"),
        beyond_expansion: run.beyond_expansion.iter().map(beyond).collect(),
        exceeded: run.exceeded.iter().map(exceeded).collect(),
    }
}

fn exceeded(exceeded: &Exceeded) -> ExceededRow {
    let Exceeded { limit, limit_value, peak, peak_time_s, first_time_s } = *exceeded;
    ExceededRow { what: limit.word(), limit: limit_value, peak, peak_time_s, first_time_s }
}

fn amplified(grown: Amplification) -> AmplifiedRow {
    let Amplification { from_s, until_s, frequency_rad_per_s, .. } = grown;
    AmplifiedRow { from_s, until_s, frequency_rad_per_s }
}

fn beyond(beyond: &BeyondExpansion) -> BeyondRow {
    BeyondRow {
        chamber: beyond.chamber,
        peak_pressure_pa: beyond.peak_pa,
        stated_pressure_pa: beyond.stated_pa,
    }
}

fn measured(overlay: &Overlay) -> MeasuredRow<'_> {
    MeasuredRow {
        file: &overlay.file,
        column: &overlay.column,
        signal: overlay.signal,
        rows: overlay.times_s.len(),
        rows_outside: overlay.rows_outside,
        rmse: overlay.rmse.ok(),
        rmse_reason: overlay.rmse.err(),
        nrmse: overlay.nrmse.ok(),
        nrmse_reason: overlay.nrmse.err(),
    }
}

fn event((window, metrics): &(Window, Metrics)) -> EventAnswer<'_> {
    let reference_n = match window.cause {
        Cause::ReferenceStep { from_n, to_n } => Some([from_n, to_n]),
        _ => None,
    };
    let command_v = match window.cause {
        Cause::CommandStep { from_v, to_v } => Some([from_v, to_v]),
        _ => None,
    };
    EventAnswer {
        kind: window.cause.word(),
        time_s: window.start_s,
        until_s: window.end_s,
        reference_n,
        reference_n_reason: reference_n.is_none().then_some("the reference does not step"),
        command_v,
        command_v_reason: command_v.is_none().then_some("no open-loop command steps"),
        metrics: MetricsRow(metrics),
    }
}

fn occurrence(occurrence: &Occurrence) -> OccurrenceAnswer {
    OccurrenceAnswer { time_s: occurrence.time_s, kind: occurrence.kind, begins: occurrence.begins }
}
