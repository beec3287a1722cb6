//! Roots of a polynomial with real coefficients, over any range of magnitudes.
//!
//! The iteration of Ehrlich (1967) and Aberth (1973) moves all roots at once and converges
//! cubically to simple ones. Its starting radii come from the Newton polygon of the coefficients
//! (Bini 1996), so that roots of very different magnitude start at their own magnitude; beyond the
//! unit circle the reversed polynomial is evaluated.

use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

use super::double_double::ComplexDoubleDouble;
pub(crate) use super::refinement::conjugate_pairs;
use super::refinement::{repelled_step, sort, symmetrise};
use super::{LinearError, LinearNumber, Polynomial};
use crate::order::sort_by_number;
use crate::portable::{self, magnitude};

const MAXIMUM_SWEEPS: usize = 300;
/// Sweeps from points that are expected to be near; after them the usual method is used.
const SWEEPS_FROM_NEAR: usize = 12;
/// Ratio of imaginary part to magnitude above which a pair is not a double root on the axis.
const FAR_FROM_AXIS: f64 = 0.5;

/// All roots, sorted, in exact conjugate pairs.
pub(crate) fn of_polynomial(polynomial: &Polynomial) -> Result<Vec<Complex64>, LinearError> {
    found(polynomial, |deflated| Ok(merge_multiple(deflated, iterate(deflated)?)))
}

/// Roots to working precision, with multiple roots slightly apart: for a polynomial with rounded
/// coefficients, whose roots are refined by other means.
pub(crate) fn guessed(polynomial: &Polynomial) -> Result<Vec<Complex64>, LinearError> {
    found(polynomial, |deflated| {
        let mut roots = starting_points(deflated.coefficients());
        let moved = sweep(&mut roots, |z| evaluate_locally(deflated, z));
        let degree = polynomial.degree();
        moved.map(|()| symmetrise(&on_the_axis(roots))).ok_or(LinearError::RootsNotConverged { degree })
    })
}

/// All roots, sorted; `find` returns the roots of the polynomial without roots at the origin, if
/// its degree is at least two.
fn found(
    polynomial: &Polynomial,
    find: impl FnOnce(&Polynomial) -> Result<Vec<Complex64>, LinearError>,
) -> Result<Vec<Complex64>, LinearError> {
    if polynomial.is_zero() {
        return Err(LinearError::ZeroPolynomial);
    }
    let coefficients = polynomial.coefficients();
    if coefficients.iter().any(|c| !c.is_finite()) {
        return Err(LinearError::NotFinite { what: LinearNumber::Coefficient });
    }
    let at_origin = coefficients.iter().rev().take_while(|&&c| c == 0.0).count();
    // a common factor, a power of two, changes no root and keeps products in range
    let largest = coefficients.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    let (_, exponent) = libm::frexp(largest);
    let scaled = coefficients[..coefficients.len() - at_origin].iter().map(|&c| libm::ldexp(c, -exponent));
    let deflated = Polynomial::new(scaled.collect());
    let mut roots = match *deflated.coefficients() {
        [_] => Vec::new(),
        [a, b] => vec![Complex64::new(-b / a, 0.0)],
        _ => find(&deflated)?,
    };
    if roots.iter().any(|root| !root.is_finite()) {
        return Err(LinearError::RootsNotConverged { degree: polynomial.degree() });
    }
    roots.extend(std::iter::repeat_n(Complex64::new(0.0, 0.0), at_origin));
    sort(&mut roots);
    Ok(roots)
}

/// Ehrlich-Aberth iteration from the Newton polygon to the level of rounding, then with residuals
/// in twice the working precision; the result is made symmetric.
fn iterate(polynomial: &Polynomial) -> Result<Vec<Complex64>, LinearError> {
    let mut roots = starting_points(polynomial.coefficients());
    sweep(&mut roots, |z| evaluate_locally(polynomial, z))
        .and_then(|()| sweep(&mut roots, |z| evaluate_widely(polynomial, z)))
        .map(|()| symmetrise(&on_the_axis(roots)))
        .ok_or(LinearError::RootsNotConverged { degree: polynomial.degree() })
}

