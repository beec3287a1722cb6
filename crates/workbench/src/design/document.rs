//! A design for people.

use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_engineering::design::LedBy;
use phea_qft::design::quantization::CoefficientFormat;
use phea_qft::design::{BINDING_DB, DesignRound, DesignStatus, Objective, Starts};
use phea_qft::verification::{SpecificationMargin, Verdict};

use super::comparison::{ComparedFigure, compared};
use super::factored;
use super::relaxed;
use super::repair::{repair_sentences, repair_words};
use super::rounding::rounding_sentences;
use super::unfinished::unfinished_sentence;
use super::words::{searched_limit_name, structure_words, unusable_words, verdict_sentence};
use super::{AuditedController, Explanation, ProjectDesign, Repair, RepairStatus};
use crate::answer::significant;
use crate::audit::{self, summary};
use crate::document::{Cell, Document, StatusMark, Table};
use crate::explanation::explanation_sentence;
use crate::plant_names::{plant_cells, plant_text};
use crate::project::{Loaded, snippet};
use crate::quantity::DisplayUnit;
use crate::trial;
use crate::verdict_words::margin_words;

/// Accuracy to which a design satisfies a reserve, dB.
const RESERVE_ACCURACY_DB: f64 = 2e-3;

/// Least margin of the audit minus the required reserve where that margin occurs, dB.
fn least_beyond_reserve_db(view: &ProjectDesign) -> f64 {
    let left = view.designed.view.audit.specifications.iter().filter_map(|finding| {
        let worst = finding.worst.as_ref()?;
        let reserve_db =
            finding.requirement.reserve_at_db(view.options.reserve_db, worst.frequency_rad_per_s);
        // a spread has two limits
        let limits = if worst.other.is_some() { 2.0 } else { 1.0 };
        Some(worst.margin_db - limits * reserve_db)
    });
    left.fold(f64::INFINITY, f64::min)
}

/// Digits of the numbers of a controller, for people.
const DIGITS: usize = 5;

/// The output of `design` for people: the status first, then the controller, its performance, and
/// the evidence.
pub fn output(loaded: &Loaded, view: &ProjectDesign) -> Result<Document, LinearError> {
    let mut out = status(view);
    if view.minimum_delay_margin_s > 0.0 {
        let does = if view.tolerates_its_delay { "tolerates" } else { "does not tolerate" };
        let delay = DisplayUnit::MILLISECOND.text(view.minimum_delay_margin_s, 3);
        out.sentences([format!("the loop {does} the further delay of {delay} that is required")]);
    }
    if view.options.reserve_db > 0.0 {
        let reserve = significant(view.options.reserve_db, 2);
        let mut recorded = loaded.recorded.iter().flat_map(|recorded| &recorded.settings);
        let why = match recorded.any(|setting| setting.starts_with("design.reserve=")) {
            true => ", for what the recordings leave out of the family",
            false => "",
        };
        out.sentences([match least_beyond_reserve_db(view) {
            least_db if least_db >= -RESERVE_ACCURACY_DB => {
                format!("every margin keeps a reserve of {reserve} dB to its limit{why}")
            }
            least_db => format!(
                "the reserve of {reserve} dB to every limit{why} is not kept: a margin misses it by {} dB",
                significant(-least_db, 2)
            ),
        }]);
    }
    if let Some(trial) = &view.trial {
        out.append(trial::document(trial, None));
    }
    if let Some(repair) = &view.repair {
        out.append(repaired(loaded, view, repair)?);
    }
    out.append(super::pressure_feedback(view));
    out.heading("Controller");
    out.append(laws(&view.designed)?);
    out.append(super::manual(view));
    out.append(side_by_side(view));
    out.append(in_project(loaded, view));
    out.append(super::structures(view));
    out.append(super::limits(view));
    out.append(costs(view));
    out.heading("Audit of the designed controller");
    out.append(audit::document(&view.designed.view, vec![]));
    let title = "What is proven of the designed controller";
    match &view.designed.view.proof {
        Some(_) => out.append(audit::proven(&view.designed.view, title)),
        None => {
            out.heading(title);
            out.sentences(["nothing: the design was stopped before its proof".to_string()]);
        }
    }
    if let Some(sentence) = settings_sentence(loaded) {
        out.gap();
        out.line(sentence);
    }
    Ok(out)
}

