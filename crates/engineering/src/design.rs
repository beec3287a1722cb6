//! The design of a controller and its prefilter: from the project to a controller that satisfies
//! every specification, with the given one for comparison.

mod added_by_rig;
mod below;
mod binding;
mod by_steps;
mod command_of_steps;
mod damping;
mod deployable;
mod driven;
mod error;
mod explanation;
mod factors;
mod feedback_required;
mod manual;
mod problem;
mod proven;
mod relaxed;
mod repair;
mod rounding;
mod search;
mod side;
mod step_aim;
mod structures;
mod unfinished;
mod verdict;
pub use crate::limit_kind::{
    DesignLimitKind, ExceededLimit, LimitOrigin, RELAXED_BY, limit_key, limit_unit_key, origin_key,
};
pub use below::below_design;
pub use binding::{LedBy, SearchedLimit};
pub use command_of_steps::{CommandOfSteps, StepLimit};
pub use damping::{MissingPlants, PressureFeedbackDesign, with_free_pressure_feedback};
pub(crate) use deployable::highest_bandwidth;
pub use deployable::{DesignLimit, LimitFinding, UnusableController, design_limits};
pub use error::DesignError;
pub use explanation::{ExplainedFact, ExplainedLimit, Explanation};
pub use manual::{ManualGap, ManualLaw, ManualPart};
pub use problem::{design_options, design_problem};
pub use relaxed::{Gained, Relaxations, RelaxedGain, RelaxedLimit};
pub use repair::{Repair, RepairRemedy, RepairStatus};
pub use rounding::{RoundedSignal, Rounding};
pub use side::{AuditedController, LoopFigures, NominalMargins};
pub use structures::{ReachedStructure, structure_key};
pub use unfinished::DesignPart;
use unfinished::unless_stopped;
pub use verdict::{DesignVerdict, RigMiss, SearchedControllers};

use phea_dynamics::controller::{Controller, RateSensor, Timing};
use phea_qft::audit::audit_by;
use phea_qft::closed_loop::Compensation;
use phea_qft::design::{
    Design, DesignOptions, DesignOutcome, DesignProblem, DesignStatus, PrefilterChoice, reshaped,
};
use phea_qft::verification::Verdict;

use self::by_steps::LedSearch;
use self::deployable::{limited, split};
use self::driven::found_and_tried;
use crate::audit::{ProjectAudit, audit_problem, audit_request, caveat_of_rig, prove_claims, unexamined_rig};
use crate::project::{self, Project};
use crate::quantity::{DisplayUnit, FORCE};
use crate::robust::{RobustProblem, robust_problem};
use crate::setup::{ProjectInputs, Setup, is_of_position};
use crate::side_by_side::{all_cores, both};
use crate::source::Source;
use crate::trial::{Agreement, DrivenCorners, Trial, simulated_trial};
use phea_dynamics::watch::{Stopped, Watch, part, unwatched, within};

/// Name of the file with the designed project.
pub const DESIGNED_PROJECT: &str = "designed.toml";
/// Name of the file with the project under the nearest controller, if none suffices.
pub const NEAREST_PROJECT: &str = "nearest.toml";

/// Name of the file with the proof for the designed controller.
pub const DESIGNED_CERTIFICATE: &str = "designed_certificate.json";

