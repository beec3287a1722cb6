//! A tree over the plants of a template, which finds the few that decide a bound along a ray.

use num_complex::Complex64;

use super::inequality::{Form, Plant, Ray};
use super::interval::GainIntervals;
use super::quadratic::negative_gains;

/// Plants in a leaf: enough to be looked at several at a time.
const LEAF: usize = 8;

/// Added to what a box may forbid, relative, so that no rounding hides a plant from the ray.
const SLACK: f64 = 1e-14;

/// The plants of a template in leaves, and above them hulls of leaves, of pairs of hulls, and so on to one hull around all.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    plants: Vec<Plant>,
    leaves: Vec<Leaf>,
    levels: Vec<Vec<Hull>>,
}

/// The quadratics of some plants in columns, divided by W^2.
///
/// ```text
/// (1 - share r_k^2) g^2 + 2 (c - share r_k^2 c_k) g + (constant - share r_k^2 |q_k|^2)
/// ```
#[derive(Clone, Copy, Debug)]
struct Leaf {
    re: [f64; LEAF],
    im: [f64; LEAF],
    constant: [f64; LEAF],
    share: [f64; LEAF],
}

/// What some plants have in common.
///
/// ```text
/// least <= |q| <= greatest,   arg q within an arc,   (r/W)^2 <= share
/// ```
#[derive(Clone, Copy, Debug)]
struct Hull {
    modulus: [f64; 2],
    /// Bearings of the ends of the arc.
    bearing: [f64; 2],
    /// Directions of these ends, q/|q|.
    ends: [Complex64; 2],
    share: f64,
}

impl Tree {
    /// A tree over these plants.
    pub(super) fn new(form: Form, plants: &[Plant]) -> Tree {
        let plants = along_a_curve(plants);
        let leaves = plants.chunks(LEAF).map(|plants| Leaf::of(form, plants)).collect();
        let mut levels: Vec<Vec<Hull>> = vec![plants.chunks(LEAF).filter_map(Hull::around).collect()];
        while let Some(below) = levels.last()
            && below.len() > 1
        {
            levels.push(below.chunks(2).filter_map(Hull::of_all).collect());
        }
        Tree { plants, leaves, levels }
    }

    /// The plants, in an order of their own.
    pub(super) fn plants(&self) -> &[Plant] {
        &self.plants
    }

    /// Adds to the union whatever some plant of the tree forbids along the ray.
    ///
    /// First the leaves that seem to reach lowest and highest, then those that bridge the gap between them, each found by one descent: almost
    /// everything that is forbidden is known by then, and whole hulls need no further look.
    pub(super) fn collect(&self, ray: &Ray, union: &mut GainIntervals) {
        let top = self.levels.len().saturating_sub(1);
        let Some(hull) = self.hull(top, 0) else { return };
        if hull.could_forbid(ray).iter().all(|&interval| union.covers(interval)) {
            return;
        }
        self.collect_best(ray, union, |hull| -extent(&hull.could_forbid(ray))[0]);
        self.collect_best(ray, union, |hull| extent(&hull.could_forbid(ray))[1]);
        let mut reached = 0.0;
        while let &[[_, end], _, ..] = union.intervals()
            && end > reached
        {
            reached = end;
            self.collect_best(ray, union, |hull| -hull.least(ray, end));
        }
        self.collect_below(ray, union, top, 0);
    }

    fn hull(&self, level: usize, place: usize) -> Option<&Hull> {
        self.levels.get(level)?.get(place)
    }

    /// Adds what the leaf forbids that is found by always taking the half of greater merit.
    fn collect_best(&self, ray: &Ray, union: &mut GainIntervals, merit: impl Fn(&Hull) -> f64) {
        let mut place = 0;
        for level in (0..self.levels.len().saturating_sub(1)).rev() {
            let worth = |place| self.hull(level, place).map(&merit);
            place *= 2;
            if worth(place + 1) > worth(place) {
                place += 1;
            }
        }
        self.collect_leaf(ray, union, place);
    }

    fn collect_below(&self, ray: &Ray, union: &mut GainIntervals, level: usize, place: usize) {
        let Some(hull) = self.hull(level, place) else { return };
        let settled = match ray.form {
            Form::Spread => hull.could_forbid(ray).iter().all(|&interval| union.covers(interval)),
            _ => Borders::of_each(ray, union).any(|borders| hull.stays_within(ray, &borders)),
        };
        if settled {
            return;
        }
        if level == 0 {
            self.collect_leaf(ray, union, place);
        } else {
            self.collect_below(ray, union, level - 1, 2 * place);
            self.collect_below(ray, union, level - 1, 2 * place + 1);
        }
    }

    fn collect_leaf(&self, ray: &Ray, union: &mut GainIntervals, place: usize) {
        let Some(leaf) = self.leaves.get(place) else { return };
        if Borders::of_each(ray, union).any(|borders| leaf.stays_within(ray, &borders)) {
            return;
        }
        for plant in self.plants.iter().skip(LEAF * place).take(LEAF) {
            ray.forbidden_by(plant).into_iter().for_each(|interval| union.insert(interval));
        }
    }
}

