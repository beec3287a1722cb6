//! Block-triangular structure from the zeros of a matrix, and solutions that respect it.

use nalgebra::{DMatrix, DVector, Dyn, LU, linalg::balancing::balance_parlett_reinsch};
use num_complex::Complex64;

use super::double_double::ComplexDoubleDouble;
use crate::portable::magnitude;

/// Sets of states that all influence each other, ordered so that each is influenced by earlier sets
/// only.
pub(crate) fn irreducible_blocks(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let order = matrix.nrows();
    let mut depends = DMatrix::from_fn(order, order, |i, j| i == j || matrix[(i, j)] != 0.0);
    for via in 0..order {
        for from in 0..order {
            if depends[(from, via)] {
                for to in 0..order {
                    depends[(from, to)] = depends[(from, to)] || depends[(via, to)];
                }
            }
        }
    }
    let mut assigned = vec![false; order];
    let mut blocks = Vec::new();
    for first in 0..order {
        if !assigned[first] {
            let mutual = |&other: &usize| depends[(first, other)] && depends[(other, first)];
            let block: Vec<usize> = (first..order).filter(mutual).collect();
            block.iter().for_each(|&state| assigned[state] = true);
            blocks.push(block);
        }
    }
    // a set that depends on another depends on all that the other depends on, and more
    blocks.sort_by_key(|block: &Vec<usize>| {
        block.first().map_or(0, |&state| (0..order).filter(|&other| depends[(state, other)]).count())
    });
    blocks
}

/// Largest entry of a matrix that is balanced: the squares of larger entries leave the range of
/// numbers.
const BALANCED_MAXIMUM: f64 = 1e140;

/// Scales states so that rows and columns have like norms (Parlett and Reinsch 1969); the units,
/// powers of two. A matrix with entries whose squares leave the range of numbers, for which the
/// iteration would not end, is unchanged.
pub(crate) fn balance(matrix: &mut DMatrix<f64>) -> DVector<f64> {
    if matrix.iter().all(|entry| entry.abs() <= BALANCED_MAXIMUM) {
        balance_parlett_reinsch(matrix)
    } else {
        DVector::from_element(matrix.nrows(), 1.0)
    }
}

/// A column of numbers in twice the working precision.
pub(crate) type WideVector = Vec<ComplexDoubleDouble>;

/// Resolvent (s I - A)^-1 at one point, block by block, so that a slow mode is not mixed with a
/// fast one that it only drives.
///
/// Each block is balanced and factored in working precision; its solutions are refined with
/// residuals in twice the working precision, which recovers the digits lost by the condition of A.
pub(crate) struct Resolvent<'a> {
    matrix: &'a DMatrix<f64>,
    s: Complex64,
    blocks: Vec<StructureBlock>,
}

struct StructureBlock {
    states: Vec<usize>,
    units: DVector<f64>,
    factors: LU<Complex64, Dyn, Dyn>,
}

const MAXIMUM_REFINEMENTS: usize = 10;

impl<'a> Resolvent<'a> {
    pub(crate) fn new(matrix: &'a DMatrix<f64>, s: Complex64) -> Self {
        let block = |states: Vec<usize>| {
            let size = states.len();
            let mut balanced = DMatrix::from_fn(size, size, |i, j| matrix[(states[i], states[j])]);
            let units = balance(&mut balanced);
            let shifted = DMatrix::from_diagonal_element(size, size, s)
                - balanced.map(|entry| Complex64::new(entry, 0.0));
            StructureBlock { states, units, factors: shifted.lu() }
        };
        Resolvent { matrix, s, blocks: irreducible_blocks(matrix).into_iter().map(block).collect() }
    }

    /// Solution (s I - A)^-1 r; `None` if s is an eigenvalue.
    pub(crate) fn solve(&self, right: &[ComplexDoubleDouble]) -> Option<WideVector> {
        let mut solution = vec![ComplexDoubleDouble::default(); right.len()];
        let everything: Vec<usize> = (0..right.len()).collect();
        for block in &self.blocks {
            let mut last = f64::INFINITY;
            for _ in 0..MAXIMUM_REFINEMENTS {
                let residual = DVector::from_fn(block.states.len(), |i, _| {
                    self.residual(block.states[i], right, &solution, &everything) / block.units[i]
                });
                let correction = block.factors.solve(&residual)?;
                let size = correction.iter().map(|entry| magnitude(*entry)).fold(0.0, f64::max);
                if !size.is_finite() {
                    return None;
                }
                if size == 0.0 || size >= 0.5 * last {
                    break;
                }
                last = size;
                for (i, &state) in block.states.iter().enumerate() {
                    let step = ComplexDoubleDouble::from(correction[i] * block.units[i]);
                    solution[state] = solution[state] + step;
                }
            }
        }
        Some(solution)
    }

    /// Residual of one row, r - (s I - A) x.
    fn residual(
        &self,
        row: usize,
        right: &[ComplexDoubleDouble],
        solution: &[ComplexDoubleDouble],
        columns: &[usize],
    ) -> Complex64 {
        let diagonal =
            ComplexDoubleDouble::difference_of(Complex64::new(self.matrix[(row, row)], 0.0), self.s);
        let start = right[row] + diagonal * solution[row];
        let others = columns.iter().filter(|&&column| column != row && self.matrix[(row, column)] != 0.0);
        others
            .fold(start, |sum, &column| sum + solution[column].times_real(self.matrix[(row, column)]))
            .value()
    }
}

/// Real column in twice the working precision.
pub(crate) fn widened<'a>(column: impl Iterator<Item = &'a f64>) -> WideVector {
    column.map(|&entry| ComplexDoubleDouble::from(entry)).collect()
}

/// Sum c x + d, rounded once.
pub(crate) fn product<'a>(
    row: impl Iterator<Item = &'a f64>,
    column: &[ComplexDoubleDouble],
    start: f64,
) -> Complex64 {
    row.zip(column).fold(ComplexDoubleDouble::from(start), |sum, (&c, &x)| sum + x.times_real(c)).value()
}
