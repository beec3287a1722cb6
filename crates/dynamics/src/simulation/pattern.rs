//! Structure of a Jacobian, and a small number of evaluations that find it.

use super::System;
use crate::scalar::{Dependence, Scalar};

/// Structure of the Jacobian of a system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct JacobianPattern {
    /// States on which each rate depends, rising.
    pub(super) rows: Vec<Vec<usize>>,
    /// Colour of each state: no rate depends on two states of one colour.
    pub(super) colours: Vec<usize>,
    /// Number of colours.
    pub(super) colour_count: usize,
    /// True for a rate that depends on an input.
    pub(super) driven: Vec<bool>,
}

impl JacobianPattern {
    /// Pattern of this system; `None` if it has more states and inputs than can be followed.
    pub(super) fn of<S: Scalar, E: System<S>>(system: &E) -> Option<JacobianPattern>
    where
        Dependence: From<S>,
    {
        let (states, inputs) = (system.states(), system.inputs());
        if states + inputs > Dependence::CAPACITY {
            return None;
        }
        let state: Vec<Dependence> = (0..states).map(Dependence::on).collect();
        let input: Vec<Dependence> = (states..states + inputs).map(Dependence::on).collect();
        let mut rates = vec![Dependence::default(); states];
        system.rates(&state, &input, &mut rates);
        let of_row = |rate: &Dependence| (0..states).filter(|&column| rate.includes(column)).collect();
        let rows: Vec<Vec<usize>> = rates.iter().map(of_row).collect();
        let driven = rates.iter().map(|rate| (states..states + inputs).any(|index| rate.includes(index)));
        let driven = driven.collect();
        let colours = coloured(&rows, states);
        let colour_count = colours.iter().max().map_or(0, |highest| highest + 1);
        Some(JacobianPattern { rows, colours, colour_count, driven })
    }
}

/// Greedy colouring in the order of the states: each state takes the least colour that none of its
/// neighbours has. Two states are neighbours when a rate depends on both. Source: Curtis, Powell
/// and Reid (1974).
fn coloured(rows: &[Vec<usize>], states: usize) -> Vec<usize> {
    let mut colours: Vec<usize> = Vec::with_capacity(states);
    for state in 0..states {
        let mut taken = vec![false; states + 1];
        for row in rows.iter().filter(|row| row.contains(&state)) {
            for &neighbour in row.iter().filter(|&&neighbour| neighbour < state) {
                taken[colours[neighbour]] = true;
            }
        }
        colours.push(taken.iter().position(|taken| !taken).unwrap_or(states));
    }
    colours
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three masses in a row: each rate of velocity depends on its neighbours' positions.
    struct Chain;

    impl System<f64> for Chain {
        fn states(&self) -> usize {
            6
        }
        fn inputs(&self) -> usize {
            1
        }
        fn scales(&self) -> Vec<f64> {
            vec![1.0; 6]
        }
        fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
            let [x, y, z, u, v, w] = [0, 1, 2, 3, 4, 5].map(|index| state[index]);
            let two = T::from(2.0);
            rates.copy_from_slice(&[u, v, w, inputs[0] + y - two * x, x + z - two * y, y - z]);
        }
    }

    #[test]
    fn states_of_one_colour_share_no_rate() {
        let pattern = JacobianPattern::of(&Chain).unwrap();
        assert_eq!(pattern.rows[4], [0, 1, 2]);
        assert_eq!(pattern.driven, [false, false, false, true, false, false]);
        for row in &pattern.rows {
            let mut seen: Vec<usize> = row.iter().map(|&state| pattern.colours[state]).collect();
            seen.sort_unstable();
            seen.dedup();
            assert_eq!(seen.len(), row.len());
        }
        assert_eq!(pattern.colour_count, 3);
    }
}
