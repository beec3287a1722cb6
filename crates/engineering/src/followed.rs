//! Path of a command without the noise of its record, which the memories of a spool follow.

use nalgebra::{DMatrix, DVector};

use phea_dynamics::order::median;

/// Weights of a fourth difference, and their sum of squares: white noise of deviation sigma gives
/// it the deviation sqrt(70) sigma, a smooth command next to nothing.
const FOURTH_DIFFERENCE: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
const SUM_OF_SQUARES: f64 = 70.0;

/// Inverse ratio of the median magnitude of normal numbers to their standard deviation.
const OF_MEDIAN: f64 = 1.4826;

/// Ratio of roughness to the greatest command that follows from the digits of its numbers.
const OF_DIGITS: f64 = 1e-7;

/// Number of standard deviations of the noise by which a command has to move back to have turned:
/// the difference of two extremes of a hundred thousand rows of noise reaches nine.
const TURNED: f64 = 10.0;

/// Fewest rows from which a turning point is identified.
const FEWEST_TO_TURN: usize = 12;

/// Standard deviation of the differences from row to row in a record of a slow signal, in its unit:
/// noise, and rounding.
///
/// ```text
/// sigma = 1.4826 median |U_i - 4 U_(i+1) + 6 U_(i+2) - 4 U_(i+3) + U_(i+4)| / sqrt(70)
/// ```
pub(crate) fn roughness(command: &[f64]) -> f64 {
    let fourth =
        |rows: &[f64]| -> f64 { rows.iter().zip(FOURTH_DIFFERENCE).map(|(u, weight)| u * weight).sum() };
    let differences: Vec<f64> = command.windows(5).map(|rows| fourth(rows).abs()).collect();
    if differences.is_empty() {
        return 0.0;
    }
    let found = OF_MEDIAN * median(differences) / SUM_OF_SQUARES.sqrt();
    let greatest = command.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    if found > OF_DIGITS * greatest { found } else { 0.0 }
}

/// A recorded command without its noise: between two turning points, a monotonic sequence near the
/// record that does not go beyond the turning points.
///
/// Back-and-forth motion by noise is not in it. A memory that follows the record itself has moved
/// by many times the width of its hysteresis when the command has moved by one: noise of 2 mV rms
/// made a hysteresis of 0.128 V seem 0.247 V wide. Without noise, the result is the record.
pub(crate) fn followed(command: &[f64], roughness: f64) -> Vec<f64> {
    let mut found = Vec::with_capacity(command.len());
    let pieces = pieces(command, TURNED * roughness);
    for piece in &pieces {
        let rows = command.get(piece.rows.clone()).unwrap_or_default();
        let way = piece.way();
        let rising: Vec<f64> = rows.iter().map(|value| way * value).collect();
        found.extend(nearest_rising(&rising, TURNED * roughness).into_iter().map(|value| way * value));
    }
    // a command that never reverses has no noise, but rounding at most
    let goes_back = found.as_slice() != command;
    for pair in pieces.windows(2).filter(|_| goes_back) {
        let [before, after] = pair else { continue };
        let rows = before.rows.start..after.rows.end;
        turn(&mut found, command, (before.rows.end - 1, before.way()), rows, roughness);
    }
    found
}

/// Ends the path at the turning point of the command, estimated from the rows around it: the
/// greatest of them is beyond it by the largest noise among them.
///
/// The rows within the threshold of turning are fitted by a parabola and by two straight lines that
/// meet; the better of both gives the turning point.
fn turn(
    found: &mut [f64],
    command: &[f64],
    (at, way): (usize, f64),
    rows: std::ops::Range<usize>,
    roughness: f64,
) {
    let Some(end) = found.get(at).copied() else { return };
    let is_near = |row: &usize| found.get(*row).is_some_and(|value| way * (end - value) < TURNED * roughness);
    let first = rows.clone().take_while(|row| *row <= at).find(is_near);
    let last = (at..rows.end).take_while(is_near).last();
    let (Some(first), Some(last)) = (first, last) else { return };
    let Some(turned) = command.get(first..=last).and_then(|values| turning_value(values, at - first)) else {
        return;
    };
    for value in found.iter_mut().take(last + 1).skip(first) {
        *value = if way > 0.0 { value.min(turned) } else { value.max(turned) };
    }
}

