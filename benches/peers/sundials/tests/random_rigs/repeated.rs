//! Runs in the form of a project's: at the default tolerance, repeated at smaller ones if errors
//! may be visible. All rows of the force and the metrics of each event are judged; an error above
//! one thousandth that the run does not report is a failure.
//!
//! ```text
//! rows      largest difference of the force over its peak; reported by every run that was repeated
//! metrics   compared between two passes; reported by every repetition except one whose passes agree
//! ```
//!
//! There is no truth if CVODE's results at 1e-11 and at 1e-13 differ by as much: a run must then
//! report that errors may be visible.

use std::time::Instant;

use phea_dynamics::simulation::{InputSchedule, Profile, SimulationSettings, Status, Task};
use phea_engineering::simulate::{
    Cause, Metrics, PassAgreement, PassPlan, PassResult, PassSpread, Repetition, Unmeasured, Window, moved,
    repeated,
};
use phea_machine::{Control as Loop, Watcher};

use crate::LARGEST_ERROR;
use crate::compare::{NewSampler, Ours, Rows, TOLERANCE, force_of};
use crate::rig::{OUTPUT_STEP_S, Rig};

/// Settling band of the force, percent of a step.
const BAND: f64 = 1.0;
const NONE: Unmeasured = Unmeasured::NoStep;

/// A run with its force at each row.
#[derive(Clone)]
pub(crate) struct Made {
    pub(crate) ours: Ours,
    pub(crate) force: Vec<f64>,
}

/// Runs one pass of phea.
pub(crate) fn made<'a>(
    rig: &Rig,
    system: &'a Loop,
    schedule: &InputSchedule,
    sampler: &NewSampler<'a>,
    plan: PassPlan,
) -> Made {
    let settings = SimulationSettings {
        tolerance: plan.tolerance,
        maximum_steps: 2_000_000,
        ..SimulationSettings::default()
    };
    let count = system.size()[0];
    let mut start = rig.beginning(count);
    if plan.moved {
        moved(&mut start, &system.scales());
    }
    let mut states = Vec::new();
    let observer: Watcher<'_> = Box::new(Rows { wanted: (0..count).collect(), states: &mut states });
    let task = Task { start, schedule, sampler: sampler(), observer };
    let begun = Instant::now();
    let outcome = system.drive(task, &settings, &mut |_| true);
    let seconds = begun.elapsed().as_secs_f64();
    let ours = Ours::new(&outcome.expect("a course that fits"), seconds);
    Made { ours, force: force_of(rig, &states) }
}

/// A run that was repeated because its errors may be visible.
#[derive(Debug)]
pub(crate) struct Judged {
    pub(crate) status: Status,
    pub(crate) repetition: Option<Repetition>,
    /// Largest difference from CVODE over all rows, as a fraction of the peak.
    pub(crate) of_rows: f64,
    /// Largest difference of a metric.
    pub(crate) of_metrics: Option<PassSpread>,
    /// Largest differences of rows and of metrics between CVODE's runs at two tolerances.
    pub(crate) of_truth: [f64; 2],
    pub(crate) steps: u64,
}

impl Judged {
    /// The run that a project would report, by `run`; compared with CVODE's force, the exact one
    /// first.
    pub(crate) fn of(rig: &Rig, run: &dyn Fn(PassPlan) -> Made, truths: [&[f64]; 2]) -> Judged {
        let windows = windows(rig);
        let metrics = |force: &[f64]| -> Vec<(Window, Metrics)> {
            windows.iter().map(|window| (*window, measured(window, &rig.reference, force))).collect()
        };
        let result = |force: &[f64], ours: Option<&Ours>| PassResult {
            status: ours.map_or(Status::Completed, |ours| ours.status),
            work: ours.map(|ours| ours.work).unwrap_or_default(),
            amplification: ours.and_then(|ours| ours.amplification),
            swings: false,
            metrics: metrics(force),
            force_n: force.to_vec(),
        };
        let first = run(PassPlan { tolerance: TOLERANCE, moved: false });
        let of = |made: &Made| result(&made.force, Some(&made.ours));
        let (last, _, repetition) =
            repeated((TOLERANCE, first), of, |plan| Ok::<_, ()>(run(plan))).expect("no pass is refused");
        let exact = result(truths[0], None);
        let part = |spread: Option<PassSpread>| spread.map_or(0.0, |spread| spread.part);
        let peak = truths[0].iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        let apart = |force: &[f64]| {
            let pairs = truths[0].iter().zip(force).map(|(one, other)| (one - other).abs());
            if force.len() == truths[0].len() { pairs.fold(0.0, f64::max) / peak } else { f64::INFINITY }
        };
        let steps = repetition.as_ref().map_or(last.ours.work.steps, Repetition::steps);
        Judged {
            status: last.ours.status,
            of_rows: apart(&last.force),
            of_metrics: exact.spread(&of(&last)),
            of_truth: [apart(truths[1]), part(exact.spread(&result(truths[1], None)))],
            repetition,
            steps,
        }
    }

