//! Where a force of several frequencies shakes the piston on its bristles.

use std::f64::consts::{LN_2, PI};

use nalgebra::{DMatrix, DVector};
use phea_dynamics::portable;
use phea_dynamics::spectrum::Transform;
use phea_hydraulics::friction::MultisineForce;

use super::FrictionRecording;
use crate::identify::median;

/// The rows of a recording whose force is a sum of sines.
#[derive(Clone, Debug, PartialEq)]
pub struct ShakenRows {
    /// Index of the recording.
    pub recording: usize,
    /// The force as it is guessed.
    pub force: MultisineForce,
    /// Cosine and sine of the position for each frequency, in m.
    responses: Vec<[f64; 2]>,
    /// N and m, noise of both signals.
    pub(super) noise: [f64; 2],
}

/// Fewest rows that say anything.
const FEWEST_ROWS: usize = 100;

/// Power of a line over that of the noise from which it is one: white noise reaches it once in a
/// hundred million.
const BEYOND_NOISE: f64 = 20.0;

/// The same over the strongest line: what is below moves nothing that could be seen.
const FAINT: f64 = 1e-6;

/// Power over that of the strongest line of a round from which another is taken with it: beyond what
/// one line spreads over its neighbours.
const NO_LEAKAGE: f64 = 0.1;

/// Most sines.
const MOST_SINES: usize = 40;

/// Rounds in which further sines are looked for.
const ROUNDS: usize = 12;

/// Steps to better frequencies in each round.
const STEPS: usize = 3;

/// Fewest periods of the slowest sine.
const FEWEST_PERIODS: f64 = 3.0;

/// How many times longer the transformed signal is, by zeros.
const FILLED_UP: usize = 4;

/// The recording as one that is shaken; `None` where its force is no sum of sines.
pub(super) fn shaken_rows(recording: &FrictionRecording, index: usize) -> Option<ShakenRows> {
    let rows = recording.forces.len();
    let duration = rows as f64 * recording.time_step;
    if rows < FEWEST_ROWS {
        return None;
    }
    let sines = sines(&recording.forces)?;
    let per_time = |angle: &f64| angle / recording.time_step;
    let frequencies: Vec<f64> = sines.iter().map(per_time).collect();
    let slowest = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
    if slowest * duration < FEWEST_PERIODS * 2.0 * PI {
        return None;
    }
    let sizes = fitted(&recording.forces, &sines, 1)?;
    // the bristles may let the position drift
    let position = fitted(&recording.positions, &sines, 2)?;
    let responses = position.get(2..)?.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
    let noise = [&recording.forces, &recording.positions].map(|values| white_noise(values));
    let force = MultisineForce { rows, frequencies, sizes };
    Some(ShakenRows { recording: index, force, responses, noise })
}

impl ShakenRows {
    /// Velocity in m/s and displacement from the mean in m at the first row, but for noise.
    pub(super) fn beginning(&self) -> [f64; 2] {
        let all = self.force.frequencies.iter().zip(&self.responses);
        all.fold([0.0; 2], |[v, x], (omega, [cosine, sine])| [v + omega * sine, x + cosine])
    }

    /// Stiffness in N/m and damping in N s/m of a spring and a damper that answer alike.
    ///
    /// ```text
    /// F_k = (sigma_0 - M omega_k^2 + j omega_k c) X_k        least squares over all k
    /// ```
    pub(super) fn spring_and_damper(&self, mass: f64) -> [f64; 2] {
        let forces = self.force.sizes.get(1..).unwrap_or_default().chunks_exact(2);
        let all = self.force.frequencies.iter().zip(forces.zip(&self.responses));
        let (mut stiffness, mut damping) = ([0.0; 2], [0.0; 2]);
        for (omega, (force, [cosine, sine])) in all {
            // a cos + b sin is the real part of (a - j b) e^(j omega t)
            let [a, b] = [force[0], force[1]];
            let square = cosine * cosine + sine * sine;
            stiffness[0] += a * cosine + b * sine + mass * omega * omega * square;
            stiffness[1] += square;
            damping[0] += omega * (a * sine - b * cosine);
            damping[1] += omega * omega * square;
        }
        [stiffness, damping].map(|[product, square]| if square > 0.0 { product / square } else { 0.0 })
    }
}

/// Standard deviation of white noise on a signal that is smooth enough to have little in the upper
/// half of the frequencies; at least what numbers resolve.
fn white_noise(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let power = power(&centred, values.len());
    let upper = power.get(power.len() / 2..).unwrap_or_default();
    let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    level(upper).sqrt().max(1e-12 * largest)
}

/// Of white noise, whose power is distributed exponentially, from the median.
fn level(power: &[f64]) -> f64 {
    if power.is_empty() { 0.0 } else { median(power.to_vec()) / LN_2 }
}

/// Power at equal distances of the frequency, up to half of that of the rows: for white noise, its
/// variance on average.
fn power(values: &[f64], length: usize) -> Vec<f64> {
    let lines = Transform::new(length).of_real(values);
    let count = values.len().max(1) as f64;
    lines.iter().take(length / 2).map(|line| line.norm_sqr() / count).collect()
}

