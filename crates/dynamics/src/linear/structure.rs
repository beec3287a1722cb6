//! The block-triangular structure that the zeros of a matrix give it, and solutions that respect it.

use nalgebra::{DMatrix, DVector, linalg::balancing::balance_parlett_reinsch};
use num_complex::Complex64;

/// The sets of states that all influence each other, ordered so that each is influenced by earlier ones only.
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
    // whatever depends on a block depends on all that the block depends on, and on more
    blocks.sort_by_key(|block: &Vec<usize>| {
        block.first().map_or(0, |&state| (0..order).filter(|&other| depends[(state, other)]).count())
    });
    blocks
}

/// Solves (s I - A) X = R block by block, each block balanced: a slow mode is not mixed with a fast one that it only
/// feeds.
pub(crate) struct Resolvent<'a> {
    matrix: &'a DMatrix<f64>,
    blocks: Vec<Block>,
}

struct Block {
    states: Vec<usize>,
    balanced: DMatrix<Complex64>,
    units: DVector<f64>,
}

impl<'a> Resolvent<'a> {
    pub(crate) fn of(matrix: &'a DMatrix<f64>) -> Self {
        let block = |states: Vec<usize>| {
            let size = states.len();
            let mut balanced = DMatrix::from_fn(size, size, |i, j| matrix[(states[i], states[j])]);
            let units = balance_parlett_reinsch(&mut balanced);
            Block { states, balanced: balanced.map(|entry| Complex64::new(entry, 0.0)), units }
        };
        Resolvent { matrix, blocks: irreducible_blocks(matrix).into_iter().map(block).collect() }
    }

    /// X, or nothing where s is an eigenvalue.
    pub(crate) fn solve(&self, s: Complex64, right: &DMatrix<Complex64>) -> Option<DMatrix<Complex64>> {
        let mut solution = DMatrix::zeros(right.nrows(), right.ncols());
        let mut known: Vec<usize> = Vec::with_capacity(right.nrows());
        for block in &self.blocks {
            let size = block.states.len();
            let driven = DMatrix::from_fn(size, right.ncols(), |i, column| {
                let state = block.states[i];
                let coupled =
                    known.iter().map(|&other| solution[(other, column)] * self.matrix[(state, other)]);
                (right[(state, column)] + coupled.sum::<Complex64>()) / block.units[i]
            });
            let part = block.solve(s, &driven)?;
            for (i, &state) in block.states.iter().enumerate() {
                for column in 0..right.ncols() {
                    solution[(state, column)] = part[(i, column)] * block.units[i];
                }
            }
            known.extend_from_slice(&block.states);
        }
        Some(solution)
    }
}

impl Block {
    fn solve(&self, s: Complex64, right: &DMatrix<Complex64>) -> Option<DMatrix<Complex64>> {
        let size = self.states.len();
        let shifted = DMatrix::from_diagonal_element(size, size, s) - &self.balanced;
        if size == 1 {
            let pivot = shifted[(0, 0)];
            return (pivot != Complex64::new(0.0, 0.0)).then(|| right.map(|entry| entry / pivot));
        }
        let lu = shifted.clone().lu();
        let mut solution = lu.solve(right)?;
        // one step of refinement makes the solution backward stable entry by entry (Skeel 1980)
        if let Some(correction) = lu.solve(&(right - &shifted * &solution))
            && correction.iter().all(|entry| entry.is_finite())
        {
            solution += correction;
        }
        Some(solution)
    }
}
