//! Second-order model of a specification in the time domain, thesis (3.5) to (3.13), corrected.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::{ResponseNumber, TimeResponseError};
use crate::linear::{TimeDomain, TransferFunction};
use crate::portable::{atan2, cos, exp, ln, sin, sinh};
use crate::range::RequiredRange;

/// Second-order system with unit gain.
///
/// ```text
/// Y/R = w_n^2 / (s^2 + 2 xi w_n s + w_n^2)                                   thesis (3.5)
/// ```
///
/// # Example
/// From a specification and back: 5 % overshoot, within 2 % after about half a second.
/// ```
/// use phea_dynamics::time_response::{SecondOrder, SettlingRule};
/// # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
/// let model = SecondOrder::from_overshoot_and_settling_rule(5.0, 0.5, SettlingRule::TwoPercent)?;
/// assert!((model.overshoot_percent() - 5.0).abs() < 1e-12);
/// assert!((model.settling_time_s(2.0)?.unwrap_or(f64::NAN) - 0.5).abs() < 0.05);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondOrder {
    natural_frequency_rad_per_s: f64,
    damping_ratio: f64,
}

/// Rule of thumb for the settling time, with its band.
///
/// ```text
/// t_s = factor / (xi w_n)          thesis (3.10) to (3.13)
/// ```
///
/// Rules use the envelope and ignore where the response crosses the band;
/// [`SecondOrder::settling_time_s`] is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettlingRule {
    /// Factor 3 for 5 percent, thesis (3.10).
    FivePercent,
    /// Factor 4 for 2 percent, thesis (3.11).
    TwoPercent,
    /// Factor 4.6 for 1 percent: exp(-4.6) = 0.01.
    OnePercent,
    /// Factor 5 for 1 percent as printed in thesis (3.12); its envelope is at 0.67 percent by then.
    OnePercentThesis,
    /// Critically damped, 2 percent: factor 5.834, the solution of (1 + x) exp(-x) = 0.02. Thesis
    /// (3.13) prints 6.
    CriticallyDampedTwoPercent,
}

impl SettlingRule {
    /// Factor over xi w_n.
    pub fn factor(self) -> f64 {
        match self {
            SettlingRule::FivePercent => 3.0,
            SettlingRule::TwoPercent => 4.0,
            SettlingRule::OnePercent => 4.6,
            SettlingRule::OnePercentThesis => 5.0,
            SettlingRule::CriticallyDampedTwoPercent => 5.833_921_701_917_391,
        }
    }

    /// Settling band, percent of the step.
    pub fn band_percent(self) -> f64 {
        match self {
            SettlingRule::FivePercent => 5.0,
            SettlingRule::TwoPercent | SettlingRule::CriticallyDampedTwoPercent => 2.0,
            SettlingRule::OnePercent | SettlingRule::OnePercentThesis => 1.0,
        }
    }
}

impl SecondOrder {
    /// System with this undamped natural frequency (positive) and damping ratio (zero or positive).
    ///
    /// # Errors
    /// [`TimeResponseError::OutOfRange`].
    pub fn new(natural_frequency_rad_per_s: f64, damping_ratio: f64) -> Result<Self, TimeResponseError> {
        positive(ResponseNumber::NaturalFrequency, natural_frequency_rad_per_s)?;
        if !(damping_ratio.is_finite() && damping_ratio >= 0.0) {
            return Err(TimeResponseError::OutOfRange {
                what: ResponseNumber::DampingRatio,
                value: damping_ratio,
                expected: RequiredRange::ZeroOrPositive,
            });
        }
        Ok(SecondOrder { natural_frequency_rad_per_s, damping_ratio })
    }

