//! A signal as a sum of states and inputs.

use std::rc::Rc;

use phea_dynamics::simulation::{Quartic, Stretch};

/// Terms of a signal: indices of the observed states, and of inputs, each with its weight; and of
/// states on which it depends nonlinearly, as on the deflection of a progressive spring.
///
/// ```text
/// s = sum of a_i y_i + sum of f_k(y_k) + sum of b_j w_j
/// ```
#[derive(Default)]
pub(super) struct SignalSum<'a> {
    states: Vec<(usize, f64)>,
    curved: Vec<(usize, Term<'a>)>,
    inputs: Vec<(usize, f64)>,
}

/// Contribution of a state.
type Term<'a> = Box<dyn Fn(f64) -> f64 + 'a>;

/// Value of a state at which a proportional term has this fraction of its weight.
const SMALL: f64 = 1e-3;
/// Relative deviation from proportionality that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Points of a step through whose values a polynomial of degree four is fitted.
const QUARTERS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

impl<'a> SignalSum<'a> {
    /// Sum from a signal that has this form: its value for each of these states, and for each
    /// input, with all others zero.
    pub(super) fn of(
        wanted: &[usize],
        [states, inputs]: [usize; 2],
        signal: impl Fn(&[f64], &[f64]) -> f64 + 'a,
    ) -> SignalSum<'a> {
        let only = |count: usize, place: usize, value: f64| {
            let mut alone = vec![0.0; count];
            alone[place] = value;
            alone
        };
        let signal = Rc::new(signal);
        let mut sum = SignalSum::default();
        for (index, &state) in wanted.iter().enumerate() {
            let signal = signal.clone();
            let term = move |value: f64| signal(&only(states, state, value), &vec![0.0; inputs]);
            let (weight, small) = (term(1.0), term(SMALL));
            if (small - SMALL * weight).abs() > ROUNDING * small.abs() {
                sum.curved.push((index, Box::new(term)));
            } else if weight != 0.0 {
                sum.states.push((index, weight));
            }
        }
        let weights = (0..inputs).map(|input| signal(&vec![0.0; states], &only(inputs, input, 1.0)));
        sum.inputs = weights.enumerate().filter(|(_, weight)| *weight != 0.0).collect();
        sum
    }

    /// Contribution of the states over a step.
    #[inline]
    pub(super) fn over(&self, states: &[Quartic]) -> Quartic {
        let straight = self.states.iter().fold(Quartic::constant(0.0), |sum, &(place, weight)| {
            states.get(place).map_or(sum, |state| sum.plus(weight, state))
        });
        self.curved.iter().fold(straight, |sum, (place, term)| {
            let through = |state: &Quartic| Quartic::through(QUARTERS.map(|part| term(state.at(part))));
            states.get(*place).map_or(sum, |state| sum.plus(1.0, &through(state)))
        })
    }

    /// Contribution of the states at one time.
    pub(super) fn at(&self, states: &[f64]) -> f64 {
        let value = |place: usize| states.get(place).copied().unwrap_or(f64::NAN);
        let straight: f64 = self.states.iter().map(|&(place, weight)| weight * value(place)).sum();
        straight + self.curved.iter().map(|(place, term)| term(value(*place))).sum::<f64>()
    }

    /// True if inputs contribute to the signal.
    pub(super) fn has_inputs(&self) -> bool {
        !self.inputs.is_empty()
    }

    /// Contribution of the inputs over a part of a step.
    pub(super) fn driven(&self, stretch: &Stretch<'_>, part: f64, inputs: &mut [f64]) -> f64 {
        stretch.inputs_at(part, inputs);
        let part = |&(place, weight): &(usize, f64)| weight * inputs.get(place).copied().unwrap_or(f64::NAN);
        self.inputs.iter().map(part).sum()
    }
}

#[cfg(test)]
impl SignalSum<'_> {
    /// A single state.
    pub(super) fn single(place: usize) -> Self {
        SignalSum { states: vec![(place, 1.0)], ..SignalSum::default() }
    }
}
