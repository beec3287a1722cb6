//! Zeros of one channel of a state-space system.
//!
//! ```text
//! zeros: the s where the pencil  [ s I - A   -B ]  loses rank
//!                                [   C        D ]
//! ```
//!
//! Without feedthrough, the output y = C x = 0 ties one state to the others; that state is eliminated, and what drives
//! it becomes the new feedthrough, until one is not zero (Emami-Naeini and Van Dooren 1982, for one input and output,
//! with elimination in place of reflections so that structural zeros stay exact). Then the zeros are eigenvalues of
//! A - B C/D. Whether a number is zero is judged against the running sum of the magnitudes it was computed from, which
//! no change of units affects.

use nalgebra::{DMatrix, DVector, RowDVector};
use num_complex::Complex64;

use super::eigenvalues::{eigenvalues_of_computed, index_of_smallest};
use super::refinement::{refine, symmetrise};
use super::structure::Resolvent;
use super::{LinearError, StateSpace};
use crate::portable::magnitude;

/// A number with the sum of the magnitudes that went into it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Traced {
    value: f64,
    scale: f64,
}

impl Traced {
    fn of(value: f64) -> Self {
        Traced { value, scale: value.abs() }
    }

    /// self + factor * other
    fn plus(self, factor: Traced, other: Traced) -> Self {
        Traced {
            value: self.value + factor.value * other.value,
            scale: self.scale + factor.scale * other.scale,
        }
    }

    fn is_zero(self) -> bool {
        self.value.abs() <= 64.0 * f64::EPSILON * self.scale
    }
}

/// Gain (leading coefficient) and zeros of a system with one input and one output, whose poles are known.
pub(crate) fn of_channel(
    system: &StateSpace,
    poles: &[Complex64],
) -> Result<(f64, Vec<Complex64>), LinearError> {
    let (gain, reduced) = reduce(system);
    let Some(matrix) = reduced else { return Ok((0.0, Vec::new())) };
    let mut zeros = eigenvalues_of_computed(&matrix)?;
    let resolvent = Resolvent::of(system.a());
    if vanishes_at_origin(system, &resolvent)
        && let Some(smallest) = index_of_smallest(&zeros)
    {
        zeros[smallest] = Complex64::new(0.0, 0.0);
    }
    refine(&mut zeros, 6, |s| newton_step(system, &resolvent, poles, s));
    Ok((gain, symmetrise(&zeros)))
}

/// The leading coefficient, and the matrix whose eigenvalues are the zeros; none when the channel is zero everywhere.
fn reduce(system: &StateSpace) -> (f64, Option<DMatrix<f64>>) {
    let mut balanced = system.a().clone();
    let units = nalgebra::linalg::balancing::balance_parlett_reinsch(&mut balanced);
    let mut a = balanced.map(Traced::of);
    let mut b = DVector::from_fn(system.order(), |i, _| Traced::of(system.b()[(i, 0)] / units[i]));
    let mut c = RowDVector::from_fn(system.order(), |_, j| Traced::of(system.c()[(0, j)] * units[j]));
    let mut d = Traced::of(system.d()[(0, 0)]);
    let mut gain = 1.0;
    while d.is_zero() {
        let present = (0..a.nrows()).filter(|&j| !c[j].is_zero());
        let pivot = present.max_by(|&i, &j| c[i].value.abs().total_cmp(&c[j].value.abs()));
        let Some(pivot) = pivot else { return (0.0, None) };
        gain *= c[pivot].value;
        (a, b, c, d) = eliminate(&a, &b, &c, pivot);
    }
    let order = a.nrows();
    let closed = |i: usize, j: usize| a[(i, j)].value - b[i].value * (c[j].value / d.value);
    (gain * d.value, Some(DMatrix::from_fn(order, order, closed)))
}

type System = (DMatrix<Traced>, DVector<Traced>, RowDVector<Traced>, Traced);

/// Ties state k by C x = 0. With y' = c_k (x_k + sum m_j x_j) as a new state, m_j = c_j/c_k, the others obey
/// x_i' = sum (a_ij - a_ik m_j) x_j + b_i u, and y'/c_k is driven by the new output row and feedthrough.
fn eliminate(a: &DMatrix<Traced>, b: &DVector<Traced>, c: &RowDVector<Traced>, k: usize) -> System {
    let order = a.nrows();
    let kept: Vec<usize> = (0..order).filter(|&i| i != k).collect();
    let ratio = |j: usize| Traced { value: c[j].value / c[k].value, scale: c[j].scale / c[k].value.abs() };
    let minus = |x: Traced| Traced { value: -x.value, scale: x.scale };
    let tied = |i: usize, j: usize| a[(i, j)].plus(minus(ratio(j)), a[(i, k)]);
    let reduced = DMatrix::from_fn(order - 1, order - 1, |i, j| tied(kept[i], kept[j]));
    let inputs = DVector::from_fn(order - 1, |i, _| b[kept[i]]);
    // d(x_k + sum m_i x_i)/dt
    let row = RowDVector::from_fn(order - 1, |_, j| {
        kept.iter().fold(tied(k, kept[j]), |sum, &i| sum.plus(ratio(i), tied(i, kept[j])))
    });
    let feedthrough = kept.iter().fold(b[k], |sum, &i| sum.plus(ratio(i), b[i]));
    (reduced, inputs, row, feedthrough)
}

/// Whether the response at s = 0 is no more than the rounding of its parts.
fn vanishes_at_origin(system: &StateSpace, resolvent: &Resolvent<'_>) -> bool {
    let inputs = system.b().map(|entry| Complex64::new(entry, 0.0));
    let Some(states) = resolvent.solve(Complex64::new(0.0, 0.0), &inputs) else { return false };
    let parts = (0..system.order()).map(|j| system.c()[(0, j)] * states[(j, 0)].re);
    let feedthrough = system.d()[(0, 0)];
    let (sum, size) =
        parts.fold((feedthrough, feedthrough.abs()), |(sum, size), part| (sum + part, size + part.abs()));
    sum.abs() <= 16.0 * f64::EPSILON * size
}

/// f/f' for the numerator f = g(s) prod (s - p) of the response g; nothing at a pole that cancels.
fn newton_step(
    system: &StateSpace,
    resolvent: &Resolvent<'_>,
    poles: &[Complex64],
    s: Complex64,
) -> Option<Complex64> {
    if poles.iter().any(|pole| magnitude(pole - s) <= 1e-6 * magnitude(s)) {
        return None;
    }
    let complex = |matrix: &DMatrix<f64>| matrix.map(|entry| Complex64::new(entry, 0.0));
    let output = complex(system.c());
    let states = resolvent.solve(s, &complex(system.b()))?;
    let slopes = resolvent.solve(s, &states)?;
    let response = (&output * &states)[(0, 0)] + system.d()[(0, 0)];
    let slope = -(&output * &slopes)[(0, 0)];
    if response == Complex64::new(0.0, 0.0) {
        return Some(response);
    }
    let poles: Complex64 = poles.iter().map(|pole| (s - pole).inv()).sum();
    let step = (slope / response + poles).inv();
    step.is_finite().then_some(step)
}
