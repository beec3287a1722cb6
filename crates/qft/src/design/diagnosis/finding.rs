//! Findings on a problem before any search.

use num_complex::Complex64;

use crate::verification::{PlantPoint, SpecificationMargin};

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingSeverity {
    /// Proof that no controller meets the specifications.
    Impossible,
    /// Warning that the problem is hard, or probably not what was intended.
    Warning,
}

/// The point where T or S is independent of the controller, or where S + T = 1 is compared with the
/// limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConstraintPlace {
    /// A pole of P H in the right half plane, rad/s: T = 1 there.
    UnstablePole(Complex64),
    /// A zero of P H in the right half plane, rad/s: S = 1 there. In a sampled loop z = e^(sT) is a
    /// zero of the sampled plant.
    RightHalfPlaneZero(Complex64),
    /// A positive real s, rad/s; infinite for z = infinity in a sampled loop.
    Point(f64),
}

/// Greatest |S| and |T| that the limits allow at a point s of the right half plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// The point.
    pub place: ConstraintPlace,
    /// The plant.
    pub plant: PlantPoint,
    /// Dead time of plant, sensor and loop, with the samples of delay in a sampled loop, s.
    pub dead_time_s: f64,
    /// The greatest |S(s)| that the limits allow.
    pub sensitivity: f64,
    /// The greatest |T(s)| that the limits allow.
    pub complementary: f64,
    /// Frequency above which |T| must stay below 1 (at a pole), or up to which |S| must (at a
    /// zero), rad/s.
    pub crossover_rad_per_s: Option<f64>,
    /// The relevant specifications.
    pub specifications: Vec<usize>,
}

/// One limit with the specification that sets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SharedLimit {
    /// Index of the specification.
    pub specification: usize,
    /// The greatest |S| or |T| that it allows.
    pub limit: f64,
}

/// A fact about a problem, independent of any search.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// The lower tracking limit is above the upper one.
    CrossedLimits {
        /// Index of the specification.
        specification: usize,
        /// Frequency at which they cross most, rad/s.
        frequency_rad_per_s: f64,
        /// The lower limit there.
        lower: f64,
        /// The upper limit there.
        upper: f64,
        /// Least relaxation of both limits for which they meet, dB.
        relaxation_db: f64,
    },
    /// The limits allow only |S| + |T| < 1 at one frequency, although S + T = 1.
    SumBelowOne {
        /// Frequency at which the sum is least, rad/s.
        frequency_rad_per_s: f64,
        /// The plant.
        plant: PlantPoint,
        /// Remaining limit of |S|.
        sensitivity: SharedLimit,
        /// Remaining limit of |T|.
        complementary: SharedLimit,
        /// The least relaxation of every limit that suffices, dB.
        relaxation_db: f64,
    },
    /// The bounds at one design frequency together forbid every loop.
    Contradiction {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// Phase of the nominal loop where the contradiction is least, rad.
        phase_rad: f64,
        /// Gain of the nominal loop there.
        gain: f64,
        /// The margin of each specification in conflict there.
        conflicts: Vec<SpecificationMargin>,
        /// Lower and upper bound on the least relaxation of every limit that would allow a loop at
        /// this frequency, dB.
        relaxation_db: [f64; 2],
    },
    /// A pole of P H on the axis gives T = 1 there, which a limit forbids.
    PoleOnTheAxis {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// The plant.
        plant: PlantPoint,
        /// The limit of |T|.
        complementary: SharedLimit,
    },
    /// A zero of P on the axis gives S = 1 and F P G S = 0 there, which a limit forbids.
    ZeroOnTheAxis {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
        /// The plant.
        plant: PlantPoint,
        /// The specification, with its limit of |S|, or its lower tracking limit.
        limit: SharedLimit,
    },
    /// The limits allow only |S| + |T| < 1 at a point of the right half plane.
    RightHalfPlane {
        /// Remaining limits at the point.
        constraint: Constraint,
        /// The least relaxation of every limit that suffices at this point, dB; infinite if none
        /// does.
        relaxation_db: f64,
    },
    /// The gains of some plants differ in sign although every closed loop requires one sign.
    GainSign {
        /// 0 for the static gain, otherwise the unstable pole that the plants have in common,
        /// rad/s.
        pole_rad_per_s: f64,
        /// Two plants of different sign.
        plants: [PlantPoint; 2],
    },
    /// The required delay margin is larger than an unstable pole allows.
    DelayMargin {
        /// The pole, rad/s.
        pole_rad_per_s: f64,
        /// The plant.
        plant: PlantPoint,
        /// Required delay margin, s.
        demanded_s: f64,
        /// Greatest delay margin of any linear controller, 2/p, s.
        greatest_s: f64,
    },
    /// The limits force |S| or |T| to rise at least this far where it is not limited.
    ForcedPeak {
        /// Limits at the point, without the unlimited part of the axis.
        constraint: Constraint,
        /// The least peak, dB.
        peak_db: f64,
    },
    /// The plant can be stabilised only by an unstable controller.
    UnstableController {
        /// The plant.
        plant: PlantPoint,
        /// Zeros (the second may be infinite) between which there is an odd number of its real
        /// unstable poles, rad/s.
        between_zeros_rad_per_s: [f64; 2],
    },
    /// Design frequencies beyond the range of the loop or of a measurement: there are no data
    /// there.
    OutOfReach {
        /// Index of the specification.
        specification: usize,
        /// The first of these frequencies, rad/s.
        frequency_rad_per_s: f64,
        /// Range of the loop or the measurement, rad/s.
        reach_rad_per_s: [f64; 2],
        /// The measured plant; `None` if the sampling ends the band.
        plant: Option<PlantPoint>,
    },
    /// The tracking limits at zero frequency exclude 1: the output would not follow a constant
    /// reference.
    StaticGain {
        /// Index of the specification.
        specification: usize,
        /// The lower limit.
        lower: f64,
        /// The upper limit.
        upper: f64,
    },
}

