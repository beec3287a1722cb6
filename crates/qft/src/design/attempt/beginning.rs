//! The starting points of a search, and its width.

use crate::loop_shaping::{Aim, DescentOptions, SearchOptions, SearchProblem, Shaping};

/// Largest number of starting points that stabilise the nominal plant.
const STABILISING_MAXIMUM: usize = 24;

/// Points that a search evaluates before those spread over the bounds.
#[derive(Clone, Debug, Default)]
pub(in crate::design) struct StartingPoints {
    /// Points equivalent to a simpler controller.
    pub(in crate::design) simpler: Vec<Vec<f64>>,
    /// Points that stabilise the nominal plant.
    pub(in crate::design) stabilising: Vec<Vec<f64>>,
    /// Width of the search.
    pub(in crate::design) effort: SearchEffort,
}

/// Width of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::design) enum SearchEffort {
    /// One descent to its end, for a structure that is examined only because it may be far better
    /// than a valid one.
    Least,
    /// Few starts, for a structure of few numbers.
    Small,
    #[default]
    Usual,
    /// Many starts, for plants that are hard to stabilise.
    Great,
}

impl SearchEffort {
    /// Effort for the same structure with more plants: the first search has shown where the optima
    /// are.
    pub(in crate::design) fn again(self) -> SearchEffort {
        match self {
            SearchEffort::Usual => SearchEffort::Small,
            other => other,
        }
    }
}

/// The best of these points: those that stabilise every plant by their worst margin, then the
/// others by their distance from stability.
pub(super) fn best_of(shaping: &mut Shaping, points: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut judged: Vec<((bool, f64), Vec<f64>)> = Vec::with_capacity(points.len());
    for x in points {
        let judgement = shaping.judge(&x);
        let badness = if judgement.stable { -judgement.worst_margin_db } else { judgement.instability };
        judged.push(((!judgement.stable, badness), x));
    }
    judged.sort_by(|(one, _), (other, _)| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
    judged.into_iter().map(|(_, x)| x).take(STABILISING_MAXIMUM).collect()
}

/// Options of a search. The gain is scanned, because few gains suit a random shape. More descents
/// are completed for a relaxation, whose result is a number, and for a plant that is hard to
/// stabilise, which has many local optima.
pub(super) fn search_options(aim: Aim, seed: u64, relaxes: bool, effort: SearchEffort) -> SearchOptions {
    let descent = DescentOptions { reserve_db: 0.0, ..DescentOptions::new(aim) };
    let (samples, starts, finished) = match (effort, relaxes) {
        (SearchEffort::Great, _) => (96, 16, 8),
        (SearchEffort::Least | SearchEffort::Small | SearchEffort::Usual, true) => (48, 12, 6),
        (SearchEffort::Usual, false) => (48, 8, 5),
        (SearchEffort::Small, false) => (24, 4, 3),
        (SearchEffort::Least, false) => (24, 4, 1),
    };
    SearchOptions { samples, scanned: 14, starts, finished, descent, ..SearchOptions::new(aim, seed) }
}
