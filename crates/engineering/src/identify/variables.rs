//! The coefficients as variables of order one, within their bounds.

use phea_dynamics::portable;
use phea_dynamics::random::normal;
use phea_hydraulics::servovalve::{STATIC_COEFFICIENTS, StaticCoefficients};

pub(super) const COUNT: usize = STATIC_COEFFICIENTS;

/// Indices of the shape, the tare flow, the null bias and the width of the hysteresis.
const SHAPE: usize = 8;
pub(super) const TARE_FLOW: usize = 9;
pub(super) const NULL_BIAS: usize = 10;
const HYSTERESIS: usize = 11;

/// Flow coefficients, the first ones.
const EDGES: usize = 4;

/// Least coefficient over its reference that is varied by its inverse.
const LEAST_IN_SERIES: f64 = 0.05;

/// Step of the null bias that counts as much as a factor of e in a positive coefficient, over the
/// nominal voltage.
const BIAS_SCALE: f64 = 0.01;

/// Least leakage of an edge over the first guess: without any leakage, pressures have no limit.
const LEAST_LEAKAGE: f64 = 1e-6;

/// How a coefficient is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Positive, by its logarithm.
    Positive,
    /// It may vanish: in proportion to a reference.
    MayVanish,
    /// Of either sign, in steps.
    EitherSign,
    /// Positive, by its square's inverse over that of the reference: edges in series add by it.
    InSeries,
}

impl Kind {
    pub(super) fn of(index: usize) -> Kind {
        match index {
            0..4 | SHAPE => Kind::Positive,
            NULL_BIAS => Kind::EitherSign,
            _ => Kind::MayVanish,
        }
    }

    /// The scale of a coefficient that may end at zero.
    pub(super) fn vanishes(index: usize) -> bool {
        Kind::of(index) == Kind::MayVanish
    }
}

/// Variables of order one around a reference.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Variables {
    reference: [f64; COUNT],
    bias_step: f64,
    nominal_voltage: f64,
    /// Which flow coefficients are varied as [`Kind::InSeries`].
    in_series: [bool; EDGES],
}

impl Variables {
    pub(super) fn around(reference: &StaticCoefficients, nominal_voltage: f64) -> Variables {
        let reference = reference.to_array();
        let bias_step = BIAS_SCALE * nominal_voltage;
        Variables { reference, bias_step, nominal_voltage, in_series: [false; EDGES] }
    }

    /// The same with the flow coefficients as in series, but for those that nearly vanish here:
    /// what a test of joined ports leaves open of them is a straight line, where it is a curved
    /// valley of their logarithms.
    pub(super) fn in_series(&self, near: &StaticCoefficients) -> Variables {
        let mut in_series = [false; EDGES];
        for ((is_used, number), reference) in in_series.iter_mut().zip(near.to_array()).zip(self.reference) {
            *is_used = number > LEAST_IN_SERIES * reference;
        }
        Variables { in_series, ..self.clone() }
    }

    fn kind(&self, index: usize) -> Kind {
        let is_in_series = self.in_series.get(index).is_some_and(|is_used| *is_used);
        if is_in_series { Kind::InSeries } else { Kind::of(index) }
    }

    /// The variables of coefficients.
    pub(super) fn of(&self, coefficients: &StaticCoefficients) -> Vec<f64> {
        let all = coefficients.to_array().into_iter().zip(self.reference).enumerate();
        let of = |(index, (number, reference)): (usize, (f64, f64))| match self.kind(index) {
            Kind::Positive => portable::ln(number / reference),
            Kind::MayVanish => number / reference,
            Kind::EitherSign => (number - reference) / self.bias_step,
            Kind::InSeries => (reference / number) * (reference / number),
        };
        all.map(of).collect()
    }

    /// Those of the reference.
    pub(super) fn start(&self) -> Vec<f64> {
        (0..COUNT).map(|index| if Kind::vanishes(index) { 1.0 } else { 0.0 }).collect()
    }

    /// Those of a point around the reference, by a factor of two for most.
    pub(super) fn scattered(&self, state: &mut u64) -> Vec<f64> {
        let of = |index| {
            let by = 0.7 * normal(state);
            if Kind::vanishes(index) { portable::exp(by) } else { by }
        };
        (0..COUNT).map(of).collect()
    }

    /// The coefficients.
    pub(super) fn coefficients(&self, variables: &[f64]) -> StaticCoefficients {
        let mut numbers = self.reference;
        for (index, (number, x)) in numbers.iter_mut().zip(variables).enumerate() {
            *number = match self.kind(index) {
                Kind::Positive => *number * portable::exp(*x),
                Kind::InSeries => *number / x.sqrt(),
                Kind::MayVanish => *number * x,
                Kind::EitherSign => *number + x * self.bias_step,
            };
        }
        StaticCoefficients::from_array(numbers)
    }

    /// Derivative of each coefficient with respect to its variable.
    pub(super) fn slopes(&self, coefficients: &StaticCoefficients) -> [f64; COUNT] {
        self.of_each(coefficients, |_, reference| reference)
    }

    /// The change of each coefficient that matters: its own size, or that of the reference where it
    /// may vanish and is smaller.
    pub(super) fn scales(&self, coefficients: &StaticCoefficients) -> [f64; COUNT] {
        self.of_each(coefficients, f64::max)
    }

    fn of_each(
        &self,
        coefficients: &StaticCoefficients,
        vanishing: impl Fn(f64, f64) -> f64,
    ) -> [f64; COUNT] {
        let mut found = coefficients.to_array();
        for (index, (number, reference)) in found.iter_mut().zip(self.reference).enumerate() {
            *number = match self.kind(index) {
                Kind::Positive => *number,
                Kind::InSeries => -0.5 * *number * (*number / reference) * (*number / reference),
                Kind::MayVanish => vanishing(*number, reference),
                Kind::EitherSign => self.bias_step,
            };
        }
        found
    }

    /// The bounds of each: a factor of a hundred, down to zero where a coefficient may vanish;
    /// shape, tare flow and width within their meaningful range, the null within a tenth of the
    /// nominal voltage.
    pub(super) fn bounds(&self) -> [[f64; 2]; COUNT] {
        let mut bounds = [[-4.6, 4.6]; COUNT];
        let [.., shape, tare, bias, width] = &self.reference;
        for bounds in bounds.iter_mut().skip(4).take(4) {
            *bounds = [LEAST_LEAKAGE, 100.0];
        }
        for (bounds, _) in bounds.iter_mut().zip(self.in_series).filter(|(_, is_used)| *is_used) {
            *bounds = [1e-4, 1e4];
        }
        bounds[SHAPE] = [1.0, 5000.0].map(|end| portable::ln(end / shape));
        bounds[TARE_FLOW] = [0.0, 1e-2 / tare];
        let end = 0.1 * self.nominal_voltage;
        bounds[NULL_BIAS] = [-end, end].map(|end| (end - bias) / self.bias_step);
        bounds[HYSTERESIS] = [1e-7, 0.2].map(|share| share * self.nominal_voltage / width);
        bounds
    }
}
