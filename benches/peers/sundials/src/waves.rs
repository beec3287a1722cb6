//! Waves in delays, by the method of steps: an arriving wave was sent at least the shortest delay
//! before, and is known by then.

use std::cell::RefCell;
use std::f64::consts::PI;

use crate::session::Session;
use crate::{CvodeError, Equations, Following};

/// Points in a piece of a wave; the degree of its polynomial is one less.
const POINTS: usize = 12;
/// Least number of pieces in the shortest delay.
const PIECES: f64 = 8.0;
/// Number of passages of a break to and fro after which its waves no longer end a piece.
const ECHOES: usize = 12;

/// Waves that were sent into each delay.
pub(crate) struct Waves {
    delays: Vec<f64>,
    initial: Vec<f64>,
    pieces: Vec<Piece>,
}

/// Waves over a piece of time, at Chebyshev's points.
struct Piece {
    start: f64,
    length: f64,
    /// Values, wave by wave.
    values: Vec<[f64; POINTS]>,
}

impl Waves {
    /// Waves from delays in s, and from the values sent before time zero.
    pub(crate) fn new(delays: Vec<f64>, initial: Vec<f64>) -> Waves {
        Waves { delays, initial, pieces: Vec::new() }
    }

    /// True if nothing is delayed.
    pub(crate) fn is_empty(&self) -> bool {
        self.delays.is_empty()
    }

    /// Time ahead for which all waves are known.
    fn shortest(&self) -> f64 {
        self.delays.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Writes the arriving waves.
    pub(crate) fn arriving(&self, time: f64, places: &mut [f64]) {
        for (wave, ((place, delay), initial)) in
            places.iter_mut().zip(&self.delays).zip(&self.initial).enumerate()
        {
            let sent = time - delay;
            let after = self.pieces.partition_point(|piece| piece.start <= sent);
            *place = match after.checked_sub(1).and_then(|index| self.pieces.get(index)) {
                Some(piece) => interpolated(&piece.values[wave], (sent - piece.start) / piece.length),
                None => *initial,
            };
        }
    }

    /// Breaks, and the times at which their effects return.
    pub(crate) fn echoes(&self, breaks: &[f64], duration: f64) -> Vec<f64> {
        let mut delays = self.delays.clone();
        delays.sort_by(f64::total_cmp);
        delays.dedup();
        let mut all = breaks.to_vec();
        let mut last: Vec<f64> = [&[0.0], breaks].concat();
        for _ in 0..ECHOES {
            let mut next: Vec<f64> = Vec::new();
            for delay in &delays {
                next.extend(last.iter().map(|time| time + delay).filter(|time| *time < duration));
            }
            tidy(&mut next);
            all.extend(&next);
            last = next;
        }
        tidy(&mut all);
        all
    }
}

/// Sorts the times and removes those that are equal within rounding.
fn tidy(times: &mut Vec<f64>) {
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier <= 1e-13 * later.abs());
}

/// Chebyshev's points from 0 to 1, both included.
fn point(index: usize) -> f64 {
    0.5 - 0.5 * (PI * index as f64 / (POINTS - 1) as f64).cos()
}

/// The polynomial through values at the points: the barycentric formula.
fn interpolated(values: &[f64; POINTS], part: f64) -> f64 {
    let (mut above, mut below) = (0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let apart = part - point(index);
        if apart == 0.0 {
            return *value;
        }
        let ends = if index == 0 || index == POINTS - 1 { 0.5 } else { 1.0 };
        let weight = if index % 2 == 0 { ends } else { -ends } / apart;
        (above, below) = (above + weight * value, below + weight);
    }
    above / below
}

/// States at `times`, over which no input breaks; stores the waves that are sent meanwhile.
///
/// `inputs_at` writes all inputs of a time, arriving waves included.
pub(crate) fn integrate_delayed(
    system: &dyn Equations,
    inputs_at: &dyn Fn(f64, &Waves, &mut [f64]),
    waves: &RefCell<Waves>,
    state: &[f64],
    times: &[f64],
    following: &Following,
) -> Result<Vec<Vec<f64>>, CvodeError> {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return Ok(Vec::new()) };
    let scales = system.scales();
    let absolute: Vec<f64> = scales.iter().map(|scale| following.tolerance * scale).collect();
    let mut inputs = vec![0.0; system.inputs()];
    let mut of_rates = inputs.clone();
    let mut rates = |time: f64, state: &[f64], rates: &mut [f64]| {
        inputs_at(time, &waves.borrow(), &mut of_rates);
        system.is_evaluated_at(time);
        system.rates(state, &of_rates, rates);
    };
    let shortest = waves.borrow().shortest();
    let mut session =
        Session::new(&mut rates, state, first, following.tolerance, &absolute, following.method)?;
    let pieces = ((last - first) / shortest * PIECES).ceil().max(1.0);
    let length = (last - first) / pieces;
    let mut rows = vec![state.to_vec()];
    let mut wanted = times.iter().copied().skip(1).peekable();
    for piece in 0..pieces as usize {
        let start = first + piece as f64 * length;
        session.set_end(last.min(start + shortest))?;
        let mut sent = vec![[0.0; POINTS]; waves.borrow().delays.len()];
        for index in 0..POINTS {
            let time = if piece + 1 == pieces as usize && index == POINTS - 1 {
                last
            } else {
                start + length * point(index)
            };
            while let Some(row) = wanted.next_if(|row| *row < time) {
                rows.push(session.advance(row)?);
            }
            let reached = session.advance(time)?;
            inputs_at(time, &waves.borrow(), &mut inputs);
            let mut outgoing = vec![0.0; sent.len()];
            system.outgoing(&reached, &inputs, &mut outgoing);
            for (values, wave) in sent.iter_mut().zip(outgoing) {
                values[index] = wave;
            }
            if wanted.next_if_eq(&time).is_some() {
                rows.push(reached);
            }
        }
        waves.borrow_mut().pieces.push(Piece { start, length, values: sent });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_interpolated_exactly() {
        let wave = |t: f64| 1.0 - 2.0 * t + t.powi(5) - 0.5 * t.powi(11);
        let values = std::array::from_fn(|index| wave(point(index)));
        for part in [0.0, 0.01, 0.37, 0.5, 0.99, 1.0] {
            assert!((interpolated(&values, part) - wave(part)).abs() < 1e-13);
        }
    }

    #[test]
    fn echoes_are_all_sums_of_delays_each_once() {
        let waves = Waves::new(vec![0.1, 0.1, 0.25], vec![0.0; 3]);
        let echoes = waves.echoes(&[0.3], 0.52);
        let expected = [0.1, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5];
        assert_eq!(echoes.len(), expected.len(), "{echoes:?}");
        assert!(echoes.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12));
    }
}