/// The gains between the least and the greatest of two intervals; where there are none, an interval turned over.
fn extent(intervals: &[[f64; 2]; 2]) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let some = intervals.iter().filter(|[low, high]| low < high);
    some.fold(none, |all, interval| [all[0].min(interval[0]), all[1].max(interval[1])])
}

/// The plants in an order in which neighbours have similar magnitudes and phases: along a curve that fills the plane of both (Morton 1966).
fn along_a_curve(plants: &[Plant]) -> Vec<Plant> {
    let places = || plants.iter().map(|plant| [octave(plant.modulus), bearing(plant.inverse)]);
    let empty = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let ranges = places().fold(empty, |ranges, place| {
        let [first, second] = [0, 1].map(|axis: usize| (ranges[axis], place[axis]));
        [first, second].map(|([least, greatest], value)| [least.min(value), greatest.max(value)])
    });
    let scales =
        ranges.map(|[least, greatest]| if greatest > least { 65535.0 / (greatest - least) } else { 0.0 });
    let mut order: Vec<u64> = places()
        .zip(0_u64..)
        .map(|([octave, bearing], index)| {
            let rows = spread_bits((octave - ranges[0][0]) * scales[0]);
            let columns = spread_bits((bearing - ranges[1][0]) * scales[1]);
            (rows << 1 | columns) << 32 | index
        })
        .collect();
    order.sort_unstable();
    order.into_iter().filter_map(|code| plants.get((code & 0xffff_ffff) as usize).copied()).collect()
}

