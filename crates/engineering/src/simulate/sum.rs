//! A signal as a sum of states and inputs.

use phea_dynamics::simulation::{Quartic, Stretch};

/// The terms of a signal: indices of the observed states, and of inputs, each with its weight.
///
/// ```text
/// s = sum of a_i y_i + sum of b_j w_j
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct WeightedSum {
    states: Vec<(usize, f64)>,
    inputs: Vec<(usize, f64)>,
}

impl WeightedSum {
    /// From a signal that is such a sum: its value for each of these states, and for each input,
    /// alone.
    pub(super) fn of(
        wanted: &[usize],
        [states, inputs]: [usize; 2],
        signal: impl Fn(&[f64], &[f64]) -> f64,
    ) -> WeightedSum {
        let unit = |count: usize, place: Option<usize>| {
            (0..count).map(|index| f64::from(u8::from(Some(index) == place))).collect::<Vec<f64>>()
        };
        let of_state = |&state: &usize| signal(&unit(states, Some(state)), &unit(inputs, None));
        let of_input = |input: usize| signal(&unit(states, None), &unit(inputs, Some(input)));
        let some = |weights: Vec<f64>| -> Vec<(usize, f64)> {
            weights.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0).collect()
        };
        WeightedSum {
            states: some(wanted.iter().map(of_state).collect()),
            inputs: some((0..inputs).map(of_input).collect()),
        }
    }

    /// The contribution of the states over a step.
    #[inline]
    pub(super) fn over(&self, states: &[Quartic]) -> Quartic {
        self.states.iter().fold(Quartic::constant(0.0), |sum, &(place, weight)| {
            states.get(place).map_or(sum, |state| sum.plus(weight, state))
        })
    }

    /// The contribution of the states at one time.
    pub(super) fn at(&self, states: &[f64]) -> f64 {
        let part = |&(place, weight): &(usize, f64)| weight * states.get(place).copied().unwrap_or(f64::NAN);
        self.states.iter().map(part).sum()
    }

    /// Whether inputs contribute to it.
    pub(super) fn has_inputs(&self) -> bool {
        !self.inputs.is_empty()
    }

    /// The contribution of the inputs over a part of a step.
    pub(super) fn driven(&self, stretch: &Stretch<'_>, part: f64, inputs: &mut [f64]) -> f64 {
        stretch.inputs_at(part, inputs);
        let part = |&(place, weight): &(usize, f64)| weight * inputs.get(place).copied().unwrap_or(f64::NAN);
        self.inputs.iter().map(part).sum()
    }
}

#[cfg(test)]
impl WeightedSum {
    /// One state by itself.
    pub(super) fn single(place: usize) -> WeightedSum {
        WeightedSum { states: vec![(place, 1.0)], inputs: Vec::new() }
    }
}