/// All roots, sorted and in exact conjugate pairs, from points near them, such as the roots of a
/// polynomial with nearly the same coefficients; `None` if the iteration does not converge from
/// there.
///
/// A pair moves by its root in the upper half plane; the other one is its conjugate.
pub(crate) fn near(polynomial: &Polynomial, guesses: &[Complex64]) -> Option<Vec<Complex64>> {
    let coefficients = polynomial.coefficients();
    let at_origin = coefficients.iter().rev().take_while(|&&c| c == 0.0).count();
    let largest = coefficients.iter().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    let (_, exponent) = libm::frexp(largest);
    let kept = coefficients.get(..coefficients.len() - at_origin)?;
    let deflated = Polynomial::new(kept.iter().map(|&c| libm::ldexp(c, -exponent)).collect());
    let zero = Complex64::new(0.0, 0.0);
    let moving: Vec<Complex64> =
        guesses.iter().copied().filter(|root| root.im >= 0.0 && *root != zero).collect();
    let count: usize = moving.iter().map(|root| if root.im > 0.0 { 2 } else { 1 }).sum();
    if !largest.is_finite() || count != deflated.degree() || count == 0 {
        return None;
    }
    let mut upper = moving;
    settle(&mut upper, |z| evaluate_locally(&deflated, z))?;
    settle(&mut upper, |z| evaluate_widely(&deflated, z))?;
    let mut roots = vec![zero; at_origin];
    for root in on_the_axis(upper) {
        roots.push(root);
        roots.extend((root.im > 0.0).then(|| root.conj()));
    }
    sort(&mut roots);
    roots.iter().all(|root| root.is_finite()).then_some(roots)
}

/// Moves the roots of the closed upper half plane, and their mirror images with them, until each is
/// at the rounding level of its residual or stops moving; a real root stays real, and a pair must
/// stay one.
fn settle<F: Fn(Complex64) -> LocalValue>(upper: &mut [Complex64], evaluate: F) -> Option<()> {
    let mut done = vec![false; upper.len()];
    for _ in 0..SWEEPS_FROM_NEAR {
        for index in 0..upper.len() {
            if done[index] {
                continue;
            }
            let local = evaluate(upper[index]);
            if local.at_rounding_level {
                done[index] = true;
                continue;
            }
            let (root, newton) = (upper[index], local.newton_step?);
            let step = newton / (1.0 - newton * repulsion(upper, index));
            let next = root - step;
            let is_paired = root.im > 0.0;
            if !step.is_finite() || (is_paired && next.im <= 0.0) {
                return None;
            }
            upper[index] = if is_paired { next } else { Complex64::new(next.re, 0.0) };
            done[index] = magnitude(step) <= f64::EPSILON * magnitude(next);
        }
        if done.iter().all(|&flag| flag) {
            return Some(());
        }
    }
    None
}

/// Sum of 1/(z_i - z_j) over all other roots, mirror images included.
fn repulsion(upper: &[Complex64], index: usize) -> Complex64 {
    let root = upper[index];
    let mut sum = Complex64::new(0.0, 0.0);
    for (other, &position) in upper.iter().enumerate() {
        if other != index {
            sum += (root - position).inv();
        }
        if position.im > 0.0 {
            sum += (root - position.conj()).inv();
        }
    }
    sum
}

/// Moves all roots until each is at the rounding level of its residual or stops moving.
fn sweep<F: Fn(Complex64) -> LocalValue>(roots: &mut [Complex64], evaluate: F) -> Option<()> {
    let mut done = vec![false; roots.len()];
    for _ in 0..MAXIMUM_SWEEPS {
        for index in 0..roots.len() {
            if done[index] {
                continue;
            }
            let local = evaluate(roots[index]);
            if local.at_rounding_level {
                done[index] = true;
            } else if let Some(step) = repelled_step(roots, index, local.newton_step) {
                roots[index] -= step;
                done[index] = magnitude(step) <= f64::EPSILON * magnitude(roots[index]);
            } else {
                // a collision or a stationary point: step aside
                roots[index] *= Complex64::new(1.0 + 1e-3, 1e-3);
            }
        }
        if done.iter().all(|&flag| flag) {
            return Some(());
        }
    }
    None
}

