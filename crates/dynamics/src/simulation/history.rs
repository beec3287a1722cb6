//! Content of a delay.

use std::collections::VecDeque;

use super::quartic::Quartic;

/// Wave in transit: pieces of degree four in time, over the length of the delay.
///
/// # Example
/// A ramp of 3 1/s, sent in one piece, arrives 0.2 s later:
/// ```
/// use phea_dynamics::simulation::WaveHistory;
/// let mut ramp = WaveHistory::new(0.2, 0.0);
/// ramp.send(0.0, 0.4, [0.0, 0.3, 0.6, 0.9, 1.2]);
/// let [value, slope] = ramp.arriving(0.3, 0.3);
/// assert!((value - 0.3).abs() < 1e-15 && (slope - 3.0).abs() < 1e-14);
/// assert_eq!(ramp.arriving(0.1, 0.1), [0.0; 2]);
/// ```
#[derive(Clone, Debug)]
pub struct WaveHistory {
    delay_s: f64,
    /// Value before the first piece.
    initial: f64,
    pieces: VecDeque<HistoryPiece>,
}

#[derive(Clone, Debug)]
struct HistoryPiece {
    start_s: f64,
    length_s: f64,
    /// Coefficients c_0 + c_1 x + ... + c_4 x^4 for x from 0 to 1.
    coefficients: [f64; 5],
    /// Lower and upper bound of the wave.
    bounds: [f64; 2],
}

/// Points of a step at which a wave is sampled, so that a polynomial of degree four follows it.
pub(super) const NODES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

impl WaveHistory {
    /// History of a wave with this travel time in s, which was `initial` before time zero.
    pub fn new(delay_s: f64, initial: f64) -> WaveHistory {
        WaveHistory { delay_s, initial, pieces: VecDeque::new() }
    }

    /// Travel time, s.
    pub fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Adds the wave sent over a step, given at its quarters, and forgets the part that arrived
    /// before the step's end.
    pub fn send(&mut self, start_s: f64, length_s: f64, values: [f64; 5]) {
        let arrived = start_s + length_s - self.delay_s;
        while self.pieces.front().is_some_and(|piece| piece.start_s + piece.length_s < arrived - length_s) {
            self.pieces.pop_front();
        }
        let sent = Quartic::through(values);
        let bounds = sent.bounds();
        self.pieces.push_back(HistoryPiece { start_s, length_s, coefficients: sent.0, bounds });
    }

    /// Range of the pieces of which some part arrives between two times.
    fn between(&self, [from_s, until_s]: [f64; 2]) -> std::ops::Range<usize> {
        let [from, until] = [from_s - self.delay_s, until_s - self.delay_s];
        let first = self.pieces.partition_point(|piece| piece.start_s + piece.length_s < from);
        first..self.pieces.partition_point(|piece| piece.start_s <= until).max(first)
    }

    /// Bounds of the wave that arrives between two times, at little cost.
    pub fn bounds(&self, times_s: [f64; 2]) -> [f64; 2] {
        let before = self.pieces.front().is_none_or(|first| times_s[0] - self.delay_s < first.start_s);
        let none = if before { [self.initial; 2] } else { [f64::INFINITY, f64::NEG_INFINITY] };
        let pieces = self.pieces.range(self.between(times_s));
        pieces.fold(none, |[low, high], piece| [low.min(piece.bounds[0]), high.max(piece.bounds[1])])
    }

    /// Times between two others at which another piece begins to arrive: between them the arriving
    /// wave is a polynomial of degree four.
    pub fn joints(&self, [from_s, until_s]: [f64; 2]) -> impl Iterator<Item = f64> + '_ {
        let pieces = self.pieces.range(self.between([from_s, until_s]));
        let joints = pieces.map(|piece| piece.start_s + self.delay_s);
        joints.filter(move |joint_s| from_s < *joint_s && *joint_s < until_s)
    }

    /// Wave that arrives at this time, and its slope. At a jump of the wave, the value is that on
    /// the side of `beside_s`, within the rounding of a time and a delay.
    pub fn arriving(&self, time_s: f64, beside_s: f64) -> [f64; 2] {
        let sent = time_s - self.delay_s;
        let rounding = 8.0 * f64::EPSILON * time_s;
        let aside = sent + (beside_s - time_s).clamp(-rounding, rounding);
        let after = self.pieces.partition_point(|piece| piece.start_s <= aside);
        let Some(piece) = after.checked_sub(1).and_then(|index| self.pieces.get(index)) else {
            return [self.initial, 0.0];
        };
        let part = (sent - piece.start_s) / piece.length_s;
        let [c0, c1, c2, c3, c4] = piece.coefficients;
        let value = c0 + part * (c1 + part * (c2 + part * (c3 + part * c4)));
        let slope = c1 + part * (2.0 * c2 + part * (3.0 * c3 + part * 4.0 * c4));
        [value, slope / piece.length_s]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_four_arrives_as_it_was_sent() {
        let wave = |t: f64| 1.0 - 2.0 * t + t * t * (3.0 - t * (0.5 - 0.25 * t));
        let slope = |t: f64| -2.0 + t * (6.0 - t * (1.5 - t));
        let mut history = WaveHistory::new(0.3, wave(0.0));
        for index in 0..40 {
            let (start, length) = (0.05 * f64::from(index), 0.05);
            history.send(start, length, NODES.map(|node| wave(start + node * length)));
        }
        assert!(history.pieces.len() < 10);
        for time in [1.96, 2.01, 2.1499, 2.2999] {
            let [value, rate] = history.arriving(time, time);
            assert!((value - wave(time - 0.3)).abs() < 1e-12 && (rate - slope(time - 0.3)).abs() < 1e-10);
        }
        assert_eq!(WaveHistory::new(0.3, 5.0).arriving(0.2, 0.2), [5.0, 0.0]);
    }

    /// A wave of one period of a sine is within its bounds over any interval, and the bounds are
    /// close.
    #[test]
    fn what_arrives_lies_within_its_bounds() {
        let wave = |t: f64| crate::portable::sin(10.0 * t);
        let mut history = WaveHistory::new(0.3, 0.0);
        for index in 0..20 {
            let (start, length) = (0.05 * f64::from(index), 0.05);
            history.send(start, length, NODES.map(|node| wave(start + node * length)));
        }
        for [from, until] in [[1.0, 1.29], [1.01, 1.02], [1.1, 1.1], [0.99, 1.3]] {
            let [low, high] = history.bounds([from, until]);
            let all: Vec<f64> =
                (0..=100).map(|part| from + 0.01 * f64::from(part) * (until - from)).collect();
            let values = all.iter().map(|time| history.arriving(*time, *time)[0]);
            let [least, most] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| {
                [least.min(value), most.max(value)]
            });
            assert!(low <= least && most <= high, "{from} {until}");
            // a piece beyond each end, and the excess of a piece's bounds
            assert!(low > least - 0.5 && high < most + 0.5, "{from} {until}");
            let joints: Vec<f64> = history.joints([from, until]).collect();
            assert!(joints.iter().all(|joint| from < *joint && *joint < until));
            assert_eq!(
                joints.len(),
                (0..20)
                    .filter(|index| {
                        let joint = 0.05 * f64::from(*index) + 0.3;
                        from < joint && joint < until
                    })
                    .count()
            );
        }
        assert_eq!(WaveHistory::new(0.3, 5.0).bounds([0.1, 0.2]), [5.0; 2]);
    }
}
