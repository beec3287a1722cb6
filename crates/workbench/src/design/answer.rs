//! The answer of `design`.

mod binding;
mod explained;
mod law;
mod limits;
mod manual;
mod pressure_feedback;
mod relaxed;
mod repair;
mod rounding;
mod rounds;
mod side;
mod status;
mod structures;

use phea_dynamics::linear::LinearError;
use phea_qft::design::{DesignStatus, Objective};

use super::structures::earned_per_pole_db;
use super::words::unusable_words;
use super::{DesignPart, LedBy, ProjectDesign};
use crate::answer::{Answer, OrReason, words};
use crate::audit::{self, AuditAnswer};
use crate::project::DESIGN_OBJECTIVES;
use crate::trial::{self, Agreement, TrialAnswer};
use binding::{BindingLimitAnswer, binding, conflicts};
use explained::{ExplanationAnswer, explanations};
pub(super) use law::factors;
use law::{ContinuousLawAnswer, FactoredLawAnswer, StructureAnswer, continuous_law, structure};
use limits::DesignLimitAnswer;
use manual::ManualAnswer;
pub use pressure_feedback::pressure_feedback_object;
use pressure_feedback::{PressureFeedbackAnswer, feedback};
use relaxed::RelaxationAnswer;
use repair::RepairAnswer;
use rounding::RoundingAnswer;
use rounds::{DesignRoundAnswer, SearchStartsAnswer, rounds, starts};
use side::{AuditedControllerAnswer, LoopFiguresAnswer, audited, figures};
use status::DesignOutcomeKind;
use structures::ReachedStructureAnswer;

/// Answer of `design`.
#[derive(Answer)]
pub(crate) struct DesignAnswer {
    /// Outcome of the design.
    status: DesignOutcomeKind,
    /// Reason not to use the designed controller, only if there is one.
    #[answer(optional)]
    unusable: Option<String>,
    /// Parts that were not finished because the design was stopped.
    unfinished: Vec<DesignPart>,
    /// Objective of the search.
    objective: ObjectiveAnswer,
    /// Seed of the pseudo-random numbers of the search.
    seed: u64,
    /// Designed controller G; of a sampled loop in z.
    controller: FactoredLawAnswer,
    /// Prefilter F of the designed loop; of a sampled loop in z.
    prefilter: OrReason<FactoredLawAnswer>,
    /// Pressure feedback that was designed before the loop, only if `design.pressure_feedback` is
    /// free.
    #[answer(optional)]
    pressure_feedback: Option<PressureFeedbackAnswer>,
    /// Controller and prefilter before they are sampled, only of a sampled loop whose controller is
    /// a continuous law.
    #[answer(optional)]
    continuous_law: Option<ContinuousLawAnswer>,
    /// Figures by which controllers are compared.
    figures: LoopFiguresAnswer,
    /// Structure of the designed controller.
    structure: StructureAnswer,
    /// Designed controller in the terms of a controller's manual, before it is sampled.
    manual: OrReason<ManualAnswer>,
    /// Structures that were designed, in the order of the search.
    structures: Vec<ReachedStructureAnswer>,
    /// Requirements that led the last search.
    led_by: LedBy,
    /// Reduction of the compared quantity that each further pole must bring, `inf` if no longer
    /// structure replaces a shorter one; only if several named structures are designed.
    #[answer(optional)]
    earned_per_pole_db: Option<f64>,
    /// Audit of the designed controller over the family and the frequency band.
    verification: AuditAnswer,
    /// Controller that the project gives, with its audit; null if there is none, for the reason in
    /// `published_reason`.
    published: Option<AuditedControllerAnswer>,
    /// Controller that was designed without sampling, sampled and audited like the loop, only of a
    /// sampled loop.
    #[answer(optional)]
    continuous_as_sampled: Option<AuditedControllerAnswer>,
    /// Least additional delay that every plant must tolerate.
    minimum_delay_margin_s: f64,
    /// Limits in addition to the specifications.
    limits: Vec<DesignLimitAnswer>,
    /// Margin of the search to every limit, for what lies between its plants and frequencies.
    reserve_db: f64,
    /// Reason for the absence of `published`.
    #[answer(optional)]
    published_reason: Option<&'static str>,
    /// Rounds of search and audit.
    rounds: Vec<DesignRoundAnswer>,
    /// Starts of the last search.
    starts: OrReason<SearchStartsAnswer>,
    /// Limits over frequency that bind.
    binding: Vec<BindingLimitAnswer>,
    /// Gain from relaxing each limit that binds.
    relaxations: Vec<RelaxationAnswer>,
    /// Amount by which every limit must be relaxed for a controller to satisfy it.
    relaxation_db: OrReason<f64>,
    /// Limits that conflict at this relaxation; empty unless the specifications are infeasible.
    conflicts: Vec<BindingLimitAnswer>,
    /// Facts that are impossible or hard for any controller.
    explanations: Vec<ExplanationAnswer>,
    /// Effect of the converters of the controller's computer, only if a converter rounds.
    #[answer(optional)]
    rounding: Option<RoundingAnswer>,
    /// Designed controller on the nonlinear machine.
    machine: OrReason<TrialAnswer>,
    /// Repair of the design, only if the machine contradicts it and a repair was requested.
    repair: OrReason<RepairAnswer>,
}

