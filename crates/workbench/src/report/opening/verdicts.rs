//! The table of verdicts and numbers: a row for each requirement, a column for each controller.

use maud::{Markup, html};
use phea_qft::proof::Standing;
use phea_qft::verification::{SpecificationFinding, Verdict};

use super::Contents;
use super::side::Side;
use crate::answer::significant;
use crate::audit::frequency_words;
use crate::document::{Cell, StatusMark, badge};
use crate::document::{prose, typeset};
use crate::quantity::DisplayUnit;
use crate::report::chapter::{cell, grouped};
use crate::report::specifications::demand;
use crate::simulate::{HeldWish, ScenarioRun};
use crate::trial;

type Rows = Vec<Vec<Markup>>;

/// The table; empty without a controller.
pub(super) fn table(contents: &Contents<'_>, sides: &[Side<'_>]) -> Markup {
    if sides.is_empty() {
        return html! {};
    }
    let groups = [
        ("The whole family of plants", of_family(contents, sides)),
        ("The nonlinear machine", of_machine(contents, sides)),
        ("The numbers that matter", numbers(sides)),
    ];
    let groups: Vec<(String, Rows)> = groups
        .into_iter()
        .filter(|(_, rows)| !rows.is_empty())
        .map(|(name, rows)| (name.to_string(), rows))
        .collect();
    let names: Vec<String> = sides.iter().map(|side| format!("{} controller", side.name)).collect();
    let mut headings = vec!["what was asked"];
    headings.extend(names.iter().map(String::as_str));
    html! { div.verdicts { (grouped(&headings, 9, &groups)) } }
}

/// A row, whose cell of each controller may be missing.
fn row(name: Markup, sides: &[Side<'_>], of: impl Fn(&Side<'_>) -> Option<Markup>) -> Option<Vec<Markup>> {
    let cells: Vec<Option<Markup>> = sides.iter().map(of).collect();
    if cells.iter().all(Option::is_none) {
        return None;
    }
    let cells = cells.into_iter().map(|found| found.unwrap_or_else(|| cell("-")));
    Some(std::iter::once(name).chain(cells).collect())
}

fn of_family(contents: &Contents<'_>, sides: &[Side<'_>]) -> Rows {
    let Some(judged) = contents.judged else { return vec![] };
    let mut rows = Vec::new();
    rows.extend(row(html! { b { "every specification, at every frequency" } }, sides, |side| {
        let verdict = Cell::verdict(side.view?.audit.verdict).markup();
        Some(html! { b { (verdict) (proven(side.is_proven().unwrap_or(false))) } })
    }));
    rows.extend(row(cell("every plant stable"), sides, |side| {
        let verdict = side.view?.audit.stability.verdict;
        let word = match verdict {
            Verdict::Met => "stable",
            Verdict::Violated => "unstable",
            Verdict::NotProven => "not proven",
        };
        let is_proven = side.proof().is_some_and(|proof| proof.stability == Standing::Proven);
        Some(html! { (badge(verdict.into(), word)) (proven(is_proven)) })
    }));
    for (index, specification) in judged.problem.specifications.iter().enumerate() {
        let name = html! {
            (index + 1) " " (judged.problem.name_of(index)) ", " (typeset(&demand(&specification.requirement)))
        };
        rows.extend(row(name, sides, |side| {
            let is_proven = side.proof().and_then(|proof| proof.specifications.get(index));
            let is_proven = is_proven.is_some_and(|own| own.standing == Standing::Proven);
            Some(finding(side.view?.audit.specifications.get(index)?, is_proven))
        }));
    }
    rows
}

/// The evidence for a verdict that holds for every plant and every frequency.
fn proven(is_proven: bool) -> &'static str {
    if is_proven { ", proven" } else { "" }
}