/// The controller as a part of a project, if it may be used.
fn in_project(loaded: &Loaded, view: &ProjectDesign) -> Document {
    let mut out = Document::default();
    let caution = match view.designed.view.verdict() {
        _ if view.is_met() => "",
        Verdict::NotProven => ", though it is not proven",
        _ => ", though it does not satisfy every specification",
    };
    match unusable_words(view) {
        Some(why) => out.verdict(StatusMark::Bad, not_to_be_used(&why), vec![]),
        None => {
            out.heading(format!("{}{caution}", in_place_of(view)));
            out.preformatted(pasted(loaded, view));
        }
    }
    out
}

/// Text printed instead of the tables of a controller that must not be used.
fn not_to_be_used(why: &str) -> String {
    format!("Do not use this controller: {why}. It is not printed as a part of a project.")
}

/// The tables of a design as they would appear in its project.
fn pasted(loaded: &Loaded, view: &ProjectDesign) -> String {
    let laws = (&view.declared_controller, view.declared_prefilter.as_ref());
    snippet(laws, loaded.project.motions())
}

/// The heading of the text of a controller, with the tables that it replaces.
fn in_place_of(view: &ProjectDesign) -> &'static str {
    match view.declared_prefilter {
        Some(_) => "In the project, in place of [controller] and [prefilter]",
        None => "In the project, in place of [controller]",
    }
}

/// End of the search, the bounds that are known before any search, and the audit of the result.
pub(crate) fn status(view: &ProjectDesign) -> Document {
    let unfinished = view.unfinished.iter().map(|part| unfinished_sentence(*part).to_string());
    let mut sentences: Vec<String> = unfinished.collect();
    sentences.extend(unusable_words(view).map(|why| format!("do not use the designed controller: {why}")));
    sentences.extend(view.explanations.iter().map(|explanation| explanation_words(view, explanation)));
    sentences.extend(summary(&view.designed.view));
    sentences.extend(not_led_sentence(view));
    sentences.extend(view.rounding.iter().flat_map(|rounding| rounding_sentences(rounding, view.gain_per)));
    let mut out = Document::default();
    let mark = view.designed.view.verdict().into();
    out.verdict(
        mark,
        format!("Design: {}", verdict_sentence(&view.verdict(), view.designed.problem.units.motion)),
        sentences,
    );
    out
}

/// Reason why the steps of a design with rounded coefficients were not the objective, if they miss
/// the requirement.
fn not_led_sentence(view: &ProjectDesign) -> Option<String> {
    let misses = view.designed.view.misses_in_time() || view.misses_on_rig();
    let is_missed = misses || view.exceeded_command().is_some();
    (is_missed && view.options.coefficients != CoefficientFormat::Double).then(|| {
        "the coefficients are rounded, and a search with rounded coefficients is not led by its steps: without `controller.quantization.coefficients` they may be satisfied".to_string()
    })
}

/// The consequences of the machine's contradiction, with the controllers that come nearest to the
/// goal that cannot be achieved.
fn repaired(loaded: &Loaded, view: &ProjectDesign, repair: &Repair) -> Result<Document, LinearError> {
    let mut out = Document::default();
    out.heading(format!("Repair: {}", repair_words(repair.status)));
    out.sentences(repair_sentences(view, repair));
    if let Some(nearest) = repair.nearest() {
        out.heading("Nearest controller");
        out.append(laws(&nearest.designed)?);
        match unusable_words(nearest) {
            Some(why) => out.verdict(StatusMark::Bad, not_to_be_used(&why), vec![]),
            None => {
                out.heading_on_page(in_place_of(nearest));
                out.preformatted(pasted(loaded, nearest));
            }
        }
    }
    Ok(out)
}

