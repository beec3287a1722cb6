//! The chapter on the audit of the given controller: the audit with its figures, and the trial on
//! the machine.

use phea_engineering::audit::ProjectAudit;
use phea_engineering::robust::RobustProblem;
use phea_engineering::trial::Trial;

use super::chapter::Chapter;
use super::{closed_loops, family_steps};
use crate::audit::document;
use crate::error::CommandError;
use crate::trial;

pub(super) fn chapter(
    problem: &RobustProblem,
    view: &ProjectAudit,
    trial: Option<&Trial>,
) -> Result<Chapter, CommandError> {
    let mut figures = closed_loops::figures(problem, view)?;
    let steps = family_steps::figure(problem, view, ["family_steps", "Step responses of the family"]);
    let refused = steps.and_then(|steps| steps.map(|figure| figures.push(figure)).err());
    let mut out = document(view, figures);
    out.explanations(refused.map(|reason| format!("No step responses of the family: {reason}.")));
    if let Some(trial) = trial {
        out.append(trial::document(
            trial,
            Some(["machine_steps", "The controller in the nonlinear simulation"]),
        ));
    }
    Ok(Chapter::of("audit", "Audit of the controller", out))
}
