//! Structures of prefilters, by growing order.

use std::ops::RangeInclusive;

use phea_dynamics::portable;

use super::PrefilterBand;
use crate::loop_shaping::{Structure, StructureFactor};

/// Range of the damping ratio of a pair: from moderate ringing at 0.3 to two real roots at a ratio
/// of about 3600.
const DAMPING_RATIO: [f64; 2] = [0.3, 30.0];
/// Factor above the highest frequency up to which a pole or zero may be placed; beyond that it has
/// no effect.
const BEYOND: f64 = 10.0;
/// Range of the gain without a lower tracking limit, dB.
const GAIN_RANGE_DB: f64 = 40.0;

/// Every structure of these orders, the lowest order first and for each order the fewest zeros
/// first.
///
/// ```text
/// F = k (zeros)/(poles),     poles and zeros in pairs, and a single one if their number is odd
/// ```
pub(super) fn structures(
    band: &PrefilterBand,
    least_relative_degree: usize,
    orders: RangeInclusive<usize>,
) -> Vec<Structure> {
    let [least, greatest] = band.relative_degree;
    let least = least.max(least_relative_degree.min(greatest));
    let degrees = orders.flat_map(|order| (0..=order).map(move |zeros| (order, zeros)));
    let allowed = degrees.filter(|(order, zeros)| (least..=greatest).contains(&(order - zeros)));
    allowed.map(|(order, zeros)| structure(band, order, zeros)).collect()
}

fn structure(band: &PrefilterBand, order: usize, zeros: usize) -> Structure {
    let [from, to] = band.span;
    let range = [from, BEYOND * to];
    let pole = StructureFactor::RealPole { frequency: range };
    let pole_pair = StructureFactor::PolePair { natural_frequency: range, damping_ratio: DAMPING_RATIO };
    let zero = StructureFactor::RealZero { frequency: range };
    let zero_pair = StructureFactor::ZeroPair { natural_frequency: range, damping_ratio: DAMPING_RATIO };
    let mut parts = vec![pole_pair; order / 2];
    parts.extend(vec![pole; order % 2]);
    parts.extend(vec![zero_pair; zeros / 2]);
    parts.extend(vec![zero; zeros % 2]);
    let gain = gain_db(band.gain_db).map(|decibels| portable::pow(10.0, decibels / 20.0));
    Structure { sign: 1.0, gain, parts }
}

/// The range of the gain: the middle of edges that have crossed, and a finite end without a lower
/// limit.
fn gain_db([least, greatest]: [f64; 2]) -> [f64; 2] {
    if least > greatest {
        return [(least + greatest) / 2.0; 2];
    }
    [least.max(greatest - GAIN_RANGE_DB), greatest]
}
