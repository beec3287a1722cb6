//! Axis: a title, a range and the map from values to the fraction of its length.

use phea_dynamics::portable::log10;

use super::ticks::{self, Tick, TickSteps};

/// Map from values to lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Linear scale.
    Linear,
    /// Logarithmic scale, for positive values only.
    Logarithmic,
    /// Signed logarithmic scale sign(v) log10(1 + |v|/limit): logarithmic far from zero on both
    /// sides, linear well inside `limit`.
    SignedLogarithmic {
        /// Positive value at which the scale changes from linear to logarithmic.
        limit: f64,
    },
}

/// Axis of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit, with markup.
    pub title: String,
    /// Scale.
    pub scale: Scale,
    /// Lower end.
    pub minimum: f64,
    /// Upper end.
    pub maximum: f64,
    /// Round steps of a linear axis.
    pub steps: TickSteps,
}

impl Axis {
    /// Linear axis with exactly these ends (made distinct and finite if they are not).
    pub fn linear(title: impl Into<String>, minimum: f64, maximum: f64) -> Self {
        let (minimum, maximum) = distinct(minimum, maximum);
        Axis { title: title.into(), scale: Scale::Linear, minimum, maximum, steps: TickSteps::Decimal }
    }

    /// Logarithmic axis with exactly these ends (made positive and distinct if they are not).
    pub fn logarithmic(title: impl Into<String>, minimum: f64, maximum: f64) -> Self {
        let usable = |v: f64| v > 1e-300 && v < 1e300;
        let (minimum, maximum) = match (usable(minimum), usable(maximum)) {
            (true, true) if maximum / minimum > 1.01 => (minimum, maximum),
            (true, true) => (minimum.min(maximum) / 2.0, minimum.max(maximum) * 2.0),
            (true, false) => (minimum, 10.0 * minimum),
            (false, true) => (maximum / 1e3, maximum),
            (false, false) => (1.0, 10.0),
        };
        Axis { title: title.into(), scale: Scale::Logarithmic, minimum, maximum, steps: TickSteps::Decimal }
    }

    /// Linear axis that covers the finite values and ends on round numbers.
    pub fn fit_linear(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self::fit_steps(title, values, TickSteps::Decimal)
    }

    /// Linear axis as [`Axis::fit_linear`], in degrees.
    pub fn fit_angle(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self::fit_steps(title, values, TickSteps::Angle)
    }

    /// Linear axis as [`Axis::fit_linear`], in decibels.
    pub fn fit_decibel(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self::fit_steps(title, values, TickSteps::Decibel)
    }

    fn fit_steps(title: impl Into<String>, values: impl IntoIterator<Item = f64>, steps: TickSteps) -> Self {
        let (low, high) = extent(values.into_iter().filter(|v| v.is_finite() && v.abs() < 1e250));
        let (low, high) = distinct(low, high);
        let step = ticks::round_step(high - low, 5, steps);
        let slack = 1e-9;
        let (minimum, maximum) = ((low / step + slack).floor() * step, (high / step - slack).ceil() * step);
        Axis { steps, ..Self::linear(title, minimum, maximum) }
    }

    /// Logarithmic axis that covers the positive finite values and ends on 1, 2 or 5 times a power
    /// of ten.
    pub fn fit_logarithmic(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let usable = values.into_iter().filter(|v| v.is_finite() && *v > 1e-300 && *v < 1e300);
        let (low, high) = extent(usable);
        let round = |value: f64, up: bool| {
            let decade = ticks::decimal_power(ticks::floor_log10(value));
            let digits = [1.0, 2.0, 5.0, 10.0];
            let found = match up {
                true => digits.into_iter().find(|d| d * decade >= value * (1.0 - 1e-9)),
                false => digits.into_iter().rev().find(|d| d * decade <= value * (1.0 + 1e-9)),
            };
            found.unwrap_or(1.0) * decade
        };
        Self::logarithmic(title, round(low, false), round(high, true))
    }

    /// Signed logarithmic axis that covers the finite values; `limit` is the magnitude below which
    /// it is linear.
    pub fn fit_signed_logarithmic(
        title: impl Into<String>,
        values: impl IntoIterator<Item = f64>,
        limit: f64,
    ) -> Self {
        let limit = if limit > 1e-300 && limit < 1e250 { limit } else { 1.0 };
        let (low, high) =
            extent(values.into_iter().filter(|v| v.is_finite() && v.abs() < 1e250).chain([0.0]));
        // more than thirty decades on a side would neither be legible nor stay within a double
        let limit = limit.max(1e-30 * low.abs().max(high.abs()));
        let grown = |v: f64| if v.abs() > limit { 2.0 * v } else { v.signum() * 2.0 * limit };
        let minimum = if low < 0.0 { grown(low) } else { -limit };
        let maximum = if high > 0.0 { grown(high) } else { limit };
        let scale = Scale::SignedLogarithmic { limit };
        Axis { title: title.into(), scale, minimum, maximum, steps: TickSteps::Decimal }
    }

    /// Position of a value: 0 at the lower end, 1 at the upper; NaN for a value outside the domain
    /// of the scale.
    pub fn fraction(&self, value: f64) -> f64 {
        let (low, high, at) = (self.mapped(self.minimum), self.mapped(self.maximum), self.mapped(value));
        (at - low) / (high - low)
    }

    fn mapped(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic if value > 0.0 => log10(value),
            Scale::Logarithmic => f64::NAN,
            Scale::SignedLogarithmic { limit } => log10(1.0 + value.abs() / limit).copysign(value),
        }
    }

    /// Exponent by which tick labels are divided, a multiple of three.
    pub fn exponent(&self) -> i32 {
        match self.scale {
            Scale::Linear => ticks::engineering_exponent(self.minimum, self.maximum),
            Scale::Logarithmic | Scale::SignedLogarithmic { .. } => 0,
        }
    }

    /// Title, with the power of ten by which the labels are divided.
    pub(crate) fn full_title(&self) -> String {
        match self.exponent() {
            0 => self.title.clone(),
            exponent => format!("{}, \u{d7}10^{exponent}", self.title),
        }
    }

    /// Ticks, with at most about `count` intervals between labels.
    pub fn ticks(&self, count: usize) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => ticks::linear(self.minimum, self.maximum, count, self.steps, self.exponent()),
            Scale::Logarithmic => ticks::logarithmic(self.minimum, self.maximum, count),
            Scale::SignedLogarithmic { limit } => {
                ticks::signed_logarithmic(self.minimum, self.maximum, limit, count)
            }
        }
    }
}

/// Smallest and largest value; NaN if there are none.
pub fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold((f64::NAN, f64::NAN), |(low, high), v| (low.min(v), high.max(v)))
}

fn distinct(minimum: f64, maximum: f64) -> (f64, f64) {
    if !(minimum.is_finite() && maximum.is_finite() && (maximum - minimum).is_finite()) {
        return (0.0, 1.0);
    }
    let middle = 0.5 * minimum + 0.5 * maximum;
    let least = 1e-9 * minimum.abs().max(maximum.abs());
    if maximum - minimum > least {
        (minimum, maximum)
    } else if middle == 0.0 {
        (-1.0, 1.0)
    } else {
        (middle - 0.1 * middle.abs(), middle + 0.1 * middle.abs())
    }
}
