//! The rig itself, where the family does not contain it.

use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::verification::{Audit, Verdict};

use super::audit_request;
use crate::robust::RobustProblem;

/// The rig itself in the loop of a project whose family does not contain it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RigOutside {
    /// The parameters of the rig that are outside of the box, with their values and the box.
    pub beyond: String,
    /// What the loop with the rig does.
    pub in_loop: RigInLoop,
}

/// The result of the audit of a loop with the rig itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RigInLoop {
    /// Stable, and every specification is met.
    Met,
    /// The loop is unstable.
    Unstable,
    /// These specifications are violated, by their indices.
    Violates(Vec<usize>),
    /// Neither proven nor refuted, or the audit was stopped.
    NotProven,
}

impl RigOutside {
    /// True unless the loop with the rig satisfies every specification.
    pub fn is_unproven(&self) -> bool {
        self.in_loop != RigInLoop::Met
    }
}

/// The audit of the rig itself in the loop of a problem; `None` where the family contains it.
pub(crate) fn rig_in_loop(problem: &RobustProblem, watch: Watch<'_>) -> Result<Option<RigOutside>, Stopped> {
    let Some((alone, beyond)) = &problem.rig_outside else { return Ok(None) };
    let audit = phea_qft::audit::audit(&audit_request(problem, alone), watch)?;
    Ok(Some(RigOutside { beyond: beyond.clone(), in_loop: in_loop(&audit) }))
}

/// The result where the watch stopped it: unknown.
pub(crate) fn unexamined_rig(problem: &RobustProblem) -> Option<RigOutside> {
    let (_, beyond) = problem.rig_outside.as_ref()?;
    Some(RigOutside { beyond: beyond.clone(), in_loop: RigInLoop::NotProven })
}

fn in_loop(audit: &Audit) -> RigInLoop {
    let findings = audit.specifications.iter().enumerate();
    let violated = findings.filter(|(_, finding)| finding.verdict == Verdict::Violated);
    match (audit.verdict, audit.stability.verdict) {
        (Verdict::Met, _) => RigInLoop::Met,
        (_, Verdict::Violated) => RigInLoop::Unstable,
        (Verdict::Violated, _) => RigInLoop::Violates(violated.map(|(index, _)| index).collect()),
        (Verdict::NotProven, _) => RigInLoop::NotProven,
    }
}
