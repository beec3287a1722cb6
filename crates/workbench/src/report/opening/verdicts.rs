//! The table of verdicts and numbers: a row for each requirement, a column for each controller.

use phea_qft::proof::ClaimStatus;
use phea_qft::verification::{SpecificationFinding, Verdict};

use super::Contents;
use super::side::Side;
use super::steps::{AllSteps, StepProperty, steps};
use crate::answer::significant;
use crate::audit::position_words;
use crate::document::{Cell, StatusMark, Table};
use crate::quantity::DisplayUnit;
use crate::report::specifications::demand;
use crate::simulate::{
    Overlay, RunStatus, ScenarioRun, required_overshoot, required_rise, required_settling,
};
use crate::specification::numbered;
use crate::trial;
use crate::verdict_words::frequency_words;

type Rows = Vec<Vec<Cell>>;

/// The table; empty without a controller.
pub(super) fn table(contents: &Contents<'_>, sides: &[Side<'_>]) -> Table {
    let names = sides.iter().map(|side| format!("{} controller", side.name));
    let mut table =
        Table::grouped_by("judged", std::iter::once("what was required".to_string()).chain(names));
    let groups = [
        ("The whole family of plants", of_family(contents, sides)),
        ("The nonlinear simulation", of_machine(contents, sides)),
        ("The numbers that matter", numbers(sides)),
    ];
    for (name, rows) in groups.into_iter().filter(|(_, rows)| !rows.is_empty()) {
        table.group(name);
        rows.into_iter().for_each(|row| table.row(row));
    }
    table
}

/// A row with a cell for each controller, which may be missing.
fn row(
    name: impl Into<Cell>,
    sides: &[Side<'_>],
    of: impl Fn(&Side<'_>) -> Option<Cell>,
) -> Option<Vec<Cell>> {
    let cells: Vec<Option<Cell>> = sides.iter().map(of).collect();
    let is_known = cells.iter().any(Option::is_some);
    is_known.then(|| std::iter::once(name.into()).chain(cells.into_iter().map(Cell::from)).collect())
}

fn of_family(contents: &Contents<'_>, sides: &[Side<'_>]) -> Rows {
    let Some(judged) = contents.judged else { return vec![] };
    let mut rows = Vec::new();
    rows.extend(row(Cell::from("every specification, at every frequency").strong(), sides, |side| {
        let view = side.view?;
        let missed = if view.misses_in_time() { ", in time" } else { "" };
        let verdict = Cell::verdict(view.verdict()).then(missed);
        Some(verdict.then(proven(side.is_proven().unwrap_or(false))).strong())
    }));
    let position = contents.setup.project.motion().words().position;
    rows.extend(row(format!("{position} of every plant"), sides, |side| {
        Some(Cell::from(position_words(side.view?.position.as_ref()?)))
    }));
    rows.extend(row("every plant stable", sides, |side| {
        let verdict = side.view?.audit.stability.verdict;
        let word = match verdict {
            Verdict::Met => "stable",
            Verdict::Violated => "unstable",
            Verdict::NotProven => "not proven",
        };
        let is_proven = side.proof().is_some_and(|proof| proof.stability == ClaimStatus::Proven);
        Some(Cell::from(word).marked(verdict).then(proven(is_proven)))
    }));
    for (index, specification) in judged.problem.specifications.iter().enumerate() {
        let name = Cell::from(format!("{}, ", numbered(judged.problem.named(index))))
            .then(Cell::Equation(demand(&specification.requirement)));
        rows.extend(row(name, sides, |side| {
            let is_proven = side.proof().and_then(|proof| proof.specifications.get(index));
            let is_proven = is_proven.is_some_and(|own| own.claim_status == ClaimStatus::Proven);
            Some(finding(side.view?.audit.specifications.get(index)?, is_proven))
        }));
    }
    rows
}

/// The evidence for a verdict that holds for every plant and every frequency.
fn proven(is_proven: bool) -> &'static str {
    if is_proven { ", proven" } else { "" }
}

/// The verdict, its margin, and the frequency at which it occurs.
fn finding(finding: &SpecificationFinding, is_proven: bool) -> Cell {
    let verdict = Cell::verdict(finding.verdict);
    let Some(worst) = &finding.worst else { return verdict };
    let place = frequency_words(worst.frequency_rad_per_s);
    let size = significant(worst.margin_db.abs(), 3);
    let margin_words = match finding.verdict {
        Verdict::Met if worst.margin_db < 5e-4 => format!(", only just, {place}"),
        Verdict::Met if worst.margin_db == f64::INFINITY => String::new(),
        Verdict::Met => format!(", {size} dB to spare {place}"),
        Verdict::Violated => format!(" by {size} dB {place}"),
        Verdict::NotProven => {
            format!("; {size} dB {} {place}", if worst.margin_db < 0.0 { "off" } else { "to spare" })
        }
    };
    verdict.then(proven(is_proven)).then(Cell::from(margin_words))
}

