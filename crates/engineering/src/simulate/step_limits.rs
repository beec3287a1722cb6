//! Requirement for the step response of the force, and its comparison with a step of the machine.

use super::{Cause, Metrics, Unmeasured, Window};
use crate::project::{RequiredStep, SETTLING_BAND_PERCENT};
use crate::specification::CheckedRequirement;

/// Relative tolerance of the required value: printed numbers have three digits.
const ROUNDED: f64 = 1e-6;
/// Simulated overshoot that counts as zero below this value, percent of the step.
pub const NO_OVERSHOOT_PERCENT: f64 = 0.01;
/// Duration for which a step is first simulated: in rise times, or without one in s.
const RISES: f64 = 3.0;
const HORIZON_S: f64 = 0.1;

/// Requirements in time of the first tracking specification that has any: the overshoot of its
/// upper limit, the settling time of its lower one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Largest permitted overshoot, percent of the step.
    pub overshoot_percent: Option<f64>,
    /// Required settling time, s.
    pub settling_time_s: Option<f64>,
    /// Required rise time, from 10 to 90 percent of the step, s.
    pub rise_time_s: Option<f64>,
    /// Band of the settling time, percent of the step.
    pub band_percent: f64,
    /// Settling time of the lower limit, or of the upper one if only that states one, s: duration
    /// for which a step is first simulated.
    pub horizon_s: f64,
}

/// Properties of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachedStep {
    /// Overshoot, percent of the step.
    pub overshoot_percent: f64,
    /// Settling time, s; infinite if the step does not settle.
    pub settling_time_s: f64,
    /// Rise time from 10 to 90 percent, s; infinite if the step does not rise that far.
    pub rise_time_s: f64,
}

/// A number to twelve digits: 1.65 for 1.1 times 1.5, which is 1.6500000000000001.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

impl StepLimits {
    /// Requirement without any limit.
    pub(crate) const NOTHING: StepLimits = StepLimits {
        overshoot_percent: None,
        settling_time_s: None,
        rise_time_s: None,
        band_percent: SETTLING_BAND_PERCENT,
        horizon_s: HORIZON_S,
    };

    /// Requirement in time of these limits; `None` if there is none.
    pub fn of(requirements: &[CheckedRequirement]) -> Option<StepLimits> {
        StepLimits::of_specification(requirements, requirements.first()?.number)
    }

