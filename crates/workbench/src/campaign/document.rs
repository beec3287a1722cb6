//! The output of `campaign` for people.

use phea_engineering::campaign::{
    CampaignRequirement, Draw, FamilyBox, LUMP_NAMES, Plan, QUANTILES, RequestedRuns, Spread, Summary,
    meaningful,
};
use phea_engineering::simulate::{Metric, RunStatus, ScenarioRun};

use crate::answer::significant;
use crate::document::{Cell, Document, Table};
use crate::project::Loaded;
use crate::quantity::{DisplayUnit, MotionKind};
use crate::simulate::{self, cause_cell, shown_in, status_words};
use crate::simulate::{not_judged_words, reached_words, required_words};

/// Largest number of listed runs that were rejected or stopped early.
const LISTED: usize = 6;

/// A metric in words, with its unit.
fn metric_cell(metric: Metric, plan: &Plan) -> Cell {
    let label = Cell::from(metric.label(plan.motion()));
    let label = match metric {
        Metric::SettlingTime => {
            let band = Cell::short(plan.settling_band_percent(), 4, DisplayUnit::IN_PERCENT);
            label.then(" to ").then(band)
        }
        _ => label,
    };
    label.then(shown_in(metric, plan.units()).title(""))
}

/// A name of [`LUMP_NAMES`] as it is written in equations, with its unit.
fn lump_words(lump: usize, motion: MotionKind) -> &'static str {
    let stiffness = motion.either("K_H (N/m)", "K_θ (N.m/rad)");
    [stiffness, "K_qU (m3/(s.V))", "K_c (m3/(s.Pa))"].get(lump).copied().unwrap_or_default()
}

/// A number of runs.
pub(crate) fn counted(runs: usize) -> String {
    if runs == 1 { "1 run".to_string() } else { format!("{runs} runs") }
}

/// Number of driven runs that are left out of the quantiles of a metric because they have no such
/// number; `None` if all have one.
fn without(metric: Metric, spread: Option<Spread>, driven: usize) -> Option<Cell> {
    let missing = spread.map_or(driven, |spread| spread.missing);
    let words = match (metric, missing) {
        (Metric::SettlingTime, 1) => "does not settle within its window",
        (Metric::SettlingTime, _) => "do not settle within their window",
        (_, 1) => "has none",
        _ => "have none",
    };
    let runs = || Cell::count(missing).between("; ", " of ").then(Cell::count(driven));
    (missing > 0).then(|| runs().then(format!(" {words}")))
}

/// The scenarios of the project that a campaign leaves out; `None` if it has no other.
pub(crate) fn left_out(plan: &Plan) -> Option<String> {
    let others: Vec<String> = plan.other_scenarios().iter().map(|name| format!("\"{name}\"")).collect();
    (!others.is_empty()).then(|| {
        format!(
            "The campaign drives one scenario, and not {}: `campaign.scenario` names it.",
            others.join(", ")
        )
    })
}

/// Tables and sentences of a campaign, with a note if its rows are stored.
pub(crate) fn document(
    plan: &Plan,
    (wanted, is_stored): (RequestedRuns, bool),
    rows: usize,
    summary: &Summary,
) -> Document {
    let requested = wanted.runs;
    let mut out = Document::default();
    out.line(format!("{}: {}, seed {}", plan.scenario(), counted(rows), plan.seed()));
    left_out(plan).into_iter().for_each(|sentence| out.line(sentence));
    if (rows as u64) < requested {
        let next = match is_stored {
            true => "the same command continues from there",
            false => "with --out they would be kept, and the same command would continue from there",
        };
        out.line(format!("Stopped after {rows} of {requested} runs; {next}."));
    }
    let statuses = RunStatus::OF_ROWS.into_iter().zip(summary.statuses).filter(|(_, count)| *count > 0);
    out.sentences(statuses.map(|(status, count)| format!("{count} {}", status_words(status))));
    out.sentences(summary.refused.iter().take(LISTED).map(|(run, reason)| format!("run {run}: {reason}")));
    let early_ends = summary.early_ends.iter().take(LISTED).map(|(run, status, time_s)| {
        format!("run {run}: {} at {} s", status_words(*status), significant(*time_s, 4))
    });
    out.sentences(early_ends);
    out.sentences(summary.occurrences.iter().map(|(kind, count, first)| {
        format!("{} in {}, the first is run {first}", kind.replace('_', " "), counted(*count))
    }));
    if rows > 0 {
        out.gap();
        out.table(metrics(plan, summary));
        out.gap();
        out.sentences(summary.requirements.iter().map(requirement));
        out.table(lumps(plan, summary));
        out.sentences(beyond_box(plan));
    }
    if let Some(worst) = summary.worst.first() {
        out.line(format!(
            "To repeat a run: --seed {} --run INDEX in place of --runs, such as --run {}; it prints the numbers as --set, and everything that happened.",
            plan.seed(),
            worst.run
        ));
    }
    out
}