/// Value at which neighbouring rows turn, near one of them; `None` if there are too few.
fn turning_value(values: &[f64], near: usize) -> Option<f64> {
    if values.len() < FEWEST_TO_TURN {
        return None;
    }
    let place = |row: usize| 2.0 * row as f64 / (values.len() - 1) as f64 - 1.0;
    let middle = place(near);
    let parabola = fitted(values, |row| place(row) * place(row))?;
    let corner = fitted(values, |row| (place(row) - middle).abs())?;
    Some(if parabola.squares <= corner.squares {
        let [constant, slope, bend] = parabola.fractions;
        constant - slope * slope / (4.0 * bend)
    } else {
        let [constant, slope, _] = corner.fractions;
        constant + slope * middle
    })
}

/// A least-squares fit and its residual.
struct TurnFit {
    fractions: [f64; 3],
    squares: f64,
}

/// A constant, a slope from -1 to 1 over the rows, and a third term.
fn fitted(values: &[f64], third: impl Fn(usize) -> f64) -> Option<TurnFit> {
    let place = |row: usize| 2.0 * row as f64 / (values.len() - 1) as f64 - 1.0;
    let terms = DMatrix::from_fn(values.len(), 3, |row, term| match term {
        0 => 1.0,
        1 => place(row),
        _ => third(row),
    });
    let right = DVector::from_column_slice(values);
    let fractions = terms.clone().svd(true, true).solve(&right, f64::EPSILON).ok()?;
    let squares = (terms * &fractions - right).norm_squared();
    let fractions = [*fractions.get(0)?, *fractions.get(1)?, *fractions.get(2)?];
    fractions.iter().all(|fraction| fraction.is_finite()).then_some(TurnFit { fractions, squares })
}

/// Rows that move in one direction.
struct Piece {
    rows: std::ops::Range<usize>,
    rises: bool,
}

impl Piece {
    /// Direction: 1 if the rows rise, -1 if they fall.
    fn way(&self) -> f64 {
        if self.rises { 1.0 } else { -1.0 }
    }
}

/// The command in pieces from one turning point to the next, each of which begins after its turning
/// point; a command has turned when it has moved back by more than a threshold.
fn pieces(command: &[f64], threshold: f64) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut from = 0;
    let mut rises = None;
    // the rows of the lowest and of the highest value since the last turning point
    let [mut lowest, mut highest] = [(0, f64::INFINITY), (0, f64::NEG_INFINITY)];
    for (row, value) in command.iter().copied().enumerate() {
        // of equal values the last one while the direction is unchanged, so that rest belongs to
        // the path before it
        if value <= lowest.1 {
            lowest = (row, value);
        }
        if value >= highest.1 {
            highest = (row, value);
        }
        match rises {
            Some(true) if value < highest.1 - threshold => {
                pieces.push(Piece { rows: from..highest.0 + 1, rises: true });
                (from, rises, lowest) = (highest.0 + 1, Some(false), (row, value));
            }
            Some(false) if value > lowest.1 + threshold => {
                pieces.push(Piece { rows: from..lowest.0 + 1, rises: false });
                (from, rises, highest) = (lowest.0 + 1, Some(true), (row, value));
            }
            None if value > lowest.1 + threshold => rises = Some(true),
            None if value < highest.1 - threshold => rises = Some(false),
            _ => {}
        }
    }
    pieces.push(Piece { rows: from..command.len(), rises: rises.unwrap_or(true) });
    pieces
}

/// Monotonically rising sequence nearest to this one: neighbours that fall are pooled to their mean
/// (Ayer, Brunk, Ewing, Reid and Silverman 1955), and straight lines join the middles of the pools,
/// except for those that are further apart than a step.
fn nearest_rising(values: &[f64], step: f64) -> Vec<f64> {
    let mut pools: Vec<(f64, usize)> = Vec::with_capacity(values.len());
    for value in values {
        let mut last = (*value, 1);
        while let Some((mean, count)) = pools.last().copied().filter(|(mean, _)| *mean > last.0) {
            pools.pop();
            let together = count + last.1;
            last = ((mean * count as f64 + last.0 * last.1 as f64) / together as f64, together);
        }
        pools.push(last);
    }
    let mut found = Vec::with_capacity(values.len());
    // twice the row of the middle of the preceding pool, and its mean
    let mut before: Option<(usize, f64)> = None;
    let mut begun = 0;
    for (mean, count) in pools {
        let middle = 2 * begun + count - 1;
        let from = before.unwrap_or((middle, mean));
        if mean - from.1 > step {
            found.resize(begun, from.1);
            found.resize(begun + count.div_ceil(2), mean);
        }
        while 2 * found.len() <= middle {
            let fraction = (2 * found.len()).saturating_sub(from.0) as f64 / (middle - from.0).max(1) as f64;
            found.push(if fraction == 1.0 { mean } else { from.1 + fraction * (mean - from.1) });
        }
        begun += count;
        before = Some((middle, mean));
    }
    let last = before.map_or(0.0, |(_, mean)| mean);
    found.resize(values.len(), last);
    found
}

