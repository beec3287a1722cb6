//! An audit for people.

use phea_dynamics::portable;
use phea_qft::proof::{ClaimStatus, Proof};
use phea_qft::verification::{SpecificationFinding, SpecificationMargin, Verdict};

use super::family_and_loop::{family_sentence, loop_sentence, position_sentence};
use super::proven::{status_word, why_not_proven};
use super::remark::remark_sentences;
use super::stability::{infinity_sentence, stability_sentence};
use super::words::{closed_loop_symbol, evidence_sentence, finding_sentence, place_words, worst_at_design};
use super::{DelayedPaths, ProjectAudit, below_design, in_time, margins, noise_sentence};
use crate::caveat;
use crate::document::{Cell, Document, Table};
use crate::figure::Figure;
use crate::grouped::grouped;
use crate::plant_names::plant_cells;
use crate::quantity::{DisplayUnit, significant};
use crate::robust::DEFAULT_TOLERANCE_DB;
use crate::specification::{name_words, numbered};
use crate::trial::{self, Trial};
use crate::verdict_words::verdict_words;

/// The tables and sentences of `verify` for people, with the trial on the machine if there is one.
pub fn output(view: &ProjectAudit, trial: Option<&Trial>) -> Document {
    let mut out = document(view, vec![]);
    out.append(proven(view, "What is proven"));
    if let Some(trial) = trial {
        out.append(trial::document(trial, None));
    }
    out
}

/// An audit: the verdict first, then the figures, then its basis.
pub(crate) fn document(view: &ProjectAudit, figures: Vec<Figure>) -> Document {
    let verdict = view.verdict();
    let mut out = Document::default();
    out.verdict(verdict.into(), format!("Verdict: {}", verdict_words(verdict)), summary(view));
    out.section("Specifications", specifications(view));
    out.section("Margins", margins::table(view));
    out.append(below_design::document(view));
    out.section("Worst plants", plants(view));
    out.section("Where examined plants violate it", violations(view));
    out.figures_below("Closed loops of the family", figures);
    out.heading("What this rests on");
    out.sentences(basis(view));
    out
}

/// Stability, delay margin and each specification, a sentence each, preceded by the effects that
/// none of them includes.
pub(crate) fn summary(view: &ProjectAudit) -> Vec<String> {
    let mut sentences: Vec<String> = caveat::sentences(&view.caveats, &view.units);
    sentences.push(stability_sentence(&view.audit.stability, &view.names));
    sentences.extend(delay_sentence(view));
    sentences.extend(view.nominal.as_ref().and_then(margins::reduction_sentence));
    let noise = view.velocity_noise.iter().chain(&view.pressure_noise);
    sentences.extend(noise.map(|noise| noise_sentence(noise, &view.names)));
    let stable = view.audit.stability.verdict != Verdict::Violated;
    let findings = view.audit.specifications.iter().enumerate();
    sentences.extend(findings.map(|(index, finding)| {
        let reached = view.reached.get(index).and_then(Option::as_ref);
        finding_sentence(
            &numbered(view.named(index)),
            finding,
            reached,
            stable.then_some(view.audit.tolerance_db),
        )
    }));
    sentences.extend(
        view.in_time
            .iter()
            .filter(|finding| finding.requirement.follows)
            .map(|finding| in_time::sentence(view, finding)),
    );
    sentences.extend(view.amplifying_prefilter.as_ref().map(in_time::prefilter_sentence));
    sentences
}

fn delay_sentence(view: &ProjectAudit) -> Option<String> {
    let margin = view.audit.delay_margin.as_ref()?;
    if margin.delay_s == f64::INFINITY {
        return Some("no delay makes a plant unstable".to_string());
    }
    Some(format!(
        "the loop tolerates {} ms more delay{} before a plant becomes unstable, {}",
        DisplayUnit::MILLISECOND.number(margin.delay_s, 3),
        delayed_words(view.delayed_paths),
        place_words(margin.frequency_rad_per_s)
    ))
}

fn delayed_words(paths: DelayedPaths) -> &'static str {
    match (paths.pressure_feedback, paths.velocity_feed_forward) {
        (true, true) => ", of controller, pressure feedback and velocity feed-forward alike,",
        (true, false) => ", of controller and pressure feedback alike,",
        (false, true) => ", of controller and velocity feed-forward alike,",
        (false, false) => "",
    }
}

