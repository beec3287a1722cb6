/// Number of past rows in the models, of input and output.
const PAST: usize = 20;
/// Number of future rows that are added.
const FUTURE: usize = 10;
/// Largest number of rows used.
const ROWS: usize = 20_000;
/// Fraction of a column that must be independent, as a square.
const NEW: f64 = 1e-12;
/// Fraction of the output's power below which there is no noise that could return.
const SILENT: f64 = 1e-6;
/// Fraction of the innovation above which it counts as returned.
const FRACTION: f64 = 0.01;
/// Ratio of mean squares above which it is significant: chance exceeds it once in ten thousand for
/// ten columns.
const SIGNIFICANT: f64 = 4.0;
/// Ratio for a single column: chance exceeds it once in a hundred thousand.
const SIGNIFICANT_ROW: f64 = 20.0;

/// Effect of an input on the output of its own row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WithinRow {
    /// The input changes between the rows, so that the output may follow it within a row.
    Possible,
    /// The input is held from row to row, so that the output can follow it one row later at the
    /// earliest.
    Impossible,
}

/// Fraction of an output's innovation that its input follows: 0 in an open loop.
///
/// ```text
/// y_n = sum over i = 1..20 of (a_i y_(n-i) + b_i u_(n-i)) + b_0 u_n + sum over j = 1..10 of c_j u_(n+j) + e_n
/// ```
///
/// Without feedback an input is independent of the output's noise, so that its future explains
/// nothing: c = 0 for any input (Sims 1972; with the past of the output, Geweke, Meese and Dent
/// 1983). Under feedback it explains some of it. A controller that acts within the row in which it
/// reads the output is visible in b_0, which then has the sign of the feedback, opposite to the sum
/// of all other b; if the input cannot act within its row, b_0 shows feedback for either sign. Both
/// count if they are significant and explain more than a hundredth. The larger of the two fractions
/// is returned. Noise of less than a millionth of the output's power, and records of fewer than 200
/// rows, are not tested.
///
/// # Example
/// An input moved only by the noise of the output, through an integral controller.
/// ```
/// use phea_dynamics::random::{normal, stream};
/// use phea_dynamics::spectrum::{WithinRow, feedback};
/// let mut state = stream(1, 0);
/// let (mut input, mut output, mut x, mut noise) = (vec![], vec![], vec![0.0], 0.0);
/// for n in 0..2000 {
///     noise = 0.9 * noise + normal(&mut state);
///     output.push(x[n] + noise);
///     input.push(input.last().unwrap_or(&0.0) - 0.1 * output[n]);
///     x.push(0.5 * x[n] + 0.5 * input[n]);
/// }
/// assert!(feedback(&input, &output, WithinRow::Possible) > 0.1);
/// // the same input, and other noise
/// let other: Vec<f64> = x.iter().map(|x| x + normal(&mut state)).collect();
/// assert_eq!(feedback(&input, &other, WithinRow::Possible), 0.0);
/// ```
pub fn feedback(input: &[f64], output: &[f64], within_row: WithinRow) -> f64 {
    let count = input.len().min(output.len()).min(ROWS);
    if count < 200 {
        return 0.0;
    }
    let rows = count - PAST - FUTURE;
    let shifted = |signal: &[f64], by: usize| -> Vec<f64> {
        let part = signal.get(by..by + rows).unwrap_or_default();
        let mean = part.iter().sum::<f64>() / rows as f64;
        part.iter().map(|value| value - mean).collect()
    };
    let mut innovation = shifted(output, PAST);
    let whole = product(&innovation, &innovation);
    let mut basis = Vec::with_capacity(2 * PAST + FUTURE + 1);
    for back in 1..=PAST {
        add(&mut basis, shifted(output, PAST - back));
    }
    // in addition to the differences from the last row, the coefficient of that row is the sum of
    // all b
    let last = shifted(input, PAST - 1);
    for back in 2..=PAST {
        let earlier = shifted(input, PAST - back);
        add(&mut basis, earlier.iter().zip(&last).map(|(earlier, last)| earlier - last).collect());
    }
    let mut level = last.clone();
    take_out(&basis, &mut level);
    let sum = product(&level, &innovation);
    add(&mut basis, last);
    take_out(&basis, &mut innovation);
    if product(&innovation, &innovation) <= SILENT * whole {
        return 0.0;
    }
    let now = shifted(input, PAST);
    let mut new = now.clone();
    take_out(&basis, &mut new);
    let is_against = within_row == WithinRow::Impossible || product(&new, &innovation) * sum < 0.0;
    let in_row = explained(&mut basis, &mut innovation, vec![now], SIGNIFICANT_ROW);
    let future = (1..=FUTURE).map(|ahead| shifted(input, PAST + ahead)).collect();
    let later = explained(&mut basis, &mut innovation, future, SIGNIFICANT);
    later.max(if is_against { in_row } else { 0.0 })
}

/// Removes these columns from the innovation too; returns the fraction that they explain, 0 if it
/// may be chance or is small.
fn explained(
    basis: &mut Vec<Vec<f64>>,
    innovation: &mut [f64],
    columns: Vec<Vec<f64>>,
    significant: f64,
) -> f64 {
    let known = basis.len();
    let before = product(innovation, innovation);
    columns.into_iter().for_each(|column| add(basis, column));
    take_out(basis.get(known..).unwrap_or_default(), innovation);
    let after = product(innovation, innovation);
    let freedom = innovation.len() as f64 - basis.len() as f64;
    let of_each = (before - after) / (basis.len() - known).max(1) as f64;
    let fraction = if before > 0.0 { 1.0 - after / before } else { 0.0 };
    if of_each > significant * after / freedom && fraction > FRACTION { fraction } else { 0.0 }
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// Removes the columns of an orthonormal basis from a signal; twice, against rounding.
fn take_out(basis: &[Vec<f64>], signal: &mut [f64]) {
    for column in basis.iter().chain(basis) {
        let along = product(column, signal);
        signal.iter_mut().zip(column).for_each(|(value, column)| *value -= along * column);
    }
}

/// Adds the independent part of a column to an orthonormal basis.
fn add(basis: &mut Vec<Vec<f64>>, mut column: Vec<f64>) {
    let whole = product(&column, &column);
    take_out(basis, &mut column);
    let new = product(&column, &column);
    if new > NEW * whole {
        let size = new.sqrt();
        basis.push(column.into_iter().map(|value| value / size).collect());
    }
}
