use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::{atan2, exp, log1p};
use phea_dynamics::range::RequiredRange;
use phea_dynamics::time_response::{SecondOrder, step_response};

use super::check::{TOLERANCE, check_lower, check_upper};
use super::{
    ExtraRoot, LowerStepRequirement, TimeDomainError, TimeDomainNumber, TrackingLimit, Translation,
    UpperStepRequirement,
};

/// The upper tracking limit for a requirement in time.
///
/// ```text
/// B_U(s) = w_n^2/(s^2 + 2 xi w_n s + w_n^2) (s + z)/z                       thesis (6.28)
/// ```
///
/// The exact translation uses sigma = xi w_n and w_d = w_n sqrt(1 - xi^2), for which the first
/// extreme of the response is at
///
/// ```text
/// t_1 = (pi - atan2(w_d, z - sigma))/w_d,   overshoot = exp(-sigma t_1) sqrt(1 - 2 sigma/z + (w_n/z)^2)
/// ```
///
/// which gives xi for each z/w_n (above one if z is below w_n); w_n follows by bisection on the
/// condition that the response stays in the band from the settling time on. If the settling time
/// jumps because an extreme leaves the band, the faster side is used.
///
/// # Errors
/// [`TimeDomainError::OutOfRange`], [`TimeDomainError::RuleBand`], and
/// [`TimeDomainError::ExtraRootTooSlow`] if the slow decay due to a fixed zero prevents the
/// response from settling.
///
/// # Example
/// ```
/// use phea_qft::specification::{ExtraRoot, Translation, UpperStepRequirement, RequirementOutcome, tracking_upper};
/// let requirement = UpperStepRequirement { overshoot_percent: 1.0, settling_time_s: 0.1, settling_band_percent: 1.0 };
/// let limit = tracking_upper(&requirement, ExtraRoot::At { rad_per_s: 75.0 }, Translation::Exact)?;
/// assert_eq!(limit.check.outcome(), RequirementOutcome::Met);
/// assert!((limit.check.reached.overshoot_percent - 1.0).abs() < 1e-9);
/// assert!((limit.natural_frequency_rad_per_s - 36.13).abs() < 0.005);
/// # Ok::<(), phea_qft::specification::TimeDomainError>(())
/// ```
pub fn tracking_upper(
    requirement: &UpperStepRequirement,
    extra_zero: ExtraRoot,
    translation: Translation,
) -> Result<TrackingLimit, TimeDomainError> {
    requirement.check()?;
    extra_zero.check()?;
    let model = match translation {
        Translation::Rule(rule) => {
            same_band(rule.band_percent(), requirement.settling_band_percent)?;
            SecondOrder::from_overshoot_and_settling_rule(
                requirement.overshoot_percent,
                requirement.settling_time_s,
                rule,
            )?
        }
        Translation::Exact => {
            let model = |natural: f64| {
                let ratio =
                    damping_ratio(requirement.overshoot_percent / 100.0, extra_zero.fraction(natural));
                SecondOrder::new(natural, ratio)
            };
            let settled = |natural: f64| upper_settles(requirement, extra_zero, &model(natural)?);
            model(least_natural_frequency(requirement.settling_time_s, extra_zero, settled)?)?
        }
    };
    let zero = extra_zero.place(model.natural_frequency_rad_per_s());
    let function = with_zero(&model, zero)?;
    let check = check_upper(&function, requirement)?;
    Ok(limit(function, &model, zero, check))
}

/// The lower tracking limit for a requirement in time: critically damped, with or without an extra
/// pole.
///
/// ```text
/// B_L(s) = w_n^2/(s + w_n)^2 p/(s + p)                                      thesis (6.29)
/// ```
///
/// The exact translation: the response rises monotonically, so that w_n follows by bisection on its
/// value at the settling time.
///
/// # Errors
/// [`TimeDomainError::OutOfRange`], [`TimeDomainError::RuleBand`], and
/// [`TimeDomainError::ExtraRootTooSlow`] if the fixed pole itself takes longer: p t_s must exceed
/// ln(100/band).
///
/// # Example
/// ```
/// use phea_qft::specification::{ExtraRoot, LowerStepRequirement, Translation, RequirementOutcome, tracking_lower};
/// let requirement = LowerStepRequirement { settling_time_s: 0.3, settling_band_percent: 1.0 };
/// let limit = tracking_lower(&requirement, ExtraRoot::At { rad_per_s: 50.0 }, Translation::Exact)?;
/// assert_eq!(limit.check.outcome(), RequirementOutcome::Met);
/// assert!((limit.natural_frequency_rad_per_s - 24.19).abs() < 0.005);
/// # Ok::<(), phea_qft::specification::TimeDomainError>(())
/// ```
pub fn tracking_lower(
    requirement: &LowerStepRequirement,
    extra_pole: ExtraRoot,
    translation: Translation,
) -> Result<TrackingLimit, TimeDomainError> {
    requirement.check()?;
    extra_pole.check()?;
    let model = match translation {
        Translation::Rule(rule) => {
            same_band(rule.band_percent(), requirement.settling_band_percent)?;
            SecondOrder::from_overshoot_and_settling_rule(0.0, requirement.settling_time_s, rule)?
        }
        Translation::Exact => {
            let settled = |natural: f64| {
                let function = with_pole(&SecondOrder::new(natural, 1.0)?, extra_pole.place(natural))?;
                Ok(deviation(&function, requirement.settling_time_s)?
                    <= requirement.settling_band_percent / 100.0)
            };
            SecondOrder::new(least_natural_frequency(requirement.settling_time_s, extra_pole, settled)?, 1.0)?
        }
    };
    let pole = extra_pole.place(model.natural_frequency_rad_per_s());
    let function = with_pole(&model, pole)?;
    let check = check_lower(&function, requirement)?;
    Ok(limit(function, &model, pole, check))
}

