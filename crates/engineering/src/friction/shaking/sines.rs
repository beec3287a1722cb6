//! Sines that compose a force, found in the force and in the motion that it causes.

use std::f64::consts::{LN_2, PI};

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use phea_dynamics::order::{sort_by_number, sort_numbers};
use phea_dynamics::portable;
use phea_dynamics::spectrum::Transform;
use phea_hydraulics::friction::{TRENDS, trends};

use phea_dynamics::order::median;

/// Ratio of the power of a line in both signals together to that of their noise above which it
/// counts as a sine: white noise reaches it once in twenty thousand.
const BEYOND_NOISE: f64 = 12.0;

/// Ratio of a line's power to that of the strongest below which it is ignored: it has less than a
/// hundredth of the amplitude, and moves little.
const FAINT: f64 = 1e-4;

/// Ratio of a line's power to that of the strongest of a round above which it is added with it:
/// beyond the leakage of one line to its neighbours.
const NO_LEAKAGE: f64 = 0.1;

/// Fraction of the variance of a force that its sines may leave unexplained, in addition to the
/// noise.
const NOT_EXPLAINED: f64 = 0.05;

/// Largest number of sines.
const MOST_SINES: usize = 40;

/// Number of rounds of the search for further sines.
const ROUNDS: usize = 12;

/// Number of steps to better frequencies in each round.
const STEPS: usize = 3;

/// Fewest periods of a sine; slower ones belong to the drift of the mean, or to the noise.
const FEWEST_PERIODS: f64 = 3.0;

/// Ratio of the length of the transformed signal, filled with zeros, to that of the record.
const FILLED_UP: usize = 4;

/// Distance of two sines, in lines of the record, from which they can be distinguished.
const APART: f64 = 1.5;

/// Sines that compose a force, as angles from row to row, rad, rising; `None` if sines do not
/// explain it. Force and position are divided by the standard deviation of their noise.
///
/// A sine that is small in the force may move the piston much at its natural frequency on the
/// bristles, so that both signals are searched. The remainder may contain sines too close to one of
/// these for the duration of the recording, as when the amplitude of a sine changes slightly: they
/// remain in the noise, up to a small fraction of the force.
pub(super) fn sines(signals: [&Vec<f64>; 2]) -> Option<Vec<f64>> {
    let [forces, _] = signals;
    let length = (FILLED_UP * forces.len()).next_power_of_two();
    let line = 2.0 * PI / forces.len() as f64;
    let mut angles: Vec<f64> = Vec::new();
    let mut strongest = 0.0_f64;
    for _ in 0..ROUNDS {
        let power = power_left(signals, &angles, length)?;
        let most = power.iter().copied().fold(0.0, f64::max);
        strongest = strongest.max(most);
        let least = (BEYOND_NOISE * level(&power)).max(FAINT * strongest);
        if most <= least {
            break;
        }
        let mut more = angles.clone();
        for angle in peaks(&power, least.max(NO_LEAKAGE * most)) {
            let is_apart = more.iter().all(|known| (known - angle).abs() > APART * line);
            let is_one = is_apart && angle > FEWEST_PERIODS * line && more.len() < MOST_SINES;
            more.extend(is_one.then_some(angle));
        }
        sort_numbers(&mut more);
        if more.len() == angles.len() {
            break;
        }
        for _ in 0..STEPS {
            more = improved(signals, &more)?;
        }
        if more.windows(2).any(|two| two[1] - two[0] < line) || more.first().is_some_and(|low| *low < line) {
            break;
        }
        angles = more;
    }
    // both in squares of the standard deviation of the noise
    let squares = |angles: &[f64]| {
        Some(Sines::of(forces.len(), angles)?.left(forces).iter().map(|one| one * one).sum::<f64>())
    };
    let (all, left) = (squares(&[])?, squares(&angles)?);
    let beyond_noise = left - forces.len() as f64;
    // noise without a sine explains 2 of each
    let is_seen = all - left > BEYOND_NOISE * 2.0 * angles.len() as f64;
    (is_seen && beyond_noise <= NOT_EXPLAINED * (all - left)).then_some(angles)
}

/// Power of both signals together that remains after removal of sines of these angles.
fn power_left(signals: [&Vec<f64>; 2], angles: &[f64], length: usize) -> Option<Vec<f64>> {
    let sines = Sines::of(signals[0].len(), angles)?;
    let [force, position] = signals.map(|values| power(sines.left(values).as_slice(), length));
    Some(force.iter().zip(&position).map(|(one, other)| one + other).collect())
}

/// Angles of the local maxima above this power, the strongest first.
fn peaks(power: &[f64], enough: f64) -> Vec<f64> {
    let mut peaks: Vec<(f64, usize)> = power
        .windows(3)
        .enumerate()
        .filter(|(_, three)| three[1] > enough && three[1] >= three[0] && three[1] > three[2])
        .map(|(before, three)| (three[1], before + 1))
        .collect();
    sort_by_number(&mut peaks, |peak| -peak.0);
    peaks.into_iter().map(|(_, line)| PI * line as f64 / power.len() as f64).collect()
}

/// Standard deviation of white noise on a signal that is smooth enough to have little power in the
/// upper half of the frequencies; at least the resolution of the numbers.
pub(super) fn white_noise(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let power = power(&centred, values.len());
    let upper = power.get(power.len() / 2..).unwrap_or_default();
    let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    // power of white noise is distributed exponentially, with this median
    (typical(upper) / LN_2).sqrt().max(1e-12 * largest).max(f64::MIN_POSITIVE)
}

