//! The key `machine` of an answer.

use super::words::{agreement_key, not_driven, reason_words, run_name};
use super::{Agreement, HeldRequirement, Leg, StepSize, Trial, TrialRun, TrialStep};
use crate::answer::Object;
use crate::quantity::{FORCE, QuantityName};
use crate::simulate::satisfied_word;

/// A trial in JSON.
pub(crate) fn body(trial: &Trial) -> Object {
    Object::new()
        .with("verdict", agreement_key(trial.agreement()))
        .maybe("requirements", trial.satisfies().map(satisfied_word))
        .each("runs", &trial.runs, row)
        .with("not_driven", not_driven(trial))
}

fn row(run: &TrialRun) -> Object {
    let no_step = "the linear loop has no step response in closed form, or grows";
    Object::new()
        .with("what", run_name(run))
        .maybe("plant", run.plant.clone())
        .with("status", run.status.key())
        .with("agrees", run.agreement <= Agreement::AgreesButForSettling)
        .with("agreement", agreement_key(run.agreement))
        .with("reason", reason_words(&run.reason, run.units))
        .with(QuantityName::moving("reference", &FORCE), run.reference_n)
        .with("step", size_word(run.size))
        .with("worst_step", leg_word(run.worst))
        .known(
            QuantityName::moving("remaining_amplitude", &FORCE),
            run.remaining_amplitude_n,
            "the run ended before",
        )
        .known("linear", run.linear.as_ref().map(step), no_step)
        .known("machine", run.machine.as_ref().map(step), "it does not start")
        .each("steps", &run.legs, |(leg, of_leg)| {
            Object::new().with("step", leg_word(*leg)).and(step(of_leg))
        })
        .each("requirements", &run.requirements, held)
}

/// The worst of the steps of a run against what is required in time.
fn held(held: &HeldRequirement) -> Object {
    let HeldRequirement { number, wish, reached, is_satisfied, .. } = held;
    let required = Object::new()
        .maybe("overshoot_percent", wish.overshoot_percent)
        .maybe("settling_time_s", wish.settling_time_s)
        .maybe("rise_time_s", wish.rise_time_s)
        .with("settling_band_percent", wish.band_percent);
    Object::new()
        .with("specification", *number)
        .with("verdict", satisfied_word(*is_satisfied))
        .with("required", required)
        .with("overshoot_percent", reached.overshoot_percent)
        .with("settling_time_s", reached.settling_time_s)
        .with("rise_time_s", reached.rise_time_s)
}

fn size_word(size: StepSize) -> &'static str {
    match size {
        StepSize::Tenth => "tenth_of_supply_force",
        StepSize::Reversed => "tenth_of_supply_force_reversed",
        StepSize::Scenario => "scenario",
        StepSize::Largest => "largest_unsaturated",
        StepSize::Required => "required",
    }
}

fn leg_word(leg: Leg) -> &'static str {
    match leg {
        Leg::There => "there",
        Leg::Back => "back",
        Leg::Again => "there_again",
    }
}

fn step(step: &TrialStep) -> Object {
    Object::new().known("overshoot_percent", step.overshoot_percent, "the run ended before").known(
        "settling_time_s",
        step.settling_time_s,
        "it does not settle within the run",
    )
}
