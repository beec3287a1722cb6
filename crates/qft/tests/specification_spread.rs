//! The two tracking limits against each other.
#![cfg(test)]

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::{Polynomial, TimeDomain, TransferFunction};
use phea_dynamics::portable::log10;
use phea_qft::specification::{
    Limit, LimitOrder, LimitTable, TimeDomainError, TrackingSpread, tracking_spread,
};

const EVERYWHERE: [f64; 2] = [0.0, f64::INFINITY];

fn function(numerator: &[f64], denominator: &[f64]) -> Limit {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    let function = TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator));
    Limit::Rational(function.unwrap())
}

fn table(points: &[(f64, f64)]) -> Limit {
    Limit::Table(LimitTable::new(points.to_vec()).unwrap())
}

fn spread_db(lower: &Limit, upper: &Limit, frequency: f64) -> f64 {
    20.0 * log10(upper.magnitude(frequency).unwrap() / lower.magnitude(frequency).unwrap())
}

/// Reproducible numbers.
struct Numbers(u64);

impl Numbers {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// The spread over a band equals that of a dense scan.
fn as_scanned(lower: &Limit, upper: &Limit, band: [f64; 2]) -> TrackingSpread {
    let spread = tracking_spread(lower, upper, band).unwrap();
    let grid = logarithmic_grid(band[0], band[1], 20_001).unwrap();
    let scan: Vec<f64> = grid.iter().map(|w| spread_db(lower, upper, *w)).collect();
    let least = scan.iter().copied().fold(f64::INFINITY, f64::min);
    match spread.order {
        LimitOrder::Satisfied { least_db, .. } => {
            assert!((least_db - least).abs() < 1e-3 && least_db <= least + 1e-9)
        }
        LimitOrder::Crossed { excess_db, from_rad_per_s, .. } => {
            assert!((excess_db + least).abs() < 1e-3, "{excess_db} {least}");
            let first = scan.iter().position(|value| *value < 0.0).unwrap();
            assert!(from_rad_per_s <= grid[first] * (1.0 + 1e-12), "{from_rad_per_s} {}", grid[first]);
            assert!(first == 0 || from_rad_per_s >= grid[first - 1]);
        }
    }
    // the last point where the scan falls
    let falls = (1..grid.len()).rev().find(|index| scan[*index] < scan[index - 1] - 1e-12);
    match (spread.grows_from_rad_per_s, falls) {
        (Some(from), None) => assert_eq!(from, band[0]),
        (Some(from), Some(index)) => assert!((from / grid[index] - 1.0).abs() < 1e-3, "{from}"),
        (None, falls) => assert_eq!(falls, Some(grid.len() - 1)),
    }
    spread
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn the_spread_of_the_printed_limits_increases_steadily() {
    let upper = function(&[2116.0 / 75.0, 2116.0], &[1.0, 73.6, 2116.0]);
    let lower = function(&[20_000.0], &[1.0, 90.0, 2400.0, 20_000.0]);
    for (frequency, stated) in
        [(1.0, 0.02304629), (10.0, 2.06218249), (50.0, 16.9603930), (150.0, 31.3526350)]
    {
        let spread = tracking_spread(&lower, &upper, [0.0, frequency]).unwrap();
        assert!((spread.at_end_db - stated).abs() < 1e-7, "{spread:?}");
        assert_eq!(spread.grows_from_rad_per_s, Some(0.0));
        assert!(matches!(spread.order, LimitOrder::Satisfied { least_db, .. } if least_db.abs() < 1e-12));
    }
    let spread = tracking_spread(&lower, &upper, EVERYWHERE).unwrap();
    assert_eq!((spread.at_end_db, spread.grows_from_rad_per_s), (f64::INFINITY, Some(0.0)));
}

// ORIGIN: recomputed by comparisons/recompute_specifications.py
#[test]
fn crossing_limits_are_reported_with_place_and_distance() {
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
    // up to infinity the crossing is unchanged, and the limits end at the ratio of their
    // high-frequency gains
    let spread = tracking_spread(&lower, &upper, EVERYWHERE).unwrap();
    assert!(matches!(spread.order, LimitOrder::Crossed { from_rad_per_s, frequency_rad_per_s, .. }
        if (from_rad_per_s - 12.65701387).abs() < 1e-8 && frequency_rad_per_s == f64::INFINITY));
    assert!((spread.at_end_db + 20.0 * log10(9.0)).abs() < 1e-12);
    assert_eq!(spread.grows_from_rad_per_s, None);
    // before they cross, the limits are consistent
    assert!(matches!(
        tracking_spread(&lower, &upper, [0.0, 12.0]).unwrap().order,
        LimitOrder::Satisfied { .. }
    ));
    // crossed from the first frequency on
    let swapped = tracking_spread(&upper, &lower, [1.0, 10.0]).unwrap().order;
    assert!(matches!(swapped, LimitOrder::Crossed { from_rad_per_s: 1.0, .. }), "{swapped:?}");
}

#[test]
fn extremes_are_those_of_a_dense_scan() {
    let mut numbers = Numbers(11);
    let (mut crossed, mut falling) = (0, 0);
    for _ in 0..40 {
        let (fast, slow) = (numbers.between(8.0, 40.0), numbers.between(4.0, 25.0));
        let (ratio, zero, pole) =
            (numbers.between(0.2, 1.0), numbers.between(20.0, 200.0), numbers.between(20.0, 200.0));
        let upper = function(&[fast * fast / zero, fast * fast], &[1.0, 2.0 * ratio * fast, fast * fast]);
        let lag = Polynomial::new(vec![1.0, pole]);
        let cubic = Polynomial::new(vec![1.0, 2.0 * slow, slow * slow]).product(&lag);
        let lower = function(&[slow * slow * pole], cubic.coefficients());
        let spread = as_scanned(&lower, &upper, [0.5, 60.0]);
        crossed += usize::from(matches!(spread.order, LimitOrder::Crossed { .. }));
        falling += usize::from(spread.grows_from_rad_per_s.is_none());
    }
    assert!(crossed > 3 && crossed < 37 && falling > 0, "{crossed} {falling}");
}

#[test]
fn tables_and_constants_are_compared_between_their_points_too() {
    let mut numbers = Numbers(5);
    let mut crossed = 0;
    for _ in 0..30 {
        let mut levels = |center: f64| {
            let points = [0.5, 3.0, 9.0, 20.0, 60.0].map(|w| (w, center * numbers.between(0.5, 2.0)));
            table(&points)
        };
        let [low, high] = [levels(0.3), levels(1.0)];
        let resonance = function(&[100.0], &[1.0, 6.0, 100.0]);
        for (lower, upper) in [(&low, &high), (&low, &resonance), (&Limit::Constant(0.4), &high)] {
            let spread = as_scanned(lower, upper, [0.5, 60.0]);
            crossed += usize::from(matches!(spread.order, LimitOrder::Crossed { .. }));
        }
    }
    assert!(crossed > 10 && crossed < 80, "{crossed}");
    // the resonance 100/(s^2 + 6 s + 100) over a limit that falls as 1/w^2: the turning point is
    // between the points of the table
    let falling = table(&[(1.0, 100.0), (1000.0, 1e-4)]);
    let spread = tracking_spread(&falling, &function(&[100.0], &[1.0, 6.0, 100.0]), [0.0, 1e9]).unwrap();
    assert_eq!(spread.grows_from_rad_per_s, None);
    // w^4/((100 - w^2)^2 + 36 w^2) rises to its only turning point at w^2 = 10^4/82, w = 11.04, and
    // falls
    let up_to =
        |end: f64| tracking_spread(&falling, &function(&[100.0], &[1.0, 6.0, 100.0]), [0.0, end]).unwrap();
    assert_eq!(up_to(11.1).grows_from_rad_per_s, None);
    let short = up_to(11.0);
    assert_eq!(short.grows_from_rad_per_s, Some(1.0));
    assert!(matches!(short.order, LimitOrder::Crossed { from_rad_per_s: 1.0, .. }));
    // there is no limit beyond a table
    let apart = [table(&[(1.0, 1.0), (2.0, 1.0)]), table(&[(3.0, 1.0), (4.0, 1.0)])];
    assert_eq!(tracking_spread(&apart[0], &apart[1], EVERYWHERE), Err(TimeDomainError::NeverTogether));
}

#[test]
fn equal_limits_are_no_crossing_and_sampled_ones_are_refused() {
    let lag = function(&[3.0], &[1.0, 3.0]);
    let spread = tracking_spread(&lag, &lag, EVERYWHERE).unwrap();
    assert_eq!((spread.at_end_db, spread.grows_from_rad_per_s), (0.0, Some(0.0)));
    assert!(matches!(spread.order, LimitOrder::Satisfied { least_db: 0.0, .. }));
    let domain = TimeDomain::Discrete { sample_time_s: 0.1 };
    let sampled = Limit::Rational(TransferFunction::gain_only(1.0).in_domain(domain).unwrap());
    assert_eq!(tracking_spread(&lag, &sampled, EVERYWHERE), Err(TimeDomainError::NotContinuous));
    for band in [[-1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0]] {
        assert!(matches!(tracking_spread(&lag, &lag, band), Err(TimeDomainError::OutOfRange { .. })));
    }
}
