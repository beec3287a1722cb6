//! Proofs of plants whose coefficients are not polynomials in their parameters, and of parameters
//! that move together by equal factors: against random plants.
#![cfg(test)]

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::expression::Recorded;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::audit::audit;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
use phea_qft::proof::{Certificate, ClaimStatus, ParameterSegment, Proof, ProofOptions, check, prove};
use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};

fn parameter(name: &str, minimum: f64, maximum: f64) -> UncertainParameter {
    UncertainParameter { name: name.into(), nominal: minimum, minimum, maximum }
}

/// Plant with every recorded operation, with a choice that is decided on the whole box and one that
/// is not.
fn curved<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    let (pressure, length, heat) = (p[0], p[1], p[2]);
    let flow = (pressure - 1.0.into()).sqrt();
    let stiffness = Recorded::from(6.0) / length + (-heat).exp();
    let damping = (heat + 3.0.into()).ln() + (heat - 9.0.into()).abs().times(0.1);
    let decided = Recorded::select(pressure.less_than(0.5.into()), (pressure - 0.5.into()).sqrt(), flow);
    let undecided =
        Recorded::select(heat.less_than(0.5.into()), heat.times(0.01), heat.times(0.01) + 1e-4.into());
    PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![decided * stiffness],
            denominator: vec![1.0.into(), damping + undecided, stiffness],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    }
}

/// Plant whose stiffness rises over a step with both ends inside the box.
fn stepped<'t>(p: &[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>> {
    let (length, heat) = (p[1], p[2]);
    let (zero, one) = (Recorded::from(0.0), Recorded::from(1.0));
    let within = ((heat - 0.43.into()) / 0.06.into()).maximum(zero).minimum(one);
    let stiffness =
        Recorded::from(6.0) / length + within.squared() * (Recorded::from(3.0) - within.times(2.0));
    PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * stiffness],
            denominator: vec![1.0.into(), 2.0.into(), stiffness],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    }
}

fn family(together: bool) -> Family {
    family_of(curved, together)
}

fn family_of(
    equations: impl for<'t> FnMut(&[Recorded<'t>]) -> PlantCoefficients<Recorded<'t>>,
    together: bool,
) -> Family {
    let parameters =
        vec![parameter("pressure", 2.0, 3.0), parameter("length", 1.0, 1.5), parameter("heat", 0.1, 0.9)];
    let plant = UncertainPlant::record(parameters, equations).unwrap();
    let single = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Linear],
        points: 2,
    };
    let coordinates = match together {
        false => (0..3).map(single).collect(),
        true => {
            let spacing = vec![Spacing::Logarithmic; 2];
            vec![Coordinate { parameters: vec![0, 2], opposed: vec![2], spacing, points: 3 }, single(1)]
        }
    };
    let members = vertices(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

fn specifications() -> Vec<Specification> {
    let whole = [0.0, f64::INFINITY];
    let specification =
        |requirement| Specification { requirement, frequencies_rad_per_s: vec![1.0], band_rad_per_s: whole };
    vec![
        specification(Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(2.0))),
        specification(Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(2.0))),
        specification(Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(3.0))),
    ]
}

