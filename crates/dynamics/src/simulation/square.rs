//! Square matrices whose product with a vector is computed four rows at a time.

use super::Lane;

/// Square matrix column by column, each column in groups of four rows, the last padded with zeros.
///
/// ```text
/// A x = sum over j of a_j x_j          a_j the columns: four sums in parallel; row by row, each sum would depend on itself
/// ```
#[derive(Clone, Debug)]
pub(super) struct Square<S> {
    columns: Vec<[S; 4]>,
    groups: usize,
}

impl<S: Lane> Square<S> {
    /// Zero matrix.
    pub(super) fn new(order: usize) -> Square<S> {
        let groups = order.div_ceil(4);
        Square { columns: vec![[S::from(0.0); 4]; groups * order], groups }
    }

    /// Entry in a row and a column.
    pub(super) fn entry(&mut self, row: usize, column: usize) -> &mut S {
        &mut self.columns[column * self.groups + row / 4][row % 4]
    }

    /// Sets all entries of one lane to zero.
    pub(super) fn clear(&mut self, lane: usize) {
        self.columns.as_flattened_mut().iter_mut().for_each(|entry| entry.set_lane(lane, 0.0));
    }

    /// Product with a vector; the padding of its last group is zero.
    #[inline(always)]
    pub(super) fn times(&self, vector: &[S], product: &mut [[S; 4]]) {
        let parts = product[..self.groups].chunks_mut(4).enumerate();
        for (part, product) in parts {
            match product.len() {
                1 => self.groups_times::<1>(4 * part, vector, product),
                2 => self.groups_times::<2>(4 * part, vector, product),
                3 => self.groups_times::<3>(4 * part, vector, product),
                _ => self.groups_times::<4>(4 * part, vector, product),
            }
        }
    }

    /// Given number of row groups of the product: their sums stay in registers.
    #[inline(always)]
    fn groups_times<const GROUPS: usize>(&self, first: usize, vector: &[S], product: &mut [[S; 4]]) {
        let mut sums = [[S::from(0.0); 4]; GROUPS];
        for (column, &factor) in self.columns.chunks_exact(self.groups).zip(vector) {
            for (sums, group) in sums.iter_mut().zip(&column[first..first + GROUPS]) {
                for (sum, &entry) in sums.iter_mut().zip(group) {
                    *sum = *sum + entry * factor;
                }
            }
        }
        for (product, sums) in product.iter_mut().zip(&sums) {
            *product = *sums;
        }
    }
}

impl Square<f64> {
    /// Number of rows.
    pub(super) fn order(&self) -> usize {
        self.columns.len() / self.groups.max(1)
    }

    /// All entries, including the padding zeros.
    #[inline(always)]
    pub(super) fn entries(&self) -> impl Iterator<Item = &f64> {
        self.columns.as_flattened().iter()
    }

    /// All entries, mutable; the padding must stay zero.
    #[inline(always)]
    pub(super) fn entries_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.columns.as_flattened_mut().iter_mut()
    }

    pub(super) fn is_finite(&self) -> bool {
        self.entries().all(|entry| entry.is_finite())
    }

    /// Adds a multiple of the identity.
    #[inline(always)]
    pub(super) fn add_identity(&mut self, factor: f64) {
        let step = 4 * self.groups + 1;
        self.entries_mut().step_by(step).for_each(|entry| *entry += factor);
    }

    /// Largest sum of magnitudes in a row.
    #[inline(always)]
    pub(super) fn largest_row_sum(&self) -> f64 {
        let row = |row: usize| -> f64 {
            let columns = self.columns.as_flattened().chunks_exact(4 * self.groups);
            columns.map(|column| column[row].abs()).sum()
        };
        (0..self.order()).map(row).fold(0.0, f64::max)
    }

    /// Product with another matrix of equal order, on its right: column by column.
    #[inline(always)]
    pub(super) fn after(&self, other: &Square<f64>) -> Square<f64> {
        let mut product = Square::new(self.order());
        let groups = self.groups.max(1);
        let columns = other.columns.chunks_exact(groups);
        for (product, column) in product.columns.chunks_exact_mut(groups).zip(columns) {
            self.times(column.as_flattened(), product);
        }
        product
    }
}
