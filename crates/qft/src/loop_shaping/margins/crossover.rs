//! Quantities at |L| = 1: the delay that a plant tolerates, and the bandwidth of the nominal loop.
//!
//! ```text
//! delay = (arg L + pi)/w at each gain crossover w,      margin = 20 log10(least delay/delay demanded)
//! ```
//!
//! Poles of a stable loop cross to the right half plane at a gain crossover only, so this is the
//! complete demand: it is exact except for the frequency of the crossover and the phase there,
//! which are interpolated between the frequencies of the samples, ln|L| and arg L straight over ln
//! w. The margin is as steep for a demand that is missed as for one that is met, and falls to minus
//! infinity as a loop becomes unstable. In a sampled loop it is that of the sampled L, exact for a
//! delay of whole samples. A crossover appears or vanishes when a peak of |L| passes through 1; so
//! the peaks below 1 and the dips above it at which the phase alone would violate the demand are
//! also margins for the slopes, though not for the judgement.

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::portable;

use super::super::samples::FrequencyColumn;
use super::super::structure::DECIBELS_PER_NEPER;

/// A peak or dip that comes this near to 1 is a margin, in nepers.
const NEAR: f64 = 0.7;
/// An angle this little below zero is rounding, rad.
const ROUNDING: f64 = 1e-12;

/// L of one plant at one column.
#[derive(Clone, Copy, Debug)]
struct LoopValue {
    column: usize,
    logarithm_of_frequency: f64,
    open: Complex64,
}

/// ln|L| through zero between two columns.
#[derive(Clone, Copy, Debug)]
struct Crossover {
    /// ln w
    logarithm: f64,
    /// ln w of the upper column less that of the lower one.
    width: f64,
    /// Where between the columns, from 0 to 1.
    share: f64,
    /// Derivative of the share with respect to ln|L| at either column.
    share_slopes: [f64; 2],
}

/// A number in dB that depends on G at some columns.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ColumnDependence {
    pub(crate) value_db: f64,
    /// It moves by Re(factor d ln G), summed over these columns.
    pub(crate) terms: Vec<(usize, Complex64)>,
}

/// The margins to a required delay.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DelayMargins {
    /// At gain crossovers.
    pub(crate) crossovers: Vec<ColumnDependence>,
    /// Where a crossover may appear or vanish.
    pub(crate) peaks: Vec<ColumnDependence>,
}

/// The margins of this number of plants to a delay in s; empty where no delay is required.
pub(crate) fn delay_margins(
    columns: &[FrequencyColumn],
    feedback: &[Complex64],
    plants: usize,
    delay_s: f64,
) -> DelayMargins {
    let mut margins = DelayMargins::default();
    if delay_s <= 0.0 {
        return margins;
    }
    for path in paths(columns, feedback, plants) {
        margins.crossovers.extend(path.windows(2).filter_map(|pair| match pair {
            [lower, upper] => Some(delay_at(crossover(lower, upper)?, [lower, upper], delay_s)),
            _ => None,
        }));
        margins.peaks.extend(path.windows(3).filter_map(|three| match three {
            [before, point, after] => peak(before, point, after, delay_s),
            _ => None,
        }));
    }
    margins
}

/// The highest gain crossover of the nominal loop, 20 log10 of its frequency in rad/s; beyond the
/// columns |L| is assumed to fall as 1/w. `None` where the nominal plant is not evaluated.
pub(crate) fn bandwidth(columns: &[FrequencyColumn], feedback: &[Complex64]) -> Option<ColumnDependence> {
    let path = paths(columns, feedback, 1).into_iter().next()?;
    let (first, last) = (path.first()?, path.last()?);
    let outside = |point: &LoopValue| ColumnDependence {
        value_db: DECIBELS_PER_NEPER * (point.logarithm_of_frequency + point.size()),
        terms: vec![(point.column, Complex64::new(DECIBELS_PER_NEPER, 0.0))],
    };
    if last.size() >= 0.0 {
        return Some(outside(last));
    }
    let highest = path.windows(2).rev().find_map(|pair| match pair {
        [lower, upper] => Some((crossover(lower, upper)?, [lower, upper])),
        _ => None,
    });
    let Some((crossover, points)) = highest else { return Some(outside(first)) };
    let scale = DECIBELS_PER_NEPER * crossover.width;
    let slopes = crossover.share_slopes.map(|slope| Complex64::new(scale * slope, 0.0));
    Some(ColumnDependence {
        value_db: DECIBELS_PER_NEPER * crossover.logarithm,
        terms: points.iter().map(|point| point.column).zip(slopes).collect(),
    })
}

