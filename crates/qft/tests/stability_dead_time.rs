//! Loops with dead time against closed forms, and with rational approximations of it.
#![cfg(test)]

use std::f64::consts::{FRAC_PI_2, PI};

use phea_dynamics::controller::{Compensator, Controller, Element};
use phea_dynamics::frequency::margins;
use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::portable::{atan2, pow};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_qft::closed_loop::Compensation;
use phea_qft::stability::{Instability, Irresolution, MemberStability, StabilityStatus, member_stability};

fn function(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

fn loop_of(feedback: TransferFunction, sensor: TransferFunction) -> Compensation {
    let feedback = Compensator::new(vec![Element::General(feedback)]);
    Compensation::new(&Controller { feedback, ..Controller::default() }, sensor).unwrap()
}

fn found_in(
    compensation: &Compensation,
    numerator: &[f64],
    denominator: &[f64],
    delay: f64,
) -> MemberStability {
    let command = RationalCoefficients { numerator: numerator.to_vec(), denominator: denominator.to_vec() };
    let plant = PlantCoefficients { command, disturbance: None, dead_time_s: delay, rate: None };
    member_stability(&compensation.member(plant).unwrap(), compensation)
}

fn found(numerator: &[f64], denominator: &[f64], delay: f64) -> MemberStability {
    found_in(&loop_of(function(&[1.0], &[1.0]), function(&[1.0], &[1.0])), numerator, denominator, delay)
}

fn is_stable(found: &MemberStability) -> bool {
    match &found.status {
        StabilityStatus::Stable => true,
        StabilityStatus::Unstable(_) => false,
        StabilityStatus::NotResolved(reason) => panic!("{reason:?}"),
    }
}

/// Critical delay: a loop is stable just below it and unstable just above it; the margin from below
/// is the remainder.
fn check_critical_delay(numerator: &[f64], denominator: &[f64], critical: f64) {
    let prompt = found(numerator, denominator, 0.0).critical_delay.unwrap();
    assert!((prompt.delay_s / critical - 1.0).abs() < 1e-12, "{} against {critical}", prompt.delay_s);
    let below = found(numerator, denominator, critical * (1.0 - 1e-6));
    assert!(is_stable(&below));
    assert!((below.critical_delay.unwrap().delay_s / critical - 1e-6).abs() < 1e-12);
    assert!(!is_stable(&found(numerator, denominator, critical * (1.0 + 1e-6))));
}

/// Plant k e^(-s T)/s: two more poles become unstable each time k T passes pi/2 + 2 pi i.
#[test]
fn an_integrator_with_dead_time() {
    for (gain, delay) in [(1.0, 1.0), (1e-4, 30.0), (5e5, 1e-3), (7.8, 1.0), (7.9, 1.0), (50.0, 1.0)] {
        let turns = ((gain * delay - FRAC_PI_2) / (2.0 * PI)).floor() + 1.0;
        let expected = if turns > 0.0 {
            StabilityStatus::Unstable(Instability::Poles { count: 2 * turns as usize })
        } else {
            StabilityStatus::Stable
        };
        assert_eq!(found(&[gain], &[1.0, 0.0], delay).status, expected, "{gain} {delay}");
    }
    for gain in [1e-4, 1.0, 3e6] {
        check_critical_delay(&[gain], &[1.0, 0.0], FRAC_PI_2 / gain);
    }
}

/// Plant k e^(-s T)/(s + a) with k > |a|: |L| = 1 at w = sqrt(k^2 - a^2), where the lag is atan2(w,
/// a).
#[test]
fn a_first_order_plant_with_dead_time() {
    for (gain, pole) in [(2.0, 1.0), (1.001, 1.0), (100.0, 1e-3), (3.0, -1.0), (1.5, -1.4)] {
        let w = f64::sqrt(gain * gain - pole * pole);
        let lag = PI - atan2(w, pole);
        check_critical_delay(&[gain], &[1.0, pole], lag / w);
    }
    // |L| < 1 everywhere
    let weak = found(&[0.99], &[1.0, 1.0], 1e3);
    assert!(is_stable(&weak));
    assert_eq!(weak.critical_delay.unwrap().delay_s, f64::INFINITY);
    assert!(!is_stable(&found(&[0.99], &[1.0, -1.0], 0.1)));
}

/// Loop (s + 1) e^(-s T)/s^2: |L| = 1 where w^4 = w^2 + 1, so that w^2 is the golden ratio.
#[test]
fn two_integrators_with_dead_time() {
    let w = (0.5 * (1.0 + 5_f64.sqrt())).sqrt();
    check_critical_delay(&[1.0, 1.0], &[1.0, 0.0, 0.0], atan2(w, 1.0) / w);
}

/// A loop with as much gain at infinity as at middle frequencies: k (2 s + 1)/(s + 1).
#[test]
fn dead_time_around_a_gain_at_infinity() {
    let status = |gain: f64, delay| found(&[2.0 * gain, gain], &[1.0, 1.0], delay).status;
    assert_eq!(status(0.49, 1.0), StabilityStatus::Stable);
    assert_eq!(status(0.51, 1.0), StabilityStatus::Unstable(Instability::GainAtInfinity));
    assert_eq!(status(0.5, 1.0), StabilityStatus::NotResolved(Irresolution::GainAtInfinity));
    // the loop without dead time is stable, and tolerates none
    let prompt = found(&[4.0, 2.0], &[1.0, 1.0], 0.0);
    assert_eq!(
        (prompt.status.clone(), prompt.critical_delay.unwrap().delay_s),
        (StabilityStatus::Stable, 0.0)
    );
    // the gain at infinity can be the smallest distance of all
    let approach = found(&[0.8, 0.4], &[1.0, 1.0], 1.0).closest_approach.unwrap();
    assert!((approach.distance - 0.2).abs() < 1e-3);
}

/// A sensor acts like an equal factor of the plant, including its dead time.
#[test]
fn a_sensor_is_part_of_the_loop() {
    let sensor = function(&[3.0], &[1.0, 5.0]);
    let series = found(&[30.0], &[1.0, 7.0, 10.0], 0.2);
    let with_sensor = found_in(&loop_of(function(&[1.0], &[1.0]), sensor.clone()), &[10.0], &[1.0, 2.0], 0.2);
    let late = loop_of(function(&[1.0], &[1.0]), sensor.with_dead_time(0.2).unwrap());
    let late = found_in(&late, &[10.0], &[1.0, 2.0], 0.0);
    let expected = series.critical_delay.unwrap().delay_s;
    for found in [with_sensor, late] {
        assert!((found.critical_delay.unwrap().delay_s / expected - 1.0).abs() < 1e-12);
    }
}

/// Modes that the loop does not move are counted in every part of the loop.
#[test]
fn nothing_is_cancelled() {
    let one = || function(&[1.0], &[1.0]);
    let hidden = || function(&[1.0, -1.0], &[1.0, -1.0]);
    for compensation in [loop_of(hidden(), one()), loop_of(one(), hidden())] {
        let prompt = found_in(&compensation, &[1.0], &[1.0, 1.0], 0.0);
        assert_eq!(prompt.status, StabilityStatus::Unstable(Instability::Pole { real_part: 1.0 }));
        let late = found_in(&compensation, &[1.0], &[1.0, 1.0], 0.1);
        assert_eq!(late.status, StabilityStatus::Unstable(Instability::Poles { count: 1 }));
    }
    let plant = found(&[1.0, -1.0], &[1.0, 1.0, -2.0], 0.1);
    assert_eq!(plant.status, StabilityStatus::Unstable(Instability::Poles { count: 1 }));
    // a zero at the origin with an integrator leaves a pole there
    let integrator = loop_of(function(&[1.0], &[1.0, 0.0]), one());
    let washed_out = found_in(&integrator, &[1.0, 0.0], &[1.0, 1.0], 0.0);
    assert_eq!(washed_out.status, StabilityStatus::Unstable(Instability::Pole { real_part: 0.0 }));
    let late = found_in(&integrator, &[1.0, 0.0], &[1.0, 1.0], 0.1);
    assert!(matches!(late.status, StabilityStatus::NotResolved(Irresolution::NearBoundary { .. })));
}

#[test]
fn a_dead_time_that_cannot_be_is_refused() {
    let around = loop_of(function(&[1.0], &[1.0]), function(&[1.0], &[1.0]));
    for dead_time_s in [-1.0, f64::NAN, f64::INFINITY] {
        let command = RationalCoefficients { numerator: vec![1.0], denominator: vec![1.0, 1.0] };
        let refused =
            around.member(PlantCoefficients { command, disturbance: None, dead_time_s, rate: None });
        assert!(matches!(refused, Err(LinearError::DeadTime { .. })), "{refused:?}");
    }
}

#[test]
fn a_loop_that_has_no_solution_is_not_resolved() {
    let status = found(&[-1.0, 1.0], &[1.0, 1.0], 0.0).status;
    assert!(matches!(status, StabilityStatus::NotResolved(Irresolution::Linear(_))), "{status:?}");
}

/// Closed-loop poles over nine decades, of which the slowest one decides.
#[test]
fn slow_poles_next_to_fast_ones() {
    let slow = [1e-3, 0.1, 1.0, 1e2, 1e4, 1e6];
    let expanded = slow.iter().fold(Polynomial::new(vec![1.0]), |product, root| {
        product.product(&Polynomial::new(vec![1.0, *root]))
    });
    let open = expanded.sum(&Polynomial::new(vec![-5e6]));
    let found = found(&[5e6], open.coefficients(), 0.0);
    assert_eq!(found.status, StabilityStatus::Stable);
    assert!((found.largest_real_part.unwrap() / -1e-3 - 1.0).abs() < 1e-12);
}

/// A lightly damped resonance, stable as long as its peak k/(2 zeta) stays below one, for any dead
/// time.
#[test]
fn a_sharp_resonance_is_not_stepped_over() {
    let damping = 1e-5;
    for delay in [0.0, 0.3, 2.0, 40.0] {
        let peak = 0.999_999;
        let within = found(&[peak * 2.0 * damping], &[1.0, 2.0 * damping, 1.0], delay);
        assert!(is_stable(&within));
    }
    // half a turn at the resonance: unstable from the peak on
    let delay = FRAC_PI_2;
    for (peak, stable) in [(0.9999, true), (1.0001, false)] {
        let found = found(&[peak * 2.0 * damping], &[1.0, 2.0 * damping, 1.0], delay);
        assert_eq!(is_stable(&found), stable);
    }
    // |1 + L| = 1 - peak there
    let half = found(&[damping], &[1.0, 2.0 * damping, 1.0], delay).closest_approach.unwrap();
    assert!((half.distance - 0.5).abs() < 1e-5 && (half.frequency_rad_per_s - 1.0).abs() < 1e-5);
}

/// The critical delay is that of the margins of a loop given by its factors.
#[test]
fn critical_delays_are_those_of_the_margins() {
    // ORIGIN: Knuth (1997), the constants of the random numbers
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut compared = 0;
    while compared < 60 {
        let decade = |fraction: f64| pow(10.0, 4.0 * fraction - 2.0);
        let (w, zeta) = (decade(random()), 0.02 + random());
        let resonance = Polynomial::new(vec![1.0, 2.0 * zeta * w, w * w]);
        let lag = Polynomial::new(vec![1.0, decade(random()), 0.0]);
        let denominator = resonance.product(&lag);
        let numerator = Polynomial::new(vec![1.0, decade(random())]).scaled(decade(random()) * w * w);
        let own = found(numerator.coefficients(), denominator.coefficients(), 0.0);
        let Some(critical) = own.critical_delay else { continue };
        let expected = margins(&TransferFunction::from_polynomials(&numerator, &denominator).unwrap());
        let expected = expected.delay_margin_s();
        assert!((critical.delay_s / expected - 1.0).abs() < 1e-9, "{} {expected}", critical.delay_s);
        assert!(is_stable(&found(numerator.coefficients(), denominator.coefficients(), 0.999 * expected)));
        assert!(!is_stable(&found(numerator.coefficients(), denominator.coefficients(), 1.001 * expected)));
        compared += 1;
    }
}

/// Padé approximants of order six for e^(-s T) have as many unstable poles, if all of them are slow
/// relative to 1/T.
#[test]
fn pade_approximants_have_as_many_unstable_poles() {
    let pade = |delay: f64| {
        let (mut up, mut down) = (vec![], vec![]);
        let (mut factor, mut sign) = (1.0, 1.0);
        for power in 0..=6 {
            up.insert(0, sign * factor);
            down.insert(0, factor);
            let k = f64::from(power);
            factor *= delay * (6.0 - k) / ((12.0 - k) * (k + 1.0));
            sign = -sign;
        }
        (Polynomial::new(up), Polynomial::new(down))
    };
    let plant = Polynomial::new(vec![1.0, 1.2, 25.0, 4.0, -3.0]);
    let mut counts = std::collections::BTreeSet::new();
    for gain in [2.0, 7.0, 20.0, 60.0] {
        for delay in [0.05, 0.2, 0.5] {
            let (up, down) = pade(delay);
            let numerator = Polynomial::new(vec![1.0, 0.5]).scaled(gain);
            let closed = plant.product(&down).sum(&numerator.product(&up));
            let expected = closed.roots().unwrap().iter().filter(|root| root.re > 0.0).count();
            let status = found(numerator.coefficients(), plant.coefficients(), delay).status;
            counts.insert(expected);
            match expected {
                0 => assert_eq!(status, StabilityStatus::Stable),
                count => assert_eq!(status, StabilityStatus::Unstable(Instability::Poles { count })),
            }
        }
    }
    assert_eq!(counts.into_iter().collect::<Vec<_>>(), [0, 1, 2]);
}
