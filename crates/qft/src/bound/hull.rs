//! Common bounds of a group of plants, and the largest region that any plant of the group could
//! forbid.

use num_complex::Complex64;

use super::inequality::{InequalityForm, Ray, WeightedPlant};
use super::leaf::{Borders, lesser};
use super::quadratic::negative_gains;

/// Relative allowance added to the region that a box may forbid, so that rounding hides no plant
/// from the ray.
const SLACK: f64 = 1e-14;

/// Common bounds of a group of plants.
///
/// ```text
/// least <= |q| <= greatest,   arg q within an arc,   (r/W)^2 <= share
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) struct Hull {
    modulus: [f64; 2],
    /// Bearings of the ends of the arc.
    bearing: [f64; 2],
    /// Directions of these ends, q/|q|.
    ends: [Complex64; 2],
    fraction: f64,
}

impl Hull {
    pub(super) fn around(plants: &[WeightedPlant]) -> Option<Hull> {
        let ways = || plants.iter().map(|plant| (bearing(plant.inverse), plant));
        let (first, right) = ways().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (last, left) = ways().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let moduli = || plants.iter().map(|plant| plant.modulus);
        Some(Hull {
            modulus: [moduli().fold(f64::INFINITY, f64::min), moduli().fold(0.0, f64::max)],
            bearing: [first, last],
            ends: [right, left].map(|plant| plant.inverse / plant.modulus),
            fraction: plants.iter().map(WeightedPlant::fraction).fold(0.0, f64::max),
        })
    }

    pub(super) fn of_all(hulls: &[Hull]) -> Option<Hull> {
        hulls.iter().copied().reduce(|all, hull| {
            let right = if hull.bearing[0] < all.bearing[0] { hull } else { all };
            let left = if hull.bearing[1] > all.bearing[1] { hull } else { all };
            Hull {
                modulus: [all.modulus[0].min(hull.modulus[0]), all.modulus[1].max(hull.modulus[1])],
                bearing: [right.bearing[0], left.bearing[1]],
                ends: [right.ends[0], left.ends[1]],
                fraction: all.fraction.max(hull.fraction),
            }
        })
    }

    /// True if signs show that the plants inside forbid nothing, or nothing beyond the borders;
    /// `false` is inconclusive. Not for `Spread`.
    pub(super) fn stays_within(&self, ray: &Ray, borders: &Borders) -> bool {
        let rest = 1.0 - self.fraction - SLACK * (1.0 + self.fraction);
        let (a, c) = if ray.form == InequalityForm::Complementary { (rest, 1.0) } else { (1.0, rest) };
        let b = self.least_cosine(ray.direction);
        // The quadratic in u = g/|q|, times |q|^2: at the lower border for the nearest plant, at
        // the upper one for the farthest.
        let [near, far] = self.modulus;
        let below = borders.below(a, b * near, c * near * near);
        let above = borders.above(a, b * far, c * far * far);
        a > 0.0 && (lesser(below, above) > 0.0 || b * b < a * c)
    }

    /// The least cosine between the ray and a q of the hull.
    fn least_cosine(&self, direction: Complex64) -> f64 {
        let [first, last] = self.ends;
        let cross = |a: Complex64, b: Complex64| a.re * b.im - a.im * b.re;
        let half_turn = self.bearing[1] - self.bearing[0] >= 2.0;
        if half_turn || (cross(first, direction) <= 0.0 && cross(direction, last) <= 0.0) {
            return -1.0;
        }
        let cosine = |end: Complex64| end.re * direction.re + end.im * direction.im;
        cosine(first).min(cosine(last)) - SLACK
    }

    /// The least value at a gain that the hull allows the quadratic of a plant inside.
    pub(super) fn least(&self, ray: &Ray, gain: f64) -> f64 {
        let cosine = self.least_cosine(ray.direction);
        let [near, far] = self.modulus;
        let modulus = (-gain * cosine).clamp(near, far);
        let fraction = self.fraction * ray.other_weight * ray.other_weight;
        let distance = |cosine: f64, modulus: f64| (gain + 2.0 * modulus * cosine) * gain + modulus * modulus;
        let limit = match ray.form {
            InequalityForm::Complementary => gain * gain,
            InequalityForm::Sensitivity => modulus * modulus,
            InequalityForm::Spread => {
                gain * gain + 2.0 * gain * ray.along(ray.other) + ray.other_modulus * ray.other_modulus
            }
        };
        distance(cosine, modulus) - fraction * limit
    }

    /// Gains that contain all those a plant inside could forbid: where the least quadratic that the
    /// hull allows is negative. Under an individual limit, a plant's quadratic depends on u =
    /// g/|q|:
    ///
    /// ```text
    /// Complementary   (1 - share) u^2 + 2 u min cos + 1 < 0
    /// Sensitivity     u^2 + 2 u min cos + (1 - share) < 0
    /// Spread          (1 - share) g^2 + 2 (min c - share c_k) g + (min |q|^2 - share |q_k|^2) < 0,  share with r_k^2
    /// ```
    pub(super) fn could_forbid(&self, ray: &Ray) -> [[f64; 2]; 2] {
        let fraction = self.fraction * ray.other_weight * ray.other_weight;
        if !fraction.is_finite() {
            return [ray.window, [0.0, 0.0]];
        }
        let least = self.least_cosine(ray.direction);
        let [near, far] = self.modulus;
        let rest = 1.0 - fraction - SLACK * (1.0 + fraction);
        let scaled = |a: f64, c: f64| {
            negative_gains(a, least, c, least * least - a * c).map(|[low, high]| [low * near, high * far])
        };
        match ray.form {
            InequalityForm::Complementary => scaled(rest, 1.0 - SLACK),
            InequalityForm::Sensitivity => scaled(1.0 - SLACK, rest),
            InequalityForm::Spread => {
                let along = least * if least < 0.0 { far } else { near };
                let other = ray.other_modulus;
                let b = along - fraction * ray.along(ray.other) - SLACK * (far + fraction * other);
                let c =
                    near * near - fraction * other * other - SLACK * (far * far + fraction * other * other);
                negative_gains(rest, b, c, b * b - rest * c).map(|interval| ray.within_window(interval))
            }
        }
    }
}

/// A number in [-2, 2] that grows with the argument of q, free of transcendental functions.
pub(super) fn bearing(inverse: Complex64) -> f64 {
    let slope = inverse.im / (inverse.re.abs() + inverse.im.abs());
    if inverse.re >= 0.0 { slope } else { 2.0_f64.copysign(inverse.im) - slope }
}