impl Finding {
    /// Severity of the finding.
    pub fn severity(&self) -> FindingSeverity {
        match self {
            Finding::CrossedLimits { .. }
            | Finding::SumBelowOne { .. }
            | Finding::Contradiction { .. }
            | Finding::PoleOnTheAxis { .. }
            | Finding::ZeroOnTheAxis { .. }
            | Finding::RightHalfPlane { .. }
            | Finding::GainSign { .. }
            | Finding::DelayMargin { .. } => FindingSeverity::Impossible,
            Finding::ForcedPeak { .. }
            | Finding::UnstableController { .. }
            | Finding::OutOfReach { .. }
            | Finding::StaticGain { .. } => FindingSeverity::Warning,
        }
    }

    /// Indices of the specifications concerned, in increasing order.
    pub fn specifications(&self) -> Vec<usize> {
        let mut all = match self {
            Finding::SumBelowOne { sensitivity, complementary, .. } => {
                vec![sensitivity.specification, complementary.specification]
            }
            Finding::Contradiction { conflicts, .. } => {
                conflicts.iter().map(|margin| margin.specification).collect()
            }
            Finding::PoleOnTheAxis { complementary: limit, .. } | Finding::ZeroOnTheAxis { limit, .. } => {
                vec![limit.specification]
            }
            Finding::RightHalfPlane { constraint, .. } | Finding::ForcedPeak { constraint, .. } => {
                constraint.specifications.clone()
            }
            Finding::CrossedLimits { specification, .. }
            | Finding::OutOfReach { specification, .. }
            | Finding::StaticGain { specification, .. } => vec![*specification],
            Finding::GainSign { .. } | Finding::DelayMargin { .. } | Finding::UnstableController { .. } => {
                Vec::new()
            }
        };
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The least common relaxation of all limits below which no design can meet them, dB: a lower
    /// bound on the relaxation of a design. `None` where no relaxation helps or none is needed.
    pub fn relaxation_db(&self) -> Option<f64> {
        match self {
            Finding::CrossedLimits { relaxation_db, .. }
            | Finding::SumBelowOne { relaxation_db, .. }
            | Finding::RightHalfPlane { relaxation_db, .. } => Some(*relaxation_db),
            Finding::Contradiction { relaxation_db, .. } => Some(relaxation_db[0]),
            Finding::PoleOnTheAxis { complementary: limit, .. } | Finding::ZeroOnTheAxis { limit, .. } => {
                (limit.limit < 1.0).then(|| -20.0 * phea_dynamics::portable::log10(limit.limit))
            }
            _ => None,
        }
        .filter(|relaxation| relaxation.is_finite())
    }
}
