//! The two limits of tracking against each other.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::portable::{log10, magnitude};
use phea_qft::specification::{LimitOrder, TimeDomainError, tracking_spread};

const EVERYWHERE: [f64; 2] = [0.0, f64::INFINITY];

fn function(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

fn spread_db(lower: &TransferFunction, upper: &TransferFunction, frequency: f64) -> f64 {
    20.0 * log10(magnitude(upper.at_frequency(frequency)) / magnitude(lower.at_frequency(frequency)))
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn the_printed_limits_part_steadily() {
    let upper = function(&[2116.0 / 75.0, 2116.0], &[1.0, 73.6, 2116.0]);
    let lower = function(&[20_000.0], &[1.0, 90.0, 2400.0, 20_000.0]);
    for (frequency, stated) in
        [(1.0, 0.02304629), (10.0, 2.06218249), (50.0, 16.9603930), (150.0, 31.3526350)]
    {
        let spread = tracking_spread(&lower, &upper, [0.0, frequency]).unwrap();
        assert!((spread.at_end_db - stated).abs() < 1e-7, "{spread:?}");
        assert_eq!(spread.grows_from_rad_per_s, Some(0.0));
        assert!(matches!(spread.order, LimitOrder::Kept { least_db, .. } if least_db.abs() < 1e-12));
    }
    let spread = tracking_spread(&lower, &upper, EVERYWHERE).unwrap();
    assert_eq!((spread.at_end_db, spread.grows_from_rad_per_s), (f64::INFINITY, Some(0.0)));
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn limits_that_cross_say_where_and_how_far() {
    let upper = function(&[100.0], &[1.0, 8.0, 100.0]);
    let lower = function(&[900.0], &[1.0, 60.0, 900.0]);
    match tracking_spread(&lower, &upper, [0.0, 500.0]).unwrap().order {
        LimitOrder::Crossed { from_rad_per_s, excess_db, frequency_rad_per_s } => {
            assert!((from_rad_per_s - 12.65701387).abs() < 1e-8, "{from_rad_per_s}");
            assert!((excess_db - 19.05127463).abs() < 1e-8, "{excess_db}");
            assert_eq!(frequency_rad_per_s, 500.0);
        }
        kept => panic!("{kept:?}"),
    }
    // up to infinity the crossing is the same, and the limits end at the ratio of their high-frequency gains
    let spread = tracking_spread(&lower, &upper, EVERYWHERE).unwrap();
    assert!(matches!(spread.order, LimitOrder::Crossed { from_rad_per_s, frequency_rad_per_s, .. }
        if (from_rad_per_s - 12.65701387).abs() < 1e-8 && frequency_rad_per_s == f64::INFINITY));
    assert!((spread.at_end_db + 20.0 * log10(9.0)).abs() < 1e-12);
    assert_eq!(spread.grows_from_rad_per_s, None);
    // where they are not yet crossed the limits are sound
    assert!(matches!(tracking_spread(&lower, &upper, [0.0, 12.0]).unwrap().order, LimitOrder::Kept { .. }));
    // crossed from the first frequency on
    let swapped = tracking_spread(&upper, &lower, [1.0, 10.0]).unwrap().order;
    assert!(matches!(swapped, LimitOrder::Crossed { from_rad_per_s: 1.0, .. }), "{swapped:?}");
}

#[test]
fn extremes_are_those_of_a_dense_scan() {
    let mut seed = 11_u64;
    let mut between = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let (mut crossed, mut falling) = (0, 0);
    for _ in 0..60 {
        let (fast, slow) = (between(8.0, 40.0), between(4.0, 25.0));
        let (ratio, zero, pole) = (between(0.2, 1.0), between(20.0, 200.0), between(20.0, 200.0));
        let upper = function(&[fast * fast / zero, fast * fast], &[1.0, 2.0 * ratio * fast, fast * fast]);
        let pole = Complex64::new(-pole, 0.0);
        let lag = TransferFunction::from_factors(-pole.re, vec![], vec![pole]).unwrap();
        let lower = function(&[slow * slow], &[1.0, 2.0 * slow, slow * slow]).series(&lag).unwrap();
        let band = [0.5, 60.0];
        let spread = tracking_spread(&lower, &upper, band).unwrap();
        let grid = logarithmic_grid(band[0], band[1], 20_001).unwrap();
        let scan: Vec<f64> = grid.iter().map(|w| spread_db(&lower, &upper, *w)).collect();
        let least = scan.iter().copied().fold(f64::INFINITY, f64::min);
        match spread.order {
            LimitOrder::Kept { least_db, .. } => assert!((least_db - least).abs() < 1e-6),
            LimitOrder::Crossed { excess_db, from_rad_per_s, .. } => {
                crossed += 1;
                assert!((excess_db + least).abs() < 1e-6, "{excess_db} {least}");
                let first = scan.iter().position(|value| *value < 0.0).unwrap();
                assert!(from_rad_per_s <= grid[first] * (1.0 + 1e-12), "{from_rad_per_s} {}", grid[first]);
                assert!(first == 0 || from_rad_per_s >= grid[first - 1]);
            }
        }
        // the last place where the scan falls
        let falls = (1..grid.len()).rev().find(|index| scan[*index] < scan[index - 1] - 1e-12);
        match (spread.grows_from_rad_per_s, falls) {
            (Some(from), None) => assert_eq!(from, band[0]),
            (Some(from), Some(index)) => assert!((from / grid[index] - 1.0).abs() < 1e-3, "{from}"),
            (None, falls) => {
                falling += 1;
                assert_eq!(falls, Some(grid.len() - 1));
            }
        }
    }
    assert!(crossed > 5 && crossed < 55 && falling > 0, "{crossed} {falling}");
}

#[test]
fn equal_limits_are_no_crossing_and_sampled_ones_are_refused() {
    let lag = function(&[3.0], &[1.0, 3.0]);
    let spread = tracking_spread(&lag, &lag, EVERYWHERE).unwrap();
    assert_eq!((spread.at_end_db, spread.grows_from_rad_per_s), (0.0, Some(0.0)));
    assert!(matches!(spread.order, LimitOrder::Kept { least_db: 0.0, .. }));
    let sampled = lag.clone().in_domain(TimeDomain::Discrete { sample_time_s: 0.1 }).unwrap();
    assert_eq!(tracking_spread(&lag, &sampled, EVERYWHERE), Err(TimeDomainError::NotContinuous));
    for band in [[-1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0]] {
        assert!(matches!(tracking_spread(&lag, &lag, band), Err(TimeDomainError::OutOfRange { .. })));
    }
}
