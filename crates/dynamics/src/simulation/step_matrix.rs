//! Linear equations of a step, with an elimination order found once.

use super::Lane;

/// Update `entry[target] -= entry[multiplier] * entry[source]`.
#[derive(Clone, Copy, Debug)]
struct Update {
    target: u32,
    multiplier: u32,
    source: u32,
}

/// Two terms of a substitution: `vector[state] -= value * vector[other]` for both; rows of more
/// terms take several.
#[derive(Clone, Copy, Debug)]
struct TermPair<S> {
    values: [S; 2],
    others: [u8; 2],
    state: u8,
}

/// Triangle in the order of its substitution.
#[derive(Clone, Debug)]
struct Triangle<S> {
    terms: Vec<TermPair<S>>,
    /// Positions of the values of the terms, one after another; `None` for the padding of a pair.
    held: Vec<[Option<u32>; 2]>,
}

/// Vector of a substitution: an index of eight bits is always in range.
pub(super) type ColumnIndex<S> = [S; COLUMN];

/// Number of states that a [`Dependence`](crate::scalar::Dependence) distinguishes.
pub(super) const COLUMN: usize = 256;

/// Largest number of states of a system that is solved by its inverse.
const SMALL: usize = 16;

/// Small matrix by rows, each in groups of four.
type MatrixRows<S> = [[[S; 4]; SMALL / 4]; SMALL];

/// Inverse of a small matrix.
///
/// ```text
/// W^-T = L^-T D^-1 U^-T         row by row: contribution of each entry of a right-hand side to the solution
/// ```
///
/// Its product with a vector is a sum of vectors, whereas a substitution needs each state before it
/// finds the next.
#[derive(Clone, Debug)]
struct Inverse<S> {
    /// Triangles U^T, then L^T.
    triangles: [Triangle<S>; 2],
    /// Inverse W^-T, row by row, in groups of four columns.
    rows: Box<MatrixRows<S>>,
    /// Number of groups used.
    groups: usize,
}

impl<S: Lane> Inverse<S> {
    #[inline(always)]
    fn find(&mut self, entries: &[S], inverses: &[S]) {
        match self.groups {
            0 | 1 => self.find_groups::<1>(entries, inverses),
            2 => self.find_groups::<2>(entries, inverses),
            3 => self.find_groups::<3>(entries, inverses),
            _ => self.find_groups::<4>(entries, inverses),
        }
    }

    /// Finds the inverse with the number of column groups known at compile time, so that the sums
    /// stay in registers.
    #[inline(always)]
    fn find_groups<const GROUPS: usize>(&mut self, entries: &[S], inverses: &[S]) {
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let [first, last] = &mut self.triangles;
        first.take(entries);
        last.take(entries);
        for (place, row) in self.rows.iter_mut().enumerate().take(inverses.len()) {
            *row = [[zero; 4]; SMALL / 4];
            row[place / 4][place % 4] = one;
        }
        first.substitute_rows::<GROUPS>(&mut self.rows);
        for (row, &inverse) in self.rows.iter_mut().zip(inverses) {
            for value in row[..GROUPS].as_flattened_mut() {
                *value = *value * inverse;
            }
        }
        last.substitute_rows::<GROUPS>(&mut self.rows);
    }

    #[inline(always)]
    fn apply(&self, vector: &mut ColumnIndex<S>, states: usize) {
        match self.groups {
            0 | 1 => self.apply_groups::<1>(vector, states),
            2 => self.apply_groups::<2>(vector, states),
            3 => self.apply_groups::<3>(vector, states),
            _ => self.apply_groups::<4>(vector, states),
        }
    }

    #[inline(always)]
    fn apply_groups<const GROUPS: usize>(&self, vector: &mut ColumnIndex<S>, states: usize) {
        let mut sums = [[S::from(0.0); 4]; GROUPS];
        for (row, &right) in self.rows[..states.min(SMALL)].iter().zip(&*vector) {
            for (sums, group) in sums.iter_mut().zip(row) {
                for (sum, &value) in sums.iter_mut().zip(group) {
                    *sum = *sum + value * right;
                }
            }
        }
        let (solution, _) = vector.as_chunks_mut();
        for (solution, sums) in solution.iter_mut().zip(&sums) {
            *solution = *sums;
        }
    }
}