/// The limits that conflict, the cost of the specifications, and the account of the search.
pub(crate) fn costs(view: &ProjectDesign) -> Document {
    let mut out = Document::default();
    out.section("Conflicting specifications", conflicts(view));
    if let DesignStatus::Infeasible(relaxation) = &view.design.status {
        out.explanation(format!(
            "With every limit {} dB wider these are all reached at once: improving one of them worsens another.",
            significant(relaxation.relaxation_db, 3)
        ));
    }
    let binding = limits(view, &view.design.binding);
    let touched = match view.options.objective {
        Objective::BestWorstMargin => "the worst margin, which is as large as the search made it",
        _ if view.options.reserve_db > 0.0 => "its limit with the reserve",
        _ => "its limit",
    };
    let touches = !binding.is_empty();
    out.section("What the specifications cost: the limits that the loop touches", binding);
    if touches {
        out.explanation(format!(
            "The limits over frequency that come within {BINDING_DB} dB of {touched}, at the design frequencies and where each is worst over its whole band, with the plant that sets it. These cost: relaxed there they may allow a better controller; relaxing any other specification over frequency gains nothing. What is required in time and what may be built can cost too."
        ));
    }
    out.sentences(led_sentence(view).filter(|_| !touches));
    out.append(relaxed::document(view));
    out.heading("Rounds of search and audit");
    out.explanation(
        "A search over some plants and frequencies, then an audit over the whole family and band, whose worst plants and frequencies the next search includes, until both agree. The same seed finds the same controller.",
    );
    out.folded("Every round", rounds(view));
    let last = view.design.rounds.last();
    out.sentences(last.filter(|round| round.objective_db != view.design.objective_db).map(|round| {
        format!(
            "these rounds are those over frequency, of {}; the design was led by its steps since",
            structure_words(&round.structure)
        )
    }));
    out.sentences(
        std::iter::once(seed_sentence(view)).chain(view.design.starts.as_ref().map(starts_sentence)),
    );
    out
}

/// The objective of a design that touches no limit over frequency.
fn led_sentence(view: &ProjectDesign) -> Option<String> {
    let led_by = match view.led_by {
        LedBy::Frequency => return None,
        LedBy::LinearSteps => "the steps of the linear loop",
        LedBy::NonlinearRuns => "the steps of the nonlinear rig",
    };
    Some(format!("The loop touches no limit over frequency: {led_by} led the search, and limit it."))
}

/// The sentence, and the first plant that it concerns.
pub(crate) fn explanation_words(view: &ProjectDesign, explanation: &Explanation) -> String {
    let kind = if explanation.is_impossible { "" } else { "to be kept in mind: " };
    let plant = explanation.plants.first().map(|plant| plant_text(&view.designed.view.names, plant));
    let plant = plant.filter(|text| !text.is_empty()).map_or(String::new(), |text| format!(" ({text})"));
    format!("{kind}{}{plant}", explanation_sentence(explanation))
}

/// The transfer functions of one controller in factored form; in a sampled loop both before and
/// after sampling.
pub(crate) fn laws(side: &AuditedController) -> Result<Document, LinearError> {
    let deployed = &side.problem.compensation;
    let mut laws = vec![("G", side.controller.feedback.transfer_function()?, deployed.feedback())];
    if side.problem.has_prefilter {
        laws.push(("F", side.controller.prefilter.transfer_function()?, deployed.prefilter()));
    }
    let line = |name: &str, function: &TransferFunction| {
        let variable = if function.domain() == TimeDomain::Continuous { "s" } else { "z" };
        format!("{name}({variable}) = {}", factored(function, DIGITS))
    };
    let both = laws.iter().flat_map(|(name, law, deployed)| {
        let changed = (law != *deployed).then(|| line(name, deployed));
        std::iter::once(line(name, law)).chain(changed)
    });
    let mut out = Document::default();
    out.equations(both.collect());
    out.sentences(
        deployed
            .sample_time_s()
            .map(|time_s| format!("sampled every {}", DisplayUnit::MILLISECOND.text(time_s, 3))),
    );
    Ok(out)
}

/// The compared quantities, a row each: the given controller, the one before the repair, the
/// designed one, and in a sampled loop the one designed without sampling.
pub(crate) fn side_by_side(view: &ProjectDesign) -> Document {
    let sides = [
        ("given", view.published.as_deref()),
        ("before the repair", before_repair(view).map(|before| &before.designed)),
        ("designed", Some(&view.designed)),
        ("made without samples", view.continuous.as_deref()),
    ];
    let columns: Vec<(&str, Vec<ComparedFigure>)> = sides
        .into_iter()
        .filter_map(|(name, side)| Some((name, compared(side?, view.controlled_unit()))))
        .collect();
    let mut table = Table::new(std::iter::once("").chain(columns.iter().map(|(name, _)| *name)));
    // a designed loop has limits that the given one has not
    let longest = columns.iter().map(|(_, rows)| rows).max_by_key(|rows| rows.len());
    for ComparedFigure { by, name, .. } in longest.into_iter().flatten() {
        let cell = |rows: &Vec<ComparedFigure>| {
            let own = rows.iter().find(|own| own.by == *by);
            own.map_or(Cell::Missing, |own| own.cell.clone())
        };
        table.row(std::iter::once(name.as_str().into()).chain(columns.iter().map(|(_, rows)| cell(rows))));
    }
    let mut out = Document::default();
    out.heading_on_page(if view.published.is_some() {
        "Given and designed side by side"
    } else {
        "What it reaches"
    });
    out.table(table);
    out
}

