//! Stability margins and the limits that guarantee them, in both directions.
//!
//! A limit on |L/(1+L)| or |1/(1+L)| excludes L from a circle near -1, and thereby guarantees
//! margins: each formula here gives the point where that circle meets the negative real axis, the
//! unit circle, or the point nearest to -1. All are attained by some L, so that none can be
//! sharpened. They hold for a loop that is stable when closed and satisfies the limit at every
//! frequency.
//!
//! # Example
//! The thesis' limit of 1.3 on |L/(1+L)| (6.30) corresponds to a gain margin of almost 5 dB:
//! ```
//! use phea_dynamics::frequency::decibels;
//! use phea_qft::specification::{
//!     guaranteed_margins_of_robust_stability, robust_stability_limit_for_gain_increase,
//! };
//! let margins = guaranteed_margins_of_robust_stability(1.3)?;
//! assert!((decibels(margins.gain_increase) - 4.96).abs() < 0.005);
//! assert!((margins.phase_rad.to_degrees() - 45.2).abs() < 0.05);
//! let five_decibel = 10.0_f64.powf(0.25);
//! assert!((robust_stability_limit_for_gain_increase(five_decibel)? - 1.285).abs() < 5e-4);
//! # Ok::<(), phea_qft::specification::MarginError>(())
//! ```

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::{asin, sin};
use phea_dynamics::range::RequiredRange;

use super::{ClosedLoop, Limit, Requirement};

/// Reason why a margin has no limit, or a limit no margin.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MarginError {
    /// A number outside the range in which the formula is valid.
    #[error("{what} is {value}; it must be {expected}")]
    OutOfRange {
        /// Name of the number.
        what: MarginNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        expected: RequiredRange,
    },
}

/// Number of a margin, or of a limit that guarantees one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MarginNumber {
    /// Limit on a closed loop.
    #[error("the limit")]
    Limit,
    /// Factor by which the gain may grow.
    #[error("the increase of gain")]
    GainIncrease,
    /// Factor to which the gain may fall.
    #[error("the reduction of gain")]
    GainReduction,
    /// Phase margin, rad.
    #[error("the phase margin in rad")]
    PhaseMargin,
    /// Least distance |1 + L|.
    #[error("the modulus margin")]
    ModulusMargin,
    /// Additional delay, s.
    #[error("the delay in s")]
    Delay,
}

/// The margins that a limit guarantees, for a loop that is stable when closed and satisfies the
/// limit at every frequency. Each is attained by some loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuaranteedMargins {
    /// Factor above one by which the gain may grow; infinity if no increase is excluded.
    pub gain_increase: f64,
    /// Factor below one to which the gain may fall; zero if no reduction is excluded.
    pub gain_reduction: f64,
    /// Angle, up to pi, from -1 to the point where |L| = 1, rad; infinity if |L| can never be one.
    pub phase_rad: f64,
    /// Least distance |1 + L|.
    pub modulus: f64,
}

/// The margins that |L/(1+L)| <= W guarantees. W is a positive ratio.
///
/// ```text
/// gain may grow by       1 + 1/W
/// gain may fall to       1 - 1/W        (W > 1; to zero for W <= 1: L never crosses beyond -1)
/// phase margin           2 asin(1/(2W)) (W >= 1/2; below, |L| < 1 everywhere)
/// |1 + L|                1/(1 + W)      from |1/(1+L)| = |1 - L/(1+L)|
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a limit that is not positive and finite.
///
/// # Example
/// ```
/// let margins = phea_qft::specification::guaranteed_margins_of_robust_stability(1.0)?;
/// assert_eq!((margins.gain_increase, margins.gain_reduction, margins.modulus), (2.0, 0.0, 0.5));
/// assert!((margins.phase_rad.to_degrees() - 60.0).abs() < 1e-12);
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn guaranteed_margins_of_robust_stability(limit: f64) -> Result<GuaranteedMargins, MarginError> {
    let limit = positive(MarginNumber::Limit, limit)?;
    Ok(GuaranteedMargins {
        gain_increase: 1.0 + 1.0 / limit,
        gain_reduction: if limit > 1.0 { (limit - 1.0) / limit } else { 0.0 },
        phase_rad: phase_margin(limit),
        modulus: 1.0 / (1.0 + limit),
    })
}

