//! From a requirement in time to limits of tracking over frequency, and the actual response of
//! those limits in time.
//!
//! A wish (overshoot, settling time) becomes a second-order model, thesis (3.5) to (3.13), whose
//! magnitude limits |F L/(1+L)|. An extra zero lifts the upper limit, an extra pole lowers the
//! lower one, so that they part at high frequency (6.28, 6.29). Either changes the response in
//! time: the rules of thumb do not see it, the exact translation does, and every result says what
//! it reaches.
//!
//! A magnitude below the upper limit does not make a response that stays below the limit's own: the
//! translation is the custom of the method, not a theorem. What the loop does in time is simulated.

mod check;
mod spread;
mod step;
mod translation;

use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::range::RequiredRange;
use phea_dynamics::time_response::TimeResponseError;

pub use check::{Reached, WishCheck, WishOutcome, Wished, check_lower, check_upper};
pub use spread::{LimitOrder, TrackingSpread, tracking_spread};
pub use translation::{tracking_lower, tracking_upper};

/// The fastest acceptable response to a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UpperWish {
    /// Largest overshoot, percent of the step, from 0 up to but not 100.
    pub overshoot_percent: f64,
    /// Time after which it stays within the band, s.
    pub settling_time_s: f64,
    /// The band: plus or minus this percentage of the step.
    pub settling_band_percent: f64,
}

/// The slowest acceptable response to a step: it settles in time, without overshoot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowerWish {
    /// Time after which it stays within the band, s.
    pub settling_time_s: f64,
    /// The band: plus or minus this percentage of the step.
    pub settling_band_percent: f64,
}

/// The zero added to the upper limit, (s + z)/z, or the pole added to the lower, p/(s + p).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExtraRoot {
    /// None: both limits fall with 40 dB a decade.
    None,
    /// z or p itself.
    At {
        /// rad/s, positive.
        rad_per_s: f64,
    },
    /// z or p as a multiple of the natural frequency of the second-order model.
    Times {
        /// z/w_n or p/w_n, positive.
        natural_frequencies: f64,
    },
}

/// How a wish becomes damping ratio and natural frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Translation {
    /// By a rule of thumb, as if there were no extra root: (3.9) and (3.10) to (3.13).
    Rule(phea_dynamics::time_response::SettlingRule),
    /// Such that the response, extra root included, has the wanted overshoot and settling time.
    Exact,
}

/// A limit of tracking, and its response in time.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingLimit {
    /// B_U or B_L; its magnitude is the limit.
    pub function: TransferFunction,
    /// w_n of its second-order part, rad/s.
    pub natural_frequency_rad_per_s: f64,
    /// xi of its second-order part.
    pub damping_ratio: f64,
    /// z or p, rad/s.
    pub extra_root_rad_per_s: Option<f64>,
    /// Its response against the wish.
    pub check: WishCheck,
}

/// Why a wish has no limits, or a limit no response to check.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TimeDomainError {
    /// A number of a wish, or of a choice, outside its range.
    #[error("{what} is {value}; it must be {expected}")]
    OutOfRange {
        /// Name of the number.
        what: TimeDomainNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        expected: RequiredRange,
    },
    /// The rule of thumb stands for another band than the wish.
    #[error("the rule of thumb is for a band of {rule_percent} %, the wish for {wish_percent} %")]
    RuleBand {
        /// Band of the rule, percent.
        rule_percent: f64,
        /// Band of the wish, percent.
        wish_percent: f64,
    },
    /// With this extra root no natural frequency settles in time: the root itself is too slow.
    #[error(
        "with an extra root at {extra_root_rad_per_s} rad/s no natural frequency settles in {settling_time_s} s"
    )]
    ExtraRootTooSlow {
        /// z or p, rad/s.
        extra_root_rad_per_s: f64,
        /// The settling time wished, s.
        settling_time_s: f64,
    },
    /// Tables that have no frequency in common, or none in the band.
    #[error("there is no frequency of the band at which both limits are demanded")]
    NeverTogether,
    /// A sampled function where a limit is continuous.
    #[error("a limit of tracking is a continuous transfer function")]
    NotContinuous,
    /// The response to a step does not settle: there is a pole with this real part.
    #[error("the limit has a pole with real part {real_part}: its step response has no end to check")]
    NotStable {
        /// Real part of the pole, 1/s.
        real_part: f64,
    },
    /// So little damping that the response would have to be followed for too many periods.
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