/// Points on circles whose radii are the slopes of the upper convex hull of (power, ln
/// |coefficient|).
fn starting_points(coefficients: &[f64]) -> Vec<Complex64> {
    let degree = coefficients.len() - 1;
    // ascending powers
    let points: Vec<(f64, f64)> = coefficients
        .iter()
        .rev()
        .enumerate()
        .filter(|(_, c)| **c != 0.0)
        .map(|(power, c)| (power as f64, portable::ln(c.abs())))
        .collect();
    let mut hull: Vec<(f64, f64)> = Vec::new();
    for point in points {
        while let [.., a, b] = hull[..] {
            let turns_left = (b.1 - a.1) * (point.0 - a.0) <= (point.1 - a.1) * (b.0 - a.0);
            if !turns_left {
                break;
            }
            hull.pop();
        }
        hull.push(point);
    }
    let mut roots = Vec::with_capacity(degree);
    for (segment, pair) in hull.windows(2).enumerate() {
        let (low, high) = (pair[0], pair[1]);
        let count = high.0 - low.0;
        let radius = portable::exp((low.1 - high.1) / count);
        let offset = 0.7 + 2.0 * std::f64::consts::PI * segment as f64 / degree as f64;
        let mut k = 0.0;
        while k < count {
            let angle = 2.0 * std::f64::consts::PI * k / count + offset;
            roots.push(Complex64::new(radius * portable::cos(angle), radius * portable::sin(angle)));
            k += 1.0;
        }
    }
    roots
}

struct LocalValue {
    newton_step: Option<Complex64>,
    at_rounding_level: bool,
}

/// Ratio p/p' at z in working precision, and a flag: |p| is no more than its own rounding error.
fn evaluate_locally(polynomial: &Polynomial, z: Complex64) -> LocalValue {
    let coefficients = polynomial.coefficients();
    let degree = polynomial.degree() as f64;
    let outside = magnitude(z) > 1.0;
    let point = if outside { z.inv() } else { z };
    let radius = magnitude(point);
    let zero = Complex64::new(0.0, 0.0);
    let (mut value, mut slope, mut scale) = (zero, zero, 0.0);
    let mut absorb = |c: f64| {
        slope = slope * point + value;
        value = value * point + c;
        scale = scale * radius + c.abs();
    };
    if outside {
        coefficients.iter().rev().for_each(|&c| absorb(c));
    } else {
        coefficients.iter().for_each(|&c| absorb(c));
    }
    let at_rounding_level = magnitude(value) <= 4.0 * degree * f64::EPSILON * scale;
    // with w = 1/z and p(z) = z^n q(w):  p'/p = w (n - w q'/q)
    let newton_step =
        if outside { quotient(value * z, value * degree - point * slope) } else { quotient(value, slope) };
    LocalValue { newton_step, at_rounding_level }
}

/// Ratio p/p' at z with both in twice the working precision; partial sums that grow out of range
/// are scaled down together.
fn evaluate_widely(polynomial: &Polynomial, z: Complex64) -> LocalValue {
    Arch::new().dispatch(Widely { polynomial, z })
}

/// Evaluation in twice the working precision, compiled for the vector instructions of the
/// processor.
struct Widely<'a> {
    polynomial: &'a Polynomial,
    z: Complex64,
}

impl WithSimd for Widely<'_> {
    type Output = LocalValue;

    #[inline(always)]
    fn with_simd<D: Simd>(self, _: D) -> LocalValue {
        widely(self.polynomial, self.z)
    }
}

#[inline(always)]
fn widely(polynomial: &Polynomial, z: Complex64) -> LocalValue {
    const LIMIT: f64 = 1e30;
    let (point, radius) = (ComplexDoubleDouble::from(z), magnitude(z));
    let (mut value, mut slope) = (ComplexDoubleDouble::default(), ComplexDoubleDouble::default());
    let (mut scale, mut unit) = (0.0, 1.0);
    for &coefficient in polynomial.coefficients() {
        if scale > LIMIT {
            let shrink = libm::ldexp(1.0, -100);
            (value, slope) = (value.scaled(shrink), slope.scaled(shrink));
            (scale, unit) = (scale * shrink, unit * shrink);
        }
        slope = slope * point + value;
        value = value * point + ComplexDoubleDouble::from(coefficient * unit);
        scale = scale * radius + (coefficient * unit).abs();
    }
    let rounding = 8.0 * polynomial.degree() as f64 * f64::EPSILON * f64::EPSILON;
    LocalValue {
        newton_step: quotient(value.value(), slope.value()),
        at_rounding_level: magnitude(value.value()) <= rounding * scale,
    }
}

