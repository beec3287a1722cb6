//! The chapter on the machine with numbers that deviate from those of the project: bands over time,
//! and the worst runs.

use phea_dynamics::watch::{Stopped, Watch};
use phea_engineering::campaign::{
    CampaignError, Effort, Plan, QUANTILES, RequestedRuns, Row, Spread, Summary, VariedRange, WorstRun,
    campaign,
};
use phea_engineering::simulate::{Cause, Metric, PerMetric, Window};

use super::chapter::Chapter;
use crate::answer::significant;
use crate::campaign::{beyond_box, counted, left_out, lumps, metrics, pictures, requirement};
use crate::document::{Cell, Document, StatusMark, Table};
use crate::error::CommandError;
use crate::figure::Figure;
use crate::grouped::grouped;
use crate::project::{Distribution, Loaded};
use crate::simulate::{cause_words, shown_in, status_words};
use crate::source::Source;

/// Number of runs if the project states none, and their seed.
const RUNS: u64 = 200;
const SEED: u32 = 1;
/// Runs from which the work of all is estimated.
const PILOT_RUNS: u64 = 8;
/// Steps of the integration that all runs together may take: a minute or two.
const BUDGET_STEPS: u64 = 10_000_000;

/// Number of worst runs whose numbers are printed.
const WORST: usize = 4;

/// Significant digits of the numbers in the tables: an answer has all of them.
const DIGITS: usize = 3;

