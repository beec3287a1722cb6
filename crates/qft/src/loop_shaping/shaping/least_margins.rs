//! The least margins of the samples at one G, and the rows of their slopes.

use num_complex::Complex64;
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

use super::super::MarginRow;
use super::super::margins::{
    AboveColumns, ColumnDependence, DelayMargins, Demand, MarginCandidate, candidates, delay_margins,
};
use super::super::structure::DECIBELS_PER_NEPER;
use super::{Shaping, along};

/// Largest number of rows of one linearisation.
const ROWS_MAXIMUM: usize = 240;
/// Distance from the worst margin beyond which the worst margin of a column gives no rows, dB.
const WINDOW_DB: f64 = 20.0;
/// Relative difference of two squares, and difference of two margins in dB, that counts as rounding
/// error.
const ROUNDING: f64 = 1e-9;
const ROUNDING_DB: f64 = 1e-6;

/// The worst of the samples at one G.
#[derive(Clone, Debug)]
pub(super) struct LeastMargins {
    /// Excess for each column and requirement.
    excesses: Vec<ColumnExcess>,
    delays: DelayMargins,
    pub(super) worst_db: f64,
}

/// Ratio of the worst plant of a column to a limit.
#[derive(Clone, Copy, Debug)]
struct ColumnExcess {
    column: usize,
    /// Index of the requirement in the column.
    number: usize,
    /// The square of the excess.
    squared: f64,
    rate: f64,
}

impl ColumnExcess {
    /// The margin over its rate, dB.
    fn margin_db(&self) -> f64 {
        -10.0 * portable::log10(self.squared) / self.rate
    }
}

impl Shaping {
    pub(super) fn look(&mut self, forward: &[[Complex64; 2]]) -> LeastMargins {
        let mut excesses = Vec::new();
        let mut worst_db = f64::INFINITY;
        // for a rate of 1 most logarithms can be skipped
        let mut greatest = 0.0;
        for (index, (column, &[feedback, prefilter])) in
            self.samples.columns().iter().zip(forward).enumerate()
        {
            self.around.close(column, feedback, prefilter);
            for (number, demand) in column.demands.iter().enumerate() {
                let squared = demand.worst_excess(column, &self.around);
                let excess = ColumnExcess { column: index, number, squared, rate: demand.rate() };
                excesses.push(excess);
                if excess.rate == 1.0 {
                    if squared <= greatest * (1.0 - ROUNDING) {
                        continue;
                    }
                    greatest = squared.max(greatest);
                }
                let margin_db = excess.margin_db();
                worst_db = if margin_db < worst_db { margin_db } else { worst_db };
            }
        }
        let feedback: Vec<Complex64> = forward.iter().map(|[feedback, _]| *feedback).collect();
        let columns = self.samples.columns();
        let delay_s = self.samples.problem().minimum_delay_margin_s;
        let above = match self.samples.problem().timing.sample_time_s {
            Some(_) => AboveColumns::Nothing,
            None => AboveColumns::Falling,
        };
        let plants = self.samples.plants().len();
        let delays = delay_margins(columns, &feedback, (plants, above), delay_s);
        let worst_db = delays.crossovers.iter().map(|margin| margin.value_db).fold(worst_db, f64::min);
        LeastMargins { excesses, delays, worst_db }
    }

    /// The rows of the relevant columns and requirements, the least margin first.
    pub(super) fn rows(
        &mut self,
        looked: &LeastMargins,
        forward: &[[Complex64; 2]],
        [own, behind]: &[Vec<Vec<Complex64>>; 2],
    ) -> Vec<MarginRow> {
        let dimension = self.bounds.len();
        let plants = self.samples.plants().len();
        let mut found = self.least(looked, forward);
        let delays = looked.delays.crossovers.iter().chain(&looked.delays.peaks);
        let delays = delays.filter(|margin| margin.value_db.is_finite()).enumerate();
        found.extend(delays.map(|(number, margin)| (margin.value_db, RowOf::Delay(number, margin))));
        sort_by_number(&mut found, |(margin, _)| *margin);
        let columns = self.samples.columns();
        let row = |(_, row_of): (f64, RowOf<'_>)| match row_of {
            RowOf::Plant { column, number, found } => {
                let demand = columns[column].demands.get(number)?;
                let mut slopes = along(&[(column, -DECIBELS_PER_NEPER * found.sensitivity)], own, dimension);
                let through = Complex64::new(-DECIBELS_PER_NEPER * demand.prefilter_power(), 0.0);
                let of_prefilter = along(&[(column, through)], behind, dimension);
                slopes.iter_mut().zip(of_prefilter).for_each(|(slope, more)| *slope += more);
                let sample = sample_number(column, number, plants, &found);
                Some(MarginRow { sample, margin_db: found.margin_db, rate: demand.rate(), slopes })
            }
            RowOf::Delay(number, margin) => Some(MarginRow {
                sample: usize::MAX - number,
                margin_db: margin.value_db,
                rate: 1.0,
                slopes: along(&margin.terms, own, dimension),
            }),
        };
        let rows = found.into_iter().filter_map(row);
        let finite = rows.filter(|row| row.slopes.iter().all(|slope| slope.is_finite()));
        finite.take(ROWS_MAXIMUM).collect()
    }

