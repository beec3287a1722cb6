//! The JSON object of `campaign`.

use std::collections::BTreeMap;

use serde::Serialize;

use super::RequestedRuns;
use super::{Bands, Summary};
use super::{Draw, Plan};
use super::{LUMP_NAMES, METRIC_NAMES, STATUS_WORDS, meaningful};
use super::{QUANTILES, Spread};
use crate::answer;
use crate::project::Loaded;
use crate::simulate::{self, ScenarioRun};

#[derive(Serialize)]
struct CampaignAnswer<'a> {
    scenario: &'a str,
    seed: u32,
    runs: RunsRow,
    complete: bool,
    parameters: Vec<ParameterRow<'a>>,
    statuses: BTreeMap<&'static str, usize>,
    refused: Vec<RefusedRow<'a>>,
    ended: Vec<EndedRow>,
    occurrences: Vec<CampaignOccurrenceAnswer>,
    quantiles_percent: [u8; 5],
    metrics: Vec<CampaignEventAnswer>,
    lumps: Vec<LumpRow>,
    bands: BandsRow<'a>,
    worst_runs: Vec<WorstRow>,
}

/// Runs are counted from 0; `until` is beyond the last.
#[derive(Serialize)]
struct RunsRow {
    asked: u64,
    from: u64,
    until: u64,
    rows: usize,
}

#[derive(Serialize)]
struct ParameterRow<'a> {
    path: &'a str,
    distribution: &'static str,
    minimum: f64,
    maximum: f64,
}

#[derive(Serialize)]
struct RefusedRow<'a> {
    run: u64,
    reason: &'a str,
}

#[derive(Serialize)]
struct EndedRow {
    run: u64,
    status: &'static str,
    time_s: f64,
}

#[derive(Serialize)]
struct CampaignOccurrenceAnswer {
    kind: &'static str,
    runs: usize,
    first_run: u64,
}

#[derive(Serialize)]
struct CampaignEventAnswer {
    kind: &'static str,
    time_s: f64,
    until_s: f64,
    metrics: Vec<CampaignMetricAnswer>,
}

#[derive(Serialize)]
struct CampaignMetricAnswer {
    name: &'static str,
    #[serde(flatten)]
    spread: SpreadRow,
}

/// Absent numbers say why.
#[derive(Serialize)]
struct SpreadRow {
    count: usize,
    missing: usize,
    quantiles: Option<[f64; 5]>,
    minimum: Option<f64>,
    maximum: Option<f64>,
    worst: Option<WorstValue>,
    reason: Option<&'static str>,
}

#[derive(Serialize)]
struct WorstValue {
    value: f64,
    run: u64,
}

#[derive(Serialize)]
struct LumpRow {
    name: &'static str,
    /// Bounds of the uncertain parameter, where the project states them.
    bounds: Option<[f64; 2]>,
    bounds_reason: Option<&'static str>,
    /// Runs whose machine is outside those bounds.
    outside: Option<usize>,
    #[serde(flatten)]
    spread: SpreadRow,
}

#[derive(Serialize)]
struct BandsRow<'a> {
    time_s: &'a [f64],
    /// A list for each quantile.
    force_n: Vec<Vec<f64>>,
}

#[derive(Serialize)]
struct WorstRow {
    run: u64,
    of: Vec<String>,
    settings: Vec<String>,
}

#[derive(Serialize)]
struct RunBody<'a> {
    scenario: &'a str,
    seed: u32,
    run: u64,
    run_settings: &'a [String],
    #[serde(flatten)]
    body: simulate::SimulateAnswer<'a>,
}

const NO_RUN: &str = "no run has one";

