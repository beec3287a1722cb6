//! The best point that a search judges, for a search that is stopped on its way.

use super::descent::is_usable;
use super::search::{Aim, Judgement, SearchProblem, Slopes};
use super::start::JudgedPoint;

/// A problem that remembers the best stable point it was asked to judge.
pub(crate) struct BestSeen<'a> {
    problem: &'a mut dyn SearchProblem,
    aim: Aim,
    best: Option<JudgedPoint>,
}

impl<'a> BestSeen<'a> {
    pub(crate) fn new(problem: &'a mut dyn SearchProblem, aim: Aim) -> BestSeen<'a> {
        BestSeen { problem, aim, best: None }
    }

    /// x of the best stable point; `None` if none was judged.
    pub(crate) fn x(self) -> Option<Vec<f64>> {
        self.best.map(|best| best.x)
    }
}

impl SearchProblem for BestSeen<'_> {
    fn bounds(&self) -> &[[f64; 2]] {
        self.problem.bounds()
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let judgement = self.problem.judge(x);
        if is_usable(&judgement) {
            let point = JudgedPoint { x: x.to_vec(), judgement };
            if self.best.as_ref().is_none_or(|best| point.is_better_than(best, self.aim)) {
                self.best = Some(point);
            }
        }
        judgement
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        self.problem.slopes(x)
    }
}