fn around(sample_time_s: Option<f64>) -> Compensation {
    let law = Element::ProportionalIntegral { proportional_gain: 0.1, integral_gain: 0.3 };
    let timing = Timing { sample_time_s, ..Timing::default() };
    let controller = Controller { feedback: Compensator::new(vec![law]), timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn proven(family: &Family, compensation: &Compensation) -> Proof {
    let specifications = specifications();
    let problem = AuditProblem {
        family,
        compensation,
        specifications: &specifications,
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    let found = audit(&problem, &mut unwatched).unwrap();
    let proof = prove(&problem, &found, ProofOptions::default(), &mut unwatched).unwrap();
    assert_eq!(proof.stability, ClaimStatus::Proven);
    for (own, searched) in proof.specifications.iter().zip(&found.specifications) {
        let (least, most) = (own.least_db.unwrap(), own.most_db.unwrap());
        let worst = -searched.worst.as_ref().unwrap().margin_db;
        assert!(least - 1e-3 <= worst && worst <= most && most - least < 0.06, "{least} {worst} {most}");
    }
    proof
}

#[test]
fn enclosures_hold_for_coefficients_that_are_no_polynomials() {
    for (together, sample_time_s) in [(false, None), (true, None), (false, Some(0.05))] {
        let (family, compensation) = (family(together), around(sample_time_s));
        let proof = proven(&family, &compensation);
        let Family::Uncertain(own) = &family else { panic!("a box") };
        let state = &mut stream(31, u64::from(together));
        for _ in 0..2000 {
            let fractions: Vec<f64> = own.coordinates().iter().map(|_| uniform(state)).collect();
            let values = own.values(&fractions);
            let highest = compensation.highest_frequency_rad_per_s().min(30.0);
            let frequency = 0.02 * phea_dynamics::portable::pow(highest / 0.02, uniform(state));
            let plant = compensation.response_of(own.plant(), &values, frequency).unwrap();
            let law = compensation.response(frequency);
            let response = LoopResponse {
                plant: plant.plant,
                load_motion: plant.load_motion,
                controller: law.feedback,
                prefilter: law.prefilter,
                sensor: plant.sensor,
            };
            for (specification, own) in specifications().iter().zip(&proof.specifications) {
                let margin_db = specification.margin_db(&response, frequency).unwrap();
                assert!(-margin_db <= own.most_db.unwrap() + 1e-7, "{values:?} {frequency}");
            }
        }
    }
}

/// Boxes end where a choice switches: on either side of it the coefficients are smooth.
#[test]
fn a_step_within_the_box_is_divided_at_its_ends() {
    let proof = proven(&family_of(stepped, false), &around(None));
    let certificate = proof.certificate.unwrap();
    assert_eq!(check(&certificate), Ok(()));
    for end in [0.43, 0.49] {
        let ends = |one: &&Vec<ParameterSegment>| (one[2].high - end).abs() < 1e-12;
        assert!(certificate.plant.boxes.iter().any(|one| ends(&one)), "{end}");
    }
    // the boxes fill the family
    let volume = |one: &Vec<ParameterSegment>| one.iter().map(|one| one.high - one.low).product::<f64>();
    let filled: f64 = certificate.plant.boxes.iter().map(volume).sum();
    assert!((filled - 0.5 * 0.8).abs() < 1e-12, "{filled}");
    // and none of them contains an end of the step in its interior
    let straddles =
        |one: &Vec<ParameterSegment>, end: f64| one[2].low < end - 1e-12 && one[2].high > end + 1e-12;
    assert!(!certificate.plant.boxes.iter().any(|one| straddles(one, 0.43) || straddles(one, 0.49)));
}

/// A certificate of such a plant that claims more is rejected.
#[test]
fn a_model_of_another_plant_is_rejected() {
    let genuine = proven(&family(true), &around(None)).certificate.unwrap();
    assert_eq!(check(&genuine), Ok(()));
    assert!(genuine.plant.model_degree > 0 && genuine.plant.boxes[0].iter().any(|one| one.by_factors));
    let altered = |change: &dyn Fn(&mut Certificate)| {
        let mut other = genuine.clone();
        change(&mut other);
        check(&other).is_err()
    };
    // remainders that are too large, and no remainders
    assert!(altered(&|other| other.plant.model_degree = 1));
    assert!(altered(&|other| other.plant.model_degree = 0));
    assert!(altered(&|other| other.plant.model_degree = 100));
    // a wider box, or one of another shape
    assert!(altered(&|other| other.plant.boxes[0][0].low = 1.0));
    assert!(altered(&|other| other.plant.boxes[0][0].high *= 3.0));
    assert!(altered(&|other| other.plant.boxes[0][2].low = -1.0));
}
