//! Plants with poles far faster and slower than a sample, held and sampled, at points of the unit
//! circle.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::linear::{Discretization, HeldModes, LinearError, TransferFunction};
use phea_dynamics::portable::{cos, magnitude, pow, sin};
use phea_dynamics::random::uniform;

const fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

/// Point e^(j angle).
fn on_circle(angle: f64) -> Complex64 {
    c(cos(angle), sin(angle))
}

const FAST: [Complex64; 2] = [c(-6800.0, 0.0), c(-3740.0, 0.0)];

/// gain, zeros, poles, sample time, dead time, and the response where w T is 0.01, 1 and 3.
type Case = (f64, &'static [Complex64], &'static [Complex64], f64, f64, [Complex64; 3]);

// ORIGIN: recomputed by comparisons/recompute_sampling.py (mpmath, sixty digits)
const CASES: [Case; 5] = [
    (
        6800.0 * 3740.0,
        &[],
        &FAST,
        0.01,
        0.0,
        [
            c(0.9999500004166653, -0.009999833334166666),
            c(0.5403023058681397, -0.8414709848078965),
            c(-0.9899924966004452, -0.14112000805986716),
        ],
    ),
    (
        6800.0 * 3740.0,
        &[],
        &FAST,
        0.01,
        0.0099,
        [
            c(0.999813560246487, -0.01909516246829957),
            c(-0.3297211696557474, -0.9031685641143254),
            c(0.7839516968530946, 0.24141550429632694),
        ],
    ),
    (
        300.0,
        &[c(-0.5, 0.0)],
        &[c(-0.05, 0.0), c(-2.0, 0.0), c(-500.0, 0.0)],
        1.0,
        0.0,
        [
            c(2.8907550121225363, -0.5486864568481838),
            c(0.02908856804241749, -0.32190480438637015),
            c(-0.24329391316062468, -0.026841391702566716),
        ],
    ),
    (
        1e8,
        &[c(-0.01, 0.7), c(-0.01, -0.7)],
        &[c(-0.02, 0.5), c(-0.02, -0.5), c(-3.0, 90.0), c(-3.0, -90.0), c(-400.0, 0.0), c(-450.0, 0.0)],
        1.0,
        0.25,
        [
            c(0.13411397391727242, -0.0013090899420009506),
            c(0.025202746821190718, -0.042163400198356314),
            c(-0.07310569660807276, -0.010946461375667037),
        ],
    ),
    (
        50.0,
        &[],
        &[c(2.0, 0.0), c(-700.0, 0.0)],
        0.5,
        0.1,
        [
            c(-0.03571212206277784, -0.00010409797073056477),
            c(-0.02355820519296039, -0.0022153021048901913),
            c(-0.006999224282565537, 0.00041195446818175955),
        ],
    ),
];

#[test]
fn modes_that_decay_within_a_sample_leave_the_rest_exact() {
    for (gain, zeros, poles, sample_time_s, dead_time_s, truths) in CASES {
        let plant = TransferFunction::from_factors(gain, zeros.to_vec(), poles.to_vec()).unwrap();
        let plant = plant.with_dead_time(dead_time_s).unwrap();
        let sampled = plant.discretized(sample_time_s, Discretization::ZeroOrderHold).unwrap();
        for (angle, truth) in [0.01, 1.0, 3.0].into_iter().zip(truths) {
            let found = sampled.at_frequency(angle / sample_time_s);
            assert!(magnitude(found - truth) < 1e-12 * magnitude(truth), "{found} is not {truth}");
        }
    }
}

/// A pole that grows by exp(1000) within a sample is reported before it is used.
#[test]
fn growth_beyond_the_range_of_numbers_is_refused() {
    let plant = TransferFunction::from_factors(1.0, vec![], vec![c(1e5, 0.0), c(0.0, 0.0)]).unwrap();
    let refused = plant.discretized(0.01, Discretization::ZeroOrderHold);
    assert!(matches!(refused, Err(LinearError::NotFinite { .. })), "{refused:?}");
}

