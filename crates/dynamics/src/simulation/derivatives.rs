//! Derivatives of a system's equations with respect to its states and inputs.

use super::System;
use crate::scalar::Dual;

/// Number of derivatives found in one evaluation of a system's equations: one number everywhere,
/// because the equations are compiled once for each number used.
pub const DIRECTIONS: usize = 6;

/// Derivatives with respect to one state or input.
pub(super) struct DerivativeColumn {
    pub(super) rates: Vec<f64>,
    pub(super) sent: Vec<f64>,
}

/// Derivatives of the rates, and of the waves sent into the delays, with respect to all states and
/// then all inputs.
pub(super) fn derivatives<E: System<f64>>(
    system: &E,
    state: &[f64],
    inputs: &[f64],
    waves: usize,
) -> Vec<DerivativeColumn> {
    let count = state.len() + inputs.len();
    let mut columns = Vec::with_capacity(count);
    let mut rates = vec![Dual::constant(0.0); state.len()];
    let mut sent = vec![Dual::constant(0.0); waves];
    for first in (0..count).step_by(DIRECTIONS) {
        let seeded = |values: &[f64], from: usize| -> Vec<Dual<DIRECTIONS>> {
            let one = |(index, &value): (usize, &f64)| match (from + index).checked_sub(first) {
                Some(direction) => Dual::variable(value, direction),
                None => Dual::constant(value),
            };
            values.iter().enumerate().map(one).collect()
        };
        let (state, inputs) = (seeded(state, 0), seeded(inputs, state.len()));
        system.rates(&state, &inputs, &mut rates);
        system.outgoing(&state, &inputs, &mut sent);
        columns.extend((0..DIRECTIONS.min(count - first)).map(|direction| {
            let slopes = |duals: &[Dual<DIRECTIONS>]| {
                duals.iter().filter_map(|dual| dual.gradient().get(direction).copied()).collect()
            };
            DerivativeColumn { rates: slopes(&rates), sent: slopes(&sent) }
        }));
    }
    columns
}