/// A margin, and its frequency.
fn margin_at(worst: Option<&SpecificationMargin>) -> [Cell; 2] {
    match worst {
        Some(worst) => [Cell::margin(worst.margin_db), Cell::frequency(worst.frequency_rad_per_s)],
        None => [Cell::Missing, Cell::Missing],
    }
}

fn specifications(view: &ProjectAudit) -> Table {
    let mut rows = Table::new([
        "",
        "specification",
        "limits",
        "verdict",
        "worst margin",
        "rad/s",
        "worst at a design frequency",
        "rad/s",
    ]);
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        let mut row = vec![
            view.number_of(index).map_or_else(Cell::empty, Cell::count),
            name_words(view.named(index)).into(),
            closed_loop_symbol(&finding.requirement).into(),
            Cell::verdict(finding.verdict),
        ];
        row.extend(margin_at(finding.worst.as_ref()));
        row.extend(margin_at(worst_at_design(finding)));
        rows.row(row);
        // a worst margin at an end of the band is of little interest; the least margin of the
        // family need not occur where that of one plant does
        let interior = finding.interior.as_ref().filter(|interior| finding.worst.as_ref() != Some(*interior));
        if let Some(interior) = interior {
            let [margin, frequency] = margin_at(Some(interior));
            let inside = "  a plant's own least within the band".into();
            let [one, limits, verdict, design, place] = [(); 5].map(|()| Cell::empty());
            rows.row([one, inside, limits, verdict, margin, frequency, design, place]);
        }
    }
    for finding in view.in_time.iter().filter(|finding| finding.requirement.limits.is_none()) {
        let verdict = Cell::verdict(finding.verdict().unwrap_or(Verdict::NotProven));
        let number = Cell::count(finding.requirement.number);
        let [margin, place, design, at] = [(); 4].map(|()| Cell::empty());
        rows.row([number, "step".into(), "y(t)".into(), verdict, margin, place, design, at]);
    }
    rows
}

/// Proven claims, a row for each, and the reason why a claim is not proven; empty if no proof was
/// requested.
pub(crate) fn proven(view: &ProjectAudit, title: &str) -> Document {
    let mut out = Document::default();
    let Some(proof) = &view.proof else { return out };
    let mut rows = Table::new(["claim", "standing", "closed loop over limit, at least", "at most"]);
    let word =
        |claim_status: &ClaimStatus| Cell::from(status_word(claim_status)).marked(claim_status.verdict());
    rows.row(["every plant is stable".into(), word(&proof.stability), Cell::Missing, Cell::Missing]);
    for (index, own) in proof.specifications.iter().enumerate() {
        let [least, most]: [Cell; 2] = [own.least_db, own.most_db].map(|end| end.map(Cell::margin).into());
        let is_allowed =
            own.claim_status == ClaimStatus::Proven && own.most_db.is_some_and(|most_db| most_db > 0.0);
        let most: Cell = match is_allowed {
            true => most.then(Cell::from(allowed_words(view.audit.tolerance_db))),
            false => most,
        };
        rows.row([numbered(view.named(index)).into(), word(&own.claim_status), least, most]);
    }
    out.section(title, rows);
    out.sentences(not_proven(view, proof));
    let searched = view.in_time.iter().any(|finding| finding.requirement.follows);
    out.sentences(searched.then(|| {
        "what is required in time: the steps of the plants are searched, and no proof covers them".to_string()
    }));
    out
}

/// Words for the tolerance up to which a closed loop is proven to satisfy its limit, dB.
fn allowed_words(tolerance_db: f64) -> String {
    format!(", within the {tolerance_db} dB allowed")
}

/// Reason why claims are neither proven nor refuted, each reason once.
fn not_proven(view: &ProjectAudit, proof: &Proof) -> Vec<String> {
    let named = proof
        .specifications
        .iter()
        .enumerate()
        .map(|(index, own)| (numbered(view.named(index)), &own.claim_status));
    let all = std::iter::once(("stability".to_string(), &proof.stability)).chain(named);
    let reasons =
        all.filter_map(|(name, claim_status)| Some((why_not_proven(view, proof, claim_status)?, name)));
    grouped(reasons).into_iter().map(|(reason, names)| format!("{}: {reason}", names.join(", "))).collect()
}

