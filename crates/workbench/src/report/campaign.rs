//! The chapter on what the machine does when its numbers are not quite those of the project: bands over time, and the worst runs.

use maud::{Markup, html};
use phea_engineering::error::ProcedureError;

use super::chapter::{Chapter, cell, grouped, place, table, unbroken};
use crate::answer::significant;
use crate::campaign::{
    CampaignError, LUMP_NAMES, METRIC_NAMES, Nowhere, Plan, QUANTILES, Shard, Spread, Summary, VariedRange,
    Wanted, Worst, campaign, counted, lump_words, meaningful, metric_words, pictures, without,
};
use crate::command::{CommandError, Watch};
use crate::document::unit;
use crate::document::{figures, prose};
use crate::figure::Figure;
use crate::project::{Distribution, Loaded};
use crate::simulate::{Window, cause_words, small_as_zero};
use crate::source::Source;

/// Runs of the report's campaign, and where their numbers come from.
const RUNS: u64 = 500;
const SEED: u32 = 1;

/// Runs whose numbers are told.
const WORST: usize = 4;

/// Significant digits of the numbers in the tables: an answer has all of them.
const DIGITS: usize = 3;

/// The chapter, and what it says in a few words.
pub(super) struct Campaign {
    pub(super) chapter: Chapter,
    pub(super) fact: Option<(&'static str, String)>,
}

/// The campaign of a report; `None` for a project without `[campaign]`.
///
/// # Errors
/// [`ProcedureError::Stopped`] where the watch stops it.
pub(super) fn driven(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<Option<Campaign>, CommandError> {
    if loaded.project.campaign.is_none() {
        return Ok(None);
    }
    let (anchor, title) = ("campaign", "Campaign: the machine with drawn numbers");
    let wanted = Wanted { runs: RUNS, shard: Shard::default(), effort: Default::default() };
    let mut told = || -> Result<_, CampaignError> {
        let plan = Plan::new(source, loaded, SEED)?;
        let rows = campaign(&plan, wanted, &mut Nowhere, watch)?;
        let summary = Summary::of(&plan, &rows);
        let figures = pictures(&plan, &summary)?;
        Ok((plan, rows.len() as u64, summary, figures))
    };
    let (body, figures, fact) = match told() {
        Err(error) => (html! { div.callout.bad-edge { p { "Not driven: " (error) "." } } }, vec![], None),
        Ok((_, count, _, _)) if count < RUNS => return Err(ProcedureError::Stopped.into()),
        Ok((plan, _, summary, figures)) => {
            (body(&plan, &summary, &figures), figures, Some(("Campaign", words(&plan, &summary))))
        }
    };
    Ok(Some(Campaign { chapter: Chapter { anchor, title, body, figures }, fact }))
}

/// Metrics of an event that a reader wants first, the best of those that it has.
const TOLD_FIRST: [&str; 4] =
    ["disturbance_peak_n", "settling_time_s", "tracking_error_peak_n", "force_peak_n"];
/// Events that are told in a few words.
const TOLD_EVENTS: usize = 2;

/// How many ran to their end, and between what most of them lie in the first events.
fn words(plan: &Plan, summary: &Summary) -> String {
    let mut told = vec![format!("{} of {RUNS} runs to their end", summary.statuses[0])];
    let windows = plan.windows().iter().zip(&summary.metrics);
    let of_window = |(window, spreads): (&Window, &[Option<Spread>; METRIC_NAMES.len()])| {
        let place = |name: &&str| METRIC_NAMES.iter().position(|known| known == name);
        let metric = TOLD_FIRST.iter().filter_map(place).find(|metric| spreads[*metric].is_some())?;
        let [low, .., high] = spreads[metric]?.quantiles.map(|value| significant(value, DIGITS));
        let (name, unit) = metric_words(metric).split_once(" (").unwrap_or_default();
        let unit = unit.trim_end_matches(')');
        Some(format!("{}: {name} {low} to {high} {unit}", cause_words(window)))
    };
    told.extend(windows.filter_map(of_window).take(TOLD_EVENTS));
    let [least, .., most] = QUANTILES;
    format!("{} ({least} to {most} %)", told.join("; "))
}

fn body(plan: &Plan, summary: &Summary, figures: &[Figure]) -> Markup {
    let completed = summary.statuses[0];
    html! {
        p { (RUNS) " runs of the scenario " b { (plan.scenario()) } ", seed " (plan.seed()) ", with the numbers below drawn anew for each, independently of each other: " (completed) " ran to their end." }
        @if !summary.refused.is_empty() { p { (summary.refused.len()) " draws are no machine, the first is run " (summary.refused[0].0) ": " (summary.refused[0].1) "." } }
        @for (run, word, time_s) in summary.ended.iter().take(WORST) {
            p { "Run " (run) " ended at " (significant(*time_s, 4)) " s: " (word.replace('_', " ")) "." }
        }
        @for (kind, count, first) in &summary.occurrences {
            p { (kind.replace('_', " ")) " in " (counted(*count)) ", the first is run " (first) "." }
        }
        @for figure in figures { (place(figure)) }
        (metrics(plan, summary))
        (lumps(plan, summary))
        (worst(plan, summary))
        (drawn(plan, summary))
    }
}

fn metrics(plan: &Plan, summary: &Summary) -> Markup {
    let quantiles = QUANTILES.map(|percent| format!("{percent} %"));
    let mut heads = vec!["metric"];
    heads.extend(quantiles.iter().map(String::as_str));
    heads.push("worst (run)");
    let driven = summary.driven();
    let of_window = |(window, spreads): (&Window, &[Option<Spread>; METRIC_NAMES.len()])| {
        let rows =
            meaningful(window, plan.is_open_loop()).map(|metric| spread_row(metric, spreads[metric], driven));
        (cause_words(window), rows.collect())
    };
    let windows = plan.windows().iter().zip(&summary.metrics);
    let groups: Vec<(String, Vec<Vec<Markup>>)> = windows.map(of_window).collect();
    html! {
        h3 { "Metrics over the runs" }
        p { "That share of the runs that have such a number lies below each; the worst is that of largest magnitude. Runs that have none are counted beside the name." }
        (grouped(&heads, 1, &groups))
    }
}

fn spread_row(metric: usize, spread: Option<Spread>, driven: usize) -> Vec<Markup> {
    let number = |value: f64| match METRIC_NAMES.get(metric) {
        Some(&"steady_state_error_n") => figures(small_as_zero(value), DIGITS),
        _ => figures(value, DIGITS),
    };
    let missing = without(metric, spread, driven);
    let mut row = vec![html! {
        (unbroken(metric_words(metric)))
        @if let Some(missing) = missing { br; (unbroken(&missing)) }
    }];
    let Some(spread) = spread else {
        row.extend((0..=QUANTILES.len()).map(|_| cell("-")));
        return row;
    };
    let (value, run) = spread.worst;
    row.extend(spread.quantiles.map(number));
    row.push(html! { (number(value)) " (" (run) ")" });
    row
}

fn lumps(plan: &Plan, summary: &Summary) -> Markup {
    let text = |[low, high]: [f64; 2]| html! { (figures(low, DIGITS)) " to " (figures(high, DIGITS)) };
    let mut rows: Vec<Vec<Markup>> = Vec::new();
    for (index, spread) in summary.lumps.iter().enumerate() {
        let Some(spread) = spread else { continue };
        let (symbol, si) = lump_words(index).split_once(' ').unwrap_or_default();
        rows.push(vec![
            html! { (prose(symbol)) " " (unit(si)) },
            text(spread.extremes),
            plan.bounds(LUMP_NAMES[index]).map_or(cell("not in [uncertainty]"), text),
            cell(summary.outside[index].map_or("-".to_string(), |count| count.to_string())),
        ]);
    }
    html! {
        h3 { "Linear models that were visited" }
        p { "Stiffness, flow gain and flow-pressure coefficient do not exist in the nonlinear machine: these are those of its linear model at the operating point, for each draw, beside the box for which the controller is judged." }
        (table(&["parameter", "visited", "box", "runs outside"], 1, &rows))
    }
}

/// The runs that are worst in most.
fn told(summary: &Summary) -> Vec<&Worst> {
    let mut told: Vec<&Worst> = summary.worst.iter().collect();
    told.sort_by_key(|worst| std::cmp::Reverse(worst.of.len()));
    told.truncate(WORST);
    told
}

fn worst(plan: &Plan, summary: &Summary) -> Markup {
    let told = told(summary);
    let rows: Vec<Vec<Markup>> =
        told.iter().map(|worst| vec![cell(worst.run.to_string()), cell(worst_in(plan, worst))]).collect();
    html! {
        h3 { "Worst runs" }
        @if let Some(first) = told.first() {
            p { "A run follows from seed and index: " code { "phea campaign PROJECT.toml --seed " (plan.seed()) " --run " (first.run) } " drives it again and tells all that happens in it, with its numbers to their last digit." }
        }
        (table(&["run", "worst in"], 2, &rows))
    }
}

/// Event by event, the metrics in which a run is worst, without their units.
fn worst_in(plan: &Plan, worst: &Worst) -> String {
    let metric = |metric: usize| metric_words(metric).split(" (").next().unwrap_or_default();
    let of_window = |(index, window)| {
        let of = worst.of.iter().filter(|(place, _)| *place == index).map(|(_, name)| metric(*name));
        let of: Vec<&str> = of.collect();
        (!of.is_empty()).then(|| format!("{}: {}", cause_words(window), of.join(", ")))
    };
    plan.windows().iter().enumerate().filter_map(of_window).collect::<Vec<_>>().join("; ")
}

/// Every drawn number: where from, and what the worst runs drew.
fn drawn(plan: &Plan, summary: &Summary) -> Markup {
    let draws: Vec<_> = told(summary).iter().map(|worst| plan.draw(worst.run)).collect();
    let runs: Vec<String> = draws.iter().map(|draw| format!("run {}", draw.run)).collect();
    let mut heads = vec!["number", "unit", "from", "to"];
    heads.extend(runs.iter().map(String::as_str));
    let row = |(place, range): (usize, &VariedRange)| {
        let values = draws.iter().filter_map(|draw| draw.values.get(place).copied());
        let shown = range.unit();
        let symbol = if shown.symbol == "1" { "" } else { shown.symbol };
        let mut row = vec![path(&range.path), html! { span.unit { (unit(symbol)) } }];
        let all = [range.minimum, range.maximum].into_iter().chain(values);
        row.extend(all.map(|value| figures(shown.of(value), DIGITS)));
        row
    };
    let rows: Vec<Vec<Markup>> = plan.ranges().iter().enumerate().map(row).collect();
    let normal = plan.ranges().iter().any(|range| range.distribution == Distribution::Normal);
    html! {
        h3 { "What was drawn" }
        p { (distributions(plan)) @if normal { " The ends of a normal distribution are two standard deviations from its middle." } }
        (table(&heads, 2, &rows))
    }
}

/// How the numbers are distributed, in sentences.
fn distributions(plan: &Plan) -> String {
    let mut known: Vec<(&str, Vec<&str>)> = Vec::new();
    for range in plan.ranges() {
        let word = range.distribution_word();
        match known.iter_mut().find(|(other, _)| *other == word) {
            Some((_, paths)) => paths.push(&range.path),
            None => known.push((word, vec![&range.path])),
        }
    }
    let plain = |word: &str| word.replace('_', "-");
    match known.as_slice() {
        [(word, _)] => format!("Every distribution is {}.", plain(word)),
        several => {
            let each = several.iter().map(|(word, paths)| format!("{} of {}", plain(word), paths.join(", ")));
            format!("Distributions: {}.", each.collect::<Vec<_>>().join("; "))
        }
    }
}

/// A path that may be broken at its dots.
fn path(path: &str) -> Markup {
    let parts: Vec<&str> = path.split('.').collect();
    let last = parts.len().saturating_sub(1);
    html! { code { @for (place, part) in parts.iter().enumerate() { (part) @if place < last { "." wbr; } } } }
}
