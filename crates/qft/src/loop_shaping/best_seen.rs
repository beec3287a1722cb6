//! The best point that a search evaluates, for a search that is stopped early.

use super::descent::is_usable;
use super::search::{Aim, Judgement, SearchProblem, Slopes};
use super::start::JudgedPoint;

/// The best stable point evaluated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BestSeen {
    aim: Aim,
    best: Option<JudgedPoint>,
}

/// A problem whose best stable point is remembered.
pub(super) struct SeenProblem<'a> {
    pub(super) problem: &'a mut dyn SearchProblem,
    pub(super) seen: &'a mut BestSeen,
}

impl BestSeen {
    pub(crate) fn new(aim: Aim) -> BestSeen {
        BestSeen { aim, best: None }
    }

    /// Free numbers x of the best stable point; `None` if none was evaluated.
    pub(crate) fn x(self) -> Option<Vec<f64>> {
        self.best.map(|best| best.x)
    }

    fn take(&mut self, point: JudgedPoint) {
        if self.best.as_ref().is_none_or(|best| point.is_better_than(best, self.aim)) {
            self.best = Some(point);
        }
    }

    /// Merges the best point of another search of this problem.
    pub(super) fn join(&mut self, other: BestSeen) {
        if let Some(point) = other.best {
            self.take(point);
        }
    }
}

impl SearchProblem for SeenProblem<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let judgement = self.problem.judge(x);
        if is_usable(&judgement) {
            self.seen.take(JudgedPoint { x: x.to_vec(), judgement });
        }
        judgement
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        self.problem.slopes(x)
    }
}
