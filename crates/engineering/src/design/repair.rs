//! What follows where the machine contradicts a design: the plant that does is taken in, and the
//! design goes on with it, or it is said what cannot be had.
//!
//! ```text
//! trial contradicts -> the plant of that machine, its lines in motion -> audit of the loop with it
//!   not met  -> qft::design_again    -> met: tried on the machine anew      not met: how near, and what would help
//!   met      -> no linear plant does what the machine does: what the run met
//! ```

mod words;

use phea_dynamics::uncertain_plant::UncertainPlant;
use phea_qft::design::DesignStatus;
use phea_qft::family::{Family, UncertainFamily};
use phea_qft::verification::Verdict;

use super::{DesignError, DesignRun, ProjectDesign, tried_design};
use crate::audit::{ProjectAudit, audit_problem, try_to_prove};
use crate::error::ProcedureError;
use crate::family::family;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;
use crate::trial::{self, Agreement, TrialRun, waves_alone};
use phea_dynamics::watch::{Watch, part};

/// What became of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RepairStatus {
    /// The controller now satisfies every specification over the family, and with the plant that
    /// was taken in.
    Met,
    /// No controller that was tried does; one does with every limit this much wider.
    Infeasible {
        /// dB added to every upper limit and taken from every lower one.
        relaxation_db: f64,
    },
    /// Search and audit did not come to agree.
    NotConverged,
    /// No controller that was tried makes every plant stable.
    NotStabilised,
    /// Whoever watched stopped it.
    Stopped,
    /// No linear plant is known that does what the machine does: there was nothing to take in.
    NothingToTakeIn,
}

/// What was done about a machine that contradicts the design.
#[derive(Clone, Debug)]
pub struct Repair {
    /// What became of it.
    pub status: RepairStatus,
    /// The machine whose plant was taken in, as its run is called; `None` where none was.
    pub taken_in: Option<String>,
    /// Where the slower line of that machine is a quarter of a wave long, rad/s.
    pub quarter_wave_rad_per_s: Option<f64>,
    /// That plant in the loop of the first design.
    pub before: Option<ProjectAudit>,
    /// The same in the loop that was found; `None` where none was.
    pub after: Option<ProjectAudit>,
    /// The loop that was found with the waves in every plant of the family; `None` where none was,
    /// or nothing is known of them.
    pub whole: Option<ProjectAudit>,
    /// Where it is met, the first design; otherwise the controller that comes nearest, where there
    /// is one.
    pub other: Option<Box<ProjectDesign>>,
    /// What was done and what cannot be had, for an engineer.
    pub sentences: Vec<String>,
}

impl Repair {
    fn without(status: RepairStatus) -> Repair {
        Repair {
            status,
            taken_in: None,
            quarter_wave_rad_per_s: None,
            before: None,
            after: None,
            whole: None,
            other: None,
            sentences: vec![],
        }
    }

    /// The controller that comes nearest to what cannot be had.
    pub fn nearest(&self) -> Option<&ProjectDesign> {
        self.other.as_deref().filter(|_| self.status != RepairStatus::Met)
    }
}

/// What is being done, for whoever watches.
const STAGE: &str = "designing again, with waves in the lines";