impl<S: Lane> Triangle<S> {
    fn new(rows: impl Iterator<Item = (u8, Vec<(u32, u8)>)>) -> Triangle<S> {
        let mut triangle = Triangle { terms: Vec::new(), held: Vec::new() };
        for (state, row) in rows {
            for pair in row.chunks(2) {
                let mut terms = TermPair { values: [S::from(0.0); 2], others: [state; 2], state };
                let mut held = [None; 2];
                for (place, &(entry, other)) in pair.iter().enumerate() {
                    (held[place], terms.others[place]) = (Some(entry), other);
                }
                triangle.terms.push(terms);
                triangle.held.push(held);
            }
        }
        triangle
    }

    /// Reads its values from the entries.
    #[inline(always)]
    fn take(&mut self, entries: &[S]) {
        for (terms, held) in self.terms.iter_mut().zip(&self.held) {
            for (value, entry) in terms.values.iter_mut().zip(held) {
                if let Some(entry) = entry {
                    *value = entries[*entry as usize];
                }
            }
        }
    }

    /// Substitution for every column of a matrix that is given by rows of this number of groups.
    #[inline(always)]
    #[allow(clippy::needless_range_loop, reason = "three rows of one matrix, of which one is changed")]
    fn substitute_rows<const GROUPS: usize>(&self, rows: &mut MatrixRows<S>) {
        for TermPair { values, others, state } in &self.terms {
            let [one, other] = others.map(|other| usize::from(other) % SMALL);
            let state = usize::from(*state) % SMALL;
            for group in 0..GROUPS {
                let mut sums = rows[state][group];
                for (sum, &other) in sums.iter_mut().zip(&rows[one][group]) {
                    *sum = *sum - values[0] * other;
                }
                for (sum, &other) in sums.iter_mut().zip(&rows[other][group]) {
                    *sum = *sum - values[1] * other;
                }
                rows[state][group] = sums;
            }
        }
    }

    #[inline(always)]
    fn substitute(&self, vector: &mut ColumnIndex<S>) {
        for TermPair { values, others, state } in &self.terms {
            let sum = vector[usize::from(*state)] - values[0] * vector[usize::from(others[0])];
            vector[usize::from(*state)] = sum - values[1] * vector[usize::from(others[1])];
        }
    }
}

/// Elimination of one state: its position on the diagonal, the entries below and right of it, and
/// the entries that they update.
#[derive(Clone, Debug)]
struct Pivot {
    state: usize,
    diagonal: usize,
    below: Vec<u32>,
    beside: Vec<u32>,
    updates: Vec<Update>,
}

/// Matrix of a fixed pattern, with its triangular factors in place.
///
/// ```text
/// W = I/(h gamma) - J = L D U        L and U with ones on the diagonal; pivots on the diagonal, in an order that fills in least (Markowitz 1957)
/// ```
///
/// The order depends on the pattern and not on the values, so that all lanes have it and no step
/// searches for pivots. As the step h decreases, W tends to a multiple of the identity: a pivot
/// that lost its digits requires a shorter step.
#[derive(Clone, Debug)]
pub(super) struct StepMatrix<S> {
    values: Vec<S>,
    pivots: Vec<Pivot>,
    /// Forward and backward substitution.
    substitutions: [Triangle<S>; 2],
    /// Inverse that replaces the substitutions in a small system.
    inverse: Option<Inverse<S>>,
    /// Position of each (row, column) of the original pattern, row by row.
    entries: Vec<Vec<u32>>,
    diagonal: Vec<u32>,
    /// Diagonal before elimination, and the inverse pivots after it.
    untouched: Vec<S>,
    inverses: Vec<S>,
}

/// Ratio of a pivot to its original diagonal below which the pivot has lost its digits.
const LOST_DIGITS: f64 = 1e-10;

