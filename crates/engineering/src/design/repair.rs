//! Reaction to a machine that contradicts a design: the contradicting plant is added and the design
//! continues with it, or the report states what cannot be achieved.
//!
//! ```text
//! trial contradicts -> the plant of that machine, with waves in its lines -> audit of the loop with it
//!   not met  -> qft::design_again    -> met: simulated on the machine again      not met: distance, and remedies
//!   met      -> no linear plant reproduces the machine's behaviour: limits that the run met
//! ```

use phea_dynamics::uncertain_plant::UncertainPlant;
use phea_qft::design::{ControllerChoice, DesignStatus};
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::verification::Verdict;

use super::by_steps::SteppedPlants;
use super::command_of_steps::with_command_of_steps;
use super::{DesignError, DesignPart, DesignRun, ProjectDesign, trial_design, unless_stopped};
use crate::audit::{ProjectAudit, audit_problem, prove_claims};
use crate::family::{ProjectFamilyError, family};
use crate::project::{DeclaredLine, Project};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;
use crate::trial::{self, Agreement, StepSize, TrialMachine, TrialRun, waves_only};
use phea_dynamics::watch::{Stopped, Watch, part};

/// Result of a repair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RepairStatus {
    /// The controller now satisfies every specification over the family, and with the added plant.
    Met,
    /// None of the designed controllers satisfies them; one does if every limit is relaxed by this
    /// much.
    Infeasible {
        /// Amount by which every upper limit is raised and every lower one reduced, dB.
        relaxation_db: f64,
    },
    /// Search and audit did not converge.
    NotConverged,
    /// None of the designed controllers makes every plant stable.
    NotStabilised,
    /// The progress callback cancelled the repair.
    Stopped,
    /// No linear plant reproduces the machine's behaviour, so none could be added.
    NothingToAdd,
}

/// Repair of a design that the machine contradicts.
#[derive(Clone, Debug)]
pub struct Repair {
    /// Result of the repair.
    pub status: RepairStatus,
    /// Run of the machine whose plant was added; `None` if none was added.
    pub added_plant: Option<(TrialMachine, StepSize)>,
    /// Quarter-wave frequency of the slower line of that machine, rad/s.
    pub quarter_wave_rad_per_s: Option<f64>,
    /// Audit of that plant in the loop of the first design.
    pub before: Option<ProjectAudit>,
    /// Audit of that plant in the loop that was found; `None` if none was found.
    pub after: Option<ProjectAudit>,
    /// Audit of the loop that was found, with waves in every plant of the family; `None` if no loop
    /// was found, or if this is unknown.
    pub whole: Option<ProjectAudit>,
    /// The first design, if the repair is met; otherwise the nearest controller, if there is one.
    pub other: Option<Box<ProjectDesign>>,
    /// Error of the family with waves in its lines, whose plant was to be added; `None` if that
    /// family exists, or was not needed.
    pub no_family: Option<ProjectFamilyError>,
    /// Changes of the project that may make every specification with waves satisfiable; empty if a
    /// controller satisfies them, or no change was found.
    pub remedies: Vec<RepairRemedy>,
}

/// A change of the project that may make every specification with waves satisfiable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RepairRemedy {
    /// A line whose quarter wave is beyond the last frequency at which |L| = 1.
    ShorterLine {
        /// Greatest length, m.
        below_m: f64,
    },
    /// Known damping of the waves by the wall of a hose.
    WallDamping,
    /// A controller of higher order.
    HigherOrder {
        /// Largest number of poles of the search.
        maximum_order: usize,
    },
    /// Specifications that require less bandwidth.
    LessBandwidth {
        /// Sufficient relaxation of all limits, dB, if it is known.
        relaxation_db: Option<f64>,
    },
}

impl Repair {
    fn without(status: RepairStatus) -> Repair {
        Repair {
            status,
            added_plant: None,
            quarter_wave_rad_per_s: None,
            before: None,
            after: None,
            whole: None,
            other: None,
            no_family: None,
            remedies: vec![],
        }
    }

    /// Controller nearest to the requirement that cannot be achieved.
    pub fn nearest(&self) -> Option<&ProjectDesign> {
        self.other.as_deref().filter(|_| self.status != RepairStatus::Met)
    }
}

