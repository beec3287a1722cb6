//! Bounds: regions where the nominal loop L0 may not be, so that every plant of a template
//! satisfies a specification.

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
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Phases of L0, increasing, within [-2 pi, 0], rad.
    pub phases_rad: Vec<f64>,
    /// Forbidden gains |L0| at each phase.
    pub forbidden: Vec<GainIntervals>,
}

/// The points of a template that count as plants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TemplateFill {
    /// Only the plants. If they are sparse, the regions forbidden by neighbours do not overlap, and
    /// spurious allowed islands appear between them.
    Points,
    /// The plants, every point of the outlines, and the regions that the outlines enclose. A side
    /// of an outline is taken as straight in P0/P (in P for the control effort); between neighbours
    /// half a decibel and two degrees apart, any other curve differs by less than 0.01 dB.
    Filled,
}

/// Reason why there is no bound.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BoundError {
    /// A template without plants.
    #[error("the template at {frequency_rad_per_s} rad/s has no plants")]
    NoPlants {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// A nominal response that is zero or not finite.
    #[error("the nominal plant has no response at {frequency_rad_per_s} rad/s that could be shaped")]
    Nominal {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// A plant whose response, sensor or load-motion path is zero or not finite.
    #[error(
        "plant {index} of the template at {frequency_rad_per_s} rad/s has a response that is zero or not finite"
    )]
    Response {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Index of the plant, or of the corner of an outline, from 0.
        index: usize,
    },
    /// A limit given as a table that does not cover the frequency.
    #[error("the limit is not given at {frequency_rad_per_s} rad/s")]
    NoLimit {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// A limit that is not a valid magnitude; for tracking, the quotient of the upper and lower
    /// limits.
    #[error("the limit at {frequency_rad_per_s} rad/s is {limit}")]
    Limit {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// The limit.
        limit: f64,
    },
}
