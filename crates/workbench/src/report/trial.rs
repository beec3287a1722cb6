//! What the machine did with a verdict, as a section of the chapter on it.

use maud::{Markup, html};

use super::chapter::{cell, place, table};
use super::typeset::prose;
use crate::figure::{FamilyStepInput, Figure, TimeSeries, Words, family_step};
use crate::trial::{Agreement, HEADINGS, Response, Trial, agreement_word, cells, reasons};

/// The section; nothing without a machine.
pub(super) fn section(trial: Option<&Trial>, figure: Option<&Figure>) -> Markup {
    let Some(trial) = trial else { return html! {} };
    let edge = match trial.agreement() {
        Agreement::Agrees => "callout good-edge",
        Agreement::Differs => "callout",
        Agreement::Contradicts => "callout bad-edge",
    };
    let rows: Vec<Vec<Markup>> =
        trial.runs.iter().map(|run| cells(run).into_iter().map(cell).collect()).collect();
    html! {
        h3 { "On the machine" }
        div class=(edge) {
            p { b { "The machine " (verb(trial.agreement())) "." } " The nonlinear rig under this controller: a step of the reference by a tenth of what the supply can push with, beside that of the linear loop." }
            @let reasons = reasons(trial);
            @if !reasons.is_empty() { ul { @for reason in &reasons { li { (prose(reason)) } } } }
        }
        @if let Some(figure) = figure { (place(figure)) }
        (table(&HEADINGS, 2, &rows))
    }
}

fn verb(agreement: Agreement) -> &'static str {
    match agreement {
        Agreement::Agrees => "agrees with the linear loop",
        Agreement::Differs => "differs from the linear loop",
        Agreement::Contradicts => "contradicts the verdict",
    }
}

/// So many settling times of the linear loop are drawn.
const SETTLING_TIMES: f64 = 3.0;
/// A response that leaves these parts of the step is drawn up to there.
const SHOWN: std::ops::RangeInclusive<f64> = -0.4..=2.4;

/// The steps of all machines that were driven, and that of the linear loop with the nominal plant.
pub(super) fn figure(trial: Option<&Trial>, [name, title]: [&str; 2]) -> Option<Figure> {
    let runs = &trial?.runs;
    let first = runs.first()?;
    let driven_s = first.machine_response.times_s.last().copied()?;
    let settles_s = first.linear.and_then(|step| step.settling_time_s);
    let end_s = settles_s.map_or(driven_s, |time_s| driven_s.min(SETTLING_TIMES * time_s));
    let series = |name: &str, response: &Response| {
        let rows = response.times_s.iter().copied().zip(response.values.iter().copied());
        let shown = rows.take_while(|(time_s, value)| *time_s <= end_s && SHOWN.contains(value));
        let (times_s, values): (Vec<f64>, Vec<f64>) = shown.unzip();
        (!times_s.is_empty()).then(|| TimeSeries { name: name.to_string(), times_s, values })
    };
    let nominal = series("linear loop, nominal plant", &first.linear_response);
    let named = runs.iter().filter_map(|run| series(&run.what, &run.machine_response)).collect();
    let quantity = "Force, part of the step".to_string();
    let input = FamilyStepInput { quantity, nominal, named, ..FamilyStepInput::default() };
    let caption = "A step of the reference on the nonlinear machine: the rig as declared, with waves in its lines, and its worst plants made into rigs. A force that leaves the frame is drawn up to there.";
    Some(family_step(Words::new(name, title, caption), &input))
}

/// The same in a few words: the word, and the machine that is worst.
pub(super) fn words(trial: &Trial) -> String {
    let word = agreement_word(trial.agreement());
    match trial.runs.iter().find(|run| run.agreement == trial.agreement()) {
        Some(run) if run.agreement != Agreement::Agrees => format!("{word}: {}", run.what),
        _ => word.to_string(),
    }
}
