//! Proofs and refutations of published loops.
#![cfg(test)]

use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::proof::{ProofOptions, prove};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};

use crate::verification::thesis::{thesis_family, thesis_loop, thesis_specifications};

#[test]
fn published() {
    let (family, compensation, specifications) =
        (thesis_family([2; 6]), thesis_loop(0.0), thesis_specifications());
    let problem = AuditProblem {
        family: &family,
        compensation: &compensation,
        specifications: &specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    let found = audit(&problem, &mut unwatched).unwrap();
    let start = std::time::Instant::now();
    let proof = prove(&problem, &found, ProofOptions::default(), &mut unwatched).unwrap();
    println!("{:?} {:?} {:#?}", start.elapsed(), proof.stability, proof.specifications);
    println!("{} leaves", proof.certificate.unwrap().leaves());
}