/// The verdict, its margin, and where it occurs.
fn finding(finding: &SpecificationFinding, is_proven: bool) -> Markup {
    let Some(worst) = &finding.worst else { return Cell::verdict(finding.verdict).markup() };
    let place = frequency_words(worst.frequency_rad_per_s);
    let size = significant(worst.margin_db.abs(), 3);
    let told = match finding.verdict {
        Verdict::Met if worst.margin_db < 5e-4 => format!(", only just, {place}"),
        Verdict::Met if worst.margin_db == f64::INFINITY => String::new(),
        Verdict::Met => format!(", {size} dB to spare {place}"),
        Verdict::Violated => format!(" by {size} dB {place}"),
        Verdict::NotProven => {
            format!("; {size} dB {} {place}", if worst.margin_db < 0.0 { "off" } else { "to spare" })
        }
    };
    html! { (Cell::verdict(finding.verdict).markup()) (proven(is_proven)) (told) }
}

fn of_machine(contents: &Contents<'_>, sides: &[Side<'_>]) -> Rows {
    let mut rows = Vec::new();
    rows.extend(row(cell("tried on the rig, its worst plants, waves in its lines"), sides, |side| {
        let trial = side.trial?;
        let words = trial::words(trial);
        let which = words.split_once(": ").map_or(String::new(), |(_, which)| format!(": {which}"));
        Some(html! { (Cell::agreement(trial.agreement()).markup()) (which) })
    }));
    rows.extend(row(cell("every scenario driven to its end"), sides, |side| Some(driven(side.runs?))));
    let Some(wish) = contents.driven.and_then(|driven| driven.wish.as_ref()) else { return rows };
    if let Some(words) = wish.overshoot_words() {
        let steps = sides.iter().find_map(|side| Some(side.overshoot(wish)?.1));
        rows.extend(row(wished(&words, steps), sides, |side| Some(held(side.overshoot(wish)?.0))));
    }
    if let Some(words) = wish.settling_words() {
        let steps = sides.iter().find_map(|side| Some(side.settling(wish)?.1));
        rows.extend(row(wished(&words, steps), sides, |side| Some(held(side.settling(wish)?.0))));
    }
    rows
}

/// The wish, and the number of steps of which the worst is shown.
fn wished(words: &str, steps: Option<usize>) -> Markup {
    let steps =
        steps.filter(|steps| *steps > 1).map_or("the step".to_string(), |steps| format!("all {steps} steps"));
    html! { "wished of " (steps) ": " (words) }
}

fn held(held: HeldWish) -> Markup {
    match held.kept {
        Some(kept) => {
            let (mark, word) = if kept { (StatusMark::Good, "kept") } else { (StatusMark::Bad, "missed") };
            html! { (badge(mark, word)) ": " (held.words) " at worst" }
        }
        None => html! { (held.words) ", which is not the band of the wish" },
    }
}

fn driven(runs: &[ScenarioRun]) -> Markup {
    let ended = runs.iter().filter(|run| run.stopped().is_none()).count();
    let outside = runs.iter().filter(|run| run.outside_model_s.is_some()).count();
    if ended < runs.len() {
        return html! { (badge(StatusMark::Bad, "no")) ": " (ended) " of " (runs.len()) };
    }
    match outside {
        0 => html! { (badge(StatusMark::Good, "yes")) },
        _ => {
            html! { (badge(StatusMark::Note, "yes")) ", but " (outside) " beyond what the equations hold for" }
        }
    }
}

/// The measurements, and the properties of the loop.
fn numbers(sides: &[Side<'_>]) -> Rows {
    let mut rows = Vec::new();
    rows.extend(row(cell("measured less simulated, NRMSE"), sides, measured));
    rows.extend(row(cell("delay that the family still tolerates"), sides, |side| {
        let delay_s = side.delay_margin_s()?;
        Some(cell(match delay_s {
            f64::INFINITY => "any".to_string(),
            _ => DisplayUnit::MILLISECOND.text(delay_s, 3),
        }))
    }));
    rows.extend(row(cell("order of controller and prefilter"), sides, |side| {
        let figures = side.figures?;
        Some(cell(format!("{} and {}", figures.order, figures.prefilter_order)))
    }));
    rows
}

/// The measured signals with their deviations.
fn measured(side: &Side<'_>) -> Option<Markup> {
    let overlays = side.runs?.iter().flat_map(|run| &run.measured);
    let told: Vec<String> = overlays
        .filter_map(|overlay| {
            Some(format!("{} {} %", overlay.quantity(), significant(100.0 * overlay.nrmse.ok()?, 3)))
        })
        .collect();
    (!told.is_empty()).then(|| prose(&told.join(", ")))
}
