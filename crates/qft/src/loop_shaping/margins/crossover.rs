//! Quantities at |L| = 1: the delay that a plant tolerates, and the bandwidth of the nominal loop.
//!
//! ```text
//! delay = (arg L + pi)/w at each gain crossover w,      margin = 20 log10(least delay/required delay)
//! ```
//!
//! Poles of a stable loop cross to the right half plane only at a gain crossover, so that this is
//! the complete requirement: it is exact except for the frequency of the crossover and the phase
//! there, which are interpolated between the frequencies of the samples, ln|L| and arg L linearly
//! in ln w. The margin is as steep for a violated requirement as for a satisfied one, and falls to
//! minus infinity as a loop becomes unstable. In a sampled loop it refers to the sampled L, exact
//! for a delay of whole samples. A crossover appears or vanishes when a peak of |L| passes through
//! 1; therefore the peaks below 1 and the dips above it at which the phase would violate the
//! requirement also give slopes of margins, but are not evaluated as margins. If |L| of a
//! continuous loop is still above 1 at the highest column, it is assumed to fall as 1/w from there,
//! with its phase.

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::portable;

use super::super::samples::FrequencyColumn;
use super::super::structure::DECIBELS_PER_NEPER;

/// Distance of a peak or dip from 1 below which it is a margin, nepers.
const NEAR: f64 = 0.7;
/// Negative angle that counts as rounding error, rad.
const ROUNDING: f64 = 1e-12;

/// Open loop L of one plant at one column.
#[derive(Clone, Copy, Debug)]
struct LoopValue {
    column: usize,
    /// Frequency, rad/s.
    frequency: f64,
    open: Complex64,
    /// Squared magnitude |L|^2.
    square: f64,
}

/// Squared magnitude |L|^2 of each plant at the last two columns where it was evaluated; NaN before
/// them.
struct Trails {
    before: Vec<f64>,
    last: Vec<f64>,
    /// The last of these columns for each plant, and the plant's place in it.
    columns: Vec<usize>,
    places: Vec<usize>,
}

/// Number of plants whose |L|^2 are compared together: mostly none of them passes through 1 or
/// turns.
const TOGETHER: usize = 16;

impl Trails {
    fn new(plants: usize) -> Trails {
        let none = || vec![f64::NAN; plants];
        Trails {
            before: none(),
            last: none(),
            columns: vec![usize::MAX; plants],
            places: vec![usize::MAX; plants],
        }
    }

    /// True if |L| passes through 1 from the last column to one with this |L|^2.
    fn passes(last: f64, square: f64) -> bool {
        !last.is_nan() & ((last >= 1.0) != (square >= 1.0))
    }

    /// True if |L| passes through 1, or turned at the last column.
    fn is_notable(before: f64, last: f64, square: f64) -> bool {
        let peak = (last < 1.0) & (before < last) & (square <= last);
        let dip = (last > 1.0) & (before > last) & (square >= last);
        Self::passes(last, square) | peak | dip
    }

    /// The notable ones of the first plants, by their |L|^2 at a column.
    fn notable(&self, squares: &[f64]) -> Vec<usize> {
        let mut found = Vec::new();
        let trails = self.before.chunks(TOGETHER).zip(self.last.chunks(TOGETHER));
        for (number, ((before, last), squares)) in trails.zip(squares.chunks(TOGETHER)).enumerate() {
            let each = || before.iter().zip(last).zip(squares);
            let notable = each().map(|((before, last), square)| Self::is_notable(*before, *last, *square));
            if notable.clone().fold(false, |any, one| any | one) {
                let places = notable.enumerate().filter(|(_, is_one)| *is_one);
                found.extend(places.map(|(place, _)| number * TOGETHER + place));
            }
        }
        found
    }

    /// Moves the first plants to a column.
    fn advance_all(&mut self, index: usize, squares: &[f64]) {
        let count = squares.len().min(self.last.len());
        self.before[..count].copy_from_slice(&self.last[..count]);
        self.last[..count].copy_from_slice(&squares[..count]);
        self.columns[..count].fill(index);
        self.places[..count].iter_mut().enumerate().for_each(|(place, own)| *own = place);
    }

