//! The key `machine` of an answer.

use super::words::{agreement_key, not_driven, reason_words, run_name};
use super::{Agreement, HeldRequirement, Leg, StepSize, Trial, TrialRun, TrialStep};
use crate::answer::{Answer, OrReason, words};
use crate::plant_names::NamedPlant;
use crate::quantity::{FORCE, QuantityName};
use crate::simulate::{RunStatus, Satisfaction, WorstStepAnswer};
use crate::specification::RequiredStepAnswer;

/// Verdict of an audit tested on the nonlinear machine.
#[derive(Answer)]
pub(crate) struct TrialAnswer {
    /// Agreement of the machine with the verdict, the worst of all runs.
    verdict: Agreement,
    /// Outcome for the requirements in time, if there are any.
    #[answer(optional)]
    requirements: Option<Satisfaction>,
    /// Runs, each of a machine through steps of the reference.
    runs: Vec<TrialRunAnswer>,
    /// Machines and steps that were not simulated, with the reason.
    not_driven: Vec<String>,
}

/// Run of a machine through steps there, back and there again.
#[derive(Answer)]
struct TrialRunAnswer {
    /// Name of the machine and the size of its steps.
    what: String,
    /// Plant of the audit from which the machine was made, if any.
    #[answer(optional)]
    plant: Option<NamedPlant>,
    /// Status of the run.
    status: RunStatus,
    /// True if the machine behaves as the linear loop predicts, except for its settling time.
    agrees: bool,
    /// Agreement of the machine with the linear loop.
    agreement: Agreement,
    /// Reason for the agreement.
    reason: String,
    /// Reference before and after the first step.
    #[answer(key = QuantityName::moving("reference", &FORCE))]
    reference: [f64; 2],
    /// Size of the steps.
    step: StepSize,
    /// Worst of the steps.
    worst_step: Leg,
    /// Amplitude of an oscillation that remains: half the range of the force or torque over the
    /// last fifth of a step, the largest of all steps.
    #[answer(key = QuantityName::moving("remaining_amplitude", &FORCE))]
    remaining_amplitude: OrReason<f64>,
    /// Prediction of the linear loop.
    linear: OrReason<TrialStepAnswer>,
    /// Greatest overshoot and longest settling time of the steps of the machine.
    machine: OrReason<TrialStepAnswer>,
    /// Steps of the machine, the first alone if that is decisive.
    steps: Vec<TrialLegAnswer>,
    /// Requirements in time of these steps.
    requirements: Vec<HeldRequirementAnswer>,
}

/// Properties of a step response.
#[derive(Answer)]
struct TrialStepAnswer {
    /// Overshoot, of the step.
    overshoot_percent: OrReason<f64>,
    /// Settling time.
    settling_time_s: OrReason<f64>,
}

/// Step of a machine.
#[derive(Answer)]
struct TrialLegAnswer {
    /// Step of the run.
    step: Leg,
    #[answer(flatten)]
    response: TrialStepAnswer,
}

/// Worst of the steps of a run against a requirement in time.
#[derive(Answer)]
struct HeldRequirementAnswer {
    /// Number of the specification, from 1 in the order of the file.
    specification: usize,
    /// Outcome for the requirement.
    verdict: Satisfaction,
    /// Required step response.
    required: RequiredStepAnswer,
    /// Worst step of the run.
    reached: WorstStepAnswer,
}

words! {
    /// Agreement of a machine with its linear loop, best first.
    Agreement by agreement_key [Agrees, AgreesButForSettling, Differs, Contradicts]
}

words! {
    /// Size of the steps of a run: a tenth of the force of the supply and its reverse, a step of a
    /// scenario, the largest that meets no limit, or the one of a requirement.
    StepSize {
        Tenth => "tenth_of_supply_force",
        Reversed => "tenth_of_supply_force_reversed",
        Scenario => "scenario",
        Largest => "largest_unsaturated",
        Required => "required",
    }
}

words! {
    /// Step of a run, from the force of the operating point and back.
    Leg { There => "there", Back => "back", Again => "there_again" }
}

/// A trial in JSON.
pub(crate) fn body(trial: &Trial) -> TrialAnswer {
    TrialAnswer {
        verdict: trial.agreement(),
        requirements: trial.satisfies().map(Satisfaction::from),
        runs: trial.runs.iter().map(row).collect(),
        not_driven: not_driven(trial),
    }
}

fn row(run: &TrialRun) -> TrialRunAnswer {
    let no_step = "the linear loop has no step response in closed form, or grows";
    let legs = run.legs.iter();
    TrialRunAnswer {
        what: run_name(run),
        plant: run.plant.clone(),
        status: run.status,
        agrees: run.agreement <= Agreement::AgreesButForSettling,
        agreement: run.agreement,
        reason: reason_words(&run.reason, run.units),
        reference: run.reference_n,
        step: run.size,
        worst_step: run.worst,
        remaining_amplitude: OrReason::new(run.remaining_amplitude_n, "the run ended before"),
        linear: OrReason::new(run.linear.as_ref().map(step), no_step),
        machine: OrReason::new(run.machine.as_ref().map(step), "it does not start"),
        steps: legs.map(|(leg, own)| TrialLegAnswer { step: *leg, response: step(own) }).collect(),
        requirements: run.requirements.iter().map(held).collect(),
    }
}

/// The worst of the steps of a run against what is required in time.
fn held(held: &HeldRequirement) -> HeldRequirementAnswer {
    HeldRequirementAnswer {
        specification: held.number,
        verdict: held.is_satisfied.into(),
        required: (&held.step_limits).into(),
        reached: held.reached.into(),
    }
}

fn step(step: &TrialStep) -> TrialStepAnswer {
    TrialStepAnswer {
        overshoot_percent: OrReason::new(step.overshoot_percent, "the run ended before"),
        settling_time_s: OrReason::new(step.settling_time_s, "it does not settle within the run"),
    }
}
