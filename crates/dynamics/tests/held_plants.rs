//! Plants whose poles spread far beyond a sample, held and sampled, at points of the unit circle.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::linear::{Discretization, LinearError, TransferFunction};
use phea_dynamics::portable::magnitude;

const fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
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
fn what_dies_within_a_sample_leaves_the_rest_exact() {
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

/// A pole that grows by exp(1000) within a sample is reported, as soon as it is met.
#[test]
fn growth_beyond_the_range_of_numbers_is_refused() {
    let plant = TransferFunction::from_factors(1.0, vec![], vec![c(1e5, 0.0), c(0.0, 0.0)]).unwrap();
    let refused = plant.discretized(0.01, Discretization::ZeroOrderHold);
    assert!(matches!(refused, Err(LinearError::NotFinite { .. })), "{refused:?}");
}
