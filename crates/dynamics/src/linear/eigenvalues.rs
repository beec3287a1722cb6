//! Eigenvalues of a real matrix whose states have very different units.
//!
//! The matrix is split into the irreducible blocks of its zero pattern (a cascade gives its poles
//! exactly, an integrator gives an exact zero); each block is balanced (Parlett and Reinsch 1969),
//! reduced by the QR algorithm, and its eigenvalues are brought to full accuracy as the roots of
//! det(sI - A) in twice the working precision.

use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

use super::double_double::ComplexDoubleDouble;
use super::hessenberg;
use super::refinement::{converge, sort, symmetrise};
use super::structure::{balance, irreducible_blocks};
use super::{LinearError, LinearNumber};
use crate::portable::magnitude;

/// All eigenvalues, sorted, in exact conjugate pairs; an irreducible block that is singular to
/// rounding has the eigenvalue zero.
pub(crate) fn eigenvalues(matrix: &DMatrix<f64>) -> Result<Vec<Complex64>, LinearError> {
    by_blocks(matrix, |block, values| {
        if is_singular(block)
            && let Some(smallest) = index_of_smallest(values)
        {
            values[smallest] = Complex64::new(0.0, 0.0);
        }
    })
}

/// All eigenvalues of a matrix whose entries result from a cancellation: none is taken as zero.
pub(crate) fn eigenvalues_of_computed(matrix: &DMatrix<f64>) -> Result<Vec<Complex64>, LinearError> {
    by_blocks(matrix, |_, _| ())
}

/// Eigenvalues in working precision, unsorted, for a matrix that is evaluated repeatedly: accurate
/// relative to the largest eigenvalue, not to each. `None` if the iteration did not converge.
pub(crate) fn working_eigenvalues(mut matrix: DMatrix<f64>) -> Option<Vec<Complex64>> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let order = matrix.nrows();
    match order {
        0 => return Some(Vec::new()),
        1 => return Some(vec![Complex64::new(matrix[(0, 0)], 0.0)]),
        2 => {
            let entry = |i, j| matrix[(i, j)];
            return Some(of_two_by_two(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)).to_vec());
        }
        _ => balance(&mut matrix),
    };
    hessenberg::eigenvalues(matrix)
}

fn by_blocks(
    matrix: &DMatrix<f64>,
    adjust: impl Fn(&DMatrix<f64>, &mut [Complex64]),
) -> Result<Vec<Complex64>, LinearError> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return Err(LinearError::NotFinite { what: LinearNumber::MatrixEntry });
    }
    let mut all = Vec::with_capacity(matrix.nrows());
    for states in irreducible_blocks(matrix) {
        let block = DMatrix::from_fn(states.len(), states.len(), |i, j| matrix[(states[i], states[j])]);
        all.extend(of_block(block, &adjust)?);
    }
    sort(&mut all);
    Ok(all)
}

fn of_block(
    mut block: DMatrix<f64>,
    adjust: impl Fn(&DMatrix<f64>, &mut [Complex64]),
) -> Result<Vec<Complex64>, LinearError> {
    match block.nrows() {
        0 => return Ok(Vec::new()),
        1 => return Ok(vec![Complex64::new(block[(0, 0)], 0.0)]),
        2 => {
            let entry = |i, j| block[(i, j)];
            return Ok(of_two_by_two(entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)).to_vec());
        }
        _ => {}
    }
    let order = block.nrows();
    balance(&mut block);
    let schur = Schur::try_new(block.clone(), f64::EPSILON, 100 * order)
        .ok_or(LinearError::EigenvaluesNotConverged { order })?;
    let (_, triangular) = schur.unpack();
    let mut values = of_quasi_triangular(&triangular);
    if values.iter().any(|value| !value.is_finite()) {
        return Err(LinearError::EigenvaluesNotConverged { order });
    }
    adjust(&block, &mut values);
    converge(&mut values, 40, |s| newton_step(&block, s));
    Ok(symmetrise(&values))
}

