//! Batched test of a few plants: does any forbid a gain that is not yet known to be forbidden?

use super::inequality::{InequalityForm, Ray, WeightedPlant};
use super::interval::GainIntervals;

/// Number of plants in a leaf: enough to be processed several at a time.
pub(super) const LEAF: usize = 8;

/// The quadratics of some plants in columns, divided by W^2.
///
/// ```text
/// (1 - share r_k^2) g^2 + 2 (c - share r_k^2 c_k) g + (constant - share r_k^2 |q_k|^2)
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    re: [f64; LEAF],
    im: [f64; LEAF],
    constant: [f64; LEAF],
    fraction: [f64; LEAF],
}

/// An interval already known to be forbidden, and the value added if there is nothing beyond an
/// end: infinity.
pub(super) struct Borders {
    ends: [f64; 2],
    beyond: [f64; 2],
}

impl Borders {
    /// The borders of each interval of a union.
    pub(super) fn of_each(ray: &Ray, union: &GainIntervals) -> impl Iterator<Item = Borders> {
        let [from, to] = ray.window;
        let idle = |is_idle: bool| if is_idle { f64::INFINITY } else { 0.0 };
        union.intervals().iter().map(move |&[low, high]| {
            // Any number will do for the end if there is nothing above.
            let end = if high < to { high } else { low };
            Borders { ends: [low, end], beyond: [idle(low <= from), idle(high >= to)] }
        })
    }

    /// Positive only if a quadratic that opens upwards is positive everywhere below the interval:
    /// at the border it is positive and falls.
    pub(super) fn below(&self, a: f64, b: f64, c: f64) -> f64 {
        let end = self.ends[0];
        lesser(-(a * end + b), (a * end + 2.0 * b) * end + c) + self.beyond[0]
    }

    /// Positive only if a quadratic that opens upwards is positive everywhere above the interval:
    /// at the border it is positive and rises.
    pub(super) fn above(&self, a: f64, b: f64, c: f64) -> f64 {
        let end = self.ends[1];
        lesser(a * end + b, (a * end + 2.0 * b) * end + c) + self.beyond[1]
    }
}

/// The lesser of two numbers; unlike `f64::min` it ignores NaN, and so compiles to a single
/// instruction.
pub(super) fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Leaf {
    /// A leaf of these plants, padded by repeating the last one.
    pub(super) fn of(form: InequalityForm, plants: &[WeightedPlant]) -> Leaf {
        let mut leaf =
            Leaf { re: [1.0; LEAF], im: [0.0; LEAF], constant: [1.0; LEAF], fraction: [0.0; LEAF] };
        let columns =
            leaf.re.iter_mut().zip(&mut leaf.im).zip(leaf.constant.iter_mut().zip(&mut leaf.fraction));
        let last = plants.last().into_iter().cycle();
        for (((re, im), (constant, fraction)), plant) in columns.zip(plants.iter().chain(last)) {
            (*re, *im) = (plant.inverse.re, plant.inverse.im);
            (*constant, *fraction) = match form {
                InequalityForm::Sensitivity => (plant.sensitivity_constant(), 0.0),
                InequalityForm::Complementary | InequalityForm::Spread => {
                    (plant.modulus * plant.modulus, plant.fraction())
                }
            };
        }
        leaf
    }

    /// True if signs show that the plants forbid nothing, or nothing beyond the borders; `false` is
    /// inconclusive.
    pub(super) fn stays_within(&self, ray: &Ray, borders: &Borders) -> bool {
        let square = ray.other_weight * ray.other_weight;
        let (along, other) = (ray.along(ray.other), ray.other_modulus * ray.other_modulus);
        let ways = self.re.iter().zip(&self.im).zip(self.constant.iter().zip(&self.fraction));
        let least = ways.fold(f64::INFINITY, |least, ((re, im), (constant, fraction))| {
            let fraction = fraction * square;
            let a = 1.0 - fraction;
            let b = re * ray.direction.re + im * ray.direction.im - fraction * along;
            let c = constant - fraction * other;
            let within = lesser(borders.below(a, b, c), borders.above(a, b, c));
            // Either the discriminant is negative or the roots are between the borders.
            let slack = -lesser(-within, b * b - a * c);
            lesser(least, lesser(slack, a))
        });
        least > 0.0
    }
}
