//! Stability of the family, and its proof, in the answer of an audit.

use phea_qft::proof::{Certificate, ClaimStatus, Proof};
use phea_qft::verification::{Evidence, SearchedInfinity, StabilityFinding, Verdict};

use crate::answer::{Answer, OrReason};
use crate::audit::proven::why_not_proven;
use crate::audit::{ProjectAudit, stability_reason};
use crate::plant_names::{NamedPlant, PlantNames};

/// Stability of every plant.
#[derive(Answer)]
pub(crate) struct StableAnswer {
    /// True if every plant of the family is stable in the loop.
    stable: OrReason<bool>,
}

/// Stability of the family in the loop.
#[derive(Answer)]
pub(super) struct StabilityAnswer {
    /// Verdict on stability.
    verdict: Verdict,
    /// Evidence for the verdict.
    evidence: Evidence,
    /// Largest real part of a closed-loop pole, ln|z|/T in a sampled loop; null if the poles are
    /// not available.
    largest_real_part_per_s: Option<f64>,
    /// Plant with this pole, or that is unstable, or that could not be resolved.
    plant: NamedPlant,
    /// Reason for the verdict.
    reason: String,
    /// Leading coefficient of the characteristic equation, if a search had to find its least value:
    /// while its sign is constant, no pole passes through infinity.
    #[answer(optional)]
    leading_coefficient: Option<LeadingCoefficientAnswer>,
}

/// Least leading coefficient of the characteristic equation that a search found in the box.
#[derive(Answer)]
struct LeadingCoefficientAnswer {
    /// Ratio of the least value to the value of the nominal plant.
    least_fraction_of_nominal: f64,
    /// Plant with the least value.
    plant: NamedPlant,
    /// Parameters that change it, the most important first.
    parameters: Vec<String>,
}

/// Proof over the box.
#[derive(Answer)]
pub(super) struct AuditProofAnswer {
    /// Proof of stability.
    stable: ProvenAnswer,
    /// Number of boxes of the certificate.
    leaves: usize,
}

/// Outcome of the proof of a claim.
#[derive(Answer)]
pub(super) struct ProvenAnswer {
    /// True if the claim is proven, false if it is refuted.
    proven: OrReason<bool>,
}

/// Stability of every plant, as far as it is known.
pub(crate) fn stable(stability: &StabilityFinding) -> StableAnswer {
    let stable = match stability.verdict {
        Verdict::Met => Some(true),
        Verdict::Violated => Some(false),
        Verdict::NotProven => None,
    };
    StableAnswer { stable: OrReason::new(stable, stability_reason(stability)) }
}

/// The stability of a family.
pub(super) fn stability(stability: &StabilityFinding, names: &PlantNames) -> StabilityAnswer {
    StabilityAnswer {
        verdict: stability.verdict,
        evidence: stability.evidence,
        largest_real_part_per_s: stability.largest_real_part,
        plant: names.named(&stability.plant),
        reason: stability_reason(stability),
        leading_coefficient: stability.infinity.as_ref().map(|found| leading_coefficient(found, names)),
    }
}

fn leading_coefficient(found: &SearchedInfinity, names: &PlantNames) -> LeadingCoefficientAnswer {
    let all = names.headings();
    let moved = found.parameters.iter().filter_map(|&index| all.get(index).copied());
    LeadingCoefficientAnswer {
        least_fraction_of_nominal: found.least_fraction,
        plant: names.named(&found.plant),
        parameters: moved.map(str::to_string).collect(),
    }
}

/// The proof of an audit.
pub(super) fn proof(view: &ProjectAudit, proof: &Proof) -> AuditProofAnswer {
    AuditProofAnswer {
        stable: proven(view, proof, &proof.stability),
        leaves: proof.certificate.as_ref().map_or(0, Certificate::leaves),
    }
}

/// The outcome of a claim.
pub(super) fn proven(view: &ProjectAudit, proof: &Proof, claim_status: &ClaimStatus) -> ProvenAnswer {
    let proven = match claim_status {
        ClaimStatus::Proven => Some(true),
        ClaimStatus::Refuted => Some(false),
        ClaimStatus::NotProven(_) => None,
    };
    ProvenAnswer {
        proven: OrReason::new(proven, why_not_proven(view, proof, claim_status).unwrap_or_default()),
    }
}
