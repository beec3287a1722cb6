//! Plants that a search evaluates temporarily.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, InnerFeedback, Timing};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, PlantMember, RateNumerators, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::{Compensation, MemberResponse, TrialPlant};
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, audit_specifications};

/// A mass on a spring, driven by a valve through an integrator of the oil, with the motion of its
/// load; the sensor has a mode and a dead time.
fn placed(timing: Timing, dead_time_s: f64) -> (Compensation, PlantCoefficients<f64>) {
    let valve = Polynomial::new(vec![1.0 / (628.0 * 628.0), 1.6 / 628.0, 1.0]);
    let mass = Polynomial::new(vec![1.0 / (384.0 * 384.0), 0.046 / 384.0, 1.0, 0.0]);
    let zeros = Polynomial::new(vec![1.0 / (245.0 * 245.0), 0.09 / 245.0, 1.0]);
    let denominator = valve.product(&mass).coefficients().to_vec();
    let command = RationalCoefficients {
        numerator: zeros.scaled(2.6e5).coefficients().to_vec(),
        denominator: denominator.clone(),
    };
    let disturbance = Some(RationalCoefficients { numerator: vec![4e6, 0.0], denominator });
    let plant = PlantCoefficients { command, disturbance, dead_time_s, rate: None };
    let sensor = TransferFunction::from_factors(4000.0, vec![], vec![Complex64::new(-4000.0, 0.0)]);
    let sensor = sensor.unwrap().with_dead_time(0.3 * dead_time_s).unwrap();
    let controller = Controller { timing, ..Controller::default() };
    (Compensation::new(&controller, sensor).unwrap(), plant)
}

/// Responses P and P H of the modes equal those of the whole member, for every delay.
#[test]
fn modes_respond_as_the_whole_member() {
    for (sample_time_s, delay_s) in [(1e-3, 0.0), (1e-3, 1e-3), (2e-3, 0.7e-3), (2e-4, 1e-3)] {
        let timing = Timing { sample_time_s: Some(sample_time_s), delay_s, ..Timing::default() };
        for dead_time_s in [0.0, 0.4e-3] {
            let (around, plant) = placed(timing, dead_time_s);
            let trial = around.trial(PlantMember::Rational(plant), None).unwrap();
            let TrialPlant::Held(held) = &trial else { panic!("its modes are apart") };
            let whole = trial.whole(&around).unwrap();
            for step in 0..=60 {
                let highest = std::f64::consts::PI / sample_time_s;
                let frequency = highest * portable::pow(10.0, f64::from(step) / 15.0 - 4.0);
                let found = held.at(frequency).unwrap();
                let MemberResponse { plant, sensor, .. } = whole.response(frequency).unwrap();
                let near = |found: Complex64, expected: Complex64| {
                    (found - expected).norm_sqr() < 1e-18 * expected.norm_sqr()
                };
                assert!(near(found.plant, plant), "P at {frequency}: {found:?}, {plant}");
                assert!(near(found.with_sensor, plant * sensor), "P H at {frequency}: {found:?}");
            }
        }
    }
}

/// Inner feedback closes its loop around the modes as around the whole member.
#[test]
fn modes_respond_as_the_whole_member_with_an_inner_signal_fed_back() {
    let inner_feedback =
        InnerFeedback { gain: 3e-4, high_pass_rad_per_s: Some(300.0), low_pass_rad_per_s: Some(2000.0) };
    for (sample_time_s, delay_s) in [(1e-3, 1e-3), (5e-4, 0.7e-3)] {
        let timing =
            Timing { sample_time_s: Some(sample_time_s), delay_s, inner_feedback, ..Timing::default() };
        let (around, plant) = placed(timing, 0.0);
        let signal = Polynomial::new(vec![1.0 / (150.0 * 150.0), 0.08 / 150.0, 1.0, 0.0]).scaled(1.3e4);
        let inner = [signal.coefficients().to_vec(), vec![2e3, 0.0]];
        let rate = RateNumerators { command: vec![0.0], disturbance: vec![0.0], inner: Some(inner) };
        let without_feedback =
            around.without_inner_paths().trial(PlantMember::Rational(plant.clone()), None).unwrap();
        let trial = around
            .trial(PlantMember::Rational(PlantCoefficients { rate: Some(rate), ..plant }), None)
            .unwrap();
        let (TrialPlant::Held(held), TrialPlant::Held(without_feedback)) = (&trial, &without_feedback) else {
            panic!("its modes are apart")
        };
        let whole = trial.whole(&around).unwrap();
        let mut change = 0.0_f64;
        for step in 0..=60 {
            let highest = std::f64::consts::PI / sample_time_s;
            let frequency = highest * portable::pow(10.0, f64::from(step) / 15.0 - 4.0);
            let found = held.at(frequency).unwrap();
            let MemberResponse { plant, sensor, .. } = whole.response(frequency).unwrap();
            for (found, expected) in [(found.plant, plant), (found.with_sensor, plant * sensor)] {
                let error = (found - expected).norm_sqr() / expected.norm_sqr();
                assert!(error < 1e-18, "{frequency}: {found}, {expected}");
            }
            change =
                change.max((found.plant / without_feedback.at(frequency).unwrap().plant - 1.0).norm_sqr());
        }
        assert!(change > 0.1, "what is fed back changes the response: {change}");
    }
}

/// Plants without distinct modes are whole members from the start.
#[test]
fn equal_poles_and_continuous_loops_are_whole() {
    let equal = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, 2.0, 1.0] };
    let plant = PlantCoefficients { command: equal, disturbance: None, dead_time_s: 0.0, rate: None };
    for sample_time_s in [Some(1e-3), None] {
        let (around, _) = placed(Timing { sample_time_s, ..Timing::default() }, 0.0);
        let trial = around.trial(PlantMember::Rational(plant.clone()), None).unwrap();
        assert!(matches!(trial, TrialPlant::Whole(_)), "{trial:?}");
    }
}

/// The searches of an audit sample only the plants at their ends as a whole: the others are
/// evaluated by their modes.
#[test]
fn a_search_tests_plants_without_sampling_them_as_a_whole() {
    let parameter =
        |name: &str| UncertainParameter { name: name.into(), nominal: 1.0, minimum: 0.5, maximum: 2.0 };
    let plant = UncertainPlant::record(vec![parameter("k"), parameter("m")], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0]],
            denominator: vec![p[1], 0.4.into(), p[0], 0.0.into()],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    })
    .unwrap();
    let along = |index| Coordinate {
        parameters: vec![index],
        opposed: vec![],
        spacing: vec![Spacing::Linear],
        points: 3,
    };
    let coordinates = vec![along(0), along(1)];
    let members = grid(&plant, &coordinates).unwrap();
    let family = UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap();
    let timing = Timing { sample_time_s: Some(0.1), ..Timing::default() };
    let feedback = Compensator::new(vec![Element::Gain(0.05)]);
    let controller = Controller { feedback, timing, ..Controller::default() };
    let problem = AuditProblem {
        family: &Family::Uncertain(family),
        compensation: &Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap(),
        specifications: &[Specification {
            requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1.5)),
            frequencies_rad_per_s: vec![0.1, 1.0],
            band_rad_per_s: [0.0, f64::INFINITY],
        }],
        tracking: TrackingJudgement::Magnitude,
        tolerance_db: TOLERANCE_DB,
    };
    let (_, work) = audit_specifications(&problem, &mut unwatched).unwrap();
    assert!(work.evaluated > 1000 && 5 * work.sampled < work.evaluated, "{work:?}");
}
