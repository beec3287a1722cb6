//! A problem given by formulae, with slopes by central differences.

use phea_dynamics::watch::unwatched;
use phea_qft::loop_shaping::{
    Aim, DescentOptions, DescentResult, DescentStatus, Judgement, MarginRow, SearchProblem, Slopes, descend,
};

type Objective = fn(&[f64]) -> f64;
type Margins = fn(&[f64]) -> Vec<f64>;

/// Step of the differences; their error is its square times a third derivative.
const STEP: f64 = 1e-5;

#[derive(Clone)]
pub(crate) struct Formula {
    pub(crate) bounds: Vec<[f64; 2]>,
    pub(crate) objective: Objective,
    pub(crate) margins: Margins,
    /// Measure of instability of a loop; if it is positive, margins are invalid.
    pub(crate) instability: Objective,
}

impl Formula {
    /// A problem that is stable everywhere.
    pub(crate) fn new(dimension: usize, objective: Objective, margins: Margins) -> Formula {
        Formula { bounds: vec![[-20.0, 20.0]; dimension], objective, margins, instability: |_| 0.0 }
    }
}

/// Change of a function for each unit of each coordinate.
pub(crate) fn differences<const N: usize>(of: impl Fn(&[f64]) -> [f64; N], x: &[f64]) -> Vec<[f64; N]> {
    let along = |coordinate: usize| {
        let at = |step: f64| {
            let mut moved = x.to_vec();
            moved[coordinate] += step;
            of(&moved)
        };
        let (up, down) = (at(STEP), at(-STEP));
        std::array::from_fn(|value| (up[value] - down[value]) / (2.0 * STEP))
    };
    (0..x.len()).map(along).collect()
}

impl SearchProblem for Formula {
    fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    fn judge(&mut self, x: &[f64]) -> Judgement {
        let instability = (self.instability)(x).max(0.0);
        let worst = (self.margins)(x).into_iter().fold(f64::INFINITY, f64::min);
        let worst_margin_db = if instability > 0.0 { 100.0 } else { worst };
        Judgement {
            objective_db: (self.objective)(x),
            worst_margin_db,
            stable: instability == 0.0,
            instability,
        }
    }

    fn slopes(&mut self, x: &[f64]) -> Slopes {
        assert!((self.instability)(x) <= 0.0, "slopes of an unstable point were asked for");
        let slopes = |of: &dyn Fn(&[f64]) -> f64| {
            differences(|x| [of(x)], x).into_iter().map(|[slope]| slope).collect::<Vec<f64>>()
        };
        let row = |(sample, margin_db): (usize, f64)| MarginRow {
            sample,
            margin_db,
            rate: 1.0,
            slopes: slopes(&|x| (self.margins)(x)[sample]),
        };
        Slopes {
            objective_db: (self.objective)(x),
            objective_slopes: slopes(&self.objective),
            margins: (self.margins)(x).into_iter().enumerate().map(row).collect(),
        }
    }
}

/// A descent to its end, from a start, without a reserve.
pub(crate) fn descended(problem: &mut Formula, start: &[f64], aim: Aim) -> DescentResult {
    let options = DescentOptions { reserve_db: 0.0, ..DescentOptions::new(aim) };
    descend(problem, start, options, &mut unwatched).unwrap()
}

/// Asserts that a descent converges to an objective, and that its margins hold.
#[track_caller]
pub(crate) fn check_objective(mut problem: Formula, start: &[f64], expected: f64) -> DescentResult {
    let descent = descended(&mut problem, start, Aim::Objective);
    let judgement = descent.judgement.unwrap();
    let found = judgement.objective_db;
    assert_eq!(descent.status, DescentStatus::Converged, "{descent:?}");
    assert!((found - expected).abs() < 1e-3, "{found} {expected} {:?}", descent.work);
    assert!(judgement.worst_margin_db > -1e-4, "{judgement:?}");
    descent
}
