//! The prefilter: the band that the closed loop leaves for it, and the prefilter of least order
//! within that band (thesis 3.1.5).
//!
//! The controller determines the spread of the plants of a family, the prefilter its position. At
//! each frequency
//!
//! ```text
//! lower/min|T| <= |F| <= upper/max|T|,      T = P G/(1+L)          over the family, so that lower <= |F T| <= upper (3.18)
//! ```
//!
//! is the only condition on F: a band for its magnitude. If the band has no width, no prefilter of
//! any order satisfies it, and the two conflicting plants are identified. Otherwise a stable
//! minimum-phase F is fitted into it.

mod band;
mod ends;
mod extremes;
mod fit;
mod margin;
mod structures;
mod synthesis;

pub use band::{PrefilterBand, PrefilterBandPoint};
pub use extremes::{TrackingExtremes, tracking_extremes};
pub use fit::PrefilterFit;
pub use margin::{BandEdge, PrefilterMargin};
pub use synthesis::{FittedPrefilter, PrefilterOptions, PrefilterOutcome, fit_prefilter};

use phea_dynamics::linear::LinearError;
use phea_dynamics::watch::Stopped;

/// Reason why there is no band for a prefilter, or no search in it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrefilterError {
    /// A specification that the prefilter does not affect.
    #[error("only tracking leaves a band for a prefilter")]
    NotTracking,
    /// A family without members.
    #[error("a family without members leaves no band")]
    NoMember,
    /// All frequencies are outside the band of the tracking limits.
    #[error("tracking is demanded at none of the frequencies")]
    NoFrequency,
    /// The closed loop of a member could not be evaluated.
    #[error("the closed loop of member {member} has no value at {frequency_rad_per_s} rad/s")]
    NoResponse {
        /// Index of the member.
        member: usize,
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// A prefilter that cannot be sampled by the rule of the loop.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// The watch stopped the synthesis.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}