    /// System with this overshoot (percent, from 0 up to but not 100) and settling time in s, by a
    /// rule of thumb.
    ///
    /// ```text
    /// w_n = factor/(xi t_s)
    /// ```
    ///
    /// # Errors
    /// [`TimeResponseError::OutOfRange`].
    pub fn from_overshoot_and_settling_rule(
        overshoot_percent: f64,
        settling_time_s: f64,
        rule: SettlingRule,
    ) -> Result<Self, TimeResponseError> {
        positive(ResponseNumber::SettlingTime, settling_time_s)?;
        let damping_ratio = damping_ratio_from_overshoot(overshoot_percent)?;
        SecondOrder::new(rule.factor() / (damping_ratio * settling_time_s), damping_ratio)
    }

    /// Undamped natural frequency w_n, rad/s.
    pub fn natural_frequency_rad_per_s(&self) -> f64 {
        self.natural_frequency_rad_per_s
    }

    /// Damping ratio xi.
    pub fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    /// Damped natural frequency w_d = w_n sqrt(1 - xi^2), rad/s; `None` from critical damping on.
    pub(crate) fn damped_frequency_rad_per_s(&self) -> Option<f64> {
        let ratio = self.damping_ratio;
        (ratio < 1.0).then(|| self.natural_frequency_rad_per_s * ((1.0 - ratio) * (1.0 + ratio)).sqrt())
    }

    /// Time of the first peak in s; `None` from critical damping on.
    ///
    /// ```text
    /// t_p = pi/w_d                                                    thesis (3.6)
    /// ```
    pub fn peak_time_s(&self) -> Option<f64> {
        self.damped_frequency_rad_per_s().map(|damped| PI / damped)
    }

    /// Rise time from 0 to 100 percent in s; `None` from critical damping on.
    ///
    /// ```text
    /// t_r = (pi - atan(w_d/sigma)) / w_d,  sigma = xi w_n             thesis (3.7), corrected
    /// ```
    pub fn rise_time_s(&self) -> Option<f64> {
        let sigma = self.damping_ratio * self.natural_frequency_rad_per_s;
        self.damped_frequency_rad_per_s().map(|damped| (PI - atan2(damped, sigma)) / damped)
    }

    /// Largest overshoot in percent; zero from critical damping on.
    ///
    /// ```text
    /// M_p = 100 exp(-pi sigma/w_d)                                    thesis (3.8)
    /// ```
    pub fn overshoot_percent(&self) -> f64 {
        let ratio = self.damping_ratio;
        if ratio >= 1.0 {
            return 0.0;
        }
        100.0 * exp(-PI * ratio / ((1.0 - ratio) * (1.0 + ratio)).sqrt())
    }

    /// Exact time after which the step response stays within plus or minus `band_percent`, s;
    /// `None` without damping, when it never does.
    ///
    /// The deviation has its extremes exp(-k pi sigma/w_d) at k pi/w_d; the last one outside the
    /// band is followed by the crossing, found by bisection.
    ///
    /// # Errors
    /// [`TimeResponseError::OutOfRange`] when the band is not between 0 and 100 percent.
    pub fn settling_time_s(&self, band_percent: f64) -> Result<Option<f64>, TimeResponseError> {
        if !(band_percent > 0.0 && band_percent < 100.0) {
            return Err(TimeResponseError::OutOfRange {
                what: ResponseNumber::SettlingBand,
                value: band_percent,
                expected: RequiredRange::BetweenZeroAndHundred,
            });
        }
        if self.damping_ratio == 0.0 {
            return Ok(None);
        }
        let band = band_percent / 100.0;
        let (mut low, mut high) = match self.damped_frequency_rad_per_s() {
            Some(damped) => {
                let decrement = PI * self.damping_ratio * self.natural_frequency_rad_per_s / damped;
                let mut last = (-ln(band) / decrement).floor();
                if exp(-last * decrement) <= band {
                    // an extreme that only touches the band is inside it
                    last = (last - 1.0).max(0.0);
                }
                (last * PI / damped, (last + 1.0) * PI / damped)
            }
            None => {
                let mut high = 1.0 / self.natural_frequency_rad_per_s;
                while self.deviation(high).abs() > band {
                    high *= 2.0;
                }
                (0.0, high)
            }
        };
        loop {
            let middle = low + 0.5 * (high - low);
            if middle <= low || middle >= high {
                return Ok(Some(high));
            }
            if self.deviation(middle).abs() > band { low = middle } else { high = middle }
        }
    }

