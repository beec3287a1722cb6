//! Interface of a search to a problem: an objective, margins that must not be negative, and their
//! slopes.

/// Aim of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The greatest common margin: the x that maximises t subject to `margin >= rate t` for every
    /// margin.
    WorstMargin,
    /// The least objective among the x whose margins are all at least zero.
    Objective,
}

/// Evaluation of a point, without slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// The objective, dB.
    pub objective_db: f64,
    /// The least of margin over rate, dB.
    pub worst_margin_db: f64,
    /// True if every plant of the samples is stable; margins of an unstable loop are meaningless.
    pub stable: bool,
    /// Measure of instability, 0 if stable, greater for worse; only its order counts. It may be 0
    /// if unknown.
    pub instability: f64,
}

impl Judgement {
    /// Judgement of a controller that has no response.
    pub(crate) const UNUSABLE: Judgement = Judgement {
        objective_db: f64::INFINITY,
        worst_margin_db: f64::NEG_INFINITY,
        stable: false,
        instability: f64::INFINITY,
    };
}

/// One margin with its slopes.
#[derive(Clone, Debug, PartialEq)]
pub struct MarginRow {
    /// Identifies the margin (a specification at a frequency for a plant), so that a search
    /// recognises it at another x.
    pub sample: usize,
    /// Margin, dB; negative if it is violated.
    pub margin_db: f64,
    /// Increase of the margin per dB of relaxation of every limit: 1, or 2 for the spread between
    /// two limits.
    pub rate: f64,
    /// Slopes, dB per unit of x.
    pub slopes: Vec<f64>,
}

/// A point with the slopes of its objective and of the margins that may matter nearby.
#[derive(Clone, Debug, PartialEq)]
pub struct Slopes {
    /// The objective, dB.
    pub objective_db: f64,
    /// Slopes of the objective, dB per unit of x.
    pub objective_slopes: Vec<f64>,
    /// The margins near the worst one of each specification and frequency; all others are larger.
    pub margins: Vec<MarginRow>,
}

/// A problem that can be searched: the shaping of a loop, the fit of a prefilter.
pub trait SearchProblem {
    /// Least and greatest value of each x.
    fn bounds(&self) -> &[[f64; 2]];

    /// Evaluates a point, including stability.
    fn judge(&mut self, x: &[f64]) -> Judgement;

    /// The slopes at a point.
    fn slopes(&mut self, x: &[f64]) -> Slopes;
}