/// Objective of a search, with the value of the result.
#[derive(Answer)]
struct ObjectiveAnswer {
    /// Objective of the search.
    kind: Objective,
    /// Objective of the designed controller.
    value_db: OrReason<f64>,
}

words! {
    /// Objective of a search, as `design.objective` names it.
    Objective in DESIGN_OBJECTIVES
}

words! {
    /// Part of a design that a stop may leave unfinished.
    DesignPart by DesignPart::key [
        Search, CommandOfSteps, Trial, Repair, Proof, Relaxations, WithoutSamples, GivenController,
        TemplatesAndBounds,
    ]
}

/// A design in JSON, without the keys of every object.
pub(crate) fn body(view: &ProjectDesign) -> Result<DesignAnswer, LinearError> {
    let (design, side) = (&view.design, &view.designed);
    let prefilter = side.problem.has_prefilter.then(|| factors(side.problem.compensation.prefilter()));
    let relaxation_db = match &design.status {
        DesignStatus::Infeasible(relaxation) => Some(relaxation.relaxation_db),
        _ => None,
    };
    Ok(DesignAnswer {
        status: (&view.verdict()).into(),
        unusable: unusable_words(view),
        unfinished: view.unfinished.clone(),
        objective: objective(view),
        seed: view.options.seed,
        controller: factors(side.problem.compensation.feedback()),
        prefilter: OrReason::new(prefilter, "no prefilter is needed or requested"),
        pressure_feedback: view.pressure_feedback.as_ref().map(feedback),
        continuous_law: continuous_law(side)?,
        figures: figures(side),
        structure: structure(&design.structure, design.name),
        manual: OrReason(view.manual.as_ref().map(manual::answer).map_err(ToString::to_string)),
        structures: structures::rows(view),
        led_by: view.led_by,
        earned_per_pole_db: earned_per_pole_db(view),
        verification: audit::body(&side.view),
        published: view.published.as_deref().map(audited),
        continuous_as_sampled: view.continuous.as_deref().map(audited),
        minimum_delay_margin_s: view.minimum_delay_margin_s,
        limits: limits::rows(view),
        reserve_db: view.options.reserve_db,
        published_reason: why_not_published(view),
        rounds: rounds(design),
        starts: OrReason::new(design.starts.as_ref().map(starts), "no search ended"),
        binding: binding(view),
        relaxations: relaxed::rows(view),
        relaxation_db: OrReason::new(relaxation_db, "the specifications were not found infeasible"),
        conflicts: conflicts(view),
        explanations: explanations(view),
        rounding: view.rounding.as_ref().map(|rounding| rounding::answer(rounding, &side.view.names)),
        machine: OrReason::new(view.trial.as_ref().map(trial::body), why_not_simulated(view)),
        repair: OrReason::new(
            view.repair.as_ref().map(|repair| repair::answer(view, repair)),
            why_not_repaired(view),
        ),
    })
}

/// The objective; a design that was stopped before its first search ended has no value of it.
fn objective(view: &ProjectDesign) -> ObjectiveAnswer {
    let value_db = Some(view.design.objective_db).filter(|value_db| !value_db.is_nan());
    ObjectiveAnswer { kind: view.options.objective, value_db: OrReason::new(value_db, "no search ended") }
}

/// The reason for the absence of a trial.
fn why_not_simulated(view: &ProjectDesign) -> &'static str {
    match view.unfinished.contains(&DesignPart::Trial) {
        true => "the design was stopped before it was tried in the nonlinear simulation",
        false => "the project describes a plant and no machine",
    }
}

/// The reason for the absence of the given controller.
fn why_not_published(view: &ProjectDesign) -> Option<&'static str> {
    view.published.is_none().then_some(match view.unfinished.contains(&DesignPart::GivenController) {
        true => "the design was stopped before the given controller was audited",
        false => "the project gives no controller",
    })
}

/// The reason for the absence of a repair.
fn why_not_repaired(view: &ProjectDesign) -> &'static str {
    match view.agreement() == Agreement::Contradicts {
        true => "it was not requested",
        false => "no machine contradicts the design",
    }
}
