//! Verification that every plant of a family satisfies every specification at every required
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

/// Results for one specification.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecificationFinding {
    /// Limited closed loop and limits.
    pub requirement: Requirement,
    /// Verdict on the specification.
    pub verdict: Verdict,
    /// Evidence for the verdict.
    pub evidence: Evidence,
    /// The worst margin over the band and the family; `None` if there is no basis for a verdict.
    pub worst: Option<SpecificationMargin>,
    /// The worst minimum of the margin of one plant inside the band, if the worst margin is at an
    /// end of the band: the margin of the family may fall further towards that end.
    pub interior: Option<SpecificationMargin>,
    /// Other minima whose margin equals the worst to within 0.05 dB, the worst first: at another
    /// frequency, or with a plant elsewhere in the box.
    pub as_bad: Vec<SpecificationMargin>,
    /// Bands in which some examined plant violates it, with the worst case of each: other plants of
    /// a box may violate it slightly beyond.
    pub violations: Vec<ViolatedBand>,
    /// The worst margin of the family at each design frequency.
    pub at_design_frequencies: Vec<SpecificationMargin>,
    /// The worst margin over the family at each frequency of a grid, for plotting: (rad/s, dB).
    pub envelope: Vec<(f64, f64)>,
    /// Limitations of the examination; empty if there are none.
    pub remarks: Vec<Remark>,
}

impl SpecificationFinding {
    /// The worst margins: over the band, inside it, and in each violated band.
    pub fn worst_margins(&self) -> impl Iterator<Item = &SpecificationMargin> {
        let bands = self.violations.iter().map(|band| &band.worst);
        self.worst.iter().chain(&self.interior).chain(bands)
    }
}

/// Limitation of the verdict on a specification, or of the method.
#[derive(Clone, Debug, PartialEq)]
pub enum Remark {
    /// The band extends beyond pi/T, rad/s, above which a sampled loop has no frequencies.
    BandEndsAtNyquist {
        /// End of the band pi/T, rad/s.
        nyquist_rad_per_s: f64,
    },
    /// The table of a limit does not cover the band: there is no limit beyond it.
    TableEnds {
        /// Ends of the table, rad/s.
        table_rad_per_s: [f64; 2],
    },
    /// A lower limit extends to pi/T, where prefilter or controller have a zero: no lower limit can
    /// be met there.
    ZeroAtNyquist {
        /// End of the band pi/T, rad/s.
        nyquist_rad_per_s: f64,
    },
    /// There is no limit within the band.
    NothingDemanded,
    /// A design frequency is outside the band.
    DesignFrequencyOutside {
        /// The design frequency.
        frequency_rad_per_s: f64,
    },
    /// Tracking is assessed by the spread of |T|, without a prefilter; the worst case names both
    /// plants.
    JudgedBySpread,
    /// The response is interpolated between two frequencies of a measurement.
    Interpolated,
    /// The margin is that of the worst plant within the confidence discs of a measurement.
    WorstWithinDiscs,
    /// Some plants within the confidence discs violate the specification, and others do not.
    OpenWithinDiscs {
        /// Upper bound on the worst margin for every plant within the discs, dB.
        certain_margin_db: f64,
    },
    /// The band extends beyond the range in which every plant was measured.
    BeyondMeasurements {
        /// Range of the measurements, rad/s.
        measured_rad_per_s: [f64; 2],
    },
    /// A plant that cannot be sampled has no response that could be evaluated.
    NotSampled {
        /// Frequency at which this occurred, rad/s.
        frequency_rad_per_s: f64,
    },
    /// A plant has no response that could be evaluated.
    NoResponse {
        /// Frequency at which this occurred, rad/s.
        frequency_rad_per_s: f64,
        /// The plant, if known.
        plant: Option<PlantPoint>,
    },
    /// A plant inside the box, found in a search, cannot be evaluated.
    UndefinedInBox {
        /// Frequency at which this occurred, rad/s.
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
    /// Ends of the band, rad/s.
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
    /// Violation up to which a margin counts as met, dB.
    pub tolerance_db: f64,
    /// Stability of the family.
    pub stability: StabilityFinding,
    /// The additional delay that the family tolerates; `None` for an unstable one.
    pub delay_margin: Option<DelayMargin>,
    /// The specifications, in order.
    pub specifications: Vec<SpecificationFinding>,
}
