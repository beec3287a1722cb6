//! A common fault of many rows.

use crate::project::RawFinding;

/// Largest number of rows with a common fault that are reported one by one.
const FEW: usize = 5;
/// Largest number of faults that are stored for reporting one by one.
const MOST_KEPT: usize = 400;

/// Rows of one fault, in a column or in the whole table.
#[derive(Clone, Default)]
pub(super) struct Faults {
    count: usize,
    first: Vec<RawFinding>,
}

impl Faults {
    /// Adds a row; the finding is made only if it is stored.
    pub(super) fn add(&mut self, found: impl FnOnce() -> RawFinding) {
        self.count += 1;
        if self.first.len() < MOST_KEPT {
            self.first.push(found());
        }
    }

    /// Findings: a single one if most rows have the fault.
    pub(super) fn finding(mut self, rows: usize) -> Vec<RawFinding> {
        if self.count > FEW && 2 * self.count > rows {
            self.first.truncate(1);
            return self.first.into_iter().map(|first| first.and_more(self.count)).collect();
        }
        self.first
    }
}