    /// An error that is not reported.
    pub(crate) fn fault(&self) -> Option<String> {
        let reported = self.repetition.is_some();
        let agrees = |known: &Repetition| known.agreement == PassAgreement::Agreed;
        let claims = self.repetition.as_ref().is_none_or(agrees);
        let [rows_known, metrics_known] = self.of_truth.map(|part| part < LARGEST_ERROR);
        if self.status != Status::Completed {
            return Some(format!("{:?}, where CVODE goes on", self.status));
        }
        if self.of_rows >= LARGEST_ERROR && !reported {
            let known = if rows_known { "" } else { ", where CVODE differs from itself" };
            return Some(format!("an error of {:.1e} of the peak{known}, and no report of it", self.of_rows));
        }
        let error = self.of_metrics.filter(|error| error.part >= LARGEST_ERROR && metrics_known && claims)?;
        let agreed = if reported { "though two passes agree" } else { "and no report of it" };
        Some(format!(
            "event and metric {:?}: {:?} by CVODE, {:?} by phea, {agreed}",
            error.of, error.values[0], error.values[1]
        ))
    }
}

/// Windows, each from a step of the reference or a beginning of the ground's motion to the next.
fn windows(rig: &Rig) -> Vec<Window> {
    let end_s = rig.duration_s;
    let steps = rig.reference.breaks();
    let value = |time_s: f64| rig.reference.value(time_s);
    let mut begun: Vec<(f64, Cause)> = Vec::new();
    for time_s in steps {
        let [from_n, to_n] = [value(time_s - 1e-9), value(time_s)];
        begun.push((time_s, Cause::ReferenceStep { from_n, to_n }));
    }
    begun.extend(rig.ground.breaks().first().map(|time_s| (*time_s, Cause::LoadMotion)));
    begun.sort_by(|one, other| one.0.total_cmp(&other.0));
    let ends: Vec<f64> = begun.iter().skip(1).map(|(time_s, _)| *time_s).chain([end_s]).collect();
    begun.into_iter().zip(ends).map(|((start_s, cause), end_s)| Window { cause, start_s, end_s }).collect()
}

/// Metrics from rows, with linear interpolation.
fn measured(window: &Window, reference: &Profile, force: &[f64]) -> Metrics {
    let row = |time_s: f64| (time_s / OUTPUT_STEP_S).round() as usize;
    let (first, end) = (row(window.start_s), (row(window.end_s) + 1).min(force.len()));
    let wanted = reference.value(window.start_s);
    let inside = force.get(first..end).unwrap_or_default();
    let deviation = |force: &f64| (force - wanted).abs();
    let late = &inside[inside.len() * 9 / 10..];
    let error = late.iter().map(|force| wanted - force).sum::<f64>() / late.len().max(1) as f64;
    let (mut overshoot, mut peak, mut step) = (Err(NONE), Err(NONE), wanted.abs());
    match window.cause {
        Cause::ReferenceStep { from_n, to_n } => {
            step = (to_n - from_n).abs();
            let beyond = inside.iter().map(|force| (force - to_n) / (to_n - from_n));
            overshoot = Ok(100.0 * beyond.fold(0.0, f64::max));
        }
        _ => peak = Ok(inside.iter().map(deviation).fold(0.0, f64::max)),
    }
    let band = 0.01 * BAND * step;
    let outside = inside.iter().rposition(|force| deviation(force) > band);
    let settling = match outside {
        None => Ok(0.0),
        Some(last) if last + 1 < inside.len() => {
            let [before, after] = [last, last + 1].map(|place| deviation(&inside[place]));
            Ok(OUTPUT_STEP_S * (last as f64 + (before - band) / (before - after)))
        }
        Some(_) => Err(NONE),
    };
    Metrics {
        overshoot_percent: overshoot,
        rise_time_s: Err(NONE),
        settling_time_s: settling,
        settling_band_percent: BAND,
        disturbance_peak_n: peak,
        tracking_error_peak_n: Err(NONE),
        force_peak_n: Err(NONE),
        steady_state_error_n: Ok(error),
        control_peak_v: Err(NONE),
        control_rms_v: Err(NONE),
    }
}
