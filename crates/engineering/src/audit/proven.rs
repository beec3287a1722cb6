//! Proof or refutation of the findings of an audit; the verdict is then based on the proof.

use phea_dynamics::watch::{Stopped, Watch};
use phea_qft::proof::{ClaimStatus, NotProven, Proof, ProofOptions, prove};
use phea_qft::verification::{Evidence, Verdict};

use super::{ProjectAudit, audit_request};
use crate::robust::RobustProblem;
use crate::side_by_side::all_cores;

/// Proves or refutes stability and every specification of an audit. Anything that is neither proven
/// nor refuted becomes `not_proven`, whatever the search found, except for a violation, which is
/// shown by a plant and a frequency.
///
/// # Errors
/// [`Stopped`] if `watch` cancels it.
pub fn prove_audit(
    problem: &RobustProblem,
    view: &mut ProjectAudit,
    watch: Watch<'_>,
) -> Result<(), Stopped> {
    let options = ProofOptions { workers: all_cores(), ..ProofOptions::default() };
    let proof = prove(&audit_request(problem, &problem.family), &view.audit, options, watch)?;
    rest_on(view, proof, Verdict::NotProven);
    Ok(())
}

/// Proves or refutes an audit for which no proof was requested: anything that is neither proven nor
/// refuted retains the result of the search, and less effort is spent.
///
/// # Errors
/// [`Stopped`] if `watch` cancels it.
pub fn prove_claims(
    problem: &RobustProblem,
    view: &mut ProjectAudit,
    watch: Watch<'_>,
) -> Result<(), Stopped> {
    let options =
        ProofOptions { leaves_maximum: TRIAL_LEAVES, workers: all_cores(), ..ProofOptions::default() };
    let proof = prove(&audit_request(problem, &problem.family), &view.audit, options, watch)?;
    rest_on(view, proof, Verdict::Met);
    Ok(())
}

/// Number of leaves of a panel if no proof was requested.
const TRIAL_LEAVES: usize = 10_000;

/// Bases the verdict on a proof; `unproven` is the verdict for an audit that is met but not proven.
fn rest_on(view: &mut ProjectAudit, mut proof: Proof, unproven: Verdict) {
    let audit = &mut view.audit;
    for (finding, found) in audit.specifications.iter().zip(&mut proof.specifications) {
        contradicted(&mut found.claim_status, finding.verdict);
    }
    contradicted(&mut proof.stability, audit.stability.verdict);
    let stability = &mut audit.stability;
    let judged = |claim_status: &ClaimStatus, searched: Verdict, evidence: Evidence| match claim_status {
        ClaimStatus::Proven | ClaimStatus::Refuted => (claim_status.verdict(), Evidence::Proof),
        ClaimStatus::NotProven(_) => (searched.max(unproven), evidence),
    };
    (stability.verdict, stability.evidence) = judged(&proof.stability, stability.verdict, stability.evidence);
    for (finding, found) in audit.specifications.iter_mut().zip(&proof.specifications) {
        if found.claim_status == ClaimStatus::Refuted && finding.verdict != Verdict::Violated {
            finding.worst.clone_from(&found.worst);
        }
        (finding.verdict, finding.evidence) = judged(&found.claim_status, finding.verdict, finding.evidence);
    }
    let all = || {
        let own = [(audit.stability.verdict, audit.stability.evidence)].into_iter();
        own.chain(audit.specifications.iter().map(|finding| (finding.verdict, finding.evidence)))
    };
    let worst = all().map(|(verdict, _)| verdict).fold(Verdict::Met, Verdict::max);
    audit.verdict = match (worst, audit.verdict) {
        // effects that are declared but not included
        (Verdict::Met, Verdict::NotProven) => Verdict::NotProven,
        _ => worst,
    };
    let verdict = audit.verdict;
    let deciding = all().filter(|(own, _)| verdict == Verdict::Met || *own == verdict);
    let evidence = match verdict {
        // one proven violation is enough
        Verdict::Violated => deciding.map(|(_, evidence)| evidence).max(),
        Verdict::Met | Verdict::NotProven => deciding.map(|(_, evidence)| evidence).min(),
    };
    audit.evidence = evidence.unwrap_or(audit.evidence);
    view.proof = Some(proof);
}

/// Corrects a standing: a plant and a frequency at which the search found a violation outweigh any
/// proof.
fn contradicted(claim_status: &mut ClaimStatus, searched: Verdict) {
    if *claim_status == ClaimStatus::Proven && searched == Verdict::Violated {
        *claim_status = ClaimStatus::NotProven(NotProven::Contradicted);
    }
}
