//! Polynomials in the variables of a box, and polynomials in s that have them as coefficients.

use std::f64::consts::PI;

use phea_dynamics::expression::{Binary, Expression, Node, Unary};
use phea_dynamics::portable;
use phea_dynamics::scalar::{Interval, Scalar};

use super::dead_time::enclosed_cosine_and_sine;

/// A number of a certificate: it represents the decimal number that it prints as, to which the
/// binary number is nearest.
pub(crate) trait Decimal: Scalar + PartialEq {
    /// An enclosure of the decimal number that this number prints as.
    fn decimal(value: f64) -> Self;
    /// Enclosures of the cosine and the sine of every angle in this enclosure, rad.
    fn cosine_and_sine(angle: Self) -> [Self; 2];
    /// An enclosure of every number of at most this magnitude; zero if rounding is not tracked.
    fn uncertain(magnitude: f64) -> Self;
    /// An enclosure of pi.
    fn pi() -> Self;
    /// An enclosure of both numbers and all those between them; the other number if rounding is not
    /// tracked.
    fn up_to(self, other: Self) -> Self;
    /// A number in the middle of this enclosure.
    fn middle(self) -> f64;
    /// An upper bound of this enclosure.
    fn most(self) -> f64;
    /// A lower bound of this enclosure.
    fn least(self) -> f64;
}

impl Decimal for f64 {
    fn decimal(value: f64) -> f64 {
        value
    }

    fn cosine_and_sine(angle: f64) -> [f64; 2] {
        [portable::cos(angle), portable::sin(angle)]
    }

    fn uncertain(_magnitude: f64) -> f64 {
        0.0
    }

    fn pi() -> f64 {
        PI
    }

    fn up_to(self, other: f64) -> f64 {
        other
    }

    fn middle(self) -> f64 {
        self
    }

    fn most(self) -> f64 {
        self
    }

    fn least(self) -> f64 {
        self
    }
}

impl Decimal for Interval {
    /// Interval up to both neighbours: a decimal that reads as this number is nearer to it than to
    /// them; zero is exact.
    fn decimal(value: f64) -> Interval {
        if value == 0.0 { Interval::from(0.0) } else { Interval::new(value.next_down(), value.next_up()) }
    }

    fn cosine_and_sine(angle: Interval) -> [Interval; 2] {
        enclosed_cosine_and_sine(angle)
    }

    fn uncertain(magnitude: f64) -> Interval {
        Interval::new(-magnitude, magnitude)
    }

    /// The double nearest to pi is less than pi.
    fn pi() -> Interval {
        Interval::new(PI, PI.next_up())
    }

    fn up_to(self, other: Interval) -> Interval {
        Interval::new(self.low().min(other.low()), self.high().max(other.high()))
    }

    fn middle(self) -> f64 {
        0.5 * (self.low() + self.high())
    }

    fn most(self) -> f64 {
        self.high()
    }

    fn least(self) -> f64 {
        self.low()
    }
}

/// Largest number of variables of a box.
pub(crate) const VARIABLES_MAXIMUM: usize = 12;
/// The greatest exponent of a variable in a coefficient of a plant: the exponents of a product of
/// two such polynomials fit in a byte.
const EXPONENT_MAXIMUM: u8 = 60;

/// Largest number of products of terms: the result counts as unbounded beyond it.
const PRODUCTS_MAXIMUM: usize = 1 << 20;

/// Exponents of the variables.
type VariablePowers = [u8; VARIABLES_MAXIMUM];

/// A polynomial in the variables of a box: exponents in increasing order, each with its
/// coefficient. The function that it represents differs from it by a remainder of at most `rest`,
/// with the variables in [0, 1] or in [-1, 1].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BoxPolynomial<S> {
    terms: Vec<(VariablePowers, S)>,
    rest: S,
}

impl<S: Decimal> BoxPolynomial<S> {
    /// A number.
    pub(crate) fn constant(value: S) -> BoxPolynomial<S> {
        BoxPolynomial { terms: vec![([0; VARIABLES_MAXIMUM], value)], rest: S::from(0.0) }
    }

    /// A decimal number; zero has no term.
    pub(crate) fn number(value: f64) -> BoxPolynomial<S> {
        if value == 0.0 { BoxPolynomial::zero() } else { BoxPolynomial::constant(S::decimal(value)) }
    }

    /// Zero: no terms.
    pub(crate) fn zero() -> BoxPolynomial<S> {
        BoxPolynomial { terms: vec![], rest: S::from(0.0) }
    }

    /// `low + (high - low) t`, where t is the variable with this index; `low` if there is none.
    pub(crate) fn between(low: f64, high: f64, variable: Option<usize>) -> BoxPolynomial<S> {
        let mut out = BoxPolynomial::constant(S::decimal(low));
        let mut exponents = [0; VARIABLES_MAXIMUM];
        if let Some(slot) = variable.and_then(|variable| exponents.get_mut(variable)) {
            *slot = 1;
            out.terms.push((exponents, S::decimal(high) - S::decimal(low)));
        }
        out
    }

