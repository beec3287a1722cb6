//! What a delay still holds.

use std::collections::VecDeque;

use super::quartic::Quartic;

/// A wave on its way: pieces of degree four in time, as long as the delay.
#[derive(Clone, Debug)]
pub(super) struct History {
    delay_s: f64,
    /// Before the first piece.
    initial: f64,
    pieces: VecDeque<HistoryPiece>,
}

#[derive(Clone, Debug)]
struct HistoryPiece {
    start_s: f64,
    length_s: f64,
    /// c_0 + c_1 x + ... + c_4 x^4 for x from 0 to 1
    coefficients: [f64; 5],
}

/// Points of a step at which a wave is sampled, so that a polynomial of degree four follows it.
pub(super) const NODES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

impl History {
    pub(super) fn new(delay_s: f64, initial: f64) -> History {
        History { delay_s, initial, pieces: VecDeque::new() }
    }

    pub(super) fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Adds the wave sent over a step, given at [`NODES`], and forgets what arrived before the
    /// step's end.
    pub(super) fn send(&mut self, start_s: f64, length_s: f64, values: [f64; 5]) {
        let arrived = start_s + length_s - self.delay_s;
        while self.pieces.front().is_some_and(|piece| piece.start_s + piece.length_s < arrived - length_s) {
            self.pieces.pop_front();
        }
        self.pieces.push_back(HistoryPiece { start_s, length_s, coefficients: Quartic::through(values).0 });
    }

    /// The wave that arrives at this time, and its slope. Where the wave jumps it is that of the
    /// side on which `beside_s` lies, within what rounding does to a time and a delay.
    pub(super) fn arriving(&self, time_s: f64, beside_s: f64) -> [f64; 2] {
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
        let mut history = History::new(0.3, wave(0.0));
        for index in 0..40 {
            let (start, length) = (0.05 * f64::from(index), 0.05);
            history.send(start, length, NODES.map(|node| wave(start + node * length)));
        }
        assert!(history.pieces.len() < 10);
        for time in [1.96, 2.01, 2.1499, 2.2999] {
            let [value, rate] = history.arriving(time, time);
            assert!((value - wave(time - 0.3)).abs() < 1e-12 && (rate - slope(time - 0.3)).abs() < 1e-10);
        }
        assert_eq!(History::new(0.3, 5.0).arriving(0.2, 0.2), [5.0, 0.0]);
    }
}