    /// Moves one plant to a column.
    fn advance(&mut self, plant: usize, (index, place): (usize, usize), square: f64) {
        self.before[plant] = self.last[plant];
        self.last[plant] = square;
        (self.columns[plant], self.places[plant]) = (index, place);
    }
}

/// Direction in which |L| turns at a column.
#[derive(Clone, Copy, Debug)]
enum Bend {
    /// A peak below 1.
    Peak,
    /// A dip above 1.
    Dip,
}

/// Zero crossing of ln|L| between two columns.
#[derive(Clone, Copy, Debug)]
struct Crossover {
    /// Logarithm of the frequency, ln w.
    logarithm: f64,
    /// Difference of ln w between the upper and the lower column.
    width: f64,
    /// Position between the columns, from 0 to 1.
    fraction: f64,
    /// Derivative of this position with respect to ln|L| at either column.
    fraction_slopes: [f64; 2],
}

/// A quantity in dB that depends on G at some columns.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ColumnDependence {
    pub(crate) value_db: f64,
    /// Terms of the change Re(factor d ln G), summed over these columns.
    pub(crate) terms: Vec<(usize, Complex64)>,
}

/// Behaviour of L above the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AboveColumns {
    /// Decay as 1/w.
    Falling,
    /// End of the response: the columns of a sampled loop end at pi/T.
    Nothing,
}

/// The margins to a required delay.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DelayMargins {
    /// Margins at gain crossovers.
    pub(crate) crossovers: Vec<ColumnDependence>,
    /// Margins where a crossover may appear or vanish.
    pub(crate) peaks: Vec<ColumnDependence>,
}

/// The margins of this number of plants to a delay, s, one plant after the other, each at the
/// centre of its disc if it has one; empty if no delay is required.
pub(crate) fn delay_margins(
    columns: &[FrequencyColumn],
    feedback: &[Complex64],
    (plants, above): (usize, AboveColumns),
    delay_s: f64,
) -> DelayMargins {
    if delay_s <= 0.0 {
        return DelayMargins::default();
    }
    let mut search = DelaySearch {
        columns,
        feedback,
        delay_s,
        trails: Trails::new(plants),
        crossovers: vec![],
        peaks: vec![],
    };
    let mut squares: Vec<f64> = Vec::new();
    for (index, (column, feedback)) in columns.iter().zip(feedback).enumerate() {
        let gain = feedback.norm_sqr();
        squares.clear();
        squares.extend(column.loop_squared.iter().map(|path| gain * path));
        if column.in_order && squares.len() <= plants {
            search.go_on_with_all(index, &squares);
        } else {
            search.go_on(index, column, &squares);
        }
    }
    if above == AboveColumns::Falling {
        search.go_beyond();
    }
    let of_plants = |mut found: Vec<(usize, ColumnDependence)>| {
        found.sort_by_key(|(plant, _)| *plant);
        found.into_iter().map(|(_, margin)| margin).collect()
    };
    DelayMargins { crossovers: of_plants(search.crossovers), peaks: of_plants(search.peaks) }
}

/// The search for margins to a delay, in progress through the columns.
struct DelaySearch<'a> {
    columns: &'a [FrequencyColumn],
    feedback: &'a [Complex64],
    delay_s: f64,
    trails: Trails,
    /// Crossovers, each with its plant.
    crossovers: Vec<(usize, ColumnDependence)>,
    peaks: Vec<(usize, ColumnDependence)>,
}

