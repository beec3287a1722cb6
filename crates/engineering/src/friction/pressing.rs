//! Part of a recorded run in which the piston is pressed and has not yet broken away.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::portable;
use phea_hydraulics::friction::KnottedForce;

use super::FrictionRecording;
use super::motion::noise;

/// Rows of a recording before the piston breaks away.
#[derive(Clone, Debug, PartialEq)]
pub struct PressedRows {
    /// Index of the recording.
    pub recording: usize,
    /// Number of rows, from the first.
    pub rows: usize,
    /// True if the piston breaks away at the end.
    pub breaks_away: bool,
    /// True if the force changes within a few rows.
    pub has_quick_force: bool,
    /// Initial estimate of the force, with a knot wherever it bends.
    pub(super) force: KnottedForce,
    /// Noise of force, N, and position, m.
    pub(super) noise: [f64; 2],
}

/// Fewest rows with sufficient information.
const FEWEST_ROWS: usize = 20;

/// Number of rows that count as the beginning.
const FIRST_ROWS: usize = 10;

/// Displacement up to which the rows are explained, relative to that of the bristles at breakaway:
/// a slow force reaches 86 % of the static friction there. Later rows depend on the noise of the
/// force more than on anything else.
const EXPLAINED: f64 = 2.0;

/// Displacement at which the piston has broken away, relative to that of the bristles at breakaway.
const BROKEN_AWAY: f64 = 8.0;

/// Fewest rows from knot to knot, unless the force bends.
const SPACING: usize = 20;

/// Largest number of pieces of a force that does not bend.
const PIECES: usize = 20;

/// Number of knots beyond which no further ones are added.
const MOST_KNOTS: usize = 120;

/// Number of searches for further knots.
const REFINEMENTS: usize = 40;

/// Fraction of the static friction up to which the compliance is read.
const ELASTIC: f64 = 0.5;

/// Mean position, m, and force, N, at the beginning of a recording.
fn beginning(recording: &FrictionRecording) -> [f64; 2] {
    [&recording.positions, &recording.forces].map(|values| {
        let first = values.get(..FIRST_ROWS.min(values.len())).unwrap_or_default();
        first.iter().sum::<f64>() / first.len().max(1) as f64
    })
}

/// Compliance of the bristles, m/N, from rest to a part of the static friction; at least the value
/// that noise permits to detect. The force is used without its noise, which would reduce the slope.
///
/// ```text
/// x = -(F_S/sigma_0) ln(1 - F/F_S)                    LuGre friction under a force that rises slowly
/// ```
pub(super) fn compliance(recording: &FrictionRecording, static_friction: f64) -> f64 {
    let position_noise = noise(&recording.positions);
    let smooth = knotted(&recording.forces, noise(&recording.forces));
    let knot = |index: usize| smooth.forces.get(index).copied().unwrap_or(0.0);
    let fractions = smooth.fractions().into_iter();
    let forces =
        fractions.map(|(before, fraction)| knot(before) * (1.0 - fraction) + knot(before + 1) * fraction);
    let [position, _] = beginning(recording);
    let force = knot(0);
    let both = recording.positions.iter().zip(forces);
    let near = both.take_while(|(_, now)| (now - force).abs() <= ELASTIC * static_friction);
    let (mut product, mut square, mut rows) = (0.0, 0.0, 0.0);
    for (at, now) in near {
        let fraction = (now - force) / static_friction;
        let slipping = -static_friction * fraction.signum() * portable::log1p(-fraction.abs());
        product += (at - position) * slipping;
        square += slipping * slipping;
        rows += 1.0;
    }
    let seen = position_noise / (static_friction * f64::sqrt(rows + 1.0));
    if square > 0.0 { (product / square).max(seen) } else { seen }
}

/// A piston that breaks away from rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Breakaway {
    /// Direction of the displacement, 1 or -1.
    pub(super) way: f64,
    /// Greatest force until breakaway, including the zero error of the instruments, N.
    pub(super) force: f64,
}

/// Row and force at which the piston breaks away; `None` if it does not.
pub(super) fn breakaway(recording: &FrictionRecording) -> Option<Breakaway> {
    let position_noise = noise(&recording.positions);
    let smooth = knotted(&recording.forces, noise(&recording.forces));
    let first = *smooth.forces.first()?;
    let change = smooth.forces.iter().map(|force| (force - first).abs()).fold(0.0, f64::max);
    let limit = BROKEN_AWAY * compliance(recording, change) * change + 6.0 * position_noise;
    let [start, _] = beginning(recording);
    let moved = recording.positions.iter().map(|position| position - start);
    let (row, moved) = moved.enumerate().find(|(_, moved)| moved.abs() > limit)?;
    let fractions = smooth.fractions().into_iter().take(row + 1);
    let knot = |index: usize| smooth.forces.get(index).copied().unwrap_or(0.0);
    let forces =
        fractions.map(|(before, fraction)| knot(before) * (1.0 - fraction) + knot(before + 1) * fraction);
    let way = moved.signum();
    let force = forces.max_by(|one, other| (way * one).total_cmp(&(way * other)))?;
    Some(Breakaway { way, force })
}

