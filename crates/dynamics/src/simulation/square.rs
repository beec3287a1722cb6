//! Square matrices whose product with a vector is taken four rows at a time.

use super::Lane;

/// A square matrix column by column, each column in groups of four rows, the last filled up with zeros.
///
/// ```text
/// A x = sum over j of a_j x_j          a_j the columns: four sums at once, where a row by row each sum waits for itself
/// ```
#[derive(Clone, Debug)]
pub(super) struct Square<S> {
    columns: Vec<[S; 4]>,
    groups: usize,
}

impl<S: Lane> Square<S> {
    /// Zero.
    pub(super) fn new(order: usize) -> Square<S> {
        let groups = order.div_ceil(4);
        Square { columns: vec![[S::from(0.0); 4]; groups * order], groups }
    }

    /// The entry in a row and a column.
    pub(super) fn entry(&mut self, row: usize, column: usize) -> &mut S {
        &mut self.columns[column * self.groups + row / 4][row % 4]
    }

    /// All entries zero in one lane.
    pub(super) fn clear(&mut self, lane: usize) {
        self.columns.as_flattened_mut().iter_mut().for_each(|entry| entry.set_lane(lane, 0.0));
    }

    /// The product with a vector; what fills its last group up is zero.
    #[inline(always)]
    pub(super) fn times(&self, vector: &[S], product: &mut [[S; 4]]) {
        for (group, product) in product.iter_mut().enumerate().take(self.groups) {
            let mut sums = [S::from(0.0); 4];
            for (rows, &factor) in self.columns.iter().skip(group).step_by(self.groups).zip(vector) {
                for (sum, &entry) in sums.iter_mut().zip(rows) {
                    *sum = *sum + entry * factor;
                }
            }
            *product = sums;
        }
    }
}
