//! What sampling and delay make of the designed laws.

use phea_dynamics::controller::{Controller, Timing};
use phea_dynamics::linear::TimeDomain;
use phea_qft::closed_loop::Compensation;
use phea_qft::verification::{SpecificationFinding, Verdict};

use crate::audit::{ProjectAudit, audit_problem, margin_words, numbered};
use crate::command::{CommandError, Watch};
use crate::design::Side;
use crate::robust::RobustProblem;

/// The same laws, neither sampled nor delayed, with their audit; `None` of a continuous loop, or of laws in z.
pub(super) fn unsampled(side: &Side, watch: Watch<'_>) -> Result<Option<Side>, CommandError> {
    let given = &side.problem.compensation;
    let laws =
        [side.controller.feedback.transfer_function()?, side.controller.prefilter.transfer_function()?];
    if given.sample_time_s().is_none() || laws.iter().any(|law| law.domain() != TimeDomain::Continuous) {
        return Ok(None);
    }
    let controller = Controller { timing: Timing::default(), ..side.controller.clone() };
    let compensation = Compensation::new(&controller, given.sensor().clone())?;
    let problem = RobustProblem { compensation, ..side.problem.clone() };
    let view = audit_problem(&problem, watch)?;
    Ok(Some(Side::new(controller, problem, view)?))
}

/// Where sampling and delay take most.
pub(super) fn sentence(sampled: &Side, unsampled: &Side) -> String {
    let findings = |view: &ProjectAudit| view.audit.specifications.clone();
    let margin = |finding: &SpecificationFinding| finding.worst.as_ref().map(|worst| worst.margin_db);
    let pairs = findings(&sampled.view).into_iter().zip(findings(&unsampled.view)).enumerate();
    let changes = pairs.filter_map(|(index, (here, there))| {
        let (here_db, there_db) = (margin(&here)?, margin(&there)?);
        Some((numbered(index, &here.requirement), here_db, there_db))
    });
    let most = changes.min_by(|one, other| (one.1 - one.2).total_cmp(&(other.1 - other.2)));
    let all = "The last column is the same law, were the loop neither sampled nor delayed.";
    match most {
        Some((name, here, there)) if here < there => format!(
            "{all} Sampling and delay take most from {name}: its margin is {} instead of {}.",
            margin_words(here),
            margin_words(there)
        ),
        _ if unsampled.view.audit.verdict == Verdict::Violated => format!(
            "{all} It would not keep to every specification then: it was shaped with hold and delay in the loop, and lives by them."
        ),
        _ => format!("{all} Sampling and delay take nothing from any margin."),
    }
}