/// The worst plant of each specification, a column each.
fn plants(view: &ProjectAudit) -> Table {
    let columns = worst_plants(view);
    if columns.is_empty() {
        return Table::default();
    }
    let names = columns.iter().map(|(name, _)| name.as_str());
    let mut rows = Table::new(std::iter::once("parameter").chain(names));
    for (index, parameter) in view.names.headings().into_iter().enumerate() {
        let values =
            columns.iter().map(|(_, cells)| Cell::from(cells.get(index).cloned().unwrap_or_default()));
        rows.row(std::iter::once(Cell::Code(parameter.to_string())).chain(values));
    }
    rows
}

/// The specifications that have a worst plant, each with the values of that plant.
fn worst_plants(view: &ProjectAudit) -> Vec<(String, Vec<String>)> {
    let findings = view.audit.specifications.iter().enumerate();
    let of = |(index, finding): (usize, &SpecificationFinding)| {
        let worst = finding.worst.as_ref()?;
        let (name, own) = (numbered(view.named(index)), plant_cells(&view.names, &worst.plant));
        Some(match &worst.other {
            None => vec![(name, own)],
            Some(other) => {
                let other = plant_cells(&view.names, other);
                vec![(format!("{name}, greatest |T|"), own), (format!("{name}, least |T|"), other)]
            }
        })
    };
    let in_time = view.in_time.iter().filter(|finding| finding.requirement.limits.is_none());
    let of_step = in_time.filter_map(|finding| {
        Some((
            format!("{} step", finding.requirement.number),
            plant_cells(&view.names, &finding.nearest()?.plant),
        ))
    });
    findings.filter_map(of).flatten().chain(of_step).collect()
}

fn violations(view: &ProjectAudit) -> Table {
    let mut rows = Table::new(["specification", "from", "to rad/s", "worst margin", "at rad/s"]);
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        for band in &finding.violations {
            let [from, to] = band.band_rad_per_s.map(Cell::frequency);
            let [margin, frequency] = margin_at(Some(&band.worst));
            rows.row([numbered(view.named(index)).into(), from, to, margin, frequency]);
        }
    }
    rows
}

/// Family, loop, tolerance and everything that was not examined.
pub(crate) fn basis(view: &ProjectAudit) -> Vec<String> {
    let audit = &view.audit;
    let mut sentences =
        vec![family_sentence(view), loop_sentence(view), evidence_sentence(view), tolerance(view)];
    if let Some(position) = &view.position {
        sentences.insert(1, position_sentence(position));
    }
    sentences.extend(infinity_sentence(&audit.stability, &view.names));
    sentences.extend(audit.stability.folding.and_then(folding));
    sentences.extend(margins::sentence(view));
    sentences.extend(remarks(view));
    sentences
}

/// Tolerance within which a specification counts as met, and the accuracy of the plants at the
/// resonances of fitted lines.
fn tolerance(view: &ProjectAudit) -> String {
    let met = portable::rounded(view.audit.tolerance_db, 3);
    let fitted = match view.has_lines_in_motion() {
        true => {
            ", but near the resonances of the lines no margin is known to better than about 0.3 dB, the error of their fitted waves. They are waves in the declared oil: a thinner one damps them less, and is verified by `--set fluid.kinematic_viscosity=...`"
        }
        false => "",
    };
    format!("A margin of -{met} dB still counts as met{fitted}.")
}

/// Uncertainty between the examined plants because of modes that fold; `None` if it is below the
/// default tolerance.
fn folding(change: f64) -> Option<String> {
    let db = -20.0 * portable::log10(1.0 - change);
    (db > DEFAULT_TOLERANCE_DB).then(|| {
        format!(
            "Modes beyond half of the sampling rate change 1 + L by at most {} %, wherever they fold to: between the plants examined no margin is known to better than {} dB.",
            significant(100.0 * change, 2),
            significant(db, 2)
        )
    })
}

/// Remarks, each once, with the specifications that it concerns.
fn remarks(view: &ProjectAudit) -> Vec<String> {
    let found = view.audit.specifications.iter().enumerate().flat_map(|(index, finding)| {
        let remarks = remark_sentences(finding, &view.names).into_iter();
        remarks.map(move |remark| (remark, numbered(view.named(index))))
    });
    grouped(found).into_iter().map(|(remark, names)| format!("{}: {remark}", names.join(", "))).collect()
}