fn of_machine(contents: &Contents<'_>, sides: &[Side<'_>]) -> Rows {
    let mut rows = Vec::new();
    let has_waves = |side: &Side<'_>| {
        side.trial.is_some_and(|trial| trial.runs.iter().any(|run| run.quarter_wave_rad_per_s.is_some()))
    };
    let trial_words = match sides.iter().any(has_waves) {
        true => "tried on the rig, its worst plants, waves in its lines",
        false => "tried on the rig and its worst plants",
    };
    rows.extend(row(trial_words, sides, |side| {
        let trial = side.trial?;
        let which = trial::agreement_detail(trial).map_or(String::new(), |detail| format!(": {detail}"));
        Some(Cell::agreement(trial.agreement()).then(Cell::from(which)))
    }));
    rows.extend(row("every scenario driven to its end", sides, |side| Some(driven(side.runs?))));
    let Some(all_required) = contents.driven.and_then(|driven| driven.required.as_ref()) else {
        return rows;
    };
    let requirement = &all_required.step_limits;
    let required = [
        (StepProperty::Overshoot, required_overshoot(requirement)),
        (StepProperty::Settling, required_settling(requirement)),
        (StepProperty::Rise, required_rise(requirement)),
    ];
    for (property, words) in required {
        let Some(words) = words else { continue };
        let all: Vec<Option<AllSteps>> =
            sides.iter().map(|side| steps(side, all_required, property)).collect();
        let counted = all.iter().flatten().next().map(AllSteps::counted).unwrap_or_default();
        let cells: Vec<Cell> = all.iter().map(|all| Cell::from(all.as_ref().map(held))).collect();
        if all.iter().any(Option::is_some) {
            let name = Cell::from(format!("required of {counted}: {words}"));
            rows.push(std::iter::once(name).chain(cells).collect());
        }
    }
    rows
}

fn held(all: &AllSteps) -> Cell {
    let satisfied = all.all_satisfied();
    let word = if satisfied { "satisfied" } else { "missed" };
    Cell::from(word).marked(satisfied).then(Cell::from(format!(": {}", all.words())))
}

fn driven(runs: &[ScenarioRun]) -> Cell {
    let completed = runs.iter().filter(|run| run.stopped().is_none()).count();
    let outside = runs.iter().filter(|run| run.outside_model_s.is_some()).count();
    if completed < runs.len() {
        return Cell::from("no").marked(false).then(format!(": {completed} of {}", runs.len()));
    }
    let undetermined = runs.iter().filter(|run| run.run_status() == RunStatus::Undetermined).count();
    match (undetermined, outside) {
        (0, 0) => Cell::from("yes").marked(true),
        (1.., _) => Cell::from("yes")
            .marked(false)
            .then(format!(", but no solver determines the result of {undetermined}")),
        (0, _) => Cell::from("yes")
            .marked(StatusMark::Note)
            .then(format!(", but {outside} beyond what the equations hold for")),
    }
}

/// The measurements, and the properties of the loop.
fn numbers(sides: &[Side<'_>]) -> Rows {
    let mut rows = Vec::new();
    rows.extend(row("measured less simulated, NRMSE", sides, measured));
    rows.extend(row("delay that the family still tolerates", sides, |side| {
        let delay_s = side.delay_margin_s()?;
        Some(match delay_s {
            f64::INFINITY => "any".into(),
            _ => Cell::from(DisplayUnit::MILLISECOND.text(delay_s, 3)),
        })
    }));
    rows.extend(row("order of controller and prefilter", sides, |side| {
        let figures = side.figures?;
        Some(format!("{} and {}", figures.order, figures.prefilter_order).into())
    }));
    rows
}

/// The measured signals with their deviations.
fn measured(side: &Side<'_>) -> Option<Cell> {
    let words = |run: &ScenarioRun, overlay: &Overlay| {
        let signal = overlay.signal.words(run.record.units.motion);
        Some(format!("{signal} {} %", significant(100.0 * overlay.nrmse.ok()?, 3)))
    };
    let overlays = side.runs?.iter().flat_map(|run| run.measured.iter().map(move |overlay| (run, overlay)));
    let deviations: Vec<String> = overlays.filter_map(|(run, overlay)| words(run, overlay)).collect();
    (!deviations.is_empty()).then(|| deviations.join(", ").into())
}