/// A design, and the given controller for comparison.
#[derive(Clone, Debug)]
pub struct ProjectDesign {
    /// Result of the design.
    pub design: Design,
    /// Options of the search.
    pub options: DesignOptions,
    /// Limits beyond the specifications that the controller must satisfy to be deployable.
    pub limits: Vec<DesignLimit>,
    /// Findings of the audit for those that are separate specifications.
    pub limit_findings: Vec<LimitFinding>,
    /// Required delay in addition to that of the loop, s.
    pub minimum_delay_margin_s: f64,
    /// True if the designed loop tolerates this delay, regardless of the specifications.
    pub tolerates_its_delay: bool,
    /// Parts that were left unfinished when `watch` cancelled; if there are any, the design is the
    /// best so far.
    pub unfinished: Vec<DesignPart>,
    /// The designed controller with its audit.
    pub designed: AuditedController,
    /// The controller that the project gives, with its audit; absent if it gives none.
    pub published: Option<Box<AuditedController>>,
    /// Design made for the continuous loop, sampled and audited as the loop is; `None` for a
    /// continuous loop.
    pub continuous: Option<Box<AuditedController>>,
    /// Specifications that no controller can meet, or that will be hard to meet, whatever the
    /// search found.
    pub explanations: Vec<Explanation>,
    /// Effect of the computer's converters on the designed loop; absent if nothing is rounded.
    pub rounding: Option<Rounding>,
    /// Trial of the designed controller on the nonlinear model; absent without a machine, and if
    /// the design was cancelled.
    pub trial: Option<Trial>,
    /// Repair for a machine that contradicts the design; absent if none contradicts it, or if no
    /// repair was requested.
    pub repair: Option<Repair>,
    /// The designed controller in the terms of a controller's manual: before it was sampled and
    /// rounded.
    pub manual: Result<ManualLaw, ManualGap>,
    /// Unit of the measured quantity, below that of the command in a gain; absent for a plant
    /// without units.
    pub gain_per: Option<DisplayUnit>,
    /// Structures of the search, in order.
    pub structures: Vec<ReachedStructure>,
    /// Largest command in the steps of the scenarios; absent if nothing limits it, or if it is not
    /// known.
    pub command_of_steps: Option<CommandOfSteps>,
    /// Reason for the last search beyond its limits over frequency.
    pub led_by: LedBy,
    /// The gain from relaxing each limit that binds.
    pub relaxations: Relaxations,
    /// Pressure feedback that was found before the loop; absent if it is not free.
    pub pressure_feedback: Option<PressureFeedbackDesign>,
    /// The designed controller as declared in a project.
    pub declared_controller: project::DeclaredController,
    /// The designed prefilter as declared in a project; absent if none was designed.
    pub declared_prefilter: Option<project::Prefilter>,
}

impl ProjectDesign {
    /// A design without the given controller for comparison and without explanations. `given` is
    /// the family in the loop of the project, and `requested` is the problem that was solved.
    ///
    /// # Errors
    /// [`DesignError`] for a controller or a sensor that is not a transfer function.
    pub fn new(
        setup: &Setup<'_>,
        given: &RobustProblem,
        requested: &DesignProblem,
        design: Design,
        options: DesignOptions,
        watch: Watch<'_>,
    ) -> Result<ProjectDesign, DesignError> {
        let project = setup.project;
        let has_prefilter = options.prefilter != PrefilterChoice::None;
        let law = design.law.clone();
        let (own, audit, limit_findings) = split(given, &design.audit);
        let problem = RobustProblem {
            compensation: Compensation::new(&design.controller, setup.sensor.clone())?,
            has_controller: true,
            has_prefilter,
            ..own
        };
        let of_rig = caveat_of_rig(&problem, watch).unwrap_or_else(|Stopped| unexamined_rig(&problem));
        // the best result so far of a design that was cancelled is examined in time as well
        let view = ProjectAudit::new(&problem, audit, of_rig, &mut unwatched)?;
        let rounding = rounding::rounding(setup, &problem)?;
        let manual = ManualLaw::new(&law.feedback, design.name);
        let declared = project.controller.clone().unwrap_or_default();
        let declared_controller = project::DeclaredController {
            transfer: match &manual {
                Ok(words) if design.name.is_some() => {
                    project::Transfer { elements: words.declared(), ..project::Transfer::default() }
                }
                _ => factors::declared(&law.feedback.transfer_function()?),
            },
            ..declared
        };
        let declared_prefilter = match options.prefilter {
            PrefilterChoice::Grow { .. } => Some(project::Prefilter {
                transfer: factors::declared(&law.prefilter.transfer_function()?),
                sample_time: None,
                continuous: project.prefilter.as_ref().is_some_and(|given| given.continuous),
            }),
            PrefilterChoice::None | PrefilterChoice::Given(_) => None,
        };
        let designed = AuditedController::new(law, problem, view)?;
        Ok(ProjectDesign {
            tolerates_its_delay: requested
                .tolerates_its_delay(designed.figures.delay_margin_s.unwrap_or(0.0)),
            minimum_delay_margin_s: requested.minimum_delay_margin_s,
            designed,
            design,
            limits: design_limits(setup, given),
            limit_findings,
            options,
            unfinished: vec![],
            published: None,
            continuous: None,
            explanations: vec![],
            rounding,
            trial: None,
            repair: None,
            manual,
            gain_per: project.actuator.as_ref().map(|_| project.units.force),
            structures: vec![],
            command_of_steps: None,
            led_by: LedBy::Frequency,
            relaxations: Relaxations::default(),
            pressure_feedback: None,
            declared_controller,
            declared_prefilter,
        })
    }

