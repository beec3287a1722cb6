//! The rig itself, where the family does not contain it.

use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::verification::{Audit, Verdict};

use super::audit_request;
use crate::caveat::Caveat;
use crate::robust::RobustProblem;

/// The audit of the rig itself in the loop of a problem, where the family does not contain it.
pub(crate) fn caveat(problem: &RobustProblem, watch: Watch<'_>) -> Result<Option<Caveat>, Stopped> {
    let Some((alone, beyond)) = &problem.rig_outside else { return Ok(None) };
    let audit = phea_qft::audit::audit(&audit_request(problem, alone), watch)?;
    Ok(Some(of_rig(beyond, does(problem, &audit), audit.verdict != Verdict::Met)))
}

/// The result where the watch stopped it: unknown.
pub(crate) fn unexamined(problem: &RobustProblem) -> Option<Caveat> {
    let (_, beyond) = problem.rig_outside.as_ref()?;
    Some(of_rig(beyond, NOTHING_PROVEN.to_string(), true))
}

const NOTHING_PROVEN: &str = "nothing is proven of the loop with it";

fn of_rig(beyond: &str, does: String, unproven: bool) -> Caveat {
    let sentence = format!("the family does not contain the rig as it is derived ({beyond}): {does}");
    Caveat { sentence, unproven }
}

/// The audit of the loop with the rig.
fn does(problem: &RobustProblem, audit: &Audit) -> String {
    let violated: Vec<String> = audit
        .specifications
        .iter()
        .enumerate()
        .filter(|(_, finding)| finding.verdict == Verdict::Violated)
        .map(|(index, _)| format!("{} {}", index + 1, problem.name_of(index)))
        .collect();
    match (audit.verdict, audit.stability.verdict) {
        (Verdict::Met, _) => "the loop with it is stable and satisfies every specification".to_string(),
        (_, Verdict::Violated) => "the loop with it is unstable".to_string(),
        (Verdict::Violated, _) => format!("the loop with it violates {}", violated.join(", ")),
        (Verdict::NotProven, _) => NOTHING_PROVEN.to_string(),
    }
}
