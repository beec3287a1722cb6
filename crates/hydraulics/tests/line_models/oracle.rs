//! Response of a model at one frequency, found only from its equations; the thesis' hose; the
//! exponential of a matrix.

use nalgebra::{Complex, DMatrix, DVector};
use num_complex::Complex64;
use phea_hydraulics::fluid::Fluid;
use phea_hydraulics::line::{Conduit, DynamicLine, LineResponse, StiffeningMember};
use phea_hydraulics::reference_rig::{components, hose_line};
use phea_hydraulics::stiffness::StiffnessModel;

pub(crate) fn fluid() -> Fluid {
    components(hose_line(), StiffnessModel::ByVolume).fluid
}

/// 1.5 m of the thesis' hose.
pub(crate) fn conduit() -> Conduit {
    Conduit::of_line(&hose_line(), &fluid(), 35e5, StiffeningMember::Nominal).unwrap()
}

pub(crate) fn at(frequency: f64) -> Complex64 {
    Complex64::new(0.0, frequency)
}

pub(crate) fn size(z: Complex64) -> f64 {
    z.norm_sqr().sqrt()
}

/// Outputs of a line for its flow, pressure, state and arriving waves: rates, waves sent, port
/// pressure, chamber flow.
fn answer(line: &DynamicLine, given: &[f64]) -> Vec<f64> {
    let (states, waves) = (line.states(), line.delays().len());
    let (flow, pressure) = (given[0], given[1]);
    let (state, arriving) = given[2..].split_at(states);
    let mut rates = vec![f64::NAN; states];
    let into_chamber = line.rates(flow, pressure, state, arriving, &mut rates);
    let mut sent = vec![f64::NAN; waves];
    line.outgoing(pressure, state, arriving, &mut sent);
    rates.extend(sent);
    rates.push(line.port_pressure(state, pressure));
    rates.push(into_chamber);
    rates
}

/// Transfer matrix of a model from valve port to chamber, its chamber compliance included:
/// equations taken column by column, delays as e^(-sT), then solved.
pub(crate) fn transfer_matrix(line: &DynamicLine, s: Complex64) -> [[Complex64; 2]; 2] {
    let inner = line.states() + line.delays().len();
    let columns: Vec<Vec<f64>> = (0..inner + 2)
        .map(|unit| answer(line, &(0..inner + 2).map(|i| f64::from(u8::from(i == unit))).collect::<Vec<_>>()))
        .collect();
    let entry = |row: usize, column: usize| Complex::new(columns[column][row], 0.0);
    let mut left = DMatrix::from_fn(inner, inner, |row, column| -entry(row, column + 2));
    for index in 0..line.states() {
        left[(index, index)] += s;
    }
    for (index, delay) in line.delays().into_iter().enumerate() {
        // sent - e^(sT) arriving = 0
        let index = line.states() + index;
        left[(index, index)] += phea_dynamics::portable::exp_complex(s * delay);
    }
    // rows and columns of very different units: bring both to one before eliminating
    let largest = |values: Vec<f64>| values.into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let columns_to_one: Vec<f64> =
        left.column_iter().map(|c| largest(c.iter().map(|z| size(*z)).collect())).collect();
    left.column_iter_mut().zip(&columns_to_one).for_each(|(mut column, by)| column.unscale_mut(*by));
    let rows_to_one: Vec<f64> =
        left.row_iter().map(|r| largest(r.iter().map(|z| size(*z)).collect())).collect();
    left.row_iter_mut().zip(&rows_to_one).for_each(|(mut row, by)| row.unscale_mut(*by));
    let solved = left.lu();
    let answers = |input: usize| {
        let given = DVector::from_fn(inner, |row, _| entry(row, input) / rows_to_one[row]);
        let inside = if inner == 0 { given } else { solved.solve(&given).unwrap() };
        let inside = DVector::from_fn(inner, |row, _| inside[row] / columns_to_one[row]);
        [inner, inner + 1].map(|row| {
            entry(row, input) + (0..inner).map(|i| entry(row, i + 2) * inside[i]).sum::<Complex64>()
        })
    };
    let ([port_of_flow, chamber_of_flow], [port_of_pressure, chamber_of_pressure]) = (answers(0), answers(1));
    // (p1, q) from (q1, p2), q being the flow delivered by the line; the end volume at the chamber
    // takes s C p2 of it, and q2 remains
    let taken = s * line.chamber_compliance();
    let t22 = chamber_of_flow.inv();
    let t21 = t22 * (taken - chamber_of_pressure);
    [[port_of_flow * t21 + port_of_pressure, t22 * port_of_flow], [t21, t22]]
}

/// Root mean square errors of t11, t12, t21 over the root mean square of the exact ones.
pub(crate) fn errors(
    line: &DynamicLine,
    exact: impl Fn(Complex64) -> LineResponse,
    frequencies: impl Iterator<Item = f64>,
) -> [f64; 3] {
    let (mut error, mut total) = ([0.0; 3], [0.0; 3]);
    for frequency in frequencies {
        let [[a11, a12], [a21, _]] = exact(at(frequency)).transfer_matrix();
        let [[b11, b12], [b21, _]] = transfer_matrix(line, at(frequency));
        for (index, (a, b)) in [(a11, b11), (a12, b12), (a21, b21)].into_iter().enumerate() {
            error[index] += (a - b).norm_sqr();
            total[index] += a.norm_sqr();
        }
    }
    [0, 1, 2].map(|index: usize| (error[index] / total[index]).sqrt())
}

/// Root mean square errors of the impedances in phase and in opposition over the root mean square
/// of the exact ones.
pub(crate) fn impedance_errors(
    line: &DynamicLine,
    exact: impl Fn(Complex64) -> LineResponse,
    frequencies: impl Iterator<Item = f64>,
) -> [f64; 2] {
    let (mut error, mut total) = ([0.0; 2], [0.0; 2]);
    for frequency in frequencies {
        let exact = exact(at(frequency));
        let found = impedances(line, at(frequency));
        for (index, (a, b)) in [(exact.in_phase, found.in_phase), (exact.in_opposition, found.in_opposition)]
            .into_iter()
            .enumerate()
        {
            error[index] += (a - b).norm_sqr();
            total[index] += a.norm_sqr();
        }
    }
    [0, 1].map(|index: usize| (error[index] / total[index]).sqrt())
}

/// Impedances of a model, from its transfer matrix.
pub(crate) fn impedances(line: &DynamicLine, s: Complex64) -> LineResponse {
    let [[t11, t12], [t21, _]] = transfer_matrix(line, s);
    LineResponse { in_phase: (t11 + 1.0) / t21, in_opposition: t12 / (t11 + 1.0) }
}

/// Exponential of a matrix by halving, a Taylor series and squaring.
pub(crate) fn exponential(matrix: &DMatrix<Complex64>) -> DMatrix<Complex64> {
    let order = matrix.nrows();
    let largest = matrix.iter().map(|entry| size(*entry)).fold(0.0, f64::max);
    let halvings = (0..60)
        .find(|halvings| largest * order as f64 / f64::from(1u32 << halvings.min(&30)) < 0.1)
        .unwrap_or(30);
    let scaled = matrix / Complex::new(f64::from(1u32 << halvings), 0.0);
    let mut result = DMatrix::identity(order, order);
    for term in (1..=16).rev() {
        result = DMatrix::identity(order, order) + &scaled * result / Complex::new(f64::from(term), 0.0);
    }
    (0..halvings).fold(result, |result, _| &result * &result)
}
