//! Grids of frequencies.

use num_complex::Complex64;

use crate::linear::{LinearError, LinearOperation, TimeDomain, TransferFunction};
use crate::order::sorted_distinct;
use crate::portable::{argument, exp, ln, magnitude, pow};

/// `points` frequencies from `from` to `to` (both included, positive, in rad/s), equally spaced in
/// their logarithm.
///
/// # Errors
/// [`LinearError::Frequency`] when an end is not positive and finite, or `from` is above `to`.
///
/// # Example
/// ```
/// let grid = phea_dynamics::frequency::logarithmic_grid(0.1, 10.0, 3)?;
/// assert_eq!(grid.len(), 3);
/// assert!((grid[1] - 1.0).abs() < 1e-15);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn logarithmic_grid(from: f64, to: f64, points: usize) -> Result<Vec<f64>, LinearError> {
    let operation = LinearOperation::LogarithmicGrid;
    for frequency_rad_per_s in [from, to] {
        if !(frequency_rad_per_s > 0.0 && frequency_rad_per_s.is_finite()) {
            return Err(LinearError::Frequency { frequency_rad_per_s, operation });
        }
    }
    if from > to {
        return Err(LinearError::Frequency { frequency_rad_per_s: from, operation });
    }
    let (low, high) = (ln(from), ln(to));
    let last = points.saturating_sub(1);
    let at = |index: usize| match index {
        0 => from,
        _ if index == last => to,
        _ => exp(low + (high - low) * index as f64 / last as f64),
    };
    Ok((0..points).map(at).collect())
}

/// Points per decade of a search grid, in addition to those at the corners.
const POINTS_PER_DECADE: f64 = 100.0;
/// Rotations by dead time that a search resolves.
const MAXIMUM_ROTATIONS: f64 = 1000.0;
/// Magnitude below which rotations by dead time are ignored.
const NEGLIGIBLE: f64 = 1e-6;

/// Frequencies between which the response has no feature: dense in logarithm, denser around every
/// zero and pole, and dense enough for the rotation by dead time. Beyond its ends only asymptotes
/// remain.
pub(super) fn search_grid(system: &TransferFunction) -> Vec<f64> {
    let corners: Vec<Complex64> = equivalent_roots(system);
    let sizes = corners.iter().map(|root| magnitude(*root)).chain(asymptotic_crossovers(system));
    let sizes: Vec<f64> = sizes.filter(|size| *size > 0.0 && size.is_finite()).collect();
    let lowest = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = sizes.iter().copied().fold(0.0, f64::max);
    let (lowest, highest) = if sizes.is_empty() { (1.0, 1.0) } else { (lowest, highest) };
    let (mut from, mut to) = ((1e-3 * lowest).max(1e-290), (1e3 * highest).min(1e290));
    let mut grid = Vec::new();
    if let TimeDomain::Discrete { sample_time_s } = system.domain() {
        let nyquist = std::f64::consts::PI / sample_time_s;
        (from, to) = (from.min(1e-3 * nyquist), nyquist);
        grid.extend((1..=400).map(|k| nyquist * f64::from(k) / 400.0));
    }
    let decades = ln(to / from) / std::f64::consts::LN_10;
    let points = (1..).map(f64::from).take_while(|k| *k <= decades * POINTS_PER_DECADE + 2.0).count();
    grid.extend(logarithmic_grid(from, to, points).unwrap_or_default());
    for corner in &corners {
        extend_around(&mut grid, *corner);
    }
    extend_by_rotations(&mut grid, system, highest, to);
    grid.retain(|w| *w >= from && *w <= to);
    sorted_distinct(grid)
}

/// Zeros and poles; those of a sampled system as ln(z)/T.
fn equivalent_roots(system: &TransferFunction) -> Vec<Complex64> {
    let roots = system.zeros().iter().chain(system.poles()).copied();
    match system.domain() {
        TimeDomain::Continuous => roots.filter(|root| root.im >= 0.0).collect(),
        TimeDomain::Discrete { sample_time_s } => roots
            .filter(|root| root.im >= 0.0 && magnitude(*root) > 0.0)
            .map(|root| Complex64::new(ln(magnitude(root)), argument(root)) / sample_time_s)
            .collect(),
    }
}

/// Frequencies at which the low- and high-frequency asymptotes of a continuous system have unit
/// magnitude.
fn asymptotic_crossovers(system: &TransferFunction) -> Vec<f64> {
    if system.domain() != TimeDomain::Continuous || system.gain() == 0.0 {
        return Vec::new();
    }
    let at_origin = |roots: &[Complex64]| roots.iter().filter(|root| magnitude(**root) == 0.0).count() as f64;
    let logarithms = |roots: &[Complex64]| {
        roots.iter().map(|root| magnitude(*root)).filter(|size| *size > 0.0).map(ln).sum::<f64>()
    };
    let gain = ln(system.gain().abs());
    let low_gain = gain + logarithms(system.zeros()) - logarithms(system.poles());
    let low_slope = at_origin(system.poles()) - at_origin(system.zeros());
    let high_slope = system.poles().len() as f64 - system.zeros().len() as f64;
    let crossings = [(low_gain, low_slope), (gain, high_slope)];
    crossings.iter().filter(|(_, slope)| *slope != 0.0).map(|(gain, slope)| exp(gain / slope)).collect()
}

/// Points around the frequency of a root, spaced by its distance from the boundary of stability.
fn extend_around(grid: &mut Vec<f64>, root: Complex64) {
    grid.push(magnitude(root));
    let (centre, width) = (root.im, root.re.abs());
    if centre <= 0.0 {
        return;
    }
    for offset in [0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0] {
        grid.extend([centre - offset * width, centre + offset * width]);
    }
    if width > 0.0 {
        grid.push(centre);
    } else {
        // never on an undamped root itself
        grid.retain(|w| *w != centre);
        let offsets = (1..=8).map(|power| pow(10.0, -f64::from(power)));
        offsets.for_each(|offset| grid.extend([centre * (1.0 - offset), centre * (1.0 + offset)]));
    }
}

/// Adds points dense enough for the rotation by dead time, where the response matters.
fn extend_by_rotations(grid: &mut Vec<f64>, system: &TransferFunction, last_corner: f64, to: f64) {
    let dead_time = system.dead_time_s();
    if dead_time == 0.0 {
        return;
    }
    let step = std::f64::consts::PI / 8.0 / dead_time;
    let mut frequency = step;
    let limit = to.min(2.0 * std::f64::consts::PI * MAXIMUM_ROTATIONS / dead_time);
    while frequency < limit {
        if frequency > last_corner && magnitude(system.at_frequency(frequency)) < NEGLIGIBLE {
            return;
        }
        grid.push(frequency);
        frequency += step;
    }
}

/// Upper end of the range in which crossings of a system with dead time are listed.
pub(super) fn rotation_limit(system: &TransferFunction) -> f64 {
    if system.dead_time_s() > 0.0 {
        2.0 * std::f64::consts::PI * MAXIMUM_ROTATIONS / system.dead_time_s()
    } else {
        f64::INFINITY
    }
}
