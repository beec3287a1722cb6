//! Audit of the rig itself if the family does not contain it.

use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::verification::{Audit, Verdict};

use super::audit_request;
use crate::caveat::{Caveat, LoopWithRig, OutsideFamily, UncountedEffect};
use crate::rig::OutsideParameter;
use crate::robust::RobustProblem;

/// Audit of the rig itself in the loop of a problem, if the family does not contain it.
pub(crate) fn caveat(problem: &RobustProblem, watch: Watch<'_>) -> Result<Option<Caveat>, Stopped> {
    let Some((alone, outside)) = &problem.rig_outside else { return Ok(None) };
    let audit = phea_qft::audit::audit(&audit_request(problem, alone), watch)?;
    Ok(Some(of_rig(outside, loop_with_rig(problem, &audit), audit.verdict != Verdict::Met)))
}

/// Unknown result, after cancellation by `watch`.
pub(crate) fn unexamined(problem: &RobustProblem) -> Option<Caveat> {
    let (_, outside) = problem.rig_outside.as_ref()?;
    Some(of_rig(outside, LoopWithRig::NotProven, true))
}

fn of_rig(outside: &[OutsideParameter], with_rig: LoopWithRig, unproven: bool) -> Caveat {
    let found = OutsideFamily { parameters: outside.to_vec(), with_rig };
    Caveat { effect: UncountedEffect::OutsideFamily(found), unproven }
}

/// Verdict of the audit of the loop with the rig.
fn loop_with_rig(problem: &RobustProblem, audit: &Audit) -> LoopWithRig {
    let violated = || {
        let findings = audit.specifications.iter().zip(&problem.specification_names).enumerate();
        let violated = findings.filter(|(_, (finding, _))| finding.verdict == Verdict::Violated);
        violated.map(|(index, (_, name))| (index + 1, *name)).collect()
    };
    match (audit.verdict, audit.stability.verdict) {
        (Verdict::Met, _) => LoopWithRig::Satisfied,
        (_, Verdict::Violated) => LoopWithRig::Unstable,
        (Verdict::Violated, _) => LoopWithRig::Violates(violated()),
        (Verdict::NotProven, _) => LoopWithRig::NotProven,
    }
}
