//! A sizing for people.

use super::answer::branch_name;
use super::{Candidate, Consequence, Influence, Sizing, model_name};
use crate::answer::significant;
use crate::document::{Cell, Document, StatusMark, Table};
use crate::figure::Figure;
use crate::quantity::DisplayUnit;

/// The tables and sentences of `size`.
pub fn text(sizing: &Sizing) -> String {
    document(sizing, vec![]).text()
}

/// Every decision, the candidates with the objections to them, the answer with its figures, and the
/// uncertainties.
pub(crate) fn document(sizing: &Sizing, figures: Vec<Figure>) -> Document {
    let mut out = Document::default();
    out.heading("Procedure (letters as in the flowchart of Ledezma 2019, section 6.3.2)");
    out.sentences(sizing.decisions.iter().map(|decision| format!("({}) {}", decision.step, decision.text)));
    let headings = ["", "hose", "compliance", "branch", "length", "K_H over the stroke", "K_p", "tau"];
    out.section("Candidates", Table::new(headings).with(sizing.candidates.iter().map(candidate_cells)));
    for group in alike(&sizing.candidates) {
        findings(&mut out, &group);
    }
    out.heading("Answer");
    let [own, other] =
        [sizing.model, sizing.other_model()].map(|model| (model_name(model), sizing.best_of(model)));
    out.marked([
        (Some(own.1.is_some().into()), format!("{} (the project's): {}", own.0, answer_sentence(own.1))),
        (Some(other.1.is_some().into()), format!("{}: {}", other.0, answer_sentence(other.1))),
    ]);
    out.figures(figures);
    let headings = ["quantity", "low · nominal · high", "K_H at this length, MN/m", "length for this K_H, m"];
    out.section(
        "What is uncertain",
        Table::new(headings).with(sizing.influences.iter().map(influence_cells)),
    );
    if !sizing.influences.is_empty() {
        out.explanation("Each number goes from its low to its high value while all others stay nominal. Stiffening has its declared interval; where none is stated, 10 % either way is assumed.");
    }
    out
}

/// What to buy and which gain to set, in a sentence.
fn answer_sentence(best: Option<&Candidate>) -> String {
    match best {
        None => {
            "no hose of the catalogue satisfies every requirement; the reasons are listed with the candidates.".to_string()
        }
        Some(candidate) => format!(
            "{} with {}: K_H from {} to {} MN/m over the stroke, K_p = {} V/N.",
            candidate.option.name,
            candidate.branch.length_words(3),
            DisplayUnit::MEGANEWTON_PER_METRE.number(candidate.branch.stiffness.minimum, 3),
            DisplayUnit::MEGANEWTON_PER_METRE.number(candidate.branch.stiffness.maximum, 3),
            significant(candidate.branch.gain_v_per_n, 3)
        ),
    }
}

/// Candidates of one hose with the same findings, so that these are stated once; in the order of
/// the first of each.
fn alike(candidates: &[Candidate]) -> Vec<Vec<&Candidate>> {
    let mut groups: Vec<Vec<&Candidate>> = Vec::new();
    for candidate in candidates {
        let same = |group: &&mut Vec<&Candidate>| {
            group.first().is_some_and(|first| {
                first.option.name == candidate.option.name && first.findings == candidate.findings
            })
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(candidate),
            None => groups.push(vec![candidate]),
        }
    }
    groups
}

/// The common objections to these candidates.
fn findings(out: &mut Document, group: &[&Candidate]) {
    let Some(first) = group.first().filter(|first| !first.findings.is_empty()) else { return };
    let verdict = if first.accepted() { "accepted" } else { "rejected" };
    let name =
        |one: &&Candidate| format!("{} {}", model_name(one.branch.model), branch_name(one.branch.by_gain));
    let names: Vec<String> = group.iter().map(name).collect();
    out.heading(format!("{} ({}): {verdict}", first.option.name, names.join(", ")));
    out.marked(first.findings.iter().map(|finding| match finding.severity {
        Consequence::Rejects => (Some(StatusMark::Bad), format!("rejects: {}", finding.text)),
        _ => (Some(StatusMark::Note), format!("warns: {}", finding.text)),
    }));
}

fn candidate_cells(candidate: &Candidate) -> [Cell; 8] {
    let branch = &candidate.branch;
    let stiffness = &branch.stiffness;
    let accepted = candidate.accepted();
    let [fastest, slowest] =
        candidate.time_constant_s.map(|time_s| DisplayUnit::MILLISECOND.number(time_s, 3));
    [
        Cell::from(if accepted { "yes" } else { "no" }).marked(accepted),
        Cell::Code(candidate.option.name.clone()),
        Cell::Code(model_name(branch.model).to_string()),
        Cell::Code(branch_name(branch.by_gain).to_string()),
        match branch.is_alike() {
            true => format!("{} m", significant(candidate.length_m(), 4)).into(),
            false => branch.lengths_m.map(|length| format!("{} m", significant(length, 4))).join(", ").into(),
        },
        format!("{} to {} N/m", significant(stiffness.minimum, 4), significant(stiffness.maximum, 4)).into(),
        format!("{} V/N", significant(branch.gain_v_per_n, 3)).into(),
        format!("{fastest} to {slowest} ms").into(),
    ]
}

fn influence_cells(influence: &Influence) -> [String; 4] {
    let three = |values: [f64; 3]| values.map(|value| significant(value, 4)).join(" · ");
    let mega = DisplayUnit::MEGANEWTON_PER_METRE;
    [
        influence.quantity.to_string(),
        influence.setting_words(),
        three(influence.stiffness_n_per_m.map(|stiffness| mega.of(stiffness))),
        three(influence.length_m),
    ]
}
