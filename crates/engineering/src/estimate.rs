//! A number identified from recordings, with its 95 % confidence interval.

use phea_dynamics::portable::{exp, ln, pow};

/// Standard normal quantile of 97.5 %: half width of a 95 % interval, in standard deviations.
pub const NORMAL_95: f64 = 1.959_963_984_540_054;

/// An estimate with its 95 % confidence interval, in SI units.
///
/// A number that recordings do not determine is an `Err` or a `None` in place of an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Most likely value.
    pub value: f64,
    /// Bounds of the interval; infinite if nothing limits it.
    pub interval: [f64; 2],
}

impl Estimate {
    /// Estimate from a value and its standard deviation; unbounded if that is not finite.
    pub(crate) fn of(value: f64, deviation: f64) -> Estimate {
        let half = NORMAL_95 * deviation;
        let bounded = [value - half, value + half];
        let interval = if half.is_finite() { bounded } else { [f64::NEG_INFINITY, f64::INFINITY] };
        Estimate { value, interval }
    }

    /// Estimate from the logarithm of a positive number and its standard deviation.
    pub(crate) fn of_logarithm(logarithm: f64, deviation: f64) -> Estimate {
        let edge = NORMAL_95 * deviation;
        Estimate { value: exp(logarithm), interval: [exp(logarithm - edge), exp(logarithm + edge)] }
    }

    /// Interval, if both bounds are finite.
    pub fn bounds(&self) -> Option<[f64; 2]> {
        self.interval.iter().all(|bound| bound.is_finite()).then_some(self.interval)
    }

    /// Standard deviation.
    pub(crate) fn deviation(&self) -> f64 {
        let [low, high] = self.interval;
        (high - low) / (2.0 * NORMAL_95)
    }

    /// Standard deviation of the logarithm of a positive number.
    pub(crate) fn deviation_of_logarithm(&self) -> f64 {
        let [low, high] = self.interval;
        ln(high / low) / (2.0 * NORMAL_95)
    }

    /// Product with an exact factor.
    pub(crate) fn times(&self, factor: f64) -> Estimate {
        Estimate::of(self.value * factor, self.deviation() * factor.abs())
    }

    /// Sum with an exact number.
    pub(crate) fn plus(&self, offset: f64) -> Estimate {
        Estimate::of(self.value + offset, self.deviation())
    }

    /// Difference of two independent estimates.
    pub(crate) fn minus(&self, other: &Estimate) -> Estimate {
        let square = |one: &Estimate| one.deviation() * one.deviation();
        Estimate::of(self.value - other.value, (square(self) + square(other)).sqrt())
    }

    /// Quotient of two independent estimates.
    pub(crate) fn over(&self, other: &Estimate) -> Estimate {
        let value = self.value / other.value;
        let [first, second] = [self, other].map(|one| one.deviation() / one.value);
        Estimate::of(value, value.abs() * (first * first + second * second).sqrt())
    }

    /// Quotient of an exact number and a positive estimate.
    pub(crate) fn under(&self, number: f64) -> Estimate {
        let [low, high] = self.interval;
        Estimate { value: number / self.value, interval: [number / high, number / low] }
    }

    /// Mean of independent estimates of different numbers.
    pub(crate) fn mean(all: &[Estimate]) -> Option<Estimate> {
        let count = all.len() as f64;
        let sum: f64 = all.iter().map(|one| one.value).sum();
        let squares: f64 = all.iter().map(|one| one.deviation() * one.deviation()).sum();
        (!all.is_empty()).then(|| Estimate::of(sum / count, squares.sqrt() / count))
    }

    /// Two independent estimates of one positive number, weighted by the inverse of the variances
    /// of their logarithms.
    pub(crate) fn combined(one: Estimate, other: Estimate) -> Estimate {
        let weight = |one: Estimate| 1.0 / (one.deviation_of_logarithm() * one.deviation_of_logarithm());
        let [first, second] = [one, other].map(weight);
        let logarithm = (first * ln(one.value) + second * ln(other.value)) / (first + second);
        Estimate::of_logarithm(logarithm, pow(first + second, -0.5))
    }
}
