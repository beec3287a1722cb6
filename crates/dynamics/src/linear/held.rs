//! Gain and zeros of a plant that is held and sampled, read off its states.
//!
//! ```text
//! x(k+1) = Phi x(k) + G_1 u(k-1) + G_0 u(k),   y = C x + D u              G_1 only with a fraction of a sample of dead time
//! numerator:  N(z) = z^f P(z) det(z I - Phi),  f = 1 with that fraction, else 0
//! ```
//!
//! Phi is block triangular, its blocks the poles one by one, so that P(z) is a substitution from the last state to the first. All of it is
//! done in twice the working precision, in which a pole of exp(-40) beside one of 0.99 loses nothing. N is a polynomial: its values at
//! roots of -1 give its coefficients, these the first guess of its zeros, and the response itself brings the zeros to full accuracy.
//! What comes out is compared with the response along the unit circle, where it will be used; factors that miss it are refused.

mod numerator;

use nalgebra::DMatrix;
use num_complex::Complex64;

use super::LinearError;
use super::double_double::{ComplexDoubleDouble, DoubleDouble};
use super::matrix_exponential::{Wide, exponential};
use super::realization::Chain;

/// Beyond exp of this the poles of a sampled plant leave the range of numbers.
const GROWTH_MAXIMUM: f64 = 300.0;

/// A held and sampled plant with one input and one output, whose system matrix is block triangular.
pub(super) struct Held {
    transition: Wide,
    /// G_0
    present: Vec<DoubleDouble>,
    /// G_1
    previous: Option<Vec<DoubleDouble>>,
    output: Vec<DoubleDouble>,
    feedthrough: f64,
}

/// z^f P(z), its derivative, and det(z I - Phi).
pub(super) struct Local {
    value: ComplexDoubleDouble,
    slope: ComplexDoubleDouble,
    determinant: ComplexDoubleDouble,
}

impl Held {
    /// The plant behind a hold, with a dead time of a fraction of a sample.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`] for a plant that grows beyond the range of numbers within a sample.
    pub(super) fn new(
        plant: Chain,
        poles: &[Complex64],
        sample_time_s: f64,
        fraction_s: f64,
    ) -> Result<Held, LinearError> {
        let growth: f64 = poles.iter().map(|pole| (pole.re * sample_time_s).max(0.0)).sum();
        let unbounded = LinearError::NotFinite { what: "a pole of the sampled plant" };
        if growth.is_nan() || growth > GROWTH_MAXIMUM {
            return Err(unbounded);
        }
        let whole = Step::new(&plant, sample_time_s);
        let held = if fraction_s == 0.0 {
            Held::assembled(plant, whole.transition, whole.input, None)
        } else {
            let early = Step::new(&plant, fraction_s);
            let late = Step::new(&plant, sample_time_s - fraction_s);
            let previous = late.transition.times_column(&early.input);
            Held::assembled(plant, whole.transition, late.input, Some(previous))
        };
        if held.is_finite() { Ok(held) } else { Err(unbounded) }
    }

    fn assembled(
        plant: Chain,
        transition: Wide,
        present: Vec<DoubleDouble>,
        previous: Option<Vec<DoubleDouble>>,
    ) -> Held {
        Held { transition, present, previous, output: plant.taps, feedthrough: plant.feedthrough }
    }

    fn is_finite(&self) -> bool {
        let columns = self.present.iter().chain(self.previous.iter().flatten());
        self.transition.is_finite() && columns.map(|entry| entry.value()).all(f64::is_finite)
    }

    fn order(&self) -> usize {
        self.present.len()
    }

    /// Degree that N(z) can have.
    fn degree(&self) -> usize {
        if self.feedthrough == 0.0 && self.previous.is_none() {
            self.order().saturating_sub(1)
        } else {
            self.order()
        }
    }

