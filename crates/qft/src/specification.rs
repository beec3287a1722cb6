//! Specifications: a closed-loop magnitude, its limit over frequency, the frequencies at which
//! bounds are drawn, and the band where it must hold.

mod limit;
mod margin;
mod time_domain;

use num_complex::Complex64;
use phea_dynamics::frequency::decibels;
use phea_dynamics::linear::LinearError;
use phea_dynamics::portable;

pub use limit::{Limit, LimitError, LimitTable};
pub use margin::{
    GuaranteedMargins, MarginError, MarginNumber, delay_margin_limit, guaranteed_margins,
    guaranteed_margins_of_robust_stability, guaranteed_margins_of_sensitivity,
    robust_stability_limit_for_gain_increase, robust_stability_limit_for_gain_reduction,
    robust_stability_limit_for_modulus_margin, robust_stability_limit_for_phase_margin,
    sensitivity_limit_for_gain_increase, sensitivity_limit_for_gain_reduction,
    sensitivity_limit_for_modulus_margin, sensitivity_limit_for_phase_margin,
};
pub use phea_dynamics::closed_loop::{ClosedLoop, LoopResponse};
pub use time_domain::{
    ExtraRoot, LimitOrder, LowerStepRequirement, Reached, RequiredResponse, RequirementCheck,
    RequirementOutcome, TimeDomainError, TrackingLimit, TrackingSpread, Translation, UpperStepRequirement,
    check_lower, check_upper, tracking_lower, tracking_spread, tracking_upper,
};

/// Closed loop that is limited, and its limits.
///
/// ```text
/// robust stability          |L/(1+L)|  <= limit              thesis (3.14), (6.30)
/// sensitivity               |1/(1+L)|  <= limit              thesis (3.15), (6.31)
/// plant input disturbance   |P/(1+L)|  <= limit              thesis (3.16)
/// control effort            |G/(1+L)|  <= limit              thesis (3.3), (3.17)
/// load motion               |Pd/(1+L)| <= limit
/// tracking         lower <= |F P G/(1+L)| <= upper           thesis (3.18), (6.32)
/// ```
///
/// L = P G H is the loop of plant P, controller G and sensor H; F is the prefilter, and Pd =
/// F_e/X_L the path of the load motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    closed_loop: ClosedLoop,
    /// Lower limit; only for tracking.
    lower: Option<Limit>,
    upper: Limit,
}

impl Requirement {
    /// Requirement that this closed loop is at most this large; for tracking, the lower limit is
    /// zero.
    pub fn at_most(closed_loop: ClosedLoop, upper: Limit) -> Requirement {
        let lower = (closed_loop == ClosedLoop::Tracking).then_some(Limit::Constant(0.0));
        Requirement { closed_loop, lower, upper }
    }

    /// Requirement that the response to the reference is between these limits.
    pub fn tracking(lower: Limit, upper: Limit) -> Requirement {
        Requirement { closed_loop: ClosedLoop::Tracking, lower: Some(lower), upper }
    }

    /// The limited closed loop.
    pub fn closed_loop(&self) -> ClosedLoop {
        self.closed_loop
    }

    /// True if it limits the response to the reference, the only requirement with a lower limit.
    pub fn is_tracking(&self) -> bool {
        self.closed_loop == ClosedLoop::Tracking
    }

    /// The lower limit, only for tracking, and the upper one.
    pub fn limits(&self) -> (Option<&Limit>, &Limit) {
        (self.lower.as_ref(), &self.upper)
    }

    /// Widens the requirement: an upper limit larger by a factor, and a lower one smaller by it.
    ///
    /// # Errors
    /// [`LinearError`] for a factor that is not finite.
    ///
    /// # Example
    /// ```
    /// use phea_qft::specification::{ClosedLoop, Limit, Requirement};
    /// let limit = Requirement::tracking(Limit::Constant(0.5), Limit::Constant(2.0));
    /// let wider = Requirement::tracking(Limit::Constant(0.25), Limit::Constant(4.0));
    /// assert_eq!(limit.wider(2.0)?, wider);
    /// # Ok::<(), phea_dynamics::linear::LinearError>(())
    /// ```
    pub fn wider(&self, factor: f64) -> Result<Requirement, LinearError> {
        Ok(Requirement {
            closed_loop: self.closed_loop,
            lower: self.lower.as_ref().map(|lower| lower.scaled(1.0 / factor)).transpose()?,
            upper: self.upper.scaled(factor)?,
        })
    }

    /// Reserve of a design to every limit at a frequency, dB: the full reserve, or less if the
    /// distance between two limits is less than 1 dB or less than four reserves.
    pub fn reserve_at_db(&self, reserve_db: f64, frequency_rad_per_s: f64) -> f64 {
        let lower = self.lower.as_ref().and_then(|limit| limit.magnitude(frequency_rad_per_s));
        let ratio = self.upper.magnitude(frequency_rad_per_s).zip(lower).map(|(upper, lower)| upper / lower);
        reserve_db * fraction_kept(reserve_db, ratio.map(|ratio| 20.0 * portable::log10(ratio)))
    }
}

/// The fraction of a reserve that applies if two limits leave this room between them, dB: the full
/// reserve if the room is at least 1 dB and four reserves, so that both together use at most half
/// of it.
pub(crate) fn fraction_kept(reserve_db: f64, room_db: Option<f64>) -> f64 {
    room_db.map_or(1.0, |room_db| (room_db / (4.0 * reserve_db).max(1.0)).clamp(0.0, 1.0))
}

/// A requirement with the frequencies at which bounds are drawn and the band over which it must
/// hold, rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct Specification {
    /// Closed loop and limits.
    pub requirement: Requirement,
    /// Design frequencies, rad/s, increasing.
    pub frequencies_rad_per_s: Vec<f64>,
    /// The band `[from, to]` over which it must hold, rad/s; `to` may be infinite.
    pub band_rad_per_s: [f64; 2],
}

impl Specification {
    /// The margin of the loop to the limit at this frequency, dB; negative if the limit is
    /// violated.
    ///
    /// ```text
    /// margin = 20 log10(limit / |closed loop|)              for tracking the smaller of the margins to both limits
    /// ```
    ///
    /// `None` if a limit given as a table does not cover the frequency.
    ///
    /// # Example
    /// ```
    /// use num_complex::Complex64;
    /// use phea_qft::specification::{ClosedLoop, Limit, LoopResponse, Requirement, Specification};
    /// let one = Complex64::new(1.0, 0.0);
    /// let response = LoopResponse { plant: one, load_motion: one, controller: one, prefilter: one, sensor: one };
    /// let specification = Specification {
    ///     requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(5.0)),
    ///     frequencies_rad_per_s: vec![1.0],
    ///     band_rad_per_s: [1.0, 1.0],
    /// };
    /// // |L/(1+L)| = 1/2 is ten times below 5
    /// assert_eq!(specification.margin_db(&response, 1.0), Some(20.0));
    /// ```
    pub fn margin_db(&self, response: &LoopResponse, frequency_rad_per_s: f64) -> Option<f64> {
        let below = |limit: &Limit, value: Complex64| {
            Some(decibels(limit.magnitude(frequency_rad_per_s)? / portable::magnitude(value)))
        };
        let value = self.requirement.closed_loop().response(response);
        match self.requirement.limits() {
            (Some(lower), upper) => Some(below(upper, value)?.min(-below(lower, value)?)),
            (None, upper) => below(upper, value),
        }
    }
}