/// The sines that a force is made of, as angles in rad from row to row, rising; `None` where sines do
/// not explain it.
fn sines(forces: &[f64]) -> Option<Vec<f64>> {
    let mut angles: Vec<f64> = Vec::new();
    let length = (FILLED_UP * forces.len()).next_power_of_two();
    let mut strongest = 0.0_f64;
    for _ in 0..ROUNDS {
        let left = left(forces, &angles)?;
        let power = power(&left, length);
        let most = power.iter().copied().fold(0.0, f64::max);
        strongest = strongest.max(most);
        let least = (BEYOND_NOISE * level(&power)).max(FAINT * strongest);
        if most <= least {
            return (!angles.is_empty()).then_some(angles);
        }
        let enough = least.max(NO_LEAKAGE * most);
        let peaks = power.windows(3).enumerate().filter(|(_, three)| {
            matches!(three, [before, here, after] if *here > enough && here >= before && here > after)
        });
        angles.extend(peaks.map(|(before, _)| 2.0 * PI * (before + 1) as f64 / length as f64));
        angles.sort_by(f64::total_cmp);
        // two sines within one line of the rows cannot be told from each other
        let closest = 2.0 * PI / forces.len() as f64;
        let are_apart = |angles: &[f64]| {
            angles.windows(2).all(|two| two[1] - two[0] > closest)
                && angles.first().is_none_or(|first| *first > 0.5 * closest)
        };
        if angles.len() > MOST_SINES || !are_apart(&angles) {
            return None;
        }
        for _ in 0..STEPS {
            angles = improved(forces, &angles)?;
        }
        if !are_apart(&angles) {
            return None;
        }
    }
    None
}

/// Trends (one; with two of them, a straight line too), then cosine and sine of each angle, row by row.
fn columns(rows: usize, angles: &[f64], trends: usize) -> DMatrix<f64> {
    let count = trends + 2 * angles.len();
    let mut matrix = DMatrix::zeros(rows, count);
    for row in 0..rows {
        let trend = [1.0, 2.0 * row as f64 / rows as f64 - 1.0];
        for (index, value) in trend.into_iter().take(trends).enumerate() {
            matrix[(row, index)] = value;
        }
        for (index, angle) in angles.iter().enumerate() {
            let turned = angle * row as f64;
            matrix[(row, trends + 2 * index)] = portable::cos(turned);
            matrix[(row, trends + 2 * index + 1)] = portable::sin(turned);
        }
    }
    matrix
}

/// The solution of the normal equations: the sines are nearly orthogonal.
fn solved(matrix: &DMatrix<f64>, values: &[f64]) -> Option<DVector<f64>> {
    let right = matrix.tr_mul(&DVector::from_column_slice(values));
    Some(matrix.tr_mul(matrix).cholesky()?.solve(&right))
}

/// Sizes of the trends, and of cosine and sine of each angle, by least squares.
fn fitted(values: &[f64], angles: &[f64], trends: usize) -> Option<Vec<f64>> {
    let found = solved(&columns(values.len(), angles, trends), values)?;
    Some(found.iter().copied().collect())
}

/// What sines of these angles and a mean leave.
fn left(values: &[f64], angles: &[f64]) -> Option<Vec<f64>> {
    let matrix = columns(values.len(), angles, 1);
    let found = solved(&matrix, values)?;
    Some((DVector::from_column_slice(values) - matrix * found).iter().copied().collect())
}

/// The angles after a step of Gauss and Newton over sizes and angles.
fn improved(values: &[f64], angles: &[f64]) -> Option<Vec<f64>> {
    let rows = values.len();
    let matrix = columns(rows, angles, 1);
    let sizes = solved(&matrix, values)?;
    let left = DVector::from_column_slice(values) - &matrix * &sizes;
    let mut wider = matrix.resize_horizontally(1 + 3 * angles.len(), 0.0);
    let middle = (rows as f64 - 1.0) / 2.0;
    for index in 0..angles.len() {
        let [a, b] = [sizes[1 + 2 * index], sizes[2 + 2 * index]];
        let scale = (a * a + b * b).sqrt().max(f64::MIN_POSITIVE) * middle;
        for row in 0..rows {
            let [cosine, sine] = [wider[(row, 1 + 2 * index)], wider[(row, 2 + 2 * index)]];
            wider[(row, 1 + 2 * angles.len() + index)] =
                (row as f64 - middle) * (b * cosine - a * sine) / scale;
        }
    }
    let step = solved(&wider, left.as_slice())?;
    let better = angles.iter().enumerate().map(|(index, angle)| {
        let [a, b] = [sizes[1 + 2 * index], sizes[2 + 2 * index]];
        let scale = (a * a + b * b).sqrt().max(f64::MIN_POSITIVE) * middle;
        angle + step[1 + 2 * angles.len() + index] / scale
    });
    Some(better.collect())
}
