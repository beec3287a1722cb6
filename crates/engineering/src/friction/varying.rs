//! Runs of the piston whose velocity is constant only on average.

use std::ops::Range;

use phea_dynamics::order;

/// Rows over which the piston moves along a line on average, but sticks and slips on it.
#[derive(Clone, Debug, PartialEq)]
pub struct VaryingVelocity {
    /// Index of the recording.
    pub recording: usize,
    /// Rows that are omitted for this reason.
    pub rows: Range<usize>,
    /// Slope of the line through the positions, m/s.
    pub velocity: f64,
    /// Least and greatest velocity over the shortest windows that noise permits, m/s.
    pub range: [f64; 2],
}

/// Relative standard deviation of the velocity of a window that determines its length.
const RESOLVED: f64 = 0.05;

/// Relative departure from the mean velocity up to which a velocity is constant.
const STEADY: f64 = 0.25;

/// Number of standard deviations of the velocity of a window that count as noise.
const OF_NOISE: f64 = 5.0;

/// Fewest rows of a window.
const SHORTEST: usize = 4;

/// Fewest windows: fewer do not resolve the velocity within the run.
const FEWEST_WINDOWS: usize = 4;

/// Least and greatest velocity within a run, m per row, if it is not constant.
///
/// ```text
/// v_k = slope of the line through w rows        its standard deviation s (12/(w (w^2 - 1)))^(1/2)
/// ```
///
/// with s the noise of the position, and w the fewest rows that resolve a twentieth of the mean
/// velocity.
pub(super) fn varying(positions: &[f64], mean: f64, noise: f64) -> Option<[f64; 2]> {
    let (velocities, deviation) = velocities(positions, mean, noise)?;
    let [least, greatest] = order::ends(velocities.iter().copied());
    let allowed = STEADY * mean.abs() + OF_NOISE * deviation;
    (mean - least > allowed || greatest - mean > allowed).then_some([least, greatest])
}

/// Number of times that a velocity falls below half of its mean and exceeds one and a half of it
/// from which a piston sticks and slips.
const CYCLES: usize = 3;

/// Least ratio of the distance between the ends of the rows to the path of the piston.
const ONE_WAY: f64 = 0.5;

/// Mean, least and greatest velocity of a piston that moves in one direction with stick-slip, m per
/// row.
pub(super) fn sticks_and_slips(positions: &[f64], noise: f64) -> Option<[f64; 3]> {
    let distance = positions.last()? - positions.first()?;
    let mean = distance / (positions.len() as f64 - 1.0);
    if distance.abs() <= 20.0 * noise {
        return None;
    }
    let (velocities, deviation) = velocities(positions, mean, noise)?;
    let way: f64 = velocities.iter().map(|velocity| velocity.abs()).sum();
    let straight = mean.abs() * velocities.len() as f64;
    let beyond = 0.5 * mean.abs() + OF_NOISE * deviation;
    let (mut cycles, mut is_slow) = (0, false);
    for velocity in &velocities {
        let over = (velocity - mean) * mean.signum();
        if over < -beyond {
            is_slow = true;
        } else if over > beyond && is_slow {
            is_slow = false;
            cycles += 1;
        }
    }
    let [least, greatest] = order::ends(velocities.iter().copied());
    (cycles >= CYCLES && straight >= ONE_WAY * way).then_some([mean, least, greatest])
}

/// Velocity of the shortest windows that noise permits, m per row, and its standard deviation.
fn velocities(positions: &[f64], mean: f64, noise: f64) -> Option<(Vec<f64>, f64)> {
    let noise = noise.max(resolution(positions) / 12.0_f64.sqrt());
    let deviation = |width: usize| {
        let count = width as f64;
        noise * (12.0 / (count * (count * count - 1.0))).sqrt()
    };
    let longest = positions.len() / FEWEST_WINDOWS;
    let width = (SHORTEST..=longest).find(|width| deviation(*width) <= RESOLVED * mean.abs())?;
    let windows = positions.windows(width).step_by((width / 2).max(1));
    Some((windows.map(slope).collect(), deviation(width)))
}

/// Step between two numbers of a position that repeats itself from row to row; zero if it does not.
fn resolution(positions: &[f64]) -> f64 {
    const REPEATED: usize = 10;
    let steps = || positions.windows(2).filter_map(|pair| Some((pair.last()? - pair.first()?).abs()));
    let repeated = steps().filter(|step| *step == 0.0).count();
    if REPEATED * repeated <= positions.len() {
        return 0.0;
    }
    let finest = steps().filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    if finest.is_finite() { finest } else { 0.0 }
}

/// Slope per row of the line by least squares.
fn slope(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let middle = (count - 1.0) / 2.0;
    let product: f64 = values.iter().enumerate().map(|(row, value)| (row as f64 - middle) * value).sum();
    product / (count * (count * count - 1.0) / 12.0)
}
