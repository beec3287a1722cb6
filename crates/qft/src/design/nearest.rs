//! The attempts that came nearest to what is required, for a relaxation of the limits.

use super::attempt::Attempt;
use super::queue::WaitingStructure;

/// Most attempts that are relaxed: a search finds how near a structure comes, and counterexamples
/// how far that was from the truth.
const RELAXED_MAXIMUM: usize = 2;

/// An attempt that missed.
#[derive(Debug)]
pub(super) struct NearAttempt {
    /// Its worst margin over rate.
    worst_margin_db: f64,
    pub(super) structure: WaitingStructure,
    pub(super) attempt: Box<Attempt>,
}

/// The nearest attempts, the nearest first.
#[derive(Debug, Default)]
pub(super) struct NearestAttempts {
    each: Vec<NearAttempt>,
}

impl NearestAttempts {
    /// Takes in an attempt that missed with this worst margin.
    pub(super) fn push(&mut self, worst_margin_db: f64, structure: WaitingStructure, attempt: Attempt) {
        let place = self.each.iter().take_while(|one| one.worst_margin_db >= worst_margin_db).count();
        self.each.insert(place, NearAttempt { worst_margin_db, structure, attempt: Box::new(attempt) });
        self.each.truncate(RELAXED_MAXIMUM);
    }

    /// True where one may need less relaxation than this, dB.
    pub(super) fn may_need_less(&self, relaxation_db: f64) -> bool {
        self.each.first().is_some_and(|one| -one.worst_margin_db < relaxation_db)
    }

    /// The nearest one.
    pub(super) fn take(&mut self) -> Option<NearAttempt> {
        (!self.each.is_empty()).then(|| self.each.remove(0))
    }

    /// The attempt that is stopped, or the nearest before it if that came nearer.
    pub(super) fn nearer_than(&mut self, mut stopped: Attempt) -> Attempt {
        let reached_db = stopped.worst_margin_db().unwrap_or(f64::NEG_INFINITY);
        match self.take() {
            Some(nearest) if nearest.worst_margin_db > reached_db => *nearest.attempt,
            _ => stopped,
        }
    }
}
