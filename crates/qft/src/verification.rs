//! Verification: whether every plant of a family satisfies every specification at every required
//! frequency.

mod asymptote;
mod audit;
mod criterion;
mod evaluator;
mod finding;
mod frequencies;
mod minimum;
mod remark;
mod response;
mod scan;
mod search;
mod start;

pub(crate) use asymptote::{AxisEnd, tracking_ratio};
pub use audit::{AuditProblem, AuditWork, TOLERANCE_DB, TrackingJudgement, audit_specifications};
pub(crate) use audit::{audit_among, corners};
pub(crate) use minimum::between;

use crate::family::{Extent, Family};
use crate::specification::Requirement;
use crate::stability::{Instability, Irresolution};

/// A verdict. `Met` means that the margin is not below the negative of the tolerance, wherever it
/// was evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every plant satisfies it.
    Met,
    /// At least one plant, named with its frequency, does not.
    Violated,
    /// It could not be resolved.
    NotProven,
}

/// What a verdict rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Evidence {
    /// The members, at the frequencies of a grid: nothing is claimed between them.
    Grid,
    /// The worst case was searched for continuously over the box and the band, and nothing worse
    /// was found; this is not a proof.
    Search,
    /// Proven for every plant and every frequency.
    Proof,
}

impl Evidence {
    /// The evidence for an audit of a family.
    fn of(family: &Family) -> Evidence {
        match family {
            Family::Uncertain(family) if family.extent() == Extent::Box => Evidence::Search,
            // given plants and measurements are examined one by one
            Family::Uncertain(_) | Family::Measured(_) => Evidence::Grid,
        }
    }
}

/// One plant of a family.
#[derive(Clone, Debug, PartialEq)]
pub enum PlantPoint {
    /// Parameter values, in the order of the uncertain plant.
    Parameters(Vec<f64>),
    /// Index of a measured plant.
    Measured(usize),
    /// Index of an additional plant of a design.
    Beside(usize),
}

/// A margin with the frequency and the plant at which it was found.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstCase {
    /// Limit over closed loop in dB; negative where it is violated.
    pub margin_db: f64,
    /// rad/s; zero or infinite for a limit.
    pub frequency_rad_per_s: f64,
    /// The plant.
    pub plant: PlantPoint,
    /// The second plant of a spread: `plant` has the greatest |T| there, this one the least.
    pub other: Option<PlantPoint>,
}

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
    /// How it was decided.
    pub reason: StabilityReason,
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

/// What was found about one specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationFinding {
    /// What was limited.
    pub requirement: Requirement,
    /// Whether it is met.
    pub verdict: Verdict,
    /// What the verdict rests on.
    pub evidence: Evidence,
    /// The worst margin over the band and the family; `None` where there is nothing by which to
    /// judge a specification.
    pub worst: Option<WorstCase>,
    /// The worst interior minimum of the margin, where the worst one lies at an end of the band.
    pub interior: Option<WorstCase>,
    /// Bands in which some plant violates it, with the worst case of each.
    pub violations: Vec<ViolatedBand>,
    /// The worst margin of the family at each design frequency.
    pub at_design_frequencies: Vec<WorstCase>,
    /// The worst margin over the family at each frequency of a grid, for drawing: (rad/s, dB).
    pub envelope: Vec<(f64, f64)>,
    /// What was not examined; empty if everything was.
    pub remarks: Vec<Remark>,
}

/// What the verdict on a specification leaves out, or how it was found.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// The band reaches beyond pi/T, in rad/s, above which a sampled loop has no frequencies.
    BandEndsAtNyquist {
        /// pi/T
        nyquist_rad_per_s: f64,
    },
    /// The table of a limit does not reach over the band: nothing is demanded beyond it.
    TableEnds {
        /// From and to.
        table_rad_per_s: [f64; 2],
    },
    /// There is no limit within the band.
    NothingDemanded,
    /// A design frequency lies outside of the band.
    DesignFrequencyOutside {
        /// The design frequency.
        frequency_rad_per_s: f64,
    },
    /// Judged by the spread of |T|, without a prefilter; the worst case has both its plants.
    JudgedBySpread,
    /// Between two frequencies of a measurement the response is interpolated.
    Interpolated,
    /// The band extends beyond the range in which every plant was measured.
    BeyondMeasurements {
        /// From and to.
        measured_rad_per_s: [f64; 2],
    },
    /// A plant that cannot be sampled has no response that could be judged.
    NotSampled {
        /// Where this was met.
        frequency_rad_per_s: f64,
    },
    /// A plant has no response that could be judged.
    NoResponse {
        /// Where this was met.
        frequency_rad_per_s: f64,
        /// The plant, where it is known.
        plant: Option<PlantPoint>,
    },
    /// A plant inside the box, found in a search, cannot be judged.
    UndefinedInBox {
        /// Where this was met.
        frequency_rad_per_s: f64,
    },
    /// The loop is unstable, so that it has no margin.
    Unstable,
    /// The loop is not known to be stable: its margins may not describe any response.
    StabilityNotKnown,
}

/// A band of frequencies in which a specification is violated.
#[derive(Clone, Debug, PartialEq)]
pub struct ViolatedBand {
    /// From and to, rad/s.
    pub band_rad_per_s: [f64; 2],
    /// The worst case within it.
    pub worst: WorstCase,
}

/// The audit of a controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Audit {
    /// `Violated` if the loop is unstable or a specification is violated; `Met` if all are met.
    pub verdict: Verdict,
    /// The weakest evidence that the verdict needs.
    pub evidence: Evidence,
    /// A margin of minus this much still counts as met, dB.
    pub tolerance_db: f64,
    /// Stability of the family.
    pub stability: StabilityFinding,
    /// The additional delay that the family tolerates; `None` for an unstable one.
    pub delay_margin: Option<DelayMargin>,
    /// The specifications, in order.
    pub specifications: Vec<SpecificationFinding>,
}
