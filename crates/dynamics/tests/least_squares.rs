//! Least squares with known minima.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_dynamics::least_squares::{Ending, Linearised, Minimum, Settings, minimise};
use phea_dynamics::portable::exp;
use phea_dynamics::watch::Stopped;

fn searched(
    start: [f64; 2],
    bounds: [[f64; 2]; 2],
    settings: Settings,
    mut at: impl FnMut(f64, f64) -> ([f64; 2], [f64; 4]),
) -> Minimum {
    let mut evaluate = |x: &[f64]| -> Result<Option<Linearised>, Stopped> {
        let (residuals, jacobian) = at(x[0], x[1]);
        Ok(Some(Linearised { residuals: residuals.to_vec(), jacobian: jacobian.to_vec() }))
    };
    minimise(&start, &bounds, settings, &mut evaluate).unwrap()
}

/// A valley along y = e^x whose walls are 10^4 times as steep as its floor: straight steps leave it
/// at once and would need thousands of evaluations.
#[test]
fn a_curved_valley_is_followed_to_its_end() {
    let settings = Settings { robust_beyond: f64::INFINITY, maximum_evaluations: 500, ..Settings::default() };
    const STEEP: f64 = 1e4;
    let found = searched([1.0, exp(1.0)], [[-9.0, 9.0]; 2], settings, |x, y| {
        ([STEEP * (y - exp(x)), x + 4.0], [-STEEP * exp(x), STEEP, 1.0, 0.0])
    });
    assert_eq!(found.ending, Ending::Converged);
    let off = [found.variables[0] + 4.0, found.variables[1] - exp(-4.0)];
    assert!(off.iter().all(|one| one.abs() < 1e-6), "{:?}", found.variables);
}

/// The valley with a bound across it: the end is where the valley meets the bound.
#[test]
fn a_valley_that_meets_a_bound_ends_there() {
    let settings = Settings { robust_beyond: f64::INFINITY, maximum_evaluations: 500, ..Settings::default() };
    const STEEP: f64 = 1e3;
    let found = searched([1.0, exp(1.0)], [[-2.0, 9.0], [-9.0, 9.0]], settings, |x, y| {
        ([STEEP * (y - exp(x)), x + 4.0], [-STEEP * exp(x), STEEP, 1.0, 0.0])
    });
    assert_eq!((found.ending, found.variables[0]), (Ending::Converged, -2.0));
    assert!((found.variables[1] - exp(-2.0)).abs() < 1e-9, "{:?}", found.variables);
    // half of the square of 2, the distance that the bound adds
    assert!((found.cost - 2.0).abs() < 1e-9, "{}", found.cost);
}
