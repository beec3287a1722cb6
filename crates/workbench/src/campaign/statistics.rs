//! What all runs of a campaign say together: counts, quantiles, bands over time, and the worst of them.

use super::plan::Plan;
use super::row::{LUMP_NAMES, METRIC_NAMES, Ran, Row, RowOutcome, STATUS_WORDS, meaningful};

/// Shares of the runs below each quantile, percent.
pub const QUANTILES: [u8; 5] = [5, 25, 50, 75, 95];

/// How a number is spread over the runs that have one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Runs that have one.
    pub count: usize,
    /// Runs that were driven and have none.
    pub missing: usize,
    /// [`QUANTILES`], between two runs on a straight line.
    pub quantiles: [f64; 5],
    /// The least and the greatest.
    pub extremes: [f64; 2],
    /// The number of largest magnitude, and its run.
    pub worst: (f64, u64),
}

/// Quantiles of the force over time, of all runs that got so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bands {
    /// s.
    pub times_s: Vec<f64>,
    /// [`QUANTILES`] in N at each time.
    pub force_n: Vec<[f64; 5]>,
}

/// A run to look at again, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Worst {
    /// Its index.
    pub run: u64,
    /// Window counted from 0 and place in [`METRIC_NAMES`] of all it is worst in.
    pub of: Vec<(usize, usize)>,
}

/// What the runs of a campaign say together.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How many ended in each of [`STATUS_WORDS`].
    pub statuses: [usize; STATUS_WORDS.len()],
    /// Runs that are no machine, with the reason.
    pub refused: Vec<(u64, String)>,
    /// Runs that ended before their time, with the word for it and the time in s.
    pub ended: Vec<(u64, &'static str, f64)>,
    /// What happened on the way: its kind, in how many runs, and the first of them.
    pub occurrences: Vec<(&'static str, usize, u64)>,
    /// For each window, of each of [`METRIC_NAMES`] that it can have and a run has.
    pub metrics: Vec<[Option<Spread>; METRIC_NAMES.len()]>,
    /// Of [`LUMP_NAMES`].
    pub lumps: [Option<Spread>; LUMP_NAMES.len()],
    /// Runs whose machine has one outside its bounds in `[uncertainty]`, where there are bounds.
    pub outside: [Option<usize>; LUMP_NAMES.len()],
    /// Of the force.
    pub bands: Bands,
    /// Runs to look at again, in the order of what they are worst in.
    pub worst: Vec<Worst>,
}

impl Summary {
    /// Runs that were driven, to their end or not.
    pub(crate) fn driven(&self) -> usize {
        self.statuses.iter().sum::<usize>() - self.refused.len()
    }

    /// The summary of rows.
    pub fn of(plan: &Plan, rows: &[Row]) -> Summary {
        let driven: Vec<(u64, &Ran)> = rows.iter().filter_map(|row| Some((row.run, row.ran()?))).collect();
        let metrics: Vec<[Option<Spread>; METRIC_NAMES.len()]> = (0..plan.windows().len())
            .map(|window| {
                let mut spreads = [None; METRIC_NAMES.len()];
                for metric in plan.windows().get(window).into_iter().flat_map(meaningful) {
                    spreads[metric] = spread(driven.iter().map(|(run, ran)| {
                        (*run, ran.metrics.get(window).and_then(|numbers| numbers[metric]))
                    }));
                }
                spreads
            })
            .collect();
        let lump = |lump: usize| spread(rows.iter().map(|row| (row.run, row.lumps.map(|lumps| lumps[lump]))));
        let refused = |row: &Row| match &row.outcome {
            RowOutcome::Refused(reason) => Some((row.run, reason.clone())),
            RowOutcome::Driven(_) => None,
        };
        Summary {
            statuses: STATUS_WORDS.map(|word| rows.iter().filter(|row| row.status() == word).count()),
            refused: rows.iter().filter_map(refused).collect(),
            ended: driven.iter().filter_map(|(run, ran)| Some((*run, ran.status, ran.ended_s?))).collect(),
            occurrences: occurrences(&driven),
            worst: worst(&metrics),
            metrics,
            lumps: [lump(0), lump(1), lump(2)],
            outside: [outside(plan, rows, 0), outside(plan, rows, 1), outside(plan, rows, 2)],
            bands: bands(&plan.columns.times_s, &driven),
        }
    }
}

fn outside(plan: &Plan, rows: &[Row], lump: usize) -> Option<usize> {
    let [low, high] = plan.bounds(LUMP_NAMES[lump])?;
    // a bound that a draw meets up to rounding is met
    let beyond = |value: f64| value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9);
    Some(rows.iter().filter(|row| row.lumps.is_some_and(|lumps| beyond(lumps[lump]))).count())
}

