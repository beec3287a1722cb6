//! A tree over the plants of a template, which finds the few that decide a bound along a ray.

use num_complex::Complex64;

use super::inequality::{Form, Plant, Ray};
use super::interval::GainIntervals;
use super::quadratic::negative_gains;

/// Plants in a leaf: about where looking at a plant is as cheap as looking at a box.
const LEAF: usize = 6;

/// Added to what a box may forbid, relative, so that no rounding hides a plant from the ray.
const SLACK: f64 = 1e-14;

/// Plants within a box of the q-plane.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    hull: Hull,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    Leaf(Vec<Plant>),
    Halves(Box<[Tree; 2]>),
}

/// What all plants of a tree have in common.
///
/// ```text
/// q in a rectangle,   (r/W)^2 <= share,   |q|^2 (1 - (r/W)^2) or |q|^2 >= constant
/// ```
#[derive(Clone, Copy, Debug)]
struct Hull {
    re: [f64; 2],
    im: [f64; 2],
    share: f64,
    constant: f64,
    reach: f64,
}

impl Tree {
    /// A tree over these plants, in whose order nothing depends.
    pub(super) fn new(form: Form, plants: &mut [Plant]) -> Tree {
        let hull = Hull::around(form, plants);
        if plants.len() <= LEAF {
            return Tree { hull, content: Content::Leaf(plants.to_vec()) };
        }
        let wide = hull.re[1] - hull.re[0] >= hull.im[1] - hull.im[0];
        let key = |plant: &Plant| if wide { plant.inverse.re } else { plant.inverse.im };
        let middle = plants.len() / 2;
        plants.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        let (left, right) = plants.split_at_mut(middle);
        Tree { hull, content: Content::Halves(Box::new([Tree::new(form, left), Tree::new(form, right)])) }
    }

    /// Adds to the union whatever some plant of the tree forbids along the ray.
    pub(super) fn collect(&self, ray: &Ray, union: &mut GainIntervals) {
        let reach = self.hull.could_forbid(ray);
        self.collect_within(ray, &reach, union);
    }

    fn collect_within(&self, ray: &Ray, reach: &[[f64; 2]; 2], union: &mut GainIntervals) {
        if reach.iter().all(|&interval| union.covers(interval)) {
            return;
        }
        match &self.content {
            Content::Leaf(plants) => {
                for interval in plants.iter().flat_map(|plant| ray.forbidden_by(plant)) {
                    union.insert(interval);
                }
            }
            Content::Halves(halves) => {
                let [left, right] = halves.as_ref();
                let reaches = [left.hull.could_forbid(ray), right.hull.could_forbid(ray)];
                let [of_left, of_right] = &reaches;
                let highest = |reach: &[[f64; 2]; 2]| reach[0][1].max(reach[1][1]);
                if highest(of_left) >= highest(of_right) {
                    left.collect_within(ray, of_left, union);
                    right.collect_within(ray, of_right, union);
                } else {
                    right.collect_within(ray, of_right, union);
                    left.collect_within(ray, of_left, union);
                }
            }
        }
    }
}

impl Hull {
    fn around(form: Form, plants: &[Plant]) -> Hull {
        let empty = [f64::INFINITY, f64::NEG_INFINITY];
        let mut hull = Hull { re: empty, im: empty, share: 0.0, constant: f64::INFINITY, reach: 0.0 };
        for plant in plants {
            let Complex64 { re, im } = plant.inverse;
            hull.re = [hull.re[0].min(re), hull.re[1].max(re)];
            hull.im = [hull.im[0].min(im), hull.im[1].max(im)];
            let constant = match form {
                Form::Sensitivity => plant.sensitivity_constant(),
                Form::Complementary | Form::Spread => plant.modulus * plant.modulus,
            };
            if form != Form::Sensitivity {
                hull.share = hull.share.max(plant.share());
            }
            hull.constant = hull.constant.min(constant);
            hull.reach = hull.reach.max(plant.modulus);
        }
        hull
    }

    /// Gains among which all lie that a plant inside could forbid: where the least quadratic that the hull allows is negative.
    ///
    /// ```text
    /// (1 - share r_k^2) g^2 + 2 (min c - share r_k^2 c_k) g + (constant - share r_k^2 |q_k|^2) < 0
    /// ```
    fn could_forbid(&self, ray: &Ray) -> [[f64; 2]; 2] {
        let share = self.share * ray.other_weight * ray.other_weight;
        if !(share.is_finite() && self.constant.is_finite()) {
            return [ray.window, [0.0, 0.0]];
        }
        let Complex64 { re, im } = ray.direction;
        let least = |[low, high]: [f64; 2], factor: f64| factor * if factor >= 0.0 { low } else { high };
        let along = least(self.re, re) + least(self.im, im);
        let (other, square) = (ray.other_modulus, ray.other_modulus * ray.other_modulus);
        let a = 1.0 - share - SLACK * (1.0 + share);
        let b = along - share * ray.along(ray.other) - SLACK * (self.reach + share * other);
        let c = self.constant - share * square - SLACK * (self.constant.abs() + share * square);
        negative_gains(a, b, c, b * b - a * c).map(|interval| ray.within_window(interval))
    }
}