impl<S: Lane> StepMatrix<S> {
    /// Matrix with these columns in each row in addition to the diagonal; with no more rows than a
    /// [`ColumnIndex`] has.
    pub(super) fn new(rows: &[Vec<usize>]) -> StepMatrix<S> {
        let count = rows.len();
        let mut filled: Vec<Vec<bool>> = vec![vec![false; count]; count];
        for (row, columns) in rows.iter().enumerate() {
            filled[row][row] = true;
            for &column in columns {
                filled[row][column] = true;
            }
        }
        let order = order_of_elimination(&mut filled);
        let mut place = vec![vec![u32::MAX; count]; count];
        let mut used = 0;
        for (row, columns) in filled.iter().enumerate() {
            for (column, _) in columns.iter().enumerate().filter(|(_, filled)| **filled) {
                place[row][column] = used;
                used += 1;
            }
        }
        let pivots = pivots(&order, &filled, &place);
        let substitutions = substitutions(&order, &filled, |row, column| place[row][column]);
        let inverse = (count <= SMALL).then(|| Inverse {
            triangles: self::substitutions(&order, &transposed(&filled), |row, column| place[column][row]),
            rows: Box::new([[[S::from(0.0); 4]; SMALL / 4]; SMALL]),
            groups: count.div_ceil(4),
        });
        let entries = rows
            .iter()
            .enumerate()
            .map(|(row, columns)| columns.iter().map(|&column| place[row][column]).collect())
            .collect();
        let diagonal = (0..count).map(|state| place[state][state]).collect();
        let values = vec![S::from(0.0); used as usize];
        let untouched = vec![S::from(0.0); count];
        let inverses = untouched.clone();
        StepMatrix { values, pivots, substitutions, inverse, entries, diagonal, untouched, inverses }
    }

    /// Sets the matrix to `diagonal` times the identity.
    #[inline(always)]
    pub(super) fn reset(&mut self, diagonal: S) {
        self.values.fill(S::from(0.0));
        for &entry in &self.diagonal {
            self.values[entry as usize] = diagonal;
        }
    }

    /// Position of the entry at this index in this row of the pattern.
    pub(super) fn entry(&self, row: usize, place: usize) -> usize {
        self.entries[row][place] as usize
    }

    /// Subtracts a number from an entry.
    #[inline(always)]
    pub(super) fn subtract(&mut self, entry: usize, value: S) {
        self.values[entry] = self.values[entry] - value;
    }

    /// Factors the matrix in place; the result is positive in each lane in which every pivot kept
    /// its digits.
    #[inline(always)]
    pub(super) fn factor(&mut self) -> S {
        let mut least = S::from(f64::INFINITY);
        let values = &mut self.values;
        for (untouched, &entry) in self.untouched.iter_mut().zip(&self.diagonal) {
            *untouched = S::from(LOST_DIGITS) * values[entry as usize].abs();
        }
        for pivot in &self.pivots {
            let value = values[pivot.diagonal];
            let inverse = S::from(1.0) / value;
            least = least.minimum(value.abs() - self.untouched[pivot.state]);
            values[pivot.diagonal] = inverse;
            for &entry in &pivot.below {
                values[entry as usize] = values[entry as usize] * inverse;
            }
            for &Update { target, multiplier, source } in &pivot.updates {
                let product = values[multiplier as usize] * values[source as usize];
                values[target as usize] = values[target as usize] - product;
            }
            for &entry in &pivot.beside {
                values[entry as usize] = values[entry as usize] * inverse;
            }
        }
        for (inverse, &entry) in self.inverses.iter_mut().zip(&self.diagonal) {
            *inverse = values[entry as usize];
        }
        match &mut self.inverse {
            Some(inverse) => inverse.find(values, &self.inverses),
            None => self.substitutions.iter_mut().for_each(|triangle| triangle.take(values)),
        }
        least
    }

    /// Solves W x = b in place of b.
    #[inline(always)]
    pub(super) fn solve(&self, vector: &mut ColumnIndex<S>) {
        if let Some(inverse) = &self.inverse {
            return inverse.apply(vector, self.inverses.len());
        }
        let [forward, backward] = &self.substitutions;
        forward.substitute(vector);
        for (value, &inverse) in vector.iter_mut().zip(&self.inverses) {
            *value = *value * inverse;
        }
        backward.substitute(vector);
    }
}

/// Elimination order: each time the state whose elimination affects the fewest entries; filled-in
/// entries are marked.
fn order_of_elimination(filled: &mut [Vec<bool>]) -> Vec<usize> {
    let count = filled.len();
    let mut left: Vec<usize> = (0..count).collect();
    let mut order = Vec::with_capacity(count);
    while !left.is_empty() {
        let cost = |state: usize| {
            let below = left.iter().filter(|&&row| row != state && filled[row][state]).count();
            let beside = left.iter().filter(|&&column| column != state && filled[state][column]).count();
            below * beside
        };
        let Some(position) = (0..left.len()).min_by_key(|&position| cost(left[position])) else { break };
        let pivot = left.remove(position);
        for &row in &left {
            for &column in &left {
                filled[row][column] |= filled[row][pivot] && filled[pivot][column];
            }
        }
        order.push(pivot);
    }
    order
}

