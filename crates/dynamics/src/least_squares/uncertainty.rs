//! Uncertainty of variables determined from data: covariance, and directions that data do not
//! determine.

use crate::order::sort_by_number;
use nalgebra::{DMatrix, SymmetricEigen};

use super::Linearised;

/// Uncertainty of variables determined from data.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Standard deviation of each variable; infinite for one without influence.
    pub deviations: Vec<f64>,
    /// Correlation of each pair of variables, row by row.
    pub correlations: Vec<f64>,
    /// Combinations of variables, the best determined first.
    pub directions: Vec<Direction>,
}

/// Combination of variables, and its uncertainty.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Components of the combination, one for each variable; of unit length.
    pub fractions: Vec<f64>,
    /// Standard deviation along the combination; infinite for one without influence.
    pub deviation: f64,
}

/// Relative eigenvalue of the information below which it is a rounding error.
const ROUNDING: f64 = 1e-15;

/// Covariance of the variables at a minimum, by the sandwich of White (1980) and Huber (1967):
/// noise may differ from residual to residual, and its size is taken from the residuals themselves.
///
/// ```text
/// cov = H^-1 S H^-1 n/(n - m)      H = sum psi' j j',  S = sum over groups of g g',  g = sum psi j within a group
/// ```
///
/// with j the derivatives of one residual, n residuals and m variables that influence one.
/// Residuals of one group may depend on each other, as readings at one instant do (Liang and Zeger
/// 1986); `groups` has the index of each residual's group. The standard deviation along each
/// eigenvector of H follows from the covariance.
///
/// # Example
/// The standard deviation of the mean of n numbers is their deviation over the root of n.
/// ```
/// use phea_dynamics::least_squares::{Linearised, uncertainty};
/// let residuals = vec![-1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0];
/// let found = Linearised { residuals, jacobian: vec![1.0; 8] };
/// let alone = uncertainty(&found, &[0, 1, 2, 3, 4, 5, 6, 7], 1, f64::INFINITY);
/// assert!((alone.deviations[0] - 1.0 / 7.0_f64.sqrt()).abs() < 1e-12);
/// // read twice each, they are half as many
/// let residuals = vec![-1.0, -1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0];
/// let found = Linearised { residuals, jacobian: vec![1.0; 8] };
/// let pairs = uncertainty(&found, &[0, 0, 1, 1, 2, 2, 3, 3], 1, f64::INFINITY);
/// assert!((pairs.deviations[0] / alone.deviations[0] - 2.0_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn uncertainty(at: &Linearised, groups: &[usize], count: usize, robust_beyond: f64) -> Uncertainty {
    uncertainty_with_shared(at, groups, count, robust_beyond, &[])
}

/// Covariance where the residuals also have common errors that more data do not average out, such
/// as a constant error of an instrument.
///
/// ```text
/// S = sum over groups of g g' n/(n - m) + sum over errors of e e'       e = sum psi' j d
/// ```
///
/// with d the change of each residual by one standard deviation of the error; `shared` has one row
/// of d for each error.
///
/// # Example
/// The mean of many readings is no more certain than the zero of the instrument.
/// ```
/// use phea_dynamics::least_squares::{Linearised, uncertainty_with_shared};
/// let residuals = (0..10_000).map(|row| if row % 2 == 0 { 1.0 } else { -1.0 }).collect();
/// let found = Linearised { residuals, jacobian: vec![1.0; 10_000] };
/// let groups: Vec<usize> = (0..10_000).collect();
/// let zero = vec![0.5; 10_000];
/// let told = uncertainty_with_shared(&found, &groups, 1, f64::INFINITY, &[zero]);
/// assert!((told.deviations[0] - (0.25_f64 + 1e-4).sqrt()).abs() < 1e-6);
/// ```
pub fn uncertainty_with_shared(
    at: &Linearised,
    groups: &[usize],
    count: usize,
    robust_beyond: f64,
    shared: &[Vec<f64>],
) -> Uncertainty {
    let mut information = DMatrix::<f64>::zeros(count, count);
    let last = groups.iter().copied().max().unwrap_or(0);
    let mut scores = vec![0.0; (last + 1) * count];
    for ((residual, row), group) in at.residuals.iter().zip(at.jacobian.chunks_exact(count)).zip(groups) {
        let inside = residual.abs() <= robust_beyond;
        let score = residual.max(-robust_beyond).min(robust_beyond);
        let of_group = scores.iter_mut().skip(group * count);
        for (sum, slope) in of_group.zip(row) {
            *sum += score * slope;
        }
        if inside {
            add_square(&mut information, row);
        }
    }
    let mut scatter = DMatrix::<f64>::zeros(count, count);
    for scores in scores.chunks_exact(count) {
        add_square(&mut scatter, scores);
    }
    let mut of_errors = DMatrix::<f64>::zeros(count, count);
    for changes in shared {
        let mut score = vec![0.0; count];
        let rows = at.residuals.iter().zip(at.jacobian.chunks_exact(count)).zip(changes);
        for ((_, row), change) in rows.filter(|((residual, _), _)| residual.abs() <= robust_beyond) {
            score.iter_mut().zip(row).for_each(|(sum, slope)| *sum += slope * change);
        }
        add_square(&mut of_errors, &score);
    }
    information.fill_upper_triangle_with_lower_triangle();
    scatter.fill_upper_triangle_with_lower_triangle();
    of_errors.fill_upper_triangle_with_lower_triangle();
    // a variable without influence takes no degree of freedom from the residuals
    let varied = (0..count).filter(|index| information[(*index, *index)] > 0.0).count();
    let (rows, variables) = (at.residuals.len() as f64, varied as f64);
    let freedom = if rows > variables { rows / (rows - variables) } else { f64::INFINITY };
    sandwich(information, &(scatter * freedom + of_errors))
}