    /// The design, judged by the limits of a problem other than the one that was searched.
    fn judged_by(mut self, given: &RobustProblem, watch: Watch<'_>) -> Result<ProjectDesign, DesignError> {
        let problem = RobustProblem {
            has_prefilter: self.designed.problem.has_prefilter,
            has_controller: true,
            compensation: self.designed.problem.compensation.clone(),
            ..given.clone()
        };
        let audit = audit_by(&audit_request(&problem, &problem.family), all_cores(), watch)?;
        self.design.audit = audit.clone();
        let (problem, audit, limit_findings) = split(&problem, &audit);
        let of_rig = caveat_of_rig(&problem, watch)?;
        let mut view = ProjectAudit::new(&problem, audit, of_rig, &mut *watch)?;
        // the proof of a design led by its steps is made at the end
        if !problem.in_time.iter().any(|one| one.follows) {
            prove_claims(&problem, &mut view, watch)?;
        }
        let controller = self.designed.controller.clone();
        let designed = AuditedController::new(controller, problem, view)?;
        Ok(ProjectDesign { designed, limit_findings, ..self })
    }

    /// The design with the status met, if it missed only the path to a required step.
    fn met_where_it_is(mut self, known: usize) -> ProjectDesign {
        if self.designed.view.audit.verdict == Verdict::Met && self.satisfies_its_limits() {
            self.design.status = DesignStatus::Met;
        }
        self.design.binding.retain(|limit| limit.specification < known);
        if let DesignStatus::Infeasible(relaxation) = &mut self.design.status {
            relaxation.conflicts.retain(|conflict| conflict.specification < known);
        }
        self
    }

    /// Limit with this number among the specifications of the search: one of the project, or a
    /// limit of the design.
    pub fn searched_limit(&self, specification: usize) -> SearchedLimit {
        let own = self.designed.problem.specifications.len();
        let limit = specification.checked_sub(own).and_then(|limit| self.limit_findings.get(limit));
        limit.map_or(SearchedLimit::Specification(specification), |(kind, _)| SearchedLimit::Design(*kind))
    }

    /// The project with the designed laws in place of those that it gives.
    pub fn deployed(&self, project: &Project) -> Project {
        Project {
            controller: Some(self.declared_controller.clone()),
            prefilter: self.declared_prefilter.clone().or_else(|| project.prefilter.clone()),
            ..project.clone()
        }
    }

    /// SI unit of the controlled quantity; `None` for a plant without units.
    pub fn controlled_unit(&self) -> Option<&'static str> {
        self.gain_per.map(|_| self.designed.problem.units.motion.dimension(&FORCE).si)
    }

    /// Agreement of the machine with the linear loop in the simulated runs.
    pub fn agreement(&self) -> Agreement {
        self.trial.as_ref().map_or(Agreement::Agrees, Trial::agreement)
    }

    /// Largest ratio of a reached property to the required one in the worst run on the nonlinear
    /// rig: at most 1 if all requirements in time are met, 0 without a run.
    fn worst_run(&self) -> f64 {
        self.trial.as_ref().map_or(0.0, Trial::worst_run)
    }

    /// Largest such ratio with room for the plants between the simulated ones.
    fn worst_run_with_room(&self) -> f64 {
        self.trial.as_ref().map_or(0.0, Trial::worst_run_with_room)
    }

    /// Requirement in time that the nonlinear rig misses; `None` if it meets all of them with room
    /// for the plants between the simulated ones, or nothing is required.
    pub fn rig_miss(&self) -> Option<RigMiss> {
        let trial = self.trial.as_ref()?;
        match trial.lacks_room() {
            true => Some(RigMiss::WithoutRoom),
            false => (trial.satisfies() == Some(false)).then_some(RigMiss::Missed),
        }
    }

    /// True if a run on the nonlinear rig misses a requirement in time, or if all satisfy it
    /// without room for the plants between the simulated ones.
    pub fn misses_on_rig(&self) -> bool {
        self.rig_miss().is_some()
    }

    /// True if the designed controller satisfies every specification and every limit.
    pub fn is_met(&self) -> bool {
        self.designed.view.verdict() == Verdict::Met
            && self.tolerates_its_delay
            && self.exceeded_prefilter_gain().is_none()
            && self.exceeded_command().is_none()
            && self.satisfies_its_limits()
    }

    /// True if every limit by which a design is judged is satisfied.
    fn satisfies_its_limits(&self) -> bool {
        self.limit_findings.iter().all(|(kind, finding)| kind.is_led_to() || finding.verdict == Verdict::Met)
    }
}

