use phea_dynamics::linear::TransferFunction;
use phea_dynamics::time_response::Settling;

use super::step::reached;
use super::{LowerStepRequirement, TimeDomainError, UpperStepRequirement};

/// Relative difference below which values count as equal: a peak that touches the band stays in it,
/// and a requirement met to this accuracy is met.
pub(super) const TOLERANCE: f64 = 1e-9;

/// Values required.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequiredResponse {
    /// Largest overshoot, percent of the step.
    pub overshoot_percent: f64,
    /// Settling time, s.
    pub settling_time_s: f64,
    /// The band of the settling time: plus or minus this percentage of the step.
    pub settling_band_percent: f64,
}

/// Properties of the step response to a reference of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Amount by which it exceeds one, percent; zero if it does not.
    pub overshoot_percent: f64,
    /// Settling within the band around one, with its time.
    pub settling: Settling,
}

/// A limit of tracking compared with its requirement in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequirementCheck {
    /// Required values.
    pub required: RequiredResponse,
    /// Properties of the response of the limit itself.
    pub reached: Reached,
}

/// Comparison of the response of a limit with its requirement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RequirementOutcome {
    /// The requirement is met, to a billionth.
    Met,
    /// The requirement is not met.
    Missed {
        /// Overshoot beyond the requirement, percent of the step; zero if it is met.
        overshoot_excess_percent: f64,
        /// Settling time beyond the requirement, s; zero if it is met, infinity if it never
        /// settles.
        settling_excess_s: f64,
    },
}

/// Compares any upper limit with a requirement in time.
///
/// # Errors
/// [`TimeDomainError::OutOfRange`] for the requirement; [`TimeDomainError::NotContinuous`],
/// [`TimeDomainError::NotStable`], [`TimeDomainError::RingsTooLong`] or an improper function for
/// the limit.
///
/// # Example
/// The limit of 6.28 against its intended response:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_qft::specification::{UpperStepRequirement, check_upper};
/// let poles = vec![Complex64::new(-36.8, 27.6), Complex64::new(-36.8, -27.6)];
/// let printed = TransferFunction::from_factors(2116.0 / 75.0, vec![Complex64::new(-75.0, 0.0)], poles)?;
/// let requirement = UpperStepRequirement { overshoot_percent: 1.0, settling_time_s: 0.1, settling_band_percent: 1.0 };
/// let reached = check_upper(&printed, &requirement)?.reached;
/// assert!((reached.overshoot_percent - 2.19).abs() < 0.005);
/// assert!(reached.settling.time_s().is_some_and(|time_s| (time_s - 0.126).abs() < 5e-4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_upper(
    function: &TransferFunction,
    requirement: &UpperStepRequirement,
) -> Result<RequirementCheck, TimeDomainError> {
    requirement.check()?;
    let UpperStepRequirement { overshoot_percent, settling_time_s, settling_band_percent } = *requirement;
    let required = RequiredResponse { overshoot_percent, settling_time_s, settling_band_percent };
    Ok(RequirementCheck { required, reached: reached(function, settling_band_percent)? })
}

/// Compares any lower limit with a requirement in time, which allows no overshoot.
///
/// # Errors
/// Errors as for [`check_upper`].
///
/// # Example
/// A lag settles within 1 % after ln 100 time constants:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_qft::specification::{LowerStepRequirement, RequirementOutcome, check_lower};
/// let lag = TransferFunction::from_factors(10.0, vec![], vec![Complex64::new(-10.0, 0.0)])?;
/// let check = check_lower(&lag, &LowerStepRequirement { settling_time_s: 0.4, settling_band_percent: 1.0 })?;
/// let late = 100.0_f64.ln() / 10.0 - 0.4;
/// match check.outcome() {
///     RequirementOutcome::Missed { settling_excess_s, .. } => assert!((settling_excess_s - late).abs() < 1e-9),
///     RequirementOutcome::Met => unreachable!(),
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_lower(
    function: &TransferFunction,
    requirement: &LowerStepRequirement,
) -> Result<RequirementCheck, TimeDomainError> {
    requirement.check()?;
    let LowerStepRequirement { settling_time_s, settling_band_percent } = *requirement;
    let required = RequiredResponse { overshoot_percent: 0.0, settling_time_s, settling_band_percent };
    Ok(RequirementCheck { required, reached: reached(function, settling_band_percent)? })
}

impl RequirementCheck {
    /// Comparison with the requirement, with the excess if it is not met.
    pub fn outcome(&self) -> RequirementOutcome {
        let beyond = |reached: f64, required: f64| {
            if reached <= required * (1.0 + TOLERANCE) + TOLERANCE * 1e-3 { 0.0 } else { reached - required }
        };
        let overshoot_excess_percent =
            beyond(self.reached.overshoot_percent, self.required.overshoot_percent);
        let settling_time_s = self.reached.settling.time_s().unwrap_or(f64::INFINITY);
        let settling_excess_s = beyond(settling_time_s, self.required.settling_time_s);
        if overshoot_excess_percent == 0.0 && settling_excess_s == 0.0 {
            RequirementOutcome::Met
        } else {
            RequirementOutcome::Missed { overshoot_excess_percent, settling_excess_s }
        }
    }
}