/// The margins that |1/(1+L)| <= W guarantees. W is a positive ratio.
///
/// ```text
/// gain may grow by       W/(W - 1)      (W > 1; without bound for W <= 1: L never crosses between -1 and 0)
/// gain may fall to       W/(W + 1)
/// phase margin           2 asin(1/(2W)) (W >= 1/2; below, |L| > 1 everywhere)
/// |1 + L|                1/W            the modulus margin
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a limit that is not positive and finite.
///
/// # Example
/// ```
/// let margins = phea_qft::specification::guaranteed_margins_of_sensitivity(2.0)?;
/// assert_eq!((margins.gain_increase, margins.gain_reduction), (2.0, 2.0 / 3.0));
/// assert_eq!(margins.modulus, 0.5);
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn guaranteed_margins_of_sensitivity(limit: f64) -> Result<GuaranteedMargins, MarginError> {
    let limit = positive(MarginNumber::Limit, limit)?;
    Ok(GuaranteedMargins {
        gain_increase: if limit > 1.0 { limit / (limit - 1.0) } else { f64::INFINITY },
        gain_reduction: limit / (limit + 1.0),
        phase_rad: phase_margin(limit),
        modulus: 1.0 / limit,
    })
}

/// The margins that a requirement guarantees if it holds at every frequency; `None` for a
/// requirement that implies none: a closed loop other than |L/(1+L)| and |1/(1+L)|, or a limit that
/// depends on frequency.
///
/// # Errors
/// [`MarginError::OutOfRange`] for a constant that is not positive and finite.
///
/// # Example
/// ```
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, guaranteed_margins};
/// let stability = Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.0));
/// assert_eq!(guaranteed_margins(&stability)?.map(|margins| margins.gain_increase), Some(2.0));
/// assert_eq!(guaranteed_margins(&Requirement::at_most(ClosedLoop::ControlEffort, Limit::Constant(1.0)))?, None);
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn guaranteed_margins(requirement: &Requirement) -> Result<Option<GuaranteedMargins>, MarginError> {
    let (_, limit) = requirement.limits();
    match (requirement.closed_loop(), limit) {
        (ClosedLoop::RobustStability, Limit::Constant(limit)) => {
            guaranteed_margins_of_robust_stability(*limit).map(Some)
        }
        (ClosedLoop::Sensitivity, Limit::Constant(limit)) => {
            guaranteed_margins_of_sensitivity(*limit).map(Some)
        }
        _ => Ok(None),
    }
}

/// The limit on |L/(1+L)| that lets the gain grow by this factor (above one).
///
/// ```text
/// W = 1/(factor - 1)
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a factor outside the range.
///
/// # Example
/// ```
/// assert_eq!(phea_qft::specification::robust_stability_limit_for_gain_increase(3.0), Ok(0.5));
/// ```
pub fn robust_stability_limit_for_gain_increase(factor: f64) -> Result<f64, MarginError> {
    Ok(1.0 / (above_one(MarginNumber::GainIncrease, factor)? - 1.0))
}

/// The limit on |L/(1+L)| that lets the gain fall to this factor (above zero, below one).
///
/// ```text
/// W = 1/(1 - factor)
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a factor outside the range.
///
/// # Example
/// ```
/// assert_eq!(phea_qft::specification::robust_stability_limit_for_gain_reduction(0.5), Ok(2.0));
/// ```
pub fn robust_stability_limit_for_gain_reduction(factor: f64) -> Result<f64, MarginError> {
    Ok(1.0 / (1.0 - between_zero_and_one(MarginNumber::GainReduction, factor)?))
}

/// The limit on |L/(1+L)| for this phase margin (above zero, up to pi), rad.
///
/// ```text
/// W = 1/(2 sin(phase/2))
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for an angle outside the range.
///
/// # Example
/// ```
/// let limit = phea_qft::specification::robust_stability_limit_for_phase_margin(45.0_f64.to_radians())?;
/// assert!((limit - 1.3066).abs() < 5e-5);
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn robust_stability_limit_for_phase_margin(phase_rad: f64) -> Result<f64, MarginError> {
    limit_for_phase_margin(phase_rad)
}

/// The limit on |L/(1+L)| that holds |1 + L| at this distance (above zero, below one) or more.
///
/// ```text
/// W = 1/distance - 1
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a distance outside the range.
///
/// # Example
/// ```
/// assert_eq!(phea_qft::specification::robust_stability_limit_for_modulus_margin(0.5), Ok(1.0));
/// ```
pub fn robust_stability_limit_for_modulus_margin(distance: f64) -> Result<f64, MarginError> {
    let distance = between_zero_and_one(MarginNumber::ModulusMargin, distance)?;
    Ok((1.0 - distance) / distance)
}

/// The limit on |1/(1+L)| that lets the gain grow by this factor (above one).
///
/// ```text
/// W = factor/(factor - 1)
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a factor outside the range.
///
/// # Example
/// ```
/// assert_eq!(phea_qft::specification::sensitivity_limit_for_gain_increase(2.0), Ok(2.0));
/// ```
pub fn sensitivity_limit_for_gain_increase(factor: f64) -> Result<f64, MarginError> {
    let factor = above_one(MarginNumber::GainIncrease, factor)?;
    Ok(factor / (factor - 1.0))
}

