//! Gain and zeros of a held and sampled plant, from its states.
//!
//! ```text
//! x(k+1) = Phi x(k) + G_1 u(k-1) + G_0 u(k),   y = C x + D u              G_1 only with a fraction of a sample of dead time
//! numerator:  N(z) = z^f P(z) det(z I - Phi),  f = 1 with that fraction, otherwise 0
//! ```
//!
//! Phi is block triangular, its blocks the poles one by one, so that P(z) is a substitution from
//! the last state to the first. All operations are done in twice the working precision, in which
//! poles at exp(-40) and at 0.99 together lose no digits. N is a polynomial: its values at roots of
//! -1 give its coefficients, which give the first guess of its zeros, and the response itself
//! brings the zeros to full accuracy. The result is compared with the response along the unit
//! circle, where it will be used; factors that do not agree are rejected.

mod modes;
mod numerator;

use nalgebra::DMatrix;
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

use super::double_double::{ComplexDoubleDouble, DoubleDouble};
use super::matrix_exponential::exponential;
use super::realization::Chain;
use super::wide::{Wide, WideColumn};
use super::{LinearError, LinearNumber};
pub use modes::{HeldFactors, HeldModes, HeldPoint};

/// Largest exponent for which the poles of a sampled plant stay in the range of numbers.
const GROWTH_MAXIMUM: f64 = 300.0;

/// A held and sampled plant with one input and one output, whose system matrix is block triangular.
pub(super) struct Held {
    /// The diagonal blocks of Phi, from the last to the first.
    diagonal: Vec<DiagonalBlock>,
    /// Entries of Phi above the blocks, column by column.
    above: Wide,
    /// G_0
    present: Vec<DoubleDouble>,
    /// G_1
    previous: Option<Vec<DoubleDouble>>,
    output: Vec<DoubleDouble>,
    feedthrough: f64,
}

/// Values z^f P(z), its derivative, and det(z I - Phi).
pub(super) struct Local {
    value: ComplexDoubleDouble,
    slope: ComplexDoubleDouble,
    determinant: ComplexDoubleDouble,
}

impl Held {
    /// Plant with a zero-order hold at its input and a dead time of a fraction of a sample.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`] for a plant that grows beyond the range of numbers within a
    /// sample.
    pub(super) fn new(
        plant: Chain,
        poles: &[Complex64],
        sample_time_s: f64,
        fraction_s: f64,
    ) -> Result<Held, LinearError> {
        let growth: f64 = poles.iter().map(|pole| (pole.re * sample_time_s).max(0.0)).sum();
        let unbounded = LinearError::NotFinite { what: LinearNumber::SampledPole };
        if growth.is_nan() || growth > GROWTH_MAXIMUM {
            return Err(unbounded);
        }
        let held = if fraction_s == 0.0 {
            let whole = HeldStep::new(&plant, sample_time_s);
            Held::assembled(plant, &whole.transition, whole.input, None)
        } else {
            let rest_s = sample_time_s - fraction_s;
            let late = HeldStep::new(&plant, rest_s);
            let other = (rest_s != fraction_s).then(|| HeldStep::new(&plant, fraction_s));
            let early = other.as_ref().unwrap_or(&late);
            let previous = late.transition.times_column(&early.input);
            let whole = late.transition.times(&early.transition);
            Held::assembled(plant, &whole, late.input, Some(previous))
        };
        held.filter(Held::is_finite).ok_or(unbounded)
    }

    /// Assembles the plant; `None` if an entry of Phi is not finite.
    fn assembled(
        plant: Chain,
        transition: &Wide,
        present: Vec<DoubleDouble>,
        previous: Option<Vec<DoubleDouble>>,
    ) -> Option<Held> {
        if !transition.is_finite() {
            return None;
        }
        let diagonal = diagonal_blocks(transition);
        let mut first = vec![0; transition.order()];
        for block in &diagonal {
            (first[block.first], first[block.last]) = (block.first, block.first);
        }
        let above = Wide::from_fn(transition.order(), |column, row| {
            if row < first[column] { transition.entry(row, column) } else { DoubleDouble::ZERO }
        });
        let (output, feedthrough) = (plant.taps, plant.feedthrough);
        Some(Held { diagonal, above, present, previous, output, feedthrough })
    }

    fn is_finite(&self) -> bool {
        let columns = self.present.iter().chain(self.previous.iter().flatten());
        columns.map(|entry| entry.value()).all(f64::is_finite)
    }

    fn order(&self) -> usize {
        self.present.len()
    }

    /// Largest degree of N(z).
    fn degree(&self) -> usize {
        if self.feedthrough == 0.0 && self.previous.is_none() {
            self.order().saturating_sub(1)
        } else {
            self.order()
        }
    }

    /// N at a point; `None` at a pole.
    pub(super) fn numerator(&self, z: ComplexDoubleDouble) -> Option<ComplexDoubleDouble> {
        let local = Arch::new().dispatch(VectorizedResponse { held: self, z, with_slope: false })?;
        Some(local.value * local.determinant)
    }

    /// Values at a point; `None` at a pole.
    pub(super) fn at(&self, z: ComplexDoubleDouble) -> Option<Local> {
        Arch::new().dispatch(VectorizedResponse { held: self, z, with_slope: true })
    }

    /// Input vector b(z).
    #[inline(always)]
    fn driven(&self, z: ComplexDoubleDouble) -> WideColumn {
        let mut driven = WideColumn::zero(self.order());
        for (index, &now) in self.present.iter().enumerate() {
            let entry = match &self.previous {
                None => now.into(),
                Some(previous) => z.times_wide(now) + previous[index].into(),
            };
            driven.set(index, entry);
        }
        driven
    }

