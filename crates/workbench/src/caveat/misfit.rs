//! Identified parts whose numbers do not explain their recordings.

use super::{MISFIT_BOUND, MisfitConsequence, UnexplainedKind, UnexplainedPart, unexplained_parts};
use crate::project::Project;
use crate::quantity::significant;

/// The misfits of identified parts, for runs of the machine, which lead to no verdict.
pub(crate) fn misfits_in_runs(project: &Project) -> Vec<String> {
    let of = |part: UnexplainedPart| format!("{}: these runs do not contain it", statement(&part));
    unexplained_parts(project).into_iter().map(of).collect()
}

/// A misfit and its consequence for a verdict.
pub(super) fn sentence(part: &UnexplainedPart, consequence: MisfitConsequence) -> String {
    let bound = significant(100.0 * MISFIT_BOUND, 3);
    let of = match part.kind {
        UnexplainedKind::Valve => "valve",
        UnexplainedKind::Line => "line",
        UnexplainedKind::Friction => "`viscous`",
    };
    let judged = match consequence {
        MisfitConsequence::Beyond => format!("beyond {bound} % no verdict on this {of} is met"),
        MisfitConsequence::Within => format!("up to {bound} % a verdict on this {of} stands"),
        MisfitConsequence::OnlyOfRuns => {
            "the linear plant has its viscous friction from elsewhere, so that a verdict on the linear loop stands"
                .to_string()
        }
    };
    let consequence = match (part.kind, consequence) {
        (UnexplainedKind::Friction, MisfitConsequence::OnlyOfRuns) => format!("{judged}; {IN_RUNS}"),
        (UnexplainedKind::Friction, _) => {
            format!("the linear plant has `viscous` alone of it, and {judged}; {IN_RUNS}")
        }
        _ => judged,
    };
    format!("{}: {consequence}", statement(part))
}

/// Consequence of a misfit of friction for the machine.
const IN_RUNS: &str = "nonlinear runs have all of this friction, and sticking, settling and residual errors that they show do not contain its misfit";

/// A misfit with its recording.
fn statement(part: &UnexplainedPart) -> String {
    let numbers = match part.kind {
        UnexplainedKind::Valve => "the coefficients of the valve leave",
        UnexplainedKind::Line => "the moduli of the line leave",
        UnexplainedKind::Friction => "the friction leaves",
    };
    let at = part.at.as_ref().map_or_else(String::new, |at| format!(", {at}"));
    format!(
        "{numbers} {} % of the range of a recorded signal unexplained ({}.misfit{at})",
        significant(100.0 * part.fraction, 3),
        part.table
    )
}