/// Newton step f/f' for f = det(s I - A), by elimination in twice the working precision on the
/// matrix and its derivative I.
///
/// ```text
/// f'/f = sum of u_k'/u_k over the pivots u
/// ```
fn newton_step(matrix: &DMatrix<f64>, s: Complex64) -> Option<Complex64> {
    let order = matrix.nrows();
    let zero = ComplexDoubleDouble::default();
    let mut rows: Vec<Vec<(ComplexDoubleDouble, ComplexDoubleDouble)>> = (0..order)
        .map(|i| {
            let entry = |j: usize| match i == j {
                true => {
                    let difference = ComplexDoubleDouble::difference_of(s, matrix[(i, j)].into());
                    (difference, ComplexDoubleDouble::from(1.0))
                }
                false => (ComplexDoubleDouble::from(-matrix[(i, j)]), zero),
            };
            (0..order).map(entry).collect()
        })
        .collect();
    let mut slope = Complex64::new(0.0, 0.0);
    for column in 0..order {
        let size = |row: &usize| magnitude(rows[*row][column].0.value());
        let pivot_row = (column..order).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        rows.swap(column, pivot_row);
        let pivots = rows[column].clone();
        let (pivot, pivot_slope) = pivots[column];
        if pivot == zero {
            return Some(Complex64::new(0.0, 0.0));
        }
        slope += pivot_slope.value() / pivot.value();
        for row in rows.iter_mut().skip(column + 1) {
            let (entry, entry_slope) = row[column];
            if entry == zero && entry_slope == zero {
                continue;
            }
            let factor = entry.divided_by(pivot);
            let factor_slope = (entry_slope - factor * pivot_slope).divided_by(pivot);
            for (target, &(value, value_slope)) in row.iter_mut().zip(&pivots).skip(column + 1) {
                target.1 = target.1 - factor * value_slope - factor_slope * value;
                target.0 = target.0 - factor * value;
            }
        }
    }
    let step = slope.inv();
    step.is_finite().then_some(step)
}

/// Eigenvalues on the diagonal blocks of a real Schur form.
fn of_quasi_triangular(triangular: &DMatrix<f64>) -> Vec<Complex64> {
    let order = triangular.nrows();
    let mut values = Vec::with_capacity(order);
    let mut row = 0;
    while row < order {
        let below = if row + 1 < order { triangular[(row + 1, row)] } else { 0.0 };
        if below == 0.0 {
            values.push(Complex64::new(triangular[(row, row)], 0.0));
            row += 1;
        } else {
            let entry = |i, j| triangular[(row + i, row + j)];
            values.extend(of_two_by_two(entry(0, 0), entry(0, 1), below, entry(1, 1)));
            row += 2;
        }
    }
    values
}

/// Eigenvalues of [a b; c d], the real ones without cancellation.
pub(super) fn of_two_by_two(a: f64, b: f64, c: f64, d: f64) -> [Complex64; 2] {
    let (mean, half) = ((a + d) / 2.0, (a - d) / 2.0);
    // the square root of |b c| without overflow, and the sign of b c
    let coupling = b.abs().sqrt() * c.abs().sqrt();
    let same_sign = (b < 0.0) == (c < 0.0);
    if same_sign {
        let root = crate::portable::hypot(half, coupling);
        let outer = if mean < 0.0 { mean - root } else { mean + root };
        let determinant = (a * d) - (b * c);
        let inner = if outer != 0.0 { determinant / outer } else { 0.0 };
        return [Complex64::new(inner, 0.0), Complex64::new(outer, 0.0)];
    }
    let product = (half.abs() + coupling) * (half.abs() - coupling);
    if product >= 0.0 {
        let root = product.sqrt();
        let outer = if mean < 0.0 { mean - root } else { mean + root };
        let inner = if outer != 0.0 { (a * d - b * c) / outer } else { 0.0 };
        [Complex64::new(inner, 0.0), Complex64::new(outer, 0.0)]
    } else {
        let root = (-product).sqrt();
        [Complex64::new(mean, -root), Complex64::new(mean, root)]
    }
}

/// True if rounding the entries could make the matrix singular: its Skeel condition number, which
/// no scaling of rows (or, transposed, of columns) changes, reaches the inverse of the working
/// precision.
fn is_singular(matrix: &DMatrix<f64>) -> bool {
    let Some(inverse) = matrix.clone().try_inverse() else { return true };
    let size = |m: DMatrix<f64>| m.row_iter().map(|row| row.sum()).fold(0.0, f64::max);
    let by_rows = size(inverse.abs() * matrix.abs());
    let by_columns = size((matrix.abs() * inverse.abs()).transpose());
    by_rows.min(by_columns) * f64::EPSILON >= 0.25
}

pub(crate) fn index_of_smallest(values: &[Complex64]) -> Option<usize> {
    let sizes = values.iter().enumerate().map(|(index, value)| (index, magnitude(*value)));
    sizes.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}