/// The JSON object of a campaign.
pub(crate) fn json(
    loaded: &Loaded,
    plan: &Plan,
    wanted: RequestedRuns,
    rows: usize,
    summary: &Summary,
) -> String {
    let runs = wanted.shard.runs_of(wanted.runs);
    let body = CampaignAnswer {
        scenario: plan.scenario(),
        seed: plan.seed(),
        complete: rows as u64 == runs.end - runs.start,
        runs: RunsRow { asked: wanted.runs, from: runs.start, until: runs.end, rows },
        parameters: parameters(plan),
        statuses: STATUS_WORDS.into_iter().zip(summary.statuses).collect(),
        refused: summary.refused.iter().map(|(run, reason)| RefusedRow { run: *run, reason }).collect(),
        ended: summary.ended.iter().map(|&(run, status, time_s)| EndedRow { run, status, time_s }).collect(),
        occurrences: summary
            .occurrences
            .iter()
            .map(|&(kind, runs, first_run)| CampaignOccurrenceAnswer { kind, runs, first_run })
            .collect(),
        quantiles_percent: QUANTILES,
        metrics: events(plan, summary),
        lumps: lumps(plan, summary),
        bands: bands_row(&summary.bands),
        worst_runs: worst_runs(plan, summary),
    };
    answer::json("campaign", loaded, body)
}

/// The JSON object of one run.
pub(crate) fn run_json(
    loaded: &Loaded,
    (plan, draw): (&Plan, &Draw),
    settings: &[String],
    (drawn, runs): (&Loaded, &[ScenarioRun]),
) -> String {
    let body = RunBody {
        scenario: plan.scenario(),
        seed: plan.seed(),
        run: draw.run,
        run_settings: settings,
        body: simulate::body(drawn, runs),
    };
    answer::json("campaign", loaded, body)
}

fn parameters(plan: &Plan) -> Vec<ParameterRow<'_>> {
    let rows = plan.ranges().iter().map(|range| ParameterRow {
        path: &range.path,
        distribution: range.distribution_word(),
        minimum: range.minimum,
        maximum: range.maximum,
    });
    rows.collect()
}

fn events(plan: &Plan, summary: &Summary) -> Vec<CampaignEventAnswer> {
    let windows = plan.windows().iter().zip(&summary.metrics);
    windows
        .map(|(window, spreads)| CampaignEventAnswer {
            kind: window.cause.word(),
            time_s: window.start_s,
            until_s: window.end_s,
            metrics: meaningful(window, plan.is_open_loop())
                .map(|metric| CampaignMetricAnswer {
                    name: METRIC_NAMES[metric],
                    spread: spread_row(spreads[metric], summary.driven()),
                })
                .collect(),
        })
        .collect()
}

/// Of so many runs that could have such a number.
fn spread_row(spread: Option<Spread>, runs: usize) -> SpreadRow {
    SpreadRow {
        count: spread.map_or(0, |spread| spread.count),
        missing: spread.map_or(runs, |spread| spread.missing),
        quantiles: spread.map(|spread| spread.quantiles),
        minimum: spread.map(|spread| spread.extremes[0]),
        maximum: spread.map(|spread| spread.extremes[1]),
        worst: spread.map(|spread| WorstValue { value: spread.worst.0, run: spread.worst.1 }),
        reason: spread.is_none().then_some(NO_RUN),
    }
}

fn lumps(plan: &Plan, summary: &Summary) -> Vec<LumpRow> {
    let rows = LUMP_NAMES.iter().zip(summary.lumps).zip(summary.outside);
    rows.map(|((name, spread), outside)| {
        let bounds = plan.bounds(name);
        LumpRow {
            name,
            bounds,
            bounds_reason: bounds.is_none().then_some("[uncertainty] does not name it"),
            outside,
            spread: spread_row(spread, summary.statuses.iter().sum()),
        }
    })
    .collect()
}

fn bands_row(bands: &Bands) -> BandsRow<'_> {
    let one = |quantile: usize| bands.force_n.iter().map(|forces| forces[quantile]).collect();
    BandsRow { time_s: &bands.times_s, force_n: (0..QUANTILES.len()).map(one).collect() }
}

fn worst_runs(plan: &Plan, summary: &Summary) -> Vec<WorstRow> {
    let name = |(window, metric): &(usize, usize)| format!("event {} {}", window + 1, METRIC_NAMES[*metric]);
    let row = |worst: &super::WorstRun| WorstRow {
        run: worst.run,
        of: worst.of.iter().map(name).collect(),
        settings: plan.settings(&plan.draw(worst.run)),
    };
    summary.worst.iter().map(row).collect()
}
