//! The chapter on the audit of the given controller: the audit with its figures, and the trial on
//! the machine.

use phea_dynamics::linear::LinearError;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::robust::RobustProblem;
use phea_engineering::trial::Trial;

use super::chapter::Chapter;
use super::{closed_loops, family_steps};
use crate::audit::document;
use crate::error::CommandError;
use crate::figure::Figure;
use crate::trial;

pub(super) fn chapter(
    problem: &RobustProblem,
    view: &ProjectAudit,
    trial: Option<&Trial>,
) -> Result<Chapter, CommandError> {
    let (figures, refused) = figures(problem, view)?;
    let mut out = document(view, figures);
    out.explanations(refused);
    if let Some(trial) = trial {
        out.append(trial::document(trial, Some(MACHINE_STEPS)));
    }
    Ok(Chapter::of("audit", "Audit of the controller", out))
}

/// Name and title of the figure of the trial.
const MACHINE_STEPS: [&str; 2] = ["machine_steps", "The controller in the nonlinear simulation"];

/// The figures of the audit, and the reason why one of them is missing.
pub(super) fn figures(
    problem: &RobustProblem,
    view: &ProjectAudit,
) -> Result<(Vec<Figure>, Option<String>), LinearError> {
    let mut figures = closed_loops::figures(problem, view)?;
    let steps = family_steps::figure(problem, view, ["family_steps", "Step responses of the family"]);
    let refused = steps.and_then(|steps| steps.map(|figure| figures.push(figure)).err());
    Ok((figures, refused.map(|reason| format!("No step responses of the family: {reason}."))))
}

/// The figures of the trial.
pub(super) fn figures_of_trial(trial: &Trial) -> Vec<Figure> {
    trial::document(trial, Some(MACHINE_STEPS)).into_figures()
}
