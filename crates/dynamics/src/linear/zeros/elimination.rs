//! Elimination of the states that a zero output ties to the others, until the input acts on the
//! output directly.
//!
//! Emami-Naeini and Van Dooren (1982) for one input and output, with elimination in place of
//! reflections so that structural zeros stay exact. It runs in twice the working precision; a
//! number counts as zero if rounding the inputs could explain it, a criterion that does not depend
//! on units.

use nalgebra::{DMatrix, DVector, RowDVector};

use super::super::StateSpace;
use super::super::double_double::DoubleDouble;
use super::super::structure::balance;

/// Number in twice the working precision, with the change that rounding every input by one unit
/// could cause: `scale` times the working precision, to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Traced {
    value: DoubleDouble,
    scale: f64,
}

impl Traced {
    fn of(value: f64) -> Self {
        Traced { value: value.into(), scale: value.abs() }
    }

    fn size(self) -> f64 {
        self.value.abs().value()
    }

    /// Sum self + factor * other.
    fn plus(self, factor: Traced, other: Traced) -> Self {
        Traced {
            value: self.value + factor.value * other.value,
            scale: self.scale + factor.size() * other.scale + factor.scale * other.size(),
        }
    }

    fn over(self, divisor: Traced) -> Self {
        let value = self.value.divided_by_wide(divisor.value);
        let scale = (self.scale + value.abs().value() * divisor.scale) / divisor.size();
        Traced { value, scale }
    }

    fn negated(self) -> Self {
        Traced { value: -self.value, scale: self.scale }
    }

    /// True if roundings of the inputs by this many units explain the number.
    fn is_zero(self, roundings: f64) -> bool {
        self.size() <= roundings * f64::EPSILON * self.scale
    }
}

/// Leading coefficient, and the matrix whose eigenvalues are the zeros; `None` if the channel is
/// zero everywhere.
pub(super) fn reduce(system: &StateSpace, roundings: f64) -> (f64, Option<DMatrix<f64>>) {
    let mut balanced = system.a().clone();
    let units = balance(&mut balanced);
    let mut a = balanced.map(Traced::of);
    let mut b = DVector::from_fn(system.order(), |i, _| Traced::of(system.b()[(i, 0)] / units[i]));
    let mut c = RowDVector::from_fn(system.order(), |_, j| Traced::of(system.c()[(0, j)] * units[j]));
    let mut d = Traced::of(system.d()[(0, 0)]);
    let mut gain = DoubleDouble::from(1.0);
    while d.is_zero(roundings) {
        let present = (0..a.nrows()).filter(|&j| !c[j].is_zero(roundings));
        let pivot = present.max_by(|&i, &j| c[i].size().total_cmp(&c[j].size()));
        let Some(pivot) = pivot else { return (0.0, None) };
        gain = gain * c[pivot].value;
        (a, b, c, d) = eliminate(&a, &b, &c, pivot);
    }
    let order = a.nrows();
    let closed = |i: usize, j: usize| a[(i, j)].plus(b[i].negated(), c[j].over(d)).value.value();
    ((gain * d.value).value(), Some(DMatrix::from_fn(order, order, closed)))
}

type StateMatrices = (DMatrix<Traced>, DVector<Traced>, RowDVector<Traced>, Traced);

/// Ties state k by C x = 0, with the output as a new state. The others obey
///
/// ```text
/// dx_i/dt = sum over j of (a_ij - a_ik m_j) x_j + b_i u,     m_j = c_j/c_k
/// y = c_k (x_k + sum over j of m_j x_j)
/// ```
///
/// and the rate of y/c_k is the new output row and feedthrough.
fn eliminate(a: &DMatrix<Traced>, b: &DVector<Traced>, c: &RowDVector<Traced>, k: usize) -> StateMatrices {
    let order = a.nrows();
    let kept: Vec<usize> = (0..order).filter(|&i| i != k).collect();
    let ratio = |j: usize| c[j].over(c[k]);
    let tied = |i: usize, j: usize| a[(i, j)].plus(ratio(j).negated(), a[(i, k)]);
    let reduced = DMatrix::from_fn(order - 1, order - 1, |i, j| tied(kept[i], kept[j]));
    let inputs = DVector::from_fn(order - 1, |i, _| b[kept[i]]);
    // d(x_k + sum m_i x_i)/dt
    let row = RowDVector::from_fn(order - 1, |_, j| {
        kept.iter().fold(tied(k, kept[j]), |sum, &i| sum.plus(ratio(i), tied(i, kept[j])))
    });
    let feedthrough = kept.iter().fold(b[k], |sum, &i| sum.plus(ratio(i), b[i]));
    (reduced, inputs, row, feedthrough)
}
