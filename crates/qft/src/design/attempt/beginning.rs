//! The starting points of a search, and how widely it looks.

use crate::loop_shaping::{Aim, DescentOptions, SearchOptions, SearchProblem, Shaping};

/// Largest number of points that stabilise the nominal plant with which a search begins.
const STABILISING_MAXIMUM: usize = 24;

/// Points that a search evaluates before those that are spread over the bounds.
#[derive(Clone, Debug, Default)]
pub(in crate::design) struct StartingPoints {
    /// What a simpler controller does.
    pub(in crate::design) simpler: Vec<Vec<f64>>,
    /// What stabilises the nominal plant.
    pub(in crate::design) stabilising: Vec<Vec<f64>>,
    /// How widely is searched.
    pub(in crate::design) effort: SearchEffort,
}

/// How widely a search looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::design) enum SearchEffort {
    /// One descent to its end, for a structure that is looked at only because it may be far better
    /// than one that is met.
    Least,
    /// Few starts, for a structure of few numbers.
    Small,
    #[default]
    Usual,
    /// Many starts, for plants that are hard to stabilise.
    Great,
}

impl SearchEffort {
    /// For the same structure with more plants: the first search has shown where optima lie.
    pub(in crate::design) fn again(self) -> SearchEffort {
        match self {
            SearchEffort::Usual => SearchEffort::Small,
            other => other,
        }
    }
}

/// The best of these points: those that stabilise every plant by their worst margin, then the
/// others by how far from it they are.
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

/// The gain is scanned, because hardly any gain suits a random shape. More descents are completed
/// for a relaxation, whose result is a number, and for a plant that is hard to stabilise, which has
/// many local optima.
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
