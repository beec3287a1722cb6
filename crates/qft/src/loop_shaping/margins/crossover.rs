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
//! also margins for the slopes, though not for the judgement. Where |L| of a continuous loop is
//! still above 1 at the highest column, it is assumed to fall as 1/w from there, with its phase.

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
    /// rad/s
    frequency: f64,
    open: Complex64,
    /// |L|^2
    square: f64,
}

/// |L|^2 of one plant at one column, on the way through the columns.
#[derive(Clone, Copy, Debug)]
struct LoopSize {
    column: usize,
    /// Of the plant in the column.
    place: usize,
    square: f64,
}

impl LoopSize {
    /// Before the first column of a plant.
    const NOTHING: LoopSize = LoopSize { column: usize::MAX, place: usize::MAX, square: f64::NAN };

    /// True where |L| passes through 1 from here to another column.
    fn crosses(&self, other: &LoopSize) -> bool {
        !self.square.is_nan() && (self.square >= 1.0) != (other.square >= 1.0)
    }
}

/// Which way |L| turns at a column.
#[derive(Clone, Copy, Debug)]
enum Bend {
    /// A peak below 1.
    Peak,
    /// A dip above 1.
    Dip,
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

/// What becomes of L above the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AboveColumns {
    /// It falls as 1/w.
    Falling,
    /// There is none: the columns of a sampled loop end at pi/T.
    Nothing,
}

/// The margins to a required delay.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DelayMargins {
    /// At gain crossovers.
    pub(crate) crossovers: Vec<ColumnDependence>,
    /// Where a crossover may appear or vanish.
    pub(crate) peaks: Vec<ColumnDependence>,
}

/// The margins of this number of plants to a delay in s, one plant after the other, each at the
/// centre where it is known within discs; empty where no delay is required.
pub(crate) fn delay_margins(
    columns: &[FrequencyColumn],
    feedback: &[Complex64],
    (plants, above): (usize, AboveColumns),
    delay_s: f64,
) -> DelayMargins {
    if delay_s <= 0.0 {
        return DelayMargins::default();
    }
    let mut trails: Vec<[LoopSize; 2]> = vec![[LoopSize::NOTHING; 2]; plants];
    let mut crossovers: Vec<(usize, ColumnDependence)> = Vec::new();
    let mut peaks: Vec<(usize, ColumnDependence)> = Vec::new();
    let value = |passed: &LoopSize| {
        let LoopSize { column: index, place, .. } = *passed;
        let (column, feedback) = columns.get(index).zip(feedback.get(index))?;
        Some(LoopValue::of(index, column, place, *feedback))
    };
    for (index, (column, feedback)) in columns.iter().zip(feedback).enumerate() {
        let gain = feedback.norm_sqr();
        for (place, (&plant, path)) in column.plants.iter().zip(&column.loop_squared).enumerate() {
            let Some(trail) = trails.get_mut(plant) else { continue };
            let [before, last] = *trail;
            if last.column == index {
                continue;
            }
            let here = LoopSize { column: index, place, square: gain * path };
            *trail = [last, here];
            if last.crosses(&here)
                && let Some((lower, upper)) = value(&last).zip(value(&here))
                && let Some(at) = crossover(&lower, &upper)
            {
                crossovers.push((plant, delay_at(at, [&lower, &upper], delay_s)));
            }
            if let Some(bend) = bend([before, last, here].map(|passed| passed.square))
                && let Some(point) = value(&last)
            {
                peaks.extend(peak(bend, &point, delay_s).map(|peak| (plant, peak)));
            }
        }
    }
    if above == AboveColumns::Falling {
        let ends = trails.iter().enumerate().filter(|(_, [_, last])| last.square >= 1.0);
        let beyond =
            ends.filter_map(|(plant, [_, last])| Some((plant, delay_beyond(&value(last)?, delay_s))));
        crossovers.extend(beyond);
    }
    let of_plants = |mut found: Vec<(usize, ColumnDependence)>| {
        found.sort_by_key(|(plant, _)| *plant);
        found.into_iter().map(|(_, margin)| margin).collect()
    };
    DelayMargins { crossovers: of_plants(crossovers), peaks: of_plants(peaks) }
}

