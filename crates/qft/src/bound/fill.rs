//! The region between the plants of a template: its contour and its interior.

use num_complex::Complex64;

use super::inequality::{Ray, WeightedPlant};
use super::interval::GainIntervals;
use super::quadratic::negative_gains;

/// A piece of contour, every point of which counts as a plant.
///
/// ```text
/// q(t) = q_a + t (q_b - q_a),   e(t) = e_a + t (e_b - e_a) - t (1 - t) kappa,   0 <= t <= 1
/// forbidden:  (1 - share) g^2 + 2 c(t) g + e(t) < 0
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// Values of q at both ends.
    pub(super) ends: [Complex64; 2],
    /// Values of e at both ends.
    pub(super) constants: [f64; 2],
    /// Curvature kappa.
    pub(super) curvature: f64,
    /// Coefficient (r/W)^2 of |q_k + L0|^2, the greater of the two ends.
    pub(super) fraction: f64,
    /// True if the variable is 1/g: for the control effort, with P/P0 conjugated in place of q.
    pub(super) reciprocal: bool,
}

impl Edge {
    /// The edge between two plants that are compared with |L0| or with another plant; e = |q|^2.
    pub(super) fn of_complementary(ends: [&WeightedPlant; 2]) -> Edge {
        let [from, to] = ends.map(|plant| plant.inverse);
        Edge {
            ends: [from, to],
            constants: [from.norm_sqr(), to.norm_sqr()],
            curvature: (to - from).norm_sqr(),
            fraction: ends.map(WeightedPlant::fraction).into_iter().fold(0.0, f64::max),
            reciprocal: false,
        }
    }

    /// The edge between two plants whose sensitivity is limited.
    ///
    /// ```text
    /// e = |q|^2 - |u|^2/W^2,    u linear from one plant to the other
    /// ```
    pub(super) fn of_sensitivity(
        ends: [&WeightedPlant; 2],
        disturbances: [Complex64; 2],
        limit: f64,
    ) -> Edge {
        let [from, to] = ends.map(|plant| plant.inverse);
        let change = (disturbances[1] - disturbances[0]).norm_sqr() / limit / limit;
        Edge {
            ends: [from, to],
            constants: ends.map(WeightedPlant::sensitivity_constant),
            curvature: (to - from).norm_sqr() - change,
            fraction: 0.0,
            reciprocal: false,
        }
    }

    /// The edge between two plants whose control effort is limited, in x = P/P0 and 1/g.
    ///
    /// ```text
    /// |G/(1+L)| <= W :   (1/g)^2 + 2 Re(x e^(j phi)) (1/g) + |x|^2 - 1/(W |P0 H0|)^2 >= 0
    /// ```
    pub(super) fn of_control_effort(ends: [&WeightedPlant; 2], nominal_limit: f64) -> Edge {
        let [from, to] = ends.map(|plant| plant.inverse.inv().conj());
        let constant = |point: Complex64| point.norm_sqr() - 1.0 / nominal_limit / nominal_limit;
        Edge {
            ends: [from, to],
            constants: [constant(from), constant(to)],
            curvature: (to - from).norm_sqr(),
            fraction: 0.0,
            reciprocal: true,
        }
    }

