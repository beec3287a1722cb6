//! Placement of the poles of a loop, and the controller that places them.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use phea_dynamics::linear::Polynomial;
use phea_dynamics::portable;

/// Least damping ratio of mirrored pairs.
const DAMPING_RATIO: f64 = 0.7;
/// Damping ratio below which a pole counts as undamped: the loop has to move it.
const UNDAMPED: f64 = 1e-3;

/// True if a loop has to move a pole: it is unstable or undamped, and not at the origin.
pub(super) fn has_to_move(pole: Complex64) -> bool {
    let size = portable::magnitude(pole);
    size > 0.0 && pole.re > -UNDAMPED * size
}

/// The well-damped mirror image of a pole in the left half plane; a slow pole for one at the
/// origin.
pub(super) fn mirror(pole: Complex64, slow: f64) -> Complex64 {
    let size = portable::magnitude(pole);
    if size == 0.0 {
        return Complex64::new(-slow, 0.0);
    }
    let damping = (pole.re.abs() / size).clamp(DAMPING_RATIO, 1.0);
    let turn = if pole.im == 0.0 { 0.0 } else { (1.0 - damping * damping).sqrt().copysign(pole.im) };
    let damping = if pole.im == 0.0 { 1.0 } else { damping };
    Complex64::new(-damping * size, turn * size)
}

/// All but one of these poles; the remaining pole of a split pair becomes real. A controller of
/// least order has one pole fewer than the plant.
pub(super) fn observer_poles(poles: &[Complex64]) -> Vec<Complex64> {
    let Some((last, others)) = poles.split_last() else { return vec![] };
    if last.im == 0.0 {
        return others.to_vec();
    }
    let size = portable::magnitude(*last);
    let left =
        others.iter().map(|pole| if *pole == last.conj() { Complex64::new(-size, 0.0) } else { *pole });
    left.collect()
}

/// Sorts poles that have to move first, then the others by their magnitude; conjugates stay
/// together, the upper one first.
pub(super) fn by_need(poles: &mut [Complex64]) {
    poles.sort_by(|one, other| {
        let key = |pole: &Complex64| (!has_to_move(*pole), portable::magnitude(*pole));
        let (one_key, other_key) = (key(one), key(other));
        let by_size = one_key.0.cmp(&other_key.0).then(one_key.1.total_cmp(&other_key.1));
        by_size.then(other.im.total_cmp(&one.im))
    });
}

/// Polynomials x (monic) and y of least degree with d x + n y = target: d has degree n, x and y
/// have degree n - 1, the target 2 n - 1.
pub(super) fn placed(
    d: &Polynomial,
    n: &Polynomial,
    target: &Polynomial,
) -> Option<(Polynomial, Polynomial)> {
    let degree = d.degree();
    let size = 2 * degree;
    if target.degree() + 1 != size {
        return None;
    }
    let column = |polynomial: &Polynomial, shift: usize| {
        let lowest_first = polynomial.coefficients().iter().rev().enumerate();
        lowest_first.map(|(power, value)| (power + shift, *value)).collect::<Vec<_>>()
    };
    let mut matrix = DMatrix::zeros(size, size);
    for shift in 0..degree {
        for (row, value) in column(d, shift) {
            matrix[(row, shift)] = value;
        }
        for (row, value) in column(n, shift) {
            matrix[(row, degree + shift)] = value;
        }
    }
    let wanted = DVector::from_iterator(size, target.coefficients().iter().rev().copied());
    let solution = matrix.lu().solve(&wanted)?;
    let polynomial =
        |from: usize| Polynomial::new((0..degree).rev().map(|power| solution[from + power]).collect());
    let (x, y) = (polynomial(0), polynomial(degree));
    let sound = solution.iter().all(|value| value.is_finite()) && !x.is_zero() && !y.is_zero();
    sound.then_some((x, y))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plant 1/(s^2 - 1) with both poles mirrored and one observer pole at 1: (s^2 - 1)(s + 3) + (4
    /// s + 4) = (s + 1)^3, so that G = 4 (s + 1)/(s + 3).
    #[test]
    fn poles_are_placed() {
        let d = Polynomial::new(vec![1.0, 0.0, -1.0]);
        let n = Polynomial::new(vec![1.0]);
        let target = Polynomial::new(vec![1.0, 3.0, 3.0, 1.0]);
        let (x, y) = placed(&d, &n, &target).unwrap_or((d.clone(), n.clone()));
        for (found, expected) in [(x, [1.0, 3.0]), (y, [4.0, 4.0])] {
            let off =
                found.coefficients().iter().zip(expected).map(|(found, expected)| (found - expected).abs());
            assert!(found.degree() == 1 && off.fold(0.0, f64::max) < 1e-12, "{found:?}");
        }
    }

    /// A pair of undamped poles becomes one with a damping ratio of 0.7 and unchanged magnitude, an
    /// unstable real pole its mirror image.
    #[test]
    fn poles_are_mirrored() {
        let pair = mirror(Complex64::new(0.0, -2.0), 0.1);
        assert!((pair.re + 1.4).abs() < 1e-12 && pair.im < 0.0 && (pair.norm_sqr() - 4.0).abs() < 1e-12);
        assert_eq!(mirror(Complex64::new(5.0, 0.0), 0.1), Complex64::new(-5.0, 0.0));
        assert_eq!(mirror(Complex64::new(0.0, 0.0), 0.1), Complex64::new(-0.1, 0.0));
    }
}
