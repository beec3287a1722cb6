//! Coefficients as variables of order one, within their bounds.

use phea_dynamics::portable;
use phea_dynamics::random::normal;
use phea_hydraulics::servovalve::{STATIC_COEFFICIENTS, StaticCoefficients, ValveTerms};

pub(super) const COUNT: usize = STATIC_COEFFICIENTS;

/// Indices of the shape, the tare flow, the null bias and the width of the hysteresis.
const SHAPE: usize = 8;
pub(super) const TARE_FLOW: usize = 9;
pub(super) const NULL_BIAS: usize = 10;
pub(super) const HYSTERESIS: usize = 11;
/// Coefficients of the terms that a valve may have: both laps, the saturation, and the shapes of
/// the other edges.
const LAPS: std::ops::Range<usize> = 12..14;
const SATURATION: usize = 14;
const OTHER_SHAPES: std::ops::Range<usize> = 15..18;

/// Coefficients that a static test shows but the linear plant does not depend on.
pub(super) const ONLY_OF_TEST: [usize; 3] = [TARE_FLOW, NULL_BIAS, HYSTERESIS];

/// Number of flow coefficients, the first of all.
const EDGES: usize = 4;

/// Least ratio of a coefficient to its reference at which it is varied by its inverse.
const LEAST_IN_SERIES: f64 = 0.05;

/// Step of the null bias, relative to the nominal voltage, that is equivalent to a factor of e in a
/// positive coefficient.
const BIAS_SCALE: f64 = 0.01;

/// Equivalent step of a lap, relative to full travel, and of the saturation.
const LAP_SCALE: f64 = 1e-3;
const SATURATION_SCALE: f64 = 0.1;

/// Lap of an initial estimate.
const FIRST_LAP: f64 = 5e-3;

/// Greatest lap and saturation.
const MOST_LAP: f64 = 0.2;
const MOST_SATURATION: f64 = 10.0;

/// Ratio of the least leakage of an edge to the initial estimate: without any leakage, pressures
/// have no limit.
const LEAST_LEAKAGE: f64 = 1e-6;

/// True if a valve with these terms has the coefficient of this index.
pub(super) fn has(terms: ValveTerms, index: usize) -> bool {
    match index {
        12..14 => terms.lap,
        SATURATION => terms.saturation,
        15.. => terms.leakage_by_edge,
        _ => true,
    }
}

/// Quotient of two derivatives; zero for a coefficient that is not varied, which has none.
pub(super) fn over(derivative: f64, other: f64) -> f64 {
    if other == 0.0 { 0.0 } else { derivative / other }
}

/// Kind of a coefficient, by its variation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Positive coefficient, varied by its logarithm.
    Positive,
    /// Coefficient that may vanish: proportional to a reference.
    MayVanish,
    /// Coefficient of either sign, in steps.
    EitherSign,
    /// Positive coefficient, varied by the inverse of its square relative to that of the reference:
    /// edges in series add by it.
    InSeries,
}

impl Kind {
    pub(super) fn of(index: usize) -> Kind {
        match index {
            0..4 | SHAPE | 15.. => Kind::Positive,
            NULL_BIAS | 12 | 13 => Kind::EitherSign,
            _ => Kind::MayVanish,
        }
    }

    /// True if a coefficient of this kind may have either sign.
    pub(super) fn may_be_negative(self) -> bool {
        self == Kind::EitherSign
    }

    /// True for a coefficient that may end at zero.
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
    terms: ValveTerms,
    /// True for each flow coefficient that is varied as [`Kind::InSeries`].
    in_series: [bool; EDGES],
}

impl Variables {
    pub(super) fn around(reference: &StaticCoefficients, nominal_voltage: f64) -> Variables {
        let mut reference = reference.to_array();
        reference[LAPS].fill(0.0);
        reference[SATURATION] = SATURATION_SCALE;
        let bias_step = BIAS_SCALE * nominal_voltage;
        let terms = ValveTerms::default();
        Variables { reference, bias_step, nominal_voltage, terms, in_series: [false; EDGES] }
    }

    /// Variables of a valve with these terms.
    pub(super) fn with_terms(&self, terms: ValveTerms) -> Variables {
        Variables { terms, ..self.clone() }
    }

    /// True if a valve with these terms has this coefficient.
    fn varies(&self, index: usize) -> bool {
        has(self.terms, index)
    }

