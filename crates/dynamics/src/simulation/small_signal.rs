//! Response of a system to small sines about an equilibrium, from its exact derivatives.

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

use super::System;
use super::derivatives::{DerivativeColumn, derivatives};
use crate::portable;

/// Complex amplitudes of all states under sines on the inputs about an equilibrium; `None` if the
/// equations have no unique solution.
///
/// ```text
/// j w X = A X + B U + E W,     W = e^(-j w d) (C X + D U + H W)         y = y_0 + Im(X e^(j w t)), u = u_0 + Im(U e^(j w t))
/// ```
///
/// A, B, E are the derivatives of the rates with respect to states, inputs and the waves that
/// arrive, C, D, H those of the waves sent into the delays d. `inputs` are all inputs at rest,
/// `drive` the amplitudes of those before the waves; missing amplitudes are zero.
///
/// # Example
/// A tank of time constant 0.5 s:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{System, small_signal};
/// struct Tank;
/// impl System<f64> for Tank {
///     fn states(&self) -> usize {
///         1
///     }
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0]
///     }
///     fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
///         rates[0] = T::from(2.0) * (inputs[0] - state[0].squared());
///     }
/// }
/// // about a level of 0.5: dy/dt = 2 u - 2 y
/// let level = small_signal(&Tank, &[0.5], &[0.25], &[Complex64::ONE], 2.0).unwrap()[0];
/// assert!((level - 1.0 / Complex64::new(1.0, 1.0)).norm_sqr() < 1e-24);
/// ```
pub fn small_signal<E: System<f64>>(
    system: &E,
    state: &[f64],
    inputs: &[f64],
    drive: &[Complex64],
    frequency_rad_per_s: f64,
) -> Option<Vec<Complex64>> {
    let delays = system.delays();
    let (states, waves) = (system.states(), delays.len());
    let own = system.inputs().checked_sub(waves)?;
    if state.len() != states || inputs.len() != own + waves {
        return None;
    }
    let columns = derivatives(system, state, inputs, waves);
    let late = delays.iter().map(|delay| Complex64::new(0.0, -frequency_rad_per_s * delay));
    let late: Vec<Complex64> = late.map(portable::exp_complex).collect();
    // unknowns are the states and then the waves, each over its scale, as real part and imaginary
    // part
    let unknowns = states + waves;
    let mut scales = system.scales();
    scales.resize(unknowns, 1.0);
    let of_unknown = |unknown: usize| if unknown < states { unknown } else { unknown + own };
    let entry = |row: usize, column: &DerivativeColumn| match row.checked_sub(states) {
        None => column.rates[row].into(),
        Some(wave) => late[wave] * column.sent[wave],
    };
    let mut matrix = DMatrix::zeros(2 * unknowns, 2 * unknowns);
    let mut right = DVector::zeros(2 * unknowns);
    for row in 0..unknowns {
        let own_part = if row < states { Complex64::new(0.0, frequency_rad_per_s) } else { Complex64::ONE };
        for unknown in 0..unknowns {
            let mut value = -entry(row, &columns[of_unknown(unknown)]);
            if unknown == row {
                value += own_part;
            }
            value *= scales[unknown] / scales[row];
            matrix[(row, unknown)] = value.re;
            matrix[(row, unknown + unknowns)] = -value.im;
            matrix[(row + unknowns, unknown)] = value.im;
            matrix[(row + unknowns, unknown + unknowns)] = value.re;
        }
        let driven: Complex64 = drive
            .iter()
            .take(own)
            .zip(&columns[states..])
            .map(|(part, column)| entry(row, column) * part)
            .sum();
        right[row] = driven.re / scales[row];
        right[row + unknowns] = driven.im / scales[row];
    }
    let solution = matrix.lu().solve(&right)?;
    let amplitudes: Vec<Complex64> = (0..states)
        .map(|row| Complex64::new(solution[row], solution[row + unknowns]) * scales[row])
        .collect();
    amplitudes.iter().all(|amplitude| amplitude.is_finite()).then_some(amplitudes)
}