/// The highest gain crossover of the nominal loop, 20 log10 of its frequency in rad/s; beyond the
/// columns |L| is assumed to fall as 1/w. `None` where the nominal plant is not evaluated.
pub(crate) fn bandwidth(columns: &[FrequencyColumn], feedback: &[Complex64]) -> Option<ColumnDependence> {
    let path = nominal_path(columns, feedback);
    let (first, last) = (path.first()?, path.last()?);
    let outside = |point: &LoopValue| ColumnDependence {
        value_db: DECIBELS_PER_NEPER * (point.logarithm_of_frequency() + point.size()),
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

/// L of the nominal plant along the columns; its centre where it is known within discs.
fn nominal_path(columns: &[FrequencyColumn], feedback: &[Complex64]) -> Vec<LoopValue> {
    let values = columns.iter().zip(feedback).enumerate().filter_map(|(index, (column, feedback))| {
        let place = column.plants.iter().position(|plant| *plant == 0)?;
        Some(LoopValue::of(index, column, place, *feedback))
    });
    values.collect()
}

impl LoopValue {
    fn of(index: usize, column: &FrequencyColumn, place: usize, feedback: Complex64) -> LoopValue {
        let open = column.loop_at(place) * feedback;
        LoopValue { column: index, frequency: column.frequency, open, square: open.norm_sqr() }
    }

    /// ln w
    fn logarithm_of_frequency(&self) -> f64 {
        portable::ln(self.frequency)
    }

    /// ln|L|
    fn size(&self) -> f64 {
        0.5 * portable::ln(self.square)
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
    if (lower.square >= 1.0) == (upper.square >= 1.0) {
        return None;
    }
    let (a, b) = (lower.size(), upper.size());
    let width = upper.logarithm_of_frequency() - lower.logarithm_of_frequency();
    let share = a / (a - b);
    Some(Crossover {
        logarithm: lower.logarithm_of_frequency() + share * width,
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

/// The margin to a delay where |L| falls as 1/w from the highest column on.
fn delay_beyond(last: &LoopValue, delay_s: f64) -> ColumnDependence {
    let angle = positive(last.angle());
    let margin = portable::ln(angle) - last.logarithm_of_frequency() - last.size() - portable::ln(delay_s);
    let factor = DECIBELS_PER_NEPER * Complex64::new(-1.0, -1.0 / angle);
    ColumnDependence { value_db: DECIBELS_PER_NEPER * margin, terms: vec![(last.column, factor)] }
}

/// A peak of |L|^2 below 1, or a dip above it, at the second of three columns.
fn bend([low, here, high]: [f64; 3]) -> Option<Bend> {
    if here < 1.0 && low < here && high <= here {
        Some(Bend::Peak)
    } else if here > 1.0 && low > here && high >= here {
        Some(Bend::Dip)
    } else {
        None
    }
}

/// |L| at a peak or dip, where the phase alone would not tolerate the delay.
fn peak(bend: Bend, point: &LoopValue, delay_s: f64) -> Option<ColumnDependence> {
    let size = point.size();
    if size.abs() >= NEAR {
        return None;
    }
    let tolerates = positive(point.angle()) > portable::exp(point.logarithm_of_frequency()) * delay_s;
    let sign = match bend {
        Bend::Peak => -1.0,
        Bend::Dip => 1.0,
    };
    (!tolerates).then(|| ColumnDependence {
        value_db: DECIBELS_PER_NEPER * size.abs(),
        terms: vec![(point.column, Complex64::new(sign * DECIBELS_PER_NEPER, 0.0))],
    })
}

/// The same angle in [0, 2 pi).
fn positive(angle: f64) -> f64 {
    if angle < -ROUNDING { angle + 2.0 * PI } else { angle.max(0.0) }
}
