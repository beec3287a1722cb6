//! Rows at which a recorded run slides at a constant velocity.

use std::ops::Range;

use phea_hydraulics::friction::SlidBlock;

use super::FrictionRecording;
use super::varying::{VaryingVelocity, sticks_and_slips, varying};
use phea_dynamics::order::median;

/// Rows over which the piston slides at a constant velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantVelocity {
    /// Index of the recording.
    pub recording: usize,
    /// Rows that are used; those at both ends are omitted.
    pub rows: Range<usize>,
    /// Slope of the line through the positions, m/s.
    pub velocity: f64,
    /// Blocks of rows, one after the other.
    pub(super) blocks: Vec<ForceBlock>,
}

/// Neighbouring rows taken together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ForceBlock {
    pub(super) slid: SlidBlock,
    /// Mean force of the rows, N.
    pub(super) force: f64,
    pub(super) rows: usize,
}

/// Fewest rows of a constant velocity.
const FEWEST_ROWS: usize = 20;

/// Largest number of blocks of a constant velocity.
const BLOCKS: usize = 40;

/// Fraction of the rows that is omitted at either end, where the velocity may still change.
const ENDS: f64 = 0.05;

/// Fraction by which a constant velocity may change from its beginning to its end.
const CHANGE: f64 = 0.02;

/// Largest fraction by which it may change, including twice the standard deviation of the change.
const CERTAIN_CHANGE: f64 = 0.05;

/// Fraction by which the force may still change in the second half.
const SETTLED: f64 = 0.05;

/// Number of standard deviations of the slope of a force beyond which it is no noise.
const CERTAIN_SLOPE: f64 = 6.0;

/// Relative difference of slopes that belong to one line.
const SAME_SLOPE: f64 = 0.25;

/// Sum of the residuals of a line, divided by noise and the root of their number, beyond which it
/// is not a line. The largest of white noise exceeds 0.9 in one case of twenty: an additional bend
/// does no harm.
const BENT: f64 = 1.0;

/// Standard deviation of white noise on a smooth signal, from the median of its third differences
/// (their variance is 20 times that of the noise); at least the resolution of the numbers.
pub(super) fn noise(values: &[f64]) -> f64 {
    let third = values.windows(4).filter_map(|four| match four {
        [a, b, c, d] => Some((d - 3.0 * c + 3.0 * b - a).abs()),
        _ => None,
    });
    let differences: Vec<f64> = third.collect();
    let largest = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let floor = 1e-12 * largest;
    if differences.is_empty() { floor } else { (1.4826 * median(differences) / 20.0_f64.sqrt()).max(floor) }
}

/// Straight line through the values of some rows.
#[derive(Clone, Copy, Debug)]
struct RowLine {
    middle: f64,
    mean: f64,
    /// Slope per row.
    slope: f64,
}

impl RowLine {
    fn through(values: &[f64], rows: &Range<usize>) -> RowLine {
        let own = values.get(rows.clone()).unwrap_or_default();
        let count = own.len().max(1) as f64;
        let middle = rows.start as f64 + (count - 1.0) / 2.0;
        let mean = own.iter().sum::<f64>() / count;
        let square = count * (count * count - 1.0) / 12.0;
        let from_middle = |row: usize| (rows.start + row) as f64 - middle;
        let product: f64 = own.iter().enumerate().map(|(row, value)| from_middle(row) * (value - mean)).sum();
        RowLine { middle, mean, slope: if square > 0.0 { product / square } else { 0.0 } }
    }

    fn at(&self, row: usize) -> f64 {
        self.mean + self.slope * (row as f64 - self.middle)
    }
}

/// Pieces of rows over each of which the values are linear, within noise or within a fraction of
/// their change.
fn straight_pieces(values: &[f64], noise: f64, fraction: f64) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut open = vec![Range { start: 0, end: values.len() }];
    while let Some(rows) = open.pop() {
        match bend(values, &rows, noise, fraction) {
            Some(at) => {
                open.push(at..rows.end);
                open.push(rows.start..at);
            }
            None => found.push(rows),
        }
    }
    joined(found, |rows| bend(values, rows, noise, fraction).is_none())
}

