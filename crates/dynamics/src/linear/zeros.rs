//! Zeros of one channel of a state-space system.
//!
//! ```text
//! zeros: the s where the pencil  [ s I - A   -B ]  loses rank
//!                                [   C        D ]
//! ```
//!
//! Without feedthrough, the output y = C x = 0 ties one state to the others; that state is
//! eliminated and its input becomes the new feedthrough, until the feedthrough is not zero. Then
//! the zeros are the eigenvalues of A - B C/D, and are brought to full accuracy on the response
//! itself. How many zeros there are depends on which numbers count as zero, so the result is
//! compared with the response, and the result that agrees is returned.

mod elimination;

use num_complex::Complex64;

use super::eigenvalues::{eigenvalues_of_computed, index_of_smallest};
use super::refinement::{converge, symmetrise};
use super::structure::{Resolvent, product, widened};
use super::{LinearError, StateSpace, TransferFunction};
use crate::portable::{exp, ln, magnitude};

/// Roundings of the inputs that may make the result of a cancellation count as zero, in the order
/// of the attempts: many (matrices are often the result of a computation), a few, none. The first
/// attempt that agrees has the fewest zeros.
const ROUNDINGS: [f64; 4] = [1e4, 1e2, 4.0, 0.0];

/// Agreement of the factors with the response that ends the attempts.
const AGREEMENT: f64 = 1e-11;

/// Gain (leading coefficient) and zeros of a system with one input and one output, whose poles are
/// known.
pub(crate) fn of_channel(
    system: &StateSpace,
    poles: &[Complex64],
) -> Result<(f64, Vec<Complex64>), LinearError> {
    if is_zero_everywhere(system, poles) {
        return Ok((0.0, Vec::new()));
    }
    let mut best: Option<(f64, Vec<Complex64>)> = None;
    let mut smallest = f64::INFINITY;
    for roundings in ROUNDINGS {
        let Some(factors) = attempt(system, poles, roundings)? else { continue };
        let deviation = deviation(system, &factors, poles);
        if best.is_none() || deviation < smallest {
            (best, smallest) = (Some(factors), deviation);
        }
        if smallest <= AGREEMENT {
            break;
        }
    }
    Ok(best.unwrap_or_default())
}

fn attempt(
    system: &StateSpace,
    poles: &[Complex64],
    roundings: f64,
) -> Result<Option<(f64, Vec<Complex64>)>, LinearError> {
    let (gain, Some(matrix)) = elimination::reduce(system, roundings) else { return Ok(None) };
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return Ok(None);
    }
    let mut zeros = eigenvalues_of_computed(&matrix)?;
    if vanishes_at_origin(system)
        && let Some(smallest) = index_of_smallest(&zeros)
    {
        zeros[smallest] = Complex64::new(0.0, 0.0);
    }
    converge(&mut zeros, 60, |s| newton_step(system, poles, s));
    let zeros = symmetrise(&zeros);
    let matched =
        matched_gain(system, &zeros, poles).filter(|matched| (matched - gain).abs() > 1e-13 * gain.abs());
    Ok(Some((matched.unwrap_or(gain), zeros)))
}

/// Response at s, and the sum of the magnitudes of its terms.
fn response(system: &StateSpace, s: Complex64) -> Option<(Complex64, f64)> {
    let states = Resolvent::new(system.a(), s).solve(&widened(system.b().iter()))?;
    let feedthrough = system.d()[(0, 0)];
    let parts = system.c().iter().zip(&states).map(|(c, x)| c.abs() * magnitude(x.value()));
    let size = feedthrough.abs() + parts.sum::<f64>();
    Some((product(system.c().iter(), &states, feedthrough), size))
}