    /// Unit step response at a time in s.
    pub fn step_value(&self, time_s: f64) -> f64 {
        if time_s <= 0.0 { 0.0 } else { 1.0 - self.deviation(time_s) }
    }

    /// The system in factored form.
    pub fn transfer_function(&self) -> TransferFunction {
        let (natural, ratio) = (self.natural_frequency_rad_per_s, self.damping_ratio);
        let poles = match self.damped_frequency_rad_per_s() {
            Some(damped) => {
                let real = -ratio * natural;
                vec![Complex64::new(real, -damped), Complex64::new(real, damped)]
            }
            None => {
                let fast = natural * (ratio + (ratio - 1.0).sqrt() * (ratio + 1.0).sqrt());
                vec![Complex64::new(-natural * (natural / fast), 0.0), Complex64::new(-fast, 0.0)]
            }
        };
        TransferFunction::assembled(natural * natural, Vec::new(), poles, TimeDomain::Continuous)
    }

    /// Deviation of the step response from its final value, continued beyond critical damping.
    ///
    /// ```text
    /// 1 - y(t) = exp(-sigma t) (cos w_d t + sigma/w_d sin w_d t)
    /// ```
    fn deviation(&self, time: f64) -> f64 {
        let sigma = self.damping_ratio * self.natural_frequency_rad_per_s;
        if let Some(damped) = self.damped_frequency_rad_per_s() {
            let angle = damped * time;
            return exp(-sigma * time) * (cos(angle) + sigma / damped * sin(angle));
        }
        let ratio = self.damping_ratio;
        let spread = self.natural_frequency_rad_per_s * (ratio - 1.0).sqrt() * (ratio + 1.0).sqrt();
        let slow = self.natural_frequency_rad_per_s * (self.natural_frequency_rad_per_s / (sigma + spread));
        if spread * time < 1e-4 {
            // cosh x + sigma t sinh x / x with x = spread t near zero
            let x = spread * time;
            return exp(-sigma * time) * (1.0 + x * x / 2.0 + sigma * time * (1.0 + x * x / 6.0));
        }
        if spread * time < 1.0 {
            let x = spread * time;
            let half = sinh(x / 2.0);
            return exp(-sigma * time) * (1.0 + 2.0 * half * half + sigma * time * sinh(x) / x);
        }
        let fast = sigma + spread;
        (fast * exp(-slow * time) - slow * exp(-fast * time)) / (2.0 * spread)
    }
}

/// Damping ratio with this overshoot in percent, from 0 (critically damped) up to but not 100.
///
/// ```text
/// xi = -ln(M_p/100) / sqrt(pi^2 + ln^2(M_p/100))                           thesis (3.9), corrected
/// ```
///
/// # Errors
/// [`TimeResponseError::OutOfRange`].
///
/// # Example
/// ```
/// let ratio = phea_dynamics::time_response::damping_ratio_from_overshoot(1.0)?;
/// assert!((ratio - 0.8261).abs() < 1e-4);
/// # Ok::<(), phea_dynamics::time_response::TimeResponseError>(())
/// ```
pub fn damping_ratio_from_overshoot(overshoot_percent: f64) -> Result<f64, TimeResponseError> {
    if !(0.0..100.0).contains(&overshoot_percent) {
        return Err(TimeResponseError::OutOfRange {
            what: ResponseNumber::Overshoot,
            value: overshoot_percent,
            expected: RequiredRange::BelowHundred,
        });
    }
    if overshoot_percent == 0.0 {
        return Ok(1.0);
    }
    let logarithm = ln(overshoot_percent / 100.0);
    Ok(-logarithm / crate::portable::hypot(PI, logarithm))
}

fn positive(what: ResponseNumber, value: f64) -> Result<(), TimeResponseError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(TimeResponseError::OutOfRange { what, value, expected: RequiredRange::PositiveAndFinite })
    }
}
