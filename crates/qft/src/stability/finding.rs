//! Stability results of a family.

use super::{Instability, Irresolution};
use crate::verdict::{Evidence, PlantPoint, Verdict};

/// Stability results of the family.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityFinding {
    /// Verdict; `Met` if every plant is stable.
    pub verdict: Verdict,
    /// Evidence for the verdict.
    pub evidence: Evidence,
    /// Largest real part of a closed-loop pole, 1/s (in a sampled loop ln|z|/T); `None` if the
    /// poles are not available (dead time, measurements).
    pub largest_real_part: Option<f64>,
    /// The plant that has it, or that is unstable, or that could not be resolved.
    pub plant: PlantPoint,
    /// Closest approach of the family's loops to -1; `None` unless it is stable.
    pub closest_approach: Option<ClosestApproach>,
    /// Result of a search, instead of an enclosure, for poles that pass through infinity inside the
    /// box.
    pub infinity: Option<SearchedInfinity>,
    /// Bound on the relative change of 1 + L by modes beyond half the sampling rate, in a box of
    /// plants without polynomials: the margins between the examined plants have this uncertainty.
    pub folding: Option<f64>,
    /// Reason for the verdict.
    pub reason: StabilityReason,
}

/// The leading coefficients of the characteristic equation over a box, by a search: while they keep
/// their sign, no pole passes through infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchedInfinity {
    /// The least value found, as a fraction of its value for the nominal plant.
    pub least_fraction: f64,
    /// The plant that has it.
    pub plant: PlantPoint,
    /// The parameters that move it, as their indices, the most important first.
    pub parameters: Vec<usize>,
}

/// Reason for the verdict on the stability of a family.
#[derive(Clone, Debug, PartialEq)]
pub enum StabilityReason {
    /// All examined plants are stable.
    AllStable {
        /// Number of members.
        members: usize,
        /// Number of corners of the box.
        corners: usize,
        /// Number of plants between these, needed because modes beyond half the sampling rate fold.
        between: usize,
        /// Method used for each plant.
        method: StabilityMethod,
        /// The smallest |1 + L| found.
        closest: Option<ClosestApproach>,
    },
    /// A plant is unstable.
    Unstable(Instability),
    /// The prefilter itself is unstable.
    UnstablePrefilter,
    /// The stability of one plant could not be resolved.
    NotResolved(Irresolution),
}

/// Method of determining the stability of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StabilityMethod {
    /// Closed-loop poles.
    Poles,
    /// Turns of the characteristic function.
    Turns,
    /// Nyquist count, with 1 + L of the nominal plant enclosed between successive frequencies.
    Enclosed,
    /// Nyquist count on points of the responses.
    Points,
    /// Nyquist count on the points of a measurement.
    MeasuredPoints,
}

/// The smallest |1 + L| over family and frequency, the inverse of the largest sensitivity.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosestApproach {
    /// Distance |1 + L|.
    pub distance: f64,
    /// Frequency, rad/s; infinite for a limit.
    pub frequency_rad_per_s: f64,
    /// The plant.
    pub plant: PlantPoint,
}

/// The least dead time that makes a plant of the family unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct DelayMargin {
    /// Delay in addition to that of the loop, s; infinite if none does.
    pub delay_s: f64,
    /// The gain crossover where this happens, rad/s.
    pub frequency_rad_per_s: f64,
    /// The plant.
    pub plant: PlantPoint,
}