/// Neighbouring pieces joined if they are one: a search may have split one next to a jump.
fn joined(pieces: Vec<Range<usize>>, is_straight: impl Fn(&Range<usize>) -> bool) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let mut piece = piece;
        while let Some(before) = found.pop() {
            let both = before.start..piece.end;
            if !is_straight(&both) {
                found.push(before);
                break;
            }
            piece = both;
        }
        found.push(piece);
    }
    found
}

/// Row at which these rows bend most, if they bend.
fn bend(values: &[f64], rows: &Range<usize>, noise: f64, fraction: f64) -> Option<usize> {
    const SHORTEST: usize = 3;
    let count = rows.len();
    if count < 2 * SHORTEST {
        return None;
    }
    let line = RowLine::through(values, rows);
    let own = values.get(rows.clone())?;
    let residuals: Vec<f64> =
        own.iter().enumerate().map(|(row, value)| value - line.at(rows.start + row)).collect();
    let mut sum = 0.0;
    let sums = residuals.iter().map(|residual| {
        sum += residual;
        sum
    });
    let largest = sums.map(f64::abs).fold(0.0, f64::max);
    let single = residuals.iter().map(|residual| residual.abs()).fold(0.0, f64::max);
    let root = (count as f64).sqrt();
    if largest <= BENT * noise * root && single <= 6.0 * noise {
        return None;
    }
    let width = (count / 16).max(1);
    let mean = |(start, window): (usize, &[f64])| {
        (start + width / 2, (window.iter().sum::<f64>() / width as f64).abs())
    };
    let means = residuals.windows(width).enumerate().map(mean);
    let (at, most) = means.fold((0, 0.0), |best, one| if one.1 > best.1 { one } else { best });
    let allowed = fraction / 12.0 * (line.slope * count as f64).abs();
    (most > allowed).then(|| rows.start + at.clamp(SHORTEST, count - SHORTEST))
}

/// Runs in which a recording slides along a line.
#[derive(Clone, Debug, Default)]
pub(super) struct SlidingRuns {
    pub(super) constant: Vec<ConstantVelocity>,
    /// Runs whose velocity is constant only on average.
    pub(super) varying: Vec<VaryingVelocity>,
}

/// Runs of a recording at a velocity that is constant, at least on average.
pub(super) fn sliding_runs(recording: &FrictionRecording, index: usize) -> SlidingRuns {
    let positions = &recording.positions;
    let [position_noise, force_noise] = [positions, &recording.forces].map(|values| noise(values));
    let mut found = SlidingRuns::default();
    for piece in straight_pieces(positions, position_noise, CHANGE) {
        let margin = ((piece.len() as f64 * ENDS).ceil() as usize).max(1);
        let rows = piece.start + margin..piece.end.saturating_sub(margin);
        if rows.len() < FEWEST_ROWS || !is_constant(positions, &rows, position_noise) {
            continue;
        }
        let slope = RowLine::through(positions, &rows).slope;
        let own = positions.get(rows.clone()).unwrap_or_default();
        if let Some(range) = varying(own, slope, position_noise) {
            let [velocity, least, greatest] =
                [slope, range[0], range[1]].map(|slope| slope / recording.time_step);
            let range = [least, greatest];
            found.varying.push(VaryingVelocity { recording: index, rows, velocity, range });
        } else if is_settled(&recording.forces, &rows, force_noise)
            && !is_ramp(&recording.forces, &rows, force_noise)
        {
            found.constant.push(taken(recording, index, rows));
        }
    }
    let lines = found.constant.iter().map(|run| run.rows.clone());
    let lines: Vec<Range<usize>> = lines.chain(found.varying.iter().map(|run| run.rows.clone())).collect();
    for rows in between(lines, positions.len()) {
        let own = positions.get(rows.clone()).unwrap_or_default();
        let Some([velocity, least, greatest]) = sticks_and_slips(own, position_noise) else { continue };
        let [velocity, least, greatest] =
            [velocity, least, greatest].map(|slope| slope / recording.time_step);
        found.varying.push(VaryingVelocity { recording: index, rows, velocity, range: [least, greatest] });
    }
    found.varying.sort_by_key(|run| run.rows.start);
    found
}

