//! A tree over the plants of a template, which finds the few that decide a bound along a ray.

use super::hull::{Hull, bearing};
use super::inequality::{InequalityForm, Ray, WeightedPlant};
use super::interval::GainIntervals;
use super::leaf::{Borders, LEAF, Leaf};

/// The plants of a template in leaves, below a binary tree of hulls up to one hull around all.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    plants: Vec<WeightedPlant>,
    leaves: Vec<Leaf>,
    levels: Vec<Vec<Hull>>,
}

impl Tree {
    /// A tree over these plants.
    pub(super) fn new(form: InequalityForm, plants: &[WeightedPlant]) -> Tree {
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

    /// The plants, in the order of the tree.
    pub(super) fn plants(&self) -> &[WeightedPlant] {
        &self.plants
    }

    /// Adds to the union all gains that some plant of the tree forbids along the ray.
    ///
    /// The search begins with the leaves that seem to reach lowest and highest, then those that
    /// bridge the gap between them, each found by one descent: almost all forbidden gains are known
    /// by then, and whole hulls can be skipped.
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

    /// Adds the gains forbidden by one leaf, found by always taking the half of greater merit.
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
            InequalityForm::Spread => hull.could_forbid(ray).iter().all(|&interval| union.covers(interval)),
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

/// The gains between the least and the greatest of two intervals; an inverted interval if there are
/// none.
fn extent(intervals: &[[f64; 2]; 2]) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let some = intervals.iter().filter(|[low, high]| low < high);
    some.fold(none, |all, interval| [all[0].min(interval[0]), all[1].max(interval[1])])
}

/// The plants in an order in which neighbours have similar magnitudes and phases: along a curve
/// that fills the plane of both (Morton 1966).
fn along_a_curve(plants: &[WeightedPlant]) -> Vec<WeightedPlant> {
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

/// A number that grows roughly as the logarithm of a positive one: linear between powers of two.
fn octave(value: f64) -> f64 {
    (value.to_bits() >> 20) as f64
}