    /// The least margins over their rates, with their plants, by column and requirement: at least
    /// as many as there are rows.
    fn least(&mut self, looked: &LeastMargins, forward: &[[Complex64; 2]]) -> Vec<(f64, RowOf<'static>)> {
        let mut found = Vec::new();
        // the least margins found so far, in order
        let mut least: Vec<f64> = Vec::with_capacity(ROWS_MAXIMUM + 1);
        for (worst, index, number) in near(looked) {
            if least.get(ROWS_MAXIMUM - 1).is_some_and(|last| *last < worst - ROUNDING_DB) {
                break;
            }
            let (column, [feedback, prefilter]) = (&self.samples.columns()[index], forward[index]);
            self.around.close(column, feedback, prefilter);
            let Some(demand) = column.demands.get(number) else { continue };
            for one in candidates(demand, column, &self.around, feedback) {
                let margin = one.margin_db / demand.rate();
                let place = least.partition_point(|known| *known <= margin);
                if place < ROWS_MAXIMUM {
                    least.insert(place, margin);
                    least.truncate(ROWS_MAXIMUM);
                }
                found.push((margin, RowOf::Plant { column: index, number, found: one }));
            }
        }
        found.sort_by_key(|(_, row_of)| row_of.place());
        found
    }
}

/// Origin of a row.
#[derive(Clone, Copy, Debug)]
enum RowOf<'a> {
    Plant { column: usize, number: usize, found: MarginCandidate },
    Delay(usize, &'a ColumnDependence),
}

impl RowOf<'_> {
    /// Column and number of the requirement, for a plant.
    fn place(&self) -> (usize, usize) {
        match *self {
            RowOf::Plant { column, number, .. } => (column, number),
            RowOf::Delay(..) => (usize::MAX, usize::MAX),
        }
    }
}

/// The least margins over their rates in dB, with column and requirement, in order.
fn near(looked: &LeastMargins) -> Vec<(f64, usize, usize)> {
    let farthest_db = looked.worst_db + WINDOW_DB;
    // the square of an excess with a rate of 1 that is certainly too far from the worst
    let beyond = portable::pow(10.0, -0.1 * farthest_db) * (1.0 - ROUNDING);
    let may_be = |excess: &&ColumnExcess| excess.rate != 1.0 || excess.squared >= beyond;
    let margins = looked.excesses.iter().filter(may_be);
    let margins = margins.map(|excess| (excess.margin_db(), excess.column, excess.number));
    let mut near: Vec<(f64, usize, usize)> =
        margins.filter(|(margin_db, ..)| *margin_db <= farthest_db).collect();
    let in_order = |one: &(f64, usize, usize), other: &(f64, usize, usize)| {
        one.0.total_cmp(&other.0).then((one.1, one.2).cmp(&(other.1, other.2)))
    };
    if near.len() > ROWS_MAXIMUM {
        near.select_nth_unstable_by(ROWS_MAXIMUM, in_order);
        near.truncate(ROWS_MAXIMUM);
    }
    near.sort_unstable_by(in_order);
    near
}

/// A number that identifies the margin of this plant, or pair, to this requirement at this column.
fn sample_number(column: usize, demand: usize, plants: usize, found: &MarginCandidate) -> usize {
    let pair = found.plant * (plants + 1) + found.other.map_or(plants, |other| other);
    (column * Demand::PER_COLUMN + demand) * (plants + 1) * (plants + 1) + pair
}