    /// Requirement in time of the limits of one specification, by its number from 1; `None` if
    /// there is none.
    pub fn of_specification<'a>(
        requirements: impl IntoIterator<Item = &'a CheckedRequirement> + Clone,
        number: usize,
    ) -> Option<StepLimits> {
        let side = |key: &str| {
            let of_side =
                |requirement: &&CheckedRequirement| requirement.number == number && requirement.key == key;
            requirements.clone().into_iter().find(of_side).map(|requirement| requirement.check.required)
        };
        let (upper, lower) = (side("upper"), side("lower"));
        Some(StepLimits {
            overshoot_percent: upper.map(|required| required.overshoot_percent),
            settling_time_s: lower.map(|required| required.settling_time_s),
            rise_time_s: None,
            band_percent: lower.or(upper)?.settling_band_percent,
            horizon_s: lower.or(upper)?.settling_time_s,
        })
    }

    /// Requirement of a specification of the kind `step`.
    pub(crate) fn of_step(step: &RequiredStep) -> StepLimits {
        let of_rise = step.rise_time.map(|time_s| RISES * time_s);
        StepLimits {
            overshoot_percent: step.overshoot_percent,
            settling_time_s: step.settling_time,
            rise_time_s: step.rise_time,
            band_percent: step.settling_band_percent.unwrap_or(SETTLING_BAND_PERCENT),
            horizon_s: step.settling_time.or(of_rise).unwrap_or(HORIZON_S),
        }
    }

    /// The requirement with this multiple of each permitted property, to twelve digits.
    pub fn wider(self, factor: f64) -> StepLimits {
        let times = |value: f64| rounded(factor * value);
        StepLimits {
            overshoot_percent: self.overshoot_percent.map(times),
            settling_time_s: self.settling_time_s.map(times),
            rise_time_s: self.rise_time_s.map(times),
            horizon_s: factor * self.horizon_s,
            ..self
        }
    }

    /// True if a step satisfies the requirement, up to the rounding of printed numbers. An
    /// overshoot below a hundredth of a percent counts as zero.
    pub fn is_satisfied(&self, reached: &ReachedStep) -> bool {
        self.excess(reached) <= 1.0 + ROUNDED
    }

    /// Largest ratio of a reached property to the required one; zero if nothing is required.
    pub fn excess(&self, reached: &ReachedStep) -> f64 {
        self.excesses(reached)[0]
    }

    /// Ratios of the reached properties of a step to the required ones, the largest first; zero if
    /// nothing is required. Of two steps that never settle, the one with the larger second ratio is
    /// worse.
    pub fn excesses(&self, reached: &ReachedStep) -> [f64; 3] {
        let overshoot_percent = self.overshoot_percent.map(|most| most.max(NO_OVERSHOOT_PERCENT));
        let each = [
            (reached.overshoot_percent, overshoot_percent),
            (reached.settling_time_s, self.settling_time_s),
            (reached.rise_time_s, self.rise_time_s),
        ];
        let mut ratios = each.map(|(value, most)| most.map_or(0.0, |most| (value / most).max(0.0)));
        ratios.sort_by(|one, other| other.total_cmp(one));
        ratios
    }

    /// True if the overshoot of a step satisfies the requirement; `None` if none is required or the
    /// window contains no step.
    pub fn overshoot_satisfied(&self, metrics: &Metrics) -> Option<bool> {
        let most = self.overshoot_percent?;
        let reached = metrics.overshoot_percent.ok()?;
        Some(reached <= most + ROUNDED * most.max(1.0))
    }

    /// True if the settling time satisfies the requirement; `None` also if the two bands differ.
    pub fn settling_satisfied(&self, metrics: &Metrics) -> Option<bool> {
        let most = self.settling_time_s?;
        metrics.overshoot_percent.ok()?;
        let same_band = metrics.settling_band_percent == self.band_percent;
        match metrics.settling_time_s {
            Ok(reached) => same_band.then_some(reached <= most * (1.0 + ROUNDED)),
            Err(Unmeasured::NotSettled) => Some(false),
            Err(_) => None,
        }
    }

    /// Lines of times, s, and forces, N, that the force should not cross after each step of these
    /// windows that begins within a span: above it, and below it once it should have settled.
    pub fn lines<'a>(
        &self,
        windows: impl Iterator<Item = &'a Window>,
        [start_s, end_s]: [f64; 2],
    ) -> Vec<Vec<[f64; 2]>> {
        let seen = windows.filter(|window| (start_s..end_s).contains(&window.start_s));
        seen.flat_map(|window| self.around(window, window.end_s.min(end_s))).collect()
    }

    fn around(&self, window: &Window, end_s: f64) -> Vec<Vec<[f64; 2]>> {
        let Cause::ReferenceStep { from_n, to_n } = window.cause else { return vec![] };
        let (start_s, step_n) = (window.start_s, to_n - from_n);
        let at = |percent: f64| to_n + 0.01 * percent * step_n;
        let settled_s = self.settling_time_s.map_or(end_s, |time_s| (start_s + time_s).min(end_s));
        let mut lines = Vec::new();
        if let Some(most) = self.overshoot_percent {
            lines.push(vec![[start_s, at(most)], [settled_s, at(most)]]);
        }
        if settled_s < end_s {
            let band = self.band_percent;
            lines.push(vec![[settled_s, at(band)], [end_s, at(band)]]);
            lines.push(vec![[settled_s, at(-band)], [end_s, at(-band)]]);
        }
        lines
    }
}
