//! Verification: whether every plant of a family satisfies every specification at every required
//! frequency.

mod asymptote;
mod audit;
mod criterion;
mod evaluator;
mod finding;
mod frequencies;
mod remark;
mod response;
mod scan;
mod search;
mod start;

pub(crate) use asymptote::{AxisEnd, tracking_ratio};
pub(crate) use audit::{AuditEffort, audit_among};
pub use audit::{AuditProblem, AuditWork, TOLERANCE_DB, TrackingJudgement, audit_specifications};

pub use crate::specification_margin::SpecificationMargin;
pub use crate::stability::{
    ClosestApproach, DelayMargin, SearchedInfinity, StabilityFinding, StabilityMethod, StabilityReason,
};
pub use crate::verdict::{Evidence, PlantPoint, Verdict};

use crate::specification::Requirement;

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
    pub worst: Option<SpecificationMargin>,
    /// The worst minimum that the margin of one plant has inside the band, where the worst one lies
    /// at an end of it: the margin of the family may fall further towards that end.
    pub interior: Option<SpecificationMargin>,
    /// Other minima whose margin is that of the worst to within 0.05 dB, the worst first: at
    /// another frequency, or with a plant elsewhere in the box.
    pub as_bad: Vec<SpecificationMargin>,
    /// Bands in which some plant that was examined violates it, with the worst case of each: others
    /// of a box may do so a little beyond.
    pub violations: Vec<ViolatedBand>,
    /// The worst margin of the family at each design frequency.
    pub at_design_frequencies: Vec<SpecificationMargin>,
    /// The worst margin over the family at each frequency of a grid, for drawing: (rad/s, dB).
    pub envelope: Vec<(f64, f64)>,
    /// What was not examined; empty if everything was.
    pub remarks: Vec<Remark>,
}

impl SpecificationFinding {
    /// The worst margins: over the band, inside of it, and of each violated band.
    pub fn worst_margins(&self) -> impl Iterator<Item = &SpecificationMargin> {
        let bands = self.violations.iter().map(|band| &band.worst);
        self.worst.iter().chain(&self.interior).chain(bands)
    }
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
    /// A lower limit reaches pi/T, where prefilter or controller have a zero: no lower limit can be
    /// met there.
    ZeroAtNyquist {
        /// pi/T
        nyquist_rad_per_s: f64,
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
    /// The margin is that of the worst plant within the confidence discs of a measurement.
    WorstWithinDiscs,
    /// Some plants within the confidence discs violate the specification, and others do not.
    OpenWithinDiscs {
        /// Worst margin that every plant within them has at most, dB.
        certain_margin_db: f64,
    },
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
    pub worst: SpecificationMargin,
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