/// Designs a controller and, if the machine contradicts it, continues with the contradicting plant.
///
/// # Errors
/// The errors of [`design_project`].
pub fn design_and_repair(
    source: &dyn Source,
    setup: &Setup<'_>,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    let damped = with_free_pressure_feedback(source, setup, watch)?;
    let Some((project, found)) = damped else {
        let searched = designed(source, [setup; 2], seed, &mut within(&mut *watch, [0.0, 0.6]))?;
        let inputs = ProjectInputs { source, setup };
        return repair::repaired(inputs, searched, &mut within(watch, [0.6, 1.0]));
    };
    let damped = Setup::new(&project)?;
    let searched = designed(source, [setup, &damped], seed, &mut within(&mut *watch, [0.0, 0.6]))?;
    let inputs = ProjectInputs { source, setup: &damped };
    let project_design = repair::repaired(inputs, searched, &mut within(watch, [0.6, 1.0]))?;
    Ok(project_design.with_pressure_feedback(Some(found)))
}

/// Designs a controller for the project, after the audit of the given one.
///
/// # Errors
/// [`DesignError`] for a project without a specification, a required step that no controller makes
/// on the rig, a part that is not a transfer function, a family that cannot be built, or a
/// cancellation before anything was found.
pub fn design_project(
    source: &dyn Source,
    setup: &Setup<'_>,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    let Some((project, found)) = with_free_pressure_feedback(source, setup, watch)? else {
        return designed(source, [setup; 2], seed, watch).map(|searched| searched.project_design);
    };
    let searched = designed(source, [setup, &Setup::new(&project)?], seed, watch)?;
    Ok(searched.project_design.with_pressure_feedback(Some(found)))
}

/// A problem and its result.
struct DesignRun {
    /// Problem with the limits at which the search aims.
    aimed: RobustProblem,
    problem: DesignProblem,
    outcome: DesignOutcome,
    /// Search in which the design was led by its steps; absent if there was none.
    led: Option<LedSearch>,
}

/// A design with the problem and the result of its search.
struct SearchedDesign {
    run: DesignRun,
    project_design: ProjectDesign,
}

