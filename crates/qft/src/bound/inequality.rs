//! The quadratic inequality that one plant imposes on the nominal loop.

use num_complex::Complex64;

use super::quadratic::negative_gains;

/// The closed loop that is compared with its limit W; q = P0 H0/(P H), and the weights r are set
/// per plant.
///
/// ```text
/// Complementary    W |q + L0| >= r |L0|              |T| = |L0|/|q + L0|
/// Sensitivity      W |q + L0| >= r |q|               |S| = |q|/|q + L0|
/// Spread           W |q_i + L0| >= r_k |q_k + L0|    |T_i|/|T_k| for every k
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InequalityForm {
    Complementary,
    Sensitivity,
    Spread,
}

/// One plant with its limit and weight, both divided by a common power of two so that neither
/// square overflows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WeightedPlant {
    /// Inverse plant ratio q.
    pub(super) inverse: Complex64,
    /// Magnitude |q|.
    pub(super) modulus: f64,
    /// Limit W.
    pub(super) limit: f64,
    /// Weight r.
    pub(super) weight: f64,
}

impl WeightedPlant {
    /// (r/W)^2
    pub(super) fn fraction(&self) -> f64 {
        let ratio = self.weight / self.limit;
        ratio * ratio
    }

    /// Constant |q|^2 (1 - (r/W)^2), free of cancellation.
    pub(super) fn sensitivity_constant(&self) -> f64 {
        let ratio = self.weight / self.limit;
        (self.limit - self.weight) / self.limit * (1.0 + ratio) * self.modulus * self.modulus
    }
}

/// A ray L0 = g e^(j phi) from the origin, and the plant whose |q + L0| is the reference for all
/// others along it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) form: InequalityForm,
    /// Direction e^(j phi).
    pub(super) direction: Complex64,
    /// Reference plant q_k; zero in forms other than `Spread`.
    pub(super) other: Complex64,
    /// Magnitude |q_k|.
    pub(super) other_modulus: f64,
    /// Weight r_k of the reference plant; one in forms other than `Spread`.
    pub(super) other_weight: f64,
    /// The gains over which q_k is the reference.
    pub(super) window: [f64; 2],
}

impl Ray {
    /// Coordinate of a plant along the ray.
    ///
    /// ```text
    /// c = Re(conj(q) e^(j phi))
    /// ```
    pub(super) fn along(&self, inverse: Complex64) -> f64 {
        inverse.re * self.direction.re + inverse.im * self.direction.im
    }

    /// Coordinate of a plant across the ray.
    ///
    /// ```text
    /// s = Im(conj(q) e^(j phi))
    /// ```
    fn across(&self, inverse: Complex64) -> f64 {
        inverse.re * self.direction.im - inverse.im * self.direction.re
    }

    /// The gains that this plant forbids along the ray.
    ///
    /// ```text
    /// Complementary, Spread:   a = W^2 - r^2    b = W^2 c - r^2 c_k    c = W^2 |q|^2 - r^2 |q_k|^2
    ///                          b^2 - a c = W^2 r^2 |q - q_k|^2 - (W^2 s - r^2 s_k)^2
    /// Sensitivity:             a = W^2          b = W^2 c              c = (W^2 - r^2) |q|^2
    ///                          b^2 - a c = W^2 (r^2 |q|^2 - W^2 s^2)
    /// ```
    ///
    /// Differences of squares are computed as products of sum and difference.
    pub(super) fn forbidden_by(&self, plant: &WeightedPlant) -> [[f64; 2]; 2] {
        let WeightedPlant { inverse, modulus, limit, .. } = *plant;
        let weight = plant.weight * self.other_weight;
        let (along, across) = (self.along(inverse), self.across(inverse));
        let square = limit * limit;
        let found = match self.form {
            InequalityForm::Complementary => {
                let (radius, distance) = (limit * weight * modulus, square * across.abs());
                negative_gains(
                    (limit - weight) * (limit + weight),
                    square * along,
                    square * modulus * modulus,
                    (radius - distance) * (radius + distance),
                )
            }
            InequalityForm::Sensitivity => {
                let (radius, distance) = (limit * weight * modulus, square * across.abs());
                negative_gains(
                    square,
                    square * along,
                    (limit - weight) * (limit + weight) * modulus * modulus,
                    (radius - distance) * (radius + distance),
                )
            }
            InequalityForm::Spread => {
                let other = weight * weight;
                let apart = inverse - self.other;
                let radius = limit * weight * (apart.re * apart.re + apart.im * apart.im).sqrt();
                let distance = (square * across - other * self.across(self.other)).abs();
                let (ours, theirs) = (limit * modulus, weight * self.other_modulus);
                negative_gains(
                    (limit - weight) * (limit + weight),
                    square * along - other * self.along(self.other),
                    (ours - theirs) * (ours + theirs),
                    (radius - distance) * (radius + distance),
                )
            }
        };
        found.map(|interval| self.within_window(interval))
    }

    /// The part of an interval inside the window. An end within rounding of an end of the window is
    /// moved onto it, so that intervals on both sides of that end meet there.
    pub(super) fn within_window(&self, interval: [f64; 2]) -> [f64; 2] {
        const ROUNDING: f64 = 1e-12;
        let [from, to] = self.window;
        let [mut low, mut high] = interval;
        if low <= from * (1.0 + ROUNDING) {
            low = from;
        }
        if high >= to * (1.0 - ROUNDING) {
            high = to;
        }
        [low, high]
    }
}