/// `291 of 300 runs (97.0 %; 94.4 to 98.4 % with 95 % confidence) satisfy: at most 2 % overshoot`
pub(crate) fn requirement(one: &CampaignRequirement) -> String {
    let required = required_words(&one.step_limits);
    let judged = match one.judged {
        Ok(judged) => judged,
        Err(why) => return format!("not judged: {required}; {}", not_judged_words(why)),
    };
    let percent = |part: f64| significant(100.0 * part, 3);
    let [low, high] = judged.confidence_95().map(percent);
    let part = percent(judged.satisfied as f64 / judged.runs.max(1) as f64);
    let worst = match judged.worst {
        Some((run, reached)) if judged.satisfied < judged.runs => {
            format!("; the worst is run {run}: {}", reached_words(&one.step_limits, &reached))
        }
        _ => String::new(),
    };
    format!(
        "{} of {} ({part} %; {low} to {high} % with 95 % confidence) satisfy what is required, {required}{worst}",
        judged.satisfied,
        counted(judged.runs)
    )
}

/// The spread of each metric, event by event.
pub(crate) fn metrics(plan: &Plan, summary: &Summary) -> Table {
    let quantiles = QUANTILES.map(|percent| format!("{percent} %"));
    let heads = std::iter::once("metric".to_string()).chain(quantiles).chain(["worst (run)".to_string()]);
    let mut rows = Table::grouped_by("event", heads);
    let units = plan.units();
    for (window, spreads) in plan.windows().iter().zip(&summary.metrics) {
        rows.group(cause_cell(window, units));
        for metric in meaningful(window, plan.is_open_loop()) {
            let missing = without(metric, spreads[metric], summary.driven());
            let name = metric_cell(metric, plan).then(missing.unwrap_or_else(Cell::empty));
            rows.row(std::iter::once(name).chain(spread_cells(spreads[metric], shown_in(metric, units))));
        }
    }
    rows
}

/// Quantiles, and the worst value with its run; empty if no run has such a number.
fn spread_cells(spread: Option<Spread>, unit: DisplayUnit) -> Vec<Cell> {
    let Some(spread) = spread else { return vec![Cell::Missing; QUANTILES.len() + 1] };
    let (value, run) = spread.worst;
    let number = |value: f64| Cell::number_in(value, 4, unit);
    let worst = number(value).then(" (").then(Cell::count(run as usize)).then(")");
    spread.quantiles.iter().map(|value| number(*value)).chain([worst]).collect()
}

/// The parameters of the linear models that were visited, next to the box for which the controller
/// is judged.
pub(crate) fn lumps(plan: &Plan, summary: &Summary) -> Table {
    let row = |(index, spread): (usize, &Option<Spread>)| {
        let spread = (*spread)?;
        let number = |value: f64| Cell::number(value, 4);
        let bounds = plan.bounds(LUMP_NAMES[index]);
        let bounds = bounds.map(|[low, high]| number(low).then(" to ").then(number(high)));
        Some([
            lump_words(index, plan.motion()).into(),
            number(spread.extremes[0]),
            number(spread.quantiles[2]),
            number(spread.extremes[1]),
            bounds.into(),
            summary.outside[index].map(Cell::count).into(),
        ])
    };
    Table::new(["visited", "least", "median", "greatest", "box of [uncertainty]", "runs outside"])
        .with(summary.lumps.iter().enumerate().filter_map(row))
}

/// Drawn numbers for which the controller is not judged, and the reason why parameters of the
/// linear model have no box.
pub(crate) fn beyond_box(plan: &Plan) -> Vec<String> {
    let mut sentences = Vec::new();
    let without: Vec<&str> = LUMP_NAMES.iter().copied().filter(|name| plan.bounds(name).is_none()).collect();
    if !without.is_empty() {
        let follow = match plan.box_of_family() {
            FamilyBox::None => "no box is stated for the controller to be judged over",
            FamilyBox::LinearParameters => "it ranges over other parameters of the linear model",
            FamilyBox::Numbers => {
                "it ranges over numbers of the rig, from which they follow; `check` prints what they range over"
            }
        };
        sentences.push(format!("[uncertainty] has no box of {}: {follow}", without.join(", ")));
    }
    sentences.extend(plan.beyond_box().into_iter().map(|one| {
        let unit = one.range.unit();
        let between = |[low, high]: [f64; 2]| format!("{} to {}", unit.number(low, 4), unit.text(high, 4));
        let drawn = between([one.range.minimum, one.range.maximum]);
        let path = &one.range.path;
        match one.designed_for {
            Some(box_of) => format!(
                "{path} is drawn beyond the box that the controller is judged for: {drawn}, box {}",
                between(box_of)
            ),
            None => {
                format!("{path} is drawn, {drawn}, and is not in the box that the controller is judged for")
            }
        }
    }));
    sentences
}

/// A single run: its numbers as settings, and the output of `simulate`.
pub(crate) fn run_document(
    draw: &Draw,
    settings: &[String],
    drawn: &Loaded,
    runs: &[ScenarioRun],
) -> Document {
    let mut out = Document::default();
    out.line(format!("Run {}:", draw.run));
    out.sentences(settings.iter().map(|setting| format!("--set \"{setting}\"")));
    out.gap();
    out.append(simulate::document(drawn, runs));
    out
}