#[cfg(test)]
mod tests {
    use phea_dynamics::random::{normal, stream};

    use super::*;

    /// A triangle of 10 V with a reversal of 0.2 V on its way up.
    fn path(rows: usize) -> Vec<f64> {
        let corners = [0.0, 6.0, 5.8, 10.0, -10.0, 0.0];
        let of = |pair: &[f64]| {
            let [from, to] = [pair[0], pair[1]];
            let steps = ((to - from).abs() * rows as f64 / 40.0) as usize;
            (0..steps).map(move |step| from + (to - from) * step as f64 / steps as f64).collect::<Vec<_>>()
        };
        corners.windows(2).flat_map(of).collect()
    }

    fn travelled(command: &[f64]) -> f64 {
        command.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
    }

    /// The result is the record, to the bit, in the absence of noise.
    #[test]
    fn a_clean_command_is_left_as_it_is() {
        let clean = path(8000);
        assert_eq!(roughness(&clean), 0.0);
        assert_eq!(followed(&clean, 0.0), clean);
    }

    /// The path has the length of the clean command to within the noise at each of four turning
    /// points; the path of the record is ten times as long.
    #[test]
    fn noise_adds_no_way() {
        let clean = path(40_000);
        let mut state = stream(7, 0);
        let noise = 0.002;
        let noisy: Vec<f64> = clean.iter().map(|value| value + noise * normal(&mut state)).collect();
        let found = roughness(&noisy);
        assert!((found / noise - 1.0).abs() < 0.05, "{found}");
        let smooth = followed(&noisy, found);
        assert_eq!(smooth.len(), clean.len());
        assert!(travelled(&noisy) > 2.0 * travelled(&clean));
        assert!((travelled(&smooth) - travelled(&clean)).abs() < 10.0 * 4.0 * noise);
        let errors: f64 = smooth.iter().zip(&clean).map(|(one, other)| (one - other) * (one - other)).sum();
        assert!((errors / clean.len() as f64).sqrt() < 0.7 * noise);
    }

    /// The turning points of a sine and a triangle are found to a fraction of the noise; the
    /// greatest row is beyond them by up to three times the noise.
    #[test]
    fn the_way_ends_where_the_command_turns() {
        let noise = 0.002;
        let sine =
            |row: usize| 3.0 * phea_dynamics::portable::sin(std::f64::consts::TAU * row as f64 / 2400.0);
        let triangle = |row: usize| 1.2 - (row as f64 - 1200.0).abs() * 0.001;
        for clean in [(0..2401).map(sine).collect::<Vec<f64>>(), (0..2401).map(triangle).collect()] {
            let most = clean.iter().copied().fold(0.0, f64::max);
            let mut beyond = [0.0, 0.0];
            for seed in 0..20 {
                let mut state = stream(seed, 0);
                let noisy: Vec<f64> = clean.iter().map(|value| value + noise * normal(&mut state)).collect();
                let smooth = followed(&noisy, roughness(&noisy));
                let greatest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max) - most;
                beyond[0] += greatest(&smooth) / 20.0;
                beyond[1] += greatest(&noisy) / 20.0;
            }
            assert!(beyond[0].abs() < 0.4 * noise, "{beyond:?}");
            assert!(beyond[1] > 0.6 * noise, "{beyond:?}");
        }
    }

    /// Steps and rests of a staircase remain in place.
    #[test]
    fn a_staircase_keeps_its_steps() {
        let stairs: Vec<f64> = (0..4000).map(|row| (row / 200) as f64 * 0.5).collect();
        let mut state = stream(8, 0);
        let noisy: Vec<f64> = stairs.iter().map(|value| value + 0.003 * normal(&mut state)).collect();
        let smooth = followed(&noisy, roughness(&noisy));
        for (one, other) in smooth.iter().zip(&stairs) {
            assert!((one - other).abs() < 0.008, "{one} {other}");
        }
    }

    #[test]
    fn what_falls_is_pooled() {
        assert_eq!(nearest_rising(&[1.0, 3.0, 2.0, 4.0], 9.0), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(nearest_rising(&[1.0, 3.0, 2.0, 4.0], 0.5), [1.0, 2.5, 2.5, 4.0]);
        assert_eq!(nearest_rising(&[3.0, 2.0, 1.0], 9.0), [2.0; 3]);
        assert_eq!(nearest_rising(&[0.1, 0.7, 0.7, 1.9], 0.0), [0.1, 0.7, 0.7, 1.9]);
        assert!(nearest_rising(&[], 0.0).is_empty());
    }
}
