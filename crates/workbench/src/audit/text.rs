use phea_qft::verification::{SpecificationFinding, Verdict, WorstCase};

use super::ProjectAudit;
use super::{
    closed_loop_symbol, evidence_sentence, finding_sentence, frequency_number, margin_words, place_words,
    stability_sentence, verdict_words, worst_at_design,
};
use crate::answer::{significant, table};
use crate::quantity::DisplayUnit;

/// The tables and sentences of `verify` for people: the verdict first, then what it rests on.
pub fn text(view: &ProjectAudit) -> String {
    let audit = &view.audit;
    let mut out = format!("Verdict: {}\n", verdict_words(audit.verdict));
    for sentence in summary(view) {
        out.push_str(&format!("  {sentence}\n"));
    }
    out.push_str(&format!("\nSpecifications\n{}\n", specifications(view)));
    if let Some(plants) = plants(view) {
        out.push_str(&format!("\nWorst plants\n{plants}\n"));
    }
    if let Some(violations) = violations(view) {
        out.push_str(&format!("\nWhere it is violated\n{violations}\n"));
    }
    out.push_str("\nWhat this rests on\n");
    for sentence in basis(view) {
        out.push_str(&format!("  {sentence}\n"));
    }
    out
}

/// Stability, delay margin and each specification, a sentence each; before them what none of them counts.
pub(crate) fn summary(view: &ProjectAudit) -> Vec<String> {
    let mut sentences: Vec<String> = view.caveats.iter().map(|caveat| caveat.sentence.clone()).collect();
    sentences.push(stability_sentence(&view.audit.stability, &view.names));
    sentences.extend(delay_sentence(view));
    let stable = view.audit.stability.verdict != Verdict::Violated;
    let findings = view.audit.specifications.iter().enumerate();
    sentences.extend(findings.map(|(index, finding)| {
        let reached = view.reached.get(index).and_then(Option::as_ref);
        finding_sentence(&view.numbered(index), finding, reached, stable)
    }));
    sentences
}

fn delay_sentence(view: &ProjectAudit) -> Option<String> {
    let margin = view.audit.delay_margin.as_ref()?;
    if margin.delay_s == f64::INFINITY {
        return Some("no delay makes a plant unstable".to_string());
    }
    Some(format!(
        "the loop tolerates {} ms more delay before a plant becomes unstable, {}",
        DisplayUnit::MILLISECOND.number(margin.delay_s, 3),
        place_words(margin.frequency_rad_per_s)
    ))
}

fn margin_at(worst: Option<&WorstCase>) -> [String; 2] {
    match worst {
        Some(worst) => [margin_words(worst.margin_db), frequency_number(worst.frequency_rad_per_s)],
        None => ["-".to_string(), "-".to_string()],
    }
}

fn specifications(view: &ProjectAudit) -> String {
    let headings = [
        "",
        "specification",
        "limits",
        "verdict",
        "worst margin",
        "rad/s",
        "worst at a design frequency",
        "rad/s",
    ];
    let mut rows = table(&headings);
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        let [margin, frequency] = margin_at(finding.worst.as_ref());
        let [design, design_frequency] = margin_at(worst_at_design(finding));
        rows.add_row([
            (index + 1).to_string(),
            view.name_of(index).to_string(),
            closed_loop_symbol(&finding.requirement).to_string(),
            verdict_words(finding.verdict).to_string(),
            margin,
            frequency,
            design,
            design_frequency,
        ]);
        if let Some(interior) = finding.interior.as_ref().filter(|_| rests_on_the_end(finding)) {
            let [margin, frequency] = margin_at(Some(interior));
            let blank = String::new();
            rows.add_row([
                &blank,
                &"  inside its band".to_string(),
                &blank,
                &blank,
                &margin,
                &frequency,
                &blank,
                &blank,
            ]);
        }
    }
    rows.trim_fmt()
}

/// Whether the worst margin says little because it lies at an end of the band.
fn rests_on_the_end(finding: &SpecificationFinding) -> bool {
    finding.worst.as_ref().zip(finding.interior.as_ref()).is_some_and(|(worst, interior)| worst != interior)
}

/// The worst plant of each specification, a column each.
fn plants(view: &ProjectAudit) -> Option<String> {
    let columns = worst_plants(view);
    if columns.is_empty() {
        return None;
    }
    let names: Vec<String> = columns.iter().map(|(name, _)| name.clone()).collect();
    let mut headings = vec!["parameter"];
    headings.extend(names.iter().map(String::as_str));
    let mut rows = table(&headings);
    for (index, parameter) in view.names.headings().into_iter().enumerate() {
        let mut row = vec![parameter.to_string()];
        row.extend(columns.iter().map(|(_, cells)| cells.get(index).cloned().unwrap_or_default()));
        rows.add_row(row);
    }
    Some(rows.trim_fmt())
}

/// The specifications that have a worst plant, each with the values of that plant.
pub(crate) fn worst_plants(view: &ProjectAudit) -> Vec<(String, Vec<String>)> {
    let findings = view.audit.specifications.iter().enumerate();
    findings
        .filter_map(|(index, finding)| {
            let worst = finding.worst.as_ref()?;
            let name = view.numbered(index);
            let own = view.names.cells(&worst.plant);
            Some(match &worst.other {
                None => vec![(name, own)],
                Some(other) => {
                    let other = view.names.cells(other);
                    vec![(format!("{name}, greatest |T|"), own), (format!("{name}, least |T|"), other)]
                }
            })
        })
        .flatten()
        .collect()
}

fn violations(view: &ProjectAudit) -> Option<String> {
    let mut rows = table(&["specification", "from", "to rad/s", "worst margin", "at rad/s"]);
    let mut any = false;
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        for band in &finding.violations {
            let [from, to] = band.band_rad_per_s.map(frequency_number);
            let [margin, frequency] = margin_at(Some(&band.worst));
            rows.add_row([view.numbered(index), from, to, margin, frequency]);
            any = true;
        }
    }
    any.then(|| rows.trim_fmt())
}

/// Family, loop, tolerance and everything that was not looked at.
pub(crate) fn basis(view: &ProjectAudit) -> Vec<String> {
    let audit = &view.audit;
    let mut sentences = vec![
        view.family_sentence(),
        view.loop_sentence(),
        evidence_sentence(audit.evidence, view.names.headings().is_empty()).to_string(),
        format!("A margin of -{} dB still counts as met.", significant(audit.tolerance_db, 1)),
    ];
    sentences.extend(remarks(view));
    sentences
}

/// Each remark once, with the specifications that it is made of.
fn remarks(view: &ProjectAudit) -> Vec<String> {
    let mut found: Vec<(&str, Vec<String>)> = Vec::new();
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        for remark in &finding.remarks {
            let name = view.numbered(index);
            match found.iter_mut().find(|(text, _)| text == remark) {
                Some((_, names)) => names.push(name),
                None => found.push((remark, vec![name])),
            }
        }
    }
    found.into_iter().map(|(remark, names)| format!("{}: {remark}", names.join(", "))).collect()
}
