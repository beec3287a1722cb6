//! Figures of a campaign: the bands of the force over time, with the worst run in them.

use phea_engineering::campaign::{CampaignError, Effort, Plan, QUANTILES, Row, Summary};
use phea_engineering::simulate::{Cause, Metric, Window};

use crate::answer::{OutputFile, picture_files};
use crate::figure::{FanChart, Figure, TimeBand, TimeSeries, Words};
use crate::over_time::measured_force;
use crate::simulate::{around, cause_words};

/// The bands over the whole scenario, and around each event; empty if no run was driven.
///
/// # Errors
/// Errors of [`Plan::forces`].
pub(crate) fn pictures(plan: &Plan, summary: &Summary) -> Result<Vec<Figure>, CampaignError> {
    let end = summary.bands.times_s.last().copied().unwrap_or(0.0);
    let words = Words::new(
        "campaign-bands",
        format!("Campaign: {}", plan.scenario()),
        "Half of all runs are in the darker band, nine in ten in the lighter one, at each time.",
    );
    if summary.bands.times_s.len() < 2 {
        return Ok(vec![]);
    }
    let mut figures = vec![picture(&words, plan, summary, [0.0, end], None)];
    let windows = plan.windows().iter().enumerate();
    for (index, window) in windows.filter(|(_, window)| window.start_s < end) {
        let words = Words::new(
            format!("campaign-bands-event-{}", index + 1),
            format!("Enlarged: {}", cause_words(window, plan.units())),
            format!(
                "The bands around what begins it, and the run with the worst {}.",
                worst_metric(window, plan).1
            ),
        );
        let span = around(window.start_s, after_s(summary, index), end);
        figures.push(picture(&words, plan, summary, span, worst_series(plan, summary, index)?));
    }
    Ok(figures)
}

/// Time shown of the slowest run, in settling times, and time shown of an event without one, s.
const SETTLING_TIMES: f64 = 2.0;
const AFTER_S: f64 = 0.5;

/// Time of a window that is shown.
fn after_s(summary: &Summary, index: usize) -> f64 {
    let spread = summary.metrics.get(index).and_then(|spreads| spreads[Metric::SettlingTime]);
    spread.map_or(AFTER_S, |spread| SETTLING_TIMES * spread.worst.0)
}

/// The metric by which a window's worst run is chosen, and the words for it.
fn worst_metric(window: &Window, plan: &Plan) -> (Metric, &'static str) {
    let force = plan.motion().words().force;
    match window.cause {
        _ if plan.is_open_loop() => (Metric::ForcePeak, force),
        Cause::ReferenceStep { .. } => (Metric::Overshoot, "overshoot"),
        Cause::ReferenceMotion { .. } => (Metric::TrackingErrorPeak, "tracking error"),
        Cause::CommandStep { .. } | Cause::CommandMotion { .. } => (Metric::ForcePeak, force),
        Cause::LoadMotion | Cause::ExternalForce { .. } | Cause::SettingChange => {
            (Metric::DisturbancePeak, "disturbance")
        }
    }
}

/// The complete force of a window's worst run.
fn worst_series(plan: &Plan, summary: &Summary, index: usize) -> Result<Option<TimeSeries>, CampaignError> {
    let metric = plan.windows().get(index).map(|window| worst_metric(window, plan).0);
    let spread = metric.and_then(|metric| summary.metrics.get(index)?[metric]);
    let Some((_, run)) = spread.map(|spread| spread.worst) else { return Ok(None) };
    let forces = plan.forces(run..run + 1, Effort { lanes: false, threads: 1 })?;
    let values = forces.into_iter().next().unwrap_or_default();
    Ok(Some(TimeSeries { name: format!("run {run}"), times_s: plan.times_s.clone(), values }))
}

fn picture(
    words: &Words,
    plan: &Plan,
    summary: &Summary,
    span_s: [f64; 2],
    worst: Option<TimeSeries>,
) -> Figure {
    let bands = &summary.bands;
    let series = |quantile: usize| TimeSeries {
        name: format!("{} %", QUANTILES[quantile]),
        times_s: bands.times_s.clone(),
        values: bands.force_n.iter().map(|forces| forces[quantile]).collect(),
    };
    let reference = (!plan.is_open_loop()).then(|| TimeSeries {
        name: "reference".to_string(),
        times_s: plan.times_s.clone(),
        values: plan.reference_n.clone(),
    });
    let inside = |window: &&Window| window.start_s >= span_s[0] && window.start_s <= span_s[1];
    let event = |window: &Window| (window.start_s, window.cause.label(plan.motion()).to_string());
    FanChart {
        quantity: measured_force(plan.motion()),
        unit: plan.units().force,
        bands: vec![
            TimeBand { name: "90 % of the runs".to_string(), lower: series(0), upper: series(4) },
            TimeBand { name: "50 % of the runs".to_string(), lower: series(1), upper: series(3) },
        ],
        middle: TimeSeries { name: "median".to_string(), ..series(2) },
        single: worst,
        reference,
        events: plan.windows().iter().filter(inside).map(event).collect(),
        span_s,
    }
    .draw(words)
}

/// The table for other programs and the figures.
///
/// # Errors
/// [`CampaignError`].
pub(crate) fn files(
    plan: &Plan,
    rows: &[Row],
    summary: &Summary,
) -> Result<Vec<OutputFile>, crate::error::CommandError> {
    let rows = plan.parquet(rows).map_err(CampaignError::RowStore)?;
    let mut files = vec![OutputFile::new("runs.parquet", rows)];
    files.extend(picture_files(&pictures(plan, summary)?));
    Ok(files)
}