/// The design after what the machine taught it; as it is where the machine does not contradict it.
pub(super) fn repaired(
    (source, setup): (&dyn Source, &Setup<'_>),
    run: DesignRun,
    told: ProjectDesign,
    watch: Watch<'_>,
) -> Result<ProjectDesign, ProcedureError> {
    if told.agreement() != Agreement::Contradicts {
        return Ok(told);
    }
    let mut repair = match with_waves((source, setup), run, &told, watch) {
        Err(ProcedureError::Stopped) => Repair::without(RepairStatus::Stopped),
        other => other?,
    };
    let mut design = match repair.other.take() {
        Some(found) if repair.status == RepairStatus::Met => {
            let (published, continuous) = (told.published.clone(), told.continuous.clone());
            let explanations = told.explanations.clone();
            repair.other = Some(Box::new(told));
            ProjectDesign { published, continuous, explanations, ..*found }
        }
        other => {
            repair.other = other;
            told
        }
    };
    if let (RepairStatus::Met, Some(run)) = (repair.status, contradicting_waves(&design)) {
        repair.sentences.push(words::stable_with_waves(run));
    }
    if design.designed.view.proof.is_none() {
        try_to_prove(&design.designed.problem, &mut design.designed.view, watch)?;
    }
    let runs = design.trial.iter().flat_map(|trial| &trial.runs);
    repair.sentences.extend(words::left(runs));
    Ok(ProjectDesign { repair: Some(repair), ..design })
}

/// Takes in the plant with waves in its lines, where that is what contradicts.
fn with_waves(
    (source, setup): (&dyn Source, &Setup<'_>),
    run: DesignRun,
    told: &ProjectDesign,
    watch: Watch<'_>,
) -> Result<Repair, ProcedureError> {
    let nothing = Repair::without(RepairStatus::NothingToTakeIn);
    let (Some(contradicting), Some(alone)) = (contradicting_waves(told), waves_alone(setup)) else {
        return Ok(nothing);
    };
    let plant = match family(&Setup::new(&alone)?, source) {
        Ok(Family::Uncertain(family)) => family.plant().clone(),
        Ok(Family::Measured(_)) => return Ok(nothing),
        Err(error) => {
            let sentences = vec![format!("the plant with waves in its lines cannot be taken in: {error}")];
            return Ok(Repair { sentences, ..nothing });
        }
    };
    let before = audit_problem(&alone_in_loop(&plant, told), watch)?;
    let known = Repair {
        taken_in: Some(contradicting.what.clone()),
        quarter_wave_rad_per_s: contradicting.quarter_wave_rad_per_s,
        before: Some(before.clone()),
        ..nothing
    };
    if before.audit.verdict == Verdict::Met {
        let sentences = vec![words::stable_with_waves(contradicting)];
        return Ok(Repair { taken_in: None, sentences, ..known });
    }
    let Some((status, found)) = designed_again((source, setup), run, (&plant, told), watch)? else {
        let sentences = vec![words::nothing_found()];
        return Ok(Repair { status: RepairStatus::NotStabilised, sentences, ..known });
    };
    let audits = found.design.beside.first().cloned();
    let after = audits.map(|audit| ProjectAudit::new(&alone_in_loop(&plant, &found), audit, None));
    let whole = match status {
        RepairStatus::Met => family_with_waves((source, setup), &found, watch)?,
        _ => None,
    };
    let repair = Repair { status, after, whole, ..known };
    let sentences = words::sentences(setup.project, &repair, told, &found);
    Ok(Repair { sentences, other: Some(Box::new(found)), ..repair })
}

/// The run with waves, where it contradicts.
fn contradicting_waves(told: &ProjectDesign) -> Option<&TrialRun> {
    let mut runs = told.trial.iter().flat_map(|trial| &trial.runs);
    runs.find(|run| run.agreement == Agreement::Contradicts && run.quarter_wave_rad_per_s.is_some())
}

/// One plant in the loop of a design.
fn alone_in_loop(plant: &UncertainPlant, design: &ProjectDesign) -> RobustProblem {
    RobustProblem {
        family: Family::Uncertain(UncertainFamily::of_nominal(plant.clone())),
        rig_outside: None,
        caveats: vec![],
        ..design.designed.problem.clone()
    }
}

/// The loop of a design with waves in every plant of its family, of which one was taken in; `None`
/// where there is no such family.
fn family_with_waves(
    (source, setup): (&dyn Source, &Setup<'_>),
    found: &ProjectDesign,
    watch: Watch<'_>,
) -> Result<Option<ProjectAudit>, ProcedureError> {
    let Some(project) = trial::with_waves(setup.project) else { return Ok(None) };
    let Ok(family) = family(&Setup::new(&project)?, source) else { return Ok(None) };
    let problem =
        RobustProblem { family, rig_outside: None, caveats: vec![], ..found.designed.problem.clone() };
    audit_problem(&problem, watch).map(Some)
}

/// The design gone on with the plant among those that it serves, tried on the machine; `None` where
/// no controller was found.
fn designed_again(
    (source, setup): (&dyn Source, &Setup<'_>),
    run: DesignRun,
    (plant, told): (&UncertainPlant, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(RepairStatus, ProjectDesign)>, ProcedureError> {
    let DesignRun { mut problem, outcome } = run;
    problem.beside.push(plant.clone());
    let options = told.options.clone();
    let outcome =
        phea_qft::design::design_again(&problem, &options, outcome, &mut part(watch, STAGE, [0.0, 1.0]));
    let outcome = outcome.map_err(DesignError::from)?;
    if outcome.stopped {
        return Err(ProcedureError::Stopped);
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
    let found = ProjectDesign::new(setup, &told.designed.problem, &problem, design, options, watch)?;
    let trial = tried_design(source, setup.project, &found, watch)?;
    Ok(Some((status, ProjectDesign { trial, ..found })))
}