fn typical(power: &[f64]) -> f64 {
    if power.is_empty() { 0.0 } else { median(power.to_vec()) }
}

/// Power of the noise of one signal, from the median of the sum of two: 1.678 of that of one.
fn level(power: &[f64]) -> f64 {
    typical(power) / 1.678
}

/// Power at equally spaced frequencies, up to half of that of the rows: for white noise, its
/// variance on average.
fn power(values: &[f64], length: usize) -> Vec<f64> {
    let lines = Transform::new(length).of_real(values);
    let count = values.len().max(1) as f64;
    lines.iter().take(length / 2).map(|line| line.norm_sqr() / count).collect()
}

/// Drifting mean, then cosine and sine of each angle, column after column.
fn columns(rows: usize, angles: &[f64]) -> Vec<f64> {
    let places = (0..rows).map(|row| trends(2.0 * row as f64 / (rows as f64 - 1.0) - 1.0));
    let drift: Vec<[f64; TRENDS]> = places.collect();
    let mut columns = Vec::with_capacity(rows * (TRENDS + 3 * angles.len()));
    for index in 0..TRENDS {
        columns.extend(drift.iter().map(|row| row[index]));
    }
    for angle in angles {
        columns.extend((0..rows).map(|row| portable::cos(angle * row as f64)));
        columns.extend((0..rows).map(|row| portable::sin(angle * row as f64)));
    }
    columns
}

/// Drifting mean, and sines of some angles, to be fitted to signals.
struct Sines {
    /// Values, column after column.
    columns: Vec<f64>,
    matrix: DMatrix<f64>,
    normal: Cholesky<f64, Dyn>,
}

impl Sines {
    fn of(rows: usize, angles: &[f64]) -> Option<Sines> {
        let columns = columns(rows, angles);
        let matrix = matrix(rows, columns.clone());
        let normal = (matrix.transpose() * &matrix).cholesky()?;
        Some(Sines { columns, matrix, normal })
    }

    /// Coefficients of the drifting mean, and of cosine and sine of each angle, by least squares:
    /// by the normal equations, as the sines are nearly orthogonal.
    fn sizes(&self, values: &[f64]) -> DVector<f64> {
        self.normal.solve(&(self.matrix.transpose() * DVector::from_column_slice(values)))
    }

    /// Residuals of the sines.
    fn left(&self, values: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(values) - &self.matrix * self.sizes(values)
    }
}

fn matrix(rows: usize, columns: Vec<f64>) -> DMatrix<f64> {
    DMatrix::from_vec(rows, columns.len() / rows.max(1), columns)
}

/// Solution of the normal equations.
fn solved(matrix: &DMatrix<f64>, values: &[f64]) -> Option<DVector<f64>> {
    let transposed = matrix.transpose();
    let right = &transposed * DVector::from_column_slice(values);
    Some((transposed * matrix).cholesky()?.solve(&right))
}

/// Coefficients of the drifting mean, and of cosine and sine of each angle, by least squares.
pub(super) fn fitted(values: &[f64], angles: &[f64]) -> Option<Vec<f64>> {
    Some(Sines::of(values.len(), angles)?.sizes(values).iter().copied().collect())
}

/// Angles after a Gauss-Newton step over coefficients and angles: the mean of the steps for both
/// signals, weighted by the squares of the amplitudes.
fn improved(signals: [&Vec<f64>; 2], angles: &[f64]) -> Option<Vec<f64>> {
    let sines = Sines::of(signals[0].len(), angles)?;
    let [force, position] = signals.map(|values| steps(values, angles, &sines));
    let both = force?.into_iter().zip(position?).zip(angles);
    Some(
        both.map(|(([one, by_one], [other, by_other]), angle)| {
            let all = (by_one + by_other).max(f64::MIN_POSITIVE);
            angle + (one * by_one + other * by_other) / all
        })
        .collect(),
    )
}

/// Step of each angle, and the square of the amplitude of its sine.
fn steps(values: &[f64], angles: &[f64], sines: &Sines) -> Option<Vec<[f64; 2]>> {
    let rows = values.len();
    let sizes = sines.sizes(values);
    let left = sines.left(values);
    let mut columns = sines.columns.clone();
    let middle = (rows as f64 - 1.0) / 2.0;
    let size = |index: usize| {
        let [a, b] = [0, 1].map(|part| sizes[TRENDS + 2 * index + part]);
        (a, b, (a * a + b * b).max(f64::MIN_POSITIVE))
    };
    for index in 0..angles.len() {
        let (a, b, square) = size(index);
        let scale = square.sqrt() * middle;
        let first = (TRENDS + 2 * index) * rows;
        let of =
            |row: usize| (row as f64 - middle) * (b * columns[first + row] - a * columns[first + rows + row]);
        let slopes: Vec<f64> = (0..rows).map(|row| of(row) / scale).collect();
        columns.extend(slopes);
    }
    let step = solved(&matrix(rows, columns), left.as_slice())?;
    let of = |index: usize| {
        let (_, _, square) = size(index);
        [step[TRENDS + 2 * angles.len() + index] / (square.sqrt() * middle), square]
    };
    Some((0..angles.len()).map(of).collect())
}