fn pivots(order: &[usize], filled: &[Vec<bool>], place: &[Vec<u32>]) -> Vec<Pivot> {
    let mut later: Vec<usize> = order.to_vec();
    let mut pivots = Vec::with_capacity(order.len());
    for &state in order {
        later.retain(|&other| other != state);
        let rows: Vec<usize> = later.iter().copied().filter(|&row| filled[row][state]).collect();
        let columns: Vec<usize> = later.iter().copied().filter(|&column| filled[state][column]).collect();
        let update = |row: usize, column: usize| Update {
            target: place[row][column],
            multiplier: place[row][state],
            source: place[state][column],
        };
        let updates = rows.iter().flat_map(|&row| columns.iter().map(move |&column| update(row, column)));
        pivots.push(Pivot {
            state,
            diagonal: place[state][state] as usize,
            below: rows.iter().map(|&row| place[row][state]).collect(),
            beside: columns.iter().map(|&column| place[state][column]).collect(),
            updates: updates.collect(),
        });
    }
    pivots
}

/// Forward substitution through L, backward through U; the position of the entry in each row and
/// column.
fn substitutions<S: Lane>(
    order: &[usize],
    filled: &[Vec<bool>],
    place: impl Fn(usize, usize) -> u32,
) -> [Triangle<S>; 2] {
    let row = |state: usize, known: &[usize]| {
        let known = known.iter().filter(|&&other| filled[state][other]);
        (state as u8, known.map(|&other| (place(state, other), other as u8)).collect::<Vec<_>>())
    };
    let positions = order.iter().enumerate();
    let forward = positions.clone().map(|(position, &state)| row(state, &order[..position]));
    let backward = positions.rev().map(|(position, &state)| row(state, &order[position + 1..]));
    [Triangle::new(forward), Triangle::new(backward)]
}

fn transposed(filled: &[Vec<bool>]) -> Vec<Vec<bool>> {
    (0..filled.len()).map(|row| filled.iter().map(|columns| columns[row]).collect()).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::scalar::Lanes;

    /// An arrow with a band: fill-in, several pivots without entries below, and numbers from a
    /// small recurrence.
    #[test]
    fn solves_as_a_dense_factorisation_does() {
        for count in [1, 9, 15, 16, 17, 30] {
            compare_with_dense(count);
        }
    }

    fn compare_with_dense(count: usize) {
        let rows: Vec<Vec<usize>> = (0..count)
            .map(|row| {
                (0..count).filter(|&c| c == 0 || row == 0 || row.abs_diff(c) == 1 || c + 4 == row).collect()
            })
            .collect();
        let mut matrix = StepMatrix::<Lanes>::new(&rows);
        let mut dense =
            [40.0, -30.0, 50.0, 25.0].map(|diagonal| DMatrix::<f64>::identity(count, count) * diagonal);
        matrix.reset(Lanes([40.0, -30.0, 50.0, 25.0]));
        let mut number = 0.4;
        for (row, columns) in rows.iter().enumerate() {
            for (place, &column) in columns.iter().enumerate() {
                number = 3.9 * number * (1.0 - number);
                let entry = matrix.entry(row, place);
                let parts = [10.0, -7.0, 3.0, 5.0].map(|factor| factor * number);
                matrix.subtract(entry, Lanes(parts));
                for (dense, part) in dense.iter_mut().zip(parts) {
                    dense[(row, column)] -= part;
                }
            }
        }
        assert!(matrix.factor().0.iter().all(|&kept| kept > 0.0));
        let right = DVector::from_fn(count, |row, _| row as f64 - 3.5);
        let mut solution = [Lanes::from(0.0); COLUMN];
        for (place, &value) in solution.iter_mut().zip(right.iter()) {
            *place = Lanes::from(value);
        }
        matrix.solve(&mut solution);
        for (lane, dense) in dense.into_iter().enumerate() {
            let expected = dense.lu().solve(&right).unwrap();
            for (value, expected) in solution.iter().zip(expected.iter()) {
                assert!((value.0[lane] - expected).abs() < 1e-12 * expected.abs().max(1.0));
            }
        }
    }

    /// The matrix [1 1; 1 1] plus rounding has no reliable second pivot.
    #[test]
    fn a_pivot_without_digits_is_told() {
        let mut matrix = StepMatrix::<f64>::new(&[vec![1], vec![0]]);
        matrix.reset(1.0);
        matrix.subtract(matrix.entry(0, 0), 1.0);
        matrix.subtract(matrix.entry(1, 0), 1.0 - 1e-13);
        assert!(matrix.factor() < 0.0);
    }
}
