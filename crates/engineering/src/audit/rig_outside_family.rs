//! The rig itself, where the family does not contain it.

use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::verification::{Audit, Verdict};

use super::audit_request;
use crate::caveat::{Caveat, UncountedEffect};
use crate::rig::OutsideParameter;
use crate::robust::RobustProblem;
use crate::specification::SpecificationName;

/// The rig itself, which the family does not contain.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideFamily {
    /// The parameters that the family does not contain.
    pub parameters: Vec<OutsideParameter>,
    /// Verdict on the loop with the rig.
    pub with_rig: LoopWithRig,
}

/// Verdict on the loop with the rig itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoopWithRig {
    /// It is stable and satisfies every specification.
    Satisfied,
    /// It is unstable.
    Unstable,
    /// It violates these specifications, each with its number, from 1, and name.
    Violates(Vec<(usize, SpecificationName)>),
    /// Nothing is proven.
    NotProven,
}

/// The audit of the rig itself in the loop of a problem, where the family does not contain it.
pub(crate) fn caveat(problem: &RobustProblem, watch: Watch<'_>) -> Result<Option<Caveat>, Stopped> {
    let Some((alone, outside)) = &problem.rig_outside else { return Ok(None) };
    let audit = phea_qft::audit::audit(&audit_request(problem, alone), watch)?;
    Ok(Some(of_rig(outside, loop_with_rig(problem, &audit), audit.verdict != Verdict::Met)))
}

/// The result where the watch stopped it: unknown.
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