/// `None` where no run has such a number.
fn spread(numbers: impl Iterator<Item = (u64, Option<f64>)>) -> Option<Spread> {
    let mut missing = 0;
    let mut values = Vec::new();
    let mut worst: Option<(f64, u64)> = None;
    for (run, value) in numbers {
        match value {
            None => missing += 1,
            Some(value) => {
                values.push(value);
                if worst.is_none_or(|(largest, _)| value.abs() > largest.abs()) {
                    worst = Some((value, run));
                }
            }
        }
    }
    values.sort_by(f64::total_cmp);
    let extremes = [*values.first()?, *values.last()?];
    Some(Spread { count: values.len(), missing, quantiles: quantiles(&values), extremes, worst: worst? })
}

/// Of sorted values, at least one: at (n - 1) q, between two on a straight line.
fn quantiles(sorted: &[f64]) -> [f64; 5] {
    let last = sorted.len().saturating_sub(1);
    QUANTILES.map(|percent| {
        let place = last as f64 * f64::from(percent) / 100.0;
        let below = (place as usize).min(last);
        let value = |index: usize| sorted.get(index.min(last)).copied().unwrap_or(f64::NAN);
        value(below) + (place - below as f64) * (value(below + 1) - value(below))
    })
}

fn occurrences(driven: &[(u64, &Ran)]) -> Vec<(&'static str, usize, u64)> {
    let mut found: Vec<(&'static str, usize, u64)> = Vec::new();
    for (run, kind) in
        driven.iter().flat_map(|(run, ran)| ran.occurrences.iter().map(move |kind| (*run, *kind)))
    {
        match found.iter_mut().find(|(known, _, _)| *known == kind) {
            Some((_, count, _)) => *count += 1,
            None => found.push((kind, 1, run)),
        }
    }
    found
}

fn bands(times_s: &[f64], driven: &[(u64, &Ran)]) -> Bands {
    let mut bands = Bands::default();
    for (index, time_s) in times_s.iter().enumerate() {
        let forces = driven.iter().filter_map(|(_, ran)| ran.force_n.get(index));
        let mut forces: Vec<f64> = forces.map(|force| f64::from(*force)).collect();
        if forces.is_empty() {
            break;
        }
        forces.sort_by(f64::total_cmp);
        bands.times_s.push(*time_s);
        bands.force_n.push(quantiles(&forces));
    }
    bands
}

fn worst(metrics: &[[Option<Spread>; METRIC_NAMES.len()]]) -> Vec<Worst> {
    let mut found: Vec<Worst> = Vec::new();
    for (window, spreads) in metrics.iter().enumerate() {
        for (metric, spread) in spreads.iter().enumerate() {
            let Some((_, run)) = spread.map(|spread| spread.worst) else { continue };
            match found.iter_mut().find(|known| known.run == run) {
                Some(known) => known.of.push((window, metric)),
                None => found.push(Worst { run, of: vec![(window, metric)] }),
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_whole_numbers_are_where_they_should_be() {
        let values: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(quantiles(&values), [5.0, 25.0, 50.0, 75.0, 95.0]);
        assert_eq!(quantiles(&[7.0]), [7.0; 5]);
        assert_eq!(quantiles(&[0.0, 1.0])[1], 0.25);
    }

    #[test]
    fn the_worst_is_the_largest_magnitude_and_what_is_missing_is_counted() {
        let numbers = [(3, Some(1.0)), (4, Some(-5.0)), (5, None), (6, Some(5.0))];
        let found = spread(numbers.into_iter()).unwrap();
        assert_eq!((found.count, found.missing, found.worst), (3, 1, (-5.0, 4)));
        assert_eq!(found.extremes, [-5.0, 5.0]);
        assert_eq!(spread([(0, None)].into_iter()), None);
    }
}
