//! A sparse matrix by its entries.

use clarabel::algebra::CscMatrix;

/// Entries of a sparse matrix.
#[derive(Default)]
pub(super) struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    /// Adds one entry.
    pub(super) fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }

    /// The matrix of these entries.
    pub(super) fn matrix(self, rows: usize, columns: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, columns, self.rows, self.columns, self.values)
    }
}
