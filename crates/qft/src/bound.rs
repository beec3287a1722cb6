//! Bounds: where the nominal loop L0 may not be, so that every plant of a template keeps to a specification.

mod interval;

pub use interval::GainIntervals;

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
