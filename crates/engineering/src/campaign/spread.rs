//! The distribution of a number over the runs of a campaign.

use phea_dynamics::order::sort_numbers;

/// Percentages of the runs below each quantile.
pub const QUANTILES: [u8; 5] = [5, 25, 50, 75, 95];

/// Distribution of a number over the runs that have one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Number of runs that have a number.
    pub count: usize,
    /// Number of simulated runs that do not have one.
    pub missing: usize,
    /// [`QUANTILES`], interpolated linearly between two runs.
    pub quantiles: [f64; 5],
    /// Least and greatest number.
    pub extremes: [f64; 2],
    /// The number of largest magnitude, and its run.
    pub worst: (f64, u64),
}

/// Distribution of these numbers; `None` if no run has one.
pub(super) fn spread(numbers: impl Iterator<Item = (u64, Option<f64>)>) -> Option<Spread> {
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
    sort_numbers(&mut values);
    let extremes = [*values.first()?, *values.last()?];
    Some(Spread { count: values.len(), missing, quantiles: quantiles(&values)?, extremes, worst: worst? })
}

/// Quantile of sorted values: at (n - 1) q, interpolated linearly; `None` if there are none.
pub(super) fn quantiles(sorted: &[f64]) -> Option<[f64; 5]> {
    let (greatest, last) = (sorted.last()?, sorted.len() - 1);
    Some(QUANTILES.map(|percent| {
        let place = last as f64 * f64::from(percent) / 100.0;
        let below = (place as usize).min(last);
        let value = |index: usize| *sorted.get(index).unwrap_or(greatest);
        value(below) + (place - below as f64) * (value(below + 1) - value(below))
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_whole_numbers_are_where_they_should_be() {
        let values: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(quantiles(&values), Some([5.0, 25.0, 50.0, 75.0, 95.0]));
        assert_eq!(quantiles(&[7.0]), Some([7.0; 5]));
        assert_eq!(quantiles(&[0.0, 1.0]).map(|five| five[1]), Some(0.25));
        assert_eq!(quantiles(&[]), None);
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