fn limit(
    function: TransferFunction,
    model: &SecondOrder,
    extra_root_rad_per_s: Option<f64>,
    check: super::RequirementCheck,
) -> TrackingLimit {
    TrackingLimit {
        function,
        natural_frequency_rad_per_s: model.natural_frequency_rad_per_s(),
        damping_ratio: model.damping_ratio(),
        extra_root_rad_per_s,
        check,
    }
}

fn same_band(rule_percent: f64, required_percent: f64) -> Result<(), TimeDomainError> {
    if rule_percent == required_percent {
        Ok(())
    } else {
        Err(TimeDomainError::RuleBand { rule_percent, required_percent })
    }
}

fn with_zero(model: &SecondOrder, zero: Option<f64>) -> Result<TransferFunction, TimeDomainError> {
    let function = model.transfer_function();
    let Some(zero) = zero else { return Ok(function) };
    let factor = TransferFunction::from_factors(1.0 / zero, vec![Complex64::new(-zero, 0.0)], Vec::new())?;
    Ok(function.series(&factor)?)
}

fn with_pole(model: &SecondOrder, pole: Option<f64>) -> Result<TransferFunction, TimeDomainError> {
    let function = model.transfer_function();
    let Some(pole) = pole else { return Ok(function) };
    let lag = TransferFunction::from_factors(pole, Vec::new(), vec![Complex64::new(-pole, 0.0)])?;
    Ok(function.series(&lag)?)
}

/// Deviation |1 - y(t)| of the unit step response.
fn deviation(function: &TransferFunction, time_s: f64) -> Result<f64, TimeDomainError> {
    let value = step_response(function, &[time_s])?.iter().sum::<f64>();
    Ok((1.0 - value).abs())
}

/// True if the response of the model with its zero stays in the band from the settling time on.
fn upper_settles(
    requirement: &UpperStepRequirement,
    extra_zero: ExtraRoot,
    model: &SecondOrder,
) -> Result<bool, TimeDomainError> {
    let natural = model.natural_frequency_rad_per_s();
    let band = requirement.settling_band_percent / 100.0;
    let function = with_zero(model, extra_zero.place(natural))?;
    if deviation(&function, requirement.settling_time_s)? > band {
        return Ok(false);
    }
    // the response is in the band now: it stays there if the next extreme does
    let (ratio, fraction) = (model.damping_ratio(), extra_zero.fraction(natural));
    let time = natural * requirement.settling_time_s;
    let next = first_extreme(ratio, fraction).and_then(|first| {
        let half_period = PI / ((1.0 - ratio) * (1.0 + ratio)).sqrt();
        let passed = ((time - first) / half_period).ceil();
        match ratio < 1.0 && passed > 0.0 {
            true => Some(first + passed * half_period),
            false => (time <= first).then_some(first),
        }
    });
    // half the tolerance of the check, so that the check accepts a result whose extreme is just
    // inside the band
    Ok(next.is_none_or(|next| extreme(ratio, fraction, next) <= band * (1.0 + 0.5 * TOLERANCE)))
}

/// The first time, in units of 1/w_n, at which the response with zero z = w_n/share is stationary;
/// `None` if it only rises.
///
/// The slope is proportional to exp(-xi t) ((1 - xi share) S + share C), with C = cos, S =
/// sin/sqrt(1 - xi^2) of sqrt(1 - xi^2) t, or their hyperbolic counterparts.
fn first_extreme(ratio: f64, fraction: f64) -> Option<f64> {
    let (rise, square) = (ratio * fraction - 1.0, (1.0 - ratio) * (1.0 + ratio));
    if square > 0.0 {
        let damped = square.sqrt();
        return Some(atan2(damped * fraction, rise) / damped);
    }
    let spread = (-square).sqrt();
    if rise <= spread * fraction {
        return None;
    }
    if spread == 0.0 {
        return Some(fraction / rise);
    }
    let tangent = spread * fraction / rise;
    Some((log1p(tangent) - log1p(-tangent)) / (2.0 * spread))
}