    /// Terms: exponents and coefficients.
    pub(crate) fn terms(&self) -> impl Iterator<Item = (&[u8], S)> {
        self.terms.iter().map(|(exponents, coefficient)| (exponents.as_slice(), *coefficient))
    }

    /// Bound on the difference from the function that it represents.
    pub(crate) fn rest(&self) -> S {
        self.rest
    }

    /// The variable of a linear function of a single variable, and its zero in t; `None` for any
    /// other polynomial, and without a zero.
    pub(super) fn root(&self) -> Option<(usize, S)> {
        let mut constant = S::from(0.0);
        let mut straight = None;
        for (exponents, value) in &self.terms {
            let moved: Vec<usize> = (0..exponents.len()).filter(|&one| exponents[one] > 0).collect();
            match moved[..] {
                [] => constant = *value,
                [variable] if exponents[variable] == 1 && straight.is_none() => {
                    straight = Some((variable, *value));
                }
                _ => return None,
            }
        }
        let (variable, slope) = straight?;
        Some((variable, (S::from(1.0) - constant / slope).times(0.5)))
    }

    /// Copy of this polynomial with an increased remainder.
    pub(super) fn with_rest(mut self, more: S) -> BoxPolynomial<S> {
        self.rest = self.rest + more;
        self
    }

    /// Bound on the magnitude, without the remainder.
    pub(super) fn size(&self) -> S {
        self.terms.iter().fold(S::from(0.0), |sum, (_, value)| sum + value.abs())
    }

    fn has_rest(&self) -> bool {
        self.rest.most() != 0.0
    }

    /// True if it has neither a term nor a remainder. A sum of intervals that may vanish is not
    /// zero.
    pub(crate) fn is_zero(&self) -> bool {
        self.terms.is_empty() && !self.has_rest()
    }

    /// Value, if it depends on no variable.
    pub(crate) fn as_constant(&self) -> Option<S> {
        match self.terms.as_slice() {
            _ if self.has_rest() => None,
            [] => Some(S::from(0.0)),
            [(exponents, value)] if exponents.iter().all(|exponent| *exponent == 0) => Some(*value),
            _ => None,
        }
    }

    pub(crate) fn scaled(&self, factor: S) -> BoxPolynomial<S> {
        let terms = self.terms.iter().map(|(exponents, coefficient)| (*exponents, *coefficient * factor));
        BoxPolynomial { terms: terms.collect(), rest: self.rest * factor.abs() }
    }

    pub(crate) fn plus(&self, other: &BoxPolynomial<S>) -> BoxPolynomial<S> {
        let terms = self.terms.iter().chain(&other.terms).copied().collect();
        BoxPolynomial::collected(terms, self.rest + other.rest)
    }

    pub(crate) fn times(&self, other: &BoxPolynomial<S>) -> BoxPolynomial<S> {
        if self.terms.len().saturating_mul(other.terms.len()) > PRODUCTS_MAXIMUM {
            return BoxPolynomial::constant(S::from(f64::NAN));
        }
        let products = self.terms.iter().flat_map(|(one, a)| {
            other.terms.iter().map(|(another, b)| {
                let mut exponents = *one;
                let mut fits = true;
                for (slot, exponent) in exponents.iter_mut().zip(another) {
                    fits &= slot.checked_add(*exponent).is_some();
                    *slot = slot.saturating_add(*exponent);
                }
                // a power beyond the largest cannot be stored: the sum is unknown
                let product = if fits { *a * *b } else { S::from(f64::NAN) };
                (exponents, product)
            })
        });
        let rest = match self.has_rest() || other.has_rest() {
            true => self.size() * other.rest + self.rest * other.size() + self.rest * other.rest,
            false => S::from(0.0),
        };
        BoxPolynomial::collected(products.collect(), rest)
    }

    /// Polynomial of terms in any order; those with equal exponents are added.
    fn collected(mut terms: Vec<(VariablePowers, S)>, rest: S) -> BoxPolynomial<S> {
        terms.sort_by_key(|(exponents, _)| *exponents);
        terms.dedup_by(|next, cache| {
            let same = next.0 == cache.0;
            if same {
                cache.1 = cache.1 + next.1;
            }
            same
        });
        BoxPolynomial { terms, rest }
    }

    /// Terms up to a total degree; a bound on the others is added to the remainder.
    pub(super) fn truncated(mut self, degree: usize) -> BoxPolynomial<S> {
        let is_satisfied = |exponents: &VariablePowers| {
            exponents.iter().map(|one| usize::from(*one)).sum::<usize>() <= degree
        };
        let beyond = self.terms.iter().filter(|(exponents, _)| !is_satisfied(exponents));
        self.rest = beyond.fold(self.rest, |sum, (_, value)| sum + value.abs());
        self.terms.retain(|(exponents, _)| is_satisfied(exponents));
        self
    }