/// Quotient a/b with b brought to unit size first, so that its square stays in range.
fn quotient(a: Complex64, b: Complex64) -> Option<Complex64> {
    let scale = 1.0 / b.re.abs().max(b.im.abs());
    let result = (a * scale) / (b * scale);
    result.is_finite().then_some(result)
}

/// Moves roots onto the imaginary axis if rounding of the coefficients cannot distinguish them from
/// it.
fn on_the_axis(mut roots: Vec<Complex64>) -> Vec<Complex64> {
    for root in roots.iter_mut().filter(|root| root.re.abs() <= 0.5 * f64::EPSILON * root.im.abs()) {
        root.re = 0.0;
    }
    roots
}

/// Replaces clusters that a rounding of the coefficients explains as a multiple root by that root.
///
/// The mean of a cluster of m roots is well conditioned although its members are not; it is the
/// simple root of the derivative of order m - 1 nearby, and is accepted when all lower derivatives
/// vanish there to the rounding of the coefficients.
fn merge_multiple(polynomial: &Polynomial, roots: Vec<Complex64>) -> Vec<Complex64> {
    let mut open: Vec<Complex64> = roots.into_iter().filter(|root| root.im >= 0.0).collect();
    let mut merged = Vec::new();
    while let Some(seed) = open.pop() {
        // each root of the upper half plane counts once, its mirror image once more if it is near
        let near = |root: &Complex64| magnitude(root - seed) <= 0.05 * magnitude(seed);
        let (mut cluster, far): (Vec<Complex64>, Vec<Complex64>) = open.iter().copied().partition(near);
        sort_by_number(&mut cluster, |root| magnitude(root - seed));
        cluster.insert(0, seed);
        let taken = (1..=cluster.len()).rev().find_map(|size| {
            multiple_root(polynomial, &cluster[..size]).map(|(root, count)| (root, count, size))
        });
        match taken {
            Some((root, count, size)) => {
                open = far;
                open.extend_from_slice(&cluster[size..]);
                merged.extend(std::iter::repeat_n(root, count));
            }
            None => merged.push(seed),
        }
    }
    let mirrored: Vec<Complex64> =
        merged.iter().filter(|root| root.im > 0.0).map(|root| root.conj()).collect();
    merged.extend(mirrored);
    merged
}

/// Multiple root that represents these members of the closed upper half plane, and its multiplicity
/// in the returned set.
fn multiple_root(polynomial: &Polynomial, members: &[Complex64]) -> Option<(Complex64, usize)> {
    let mean = members.iter().sum::<Complex64>() / members.len() as f64;
    let real_count: usize = members.iter().map(|root| if root.im == 0.0 { 1 } else { 2 }).sum();
    let on_axis = Complex64::new(mean.re, 0.0);
    let near_axis = members.len() > 1 || mean.im.abs() <= FAR_FROM_AXIS * magnitude(mean);
    if real_count > 1
        && near_axis
        && let Some(root) = accepted(polynomial, on_axis, real_count)
    {
        return Some((root, real_count));
    }
    if members.len() > 1
        && members.iter().all(|root| root.im > 0.0)
        && let Some(root) = accepted(polynomial, mean, members.len())
    {
        return Some((root, members.len()));
    }
    None
}

fn accepted(polynomial: &Polynomial, start: Complex64, multiplicity: usize) -> Option<Complex64> {
    // p, p'/1!, p''/2!, ... up to order m
    let mut taylor = vec![polynomial.clone()];
    for order in 1..=multiplicity {
        let last = taylor.last()?;
        taylor.push(last.derivative().scaled(1.0 / order as f64));
    }
    let (simple, slope) = (taylor.get(multiplicity - 1)?, taylor.get(multiplicity)?);
    let mut root = start;
    for _ in 0..3 {
        let step = simple.evaluate(root) / (slope.evaluate(root) * multiplicity as f64);
        if !step.is_finite() || magnitude(step) > 0.02 * magnitude(root) {
            return None;
        }
        root -= step;
    }
    let vanishes =
        |p: &Polynomial| magnitude(p.evaluate(root)) <= 2.0 * f64::EPSILON * p.evaluate_magnitudes(root);
    let lower = taylor.get(..multiplicity - 1)?;
    lower.iter().all(vanishes).then_some(root)
}