/// L of this number of plants along the columns; the centre of a plant that is known within discs.
fn paths(columns: &[FrequencyColumn], feedback: &[Complex64], plants: usize) -> Vec<Vec<LoopValue>> {
    let mut paths = vec![Vec::with_capacity(columns.len()); plants];
    for (index, (column, feedback)) in columns.iter().zip(feedback).enumerate() {
        let logarithm_of_frequency = portable::ln(column.frequency);
        for (place, &plant) in column.plants.iter().enumerate() {
            let open = column.loop_at(place) * feedback;
            let is_centre = |path: &&mut Vec<LoopValue>| path.last().is_none_or(|last| last.column != index);
            if let Some(path) = paths.get_mut(plant).filter(is_centre) {
                path.push(LoopValue { column: index, logarithm_of_frequency, open });
            }
        }
    }
    paths
}

impl LoopValue {
    /// ln|L|
    fn size(&self) -> f64 {
        0.5 * portable::ln(self.open.norm_sqr())
    }

    /// arg L + pi, in (-pi, pi].
    fn angle(&self) -> f64 {
        portable::argument(-self.open)
    }
}

/// ```text
/// share = a/(a - b),   a, b = ln|L| at the lower and the upper column
/// ```
fn crossover(lower: &LoopValue, upper: &LoopValue) -> Option<Crossover> {
    if (lower.open.norm_sqr() >= 1.0) == (upper.open.norm_sqr() >= 1.0) {
        return None;
    }
    let (a, b) = (lower.size(), upper.size());
    let width = upper.logarithm_of_frequency - lower.logarithm_of_frequency;
    let share = a / (a - b);
    Some(Crossover {
        logarithm: lower.logarithm_of_frequency + share * width,
        width,
        share,
        share_slopes: [-b, a].map(|size| size / ((a - b) * (a - b))),
    })
}

/// The margin to a delay at a crossover.
fn delay_at(crossover: Crossover, [lower, upper]: [&LoopValue; 2], delay_s: f64) -> ColumnDependence {
    let turn = portable::argument(upper.open / lower.open);
    let angle = positive(lower.angle() + crossover.share * turn);
    let margin = portable::ln(angle) - crossover.logarithm - portable::ln(delay_s);
    let by_share = turn / angle - crossover.width;
    let shares = [1.0 - crossover.share, crossover.share];
    let term = |point: &LoopValue, share_slope: f64, share: f64| {
        (point.column, DECIBELS_PER_NEPER * Complex64::new(by_share * share_slope, -share / angle))
    };
    let [below, above] = crossover.share_slopes;
    ColumnDependence {
        value_db: DECIBELS_PER_NEPER * margin,
        terms: vec![term(lower, below, shares[0]), term(upper, above, shares[1])],
    }
}

/// |L| at a peak below 1 or a dip above it, where the phase alone would not tolerate the delay.
fn peak(before: &LoopValue, point: &LoopValue, after: &LoopValue, delay_s: f64) -> Option<ColumnDependence> {
    let [low, here, high] = [before, point, after].map(|point| point.open.norm_sqr());
    let sign = if here < 1.0 && low < here && high <= here {
        -1.0
    } else if here > 1.0 && low > here && high >= here {
        1.0
    } else {
        return None;
    };
    let size = point.size();
    let tolerates = positive(point.angle()) > portable::exp(point.logarithm_of_frequency) * delay_s;
    (!tolerates && size.abs() < NEAR).then(|| ColumnDependence {
        value_db: DECIBELS_PER_NEPER * size.abs(),
        terms: vec![(point.column, Complex64::new(sign * DECIBELS_PER_NEPER, 0.0))],
    })
}

/// The same angle in [0, 2 pi).
fn positive(angle: f64) -> f64 {
    if angle < -ROUNDING { angle + 2.0 * PI } else { angle.max(0.0) }
}
