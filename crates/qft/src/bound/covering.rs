//! Minimal sets of specifications that together forbid every gain.

use super::interval::GainIntervals;

/// A minimal set of specifications that together forbid every gain: starting from zero gain, the
/// specification that reaches farthest is taken next.
pub(super) fn covering(parts: Vec<(usize, &GainIntervals)>) -> Vec<usize> {
    let mut reached = 0.0;
    let mut chosen = Vec::new();
    while reached < f64::INFINITY {
        let farthest = parts
            .iter()
            .flat_map(|(index, part)| part.intervals().iter().map(move |interval| (*index, *interval)))
            .filter(|(_, [low, high])| *low <= reached && reached < *high)
            .max_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
        let Some((index, [_, high])) = farthest else { break };
        if !chosen.contains(&index) {
            chosen.push(index);
        }
        reached = high;
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_no_two_collide_the_fewest_that_do_are_named() {
        let part = |intervals: &[[f64; 2]]| GainIntervals::union_of(intervals.to_vec());
        let parts = [
            part(&[[0.5, 1.0]]),
            part(&[[3.0, f64::INFINITY]]),
            part(&[[0.0, 0.7], [1.5, 2.0]]),
            part(&[[0.6, 4.0]]),
            part(&[[0.0, 0.5]]),
        ];
        assert_eq!(covering(parts.iter().enumerate().collect()), [2, 3, 1]);
    }
}
