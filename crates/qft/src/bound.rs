//! Bounds: where the nominal loop L0 may not be, so that every plant of a template keeps to a specification.

mod ceiling;
mod combined;
mod covering;
mod fill;
mod function;
mod hull;
mod inequality;
mod interval;
mod leaf;
mod phases;
mod power_of_two;
mod quadratic;
mod rule;
mod tree;

pub use combined::{Collision, CombinedBound, Feasibility, FrequencyBounds, Placement, SpecificationBound};
pub use function::BoundFunction;
pub use interval::GainIntervals;
pub use phases::PhaseGrid;

/// A bound at one frequency: for each phase of the nominal loop, the gains |L0| that are forbidden.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// rad/s
    pub frequency_rad_per_s: f64,
    /// Phases of L0, increasing, within [-2 pi, 0], rad.
    pub phases_rad: Vec<f64>,
    /// Forbidden gains |L0| at each phase.
    pub forbidden: Vec<GainIntervals>,
}

/// What of a template counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TemplateFill {
    /// Its plants alone. Where they are sparse, the regions that neighbours forbid do not overlap, and islands seem allowed between them.
    Points,
    /// Its plants, every point of its outlines, and what these enclose. A side of an outline is taken as straight in P0/P (for the control effort
    /// in P), which between neighbours half a decibel and two degrees apart is within 0.01 dB of any other way to join them.
    Filled,
}

/// Why there is no bound.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoundError {
    /// A template without plants.
    #[error("the template at {frequency_rad_per_s} rad/s has no plants")]
    NoPlants {
        /// rad/s
        frequency_rad_per_s: f64,
    },
    /// A nominal response that is zero or not finite.
    #[error("the nominal plant has no response at {frequency_rad_per_s} rad/s that could be shaped")]
    Nominal {
        /// rad/s
        frequency_rad_per_s: f64,
    },
    /// A plant whose response, sensor or load-motion path is zero or not finite.
    #[error(
        "plant {index} of the template at {frequency_rad_per_s} rad/s has a response that is zero or not finite"
    )]
    Response {
        /// rad/s
        frequency_rad_per_s: f64,
        /// Index of the plant, or of the corner of an outline, from 0.
        index: usize,
    },
    /// A limit given as a table that does not reach.
    #[error("the limit is not given at {frequency_rad_per_s} rad/s")]
    NoLimit {
        /// rad/s
        frequency_rad_per_s: f64,
    },
    /// A limit that is no magnitude; for tracking the quotient of upper and lower.
    #[error("the limit at {frequency_rad_per_s} rad/s is {limit}")]
    Limit {
        /// rad/s
        frequency_rad_per_s: f64,
        /// The limit.
        limit: f64,
    },
}