    /// Number of coefficients that are varied.
    pub(super) fn count(&self) -> usize {
        (0..COUNT).filter(|index| self.varies(*index)).count()
    }

    /// Step of a coefficient of either sign.
    fn step(&self, index: usize) -> f64 {
        if index == NULL_BIAS { self.bias_step } else { LAP_SCALE }
    }

    /// Variables with the flow coefficients as in series, except for those that nearly vanish here:
    /// the combinations that a test of joined ports leaves open are a straight line, instead of a
    /// curved valley in their logarithms.
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

    /// Variables of given coefficients.
    pub(super) fn of(&self, coefficients: &StaticCoefficients) -> Vec<f64> {
        let all = coefficients.to_array().into_iter().zip(self.reference).enumerate();
        let of = |(index, (number, reference)): (usize, (f64, f64))| match self.kind(index) {
            Kind::Positive => portable::ln(number / reference),
            Kind::MayVanish => number / reference,
            Kind::EitherSign => (number - reference) / self.step(index),
            Kind::InSeries => (reference / number) * (reference / number),
        };
        all.map(of).collect()
    }

    /// Variables of the reference.
    pub(super) fn start(&self) -> Vec<f64> {
        let of = |index| if Kind::vanishes(index) && index != SATURATION { 1.0 } else { 0.0 };
        (0..COUNT).map(of).collect()
    }

    /// Variables of the reference; for a valve with lap also with an overlap and with an underlap.
    pub(super) fn starts(&self) -> Vec<Vec<f64>> {
        let laps: &[f64] = if self.terms.lap { &[0.0, FIRST_LAP, -FIRST_LAP] } else { &[0.0] };
        let with = |lap: &f64| {
            let mut start = self.start();
            start[LAPS].fill(lap / LAP_SCALE);
            start
        };
        laps.iter().map(with).collect()
    }

    /// Variables of a point around the reference, by a factor of two for most.
    pub(super) fn scattered(&self, state: &mut u64) -> Vec<f64> {
        let of = |index| {
            if !has(ValveTerms::default(), index) {
                return 0.0;
            }
            let by = 0.7 * normal(state);
            if Kind::vanishes(index) { portable::exp(by) } else { by }
        };
        (0..COUNT).map(of).collect()
    }

    /// Coefficients of these variables.
    pub(super) fn coefficients(&self, variables: &[f64]) -> StaticCoefficients {
        let mut numbers = self.reference;
        for (index, (number, x)) in numbers.iter_mut().zip(variables).enumerate() {
            *number = match self.kind(index) {
                Kind::Positive => *number * portable::exp(*x),
                Kind::InSeries => *number / x.sqrt(),
                Kind::MayVanish => *number * x,
                Kind::EitherSign => *number + x * self.step(index),
            };
        }
        if !self.terms.leakage_by_edge {
            let shape = numbers[SHAPE];
            numbers[OTHER_SHAPES].fill(shape);
        }
        StaticCoefficients::from_array(numbers)
    }

    /// Derivative of each coefficient with respect to its variable; zero if it is not varied.
    pub(super) fn slopes(&self, coefficients: &StaticCoefficients) -> [f64; COUNT] {
        self.of_each(coefficients, |_, reference| reference)
    }

    /// Change of each coefficient that matters: its magnitude, or that of the reference if it may
    /// vanish and is smaller.
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
                Kind::EitherSign => self.step(index),
            };
            if !self.varies(index) {
                *number = 0.0;
            }
        }
        found
    }

    /// Bounds of each variable: a factor of a hundred, down to zero if a coefficient may vanish;
    /// shape, tare flow and width within their meaningful range, the null within a tenth of the
    /// nominal voltage.
    pub(super) fn bounds(&self) -> [[f64; 2]; COUNT] {
        let mut bounds = [[-4.6, 4.6]; COUNT];
        let [shape, tare, bias, width] =
            [SHAPE, TARE_FLOW, NULL_BIAS, HYSTERESIS].map(|at| self.reference[at]);
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
        bounds[HYSTERESIS] = [1e-7, 0.2].map(|fraction| fraction * self.nominal_voltage / width);
        bounds[LAPS].fill([-MOST_LAP, MOST_LAP].map(|lap| lap / LAP_SCALE));
        bounds[SATURATION] = [0.0, MOST_SATURATION / SATURATION_SCALE];
        for index in OTHER_SHAPES {
            bounds[index] = [1.0, 5000.0].map(|end| portable::ln(end / self.reference[index]));
        }
        bounds
    }
}
