//! The key `machine` of an answer.

use super::{Agreement, Trial, TrialRun, TrialStep, agreement_word};
use crate::answer::Object;

/// A trial in JSON.
pub(crate) fn body(trial: &Trial) -> Object {
    Object::new()
        .with("verdict", agreement_word(trial.agreement()))
        .each("runs", &trial.runs, row)
        .with("not_driven", trial.not_driven.as_slice())
}

fn row(run: &TrialRun) -> Object {
    let no_step = "the linear loop has no step response in closed form, or grows";
    Object::new()
        .with("what", run.what.as_str())
        .maybe("plant", run.plant.clone())
        .with("status", run.status)
        .with("agrees", run.agreement == Agreement::Agrees)
        .with("agreement", agreement_word(run.agreement))
        .with("reason", run.reason.as_str())
        .with("reference_n", run.reference_n)
        .known("linear", run.linear.as_ref().map(step), no_step)
        .known("machine", run.machine.as_ref().map(step), "it does not start")
}

fn step(step: &TrialStep) -> Object {
    Object::new().known("overshoot_percent", step.overshoot_percent, "the run ended before").known(
        "settling_time_s",
        step.settling_time_s,
        "it does not settle within the run",
    )
}