/// Points off the axes at the magnitudes of the poles.
fn test_points(poles: &[Complex64]) -> Vec<Complex64> {
    let sizes = poles.iter().map(|pole| magnitude(*pole)).map(|size| if size > 0.0 { size } else { 1.0 });
    let mut points: Vec<Complex64> = sizes.map(|size| Complex64::new(0.3 * size, 1.1 * size)).collect();
    if points.is_empty() {
        points.push(Complex64::new(0.3, 1.1));
    }
    points
}

/// True if the response is nowhere larger than the rounding of its terms.
fn is_zero_everywhere(system: &StateSpace, poles: &[Complex64]) -> bool {
    test_points(poles).into_iter().all(|s| {
        response(system, s).is_none_or(|(value, size)| magnitude(value) <= 16.0 * f64::EPSILON * size)
    })
}

/// Largest relative difference between factors and response.
fn deviation(system: &StateSpace, factors: &(f64, Vec<Complex64>), poles: &[Complex64]) -> f64 {
    let (gain, zeros) = factors;
    let candidate = TransferFunction::assembled(*gain, zeros.clone(), poles.to_vec(), system.domain());
    let at = |s: Complex64| {
        let (value, _) = response(system, s)?;
        Some(magnitude(candidate.evaluate_rational(s) - value) / magnitude(value))
    };
    test_points(poles).into_iter().filter_map(at).fold(0.0, f64::max)
}

/// Gain that makes the factors agree with the response at a point of the real axis among the poles.
/// (The leading coefficient itself is only as accurate as the terms above it that were neglected as
/// zero.)
fn matched_gain(system: &StateSpace, zeros: &[Complex64], poles: &[Complex64]) -> Option<f64> {
    let logarithms = || poles.iter().map(|root| magnitude(*root)).filter(|size| *size > 0.0).map(ln);
    let centre = exp(logarithms().sum::<f64>() / logarithms().count().max(1) as f64);
    let clearance = |point: &f64| {
        let roots = zeros.iter().chain(poles);
        roots.map(|root| magnitude(root - point)).fold(f64::INFINITY, f64::min) / point
    };
    let candidates = [1.0, 0.77, 1.3, 0.6, 1.7].map(|factor| factor * centre);
    let point = candidates.into_iter().max_by(|a, b| clearance(a).total_cmp(&clearance(b)))?;
    let s = Complex64::new(point, 0.0);
    let (response, _) = response(system, s)?;
    let shape = TransferFunction::assembled(1.0, zeros.to_vec(), poles.to_vec(), system.domain());
    let gain = response.re / shape.evaluate_rational(s).re;
    (gain.is_finite() && gain != 0.0).then_some(gain)
}

/// True if the response at s = 0 is no larger than the rounding of its terms.
fn vanishes_at_origin(system: &StateSpace) -> bool {
    let at_origin = response(system, Complex64::new(0.0, 0.0));
    at_origin.is_some_and(|(value, size)| magnitude(value) <= 16.0 * f64::EPSILON * size)
}

/// Newton step for the numerator f of the response g; `None` at a pole that cancels.
///
/// ```text
/// f/f',     f = g(s) prod (s - p)
/// ```
fn newton_step(system: &StateSpace, poles: &[Complex64], s: Complex64) -> Option<Complex64> {
    if poles.iter().any(|pole| magnitude(pole - s) <= 1e-6 * magnitude(s)) {
        return None;
    }
    // g = C x + D with (s I - A) x = B, and g' = -C x' with (s I - A) x' = x
    let resolvent = Resolvent::new(system.a(), s);
    let states = resolvent.solve(&widened(system.b().iter()))?;
    let slopes = resolvent.solve(&states)?;
    let response = product(system.c().iter(), &states, system.d()[(0, 0)]);
    let slope = -product(system.c().iter(), &slopes, 0.0);
    if response == Complex64::new(0.0, 0.0) {
        return Some(response);
    }
    let poles: Complex64 = poles.iter().map(|pole| (s - pole).inv()).sum();
    let step = (slope / response + poles).inv();
    step.is_finite().then_some(step)
}
