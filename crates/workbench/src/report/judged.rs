//! The verdicts of a report: the audit of the given controller, the design, and the trials of both
//! on the machine.

use phea_dynamics::watch::Watch;

use super::design::{self, Designed};
use crate::audit::{ProjectAudit, audit_problem, prove_claims};
use crate::design::{ProjectDesign, below_design};
use crate::error::CommandError;
use crate::robust::{DesignFrequency, RobustProblem, robust_problem};
use crate::setup::Setup;
use crate::source::Source;
use crate::trial::{DrivenCorners, Trial, simulated_trial};

/// The results of the robust method for a project with specifications.
pub(super) struct Judged {
    /// The family in the loop of the project.
    pub(super) problem: RobustProblem,
    /// Templates and bounds.
    pub(super) bounds: Vec<DesignFrequency>,
    /// The audit of the given controller; `None` without one.
    pub(super) given: Option<ProjectAudit>,
    /// The trial of the given controller on the machine.
    pub(super) given_trial: Option<Trial>,
    /// The result of the design; `None` if no design was requested.
    pub(super) designed: Option<Designed>,
}

/// Judges a project; `None` without specifications.
///
/// # Errors
/// [`CommandError`] for a family or a controller that cannot be computed; [`CommandError::Stopped`]
/// if the watch stops it.
pub(super) fn judged(
    source: &dyn Source,
    setup: &Setup<'_>,
    watch: Watch<'_>,
) -> Result<Option<Judged>, CommandError> {
    let project = setup.project;
    if project.specifications.is_empty() {
        return Ok(None);
    }
    let problem = robust_problem(source, setup)?;
    let given = match problem.has_controller {
        true => {
            let mut view = audit_problem(&problem, watch)?;
            prove_claims(&problem, &mut view, watch)?;
            view.below_design = Some(below_design(setup, &problem, &view, watch)?);
            Some(view)
        }
        false => None,
    };
    let bounds = problem.at_design_frequencies(watch)?;
    let given_trial = match &given {
        Some(view) => {
            simulated_trial(source, setup, (&problem, view), DrivenCorners::WhereElseSatisfies, watch)?
        }
        None => None,
    };
    let designed = match design::is_requested(project) {
        true => Some(design::designed(source, setup, watch)?),
        false => None,
    };
    Ok(Some(Judged { problem, bounds, given, given_trial, designed }))
}

impl Judged {
    /// The design, if one was found.
    pub(super) fn found(&self) -> Option<&ProjectDesign> {
        self.designed.as_ref()?.found()
    }
}