    /// `None` at a pole.
    pub(super) fn at(&self, z: ComplexDoubleDouble) -> Option<Local> {
        let zero = ComplexDoubleDouble::default();
        let blocks = self.solved(z)?;
        let driven: Vec<ComplexDoubleDouble> = match &self.previous {
            None => self.present.iter().map(|&entry| entry.into()).collect(),
            Some(previous) => {
                let pairs = self.present.iter().zip(previous);
                pairs.map(|(&now, &before)| z.times_wide(now) + before.into()).collect()
            }
        };
        let states = self.substituted(&blocks, &driven);
        // (z I - Phi) x = b(z), so (z I - Phi) x' = b'(z) - x
        let changes: Vec<ComplexDoubleDouble> = states
            .iter()
            .zip(&self.present)
            .map(|(&state, &now)| {
                let own = if self.previous.is_some() { ComplexDoubleDouble::from(now) } else { zero };
                own - state
            })
            .collect();
        let slopes = self.substituted(&blocks, &changes);
        let read = |states: &[ComplexDoubleDouble], start: f64| {
            let start = ComplexDoubleDouble::from(start);
            states.iter().zip(&self.output).fold(start, |sum, (&x, &c)| sum + x.times_wide(c))
        };
        let determinant =
            blocks.iter().fold(ComplexDoubleDouble::from(1.0), |product, block| product * block.determinant);
        Some(Local { value: read(&states, self.feedthrough), slope: read(&slopes, 0.0), determinant })
    }

    /// The diagonal blocks of z I - Phi from the last to the first, inverted; `None` where one of them is singular.
    fn solved(&self, z: ComplexDoubleDouble) -> Option<Vec<Block>> {
        let entry = |i: usize, j: usize| self.transition.entry(i, j);
        let mut blocks = Vec::with_capacity(self.order());
        let mut end = self.order();
        while end > 0 {
            let last = end - 1;
            let paired = last > 0 && entry(last, last - 1).high != 0.0;
            let first = if paired { last - 1 } else { last };
            let diagonal = [z - entry(first, first).into(), z - entry(last, last).into()];
            let coupling = if paired {
                [entry(first, last), entry(last, first)]
            } else {
                [DoubleDouble::ZERO, DoubleDouble::ZERO]
            };
            let determinant = if paired {
                diagonal[0] * diagonal[1] - (coupling[0] * coupling[1]).into()
            } else {
                diagonal[0]
            };
            if determinant.value() == Complex64::new(0.0, 0.0) {
                return None;
            }
            let inverse = ComplexDoubleDouble::from(1.0).divided_by(determinant);
            blocks.push(Block { first, last, diagonal, coupling, determinant, inverse });
            end = first;
        }
        Some(blocks)
    }

    /// (z I - Phi)^-1 b, from the last state to the first.
    fn substituted(&self, blocks: &[Block], right: &[ComplexDoubleDouble]) -> Vec<ComplexDoubleDouble> {
        let mut states = right.to_vec();
        for block in blocks {
            let rest = |row: usize, states: &[ComplexDoubleDouble]| {
                let later = block.last + 1..self.order();
                later.fold(states[row], |sum, column| {
                    let factor = self.transition.entry(row, column);
                    if factor.high == 0.0 { sum } else { sum + states[column].times_wide(factor) }
                })
            };
            let (upper, lower) = (rest(block.first, &states), rest(block.last, &states));
            if block.first == block.last {
                states[block.last] = upper * block.inverse;
            } else {
                let [first, last] = block.diagonal;
                let [right, below] = block.coupling;
                states[block.first] = (last * upper + lower.times_wide(right)) * block.inverse;
                states[block.last] = (first * lower + upper.times_wide(below)) * block.inverse;
            }
        }
        states
    }
}

/// A pole or a pair of them in z I - Phi.
struct Block {
    first: usize,
    last: usize,
    diagonal: [ComplexDoubleDouble; 2],
    /// Entries of Phi above and below the diagonal.
    coupling: [DoubleDouble; 2],
    determinant: ComplexDoubleDouble,
    inverse: ComplexDoubleDouble,
}

/// exp(A h), and the effect of a constant input over h.
struct Step {
    transition: Wide,
    input: Vec<DoubleDouble>,
}

impl Step {
    fn new(plant: &Chain, time: f64) -> Step {
        let order = plant.taps.len();
        let mut augmented = DMatrix::zeros(order + 1, order + 1);
        augmented.view_mut((0, 0), (order, order)).copy_from(&plant.a);
        augmented.view_mut((0, order), (order, 1)).copy_from(&plant.b);
        let result = exponential(&augmented, time);
        Step {
            transition: Wide::from_fn(order, |i, j| result.entry(i, j)),
            input: (0..order).map(|i| result.entry(i, order)).collect(),
        }
    }
}
