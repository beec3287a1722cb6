//! An audit composed of two.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::pieces::{WorkPiece, Workers};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::{Stopped, Watch, unwatched};
use phea_qft::audit::{audit, audit_by};
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::proof::{ProofOptions, prove};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::stability::family_stability;
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict, audit_specifications};

/// Plant k/(s^2 + 0.4 s + 1) under integral control, sampled ten times per second.
fn family(extent: Extent) -> Family {
    let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 0.5, maximum: 2.0 };
    let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0]],
            denominator: vec![1.0.into(), 0.4.into(), 1.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let plant = plant.unwrap();
    let along =
        vec![Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 5 }];
    let members = grid(&plant, &along).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, along, members, extent).unwrap())
}

fn sampled_loop() -> Compensation {
    let timing = Timing { sample_time_s: Some(0.1), ..Timing::default() };
    let integral = Element::ProportionalIntegral { proportional_gain: 0.05, integral_gain: 0.1 };
    let feedback = Compensator::new(vec![integral]);
    let controller = Controller { feedback, timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn specifications() -> [Specification; 1] {
    [Specification {
        requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1.5)),
        frequencies_rad_per_s: vec![1.0],
        band_rad_per_s: [0.0, f64::INFINITY],
    }]
}

/// Transfer of plants from one audit to the other, which saves work and does not change the
/// results.
#[test]
fn audits_in_one_pass_agree_with_separate_audits() {
    for extent in [Extent::Box, Extent::Members] {
        let (family, around) = (family(extent), sampled_loop());
        let problem = AuditProblem {
            family: &family,
            compensation: &around,
            specifications: &specifications(),
            tracking: TrackingJudgement::Magnitude,
            tolerance_db: TOLERANCE_DB,
        };
        let stability = family_stability(&family, &around, &mut unwatched).unwrap();
        let (separate, _) = audit_specifications(&problem, &mut unwatched).unwrap();
        let audit = audit(&problem, &mut unwatched).unwrap();
        assert_eq!(audit.stability, stability.finding);
        assert_eq!(audit.delay_margin, stability.delay_margin);
        assert_eq!(audit.stability.verdict, Verdict::Met, "{:?}", audit.stability);
        assert_eq!(audit.specifications, separate);
    }
}

/// Workers that take the tasks from the last to the first.
fn backwards(pieces: Vec<WorkPiece<'_>>, _: &'static str, watch: Watch<'_>) -> Result<(), Stopped> {
    pieces.into_iter().rev().try_for_each(|piece| piece(&mut *watch))
}

/// Plants, searches and specifications are independent of each other: any number of workers, in any
/// order, gives identical findings and proofs.
#[test]
fn audit_and_proof_do_not_depend_on_the_workers() {
    for extent in [Extent::Box, Extent::Members] {
        let (family, around) = (family(extent), sampled_loop());
        let wider = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.6));
        let [sensitivity] = specifications();
        let problem = AuditProblem {
            family: &family,
            compensation: &around,
            specifications: &[Specification { requirement: wider, ..sensitivity.clone() }, sensitivity],
            tracking: TrackingJudgement::Magnitude,
            tolerance_db: TOLERANCE_DB,
        };
        let found = |workers: Workers| {
            let audit = audit_by(&problem, workers, &mut unwatched).unwrap();
            let options = ProofOptions { workers, ..ProofOptions::default() };
            let proof = prove(&problem, &audit, options, &mut unwatched).unwrap();
            (audit, proof)
        };
        let separate = found(Workers::CALLER);
        assert_eq!(separate.0, audit(&problem, &mut unwatched).unwrap());
        for at_once in [1, 2, 5] {
            assert_eq!(found(Workers { at_once, work: backwards }), separate, "{at_once}");
        }
    }
}

/// Stopped audits: an audit stops at once when its watch requests it, and reports its progress
/// until then.
#[test]
fn an_audit_can_be_stopped() {
    let (family, around) = (family(Extent::Box), sampled_loop());
    let problem = AuditProblem {
        family: &family,
        compensation: &around,
        specifications: &specifications(),
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    for limit in [0.0, 0.3, 0.5, 0.9] {
        let mut last = 0.0;
        let stopped = audit(&problem, &mut |progress| {
            assert!((last..=1.0).contains(&progress.fraction) && last <= limit, "{progress:?}");
            last = progress.fraction;
            last <= limit
        });
        assert_eq!(stopped, Err(Stopped));
    }
}