/// The first design, if the repair found another one.
fn before_repair(view: &ProjectDesign) -> Option<&ProjectDesign> {
    let repair = view.repair.as_ref().filter(|repair| repair.status == RepairStatus::Met)?;
    repair.other.as_deref()
}

/// The limits at which the smallest relaxation is found, with their plants.
fn conflicts(view: &ProjectDesign) -> Table {
    let DesignStatus::Infeasible(relaxation) = &view.design.status else { return Table::default() };
    limits(view, &relaxation.conflicts)
}

fn limits(view: &ProjectDesign, margins: &[SpecificationMargin]) -> Table {
    let names = &view.designed.view.names;
    let mut found = Table::new(["specification", "rad/s", "margin"].into_iter().chain(names.headings()));
    for SpecificationMargin { specification, frequency_rad_per_s, margin_db, plant, .. } in margins {
        let name = searched_limit_name(view, view.searched_limit(*specification)).into();
        let row = [name, Cell::frequency(*frequency_rad_per_s), Cell::margin(*margin_db)];
        found.row(row.into_iter().chain(plant_cells(names, plant).into_iter().map(Cell::from)));
    }
    found
}

fn rounds(view: &ProjectDesign) -> Table {
    let headings =
        ["", "structure", "objective", "plants", "frequencies", "margin searched", "margin audited"];
    let row = |(index, round): (usize, &DesignRound)| {
        [
            Cell::count(index + 1),
            structure_words(&round.structure).into(),
            format!("{} dB", significant(round.objective_db, 5)).into(),
            Cell::count(round.plants),
            Cell::count(round.frequencies),
            Cell::margin(round.searched_margin_db),
            round.audited_margin_db.map_or("unstable".into(), Cell::margin),
        ]
    };
    Table::new(headings).with(view.design.rounds.iter().enumerate().map(row))
}

/// Effect that another seed may have.
fn seed_sentence(view: &ProjectDesign) -> String {
    let better = match (&view.design.status, view.options.objective) {
        (DesignStatus::Infeasible(_), _) => "may need less relaxation",
        (DesignStatus::NotConverged { .. } | DesignStatus::NotStabilised, _) => "may find one",
        (DesignStatus::Met, Objective::BestWorstMargin) => "may end with more margin",
        (DesignStatus::Met, _) => "may end lower",
    };
    format!("started from random points (seed {}); a local optimum: other seeds {better}", view.options.seed)
}

/// Dependence of the result on its starting points: the ends of the descents of the last search.
fn starts_sentence(starts: &Starts) -> String {
    let mut sentence = format!("{} of {} starts stabilise every plant", starts.stabilised, starts.evaluated);
    let three = |[best, median, worst]: [String; 3]| format!("best {best}, median {median}, worst {worst}");
    if let Some(margins_db) = starts.margins_db {
        let (descents, margins) = (starts.completed, three(margins_db.map(margin_words)));
        sentence.push_str(&format!("; worst margin where {descents} descents ended: {margins}"));
    }
    if let Some(objectives_db) = starts.objectives_db {
        let objectives = three(objectives_db.map(|value| format!("{} dB", significant(value, 4))));
        sentence.push_str(&format!("; objective of those that satisfy the limits: {objectives}"));
    }
    sentence
}

/// Settings of the command line are not in the file that a design writes.
fn settings_sentence(loaded: &Loaded) -> Option<String> {
    let others: Vec<&str> = loaded
        .settings
        .iter()
        .map(|setting| setting.trim())
        .filter(|setting| !setting.starts_with("controller") || setting.contains("quantization"))
        .collect();
    (!others.is_empty()).then(|| {
        format!(
            "A project written by this design does not contain what was set on the command line: --set {}",
            others.join(" --set ")
        )
    })
}
