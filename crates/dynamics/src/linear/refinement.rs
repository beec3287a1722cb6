//! Simultaneous refinement of the zeros of any analytic function, and the conjugate symmetry of a
//! set of roots.

use num_complex::Complex64;

use super::{LinearError, LinearNumber};
use crate::portable::magnitude;

/// Improves all roots of a function at once by the iteration of Ehrlich and Aberth,
///
/// ```text
/// z_i <- z_i - N_i / (1 - N_i sum over j of 1/(z_i - z_j)),      N_i = f(z_i)/f'(z_i)
/// ```
///
/// where `newton_step` gives N. A root is left unchanged when it has an equal twin, when the step
/// is no longer small, or when steps stop shrinking, so that good roots are never made worse by
/// rounding.
pub(crate) fn refine<F>(roots: &mut [Complex64], sweeps: usize, newton_step: F)
where
    F: Fn(Complex64) -> Option<Complex64>,
{
    let mut last_step = vec![f64::INFINITY; roots.len()];
    for _ in 0..sweeps {
        let mut moved = false;
        for index in 0..roots.len() {
            let root = roots[index];
            let Some(step) = repelled_step(roots, index, newton_step(root)) else { continue };
            let size = magnitude(step);
            let scale = magnitude(root);
            if size <= 0.02 * scale && size < 0.5 * last_step[index] {
                roots[index] = root - step;
                last_step[index] = size;
                moved = moved || size > f64::EPSILON * 1e-3 * scale;
            }
        }
        if !moved {
            return;
        }
    }
}

/// Iteration without these limits, for steps that are accurate at any distance; roots without a
/// step, and exact zeros (placed intentionally), stay.
///
/// From real points a real function never leads to complex roots, so points that are still far from
/// a root, or that do not converge, are moved off the real axis.
pub(crate) fn converge<F>(roots: &mut [Complex64], sweeps: usize, newton_step: F)
where
    F: Fn(Complex64) -> Option<Complex64>,
{
    let mut done: Vec<bool> = roots.iter().map(|root| *root == Complex64::new(0.0, 0.0)).collect();
    for sweep in 0..sweeps {
        for index in 0..roots.len() {
            if done[index] {
                continue;
            }
            let step = repelled_step(roots, index, newton_step(roots[index])).unwrap_or_default();
            let (size, scale) = (magnitude(step), magnitude(roots[index]));
            let side = if index % 2 == 0 { 1.0 } else { -1.0 };
            if sweep == 0 && size > 1e-3 * scale {
                roots[index] *= Complex64::new(1.0, 0.1 * side);
                continue;
            }
            roots[index] -= step;
            if sweep == sweeps / 2 {
                roots[index].im += side * size;
            }
            done[index] = size <= 4.0 * f64::EPSILON * scale;
        }
        if done.iter().all(|&flag| flag) {
            return;
        }
    }
}

/// Step of Ehrlich and Aberth for one root; `None` if it is undefined or zero.
pub(crate) fn repelled_step(
    roots: &[Complex64],
    index: usize,
    newton_step: Option<Complex64>,
) -> Option<Complex64> {
    let newton_step = newton_step?;
    let root = *roots.get(index)?;
    let mut repulsion = Complex64::new(0.0, 0.0);
    for (other, &position) in roots.iter().enumerate() {
        if other != index {
            if position == root {
                return None;
            }
            repulsion += (root - position).inv();
        }
    }
    let step = newton_step / (Complex64::new(1.0, 0.0) - newton_step * repulsion);
    (step.is_finite() && step != Complex64::new(0.0, 0.0)).then_some(step)
}

