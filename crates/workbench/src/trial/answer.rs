//! What the machine did, for people and for programs.

use serde::Serialize;

use super::percent_words;
use super::{Agreement, Run, Step, Trial, agreement_word};
use crate::answer::table;
use crate::audit::NamedPlant;
use crate::quantity::DisplayUnit;

/// The key `machine` of an answer.
#[derive(Serialize)]
pub(crate) struct Body<'a> {
    verdict: &'static str,
    runs: Vec<RunRow<'a>>,
    not_driven: &'a [String],
}

#[derive(Serialize)]
struct RunRow<'a> {
    what: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    plant: Option<&'a NamedPlant>,
    status: &'static str,
    agrees: bool,
    agreement: &'static str,
    reason: &'a str,
    reference_n: [f64; 2],
    linear: Option<StepRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    linear_reason: Option<&'static str>,
    machine: Option<StepRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    machine_reason: Option<&'static str>,
}

#[derive(Serialize)]
struct StepRow {
    overshoot_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    overshoot_percent_reason: Option<&'static str>,
    settling_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    settling_time_s_reason: Option<&'static str>,
}

fn step(step: &Step) -> StepRow {
    StepRow {
        overshoot_percent: step.overshoot_percent,
        overshoot_percent_reason: step.overshoot_percent.is_none().then_some("the run ended before"),
        settling_time_s: step.settling_time_s,
        settling_time_s_reason: step.settling_time_s.is_none().then_some("it does not settle within the run"),
    }
}

fn row(run: &Run) -> RunRow<'_> {
    RunRow {
        what: &run.what,
        plant: run.plant.as_ref(),
        status: run.status,
        agrees: run.agreement == Agreement::Agrees,
        agreement: agreement_word(run.agreement),
        reason: &run.reason,
        reference_n: run.reference_n,
        linear: run.linear.as_ref().map(step),
        linear_reason: run
            .linear
            .is_none()
            .then_some("the linear loop has no step response in closed form, or grows"),
        machine: run.machine.as_ref().map(step),
        machine_reason: run.machine.is_none().then_some("it does not start"),
    }
}

/// What a trial says in JSON.
pub(crate) fn body(trial: &Trial) -> Body<'_> {
    Body {
        verdict: agreement_word(trial.agreement()),
        runs: trial.runs.iter().map(row).collect(),
        not_driven: &trial.not_driven,
    }
}

/// What the table for people says of each machine.
pub(crate) const HEADINGS: [&str; 6] = ["machine", "", "overshoot", "linear", "settles in", "linear"];

/// A row of that table.
pub(crate) fn cells(run: &Run) -> [String; HEADINGS.len()] {
    let settling = |step: Option<&Step>| match step.and_then(|step| step.settling_time_s) {
        Some(time_s) => DisplayUnit::MILLISECOND.text(time_s, 3),
        None => "-".to_string(),
    };
    let overshoot = |step: Option<&Step>| match step.and_then(|step| step.overshoot_percent) {
        Some(percent) => percent_words(percent),
        None => "-".to_string(),
    };
    let (linear, machine) = (run.linear.as_ref(), run.machine.as_ref());
    [
        run.what.clone(),
        agreement_word(run.agreement).to_string(),
        overshoot(machine),
        overshoot(linear),
        settling(machine),
        settling(linear),
    ]
}

/// Why a machine does not do what the linear loop does, and which plants were not driven.
pub(crate) fn reasons(trial: &Trial) -> Vec<String> {
    let others = trial.runs.iter().filter(|run| run.agreement != Agreement::Agrees);
    let told = others.map(|run| format!("{}: {}", run.what, run.reason));
    told.chain(trial.not_driven.iter().map(|missing| format!("not driven: {missing}"))).collect()
}

/// The same for people.
pub(crate) fn text(trial: &Trial) -> String {
    let mut rows = table(&HEADINGS);
    for run in &trial.runs {
        rows.add_row(cells(run));
    }
    let mut out = format!("\nOn the machine: {}\n{}\n", agreement_word(trial.agreement()), rows.trim_fmt());
    for reason in reasons(trial) {
        out.push_str(&format!("  {reason}\n"));
    }
    out
}
