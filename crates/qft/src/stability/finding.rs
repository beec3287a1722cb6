//! What is found about the stability of a family.

use super::{Instability, Irresolution};
use crate::verdict::{Evidence, PlantPoint, Verdict};

/// What was found about the stability of the family.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityFinding {
    /// `Met` when every plant is stable.
    pub verdict: Verdict,
    /// What the verdict rests on.
    pub evidence: Evidence,
    /// Largest real part of a closed-loop pole, 1/s (in a sampled loop ln|z|/T); `None` where the
    /// poles are not available (dead time, measurements).
    pub largest_real_part: Option<f64>,
    /// The plant that has it, or that is unstable, or that could not be resolved.
    pub plant: PlantPoint,
    /// How near the loops of the family come to -1; `None` unless it is stable.
    pub closest_approach: Option<ClosestApproach>,
    /// Where a search, and no enclosure, finds that no pole passes through infinity inside the box.
    pub infinity: Option<SearchedInfinity>,
    /// Bound of the relative change of 1 + L by modes beyond half the sampling rate, in a box of
    /// plants without polynomials: between those examined no margin is known any better.
    pub folding: Option<f64>,
    /// How it was decided.
    pub reason: StabilityReason,
}

/// The leading coefficients of the characteristic equation over a box, by a search: while they keep
/// their sign, no pole passes through infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchedInfinity {
    /// The least that was found, as a share of its value for the nominal plant.
    pub least_share: f64,
    /// The plant that has it.
    pub plant: PlantPoint,
    /// The parameters that move it, as their indices, the most important first.
    pub parameters: Vec<usize>,
}

/// How the stability of a family was decided.
#[derive(Clone, Debug, PartialEq)]
pub enum StabilityReason {
    /// All plants that were examined are stable.
    AllStable {
        /// How many of them are members.
        members: usize,
        /// How many are corners of the box.
        corners: usize,
        /// How many lie between these, because modes beyond half the sampling rate fold.
        between: usize,
        /// How each was judged.
        method: StabilityMethod,
        /// The smallest |1 + L| that was found.
        closest: Option<ClosestApproach>,
    },
    /// A plant is not.
    Unstable(Instability),
    /// The prefilter itself is not.
    UnstablePrefilter,
    /// It could not be resolved for one plant.
    NotResolved(Irresolution),
}

/// How the stability of a plant is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StabilityMethod {
    /// By the closed-loop poles.
    Poles,
    /// By the turns of the characteristic function.
    Turns,
    /// By Nyquist's count, 1 + L of the nominal plant enclosed from each frequency to the next.
    Enclosed,
    /// By Nyquist's count on points of the responses.
    Points,
    /// The same on the points of a measurement.
    MeasuredPoints,
}

/// The smallest |1 + L| over family and frequency, the inverse of the largest sensitivity.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosestApproach {
    /// |1 + L|
    pub distance: f64,
    /// rad/s; infinite where it is a limit.
    pub frequency_rad_per_s: f64,
    /// The plant.
    pub plant: PlantPoint,
}

/// The least dead time that makes a plant of the family unstable.
#[derive(Clone, Debug, PartialEq)]
pub struct DelayMargin {
    /// s, in addition to the delay that the loop already has; infinite if none does.
    pub delay_s: f64,
    /// The gain crossover where it happens, rad/s.
    pub frequency_rad_per_s: f64,
    /// The plant.
    pub plant: PlantPoint,
}