/// Rows until the piston breaks away; `None` if there are too few rows.
pub(super) fn pressed_rows(
    recording: &FrictionRecording,
    index: usize,
    broken_by: f64,
) -> Option<PressedRows> {
    let noise = [&recording.forces, &recording.positions].map(|values| noise(values));
    let [start, _] = beginning(recording);
    let is_beyond = |length: f64| {
        let limit = length * broken_by + 6.0 * noise[1];
        recording.positions.iter().position(|position| (position - start).abs() > limit)
    };
    let rows = is_beyond(EXPLAINED).unwrap_or(recording.positions.len());
    let forces = recording.forces.get(..rows)?;
    let force = knotted(forces, noise[0]);
    (rows >= FEWEST_ROWS).then(|| PressedRows {
        recording: index,
        rows,
        has_quick_force: force.knots.windows(2).take(force.knots.len().saturating_sub(2)).any(is_quick),
        breaks_away: is_beyond(BROKEN_AWAY).is_some(),
        force,
        noise,
    })
}

/// A force that is linear between its knots, as close to the rows as their noise: knots at equal
/// distances, and at each row at which the force bends more sharply.
fn knotted(forces: &[f64], noise: f64) -> KnottedForce {
    let last = forces.len().saturating_sub(1);
    let spacing = (forces.len() / PIECES).max(SPACING);
    let mut knots: Vec<usize> = (0..last).step_by(spacing).chain([last]).collect();
    for _ in 0..REFINEMENTS {
        let found = through(knots, forces);
        let sharp = sharpest(&residuals(&found, forces), noise);
        let before = found.knots.len();
        if sharp.is_empty() || before > MOST_KNOTS {
            return found;
        }
        knots = found.knots;
        knots.extend(sharp);
        knots.sort_unstable();
        knots.dedup();
        if knots.len() == before {
            break;
        }
    }
    through(knots, forces)
}

/// True if two knots are at neighbouring rows.
fn is_quick(knots: &[usize]) -> bool {
    matches!(knots, [one, next] if next - one == 1)
}

/// Force at these knots by least squares over all rows.
fn through(knots: Vec<usize>, forces: &[f64]) -> KnottedForce {
    let count = knots.len();
    let found = KnottedForce { knots, forces: vec![0.0; count] };
    let mut normal = DMatrix::<f64>::zeros(count, count);
    let mut right = DVector::<f64>::zeros(count);
    for ((knot, fraction), force) in found.fractions().into_iter().zip(forces) {
        let weights = [(knot, 1.0 - fraction), (knot + 1, fraction)];
        for (i, first) in weights {
            right[i] += first * force;
            for (j, second) in weights {
                normal[(i, j)] += first * second;
            }
        }
    }
    // each knot coincides with a row, so that there is a solution
    let solved = normal.cholesky().map(|factor| factor.solve(&right));
    KnottedForce { forces: solved.map_or(found.forces, |heights| heights.iter().copied().collect()), ..found }
}

fn residuals(found: &KnottedForce, forces: &[f64]) -> Vec<f64> {
    let at = |knot: usize| found.forces.get(knot).copied().unwrap_or(0.0);
    let fractions = found.fractions().into_iter().zip(forces);
    fractions
        .map(|((knot, fraction), force)| force - at(knot) * (1.0 - fraction) - at(knot + 1) * fraction)
        .collect()
}

/// Rows around the neighbours whose residuals exceed noise most, if any do.
fn sharpest(residuals: &[f64], noise: f64) -> std::ops::Range<usize> {
    const BEYOND_NOISE: f64 = 4.5;
    const AROUND: usize = 2;
    let (mut worst, mut rows) = (BEYOND_NOISE, 0..0);
    for width in [1, 2, 4] {
        for (start, window) in residuals.windows(width).enumerate() {
            let size = window.iter().sum::<f64>().abs() / (noise * f64::sqrt(width as f64));
            if size > worst {
                let end = (start + width + AROUND).min(residuals.len());
                (worst, rows) = (size, start.saturating_sub(AROUND)..end);
            }
        }
    }
    rows
}