/// Makes a set of roots of a real function exactly symmetric about the real axis.
///
/// A root nearer to the conjugate of another root than to its own forms a pair with that root; any
/// other becomes real. The result is sorted.
pub(crate) fn symmetrise(roots: &[Complex64]) -> Vec<Complex64> {
    let mut open: Vec<Complex64> = roots.to_vec();
    // the most clearly complex first, so that the doubtful ones near the axis remain
    open.sort_by(|a, b| lean(*b).total_cmp(&lean(*a)).then(a.im.total_cmp(&b.im)));
    let mut result = Vec::with_capacity(roots.len());
    while let Some(root) = (!open.is_empty()).then(|| open.remove(0)) {
        let own = 2.0 * root.im.abs();
        let mut partner: Option<(usize, f64)> = None;
        for (index, candidate) in open.iter().enumerate() {
            let distance = magnitude(candidate.conj() - root);
            if candidate.im * root.im <= 0.0 && partner.is_none_or(|(_, best)| distance < best) {
                partner = Some((index, distance));
            }
        }
        match partner {
            Some((index, distance)) if root.im != 0.0 && distance < own => {
                let other = open.remove(index);
                let (re, im) = ((root.re + other.re) / 2.0, (root.im.abs() + other.im.abs()) / 2.0);
                result.extend([Complex64::new(re, -im), Complex64::new(re, im)]);
            }
            _ => result.push(Complex64::new(root.re, 0.0)),
        }
    }
    sort(&mut result);
    result
}

fn lean(root: Complex64) -> f64 {
    let size = magnitude(root);
    if size > 0.0 { root.im.abs() / size } else { 0.0 }
}

/// Sorts by magnitude; conjugate pairs stay together, the one with the negative imaginary part
/// first.
pub(crate) fn sort(roots: &mut [Complex64]) {
    roots.sort_by(|a, b| {
        let by_size = magnitude(*a).total_cmp(&magnitude(*b));
        let by_real = a.re.total_cmp(&b.re);
        by_size.then(by_real).then(a.im.abs().total_cmp(&b.im.abs())).then(a.im.total_cmp(&b.im))
    });
    interleave_pairs(roots);
}

/// Puts equal roots, sorted as (-, -, +, +), in the order (-, +, -, +).
fn interleave_pairs(roots: &mut [Complex64]) {
    let mut start = 0;
    while start < roots.len() {
        let first = roots[start];
        let same = |r: &Complex64| r.re == first.re && r.im.abs() == first.im.abs();
        let length = roots[start..].iter().take_while(|r| same(r)).count();
        if first.im != 0.0 {
            for (offset, root) in roots[start..start + length].iter_mut().enumerate() {
                root.im = if offset % 2 == 0 { -first.im.abs() } else { first.im.abs() };
            }
        }
        start += length;
    }
}

/// Checks that roots given by a user come in conjugate pairs, and returns them sorted and exactly
/// paired.
///
/// Partners may differ by rounding (1e-12 of their magnitude); anything else is rejected.
pub(crate) fn conjugate_pairs(roots: &[Complex64]) -> Result<Vec<Complex64>, LinearError> {
    if roots.iter().any(|root| !root.is_finite()) {
        return Err(LinearError::NotFinite { what: LinearNumber::ZeroOrPole });
    }
    let mut result: Vec<Complex64> =
        roots.iter().filter(|root| root.im == 0.0).map(|root| Complex64::new(root.re, 0.0)).collect();
    let mut below: Vec<Complex64> = roots.iter().copied().filter(|root| root.im < 0.0).collect();
    for &root in roots.iter().filter(|root| root.im > 0.0) {
        let nearest = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1);
        let distances = below.iter().enumerate().map(|(i, other)| (i, magnitude(other.conj() - root)));
        match distances.min_by(nearest) {
            Some((index, distance)) if distance <= 1e-12 * magnitude(root) => {
                let other = below.remove(index);
                let (re, im) = ((root.re + other.re) / 2.0, (root.im - other.im) / 2.0);
                result.extend([Complex64::new(re, -im), Complex64::new(re, im)]);
            }
            _ => return Err(LinearError::MissingConjugate { root }),
        }
    }
    if let Some(&root) = below.first() {
        return Err(LinearError::MissingConjugate { root });
    }
    sort(&mut result);
    Ok(result)
}
