//! Proofs with a small budget.

use phea_dynamics::watch::unwatched;
use phea_qft::family::Family;
use phea_qft::proof::{ClaimStatus, NotProven, ProofOptions, check, prove};

use crate::proof::{blind, problem, random_problem};

/// A proof with any budget reports the remainder: from a frequency on, or nothing; a larger budget
/// never proves less, and no budget leads to a false claim.
#[test]
fn a_proof_within_a_budget_reports_the_remainder() {
    let mut last = 0;
    for points in [0, 2_000, 20_000, 200_000, 100_000_000] {
        let mut shown = 0;
        for seed in 0..6 {
            let random = random_problem(seed, seed % 2 == 1);
            let Family::Uncertain(family) = &random.family else { panic!("a box") };
            let nominal = family.plant().nominal();
            let audited = problem(&random.family, &random.compensation, &random.specifications);
            let options = ProofOptions { points_maximum: points, ..ProofOptions::default() };
            let proof = prove(&audited, &blind(&random, nominal), options, &mut unwatched).unwrap();
            if let Some(certificate) = &proof.certificate {
                assert_eq!(check(certificate), Ok(()), "seed {seed}");
            }
            let claim_statuses = proof.specifications.iter().map(|one| &one.claim_status);
            for claim_status in std::iter::once(&proof.stability).chain(claim_statuses) {
                match claim_status {
                    ClaimStatus::Proven | ClaimStatus::Refuted => shown += 1,
                    ClaimStatus::NotProven(NotProven::Budget(region)) => {
                        let [from, to] = region.band_rad_per_s;
                        assert!(0.0 <= from && from < to, "{region:?}");
                    }
                    ClaimStatus::NotProven(_) => {}
                }
            }
        }
        assert!(shown >= last, "{points}: {shown} after {last}");
        last = shown;
    }
    assert!(last > 0);
}
