//! Control points: what two complex polynomials over a box and a panel of frequencies are spanned by, in the basis of Bernstein.
//!
//! ```text
//! U = sum over k of U_k B_k(t),     B_k >= 0,   sum over k of B_k = 1        t in [0, 1]^n
//! ```
//!
//! Every pair (U, V) on the box is a mean of the pairs (U_k, V_k), with the same weights for both.

use super::polynomial::{Decimal, InS};

/// Real and imaginary part of U, the same of V.
pub(crate) type Pair<S> = [S; 4];

/// A panel of frequencies, rad/s; it may end at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Pairs of coefficients over all axes, that of the frequency first, the last axis running fastest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Points<S> {
    degrees: Vec<usize>,
    values: Vec<Pair<S>>,
}

impl<S: Decimal> Points<S> {
    /// U and V as powers of the frequency and of the variables, s being j times the frequency.
    pub(crate) fn powers(u: &InS<S>, v: &InS<S>, variables: usize) -> Points<S> {
        let mut degrees = vec![0; variables + 1];
        degrees[0] = u.degree().max(v.degree()).unwrap_or(0);
        for (exponents, _) in [u, v].iter().flat_map(|one| &one.0).flat_map(|one| one.terms()) {
            for (degree, exponent) in degrees.iter_mut().skip(1).zip(exponents) {
                *degree = (*degree).max(usize::from(*exponent));
            }
        }
        let count = degrees.iter().map(|degree| degree + 1).product();
        let mut out = Points { degrees, values: vec![[S::from(0.0); 4]; count] };
        for (place, polynomial) in [u, v].into_iter().enumerate() {
            for (power, coefficient) in polynomial.0.iter().enumerate() {
                // j^0 = 1, j, -1, -j
                let (part, sign) = (power % 2, if power % 4 < 2 { 1.0 } else { -1.0 });
                for (exponents, value) in coefficient.terms() {
                    let index = out.index(power, exponents);
                    if let Some(slot) = out.values.get_mut(index) {
                        slot[2 * place + part] = value * S::from(sign);
                    }
                }
            }
        }
        out
    }

    fn index(&self, power: usize, exponents: &[u8]) -> usize {
        let others =
            (0..self.degrees.len() - 1).map(|axis| exponents.get(axis).copied().map_or(0, usize::from));
        let digits = std::iter::once(power).chain(others);
        digits.zip(&self.degrees).fold(0, |index, (digit, degree)| index * (degree + 1) + digit)
    }

    /// The control points over a panel and the whole box, of what [`Points::powers`] gave. Towards infinity both are divided by the same power
    /// of the frequency, and its inverse is the variable.
    pub(crate) fn over(mut self, range: Range) -> Points<S> {
        let one = S::from(1.0);
        if range.to.is_finite() {
            self.substitute(0, S::decimal(range.from), S::decimal(range.to));
        } else {
            self.reverse_frequency();
            self.substitute(0, S::from(0.0), one / S::decimal(range.from));
        }
        for axis in 0..self.degrees.len() {
            self.to_bernstein(axis);
        }
        self
    }

    /// Number of axes, that of the frequency included.
    pub(crate) fn axes(&self) -> usize {
        self.degrees.len()
    }

    pub(crate) fn degree(&self, axis: usize) -> usize {
        self.degrees[axis]
    }

    pub(crate) fn pairs(&self) -> &[Pair<S>] {
        &self.values
    }

    /// Distance in memory from one point of an axis to the next.
    pub(crate) fn stride(&self, axis: usize) -> usize {
        self.degrees.iter().skip(axis + 1).map(|degree| degree + 1).product()
    }

    /// Both halves of the box across an axis, by the rule of de Casteljau.
    pub(crate) fn halves(mut self, axis: usize) -> [Points<S>; 2] {
        let degree = self.degrees[axis];
        let half = S::from(0.5);
        let mut low = self.clone();
        for step in 1..=degree {
            self.for_lines(axis, |line, at| {
                for place in 0..=degree - step {
                    let (one, next) = (line[at(place)], line[at(place + 1)]);
                    line[at(place)] = [0, 1, 2, 3].map(|part| (one[part] + next[part]) * half);
                }
            });
            let stride = self.stride(axis);
            let block = stride * (degree + 1);
            for start in (0..self.values.len()).step_by(block) {
                let (to, from) = (start + step * stride, start);
                low.values[to..to + stride].copy_from_slice(&self.values[from..from + stride]);
            }
        }
        [low, self]
    }

    /// x -> low + (high - low) t in powers of the variable of an axis.
    fn substitute(&mut self, axis: usize, low: S, high: S) {
        let degree = self.degrees[axis];
        let width = high - low;
        self.for_lines(axis, |line, at| {
            // Horner's rule, the highest coefficients first: shifted, then scaled
            for step in 0..degree {
                for place in (step..degree).rev() {
                    let (here, next) = (line[at(place)], line[at(place + 1)]);
                    line[at(place)] = [0, 1, 2, 3].map(|part| here[part] + low * next[part]);
                }
            }
            let mut factor = S::from(1.0);
            for place in 1..=degree {
                factor = factor * width;
                line[at(place)] = line[at(place)].map(|part| part * factor);
            }
        });
    }

    fn reverse_frequency(&mut self) {
        let degree = self.degrees[0];
        self.for_lines(0, |line, at| {
            for place in 0..=degree / 2 {
                line.swap(at(place), at(degree - place));
            }
        });
    }

    /// b_k = sum over i <= k of C(k, i)/C(n, i) a_i: divided by C(n, i), then summed up n times.
    fn to_bernstein(&mut self, axis: usize) {
        let degree = self.degrees[axis];
        self.for_lines(axis, |line, at| {
            let mut binomial = 1.0;
            for place in 0..=degree {
                let share = S::from(1.0) / S::from(binomial);
                line[at(place)] = line[at(place)].map(|part| part * share);
                binomial = binomial * (degree - place) as f64 / (place + 1) as f64;
            }
            for step in 0..degree {
                for place in (step + 1..=degree).rev() {
                    let (before, here) = (line[at(place - 1)], line[at(place)]);
                    line[at(place)] = [0, 1, 2, 3].map(|part| here[part] + before[part]);
                }
            }
        });
    }

    /// Every line of points along an axis: the values, and where the point of a place stands.
    fn for_lines(&mut self, axis: usize, mut of_line: impl FnMut(&mut [Pair<S>], &dyn Fn(usize) -> usize)) {
        let stride = self.stride(axis);
        let block = stride * (self.degrees[axis] + 1);
        for start in (0..self.values.len()).step_by(block) {
            for offset in start..start + stride {
                of_line(&mut self.values, &|place| offset + place * stride);
            }
        }
    }
}