/// Name of the stage in progress reports.
const STAGE: &str = "designing again";

/// The design after the correction by the machine; unchanged if the machine does not contradict it.
pub(super) fn repaired(
    (source, setup): (&dyn Source, &Setup<'_>),
    run: DesignRun,
    project_design: ProjectDesign,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    if project_design.agreement() != Agreement::Contradicts {
        return Ok(project_design);
    }
    let mut repair = match with_waves((source, setup), run, &project_design, watch) {
        Err(DesignError::Stopped(_)) => Repair::without(RepairStatus::Stopped),
        other => other?,
    };
    let mut design = match repair.other.take() {
        Some(found) if repair.status == RepairStatus::Met => {
            let (published, continuous) =
                (project_design.published.clone(), project_design.continuous.clone());
            let explanations = project_design.explanations.clone();
            repair.other = Some(Box::new(project_design));
            ProjectDesign { published, continuous, explanations, ..*found }
        }
        other => {
            repair.other = other;
            project_design
        }
    };
    if repair.status == RepairStatus::Stopped {
        design.leave(DesignPart::Repair);
    }
    if design.designed.view.proof.is_none() {
        let mut unfinished = std::mem::take(&mut design.unfinished);
        let designed = &mut design.designed;
        unless_stopped(&mut unfinished, DesignPart::Proof, || {
            Ok(Some(prove_claims(&designed.problem, &mut designed.view, watch)?))
        })?;
        design.unfinished = unfinished;
    }
    Ok(ProjectDesign { repair: Some(repair), ..design })
}

/// Adds the plant with waves in its lines, if this plant contradicts the design.
fn with_waves(
    (source, setup): (&dyn Source, &Setup<'_>),
    run: DesignRun,
    project_design: &ProjectDesign,
    watch: Watch<'_>,
) -> Result<Repair, DesignError> {
    let nothing = Repair::without(RepairStatus::NothingToAdd);
    let (Some(contradicting), Some(alone)) = (project_design.contradicting_waves(), waves_only(setup)) else {
        return Ok(nothing);
    };
    let plant = match family(&Setup::new(&alone)?, source) {
        Ok(Family::Uncertain(family)) => family.plant().clone(),
        Ok(Family::Measured(_)) => return Ok(nothing),
        Err(error) => return Ok(Repair { no_family: Some(error), ..nothing }),
    };
    let before = audit_problem(&alone_in_loop(&plant, project_design), watch)?;
    let known = Repair {
        added_plant: Some((contradicting.machine_driven.clone(), contradicting.size)),
        quarter_wave_rad_per_s: contradicting.quarter_wave_rad_per_s,
        before: Some(before.clone()),
        ..nothing
    };
    if before.audit.verdict == Verdict::Met {
        return Ok(Repair { added_plant: None, ..known });
    }
    let Some((status, found)) = designed_again((source, setup), run, (&plant, project_design), watch)? else {
        return Ok(Repair { status: RepairStatus::NotStabilised, ..known });
    };
    let after = Some(audit_problem(&alone_in_loop(&plant, &found), watch)?);
    let whole = match status {
        RepairStatus::Met => family_with_waves((source, setup), &found, watch)?,
        _ => None,
    };
    let remedies = match status {
        RepairStatus::Met => vec![],
        _ => remedies(setup.project, status, known.quarter_wave_rad_per_s, project_design),
    };
    Ok(Repair { status, after, whole, remedies, other: Some(Box::new(found)), ..known })
}

/// Changes that may help: a line so short that its quarter wave is beyond the last frequency at
/// which |L| = 1, a wall that damps, a longer controller, less bandwidth.
fn remedies(
    project: &Project,
    status: RepairStatus,
    quarter_wave_rad_per_s: Option<f64>,
    project_design: &ProjectDesign,
) -> Vec<RepairRemedy> {
    let mut ways = Vec::new();
    let lines = project.actuator.as_ref().map(|actuator| [&actuator.line.a, &actuator.line.b]);
    let longest = lines.iter().flatten().filter_map(|line| DeclaredLine::length(line)).fold(0.0, f64::max);
    let crossing = project_design.designed.figures.last_crossing_rad_per_s();
    if let (Some(own), Some(quarter)) = (crossing, quarter_wave_rad_per_s)
        && own > quarter
        && longest > 0.0
    {
        ways.push(RepairRemedy::ShorterLine { below_m: longest * quarter / own });
    }
    if lines.iter().flatten().any(|line| line.hose().is_some()) {
        ways.push(RepairRemedy::WallDamping);
    }
    if let ControllerChoice::Grow { maximum_order } | ControllerChoice::Any { maximum_order, .. } =
        project_design.options.controller
    {
        ways.push(RepairRemedy::HigherOrder { maximum_order });
    }
    let relaxation_db = match status {
        RepairStatus::Infeasible { relaxation_db } => Some(relaxation_db),
        _ => None,
    };
    ways.push(RepairRemedy::LessBandwidth { relaxation_db });
    ways
}

impl ProjectDesign {
    /// The run with waves in its lines, if it contradicts the design.
    pub fn contradicting_waves(&self) -> Option<&TrialRun> {
        let mut runs = self.trial.iter().flat_map(|trial| &trial.runs);
        runs.find(|run| run.agreement == Agreement::Contradicts && run.quarter_wave_rad_per_s.is_some())
    }
}

/// One plant in the loop of a design.
fn alone_in_loop(plant: &UncertainPlant, design: &ProjectDesign) -> RobustProblem {
    RobustProblem {
        family: Family::Uncertain(UncertainFamily::of_nominal(plant.clone())),
        before_feedback: None,
        position: None,
        rig_outside: None,
        caveats: vec![],
        ..design.designed.problem.clone()
    }
}

/// The loop of a design with waves in every plant of its family, one of which was added; `None`
/// without such a family.
fn family_with_waves(
    (source, setup): (&dyn Source, &Setup<'_>),
    found: &ProjectDesign,
    watch: Watch<'_>,
) -> Result<Option<ProjectAudit>, DesignError> {
    let Some(project) = trial::with_waves(setup.project) else { return Ok(None) };
    let Ok(family) = family(&Setup::new(&project)?, source) else { return Ok(None) };
    let problem = RobustProblem {
        family,
        before_feedback: None,
        position: None,
        rig_outside: None,
        caveats: vec![],
        ..found.designed.problem.clone()
    };
    Ok(Some(audit_problem(&problem, watch)?))
}

/// The design continued with the additional plant and simulated on the machine; `None` if no
/// controller was found.
fn designed_again(
    (source, setup): (&dyn Source, &Setup<'_>),
    run: DesignRun,
    (plant, project_design): (&UncertainPlant, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(RepairStatus, ProjectDesign)>, DesignError> {
    let DesignRun { aimed, mut problem, outcome, .. } = run;
    problem.additional_plants.push(plant.clone());
    let options = project_design.options.clone();
    let outcome =
        phea_qft::design::design_again(&problem, &options, outcome, &mut part(watch, STAGE, [0.0, 1.0]));
    let outcome = outcome?;
    if outcome.stopped {
        return Err(Stopped.into());
    }
    let Some(design) = outcome.design else { return Ok(None) };
    let status = match &design.status {
        DesignStatus::Met => RepairStatus::Met,
        DesignStatus::Infeasible(relaxation) => {
            RepairStatus::Infeasible { relaxation_db: relaxation.relaxation_db }
        }
        DesignStatus::NotConverged { .. } => RepairStatus::NotConverged,
        DesignStatus::NotStabilised => RepairStatus::NotStabilised,
    };
    let mut found = ProjectDesign::new(setup, &aimed, &problem, design, options, watch)?;
    let own = &project_design.designed.problem.specifications;
    if aimed.specifications[..own.len()] != own[..] {
        found = found.judged_by(&project_design.designed.problem, watch)?;
    }
    found = with_command_of_steps((setup, found), &SteppedPlants::default(), watch)?;
    let trial = trial_design(source, setup.project, &found, watch)?;
    Ok(Some((status, ProjectDesign { trial, ..found })))
}
