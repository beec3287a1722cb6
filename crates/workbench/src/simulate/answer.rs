//! The JSON objects of `simulate` and `compare`.

use super::MachineResponses;
use super::check;
use super::frequency;
use super::metrics::metrics_row;
use super::reasons::{no_ledger_words, not_saved_words, unmeasured_words};
use super::state_names;
use super::{
    AccountSum, Cause, Exceeded, Metrics, Overlay, RunLedger, ScenarioComparison, ScenarioRun, StoppedRun,
    Window,
};
use super::{repetition, required, required_of_run};
use crate::answer::{Describe, Object, body_in_use};
use crate::project::Loaded;
use crate::quantity::{FORCE, MotionKind, QuantityName};
use phea_dynamics::simulation::{Amplification, GrowthCause};

/// What `simulate` says to programs if a frequency response is requested: no scenario is run.
pub(crate) fn frequency_body(loaded: &Loaded, found: &MachineResponses) -> Object {
    Object::new().with("frequency_response", frequency::body(found)).and(body(loaded, &[]))
}

/// What `compare` says to programs.
pub(crate) fn comparison_body(comparison: &ScenarioComparison<'_>) -> Object {
    Object::new().each("projects", &comparison.projects, |(loaded, runs)| {
        Object::new()
            .with("path", loaded.path.as_str())
            .with("title", loaded.project.title.as_str())
            .with("project_sha256", loaded.sha256.as_str())
            .with("settings", loaded.settings.as_slice())
            .with("catalogue_files", loaded.catalogue_files.as_slice())
            .maybe("identified", loaded.recorded.as_ref().map(|recorded| body_in_use(recorded).into_json()))
            .and(body(loaded, runs))
    })
}

/// What `simulate` says of a project; scenarios are not run where the run was stopped before they
/// began.
pub(crate) fn body(loaded: &Loaded, runs: &[ScenarioRun]) -> Object {
    let names = state_names(runs.iter().map(|run| run.name.as_str()));
    let not_run = loaded.project.scenarios.iter().skip(runs.len());
    let scenarios = runs.iter().zip(names);
    let of = |(run, name)| {
        scenario(run, name).each("requirements", &required_of_run(&loaded.project, run), required::row)
    };
    Object::new().each("scenarios", scenarios, of).each("not_run", not_run, |scenario| scenario.name.as_str())
}

fn adjustment(run: &ScenarioRun) -> Object {
    Object::new()
        .told("adjustment_brought_j", run.adjustment.map(|of| of.brought_j).ok_or(NOT_ADJUSTED))
        .told("adjustment_taken_j", run.adjustment.map(|of| of.taken_j).ok_or(NOT_ADJUSTED))
        .told("gas_valve_throttled_j", run.adjustment.and_then(|of| of.throttled_j).ok_or(NO_GAS_VALVE))
        .each("gas", &run.gas, |gas| {
            Object::new()
                .with("chamber", gas.chamber)
                .with("peak_pressure_pa", gas.peak_pa)
                .told("temperature_least_ratio", gas.temperature_ratios.map(|[low, _]| low).ok_or(NO_HEAT))
                .told("temperature_peak_ratio", gas.temperature_ratios.map(|[_, high]| high).ok_or(NO_HEAT))
        })
}

const NOT_AMPLIFIED: &str = "no mode grew so much that errors within the tolerance may be visible";
const FOLLOWED: &str = "a deviation was carried along the run, or fewer than two steps pass a kink";
/// Reason why there is no work of an adjustment, or no temperature.
const NOT_ADJUSTED: &str = "no setting of an accumulator moves, and no valve leads to its gas";
const NO_GAS_VALVE: &str = "no valve lies between a chamber and its gas";
const NO_HEAT: &str = "a polytropic exponent gives no temperature: state `thermal_time_constant`";

