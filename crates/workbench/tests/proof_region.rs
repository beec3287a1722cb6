//! Proofs of families whose operating points have a load force, or a velocity: the coefficients
//! follow from an equilibrium that is solved, and every plant of dense samples is within the proven
//! bounds.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::HOSE;
use phea_dynamics::portable::{log10, magnitude, pow};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::family::Family;
use phea_qft::proof::{Certificate, Claim, ClaimStatus, ProofOptions, check, differences, prove};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};
use phea_workbench::project;
use phea_workbench::robust::{RobustProblem, robust_problem};
use phea_workbench::setup::Setup;
use phea_workbench::source::Memory;

/// Largest |T|, which every plant of these regions satisfies.
const LIMIT: f64 = 3.5;

fn problem(uncertainty: &str) -> RobustProblem {
    let source = Memory::default().with("p.toml", HOSE);
    let settings = [format!("uncertainty={{ {uncertainty} }}")];
    let read = project::read(&source, "p.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    let problem = robust_problem(&source, &Setup::new(&read.project).unwrap()).unwrap();
    let requirement = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(LIMIT));
    let specification = Specification { requirement, ..problem.specifications[0].clone() };
    RobustProblem { specifications: vec![specification], ..problem }
}

fn request(problem: &RobustProblem) -> AuditProblem<'_> {
    AuditProblem {
        family: &problem.family,
        compensation: &problem.compensation,
        specifications: &problem.specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    }
}

fn range(name: &str, [low, high]: [f64; 2]) -> String {
    let nominal = 0.5 * (low + high);
    format!(
        "\"operating_point.{name}\" = {{ nominal = {nominal}, minimum = {low}, maximum = {high}, points = 2 }}"
    )
}

/// Proves stability and the limit of |T| over a region; its certificate holds, and no plant of a
/// dense grid exceeds the proven bounds.
fn proven(uncertainty: &str) -> Certificate {
    let problem = problem(uncertainty);
    let request = request(&problem);
    let found = audit(&request, &mut unwatched).unwrap();
    let proof = prove(&request, &found, ProofOptions::default(), &mut unwatched).unwrap();
    assert_eq!(proof.stability, ClaimStatus::Proven, "{uncertainty}");
    assert_eq!(
        proof.specifications[0].claim_status,
        ClaimStatus::Proven,
        "{uncertainty} {:?}",
        proof.specifications
    );
    let certificate = proof.certificate.unwrap();
    assert_eq!(check(&certificate), Ok(()));
    assert_eq!(differences(&certificate, &request), []);
    let Family::Uncertain(family) = &problem.family else { panic!("a box") };
    let most_db = proof.specifications[0].most_db.unwrap();
    let axes = family.coordinates().len();
    let count: usize = if axes > 2 { 7 } else { 41 };
    let mut worst_db = f64::NEG_INFINITY;
    for number in 0..count.pow(axes as u32) {
        let fraction = |axis: usize| (number / count.pow(axis as u32) % count) as f64 / (count - 1) as f64;
        let values = family.values(&(0..axes).map(fraction).collect::<Vec<f64>>());
        for step in 0..40 {
            let frequency = 0.1 * pow(1e5, f64::from(step) / 39.0);
            let open = family.plant().response(&values, frequency).unwrap()
                * problem.compensation.feedback().at_frequency(frequency);
            worst_db = worst_db.max(20.0 * log10(magnitude(open / (1.0 + open)) / LIMIT));
        }
    }
    assert!(worst_db <= most_db + 1e-6, "{worst_db} {most_db}");
    certificate
}

/// Regions of force from ten newtons to thousands, on one side of null.
#[test]
fn regions_of_force_are_proven() {
    for ends in [[1995.0, 2005.0], [1000.0, 1400.0], [-5.0, 5.0], [-3000.0, 1500.0]] {
        let certificate = proven(&range("load_force", ends));
        // a forged coefficient belongs to no plant, and its claims are rejected
        let mut forged = certificate.clone();
        for segments in &mut forged.plant.boxes {
            for segment in segments.iter_mut().filter(|one| one.variable.is_some()) {
                segment.high = segment.low + 3.0 * (segment.high - segment.low);
            }
        }
        assert!(!differences(&forged, &request(&problem(&range("load_force", ends)))).is_empty());
        let mut forged = certificate;
        for claim in &mut forged.claims {
            if let Claim::Limited { ratio, .. } = claim {
                *ratio *= 0.9;
            }
        }
        assert!(check(&forged).is_err());
    }
}

#[test]
fn a_region_of_velocity_is_proven() {
    proven(&range("velocity", [0.02, 0.022]));
    proven(&[range("velocity", [0.02, 0.03]), range("load_force", [300.0, 700.0])].join(", "));
}