/// The design with its problem, for the project as given and with the pressure feedback for which
/// it is designed.
fn designed(
    source: &dyn Source,
    [as_given, setup]: [&Setup<'_>; 2],
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<SearchedDesign, DesignError> {
    let project = setup.project;
    if project.specifications.is_empty() {
        return Err(DesignError::NoSpecification);
    }
    if is_of_position(project) {
        return Err(DesignError::Admittance(project.motion()));
    }
    let given = robust_problem(source, as_given)?;
    let as_designed = match std::ptr::eq(as_given, setup) {
        true => given.clone(),
        false => robust_problem(source, setup)?,
    };
    error::refuse_impossible_steps(setup, &as_designed)?;
    let limits = design_limits(setup, &as_designed);
    let feedback_not_required = feedback_required::feedback_not_required(&as_designed);
    let limited = limited(&as_designed, &limits);
    let (published, found) = both(
        watch,
        0.05,
        |watch| audited_as_given(as_given, &given, watch),
        |watch| {
            let inputs = ProjectInputs { source, setup };
            let (searched, twin) =
                found_and_tried(inputs, &limited, seed, &mut within(&mut *watch, [0.0, 0.9]))?;
            let SearchedDesign { run, mut project_design } = searched;
            let mut unfinished = std::mem::take(&mut project_design.unfinished);
            let is_sampled = run.problem.timing.sample_time_s.is_some();
            let continuous = match is_sampled {
                true => unless_stopped(&mut unfinished, DesignPart::WithoutSamples, || {
                    let watch = &mut within(watch, [0.9, 1.0]);
                    twin.and_then(|twin| twin.of(&project_design.design)).unwrap_or_else(|| {
                        continuous_as_sampled(inputs, &run.problem, &project_design, watch)
                    })
                })?,
                false => None,
            };
            Ok::<_, DesignError>((run, ProjectDesign { unfinished, ..project_design }, continuous))
        },
    );
    let (run, mut project_design, continuous) = found?;
    // the audit of the given controller may have ended before `watch` cancelled the design
    let published = match published {
        Err(DesignError::Stopped(_)) => {
            project_design.leave(DesignPart::GivenController);
            None
        }
        other => other?,
    };
    project_design.explanations.extend(feedback_not_required);
    let [published, continuous] = [published, continuous].map(|one| one.map(Box::new));
    let project_design = ProjectDesign { published, continuous, ..project_design };
    Ok(SearchedDesign { run, project_design })
}

/// The controller that the project gives, with its audit; `None` if it gives none.
fn audited_as_given(
    setup: &Setup<'_>,
    given: &RobustProblem,
    watch: Watch<'_>,
) -> Result<Option<AuditedController>, DesignError> {
    let Some(law) = &setup.controller else { return Ok(None) };
    let mut view = audit_problem(given, watch)?;
    view.below_design = Some(below_design(setup, given, &view, watch)?);
    Ok(Some(AuditedController::new(law.clone(), given.clone(), view)?))
}

/// The machine under the designed controller, as declared in a project.
fn trial_design(
    inputs: ProjectInputs<'_>,
    project_design: &ProjectDesign,
    watch: Watch<'_>,
) -> Result<Option<Trial>, DesignError> {
    let deployed = project_design.deployed(inputs.setup.project);
    let audited = project_design.designed.audited();
    Ok(simulated_trial(inputs.source, &Setup::new(&deployed)?, audited, DrivenCorners::Always, watch)?)
}

/// Effect of sampling and delay on a design that ignores them: its structure shaped for the
/// continuous loop, starting from its controller, and audited in the sampled one. `None` if the
/// loop is not sampled, or no such design is found.
fn continuous_as_sampled(
    inputs: ProjectInputs<'_>,
    sampled: &DesignProblem,
    project_design: &ProjectDesign,
    watch: Watch<'_>,
) -> Result<Option<AuditedController>, DesignError> {
    let timing = sampled.timing;
    if timing.sample_time_s.is_none() {
        return Ok(None);
    }
    let at_once = Timing {
        rate_feed_forward: timing.rate_feed_forward,
        rate_sensor: RateSensor { delay_s: 0.0, ..timing.rate_sensor },
        inner_feedback: timing.inner_feedback,
        ..Timing::default()
    };
    // a sampled loop closes the pressure feedback itself
    let family = match timing.inner_feedback.is_zero() {
        true => sampled.family.clone(),
        false => damping::family_at_once(inputs.source, inputs.setup.project)?,
    };
    let problem = DesignProblem { timing: at_once, family, ..sampled.clone() };
    let stage = "designing without samples";
    // the structure is unchanged, so that only sampling makes the difference
    let law = reshaped(
        &problem,
        &project_design.options,
        &project_design.design,
        &mut part(&mut *watch, stage, [0.0, 1.0]),
    )?;
    let Some(law) = law else { return Ok(None) };
    let controller = Controller { timing, ..law };
    let compensation = inputs.setup.compensation(&controller)?;
    let problem = RobustProblem { compensation, ..project_design.designed.problem.clone() };
    let view = audit_problem(&problem, watch)?;
    Ok(Some(AuditedController::new(controller, problem, view)?))
}
