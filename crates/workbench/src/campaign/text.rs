//! What `campaign` says to people.

use super::Summary;
use super::Wanted;
use super::{Draw, Plan};
use super::{LUMP_NAMES, METRIC_NAMES, STATUS_WORDS, meaningful};
use super::{QUANTILES, Spread};
use crate::answer::{significant, table};
use crate::project::Loaded;
use crate::simulate::{self, ScenarioRun, cause_words};

/// Refused, ended and worst runs that are told one by one.
const TOLD: usize = 6;

/// Words and units of [`METRIC_NAMES`].
const METRIC_WORDS: [&str; 9] = [
    "overshoot (%)",
    "rise (s)",
    "settling (s)",
    "disturbance peak (N)",
    "steady-state error (N)",
    "control peak (V)",
    "control rms (V)",
    "tracking error peak (N)",
    "force peak (N)",
];

const LUMP_WORDS: [&str; 3] = ["K_H (N/m)", "K_qU (m3/(s.V))", "K_c (m3/(s.Pa))"];

/// A metric in words, with its unit.
pub(crate) fn metric_words(metric: usize) -> &'static str {
    METRIC_WORDS.get(metric).copied().unwrap_or_default()
}

/// One of [`LUMP_NAMES`] as it is written in equations, with its unit.
pub(crate) fn lump_words(lump: usize) -> &'static str {
    LUMP_WORDS.get(lump).copied().unwrap_or_default()
}

/// So many runs.
pub(crate) fn counted(runs: usize) -> String {
    if runs == 1 { "1 run".to_string() } else { format!("{runs} runs") }
}

/// How many of the driven runs are left out of the quantiles of a metric because they have no such number; `None` where all have one.
pub(crate) fn without(metric: usize, spread: Option<Spread>, driven: usize) -> Option<String> {
    let missing = spread.map_or(driven, |spread| spread.missing);
    let words = match (METRIC_NAMES.get(metric), missing) {
        (Some(&"settling_time_s"), 1) => "never settles",
        (Some(&"settling_time_s"), _) => "never settle",
        (_, 1) => "has none",
        _ => "have none",
    };
    (missing > 0).then(|| format!("{missing} of {driven} {words}"))
}

/// Tables and sentences of a campaign; whether its rows are kept.
pub(crate) fn text(plan: &Plan, (wanted, kept): (Wanted, bool), rows: usize, summary: &Summary) -> String {
    let runs = wanted.shard.runs_of(wanted.runs);
    let asked = runs.end - runs.start;
    let mut out = format!("{}: {}, seed {}\n", plan.scenario(), counted(rows), plan.seed());
    if (rows as u64) < asked {
        let next = match kept {
            true => "the same command goes on from there",
            false => "with --out they would be kept, and the same command would go on from there",
        };
        out.push_str(&format!("Stopped after {rows} of {asked} runs; {next}.\n"));
    }
    for (word, count) in STATUS_WORDS.iter().zip(summary.statuses).filter(|(_, count)| *count > 0) {
        out.push_str(&format!("  {count} {}\n", word.replace('_', " ")));
    }
    for (run, reason) in summary.refused.iter().take(TOLD) {
        out.push_str(&format!("  run {run}: {reason}\n"));
    }
    for (run, word, time_s) in summary.ended.iter().take(TOLD) {
        out.push_str(&format!("  run {run}: {} at {} s\n", word.replace('_', " "), significant(*time_s, 4)));
    }
    for (kind, count, first) in &summary.occurrences {
        out.push_str(&format!(
            "  {} in {}, the first is run {first}\n",
            kind.replace('_', " "),
            counted(*count)
        ));
    }
    if rows > 0 {
        out.push_str(&format!("\n{}\n\n{}\n", metrics(plan, summary), lumps(plan, summary)));
    }
    if let Some(worst) = summary.worst.first() {
        out.push_str(&format!(
            "Any run again: --run INDEX, such as --run {}; its numbers as --set, and the whole of what happened.\n",
            worst.run
        ));
    }
    out
}

fn heads(first: [&'static str; 2], last: &'static str) -> Vec<String> {
    let quantiles = QUANTILES.map(|percent| format!("{percent} %"));
    let names = first.into_iter().filter(|name| !name.is_empty()).map(str::to_string);
    names.chain(quantiles).chain([last.to_string()]).collect()
}

fn metrics(plan: &Plan, summary: &Summary) -> String {
    let heads = heads(["event", "metric"], "worst (run)");
    let driven = summary.driven();
    let mut rows = table(&heads.iter().map(String::as_str).collect::<Vec<_>>());
    for (window, spreads) in plan.windows().iter().zip(&summary.metrics) {
        let mut name = cause_words(window);
        for metric in meaningful(window, plan.is_open_loop()) {
            let missing =
                without(metric, spreads[metric], driven).map_or(String::new(), |text| format!("; {text}"));
            let mut cells = vec![std::mem::take(&mut name), format!("{}{missing}", metric_words(metric))];
            cells.extend(spread_cells(spreads[metric]));
            rows.add_row(cells);
        }
    }
    rows.trim_fmt()
}

/// Quantiles, and the worst with its run; dashes where no run has such a number.
fn spread_cells(spread: Option<Spread>) -> Vec<String> {
    let Some(spread) = spread else { return vec!["-".to_string(); QUANTILES.len() + 1] };
    let (value, run) = spread.worst;
    let worst = format!("{} ({run})", significant(value, 4));
    spread.quantiles.iter().map(|value| significant(*value, 4)).chain([worst]).collect()
}

fn lumps(plan: &Plan, summary: &Summary) -> String {
    let mut rows = table(&["visited", "least", "median", "greatest", "box of [uncertainty]", "runs outside"]);
    for (index, spread) in summary.lumps.iter().enumerate() {
        let Some(spread) = spread else { continue };
        let number = |value: f64| significant(value, 4);
        let bounds = plan.bounds(LUMP_NAMES[index]);
        rows.add_row([
            lump_words(index).to_string(),
            number(spread.extremes[0]),
            number(spread.quantiles[2]),
            number(spread.extremes[1]),
            bounds.map_or("-".to_string(), |[low, high]| format!("{} to {}", number(low), number(high))),
            summary.outside[index].map_or("-".to_string(), |count| count.to_string()),
        ]);
    }
    rows.trim_fmt()
}

/// One run: its numbers as settings, and what `simulate` says of it.
pub(crate) fn run_text(draw: &Draw, settings: &[String], drawn: &Loaded, runs: &[ScenarioRun]) -> String {
    let lines: String = settings.iter().map(|setting| format!("  --set \"{setting}\"\n")).collect();
    format!("Run {}:\n{lines}\n{}", draw.run, simulate::text(drawn, runs))
}
