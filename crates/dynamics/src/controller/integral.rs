//! Content of the integral part of a compensator.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use crate::linear::TransferFunction;

/// Distance of a pole from the integrating point below which it integrates: 1e-12 rad/s, or 1e-12
/// rad of pole angle.
const INTEGRATING: f64 = 1e-12;

/// Relative size of singular values that are taken as zero: an equation without information.
const SINGULAR: f64 = 1e-13;

/// Row w that gives the integral part of an output from the states, w x; all zero if nothing
/// integrates.
///
/// ```text
/// G = c_1/(s - p) + ... + c_m/(s - p)^m + remainder without integration          p = 0; sampled, z in place of s and p = 1
/// w (A - p)^m = 0,    w (A - p)^(k - 1) B = c_k,    k = 1 ... m
/// ```
///
/// By the first equation the other states do not contribute; by the others the value is the
/// response of the integral part of G to the input.
pub(crate) fn integral_row(
    function: &TransferFunction,
    dynamics: &DMatrix<f64>,
    drive: &DVector<f64>,
    point: f64,
) -> Vec<f64> {
    let states = drive.len();
    let residues = residues(function, point);
    if residues.is_empty() {
        return vec![0.0; states];
    }
    let shifted = dynamics - DMatrix::identity(states, states) * point;
    let (mut power, mut driven) = (DMatrix::identity(states, states), drive.clone());
    let mut left = DMatrix::zeros(states + residues.len(), states);
    let mut right = DVector::zeros(states + residues.len());
    for (order, residue) in residues.iter().enumerate() {
        left.row_mut(states + order).copy_from(&driven.transpose());
        right[states + order] = *residue;
        driven = &shifted * driven;
        power = &shifted * power;
    }
    left.rows_mut(0, states).copy_from(&power.transpose());
    for row in 0..left.nrows() {
        let size: f64 = left.row(row).amax();
        if size > 0.0 {
            left.row_mut(row).scale_mut(1.0 / size);
            right[row] /= size;
        }
    }
    let solution = left.svd(true, true).solve(&right, SINGULAR);
    solution.map_or_else(|_| vec![f64::NAN; states], |row| row.iter().copied().collect())
}

/// Coefficients c_1, c_2 ... of the partial fractions at this point; empty if nothing integrates.
fn residues(function: &TransferFunction, point: f64) -> Vec<f64> {
    let integrates = |pole: &Complex64| (pole - point).norm_sqr() <= INTEGRATING * INTEGRATING;
    let order = function.poles().iter().filter(|pole| integrates(pole)).count();
    // the series of (s - p)^m G in powers of s - p
    let mut series = vec![Complex64::ZERO; order];
    if let Some(first) = series.first_mut() {
        *first = function.gain().into();
    }
    for zero in function.zeros() {
        let mut below = Complex64::ZERO;
        for term in &mut series {
            let kept = *term;
            *term = kept * (point - zero) + below;
            below = kept;
        }
    }
    for pole in function.poles().iter().filter(|pole| !integrates(pole)) {
        let mut below = Complex64::ZERO;
        for term in &mut series {
            *term = (*term - below) / (point - pole);
            below = *term;
        }
    }
    series.iter().rev().map(|term| term.re).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{Polynomial, StateSpace};

    /// Coefficients from 1/s^m down, checked by hand.
    #[test]
    fn partial_fractions_at_zero() {
        let of = |numerator: &[f64], denominator: &[f64]| {
            let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
            let function =
                TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap();
            residues(&function, 0.0)
        };
        let near = |found: Vec<f64>, expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        };
        // ORIGIN: analytic
        near(of(&[0.001, 0.008], &[1.0, 0.0]), &[0.008]);
        near(of(&[1.0, 3.0], &[1.0, 2.0, 0.0]), &[1.5]);
        // (s + 3)/(s^2 (s + 2)): 1.5/s^2 + 0.25 (2 - 3) ... = 1.5/s^2 - 0.25/s + 0.25/(s + 2)
        near(of(&[1.0, 3.0], &[1.0, 2.0, 0.0, 0.0]), &[-0.25, 1.5]);
        near(of(&[1.0], &[1.0, 2.0]), &[]);
    }

    /// For a constant error, the value is its integral, however fast the other poles are.
    #[test]
    fn the_row_reads_the_integral() {
        let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
        // 5 (s + 4)/(s (s^2/1e6 + 1.2 s/1e3 + 1)(s/30 + 1)): c_1 = 20
        let denominator = polynomial(&[1e-6, 1.2e-3, 1.0])
            .product(&polynomial(&[1.0 / 30.0, 1.0]))
            .product(&polynomial(&[1.0, 0.0]));
        let function = TransferFunction::from_polynomials(&polynomial(&[5.0, 20.0]), &denominator).unwrap();
        let system = StateSpace::from_transfer_function(&function).unwrap();
        let drive = system.b().column(0).into_owned();
        let row = DVector::from_vec(integral_row(&function, system.a(), &drive, 0.0)).transpose();
        // its rate is c_1 e for any states
        let rates = &row * system.a();
        let size = row.amax() * system.a().amax();
        assert!(rates.amax() < 1e-9 * size, "{rates} {size}");
        assert!(((&row * &drive)[0] - 20.0).abs() < 1e-9);
    }
}