/// The limit on |1/(1+L)| that lets the gain fall to this factor (above zero, below one).
///
/// ```text
/// W = factor/(1 - factor)
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for a factor outside the range.
///
/// # Example
/// ```
/// assert_eq!(phea_qft::specification::sensitivity_limit_for_gain_reduction(0.5), Ok(1.0));
/// ```
pub fn sensitivity_limit_for_gain_reduction(factor: f64) -> Result<f64, MarginError> {
    let factor = between_zero_and_one(MarginNumber::GainReduction, factor)?;
    Ok(factor / (1.0 - factor))
}

/// The limit on |1/(1+L)| for this phase margin (above zero, up to pi), rad: as for |L/(1+L)|,
/// since both are equal where |L| = 1.
///
/// ```text
/// W = 1/(2 sin(phase/2))
/// ```
///
/// # Errors
/// [`MarginError::OutOfRange`] for an angle outside the range.
///
/// # Example
/// ```
/// let limit = phea_qft::specification::sensitivity_limit_for_phase_margin(60.0_f64.to_radians())?;
/// assert!((limit - 1.0).abs() < 1e-15);
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn sensitivity_limit_for_phase_margin(phase_rad: f64) -> Result<f64, MarginError> {
    limit_for_phase_margin(phase_rad)
}

/// The limit on |1/(1+L)| that holds |1 + L| at this distance (above zero) or more.
///
/// ```text
/// W = 1/distance
/// ```
///
/// A loop that vanishes at high frequency cannot have a distance above one.
///
/// # Errors
/// [`MarginError::OutOfRange`] for a distance outside the range.
///
/// # Example
/// ```
/// assert_eq!(phea_qft::specification::sensitivity_limit_for_modulus_margin(0.5), Ok(2.0));
/// ```
pub fn sensitivity_limit_for_modulus_margin(distance: f64) -> Result<f64, MarginError> {
    Ok(1.0 / positive(MarginNumber::ModulusMargin, distance)?)
}

/// The angle at which |L| = 1 meets |1 + L| = 1/W; infinity if it cannot.
///
/// ```text
/// 2 sin(phase/2) = 1/W
/// ```
fn phase_margin(limit: f64) -> f64 {
    let sine = 0.5 / limit;
    if sine > 1.0 { f64::INFINITY } else { 2.0 * asin(sine) }
}

fn limit_for_phase_margin(phase_rad: f64) -> Result<f64, MarginError> {
    if !(phase_rad > 0.0 && phase_rad <= PI) {
        let (what, expected) = (MarginNumber::PhaseMargin, RequiredRange::UpToPi);
        return Err(MarginError::OutOfRange { what, value: phase_rad, expected });
    }
    Ok(0.5 / sin(phase_rad / 2.0))
}

/// The limit on |L/(1+L)| that lets every loop tolerate this much additional delay (positive), s.
///
/// ```text
/// |L/(1+L)| <= 1/(w tau)          since 1 + L e^(-s tau) = (1 + L)(1 + (e^(-s tau) - 1) L/(1+L))
///                                 and |e^(-jw tau) - 1| <= w tau
/// ```
///
/// Sufficient, by the small gain theorem: the loop may tolerate more.
///
/// # Errors
/// [`MarginError::OutOfRange`] for a delay outside the range.
///
/// # Example
/// ```
/// let limit = phea_qft::specification::delay_margin_limit(0.5e-3)?;
/// assert_eq!(limit.magnitude(1000.0), Some(2.0)); // one millisecond's worth at 1000 rad/s is 1, half of it 2
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn delay_margin_limit(delay_s: f64) -> Result<Limit, MarginError> {
    let gain = 1.0 / positive(MarginNumber::Delay, delay_s)?;
    let limit = TransferFunction::from_factors(gain, Vec::new(), vec![Complex64::new(0.0, 0.0)]);
    let (what, expected) = (MarginNumber::Delay, RequiredRange::FiniteInverse);
    limit.map(Limit::Rational).map_err(|_| MarginError::OutOfRange { what, value: delay_s, expected })
}

fn positive(what: MarginNumber, value: f64) -> Result<f64, MarginError> {
    in_range(what, value, value > 0.0 && value.is_finite(), RequiredRange::PositiveAndFinite)
}

fn above_one(what: MarginNumber, value: f64) -> Result<f64, MarginError> {
    in_range(what, value, value > 1.0 && value.is_finite(), RequiredRange::AboveOne)
}

fn between_zero_and_one(what: MarginNumber, value: f64) -> Result<f64, MarginError> {
    in_range(what, value, value > 0.0 && value < 1.0, RequiredRange::BetweenZeroAndOne)
}

fn in_range(what: MarginNumber, value: f64, fits: bool, expected: RequiredRange) -> Result<f64, MarginError> {
    if fits { Ok(value) } else { Err(MarginError::OutOfRange { what, value, expected }) }
}