/// Deviation of the response from its final value at a stationary time (in units of 1/w_n).
fn extreme(ratio: f64, fraction: f64, time: f64) -> f64 {
    exp(-ratio * time) * (1.0 - 2.0 * ratio * fraction + fraction * fraction).max(0.0).sqrt()
}

/// The damping ratio with which the response with zero z = w_n/share overshoots by this ratio.
fn damping_ratio(overshoot: f64, fraction: f64) -> f64 {
    // above this ratio there is no overshoot: critically damped, or the slow pole coincides with
    // the zero
    let most = if fraction <= 1.0 { 1.0 } else { (fraction + 1.0 / fraction) / 2.0 };
    let overshoots =
        |ratio: f64| first_extreme(ratio, fraction).map_or(0.0, |time| extreme(ratio, fraction, time));
    if overshoot == 0.0 {
        return most;
    }
    let (mut low, mut high) = (0.0, most);
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return high;
        }
        if overshoots(middle) > overshoot { low = middle } else { high = middle }
    }
}

/// The natural frequency from which on the response has settled by the required time, by doubling
/// and bisection.
fn least_natural_frequency<F: Fn(f64) -> Result<bool, TimeDomainError>>(
    settling_time_s: f64,
    extra_root: ExtraRoot,
    settled: F,
) -> Result<f64, TimeDomainError> {
    const DOUBLINGS: usize = 30;
    let mut high = 1.0 / settling_time_s;
    let mut doublings = 0;
    while !settled(high)? {
        high *= 2.0;
        doublings += 1;
        if doublings > DOUBLINGS {
            let extra_root_rad_per_s = extra_root.place(high).unwrap_or(f64::INFINITY);
            return Err(TimeDomainError::ExtraRootTooSlow { extra_root_rad_per_s, settling_time_s });
        }
    }
    let mut low = 0.5 * high;
    while settled(low)? {
        (high, low) = (low, 0.5 * low);
    }
    loop {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            return Ok(high);
        }
        if settled(middle)? { high = middle } else { low = middle }
    }
}

impl ExtraRoot {
    fn check(self) -> Result<(), TimeDomainError> {
        match self {
            ExtraRoot::None => Ok(()),
            ExtraRoot::At { rad_per_s } => positive(TimeDomainNumber::ExtraRoot, rad_per_s),
            ExtraRoot::Times { natural_frequencies } => {
                positive(TimeDomainNumber::ExtraRootRatio, natural_frequencies)
            }
        }
    }

    /// Root z or p for this natural frequency, both in rad/s.
    fn place(self, natural: f64) -> Option<f64> {
        match self {
            ExtraRoot::None => None,
            ExtraRoot::At { rad_per_s } => Some(rad_per_s),
            ExtraRoot::Times { natural_frequencies } => Some(natural_frequencies * natural),
        }
    }

    /// Ratio w_n/z; zero without a zero.
    fn fraction(self, natural: f64) -> f64 {
        match self {
            ExtraRoot::None => 0.0,
            ExtraRoot::At { rad_per_s } => natural / rad_per_s,
            ExtraRoot::Times { natural_frequencies } => 1.0 / natural_frequencies,
        }
    }
}

impl UpperStepRequirement {
    pub(super) fn check(&self) -> Result<(), TimeDomainError> {
        if !(0.0..100.0).contains(&self.overshoot_percent) {
            let (what, expected) = (TimeDomainNumber::Overshoot, RequiredRange::BelowHundred);
            return Err(TimeDomainError::OutOfRange { what, value: self.overshoot_percent, expected });
        }
        let (settling_time_s, settling_band_percent) = (self.settling_time_s, self.settling_band_percent);
        LowerStepRequirement { settling_time_s, settling_band_percent }.check()
    }
}

impl LowerStepRequirement {
    pub(super) fn check(&self) -> Result<(), TimeDomainError> {
        positive(TimeDomainNumber::SettlingTime, self.settling_time_s)?;
        let value = self.settling_band_percent;
        if value > 0.0 && value < 100.0 {
            return Ok(());
        }
        let (what, expected) = (TimeDomainNumber::SettlingBand, RequiredRange::BetweenZeroAndHundred);
        Err(TimeDomainError::OutOfRange { what, value, expected })
    }
}

fn positive(what: TimeDomainNumber, value: f64) -> Result<(), TimeDomainError> {
    let expected = RequiredRange::PositiveAndFinite;
    let fits = value > 0.0 && value.is_finite();
    if fits { Ok(()) } else { Err(TimeDomainError::OutOfRange { what, value, expected }) }
}