    /// `middle + half x`, where x is the variable with this index.
    pub(super) fn about(middle: S, half: S, variable: usize) -> BoxPolynomial<S> {
        let mut out = BoxPolynomial::constant(middle);
        let mut exponents = [0; VARIABLES_MAXIMUM];
        if let Some(slot) = exponents.get_mut(variable) {
            *slot = 1;
            out.terms.push((exponents, half));
        }
        out
    }

    /// Substitution x = 2 t - 1 in place of every variable.
    pub(super) fn with_fractions(&self) -> BoxPolynomial<S> {
        let mut out = BoxPolynomial { terms: vec![], rest: self.rest };
        for (exponents, value) in &self.terms {
            let start = BoxPolynomial::constant(*value);
            let powers = exponents.iter().enumerate().flat_map(|(variable, power)| {
                std::iter::repeat_n(
                    BoxPolynomial::about(S::from(-1.0), S::from(2.0), variable),
                    usize::from(*power),
                )
            });
            out = out.plus(&powers.fold(start, |product, one| product.times(&one)));
        }
        out
    }

    /// Result: this polynomial, or `None` if an exponent is greater than this.
    pub(crate) fn up_to(self, greatest: u8) -> Option<BoxPolynomial<S>> {
        let fits = self.terms.iter().flat_map(|(exponents, _)| exponents).all(|one| *one <= greatest);
        fits.then_some(self)
    }
}

/// The results of an expression as polynomials in the variables of a box, with its parameters as
/// such polynomials; `None` if it uses operations other than sums, products and quotients by
/// numbers.
pub(crate) fn expanded<S: Decimal>(
    expression: &Expression,
    parameters: &[BoxPolynomial<S>],
) -> Option<Vec<BoxPolynomial<S>>> {
    let minus_one = S::from(-1.0);
    let mut values: Vec<Option<BoxPolynomial<S>>> = Vec::with_capacity(expression.nodes().len());
    for node in expression.nodes() {
        let of = |index: usize| values.get(index).and_then(Option::as_ref);
        let value = match *node {
            Node::Parameter(index) => parameters.get(index).cloned(),
            Node::Constant(value) => Some(BoxPolynomial::number(value)),
            Node::Unary(Unary::Negate, x) => of(x).map(|x| x.scaled(minus_one)),
            Node::Binary(Binary::Add, x, y) => of(x).zip(of(y)).map(|(x, y)| x.plus(y)),
            Node::Binary(Binary::Subtract, x, y) => {
                of(x).zip(of(y)).map(|(x, y)| x.plus(&y.scaled(minus_one)))
            }
            Node::Binary(Binary::Multiply, x, y) => {
                of(x).zip(of(y)).and_then(|(x, y)| x.times(y).up_to(EXPONENT_MAXIMUM))
            }
            Node::Binary(Binary::Divide, x, y) => of(x).zip(of(y)).and_then(|(x, y)| {
                let divisor = y.as_constant().filter(|own| own.least() > 0.0 || own.most() < 0.0)?;
                Some(x.scaled(S::from(1.0) / divisor))
            }),
            Node::Unary(..) | Node::Select(..) => None,
        };
        values.push(value);
    }
    expression.results().iter().map(|&index| values.get(index).cloned().flatten()).collect()
}

/// A polynomial in s, the lowest power first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct InS<S>(pub(crate) Vec<BoxPolynomial<S>>);

impl<S: Decimal> InS<S> {
    /// Polynomial with these numbers as coefficients, the highest power first.
    pub(crate) fn of_decimals(coefficients: &[f64]) -> InS<S> {
        InS(coefficients.iter().rev().map(|&value| BoxPolynomial::number(value)).collect())
    }

    pub(crate) fn plus(&self, other: &InS<S>) -> InS<S> {
        let (longer, shorter) = if self.0.len() < other.0.len() { (other, self) } else { (self, other) };
        let mut out = longer.clone();
        for (slot, term) in out.0.iter_mut().zip(&shorter.0) {
            *slot = slot.plus(term);
        }
        out
    }

    pub(crate) fn scaled(&self, factor: S) -> InS<S> {
        InS(self.0.iter().map(|coefficient| coefficient.scaled(factor)).collect())
    }

    pub(crate) fn times(&self, other: &InS<S>) -> InS<S> {
        let mut out = vec![BoxPolynomial::zero(); (self.0.len() + other.0.len()).saturating_sub(1)];
        for (index, a) in self.0.iter().enumerate() {
            for (slot, b) in out.iter_mut().skip(index).zip(&other.0) {
                *slot = slot.plus(&a.times(b));
            }
        }
        InS(out)
    }

    /// Degree; `None` if all coefficients are zero.
    pub(crate) fn degree(&self) -> Option<usize> {
        self.0.iter().rposition(|coefficient| !coefficient.is_zero())
    }

    /// Number of times that s divides it.
    pub(crate) fn powers_of_s(&self) -> Option<usize> {
        self.0.iter().position(|coefficient| !coefficient.is_zero())
    }

    /// The quotient by this power of s, which must divide it.
    pub(crate) fn without_powers_of_s(&self, count: usize) -> InS<S> {
        InS(self.0.iter().skip(count).cloned().collect())
    }
}
