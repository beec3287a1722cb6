//! What a descent ends with.

use crate::loop_shaping::search::Judgement;

/// Why a descent ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DescentStatus {
    /// No small step gains more than the tolerance, and no margin misses its reserve by more: a
    /// local optimum.
    Converged,
    /// No small step brings the worst margin nearer to the reserve, dB: a local optimum of the
    /// worst margin.
    Infeasible {
        /// The worst margin there.
        worst_margin_db: f64,
    },
    /// Only steps smaller than this gain anything, and less than was predicted: there is a kink, or
    /// the slopes do not match the margins.
    TrustRegionTooSmall {
        /// Size of the last step that was tried, in units of x.
        radius: f64,
    },
    /// The steps allowed were made.
    BudgetSpent {
        /// How many.
        steps: usize,
    },
    /// The subproblem had no usable answer several times in succession.
    NoStep {
        /// The penalty then, dB for each dB.
        penalty: f64,
    },
    /// The start is not stable, or has margins that are NaN.
    StartUnusable,
    /// The start lies outside of the bounds.
    StartOutside,
}

/// Where a descent ended.
#[derive(Clone, Debug, PartialEq)]
pub struct DescentResult {
    /// x
    pub x: Vec<f64>,
    /// Its judgement; `None` for a start outside of the bounds.
    pub judgement: Option<Judgement>,
    /// Why it ended there.
    pub status: DescentStatus,
    /// The margins that limited the last step, the strongest first.
    pub binding: Vec<Binding>,
    /// Work done.
    pub work: DescentWork,
}

/// Work done: counts, not times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DescentWork {
    /// Points judged.
    pub judgements: usize,
    /// Points at which slopes were taken.
    pub slopes: usize,
    /// Convex subproblems solved.
    pub subproblems: usize,
}

impl std::ops::Add for DescentWork {
    type Output = DescentWork;

    fn add(self, other: DescentWork) -> DescentWork {
        DescentWork {
            judgements: self.judgements + other.judgements,
            slopes: self.slopes + other.slopes,
            subproblems: self.subproblems + other.subproblems,
        }
    }
}

/// A margin that limits a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binding {
    /// Its [`MarginRow::sample`](crate::loop_shaping::MarginRow::sample).
    pub sample: usize,
    /// What one dB more of this margin would gain: dB of the objective, or of the common margin.
    pub multiplier: f64,
}
