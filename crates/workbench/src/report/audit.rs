//! The chapter on the audit of the given controller: the verdict in words, where it is worst, and the pictures of it.

use maud::{Markup, html};
use phea_qft::verification::{SpecificationFinding, Verdict, WorstCase};

use super::chapter::{Chapter, cell, place, table, wide};
use super::typeset::prose;
use super::{closed_loops, family_steps, trial};
use crate::audit::{
    ProjectAudit, basis, closed_loop_symbol, frequency_number, frequency_words, margin_words, meaning,
    summary, verdict_words, worst_at_design, worst_plants,
};
use crate::command::CommandError;
use crate::robust::RobustProblem;
use crate::trial::Trial;

pub(super) fn chapter(
    problem: &RobustProblem,
    view: &ProjectAudit,
    trial: Option<&Trial>,
) -> Result<Chapter, CommandError> {
    let mut figures = closed_loops::figures(problem, &view.audit.specifications, view.audit.tolerance_db)?;
    let steps = family_steps::figure(problem, view, ["family_steps", "Step responses of the family"]);
    let driven = trial::figure(trial, ["machine_steps", "The controller on the machine"]);
    let body = html! {
        (verdict(view))
        (trial::section(trial, driven.as_ref()))
        h3 { "Specifications" }
        (specifications(view))
        @if violated(view) { h3 { "Where it is violated" } (violations(view)) }
        @if !worst_plants(view).is_empty() {
            h3 { "Worst plants" }
            p { "The plant of the family with which each specification fares worst; a test bench shows it only when it is set up as this one." }
            (plants(view))
        }
        @if !figures.is_empty() { h3 { "Closed loops of the family" } }
        @for figure in &figures { (place(figure)) }
        @match &steps {
            Some(Ok(figure)) => (place(figure)),
            Some(Err(reason)) => p { "No step responses of the family: " (reason) "." },
            None => {},
        }
        h3 { "What this rests on" }
        ul { @for sentence in basis(view) { li { (prose(&sentence)) } } }
    };
    figures.extend(steps.and_then(Result::ok));
    figures.splice(0..0, driven);
    Ok(Chapter { anchor: "audit", title: "Audit of the controller", body, figures })
}

pub(super) fn verdict_edge(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Met => "callout good-edge",
        Verdict::Violated => "callout bad-edge",
        Verdict::NotProven => "callout",
    }
}

fn verdict(view: &ProjectAudit) -> Markup {
    html! {
        div class=(verdict_edge(view.audit.verdict)) {
            p { b { "Verdict: " (verdict_words(view.audit.verdict)) "." } }
            ul { @for sentence in summary(view) { li { (prose(&sentence)) } } }
        }
    }
}

fn verdict_cell(verdict: Verdict) -> Markup {
    let class = match verdict {
        Verdict::Met => "good",
        Verdict::Violated => "bad",
        Verdict::NotProven => "",
    };
    html! { span class=(class) { (verdict_words(verdict)) } }
}

fn margin_cell(worst: Option<&WorstCase>) -> Markup {
    match worst {
        Some(worst) => {
            html! { (margin_words(worst.margin_db)) " " (frequency_words(worst.frequency_rad_per_s)) }
        }
        None => cell("-"),
    }
}

fn specifications(view: &ProjectAudit) -> Markup {
    let row = |(index, finding): (usize, &SpecificationFinding)| {
        vec![
            html! { (view.numbered(index)) ", " (prose(closed_loop_symbol(&finding.requirement))) },
            cell(meaning(&finding.requirement)),
            verdict_cell(finding.verdict),
            margin_cell(finding.worst.as_ref()),
            margin_cell(worst_at_design(finding)),
        ]
    };
    let rows: Vec<Vec<Markup>> = view.audit.specifications.iter().enumerate().map(row).collect();
    let headings =
        ["specification", "what it asks for", "verdict", "worst margin", "worst at a design frequency"];
    table(&headings, 9, &rows)
}

fn violated(view: &ProjectAudit) -> bool {
    view.audit.specifications.iter().any(|finding| !finding.violations.is_empty())
}

fn violations(view: &ProjectAudit) -> Markup {
    let mut rows = Vec::new();
    for (index, finding) in view.audit.specifications.iter().enumerate() {
        for band in &finding.violations {
            let [from, to] = band.band_rad_per_s.map(frequency_number);
            rows.push(vec![
                cell(view.numbered(index)),
                cell(format!("{from} to {to} rad/s")),
                margin_cell(Some(&band.worst)),
                cell(view.names.text(&band.worst.plant)),
            ]);
        }
    }
    wide(&table(&["specification", "band", "worst margin", "plant"], 9, &rows))
}

/// The worst plant of each specification, a column each.
fn plants(view: &ProjectAudit) -> Markup {
    let columns = worst_plants(view);
    let mut headings = vec!["parameter"];
    headings.extend(columns.iter().map(|(name, _)| name.as_str()));
    let row = |(index, parameter): (usize, &str)| {
        let mut row = vec![html! { code { (parameter) } }];
        row.extend(columns.iter().map(|(_, cells)| cell(cells.get(index).cloned().unwrap_or_default())));
        row
    };
    let rows: Vec<Vec<Markup>> = view.names.headings().into_iter().enumerate().map(row).collect();
    table(&headings, 1, &rows)
}
