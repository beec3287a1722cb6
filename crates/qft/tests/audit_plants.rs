//! Plants that one audit hands on to the next.

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_qft::audit::AuditRun;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::specification::{Limit, Requirement, Specification};
use phea_qft::stability::StabilityAudit;
use phea_qft::verification::{SpecificationAudit, TOLERANCE_DB, TrackingJudgement, Verdict};

/// k/(s^2 + 0.4 s + 1) under integral control, sampled ten times a second.
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

fn sampled_loop(delay_s: f64) -> Compensation {
    let timing = Timing { sample_time_s: Some(0.1), delay_s, ..Timing::default() };
    let integral = Element::ProportionalIntegral { proportional_gain: 0.05, integral_gain: 0.1 };
    let feedback = Compensator::new(vec![integral]);
    let controller = Controller { feedback, timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn specifications() -> [Specification; 1] {
    [Specification {
        requirement: Requirement::Sensitivity(Limit::Constant(1.5)),
        frequencies_rad_per_s: vec![1.0],
        band_rad_per_s: [0.0, f64::INFINITY],
    }]
}

fn specification_audit(family: &Family, around: &Compensation) -> SpecificationAudit {
    SpecificationAudit::new(family, around, &specifications(), TrackingJudgement::Magnitude, TOLERANCE_DB)
}

/// Handing plants on from one audit to the other saves work and changes nothing.
#[test]
fn both_audits_find_what_they_find_alone() {
    for extent in [Extent::Box, Extent::Members] {
        let (family, around) = (family(extent), sampled_loop(0.0));
        let mut stability = StabilityAudit::new(&family, &around);
        while stability.step() {}
        let mut alone = specification_audit(&family, &around);
        while alone.step() {}
        let all = &specifications();
        let mut run = AuditRun::new(&family, &around, all, TrackingJudgement::Magnitude, TOLERANCE_DB);
        while run.step() {}
        let audit = run.audit();
        assert_eq!(audit.stability, stability.result().finding);
        assert_eq!(audit.delay_margin, stability.result().delay_margin);
        assert_eq!(audit.stability.verdict, Verdict::Met, "{:?}", audit.stability);
        assert_eq!(audit.specifications, alone.findings());
        assert_eq!(run.take_stability_plants().count(), 0);
        assert!(stability.take_sampled().count() >= 5);
    }
}

/// Plants of a loop with more delay show that they are not sampled again.
#[test]
fn plants_that_were_taken_over_are_not_sampled_again() {
    let (family, around) = (family(Extent::Members), sampled_loop(0.0));
    let mut delayed = StabilityAudit::new(&family, &sampled_loop(0.5));
    while delayed.step() {}
    let mut own = specification_audit(&family, &around);
    let mut others = own.clone();
    others.take_over(delayed.take_sampled());
    while own.step() {}
    while others.step() {}
    let worst = |audit: &SpecificationAudit| audit.findings()[0].worst.as_ref().unwrap().margin_db;
    assert!(worst(&others) < worst(&own) - 0.01, "{} {}", worst(&others), worst(&own));
}
