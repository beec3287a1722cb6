//! Sampled loops against closed forms.
#![cfg(test)]

use std::f64::consts::PI;

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_dynamics::portable::{asin, exp, ln, log1p, sin};
use phea_dynamics::uncertain_plant::{
    PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant,
};
use phea_dynamics::watch::unwatched;
use phea_qft::closed_loop::Compensation;
use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
use phea_qft::stability::{
    Instability, Irresolution, MemberStability, StabilityStatus, family_stability, member_stability,
};
use phea_qft::verification::PlantPoint;

const SAMPLE: f64 = 1e-3;

fn found(elements: Vec<Element>, plant: (&[f64], &[f64]), delay_s: f64) -> MemberStability {
    let timing = Timing { sample_time_s: Some(SAMPLE), delay_s, ..Timing::default() };
    let feedback = Compensator::new(elements);
    let controller = Controller { feedback, timing, ..Controller::default() };
    let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let command = RationalCoefficients { numerator: plant.0.to_vec(), denominator: plant.1.to_vec() };
    let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None };
    member_stability(&compensation.member(plant).unwrap(), &compensation)
}

/// Plant k/s, held and sampled, is k T/(z - 1): one pole at 1 - k T.
#[test]
fn an_integrator_has_one_pole() {
    for gain_ratio in [1e-9, 1e-3, 0.3, 1.7, 2.1] {
        let found = found(vec![Element::Gain(gain_ratio / SAMPLE)], (&[1.0], &[1.0, 0.0]), 0.0);
        let expected = log1p(-gain_ratio.min(2.0 - gain_ratio)) / SAMPLE;
        assert!((found.largest_real_part.unwrap() / expected - 1.0).abs() < 1e-9, "{gain_ratio}");
        assert_eq!(found.status == StabilityStatus::Stable, gain_ratio < 2.0);
    }
}

/// System x(n + 1) = x(n) - k T x(n - d), stable for 0 < k T < 2 sin(pi/(4 d + 2)) (Levin and May
/// 1976): by poles for a few samples of delay, by turns for many.
#[test]
fn an_integrator_with_samples_of_delay() {
    for samples in [0_u32, 1, 3, 20, 40, 300] {
        let limit = 2.0 * sin(PI / f64::from(4 * samples + 2));
        for (gain_ratio, stable) in [(1.0 - 1e-6, true), (1.0 + 1e-6, false)] {
            let gain = vec![Element::Gain(gain_ratio * limit / SAMPLE)];
            let found = found(gain, (&[1.0], &[1.0, 0.0]), f64::from(samples) * SAMPLE);
            assert_eq!(found.status == StabilityStatus::Stable, stable, "{samples}: {found:?}");
            assert_eq!(found.largest_real_part.is_some(), samples < 24);
            if samples >= 24 && !stable {
                assert_eq!(found.status, StabilityStatus::Unstable(Instability::Poles { count: 2 }));
            }
        }
    }
}

/// Loop 1/(z - 1), which has a sixth of a turn of phase margin at w T = pi/3: one sample of delay,
/// which also brings k T = 1 to its limit.
#[test]
fn a_whole_sample_is_tolerated_exactly() {
    for samples in [0.0, 4.0, 40.0] {
        let limit = 2.0 * sin(PI / (4.0 * samples + 6.0));
        let found = found(vec![Element::Gain(limit / SAMPLE)], (&[1.0], &[1.0, 0.0]), samples * SAMPLE);
        let critical = found.critical_delay.unwrap();
        assert!((critical.delay_s / SAMPLE - 1.0).abs() < 1e-9, "{critical:?}");
        assert!((critical.frequency_rad_per_s * SAMPLE - PI / (2.0 * samples + 3.0)).abs() < 1e-12);
    }
}

/// Plant k/s with a delay of m samples, m < 1, closes to z^2 - (1 - k T (1 - m)) z + k T m: stable
/// until m = 1/(k T), for 1 < k T < 4/3. The family's margin is that of its largest gain, to the
/// last digits, although phase over frequency gives 0.66.
#[test]
fn a_fraction_of_a_sample_is_tolerated_exactly() {
    let gain = UncertainParameter { name: "k".into(), nominal: 0.6, minimum: 0.5, maximum: 1.25 };
    let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
        command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let plant = plant.unwrap();
    let coordinate =
        Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
    let members = vertices(&plant, std::slice::from_ref(&coordinate)).unwrap();
    for extent in [Extent::Box, Extent::Members] {
        let coordinates = vec![coordinate.clone()];
        let family = UncertainFamily::new(plant.clone(), coordinates, members.clone(), extent).unwrap();
        let family = Family::Uncertain(family);
        let timing = Timing { sample_time_s: Some(SAMPLE), ..Timing::default() };
        let feedback = Compensator::new(vec![Element::Gain(1.0 / SAMPLE)]);
        let controller = Controller { feedback, timing, ..Controller::default() };
        let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        let found = family_stability(&family, &compensation, &mut unwatched).unwrap();
        let margin = found.delay_margin.unwrap();
        assert_eq!(margin.plant, PlantPoint::Parameters(vec![1.25]));
        assert!((margin.delay_s / SAMPLE - 0.8).abs() < 1e-8, "{margin:?}");
    }
    let estimate =
        found(vec![Element::Gain(1.25 / SAMPLE)], (&[1.0], &[1.0, 0.0]), 0.0).critical_delay.unwrap();
    let half = asin(0.5 * 1.25);
    assert!((estimate.delay_s / SAMPLE - (std::f64::consts::FRAC_PI_2 - half) / (2.0 * half)).abs() < 1e-12);
}