/// Rows between these.
fn between(mut taken: Vec<Range<usize>>, count: usize) -> Vec<Range<usize>> {
    taken.sort_by_key(|rows| rows.start);
    let starts = std::iter::once(0).chain(taken.iter().map(|rows| rows.end));
    let ends = taken.iter().map(|rows| rows.start).chain([count]);
    starts.zip(ends).map(|(start, end)| start..end.max(start)).collect()
}

/// True if the piston certainly moves, and certainly at one velocity.
fn is_constant(positions: &[f64], rows: &Range<usize>, noise: f64) -> bool {
    let count = rows.len() as f64;
    let line = RowLine::through(positions, rows);
    // coefficient of the second-order Legendre polynomial, whose ends differ in slope by 12/count
    // of it
    let middle = rows.start as f64 + (count - 1.0) / 2.0;
    let second = |row: usize| {
        let x = 2.0 * (row as f64 - middle) / count;
        (3.0 * x * x - 1.0) / 2.0
    };
    let own = positions.get(rows.clone()).unwrap_or_default().iter().enumerate();
    let product: f64 =
        own.map(|(row, value)| second(rows.start + row) * (value - line.at(rows.start + row))).sum();
    let size = product * 5.0 / count;
    let deviation = noise * (5.0 / count).sqrt();
    let change = 12.0 / count * (size.abs() + 2.0 * deviation);
    change <= CERTAIN_CHANGE * line.slope.abs() && line.slope.abs() * count > 20.0 * noise
}

/// True if the force no longer changes: it does while a seal is only deformed.
fn is_settled(forces: &[f64], rows: &Range<usize>, noise: f64) -> bool {
    let quarter = rows.len() / 4;
    let mean = |start: usize| {
        let own = forces.get(start..start + quarter).unwrap_or_default();
        own.iter().sum::<f64>() / quarter as f64
    };
    let [second, last] = [rows.start + quarter, rows.end - quarter].map(mean);
    let by_noise = 6.0 * noise * (2.0 / quarter as f64).sqrt();
    (last - second).abs() <= by_noise.max(SETTLED * last.abs())
}

/// True if the force rises or falls along one line through the rows and beyond them: slowly loaded
/// bristles move the piston as steadily as sliding does.
fn is_ramp(forces: &[f64], rows: &Range<usize>, noise: f64) -> bool {
    let count = rows.len();
    let slope = |rows: Range<usize>| RowLine::through(forces, &rows).slope;
    let own = slope(rows.clone());
    let by_noise = CERTAIN_SLOPE * noise * (12.0 / count as f64).sqrt() / count as f64;
    let before = rows.start.checked_sub(count / 2).map(|start| start..rows.start);
    let after = Some(rows.end..rows.end + count / 2).filter(|after| after.end <= forces.len());
    let around: Vec<f64> = before.into_iter().chain(after).map(slope).collect();
    let is_alike = |slope: &f64| (slope - own).abs() <= SAME_SLOPE * own.abs();
    own.abs() > by_noise && !around.is_empty() && around.iter().all(is_alike)
}

fn taken(recording: &FrictionRecording, index: usize, rows: Range<usize>) -> ConstantVelocity {
    let velocity = RowLine::through(&recording.positions, &rows).slope / recording.time_step;
    let each = (velocity * recording.time_step).abs();
    let width = rows.len().div_ceil(BLOCKS);
    let own = recording.forces.get(rows.clone()).unwrap_or_default();
    let block = |(number, forces): (usize, &[f64])| {
        let count = forces.len() as f64;
        let before = (number * width) as f64;
        ForceBlock {
            slid: SlidBlock {
                velocity,
                distance: (before + (count - 1.0) / 2.0) * each,
                half_length: count / 2.0 * each,
            },
            force: forces.iter().sum::<f64>() / count,
            rows: forces.len(),
        }
    };
    let blocks = own.chunks(width).enumerate().map(block).collect();
    ConstantVelocity { recording: index, rows, velocity, blocks }
}
