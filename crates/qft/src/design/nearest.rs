//! The attempts that came nearest to the requirements, for a relaxation of the limits.

use super::attempt::Attempt;
use super::queue::QueuedStructure;

/// Largest number of attempts that are relaxed: a search estimates the deficit of a structure, and
/// counterexamples correct the estimate.
const RELAXED_MAXIMUM: usize = 2;

/// An attempt that missed.
#[derive(Debug)]
pub(super) struct NearAttempt {
    /// Worst margin over rate, dB.
    worst_margin_db: f64,
    pub(super) structure: QueuedStructure,
    pub(super) attempt: Box<Attempt>,
}

/// The nearest attempts, the nearest first.
#[derive(Debug, Default)]
pub(super) struct NearestAttempts {
    each: Vec<NearAttempt>,
}

impl NearestAttempts {
    /// Adds an attempt that missed with this worst margin.
    pub(super) fn push(&mut self, worst_margin_db: f64, structure: QueuedStructure, attempt: Attempt) {
        let place = self.each.iter().take_while(|one| one.worst_margin_db >= worst_margin_db).count();
        self.each.insert(place, NearAttempt { worst_margin_db, structure, attempt: Box::new(attempt) });
        self.each.truncate(RELAXED_MAXIMUM);
    }

    /// True if an attempt may need less relaxation than this, dB.
    pub(super) fn may_need_less(&self, relaxation_db: f64) -> bool {
        self.each.first().is_some_and(|one| -one.worst_margin_db < relaxation_db)
    }

    /// The nearest attempt.
    pub(super) fn take(&mut self) -> Option<NearAttempt> {
        (!self.each.is_empty()).then(|| self.each.remove(0))
    }

    /// The stopped attempt, or the nearest earlier one if that is nearer.
    pub(super) fn nearer_than(&mut self, mut stopped: Attempt) -> Attempt {
        let reached_db = stopped.worst_margin_db().unwrap_or(f64::NEG_INFINITY);
        match self.take() {
            Some(nearest) if nearest.worst_margin_db > reached_db => *nearest.attempt,
            _ => stopped,
        }
    }
}
