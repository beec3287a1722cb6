//! The spread of numbers over the runs of a campaign.

use phea_engineering::campaign::{LUMP_NAMES, Plan, QUANTILES, Spread, Summary, meaningful};
use phea_engineering::simulate::{Cause, PerMetric, Window};

use crate::answer::{Answer, Reasoned};
use crate::quantity::QuantityName;
use crate::simulate::{SteppedAnswer, stepped};

/// Metrics of an event over the runs.
#[derive(Answer)]
pub(super) struct CampaignEventAnswer {
    /// Kind of the event.
    kind: Cause,
    /// Time of the event, from the start of the scenario.
    time_s: f64,
    /// Time of the next event, or the end of the scenario.
    until_s: f64,
    #[answer(flatten)]
    step: SteppedAnswer,
    /// Metrics that such an event can have.
    metrics: Vec<CampaignMetricAnswer>,
}

/// Metric over the runs.
#[derive(Answer)]
struct CampaignMetricAnswer {
    /// Name of the metric.
    name: QuantityName,
    #[answer(flatten)]
    spread: SpreadAnswer,
}

/// Parameter of the linear models of the drawn machines.
#[derive(Answer)]
pub(super) struct CampaignLumpAnswer {
    /// Name of the parameter: `hydraulic_stiffness`, `flow_gain` or `flow_pressure_coefficient`.
    name: &'static str,
    /// Bounds of the parameter in the family, from low to high.
    #[answer(interval)]
    bounds: Reasoned<[f64; 2]>,
    /// Number of runs whose machine is outside the bounds; null without bounds.
    outside: Option<usize>,
    #[answer(flatten)]
    spread: SpreadAnswer,
}

/// Distribution of a number over the runs that have one, in SI.
#[derive(Answer)]
struct SpreadAnswer {
    /// Number of runs that have one.
    count: usize,
    /// Number of runs that could have one and do not.
    missing: usize,
    /// Quantiles by `quantiles_percent`, interpolated linearly between two runs; null if no run has
    /// one.
    quantiles: Option<[f64; QUANTILES.len()]>,
    /// Least number; null if no run has one.
    minimum: Option<f64>,
    /// Greatest number; null if no run has one.
    maximum: Option<f64>,
    /// Number of largest magnitude; null if no run has one.
    worst: Option<WorstNumberAnswer>,
    /// Reason for the absence of the numbers; null if a run has one.
    reason: Option<&'static str>,
}

/// Number of largest magnitude over the runs.
#[derive(Answer)]
struct WorstNumberAnswer {
    /// Number in SI.
    value: f64,
    /// Index of the run, from 0.
    run: u64,
}

/// The metrics of each event.
pub(super) fn events(plan: &Plan, summary: &Summary) -> Vec<CampaignEventAnswer> {
    let windows = plan.windows().iter().zip(&summary.metrics);
    let event = |(window, spreads): (&Window, &PerMetric<Option<Spread>>)| CampaignEventAnswer {
        kind: window.cause,
        time_s: window.start_s,
        until_s: window.end_s,
        step: stepped(window),
        metrics: meaningful(window, plan.is_open_loop())
            .map(|metric| CampaignMetricAnswer {
                name: metric.quantity(),
                spread: spread(spreads[metric], summary.driven()),
            })
            .collect(),
    };
    windows.map(event).collect()
}

/// The parameters of the linear models.
pub(super) fn lumps(plan: &Plan, summary: &Summary) -> Vec<CampaignLumpAnswer> {
    let rows = LUMP_NAMES.into_iter().zip(summary.lumps).zip(summary.outside);
    rows.map(|((name, own), outside)| CampaignLumpAnswer {
        name,
        bounds: Reasoned::new(plan.bounds(name), "[uncertainty] does not name it"),
        outside,
        spread: spread(own, summary.statuses.iter().sum()),
    })
    .collect()
}

/// The distribution of a number that `runs` could have.
fn spread(spread: Option<Spread>, runs: usize) -> SpreadAnswer {
    let worst = spread.map(|spread| WorstNumberAnswer { value: spread.worst.0, run: spread.worst.1 });
    SpreadAnswer {
        count: spread.map_or(0, |spread| spread.count),
        missing: spread.map_or(runs, |spread| spread.missing),
        quantiles: spread.map(|spread| spread.quantiles),
        minimum: spread.map(|spread| spread.extremes[0]),
        maximum: spread.map(|spread| spread.extremes[1]),
        worst,
        reason: spread.is_none().then_some("no run has one"),
    }
}
