use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_qft::design::{DesignStatus, Objective, Starts};
use phea_qft::verification::{PlantPoint, Verdict};

use super::compared;
use super::factored;
use super::{Explanation, ProjectDesign, Repair, RepairStatus, Rounding};
use super::{repair_words, status_sentence, structure_words};
use crate::answer::{significant, table};
use crate::audit::{self, frequency_number, margin_words, summary};
use crate::project::{Loaded, snippet};
use crate::quantity::DisplayUnit;
use crate::trial;

/// Digits of the numbers of a law, for people.
const DIGITS: usize = 5;

/// What `design` says to people: the status first, then the law, what it reaches, and what that rests on.
pub fn text(loaded: &Loaded, view: &ProjectDesign) -> Result<String, LinearError> {
    let mut out = format!("Design: {}\n", status_sentence(view));
    for explanation in &view.explanations {
        out.push_str(&format!("  {}\n", explanation_words(view, explanation)));
    }
    for sentence in
        summary(&view.designed.view).into_iter().chain(view.rounding.iter().flat_map(Rounding::sentences))
    {
        out.push_str(&format!("  {sentence}\n"));
    }
    if view.minimum_delay_margin_s > 0.0 {
        let is = if view.bears_its_delay { "is" } else { "is not" };
        let asked = DisplayUnit::MILLISECOND.text(view.minimum_delay_margin_s, 3);
        out.push_str(&format!("  the delay of {asked} that was asked for {is} borne\n"));
    }
    if let Some(trial) = &view.trial {
        out.push_str(&trial::text(trial));
    }
    if let Some(repair) = &view.repair {
        out.push_str(&repair_text(repair)?);
    }
    out.push_str(&format!("\nController\n{}", laws(view)?));
    out.push_str(&format!("\n{}\n", side_by_side(view)));
    let caution = match view.designed.view.audit.verdict {
        _ if view.is_met() => "",
        Verdict::NotProven => ", though it is not proven",
        _ => ", though it does not keep to every specification",
    };
    out.push_str(&format!(
        "\nTo be pasted into the project{caution}\n{}",
        snippet(&view.declared_controller, view.declared_prefilter.as_ref())
    ));
    if let Some(conflicts) = conflicts(view) {
        out.push_str(&format!("\nWhat stands against one another\n{conflicts}\n"));
    }
    if let Some(binding) = binding(view) {
        out.push_str(&format!(
            "\nWhat the specifications cost: the limits that the loop touches\n{binding}\n"
        ));
    }
    out.push_str(&format!("\nRounds of search and audit\n{}\n  {}\n", rounds(view), seed_sentence(view)));
    out.push_str(&view.design.starts.as_ref().map_or_else(String::new, starts_sentence));
    out.push_str(&format!("\nAudit of the designed controller\n{}", audit::text(&view.designed.view)));
    out.push_str(&settings_sentence(loaded));
    Ok(out)
}

/// What followed from the machine's contradiction; with the laws that come nearest to what cannot be had.
fn repair_text(repair: &Repair) -> Result<String, LinearError> {
    let mut out = format!("\nRepair: {}\n", repair_words(repair));
    for sentence in &repair.sentences {
        out.push_str(&format!("  {sentence}\n"));
    }
    if let Some(nearest) = repair.nearest() {
        let snippet = snippet(&nearest.declared_controller, nearest.declared_prefilter.as_ref());
        out.push_str(&format!("\nNearest controller\n{}\n{snippet}", laws(nearest)?));
    }
    Ok(out)
}

/// The sentence, and the first plant that it concerns.
pub(crate) fn explanation_words(view: &ProjectDesign, explanation: &Explanation) -> String {
    let kind = if explanation.is_impossible { "" } else { "to be kept in mind: " };
    let plant = explanation.plants.first().map(|plant| view.designed.view.names.text(plant));
    let plant = plant.filter(|text| !text.is_empty()).map_or(String::new(), |text| format!(" ({text})"));
    format!("{kind}{}{plant}", explanation.sentence)
}

/// The laws in factored form; those of a sampled loop as they are deployed, and before.
fn laws(view: &ProjectDesign) -> Result<String, LinearError> {
    let side = &view.designed;
    let deployed = &side.problem.compensation;
    let law = side.controller.feedback.transfer_function()?;
    let prefilter = side.controller.prefilter.transfer_function()?;
    let mut lines = Vec::new();
    let mut tell = |name: &str, function: &TransferFunction| {
        let variable = if function.domain() == TimeDomain::Continuous { "s" } else { "z" };
        lines.push(format!("  {name}({variable}) = {}\n", factored(function, DIGITS)));
    };
    tell("G", &law);
    if law != *deployed.feedback() {
        tell("G", deployed.feedback());
    }
    if side.problem.has_prefilter {
        tell("F", &prefilter);
        if prefilter != *deployed.prefilter() {
            tell("F", deployed.prefilter());
        }
    }
    if let Some(sample_time) = deployed.sample_time_s() {
        lines.push(format!("  sampled every {}\n", DisplayUnit::MILLISECOND.text(sample_time, 3)));
    }
    Ok(lines.concat())
}

