//! Proofs of sampled loops: against the audit, which samples by state space, against closed forms,
//! and against random plants.
#![cfg(test)]

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
use phea_qft::proof::{Certificate, Claim, ClaimStatus, ControlLaw, Proof, ProofOptions, check, prove};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};

use crate::proof::{sound, thesis_in};
use crate::verification::thesis::{thesis_family, thesis_specifications};

fn published(sample_time_s: f64, delay_s: f64) -> Compensation {
    let law = Element::ProportionalIntegral { proportional_gain: 0.001, integral_gain: 0.008 };
    let timing = Timing { sample_time_s: Some(sample_time_s), delay_s, ..Timing::default() };
    let controller = Controller { feedback: Compensator::new(vec![law]), timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

/// The published law at three rates and delays, including a fraction of a sample: every enclosure
/// contains the result of the audit by another method of sampling, and stability is proven in a few
/// leaves.
#[test]
fn enclosures_of_the_published_controller_hold_what_the_audit_finds() {
    for (sample_time_s, delay_s) in [(0.001, 0.0), (0.001, 0.001), (0.0005, 0.0002)] {
        let compensation = published(sample_time_s, delay_s);
        let proof = thesis_in(&compensation);
        assert_eq!(proof.stability, ClaimStatus::Proven);
        let (family, specifications) = (thesis_family([2; 6]), thesis_specifications());
        let tracking = TrackingJudgement::Magnitude;
        let problem = AuditProblem {
            family: &family,
            compensation: &compensation,
            specifications: &specifications,
            tracking,
            tolerance_db: TOLERANCE_DB,
        };
        let found = audit(&problem, &mut unwatched).unwrap();
        for (own, searched) in proof.specifications.iter().zip(&found.specifications) {
            assert_eq!(own.claim_status, ClaimStatus::Refuted);
            let (least, most) = (own.least_db.unwrap(), own.most_db.unwrap());
            let worst = -searched.worst.as_ref().unwrap().margin_db;
            assert!(most - least < 0.06 && worst <= most, "{least} {worst} {most}");
            assert!(worst >= least - 1e-3, "{least} {worst} {most}");
        }
        let certificate = proof.certificate.unwrap();
        assert!(certificate.leaves() < 200, "{}", certificate.leaves());
        assert_eq!(check(&certificate), Ok(()));
    }
}

/// Random plants, sampling rates, delays and prefilters in z and in s.
#[test]
fn no_plant_contradicts_a_proof_of_a_sampled_loop() {
    let [stable, _, limited] = sound(0..15, 500, true);
    assert!(stable > 10 && limited > 60, "{stable} {limited}");
}

/// An integrator k/s with a gain of one: L = k T/(z - 1).
fn integrator(gains: [f64; 2], limit: f64, band_rad_per_s: [f64; 2]) -> Proof {
    let [minimum, maximum] = gains;
    let parameter = UncertainParameter { name: "k".into(), nominal: minimum, minimum, maximum };
    let plant = UncertainPlant::record(vec![parameter], |p| PlantCoefficients {
        command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let requirement = Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(limit));
    let options = ProofOptions { width_db: 0.3, ..ProofOptions::default() };
    proven(plant.unwrap(), 1.0, requirement, band_rad_per_s, options)
}

/// A box over the first parameter, with a proportional gain, sampled once per second.
fn proven(
    plant: UncertainPlant,
    gain: f64,
    requirement: Requirement,
    band_rad_per_s: [f64; 2],
    options: ProofOptions,
) -> Proof {
    let spacing = vec![Spacing::Linear];
    let coordinate = vec![Coordinate { parameters: vec![0], opposed: vec![], spacing, points: 2 }];
    let members = vertices(&plant, &coordinate).unwrap();
    let family = Family::Uncertain(UncertainFamily::new(plant, coordinate, members, Extent::Box).unwrap());
    let feedback = Compensator::new(vec![Element::Gain(gain)]);
    let timing = Timing { sample_time_s: Some(1.0), ..Timing::default() };
    let controller = Controller { feedback, timing, ..Controller::default() };
    let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let specifications = [Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s }];
    let problem = AuditProblem {
        family: &family,
        compensation: &compensation,
        specifications: &specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    let found = audit(&problem, &mut unwatched).unwrap();
    prove(&problem, &found, options, &mut unwatched).unwrap()
}

// ORIGIN: analytic, S = (z - 1)/(z - 1 + k T) is greatest where the band ends and k is greatest:
// 2/sqrt 3 at a third of pi/T and k T = 1/2
#[test]
fn the_sensitivity_of_a_sampled_integrator_is_enclosed() {
    let proof = integrator([0.3, 0.5], 1.0, [0.0, std::f64::consts::FRAC_PI_3]);
    let truth_db = 20.0 * phea_dynamics::portable::log10(2.0 / 3.0_f64.sqrt());
    let own = &proof.specifications[0];
    assert_eq!([&proof.stability, &own.claim_status], [&ClaimStatus::Proven, &ClaimStatus::Refuted]);
    let (least, most) = (own.least_db.unwrap(), own.most_db.unwrap());
    assert!(least <= truth_db && truth_db <= most && most - least < 0.4, "{least} {truth_db} {most}");
}

// ORIGIN: analytic, the pole of the loop is 1 - k T
#[test]
fn poles_of_a_sampled_loop_are_counted() {
    let whole = [0.0, f64::INFINITY];
    assert_eq!(integrator([1.0, 1.8], 100.0, whole).stability, ClaimStatus::Proven);
    assert_eq!(integrator([1.5, 3.0], 100.0, whole).stability, ClaimStatus::Refuted);
    let crossed = integrator([1.9, 2.1], 100.0, whole);
    assert!(crossed.stability != ClaimStatus::Proven, "{:?}", crossed.stability);
}

/// A mode that is folded onto frequencies at which the loop has gain is unstable for some of its
/// frequencies and none of its ends: the result at the ends is not taken for the box.
#[test]
fn a_folded_mode_that_passes_the_band_is_not_proven() {
    let turn = 2.0 * std::f64::consts::PI;
    let parameter = UncertainParameter {
        name: "w".into(),
        nominal: turn + 0.2,
        minimum: turn + 0.2,
        maximum: turn + 1.5,
    };
    let plant = UncertainPlant::record(vec![parameter], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * p[0]],
            denominator: vec![1.0.into(), p[0] * 0.002.into(), p[0] * p[0]],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let requirement = || Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1000.0));
    let found = proven(
        plant.unwrap(),
        0.9,
        requirement(),
        [0.0, f64::INFINITY],
        ProofOptions { leaves_maximum: 3000, ..ProofOptions::default() },
    );
    assert!(found.stability != ClaimStatus::Proven, "{:?}", found.stability);
}

/// Certificate of a sampled loop: valid as proven, and rejected if it claims more.
#[test]
fn a_certificate_of_a_sampled_loop_that_was_tampered_with_is_rejected() {
    let genuine = thesis_in(&published(0.001, 0.0003)).certificate.unwrap();
    let altered = |change: &dyn Fn(&mut Certificate)| {
        let mut other = genuine.clone();
        change(&mut other);
        check(&other).is_err()
    };
    // another loop
    assert!(altered(&|other| other.sampling.as_mut().unwrap().sample_time_s *= 4.0));
    assert!(altered(&|other| other.plant.delay_s *= 10.0));
    assert!(altered(&|other| {
        if let ControlLaw::Sampled(sections) = &mut other.feedback {
            sections.gain *= 2.0;
        }
    }));
    assert!(altered(&|other| {
        if let ControlLaw::Sampled(sections) = &mut other.feedback {
            sections.denominator[0][1] -= 0.1;
        }
    }));
    // a prefilter with a pole on the circle
    assert!(altered(&|other| {
        if let ControlLaw::Sampled(sections) = &mut other.prefilter {
            sections.denominator.push(vec![1.0, 2.0]);
        }
    }));
    // omitted images, and bounds that are not reached
    assert!(altered(&|other| other.sampling.as_mut().unwrap().images = 0));
    assert!(altered(&|other| other.sampling.as_mut().unwrap().images = 1));
    assert!(altered(&|other| other.sampling.as_mut().unwrap().bounds[0][0].ratio *= 0.5));
    assert!(altered(&|other| other.sampling.as_mut().unwrap().bounds[0][0].panels.clear()));
    assert!(altered(&|other| other.sampling.as_mut().unwrap().bounds.clear()));
    assert!(altered(&|other| other.sampling = None));
    // the count of another function, or none
    let of_stable = |certificate: &mut Certificate, change: &dyn Fn(&mut phea_qft::proof::StableBox)| {
        for claim in &mut certificate.claims {
            if let Claim::Stable(boxes) = claim {
                boxes.iter_mut().for_each(change);
            }
        }
    };
    assert!(altered(&|other| of_stable(other, &|one| one.count = None)));
    assert!(altered(&|other| of_stable(other, &|one| {
        let count = one.count.as_mut().unwrap();
        count.denominator = count.characteristic.clone();
    })));
    assert!(altered(&|other| of_stable(other, &|one| drop(one.panels.pop()))));
    assert!(altered(&|other| of_stable(other, &|one| drop(one.count.as_mut().unwrap().beyond.pop()))));
}