impl DelaySearch<'_> {
    /// Open loop of a plant at a place in a column.
    fn value(&self, index: usize, place: usize) -> Option<LoopValue> {
        let (column, feedback) = self.columns.get(index).zip(self.feedback.get(index))?;
        Some(LoopValue::of(index, column, place, *feedback))
    }

    /// Records a notable plant at a place in a column.
    fn note(&mut self, plant: usize, (index, place): (usize, usize), square: f64) {
        let Trails { before, last, columns, places } = &self.trails;
        let (before, last, from) = (before[plant], last[plant], (columns[plant], places[plant]));
        let Some(lower) = self.value(from.0, from.1) else { return };
        if Trails::passes(last, square)
            && let Some(upper) = self.value(index, place)
            && let Some(at) = crossover(&lower, &upper)
        {
            self.crossovers.push((plant, delay_at(at, [&lower, &upper], self.delay_s)));
        }
        let bend = bend([before, last, square]);
        self.peaks.extend(bend.and_then(|bend| peak(bend, &lower, self.delay_s)).map(|peak| (plant, peak)));
    }

    /// Advances the first plants, in their order, to a column.
    fn go_on_with_all(&mut self, index: usize, squares: &[f64]) {
        for place in self.trails.notable(squares) {
            self.note(place, (index, place), squares[place]);
        }
        self.trails.advance_all(index, squares);
    }

    /// Advances any plants to a column; for one within a disc the first response is the centre.
    fn go_on(&mut self, index: usize, column: &FrequencyColumn, squares: &[f64]) {
        for (place, (&plant, &square)) in column.plants.iter().zip(squares).enumerate() {
            if self.trails.columns.get(plant).is_none_or(|last| *last == index) {
                continue;
            }
            if Trails::is_notable(self.trails.before[plant], self.trails.last[plant], square) {
                self.note(plant, (index, place), square);
            }
            self.trails.advance(plant, (index, place), square);
        }
    }

    /// Continues beyond the last column, where |L| falls as 1/w.
    fn go_beyond(&mut self) {
        let Trails { last, columns, places, .. } = &self.trails;
        let ends = last.iter().enumerate().filter(|(_, square)| **square >= 1.0);
        let beyond = ends.filter_map(|(plant, _)| {
            Some((plant, delay_beyond(&self.value(columns[plant], places[plant])?, self.delay_s)))
        });
        let beyond: Vec<(usize, ColumnDependence)> = beyond.collect();
        self.crossovers.extend(beyond);
    }
}

/// The highest gain crossover of the nominal loop, 20 log10 of its frequency, rad/s; beyond the
/// columns |L| is assumed to fall as 1/w. `None` if the nominal plant is not evaluated.
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
    let slopes = crossover.fraction_slopes.map(|slope| Complex64::new(scale * slope, 0.0));
    Some(ColumnDependence {
        value_db: DECIBELS_PER_NEPER * crossover.logarithm,
        terms: points.iter().map(|point| point.column).zip(slopes).collect(),
    })
}

/// Open loop of the nominal plant along the columns; the centre if it is known within discs.
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

    /// Logarithm of the frequency, ln w.
    fn logarithm_of_frequency(&self) -> f64 {
        portable::ln(self.frequency)
    }

    /// Logarithm of the magnitude, ln|L|.
    fn size(&self) -> f64 {
        0.5 * portable::ln(self.square)
    }

    /// Angle arg L + pi, in (-pi, pi].
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
    let fraction = a / (a - b);
    Some(Crossover {
        logarithm: lower.logarithm_of_frequency() + fraction * width,
        width,
        fraction,
        fraction_slopes: [-b, a].map(|size| size / ((a - b) * (a - b))),
    })
}

/// The margin to a delay at a crossover.
fn delay_at(crossover: Crossover, [lower, upper]: [&LoopValue; 2], delay_s: f64) -> ColumnDependence {
    let turn = portable::argument(upper.open / lower.open);
    let angle = positive(lower.angle() + crossover.fraction * turn);
    let margin = portable::ln(angle) - crossover.logarithm - portable::ln(delay_s);
    let by_fraction = turn / angle - crossover.width;
    let fractions = [1.0 - crossover.fraction, crossover.fraction];
    let term = |point: &LoopValue, fraction_slope: f64, fraction: f64| {
        (point.column, DECIBELS_PER_NEPER * Complex64::new(by_fraction * fraction_slope, -fraction / angle))
    };
    let [below, above] = crossover.fraction_slopes;
    ColumnDependence {
        value_db: DECIBELS_PER_NEPER * margin,
        terms: vec![term(lower, below, fractions[0]), term(upper, above, fractions[1])],
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

/// Margin of |L| at a peak or dip where the phase would not tolerate the delay.
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

/// An angle normalised to [0, 2 pi).
fn positive(angle: f64) -> f64 {
    if angle < -ROUNDING { angle + 2.0 * PI } else { angle.max(0.0) }
}