/// The chapter, and its summary in a few words.
pub(super) struct CampaignChapter {
    pub(super) chapter: Chapter,
    pub(super) fact: Option<(&'static str, String)>,
    /// Every step of the reference in a run that was completed.
    pub(super) steps: Vec<CampaignStep>,
}

/// A step of the reference in a run.
pub(super) struct CampaignStep {
    pub(super) run: u64,
    /// Beginning of the step and its cause.
    pub(super) window: Window,
    /// Overshoot, percent of the step.
    pub(super) overshoot_percent: Option<f64>,
    /// Settling time, s; infinite if the step does not settle.
    pub(super) settling_time_s: f64,
    /// Rise time from 10 to 90 percent, s; infinite if the step does not rise that far.
    pub(super) rise_time_s: f64,
    /// The band of the settling time, percent of the step.
    pub(super) band_percent: f64,
}

/// The campaign of a report, under its own controller or the designed one; `None` for a project
/// without `[campaign]`.
///
/// # Errors
/// [`CommandError::Stopped`] if the watch stops it.
pub(super) fn driven(
    source: &dyn Source,
    (loaded, is_designed): (&Loaded, bool),
    watch: Watch<'_>,
) -> Result<Option<CampaignChapter>, CommandError> {
    if loaded.project.campaign.is_none() {
        return Ok(None);
    }
    let anchor = "campaign";
    let title = match is_designed {
        true => "Campaign: simulations with drawn numbers, designed controller",
        false => "Campaign: simulations with drawn numbers",
    };
    let requested =
        loaded.project.campaign.as_ref().and_then(|campaign| campaign.runs).map_or(RUNS, u64::from);
    let mut simulated = || -> Result<_, CampaignError> {
        let plan = Plan::new(source, loaded, SEED)?;
        let of = |runs: u64| RequestedRuns { runs, effort: Effort::on_all_cores() };
        let pilot = campaign(&plan, of(requested.min(PILOT_RUNS)), None, watch)?;
        let runs = within_budget(requested, &pilot);
        let rows = campaign(&plan, of(runs), None, watch)?;
        let summary = Summary::of(&plan, &rows);
        let figures = pictures(&plan, &summary)?;
        let steps = steps(loaded, &plan, &rows);
        let missing = (rows.len() as u64) < runs;
        Ok((plan, (runs, missing), (summary, steps), figures))
    };
    let (document, fact, steps) = match simulated() {
        Err(error) => {
            let mut out = Document::default();
            out.verdict(StatusMark::Bad, format!("Not simulated: {error}"), vec![]);
            (out, None, vec![])
        }
        Ok((_, (_, true), _, _)) => return Err(Stopped.into()),
        Ok((plan, (runs, _), (summary, steps), figures)) => {
            let words = words(runs, &plan, &summary);
            (document([runs, requested], &plan, &summary, figures), Some(("Campaign", words)), steps)
        }
    };
    Ok(Some(CampaignChapter { chapter: Chapter::of(anchor, title, document), fact, steps }))
}

fn within_budget(requested: u64, pilot: &[Row]) -> u64 {
    let steps: u64 = pilot.iter().filter_map(Row::ran).map(|ran| ran.steps).sum();
    runs_within_budget(requested, [pilot.len() as u64, steps])
}

/// Number of the requested runs that fits the report's budget of integration steps, estimated from
/// the first runs and their steps.
pub fn runs_within_budget(requested: u64, [made, steps]: [u64; 2]) -> u64 {
    match made.saturating_mul(BUDGET_STEPS).checked_div(steps) {
        Some(most) => requested.min(most.max(made)),
        None => requested,
    }
}

/// Overshoot and settling of every step of the reference, run by run.
fn steps(loaded: &Loaded, plan: &Plan, rows: &[Row]) -> Vec<CampaignStep> {
    let scenario = loaded.project.scenarios.iter().find(|one| one.name == plan.scenario());
    let band_percent = scenario.map_or(f64::NAN, |one| one.settling_band_percent);
    let completed = rows.iter().filter_map(|row| Some((row.run, row.ran()?)));
    completed
        .filter(|(_, ran)| ran.end_time_s.is_none())
        .flat_map(|(run, ran)| ran.metrics.iter().zip(plan.windows()).map(move |own| (run, own)))
        .filter(|(_, (_, window))| matches!(window.cause, Cause::ReferenceStep { .. }))
        .map(|(run, (numbers, window))| CampaignStep {
            run,
            window: *window,
            overshoot_percent: numbers[Metric::Overshoot],
            settling_time_s: numbers[Metric::SettlingTime].unwrap_or(f64::INFINITY),
            rise_time_s: numbers[Metric::RiseTime].unwrap_or(f64::INFINITY),
            band_percent,
        })
        .collect()
}

/// Metrics of an event that a reader wants first; the first of these that the event has are shown.
const SUMMARY_METRICS: [Metric; 4] =
    [Metric::DisturbancePeak, Metric::SettlingTime, Metric::TrackingErrorPeak, Metric::ForcePeak];
/// Number of events in the summary.
const SUMMARY_EVENTS: usize = 2;

/// The number of completed runs, and the range of most of them in the first events.
fn words(runs: u64, plan: &Plan, summary: &Summary) -> String {
    let mut parts = vec![format!("{} of {runs} runs completed", summary.statuses[0])];
    let units = plan.units();
    let windows = plan.windows().iter().zip(&summary.metrics);
    let of_window = |(window, spreads): (&Window, &PerMetric<Option<Spread>>)| {
        let metric = SUMMARY_METRICS.into_iter().find(|metric| spreads[*metric].is_some())?;
        let unit = shown_in(metric, units);
        let [low, .., high] = spreads[metric]?.quantiles.map(|value| unit.number(value, DIGITS));
        Some(format!(
            "{}: {} {low} to {high} {}",
            cause_words(window, units),
            metric.label(units.motion),
            unit.symbol
        ))
    };
    parts.extend(windows.filter_map(of_window).take(SUMMARY_EVENTS));
    let [least, .., most] = QUANTILES;
    format!("{} ({least}th to {most}th percentile)", parts.join("; "))
}

fn document([runs, requested]: [u64; 2], plan: &Plan, summary: &Summary, figures: Vec<Figure>) -> Document {
    let completed = summary.statuses[0];
    let (scenario, seed) = (plan.scenario(), plan.seed());
    let mut out = Document::default();
    out.explanation(format!("{runs} runs of the scenario `{scenario}`, seed {seed}, with the numbers below drawn anew for each, independently of each other: {completed} were completed."));
    out.explanations(left_out(plan));
    out.explanations((runs < requested).then(|| format!("{requested} runs were requested: these are as many as a report makes within its budget of {BUDGET_STEPS} steps of the integration. `phea campaign PROJECT.toml --seed {seed} --runs {requested}` makes all of them.")));
    let refused = summary.refused.first().map(|(run, reason)| {
        format!("{} draws do not give a machine, the first is run {run}: {reason}.", summary.refused.len())
    });
    let ended = summary.early_ends.iter().take(WORST).map(|(run, status, time_s)| {
        format!("Run {run} ended at {} s: {}.", significant(*time_s, 4), status_words(*status))
    });
    let occurred = summary.occurrences.iter().map(|(kind, count, first)| {
        format!("{} in {}, the first is run {first}.", kind.replace('_', " "), counted(*count))
    });
    out.explanations(refused.into_iter().chain(ended).chain(occurred));
    out.sentences(summary.requirements.iter().map(requirement));
    out.figures(figures);
    out.heading("Metrics over the runs");
    out.explanation("Each column gives the value below which that share of the runs lies; the worst is the value of largest magnitude. Runs without a value are counted next to the name.");
    out.table(metrics(plan, summary));
    out.heading("Linear models that were visited");
    out.explanation("Stiffness, flow gain and flow-pressure coefficient do not exist in the nonlinear simulation: these are those of its linear model at the operating point, for each draw, next to the box for which the controller is judged.");
    out.table(lumps(plan, summary));
    out.sentences(beyond_box(plan));
    worst(&mut out, plan, summary);
    drawn(&mut out, plan, summary);
    out
}

/// The runs that are worst in most.
fn worst_runs(summary: &Summary) -> Vec<&WorstRun> {
    let mut runs: Vec<&WorstRun> = summary.worst.iter().collect();
    runs.sort_by_key(|worst| std::cmp::Reverse(worst.of.len()));
    runs.truncate(WORST);
    runs
}

fn worst(out: &mut Document, plan: &Plan, summary: &Summary) {
    let runs = worst_runs(summary);
    out.heading("Worst runs");
    out.explanations(runs.first().map(|first| {
        format!("A run follows from seed and index: `phea campaign PROJECT.toml --seed {} --run {}` simulates it again and prints all that happens in it, with its numbers to their last digit.", plan.seed(), first.run)
    }));
    let row = |worst: &&WorstRun| [worst.run.to_string(), worst_in(plan, worst)];
    out.table(Table::new(["run", "worst in"]).with(runs.iter().map(row)));
}

/// Event by event, the metrics in which a run is worst, without their units.
fn worst_in(plan: &Plan, worst: &WorstRun) -> String {
    let of_window = |(index, window)| {
        let of = worst
            .of
            .iter()
            .filter(|(place, _)| *place == index)
            .map(|(_, metric)| metric.label(plan.motion()));
        let of: Vec<&str> = of.collect();
        (!of.is_empty()).then(|| format!("{}: {}", cause_words(window, plan.units()), of.join(", ")))
    };
    plan.windows().iter().enumerate().filter_map(of_window).collect::<Vec<_>>().join("; ")
}

/// Every drawn number: its distribution, and the values of the worst runs.
fn drawn(out: &mut Document, plan: &Plan, summary: &Summary) {
    let draws: Vec<_> = worst_runs(summary).iter().map(|worst| plan.draw(worst.run)).collect();
    let runs = draws.iter().map(|draw| format!("run {}", draw.run));
    let heads = ["number", "unit", "from", "to"].map(String::from).into_iter().chain(runs);
    let row = |(place, range): (usize, &VariedRange)| {
        let values = draws.iter().filter_map(|draw| draw.values.get(place).copied());
        let shown = range.unit();
        let unit = if shown.symbol == "1" { "" } else { shown.symbol };
        let all = [range.minimum, range.maximum].into_iter().chain(values);
        let numbers = all.map(|value| Cell::number_in(value, DIGITS, shown));
        [Cell::Code(range.path.clone()), Cell::unit(unit)].into_iter().chain(numbers).collect::<Vec<_>>()
    };
    let normal = plan.ranges().iter().any(|range| range.distribution == Distribution::Normal);
    let ends = " The ends of a normal distribution are two standard deviations from its middle.";
    out.heading("What was drawn");
    out.explanation(format!("{}{}", distributions(plan), if normal { ends } else { "" }));
    out.table(Table::new(heads).with(plan.ranges().iter().enumerate().map(row)));
}

/// The distributions of the numbers, in sentences.
fn distributions(plan: &Plan) -> String {
    let known = grouped(plan.ranges().iter().map(|range| (range.distribution_word(), range.path.as_str())));
    let plain = |word: &str| word.replace('_', "-");
    match known.as_slice() {
        [(word, _)] => format!("Every distribution is {}.", plain(word)),
        several => {
            let each = several.iter().map(|(word, paths)| format!("{} of {}", plain(word), paths.join(", ")));
            format!("Distributions: {}.", each.collect::<Vec<_>>().join("; "))
        }
    }
}
