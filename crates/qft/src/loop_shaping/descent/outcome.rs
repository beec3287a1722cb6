//! Outcome of a descent.

use crate::loop_shaping::search::Judgement;

/// Final status of a descent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DescentStatus {
    /// Optimum: smaller steps gain less than the tolerance, and every margin satisfies its reserve
    /// within it; a local optimum.
    Converged,
    /// Local optimum of the worst margin: small steps do not bring it nearer to the reserve, dB.
    Infeasible {
        /// The worst margin at the end, dB.
        worst_margin_db: f64,
    },
    /// Only steps smaller than this improve the result, and by less than predicted: there is a
    /// kink, or the slopes do not match the margins.
    TrustRegionTooSmall {
        /// Size of the last step, in units of x.
        radius: f64,
    },
    /// The step budget is used up.
    BudgetSpent {
        /// Number of steps.
        steps: usize,
    },
    /// The subproblem had no usable solution several times in succession.
    NoStep {
        /// The final penalty, dB per dB.
        penalty: f64,
    },
    /// The start is not stable, or has margins that are NaN.
    StartUnusable,
    /// The start is outside the bounds.
    StartOutside,
}

/// End of a descent.
#[derive(Clone, Debug, PartialEq)]
pub struct DescentResult {
    /// Free numbers x.
    pub x: Vec<f64>,
    /// Evaluation of the end; `None` for a start outside the bounds.
    pub judgement: Option<Judgement>,
    /// Final status.
    pub status: DescentStatus,
    /// The margins that limited the last step, the strongest first.
    pub binding: Vec<Binding>,
    /// Work done.
    pub work: DescentWork,
}

/// Work done: counts, not times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DescentWork {
    /// Number of points evaluated.
    pub judgements: usize,
    /// Number of points at which slopes were computed.
    pub slopes: usize,
    /// Number of convex subproblems solved.
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
    /// Index [`MarginRow::sample`](crate::loop_shaping::MarginRow::sample) of the margin.
    pub sample: usize,
    /// Gain per dB of this margin: dB of the objective, or of the common margin.
    pub multiplier: f64,
}