/// The sixteen bits of an integer below 65536 with a zero before each.
fn spread_bits(value: f64) -> u64 {
    let mut bits = u64::from(value as u16);
    for (shift, mask) in [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

/// A number that grows with a positive one about as its logarithm does: straight between powers of two.
fn octave(value: f64) -> f64 {
    (value.to_bits() >> 20) as f64
}

/// A number in [-2, 2] that grows with the argument of q, free of transcendental functions.
fn bearing(inverse: Complex64) -> f64 {
    let slope = inverse.im / (inverse.re.abs() + inverse.im.abs());
    if inverse.re >= 0.0 { slope } else { 2.0_f64.copysign(inverse.im) - slope }
}

/// An interval that is forbidden already, and what is to be added where nothing lies beyond an end: infinity.
struct Borders {
    ends: [f64; 2],
    beyond: [f64; 2],
}

impl Borders {
    /// Those of each interval of a union.
    fn of_each(ray: &Ray, union: &GainIntervals) -> impl Iterator<Item = Borders> {
        let [from, to] = ray.window;
        let idle = |is_idle: bool| if is_idle { f64::INFINITY } else { 0.0 };
        union.intervals().iter().map(move |&[low, high]| {
            // Where nothing lies above, any number stands for the end.
            let end = if high < to { high } else { low };
            Borders { ends: [low, end], beyond: [idle(low <= from), idle(high >= to)] }
        })
    }

    /// Positive only if a quadratic that opens upwards is positive below the interval: it is so at the border, and falls there.
    fn below(&self, a: f64, b: f64, c: f64) -> f64 {
        let end = self.ends[0];
        lesser(-(a * end + b), (a * end + 2.0 * b) * end + c) + self.beyond[0]
    }

    /// Positive only if a quadratic that opens upwards is positive above the interval: it is so at the border, and rises there.
    fn above(&self, a: f64, b: f64, c: f64) -> f64 {
        let end = self.ends[1];
        lesser(a * end + b, (a * end + 2.0 * b) * end + c) + self.beyond[1]
    }
}

/// The lesser of two numbers; unlike `f64::min` without regard to what is no number, and so a single instruction.
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Leaf {
    /// These plants, the last repeated where there are too few.
    fn of(form: Form, plants: &[Plant]) -> Leaf {
        let mut leaf = Leaf { re: [1.0; LEAF], im: [0.0; LEAF], constant: [1.0; LEAF], share: [0.0; LEAF] };
        let columns = leaf.re.iter_mut().zip(&mut leaf.im).zip(leaf.constant.iter_mut().zip(&mut leaf.share));
        let last = plants.last().into_iter().cycle();
        for (((re, im), (constant, share)), plant) in columns.zip(plants.iter().chain(last)) {
            (*re, *im) = (plant.inverse.re, plant.inverse.im);
            (*constant, *share) = match form {
                Form::Sensitivity => (plant.sensitivity_constant(), 0.0),
                Form::Complementary | Form::Spread => (plant.modulus * plant.modulus, plant.share()),
            };
        }
        leaf
    }

    /// Whether its plants forbid nothing beyond the borders, or nothing at all, told by signs alone; a `false` decides nothing.
    fn stays_within(&self, ray: &Ray, borders: &Borders) -> bool {
        let square = ray.other_weight * ray.other_weight;
        let (along, other) = (ray.along(ray.other), ray.other_modulus * ray.other_modulus);
        let ways = self.re.iter().zip(&self.im).zip(self.constant.iter().zip(&self.share));
        let least = ways.fold(f64::INFINITY, |least, ((re, im), (constant, share))| {
            let share = share * square;
            let a = 1.0 - share;
            let b = re * ray.direction.re + im * ray.direction.im - share * along;
            let c = constant - share * other;
            let within = lesser(borders.below(a, b, c), borders.above(a, b, c));
            // Either the discriminant is negative or the roots lie between the borders.
            let slack = -lesser(-within, b * b - a * c);
            lesser(least, lesser(slack, a))
        });
        least > 0.0
    }
}

impl Hull {
    fn around(plants: &[Plant]) -> Option<Hull> {
        let ways = || plants.iter().map(|plant| (bearing(plant.inverse), plant));
        let (first, right) = ways().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (last, left) = ways().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let moduli = || plants.iter().map(|plant| plant.modulus);
        Some(Hull {
            modulus: [moduli().fold(f64::INFINITY, f64::min), moduli().fold(0.0, f64::max)],
            bearing: [first, last],
            ends: [right, left].map(|plant| plant.inverse / plant.modulus),
            share: plants.iter().map(Plant::share).fold(0.0, f64::max),
        })
    }

    fn of_all(hulls: &[Hull]) -> Option<Hull> {
        hulls.iter().copied().reduce(|all, hull| {
            let right = if hull.bearing[0] < all.bearing[0] { hull } else { all };
            let left = if hull.bearing[1] > all.bearing[1] { hull } else { all };
            Hull {
                modulus: [all.modulus[0].min(hull.modulus[0]), all.modulus[1].max(hull.modulus[1])],
                bearing: [right.bearing[0], left.bearing[1]],
                ends: [right.ends[0], left.ends[1]],
                share: all.share.max(hull.share),
            }
        })
    }

    /// Whether plants inside forbid nothing beyond the borders, or nothing at all, told by signs alone; a `false` decides nothing. Not for
    /// `Spread`.
    fn stays_within(&self, ray: &Ray, borders: &Borders) -> bool {
        let rest = 1.0 - self.share - SLACK * (1.0 + self.share);
        let (a, c) = if ray.form == Form::Complementary { (rest, 1.0) } else { (1.0, rest) };
        let b = self.least_cosine(ray.direction);
        // The quadratic in u = g/|q|, times |q|^2: at the lower border for the nearest plant, at the upper one for the farthest.
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
    fn least(&self, ray: &Ray, gain: f64) -> f64 {
        let cosine = self.least_cosine(ray.direction);
        let [near, far] = self.modulus;
        let modulus = (-gain * cosine).clamp(near, far);
        let share = self.share * ray.other_weight * ray.other_weight;
        let distance = |cosine: f64, modulus: f64| (gain + 2.0 * modulus * cosine) * gain + modulus * modulus;
        let limit = match ray.form {
            Form::Complementary => gain * gain,
            Form::Sensitivity => modulus * modulus,
            Form::Spread => {
                gain * gain + 2.0 * gain * ray.along(ray.other) + ray.other_modulus * ray.other_modulus
            }
        };
        distance(cosine, modulus) - share * limit
    }

    /// Gains among which all lie that a plant inside could forbid: where the least quadratic that the hull allows is negative. Under a limit
    /// of its own, a plant's quadratic depends on u = g/|q|:
    ///
    /// ```text
    /// Complementary   (1 - share) u^2 + 2 u min cos + 1 < 0
    /// Sensitivity     u^2 + 2 u min cos + (1 - share) < 0
    /// Spread          (1 - share) g^2 + 2 (min c - share c_k) g + (min |q|^2 - share |q_k|^2) < 0,  share with r_k^2
    /// ```
    fn could_forbid(&self, ray: &Ray) -> [[f64; 2]; 2] {
        let share = self.share * ray.other_weight * ray.other_weight;
        if !share.is_finite() {
            return [ray.window, [0.0, 0.0]];
        }
        let least = self.least_cosine(ray.direction);
        let [near, far] = self.modulus;
        let rest = 1.0 - share - SLACK * (1.0 + share);
        let scaled = |a: f64, c: f64| {
            negative_gains(a, least, c, least * least - a * c).map(|[low, high]| [low * near, high * far])
        };
        match ray.form {
            Form::Complementary => scaled(rest, 1.0 - SLACK),
            Form::Sensitivity => scaled(1.0 - SLACK, rest),
            Form::Spread => {
                let along = least * if least < 0.0 { far } else { near };
                let other = ray.other_modulus;
                let b = along - share * ray.along(ray.other) - SLACK * (far + share * other);
                let c = near * near - share * other * other - SLACK * (far * far + share * other * other);
                negative_gains(rest, b, c, b * b - rest * c).map(|interval| ray.within_window(interval))
            }
        }
    }
}
