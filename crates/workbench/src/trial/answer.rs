//! The key `machine` of an answer.

use serde::Serialize;

use super::{Agreement, Trial, TrialRun, TrialStep, agreement_word};
use crate::audit::NamedPlant;

/// The key `machine` of an answer.
#[derive(Serialize)]
pub(crate) struct TrialAnswer<'a> {
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
    linear: Option<TrialStepAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    linear_reason: Option<&'static str>,
    machine: Option<TrialStepAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    machine_reason: Option<&'static str>,
}

#[derive(Serialize)]
struct TrialStepAnswer {
    overshoot_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    overshoot_percent_reason: Option<&'static str>,
    settling_time_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    settling_time_s_reason: Option<&'static str>,
}

fn step(step: &TrialStep) -> TrialStepAnswer {
    TrialStepAnswer {
        overshoot_percent: step.overshoot_percent,
        overshoot_percent_reason: step.overshoot_percent.is_none().then_some("the run ended before"),
        settling_time_s: step.settling_time_s,
        settling_time_s_reason: step.settling_time_s.is_none().then_some("it does not settle within the run"),
    }
}

fn row(run: &TrialRun) -> RunRow<'_> {
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
pub(crate) fn body(trial: &Trial) -> TrialAnswer<'_> {
    TrialAnswer {
        verdict: agreement_word(trial.agreement()),
        runs: trial.runs.iter().map(row).collect(),
        not_driven: &trial.not_driven,
    }
}