    /// Output C x.
    #[inline(always)]
    fn read(&self, states: &WideColumn, start: f64) -> ComplexDoubleDouble {
        let mut sum = ComplexDoubleDouble::from(start);
        for (index, &factor) in self.output.iter().enumerate() {
            sum = sum + states.get(index).times_wide(factor);
        }
        sum
    }

    /// Solves (z I - Phi) x = b in place, from the last state to the first.
    #[inline(always)]
    fn substitute(&self, blocks: &[InvertedBlock], states: &mut WideColumn) {
        for (block, inverted) in self.diagonal.iter().zip(blocks) {
            let (upper, lower) = (states.get(block.first), states.get(block.last));
            if block.first == block.last {
                states.set(block.last, upper * inverted.inverse);
            } else {
                let [first, last] = inverted.diagonal;
                let [right, below] = block.coupling;
                states.set(block.first, (last * upper + lower.times_wide(right)) * inverted.inverse);
                states.set(block.last, (first * lower + upper.times_wide(below)) * inverted.inverse);
            }
            for column in block.first..=block.last {
                states.add_product(states.get(column), self.above.row(column), block.first);
            }
        }
    }
}

/// Real pole or pair of poles in Phi.
struct DiagonalBlock {
    first: usize,
    last: usize,
    diagonal: [DoubleDouble; 2],
    /// Entries above and below the diagonal.
    coupling: [DoubleDouble; 2],
}

fn diagonal_blocks(transition: &Wide) -> Vec<DiagonalBlock> {
    let entry = |i: usize, j: usize| transition.entry(i, j);
    let mut blocks = Vec::with_capacity(transition.order());
    let mut end = transition.order();
    while end > 0 {
        let last = end - 1;
        let paired = last > 0 && entry(last, last - 1).high != 0.0;
        let first = if paired { last - 1 } else { last };
        let coupling =
            if paired { [entry(first, last), entry(last, first)] } else { [DoubleDouble::ZERO; 2] };
        blocks.push(DiagonalBlock {
            first,
            last,
            diagonal: [entry(first, first), entry(last, last)],
            coupling,
        });
        end = first;
    }
    blocks
}

/// Inverted diagonal block of z I - Phi.
struct InvertedBlock {
    diagonal: [ComplexDoubleDouble; 2],
    determinant: ComplexDoubleDouble,
    inverse: ComplexDoubleDouble,
}

impl DiagonalBlock {
    /// Inverse of the block within z I - Phi; `None` if it is singular.
    #[inline(always)]
    fn inverted(&self, z: ComplexDoubleDouble) -> Option<InvertedBlock> {
        let diagonal = self.diagonal.map(|entry| z - entry.into());
        let determinant = if self.first == self.last {
            diagonal[0]
        } else {
            diagonal[0] * diagonal[1] - (self.coupling[0] * self.coupling[1]).into()
        };
        let singular = determinant.value() == Complex64::new(0.0, 0.0);
        let inverse = ComplexDoubleDouble::from(1.0).divided_by(determinant);
        (!singular).then_some(InvertedBlock { diagonal, determinant, inverse })
    }
}

/// Response of a plant at a point, with the vector instructions of the processor; its slope is zero
/// unless requested.
struct VectorizedResponse<'a> {
    held: &'a Held,
    z: ComplexDoubleDouble,
    with_slope: bool,
}

impl WithSimd for VectorizedResponse<'_> {
    type Output = Option<Local>;

    #[inline(always)]
    fn with_simd<D: Simd>(self, _: D) -> Option<Local> {
        let VectorizedResponse { held, z, with_slope } = self;
        let mut blocks = Vec::with_capacity(held.diagonal.len());
        let mut determinant = ComplexDoubleDouble::from(1.0);
        for block in &held.diagonal {
            let inverted = block.inverted(z)?;
            determinant = determinant * inverted.determinant;
            blocks.push(inverted);
        }
        let mut states = held.driven(z);
        held.substitute(&blocks, &mut states);
        let value = held.read(&states, held.feedthrough);
        if !with_slope {
            return Some(Local { value, slope: ComplexDoubleDouble::default(), determinant });
        }
        // (z I - Phi) x = b(z), so (z I - Phi) x' = b'(z) - x
        for (index, &now) in held.present.iter().enumerate() {
            let own = if held.previous.is_some() { now } else { DoubleDouble::ZERO };
            states.set(index, ComplexDoubleDouble::from(own) - states.get(index));
        }
        held.substitute(&blocks, &mut states);
        Some(Local { value, slope: held.read(&states, 0.0), determinant })
    }
}

/// Step matrices: exp(A h), and the effect of a constant input over h.
struct HeldStep {
    transition: Wide,
    input: Vec<DoubleDouble>,
}

impl HeldStep {
    fn new(plant: &Chain, time: f64) -> HeldStep {
        let order = plant.taps.len();
        let mut augmented = DMatrix::zeros(order + 1, order + 1);
        augmented.view_mut((0, 0), (order, order)).copy_from(&plant.a);
        augmented.view_mut((0, order), (order, 1)).copy_from(&plant.b);
        let result = exponential(&augmented, time);
        HeldStep {
            transition: Wide::from_fn(order, |i, j| result.entry(i, j)),
            input: (0..order).map(|i| result.entry(i, order)).collect(),
        }
    }
}
