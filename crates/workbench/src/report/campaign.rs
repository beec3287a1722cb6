//! The chapter on what the machine does when its numbers are not quite those of the project: bands over time, and the worst runs.

use maud::{Markup, html};

use super::chapter::{Chapter, cell, place, table};
use crate::answer::significant;
use crate::campaign::{
    CampaignError, LUMP_NAMES, Nowhere, Plan, QUANTILES, Shard, Summary, Wanted, campaign, metric_words,
    pictures, spread_cells,
};
use crate::command::{CommandError, Watch};
use crate::figure::Figure;
use crate::project::Loaded;
use crate::simulate::cause_words;
use crate::source::Source;

/// Runs of the report's campaign, and where their numbers come from.
const RUNS: u64 = 500;
const SEED: u32 = 1;

/// Runs whose numbers are told.
const WORST: usize = 4;

/// The chapter; `None` for a project without `[campaign]`.
///
/// # Errors
/// [`CommandError::Stopped`] where the watch stops it.
pub(super) fn chapter(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<Option<Chapter>, CommandError> {
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
    let (body, figures) = match told() {
        Err(error) => (html! { div.callout.bad-edge { p { "Not driven: " (error) "." } } }, vec![]),
        Ok((_, count, _, _)) if count < RUNS => return Err(CommandError::Stopped),
        Ok((plan, _, summary, figures)) => (body(&plan, &summary, &figures), figures),
    };
    Ok(Some(Chapter { anchor, title, body, figures }))
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
            p { (kind.replace('_', " ")) " in " (count) " runs, the first is run " (first) "." }
        }
        @for figure in figures { (place(figure)) }
        (metrics(plan, summary))
        (lumps(plan, summary))
        (worst(plan, summary))
        (ranges(plan))
    }
}

fn metrics(plan: &Plan, summary: &Summary) -> Markup {
    let quantiles = QUANTILES.map(|percent| format!("{percent} %"));
    let mut heads = vec!["event", "metric"];
    heads.extend(quantiles.iter().map(String::as_str));
    heads.push("worst (run)");
    let mut rows = Vec::new();
    for (window, spreads) in plan.windows().iter().zip(&summary.metrics) {
        for (metric, spread) in spreads.iter().enumerate().filter(|(_, spread)| spread.is_some()) {
            let words = [cause_words(window), metric_words(metric).to_string()];
            rows.push(words.into_iter().chain(spread_cells(*spread)).map(cell).collect::<Vec<_>>());
        }
    }
    html! {
        h3 { "Metrics over the runs" }
        (table(&heads, 2, &rows))
    }
}

fn lumps(plan: &Plan, summary: &Summary) -> Markup {
    let mut rows: Vec<Vec<Markup>> = Vec::new();
    for (index, spread) in summary.lumps.iter().enumerate() {
        let Some(spread) = spread else { continue };
        let text = |[low, high]: [f64; 2]| format!("{} to {}", significant(low, 4), significant(high, 4));
        let name = LUMP_NAMES[index];
        rows.push(vec![
            cell(name.replace('_', " ")),
            cell(text(spread.extremes)),
            cell(plan.bounds(name).map_or("not in [uncertainty]".to_string(), text)),
            cell(summary.outside[index].map_or("-".to_string(), |count| count.to_string())),
        ]);
    }
    html! {
        h3 { "Linear models that were visited" }
        p { "Stiffness, flow gain and flow-pressure coefficient do not exist in the nonlinear machine: these are those of its linear model at the operating point, for each draw, beside the box for which the controller is judged. SI units." }
        (table(&["parameter", "visited", "box", "runs outside"], 1, &rows))
    }
}

fn worst(plan: &Plan, summary: &Summary) -> Markup {
    let row = |worst: &crate::campaign::Worst| {
        let of = worst.of.iter().map(|(window, metric)| {
            let event = plan.windows().get(*window).map(cause_words).unwrap_or_default();
            format!("{} ({event})", metric_words(*metric))
        });
        vec![
            cell(worst.run.to_string()),
            cell(of.collect::<Vec<_>>().join(", ")),
            html! { code { (plan.settings(&plan.draw(worst.run)).join(" ")) } },
        ]
    };
    let rows: Vec<Vec<Markup>> = summary.worst.iter().take(WORST).map(row).collect();
    html! {
        h3 { "Worst runs" }
        p { "A run follows from seed and index: " code { "phea campaign --run INDEX" } " drives it again and tells all that happens in it." }
        (table(&["run", "worst in", "its numbers, SI"], 3, &rows))
    }
}

fn ranges(plan: &Plan) -> Markup {
    let row = |range: &crate::campaign::VariedRange| {
        let [low, high] = [range.minimum, range.maximum].map(|value| significant(value, 4));
        vec![
            html! { code { (range.path) } },
            cell(range.distribution_word().replace('_', " ")),
            cell(low),
            cell(high),
        ]
    };
    let rows: Vec<Vec<Markup>> = plan.ranges().iter().map(row).collect();
    html! {
        h3 { "What was drawn" }
        p { "SI units. The ends of a normal distribution are two standard deviations from its middle." }
        (table(&["number", "distribution", "from", "to"], 2, &rows))
    }
}
