//! What a search sees of a problem: an objective, margins that must not be negative, and their
//! slopes.

/// What a search is after.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The greatest common margin: x that maximises t where `margin >= rate t` for every margin.
    WorstMargin,
    /// The least objective among the x whose margins are all at least zero.
    Objective,
}

/// A point judged, without slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// The objective, dB.
    pub objective_db: f64,
    /// The least of margin over rate, dB.
    pub worst_margin_db: f64,
    /// Whether every plant of the samples is stable; margins of an unstable loop have no meaning.
    pub stable: bool,
    /// 0 where stable; otherwise a measure of instability, greater being worse, of which only the
    /// order counts. It may be 0 where it is not known.
    pub instability: f64,
}

impl Judgement {
    /// For a controller that has no response.
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
    /// dB; negative where it is violated.
    pub margin_db: f64,
    /// What one dB of relaxation of every limit adds to it: 1, and 2 for the spread between two
    /// limits.
    pub rate: f64,
    /// dB per unit of x.
    pub slopes: Vec<f64>,
}

/// A point with the slopes of its objective and of the margins that may matter nearby.
#[derive(Clone, Debug, PartialEq)]
pub struct Slopes {
    /// The objective, dB.
    pub objective_db: f64,
    /// dB per unit of x.
    pub objective_slopes: Vec<f64>,
    /// The margins near the worst one of each specification and frequency; all others are larger.
    pub margins: Vec<MarginRow>,
}

/// A problem that can be searched: the shaping of a loop, the fit of a prefilter.
pub trait SearchProblem {
    /// Least and greatest value of each x.
    fn bounds(&self) -> &[[f64; 2]];

    /// Judges a point, stability included.
    fn judge(&mut self, x: &[f64]) -> Judgement;

    /// The slopes at a point.
    fn slopes(&mut self, x: &[f64]) -> Slopes;
}