/// Efficiency of the loss with the usual bend for normal noise (Huber 1981).
const EFFICIENCY: f64 = 0.95;

/// Covariance of the variables at a minimum for residuals that are known to be independent, normal
/// and of standard deviation one, by the information in all of them.
///
/// ```text
/// cov = (sum j j')^-1/0.95
/// ```
///
/// A residual that depends on a variable of its own shows no noise: [`uncertainty`], which takes
/// the noise from the residuals, would count it as exact. 0.95 is the efficiency of the usual
/// robust loss.
///
/// # Example
/// ```
/// use phea_dynamics::least_squares::{Linearised, uncertainty_by_scale};
/// let found = Linearised { residuals: vec![0.0; 100], jacobian: vec![1.0; 100] };
/// let told = uncertainty_by_scale(&found, 1);
/// assert!((told.deviations[0] - 0.1 / 0.95_f64.sqrt()).abs() < 1e-12);
/// ```
pub fn uncertainty_by_scale(at: &Linearised, count: usize) -> Uncertainty {
    let mut information = DMatrix::<f64>::zeros(count, count);
    for row in at.jacobian.chunks_exact(count) {
        add_square(&mut information, row);
    }
    information.fill_upper_triangle_with_lower_triangle();
    let scatter = &information / EFFICIENCY;
    sandwich(information, &scatter)
}

/// Adds the lower triangle of a row's outer product with itself.
fn add_square(matrix: &mut DMatrix<f64>, row: &[f64]) {
    for (i, first) in row.iter().enumerate().filter(|(_, first)| **first != 0.0) {
        for (j, second) in row.iter().enumerate().take(i + 1) {
            matrix[(i, j)] += first * second;
        }
    }
}

fn sandwich(information: DMatrix<f64>, scatter: &DMatrix<f64>) -> Uncertainty {
    let count = information.nrows();
    let eigen = SymmetricEigen::new(information);
    let largest = eigen.eigenvalues.max();
    let is_told = |value: f64| value > ROUNDING * largest && value > 0.0;
    let mut inverse = DMatrix::<f64>::zeros(count, count);
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if is_told(*value) {
            inverse += vector * vector.transpose() / *value;
        }
    }
    let covariance = &inverse * scatter * &inverse;
    let mut directions: Vec<(f64, Direction)> = Vec::with_capacity(count);
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        let variance = (vector.transpose() * &covariance * vector).x;
        let deviation = if is_told(*value) { variance.max(0.0).sqrt() } else { f64::INFINITY };
        directions.push((*value, Direction { fractions: vector.iter().copied().collect(), deviation }));
    }
    sort_by_number(&mut directions, |(value, _)| -value);
    let directions: Vec<Direction> = directions.into_iter().map(|(_, direction)| direction).collect();
    let untold = |index: usize| {
        let fraction = |direction: &Direction| direction.fractions.get(index).copied().unwrap_or(0.0);
        directions.iter().any(|one| one.deviation.is_infinite() && fraction(one).abs() > 1e-6)
    };
    let deviation = |index: usize| match untold(index) {
        true => f64::INFINITY,
        false => covariance[(index, index)].max(0.0).sqrt(),
    };
    let deviations: Vec<f64> = (0..count).map(deviation).collect();
    let correlation = |i: usize, j: usize| {
        let product = (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        if i == j { 1.0 } else { covariance[(i, j)] / product }
    };
    let correlations = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
    let correlations = correlations.map(|(i, j)| correlation(i, j)).collect();
    Uncertainty { deviations, correlations, directions }
}