/// What is compared, a row each: the given controller, the designed one, and in a sampled loop the one that was designed without samples.
fn side_by_side(view: &ProjectDesign) -> String {
    let designed = compared(&view.designed);
    let published = view.published.as_ref().map(compared);
    let mut headings = vec![""];
    headings.extend(published.iter().map(|_| "given"));
    let before = before_repair(view).map(|before| compared(&before.designed));
    headings.extend(before.iter().map(|_| "before the repair"));
    headings.push("designed");
    let continuous = view.continuous.as_ref().map(compared);
    headings.extend(continuous.iter().map(|_| "made without samples"));
    let mut rows = table(&headings);
    for (index, (name, cell)) in designed.into_iter().enumerate() {
        let of = |other: &Option<Vec<(String, String)>>| {
            other.as_ref().and_then(|rows| rows.get(index)).map(|(_, cell)| cell.clone())
        };
        rows.add_row(
            [name].into_iter().chain(of(&published)).chain(of(&before)).chain([cell]).chain(of(&continuous)),
        );
    }
    rows.trim_fmt()
}

/// The first design, where the repair came to another one.
fn before_repair(view: &ProjectDesign) -> Option<&ProjectDesign> {
    let repair = view.repair.as_ref().filter(|repair| repair.status == RepairStatus::Met)?;
    repair.other.as_deref()
}

/// The limits at which the smallest relaxation is found, with their plants.
fn conflicts(view: &ProjectDesign) -> Option<String> {
    let DesignStatus::Infeasible(relaxation) = &view.design.status else { return None };
    let rows = relaxation.conflicts.iter();
    limits(view, rows.map(|one| (one.specification, one.frequency_rad_per_s, one.margin_db, &one.plant)))
}

fn binding(view: &ProjectDesign) -> Option<String> {
    let rows = view.design.binding.iter();
    limits(view, rows.map(|one| (one.specification, one.frequency_rad_per_s, one.margin_db, &one.plant)))
}

fn limits<'a>(
    view: &ProjectDesign,
    rows: impl Iterator<Item = (usize, f64, f64, &'a PlantPoint)>,
) -> Option<String> {
    let names = &view.designed.view.names;
    let mut headings = vec!["specification", "rad/s", "margin"];
    headings.extend(names.headings());
    let mut found = table(&headings);
    let mut any = false;
    for (specification, frequency, margin, plant) in rows {
        let mut row = vec![
            view.designed.view.numbered(specification),
            frequency_number(frequency),
            margin_words(margin),
        ];
        row.extend(names.cells(plant));
        found.add_row(row);
        any = true;
    }
    any.then(|| found.trim_fmt())
}

fn rounds(view: &ProjectDesign) -> String {
    let headings =
        ["", "structure", "objective", "plants", "frequencies", "margin searched", "margin audited"];
    let mut rows = table(&headings);
    for (index, round) in view.design.rounds.iter().enumerate() {
        rows.add_row([
            (index + 1).to_string(),
            structure_words(&round.structure),
            format!("{} dB", significant(round.objective_db, 5)),
            round.plants.to_string(),
            round.frequencies.to_string(),
            margin_words(round.searched_margin_db),
            round.audited_margin_db.map_or("unstable".to_string(), margin_words),
        ]);
    }
    rows.trim_fmt()
}

/// What another seed may do.
fn seed_sentence(view: &ProjectDesign) -> String {
    let better = match (&view.design.status, view.options.objective) {
        (DesignStatus::Infeasible(_), _) => "may need less relaxation",
        (DesignStatus::NotConverged { .. } | DesignStatus::NotStabilised, _) => "may find one",
        (DesignStatus::Met, Objective::BestWorstMargin) => "may end with more margin",
        (DesignStatus::Met, _) => "may end lower",
    };
    format!("begun at random points of seed {}; a local optimum: other seeds {better}", view.options.seed)
}

/// How much the result owes to its starts: where the descents of the last search ended.
fn starts_sentence(starts: &Starts) -> String {
    let mut sentence = format!("  {} of {} starts stabilise every plant", starts.stabilised, starts.tried);
    let three = |[best, median, worst]: [String; 3]| {
        format!("{best} at best, {median} in the middle, {worst} at worst")
    };
    if let Some(margins_db) = starts.margins_db {
        let (descents, margins) = (starts.ended, three(margins_db.map(margin_words)));
        sentence.push_str(&format!("; worst margin where {descents} descents ended: {margins}"));
    }
    if let Some(objectives_db) = starts.objectives_db {
        let objectives = three(objectives_db.map(|value| format!("{} dB", significant(value, 4))));
        sentence.push_str(&format!("; objective of those that keep the limits: {objectives}"));
    }
    sentence + "\n"
}

/// What was set on the command line is not in the file that a design writes.
fn settings_sentence(loaded: &Loaded) -> String {
    let others: Vec<&str> = loaded
        .settings
        .iter()
        .map(|setting| setting.trim())
        .filter(|setting| !setting.starts_with("controller") || setting.contains("quantization"))
        .collect();
    if others.is_empty() {
        return String::new();
    }
    format!(
        "\nA project written by this design does not hold what was set beside it: --set {}\n",
        others.join(" --set ")
    )
}
