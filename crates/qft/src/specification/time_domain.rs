//! Tracking limits over frequency from requirements in time, and the actual response of those
//! limits in time.
//!
//! A requirement in time (overshoot, settling time) becomes a second-order model, thesis (3.5) to
//! (3.13), whose magnitude limits |F L/(1+L)|. An extra zero lifts the upper limit, an extra pole
//! lowers the lower one, so that they diverge at high frequency (6.28, 6.29). Either root changes
//! the response in time: the rules of thumb ignore this, the exact translation accounts for it, and
//! every result reports the values reached.
//!
//! A magnitude below the upper limit does not guarantee a response below that of the limit: the
//! translation is customary in the method, not a theorem. The behaviour of the loop in time is
//! simulated.

mod check;
mod spread;
mod step;
mod translation;

use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::range::RequiredRange;
use phea_dynamics::time_response::TimeResponseError;

pub use check::{Reached, RequiredResponse, RequirementCheck, RequirementOutcome, check_lower, check_upper};
pub use spread::{LimitOrder, TrackingSpread, tracking_spread};
pub use translation::{tracking_lower, tracking_upper};

/// The fastest acceptable response to a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UpperStepRequirement {
    /// Largest overshoot, percent of the step, from 0 to below 100.
    pub overshoot_percent: f64,
    /// Time after which the response stays within the band, s.
    pub settling_time_s: f64,
    /// The settling band: plus or minus this percentage of the step.
    pub settling_band_percent: f64,
}

/// The slowest acceptable response to a step: it settles in time, without overshoot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowerStepRequirement {
    /// Time after which the response stays within the band, s.
    pub settling_time_s: f64,
    /// The settling band: plus or minus this percentage of the step.
    pub settling_band_percent: f64,
}

/// The zero added to the upper limit, (s + z)/z, or the pole added to the lower, p/(s + p).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExtraRoot {
    /// Absence of an extra root: both limits fall at 40 dB per decade.
    None,
    /// Root at a given z or p.
    At {
        /// Root z or p, positive, rad/s.
        rad_per_s: f64,
    },
    /// Root z or p as a multiple of the natural frequency of the second-order model.
    Times {
        /// Ratio z/w_n or p/w_n, positive.
        natural_frequencies: f64,
    },
}

/// Translation of a requirement in time to damping ratio and natural frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Translation {
    /// Rule of thumb, as if there were no extra root: (3.9) and (3.10) to (3.13).
    Rule(phea_dynamics::time_response::SettlingRule),
    /// Exact translation: the response, including the extra root, has the required overshoot and
    /// settling time.
    Exact,
}

/// A tracking limit, and its response in time.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingLimit {
    /// Function B_U or B_L; its magnitude is the limit.
    pub function: TransferFunction,
    /// Natural frequency w_n of its second-order part, rad/s.
    pub natural_frequency_rad_per_s: f64,
    /// Damping ratio xi of its second-order part.
    pub damping_ratio: f64,
    /// Extra root z or p, rad/s.
    pub extra_root_rad_per_s: Option<f64>,
    /// Comparison of its response with the requirement.
    pub check: RequirementCheck,
}

/// Reason why a requirement has no limits, or a limit no response to check.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TimeDomainError {
    /// A number of a requirement, or of an option, outside its range.
    #[error("{what} is {value}; it must be {expected}")]
    OutOfRange {
        /// Name of the number.
        what: TimeDomainNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        expected: RequiredRange,
    },
    /// The rule of thumb applies to a band other than that of the requirement.
    #[error("the rule of thumb is for a band of {rule_percent} %, the requirement for {required_percent} %")]
    RuleBand {
        /// Band of the rule, percent.
        rule_percent: f64,
        /// Band of the requirement, percent.
        required_percent: f64,
    },
    /// Extra root so slow that no natural frequency settles in time.
    #[error(
        "with an extra root at {extra_root_rad_per_s} rad/s no natural frequency settles in {settling_time_s} s"
    )]
    ExtraRootTooSlow {
        /// Extra root z or p, rad/s.
        extra_root_rad_per_s: f64,
        /// The required settling time, s.
        settling_time_s: f64,
    },
    /// Tables without a common frequency, or none in the band.
    #[error("there is no frequency of the band at which both limits are demanded")]
    NeverTogether,
    /// A sampled function for a limit, which must be continuous.
    #[error("a limit of tracking is a continuous transfer function")]
    NotContinuous,
    /// The response to a step does not settle: there is a pole with this real part.
    #[error("the limit has a pole with real part {real_part}: its step response has no end to check")]
    NotStable {
        /// Real part of the pole, 1/s.
        real_part: f64,
    },
    /// Damping so low that the response would have to be computed for too many periods.
    #[error("the limit rings with a damping ratio of {damping_ratio}: too long to be followed")]
    RingsTooLong {
        /// The least damping ratio among its poles.
        damping_ratio: f64,
    },
    /// The response cannot be computed.
    #[error(transparent)]
    Response(#[from] TimeResponseError),
    /// The transfer function cannot be formed.
    #[error(transparent)]
    Linear(#[from] LinearError),
}

/// Number of a requirement in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TimeDomainNumber {
    /// Extra zero or pole, rad/s.
    #[error("the extra root in rad/s")]
    ExtraRoot,
    /// Extra zero or pole, over the natural frequency.
    #[error("the extra root over the natural frequency")]
    ExtraRootRatio,
    /// Overshoot, percent.
    #[error("the overshoot in percent")]
    Overshoot,
    /// Settling time, s.
    #[error("the settling time in s")]
    SettlingTime,
    /// Settling band, percent.
    #[error("the settling band in percent")]
    SettlingBand,
    /// Lower end of a band, rad/s.
    #[error("the band in rad/s")]
    Band,
}