/// Plant k/(s + a), sampled every second with a delay of m s, m < 1, closes to z^2 + c z + d:
/// stable until d is one. Phase over frequency is least where a is largest, and the tolerated delay
/// where a is zero.
///
/// ```text
/// d = k (e^(-a (1 - m)) - e^(-a))/a
/// ```
#[test]
fn the_plant_that_tolerates_least_need_not_have_the_least_estimate() {
    let gain = |a: f64| 1.95 + 0.178 * a * a;
    let tolerated = |a: f64| if a > 0.0 { 1.0 + ln(a / gain(a) + exp(-a)) / a } else { 1.0 / gain(a) };
    let pole = UncertainParameter { name: "a".into(), nominal: 1.6, minimum: 0.0, maximum: 1.6 };
    let plant = UncertainPlant::record(vec![pole], |p| PlantCoefficients {
        command: RationalCoefficients {
            numerator: vec![p[0] * p[0] * 0.178.into() + 1.95.into()],
            denominator: vec![1.0.into(), p[0]],
        },
        disturbance: None,
        dead_time_s: 0.0.into(),
        rate: None,
    });
    let plant = plant.unwrap();
    let coordinate =
        Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
    let members = vertices(&plant, std::slice::from_ref(&coordinate)).unwrap();
    for extent in [Extent::Members, Extent::Box] {
        let coordinates = vec![coordinate.clone()];
        let family = UncertainFamily::new(plant.clone(), coordinates, members.clone(), extent).unwrap();
        let timing = Timing { sample_time_s: Some(1.0), ..Timing::default() };
        let controller = Controller { timing, ..Controller::default() };
        let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
        let found = family_stability(&Family::Uncertain(family), &compensation, &mut unwatched).unwrap();
        let margin = found.delay_margin.unwrap();
        assert!((margin.delay_s - tolerated(0.0)).abs() < 1e-6, "{extent:?}: {margin:?}");
        assert!(tolerated(1.6) > 1.5 * margin.delay_s);
    }
}

/// An unstable mode of the controller cancelled by a zero of the controller also counts in a
/// sampled loop.
#[test]
fn nothing_is_cancelled() {
    let factor = num_complex::Complex64::new(1.5, 0.0);
    let hidden = TransferFunction::from_factors(1.0, vec![factor], vec![factor]).unwrap();
    let hidden = hidden.in_domain(TimeDomain::Discrete { sample_time_s: SAMPLE }).unwrap();
    for (delay, pole) in [(0.0, true), (0.1, false)] {
        let found = found(vec![Element::General(hidden.clone())], (&[1.0], &[1.0, 1.0]), delay);
        match found.status {
            StabilityStatus::Unstable(Instability::Pole { real_part }) if pole => {
                assert!((real_part - ln(1.5) / SAMPLE).abs() < 1e-9);
            }
            status => assert_eq!(status, StabilityStatus::Unstable(Instability::Poles { count: 1 })),
        }
    }
}

/// The slow poles of a sampled loop are those of the continuous one to the order of the sample
/// time, at any speed.
#[test]
fn slow_poles_lose_no_digit() {
    let integral = Element::ProportionalIntegral { proportional_gain: 1e-3, integral_gain: 1e-9 };
    let found = found(vec![integral], (&[1.0], &[1.0, 1.0]), 0.0);
    // s^2 + 1.001 s + 1e-9: the slow root, and half a sample of the hold times its square is
    // negligible
    let expected = -2e-9 / (1.001 + f64::sqrt(1.001 * 1.001 - 4e-9));
    assert!((found.largest_real_part.unwrap() / expected - 1.0).abs() < 1e-5);
}

/// A plant built for one loop is not valid in another.
#[test]
fn a_plant_of_another_time_is_not_resolved() {
    let continuous = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0)).unwrap();
    let command = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, 1.0] };
    let plant = PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None };
    let timing = Timing { sample_time_s: Some(SAMPLE), ..Timing::default() };
    let controller = Controller { timing, ..Controller::default() };
    let sampled = Compensation::new(&controller, TransferFunction::gain_only(1.0)).unwrap();
    let mismatch = StabilityStatus::NotResolved(Irresolution::Linear(LinearError::DomainMismatch));
    for (of, within) in [(&continuous, &sampled), (&sampled, &continuous)] {
        let member = of.member(plant.clone()).unwrap();
        assert_eq!(member_stability(&member, within).status, mismatch);
    }
}
