//! Points spread evenly over a box.

use phea_dynamics::portable;
use phea_dynamics::random::uniform;

/// Number of fixed-point iterations, of which two or three gain a digit.
const ITERATIONS: usize = 64;

/// Additive recurrence from a random start: every point is the previous one moved by steps that
/// fill the unit cube evenly.
///
/// ```text
/// e_j(i) = frac(shift_j + i phi^-j),     phi^(n + 1) = phi + 1,     j = 1 ... n
/// ```
///
/// Source: Weyl (1916) on additive recurrences; Roberts (2018) on these steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AdditiveRecurrence {
    shifts: Vec<f64>,
    steps: Vec<f64>,
}

impl AdditiveRecurrence {
    pub(super) fn new(dimension: usize, random: &mut u64) -> AdditiveRecurrence {
        let root = 1.0 / (dimension as f64 + 1.0);
        let ratio = (0..ITERATIONS).fold(2.0, |ratio, _| portable::pow(1.0 + ratio, root));
        let step = |power: usize| portable::pow(ratio, -(power as f64));
        AdditiveRecurrence {
            shifts: (0..dimension).map(|_| uniform(random)).collect(),
            steps: (1..=dimension).map(step).collect(),
        }
    }

    /// One of the points, between the bounds.
    pub(super) fn point(&self, index: usize, bounds: &[[f64; 2]]) -> Vec<f64> {
        let fractions =
            self.shifts.iter().zip(&self.steps).map(|(shift, step)| (shift + index as f64 * step).fract());
        fractions.zip(bounds).map(|(fraction, [low, high])| low + fraction * (high - low)).collect()
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::order::sort_numbers;

    use super::AdditiveRecurrence;

    /// One dimension: the step is the golden section, with which any n points leave gaps of at most
    /// (1 + golden)/n.
    #[test]
    fn one_dimension_is_filled_by_the_golden_section() {
        let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
        let spread = AdditiveRecurrence::new(1, &mut 5);
        assert!((spread.steps[0] - golden).abs() < 1e-14);
        for count in [10, 57, 233] {
            let mut points: Vec<f64> =
                (0..count).map(|index| spread.point(index, &[[0.0, 1.0]])[0]).collect();
            sort_numbers(&mut points);
            let ring =
                points.windows(2).map(|pair| pair[1] - pair[0]).chain([1.0 + points[0] - points[count - 1]]);
            let widest = ring.fold(0.0, f64::max);
            assert!(widest < (1.0 + golden) / count as f64 + 1e-12, "{count} {widest}");
        }
    }

    /// Several dimensions: every slab of a tenth contains nearly a tenth of the points, and all
    /// points are within the bounds.
    #[test]
    fn every_slab_has_its_share() {
        let bounds = [[-1.0, 3.0], [2.0, 2.5], [0.0, 1e3], [-7.0, -6.0], [1.0, 1.0]];
        let spread = AdditiveRecurrence::new(5, &mut 11);
        let points: Vec<Vec<f64>> = (0..500).map(|index| spread.point(index, &bounds)).collect();
        for (coordinate, [low, high]) in bounds.into_iter().enumerate() {
            assert!(points.iter().all(|point| low <= point[coordinate] && point[coordinate] <= high));
            for slab in 0..10 {
                let edge = |of: usize| low + of as f64 / 10.0 * (high - low);
                let inside =
                    |point: &&Vec<f64>| edge(slab) <= point[coordinate] && point[coordinate] < edge(slab + 1);
                let count = points.iter().filter(inside).count();
                assert!(low == high || (42..=58).contains(&count), "{coordinate} {slab} {count}");
            }
        }
    }
}