/// Modes give the response of the sampled plant's factors, and the one computed with sixty digits.
#[test]
fn modes_give_the_response_of_the_sampled_plant() {
    for (gain, zeros, poles, sample_time_s, dead_time_s, truths) in CASES {
        let plant = TransferFunction::from_factors(gain, zeros.to_vec(), poles.to_vec()).unwrap();
        let plant = plant.with_dead_time(dead_time_s).unwrap();
        let sampled = plant.discretized(sample_time_s, Discretization::ZeroOrderHold).unwrap();
        let modes = HeldModes::of(&plant, sample_time_s).unwrap();
        for (angle, truth) in [0.01, 1.0, 3.0].into_iter().zip(truths) {
            let found = modes.at(angle / sample_time_s).unwrap();
            assert!(magnitude(found.response - truth) < 1e-13 * magnitude(truth), "{found:?} is not {truth}");
            let z = on_circle(angle);
            let denominator: Complex64 = sampled.poles().iter().map(|pole| z - pole).product();
            assert!(magnitude(found.denominator - denominator) < 1e-14 * magnitude(denominator));
        }
    }
}

/// Random plants of up to ten poles, integrators, feedthrough, resonances and any dead time : the
/// modes agree with the factors everywhere on the circle, or are rejected.
#[test]
fn modes_agree_with_the_factors_of_random_plants() {
    let mut state = 7;
    let mut within = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let (mut compared, mut refused, mut worst) = (0, 0, 0.0_f64);
    for case in 0..300 {
        let mut roots = |count: usize, origin: bool| {
            let mut roots = if origin { vec![c(0.0, 0.0)] } else { vec![] };
            while roots.len() < count {
                let size = within(0.05, 5000.0);
                if roots.len() + 1 < count && within(1.0, 3.0) < 2.0 {
                    let (real, imaginary) = (-size * within(0.003, 0.9), size);
                    roots.extend([c(real, imaginary), c(real, -imaginary)]);
                } else {
                    roots.push(c(-size, 0.0));
                }
            }
            roots
        };
        let poles = roots(1 + case % 10, case % 3 == 0);
        let zeros = roots((case / 10) % (poles.len() + 1), false);
        let zeros = zeros[..zeros.len().min(poles.len())].to_vec();
        let Ok(plant) = TransferFunction::from_factors(3.0, zeros, poles) else { continue };
        let sample_time_s = within(1e-4, 1e-2);
        let dead_time_s = if case % 4 == 0 { 0.0 } else { within(1e-5, 3e-2) };
        let plant = plant.with_dead_time(dead_time_s).unwrap();
        let Ok(sampled) = plant.discretized(sample_time_s, Discretization::ZeroOrderHold) else { continue };
        let Some(modes) = HeldModes::of(&plant, sample_time_s) else { continue };
        for step in 1..=40 {
            let frequency = std::f64::consts::PI / sample_time_s * pow(10.0, f64::from(step) / 10.0 - 4.0);
            let expected = sampled.at_frequency(frequency);
            let Some(found) = modes.at(frequency) else {
                refused += 1;
                continue;
            };
            // near a zero of the plant on the circle the factors themselves are rounded
            let nearest = sampled.zeros().iter().map(|zero| {
                let z = on_circle(frequency * sample_time_s);
                magnitude(z - zero)
            });
            if nearest.fold(1.0, f64::min) < 1e-6 {
                continue;
            }
            let error = magnitude(found.response - expected) / magnitude(expected);
            worst = worst.max(error);
            assert!(error < 1e-9, "case {case}: {found:?} is not {expected}, at {frequency}");
            compared += 1;
        }
    }
    assert!(compared > 8000 && refused < 300, "{compared} compared, {refused} refused, worst {worst}");
}

/// Equal poles have no separate modes.
#[test]
fn equal_poles_have_no_modes() {
    let plant = TransferFunction::from_factors(1.0, vec![], vec![c(-3.0, 0.0), c(-3.0, 0.0)]).unwrap();
    assert!(HeldModes::of(&plant, 0.1).is_none());
}