fn scenario(run: &ScenarioRun, state_file: String) -> Object {
    let motion = run.record.units.motion;
    let mode = run.stopped().and_then(|stopped| stopped.mode).map(|mode| {
        Object::new()
            .with("frequency_rad_per_s", mode.frequency_rad_per_s)
            .with("growth_per_s", mode.growth_per_s)
    });
    let work = Object::new()
        .with("steps", run.work.steps)
        .with("rejected", run.work.rejected)
        .with("evaluations", run.work.evaluations);
    let amplified = run.errors_amplified.map(|grown| {
        Object::new()
            .with("from_s", grown.from_s)
            .with("until_s", grown.until_s)
            .told("frequency_rad_per_s", of_mode(&grown).ok_or("no single mode grows"))
            .with("growth_logarithm", grown.logarithm)
            .with("cause", repetition::cause_word(grown.cause))
    });
    let unfollowed = run.unfollowed.map(|kinks| {
        Object::new().with("steps", kinks.steps).with("cause", repetition::unfollowed_word(kinks.cause))
    });
    let repetition = run.repetition.as_ref().map(|repetition| repetition::row(repetition, motion));
    let divergence = run.divergence.as_ref().map(repetition::divergence_row);
    let ended_s = StoppedRun::of(run.status).map(|stopped| stopped.time_s);
    Object::new()
        .with("name", run.name.as_str())
        .with("status", run.run_status().key())
        .told("ended_s", ended_s.ok_or("it ran to its end"))
        .told("divergence", divergence.ok_or("it does not diverge"))
        .told("unresolved_mode", mode.ok_or("every mode that grew was resolved"))
        .with("work", work)
        .with("tolerance", run.tolerance)
        .with("look_s", run.look_s)
        .with("open_loop", run.open_loop)
        .told("state_file", run.end.as_ref().map(|_| state_file).map_err(|why| not_saved_words(*why)))
        .each("events", &run.windows, |one| event(one, motion))
        .each("occurrences", &run.occurrences, |occurrence| {
            Object::new()
                .with("time_s", occurrence.time_s)
                .with("kind", occurrence.kind)
                .with("begins", occurrence.begins)
        })
        .told("outside_model_s", run.outside_model_s.ok_or("its equations hold throughout"))
        .each("measured", &run.measured, |one| overlay(one, motion))
        .told("errors_amplified", amplified.ok_or(NOT_AMPLIFIED))
        .told("kinks_unfollowed", unfollowed.ok_or(FOLLOWED))
        .told("repetition", repetition.ok_or("one pass was enough"))
        .told("check", run.check.as_ref().map(|check| check::row(check, motion)).ok_or("it was not checked"))
        .each("beyond_expansion", &run.beyond_expansion, |beyond| {
            Object::new()
                .with("chamber", beyond.chamber)
                .with("peak_pressure_pa", beyond.peak_pa)
                .with("stated_pressure_pa", beyond.stated_pa)
        })
        .and(adjustment(run))
        .told(
            "ledgers",
            run.ledger.as_ref().map(|one| ledger(one, motion)).map_err(|why| no_ledger_words(*why)),
        )
        .each("exceeded", &run.exceeded, exceeded)
}

/// The frequency of the mode that grows.
fn of_mode(grown: &Amplification) -> Option<f64> {
    (grown.cause != GrowthCause::Motion).then_some(grown.frequency_rad_per_s)
}

/// A measured signal over the simulated one.
fn overlay(overlay: &Overlay, motion: MotionKind) -> Object {
    Object::new()
        .with("file", overlay.file.as_str())
        .with("column", overlay.column.as_str())
        .with("signal", overlay.signal.quantity())
        .with("rows", overlay.times_s.len())
        .with("rows_outside", overlay.rows_outside)
        .told("rmse", overlay.rmse.map_err(|why| unmeasured_words(why, motion)))
        .told("nrmse", overlay.nrmse.map_err(|why| unmeasured_words(why, motion)))
}

/// A limit of the rig that a run exceeds.
fn exceeded(exceeded: &Exceeded) -> Object {
    Object::new()
        .with("what", exceeded.limit.word())
        .with("limit", exceeded.limit_value)
        .with("peak", exceeded.peak)
        .with("peak_time_s", exceeded.peak_time_s)
        .with("first_time_s", exceeded.first_time_s)
        .told("place", exceeded.place.word().ok_or("it is a limit of the rig as a whole"))
        .told("distance_m", exceeded.place.distance_m().ok_or("it is not within a line"))
}

/// The accounts of oil and energy, each with how far it is from closing.
fn ledger(ledger: &RunLedger, motion: MotionKind) -> Object {
    let account = |sum: &AccountSum| {
        let part = if sum.part == "piston" { motion.words().piston } else { sum.part };
        Object::new()
            .with("part", part)
            .with("stored", sum.stored)
            .with("inflow", sum.inflow)
            .with("lost", sum.lost)
            .with("closing_error", sum.closing_error())
            .with("relative_error", sum.relative_error())
    };
    Object::new().each("oil_m3", &ledger.oil, account).each("energy_j", &ledger.energy, account)
}

fn event((window, metrics): &(Window, Metrics), motion: MotionKind) -> Object {
    let reference_n = match window.cause {
        Cause::ReferenceStep { from_n, to_n } => Ok([from_n, to_n]),
        _ => Err("the reference does not step"),
    };
    let command_v = match window.cause {
        Cause::CommandStep { from_v, to_v } => Ok([from_v, to_v]),
        _ => Err("no open-loop command steps"),
    };
    Object::new()
        .with("kind", window.cause.word())
        .with("time_s", window.start_s)
        .with("until_s", window.end_s)
        .told(QuantityName::moving("reference", &FORCE), reference_n)
        .told("command_v", command_v)
        .with("metrics", metrics_row(metrics, motion))
}