    /// The gains forbidden by the inner points of the edge; its ends count as plants.
    ///
    /// ```text
    /// t(g) = (kappa - (e_b - e_a) - 2 g (c_b - c_a))/(2 kappa) = t_0 + t_1 g     where the quadratic is least over t
    /// least = (1 - share - kappa t_1^2) g^2 + 2 (c_a - kappa t_0 t_1) g + e_a - kappa t_0^2     while 0 < t(g) < 1
    /// ```
    pub(super) fn forbidden(&self, ray: &Ray, union: &mut GainIntervals) {
        if self.curvature.is_nan() || self.curvature <= 0.0 {
            return;
        }
        let [from, to] = self.ends.map(|end| ray.along(end));
        let start = (self.curvature - (self.constants[1] - self.constants[0])) / (2.0 * self.curvature);
        let slope = (from - to) / self.curvature;
        let [first, last] = match slope {
            0.0 if start > 0.0 && start < 1.0 => [0.0, f64::INFINITY],
            0.0 => return,
            _ => {
                let (one, other) = (-start / slope, (1.0 - start) / slope);
                [one.min(other).max(0.0), one.max(other)]
            }
        };
        let gains =
            |[low, high]: [f64; 2]| if self.reciprocal { [1.0 / high, 1.0 / low] } else { [low, high] };
        if union.covers(ray.within_window(gains([first, last]))) {
            return;
        }
        let fraction = self.fraction * ray.other_weight * ray.other_weight;
        let a = 1.0 - fraction - self.curvature * slope * slope;
        let b = from - self.curvature * start * slope - fraction * ray.along(ray.other);
        let c = self.constants[0]
            - self.curvature * start * start
            - fraction * ray.other_modulus * ray.other_modulus;
        for [low, high] in negative_gains(a, b, c, b * b - a * c) {
            let (low, high) = (low.max(first), high.min(last));
            if low < high {
                union.insert(ray.within_window(gains([low, high])));
            }
        }
    }
}

/// The gains at which -L0 is inside a closed polygon of q = P0/P: some plant between the plants
/// then has 1 + L = 0.
///
/// The inside is the region around which the polygon winds: a polygon that overlaps itself, such as
/// the outline of a template over more than a full turn of phase, encloses the overlap too. Far
/// outside the winding number is zero, and each side that the ray crosses on its way in changes it
/// by one.
pub(super) fn inside(polygon: &[Complex64], direction: Complex64) -> GainIntervals {
    let across = |point: &Complex64| point.re * direction.im - point.im * direction.re;
    let along = |point: &Complex64| -(point.re * direction.re + point.im * direction.im);
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let mut crossings: Vec<(f64, i32)> = sides
        .filter_map(|(from, to)| {
            let turn = i32::from(across(to) > 0.0) - i32::from(across(from) > 0.0);
            let fraction = across(from) / (across(from) - across(to));
            let gain = along(from) + fraction * (along(to) - along(from));
            (turn != 0 && gain > 0.0).then_some((gain, turn))
        })
        .collect();
    crossings.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let ends = crossings.iter().skip(1).map(|crossing| crossing.0).chain([0.0]);
    let mut winding = 0;
    let within = crossings.iter().zip(ends).filter_map(|(&(gain, turn), end)| {
        winding += turn;
        (winding != 0).then_some([end, gain])
    });
    GainIntervals::union_of(within.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(points: &[(f64, f64)]) -> Vec<Complex64> {
        points.iter().map(|&(re, im)| Complex64::new(re, im)).collect()
    }

    /// A notched square: a ray through the notch enters twice, one from within leaves once.
    #[test]
    fn a_ray_is_inside_a_polygon_between_its_crossings() {
        let notched = points(&[
            (1.0, -1.0),
            (4.0, -1.0),
            (4.0, 1.0),
            (3.0, 1.0),
            (3.0, -0.5),
            (2.0, -0.5),
            (2.0, 1.0),
            (1.0, 1.0),
        ]);
        let back = Complex64::new(-1.0, 0.0);
        assert_eq!(inside(&notched, back).intervals(), [[1.0, 2.0], [3.0, 4.0]]);
        assert!(inside(&notched, -back).is_empty());
        let around = points(&[(-1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-1.0, 1.0)]);
        assert_eq!(inside(&around, back).intervals(), [[0.0, 2.0]]);
        assert_eq!(inside(&around, -back).intervals(), [[0.0, 1.0]]);
        assert!(inside(&[], back).is_empty());
        let twice: Vec<Complex64> = notched.iter().chain(&notched).copied().collect();
        assert_eq!(inside(&twice, back), inside(&notched, back));
    }
}
