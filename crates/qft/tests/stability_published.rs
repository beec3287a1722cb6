//! Stability of published families: the claims of their authors, and the truth.
#![cfg(test)]

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, grid};
use phea_qft::stability::{FamilyStability, family_stability};
use phea_qft::verification::{Evidence, PlantPoint, Verdict};

use crate::rig::force;

fn parameter(name: &str, minimum: f64, nominal: f64, maximum: f64) -> UncertainParameter {
    UncertainParameter { name: name.into(), nominal, minimum, maximum }
}

fn coordinate(index: usize, points: usize, spacing: Spacing) -> Coordinate {
    Coordinate { parameters: vec![index], opposed: vec![], spacing: vec![spacing], points }
}

fn family(plant: UncertainPlant, coordinates: Vec<Coordinate>) -> Family {
    let members = grid(&plant, &coordinates).unwrap();
    Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box).unwrap())
}

fn controller(numerator: &[f64], denominator: &[f64], delay_s: f64) -> Compensation {
    let function = TransferFunction::from_polynomials(
        &Polynomial::new(numerator.to_vec()),
        &Polynomial::new(denominator.to_vec()),
    );
    let feedback = Compensator::new(vec![Element::General(function.unwrap())]);
    let timing = Timing { delay_s, ..Timing::default() };
    let controller = Controller { feedback, timing, ..Controller::default() };
    Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn audited(family: &Family, compensation: &Compensation) -> FamilyStability {
    family_stability(family, compensation, &mut unwatched).unwrap()
}

fn without_load<S>(numerator: Vec<S>, denominator: Vec<S>, dead_time_s: S) -> PlantCoefficients<S> {
    PlantCoefficients {
        command: RationalCoefficients { numerator, denominator },
        disturbance: None,
        dead_time_s,
        rate: None,
    }
}

/// Plant k (s + a)/(s^2 - 2.5).
fn unstable_family() -> Family {
    let parameters = vec![parameter("k", 1.0, 1.0, 10.0), parameter("a", 0.1, 0.1, 1.0)];
    let plant = UncertainPlant::record(parameters, |p| {
        without_load(vec![p[0], p[0] * p[1]], vec![1.0.into(), 0.0.into(), (-2.5).into()], 0.0.into())
    });
    family(plant.unwrap(), vec![coordinate(0, 3, Spacing::Linear), coordinate(1, 3, Spacing::Linear)])
}

/// Published solution C = 5.18 for this family. The polynomial s^2 + C k s + C k a - 2.5 has a root
/// at (-C k + sqrt(C^2 k^2 - 4 C k a + 10))/2.
#[test]
fn a_published_design_for_an_unstable_plant_is_unstable() {
    let found = audited(&unstable_family(), &controller(&[5.18], &[1.0], 0.0));
    let gain: f64 = 5.18;
    let expected = 0.5 * (-gain + (gain * gain - 0.4 * gain + 10.0).sqrt());
    assert_eq!(found.finding.verdict, Verdict::Violated);
    assert!((found.finding.largest_real_part.unwrap() - expected).abs() < 1e-13);
    assert_eq!(found.finding.plant, PlantPoint::Parameters(vec![1.0, 0.1]));
    assert_eq!(found.delay_margin, None);
    for (gain, verdict) in [(24.99, Verdict::Violated), (25.01, Verdict::Met)] {
        assert_eq!(audited(&unstable_family(), &controller(&[gain], &[1.0], 0.0)).finding.verdict, verdict);
    }
}

/// Two masses and a spring, k/(s^2 (s^2 + 2 k)), with 0.032 (10 s + 1)/(4 s^2 + 2 s + 1).
#[test]
fn the_benchmark_of_two_masses_is_just_stable() {
    let plant = UncertainPlant::record(vec![parameter("k", 0.5, 1.0, 2.0)], |p| {
        let zero = || 0.0.into();
        let two_k = p[0] * 2.0.into();
        without_load(vec![p[0]], vec![1.0.into(), zero(), two_k, zero(), zero()], zero())
    });
    let family = family(plant.unwrap(), vec![coordinate(0, 7, Spacing::Linear)]);
    let found = audited(&family, &controller(&[0.32, 0.032], &[4.0, 2.0, 1.0], 0.0));
    assert_eq!((found.finding.verdict, found.finding.evidence), (Verdict::Met, Evidence::Search));
    // ORIGIN: paper, the largest real part recomputed on a dense grid, to its two digits
    assert!((found.finding.largest_real_part.unwrap() + 0.0051).abs() < 5e-5);
    assert!(found.delay_margin.unwrap().delay_s > 0.0);
}

/// The fifth-order model, thesis (6.7), with the ranges of Table 6.3.
fn thesis_family(points: [usize; 6]) -> Family {
    let parameters = vec![
        parameter("viscous_friction", 100.0, 100.0, 3e4),
        parameter("flow_gain", 3.23e-5, 5.4e-5, 5.61e-5),
        parameter("flow_pressure_coefficient", 6.42e-13, 6.42e-13, 7e-11),
        parameter("hydraulic_stiffness", 2.24e6, 2.24e6, 4.11e6),
        parameter("valve_natural_frequency", 879.0, 1099.0, 1319.0),
        parameter("valve_damping_ratio", 0.72, 0.9, 1.08),
    ];
    let plant = UncertainPlant::record(parameters, |p| fifth_order(p)).unwrap();
    let logarithmic = [true, false, true, false, false, false];
    let coordinates = points.iter().zip(logarithmic).enumerate().map(|(index, (&points, logarithmic))| {
        coordinate(index, points, if logarithmic { Spacing::Logarithmic } else { Spacing::Linear })
    });
    family(plant, coordinates.collect())
}

fn fifth_order<S: Scalar>(p: &[S]) -> PlantCoefficients<S> {
    let RationalCoefficients { numerator, denominator } = force(p);
    without_load(numerator, denominator, S::from(0.0))
}

#[test]
fn the_published_controller_is_stable_for_the_whole_of_its_table() {
    let found = audited(&thesis_family([3, 3, 5, 3, 3, 3]), &controller(&[0.001, 0.008], &[1.0, 0.0], 0.0));
    assert_eq!((found.finding.verdict, found.finding.evidence), (Verdict::Met, Evidence::Search));
    // ORIGIN: recomputed independently, a search of the peak of |L/(1+L)| over the box; because S +
    // T = 1, |S| is within one of it
    let (peak, frequency, stiffness) = (11.887, 1304.4, 3.71e6);
    assert!((found.finding.largest_real_part.unwrap() + 2.9).abs() < 0.05);
    let closest = found.finding.closest_approach.unwrap();
    assert!((1.0 / closest.distance - peak).abs() < 1.0, "{closest:?}");
    assert!((closest.frequency_rad_per_s / frequency - 1.0).abs() < 1e-3, "{closest:?}");
    let PlantPoint::Parameters(values) = closest.plant else { panic!("a plant of the box") };
    assert!((values[3] / stiffness - 1.0).abs() < 2e-3, "{values:?}");
}

/// The loop tolerates each of these delays, and the tolerance beyond them is the remainder of the
/// margin without delay.
#[test]
fn the_published_controller_tolerates_delays_up_to_its_margin() {
    let family = thesis_family([2, 2, 2, 3, 2, 2]);
    let with_delay = |delay_s| audited(&family, &controller(&[0.001, 0.008], &[1.0, 0.0], delay_s));
    let margin = with_delay(0.0).delay_margin.unwrap().delay_s;
    for delay_s in [0.0005, 0.001, 0.0015, 0.999 * margin] {
        let found = with_delay(delay_s);
        assert_eq!((found.finding.verdict, found.finding.largest_real_part), (Verdict::Met, None));
        assert!((found.delay_margin.unwrap().delay_s - (margin - delay_s)).abs() < 1e-12);
    }
    let beyond = with_delay(1.001 * margin);
    assert_eq!((beyond.finding.verdict, beyond.delay_margin), (Verdict::Violated, None));
}
