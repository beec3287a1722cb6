//! Coefficients that are not polynomials in the variables of a box: a polynomial with a remainder
//! for each operation, by Taylor expansion.
//!
//! ```text
//! t = (x + 1)/2,  x in [-1, 1],    y = c + u,  |u| <= rho,    f(y) = sum over k <= d of f_k u^k + r,    |r| <= rho^(d+1) greatest |f_(d+1)|
//!
//! 1/y       f_k = (-1)^k c^-(k+1)                      greatest: least |y|^-(d+2)
//! root y    f_k = C(1/2, k) c^(1/2 - k)                          |C(1/2, d+1)| least^(1/2 - d - 1)
//! exp y     f_k = e^c/k!                                         e^greatest/(d+1)!
//! ln y      f_0 = ln c, f_k = (-1)^(k-1)/(k c^k)                 1/((d+1) least^(d+1))
//! ```
//!
//! c is the coefficient without a variable; least and greatest refer to y, which is between c - rho
//! and c + rho. Terms of a product whose total degree exceeds d are added to its remainder.

use phea_dynamics::expression::{Binary, Expression, Node, Unary};

use super::certificate::Certificate;
use super::polynomial::{BoxPolynomial, Decimal};

/// The parameters over a whole box, as polynomials in t, or in x if coefficients are modelled;
/// `None` if there is no such box.
pub(super) fn parameters_over<S: Decimal>(
    certificate: &Certificate,
    of_box: usize,
) -> Option<Vec<BoxPolynomial<S>>> {
    let segments = certificate.plant.boxes.get(of_box)?.iter();
    let degree = certificate.plant.model_degree;
    let values = segments.map(|one| match (degree, one.variable) {
        (0, variable) => Some(BoxPolynomial::between(one.low, one.high, variable)),
        (_, None) => Some(BoxPolynomial::number(one.low)),
        (_, Some(variable)) => {
            let [low, high] = [one.low, one.high].map(S::decimal);
            match one.by_factors {
                true => by_factors([low, high], variable, degree),
                false => {
                    let (middle, half) = ((low + high).times(0.5), (high - low).times(0.5));
                    Some(BoxPolynomial::about(middle, half, variable))
                }
            }
        }
    });
    values.collect()
}

/// The results of an expression as polynomials in t of at most this degree with remainders, with
/// the parameters as such polynomials in x; `None` if an operation is not defined on the whole box.
pub(super) fn modelled<S: Decimal>(
    expression: &Expression,
    parameters: &[BoxPolynomial<S>],
    degree: usize,
) -> Option<Vec<BoxPolynomial<S>>> {
    let values = Model { degree }.values(expression, parameters);
    let results = expression.results().iter().map(|&index| values.get(index)?.as_ref());
    results.map(|value| Some(value?.with_fractions())).collect()
}

/// Switching point of a choice that depends on a single variable: this variable and its value t in
/// (0, 1), for the first choice that is not decided on the box and whose condition is linear in the
/// variable.
pub(super) fn turn(
    expression: &Expression,
    parameters: &[BoxPolynomial<f64>],
    degree: usize,
) -> Option<(usize, f64)> {
    let model = Model { degree };
    let values = model.values(expression, parameters);
    let of = |index: usize| values.get(index)?.as_ref();
    expression.nodes().iter().find_map(|node| {
        let Node::Select(y, z, ..) = *node else { return None };
        let (variable, fraction) = difference(of(y)?, of(z)?).root()?;
        (NO_EDGE..=1.0 - NO_EDGE).contains(&fraction).then_some((variable, fraction))
    })
}

/// Distance from the end of a variable below which a switching point does not justify a separate
/// box.
const NO_EDGE: f64 = 1e-9;

/// Polynomial of a parameter that varies logarithmically from low to high with t: root(low high)
/// exp(x ln(high/low)/2).
pub(super) fn by_factors<S: Decimal>(
    [low, high]: [S; 2],
    variable: usize,
    degree: usize,
) -> Option<BoxPolynomial<S>> {
    let half = (high / low).ln().times(0.5);
    let model = Model { degree };
    let power = model.applied(&BoxPolynomial::about(S::from(0.0), half, variable), Function::Exponential)?;
    Some(power.scaled((low * high).sqrt()))
}

#[derive(Clone, Copy)]
enum Function {
    Inverse,
    Root,
    Exponential,
    Logarithm,
}

/// Degree of the polynomials.
struct Model {
    degree: usize,
}

/// An undecided choice of two polynomials: their mean, with half their difference added to the
/// remainder.
fn either<S: Decimal>(one: &BoxPolynomial<S>, other: &BoxPolynomial<S>) -> BoxPolynomial<S> {
    let apart = one.plus(&other.scaled(S::from(-1.0)));
    let half = (apart.size() + apart.rest()).times(0.5);
    one.plus(other).scaled(S::from(0.5)).with_rest(half)
}

fn difference<S: Decimal>(one: &BoxPolynomial<S>, other: &BoxPolynomial<S>) -> BoxPolynomial<S> {
    one.plus(&other.scaled(S::from(-1.0)))
}

/// The undecided greater, or lesser, of two polynomials: one of them or their mean, the one with
/// the smallest maximum deviation. `least` and `most` bound the first less the second.
fn extremum<S: Decimal>(
    [one, other]: [&BoxPolynomial<S>; 2],
    [least, most]: [S; 2],
    is_greater: bool,
) -> BoxPolynomial<S> {
    // maximum deviations of the first and the second polynomial
    let beyond = if is_greater { [-least, most] } else { [most, -least] };
    let mean = either(one, other);
    let taken = |of: &BoxPolynomial<S>, beyond: S| of.clone().with_rest(beyond);
    let [one, other] = [taken(one, beyond[0]), taken(other, beyond[1])];
    let all = [other, mean];
    all.into_iter().fold(one, |best, next| if next.rest().most() < best.rest().most() { next } else { best })
}

/// The range of a polynomial in x, including its remainder.
fn range<S: Decimal>(of: &BoxPolynomial<S>) -> [S; 2] {
    let (center, reach) = parted(of);
    [center - reach, center + reach]
}

/// The constant coefficient, and the greatest magnitude of the rest.
fn parted<S: Decimal>(of: &BoxPolynomial<S>) -> (S, S) {
    let zero = S::from(0.0);
    let (center, reach) =
        of.terms().fold((zero, zero), |(center, reach), (exponents, value)| {
            match exponents.iter().all(|exponent| *exponent == 0) {
                true => (center + value, reach),
                false => (center, reach + value.abs()),
            }
        });
    (center, reach + of.rest())
}

impl Model {
    /// Results of every operation; `None` for one not defined on the whole box, which a choice must
    /// not select.
    fn values<S: Decimal>(
        &self,
        expression: &Expression,
        parameters: &[BoxPolynomial<S>],
    ) -> Vec<Option<BoxPolynomial<S>>> {
        let mut values: Vec<Option<BoxPolynomial<S>>> = Vec::with_capacity(expression.nodes().len());
        for node in expression.nodes() {
            let value = self.value(*node, &values, parameters);
            values.push(value);
        }
        values
    }

    fn value<S: Decimal>(
        &self,
        node: Node,
        values: &[Option<BoxPolynomial<S>>],
        parameters: &[BoxPolynomial<S>],
    ) -> Option<BoxPolynomial<S>> {
        let of = |index: usize| values.get(index)?.as_ref();
        let minus = |of: &BoxPolynomial<S>| of.scaled(S::from(-1.0));
        match node {
            Node::Parameter(index) => parameters.get(index).cloned(),
            Node::Constant(value) => Some(BoxPolynomial::number(value)),
            Node::Unary(Unary::Negate, y) => Some(minus(of(y)?)),
            Node::Unary(Unary::SquareRoot, y) => self.applied(of(y)?, Function::Root),
            Node::Unary(Unary::Exponential, y) => self.applied(of(y)?, Function::Exponential),
            Node::Unary(Unary::Logarithm, y) => self.applied(of(y)?, Function::Logarithm),
            Node::Unary(Unary::Magnitude, y) => {
                let [least, most] = range(of(y)?);
                match (least.least() >= 0.0, most.most() <= 0.0) {
                    (true, _) => of(y).cloned(),
                    (_, true) => Some(minus(of(y)?)),
                    // |y| is the greater of y and -y
                    _ => {
                        let apart = [least.times(2.0), most.times(2.0)];
                        Some(extremum([of(y)?, &minus(of(y)?)], apart, true))
                    }
                }
            }
            Node::Binary(Binary::Add, y, z) => Some(of(y)?.plus(of(z)?)),
            Node::Binary(Binary::Subtract, y, z) if y == z => of(y).map(|_| BoxPolynomial::zero()),
            Node::Binary(Binary::Subtract, y, z) => Some(of(y)?.plus(&minus(of(z)?))),
            Node::Binary(Binary::Multiply, y, z) => Some(self.product(of(y)?, of(z)?)),
            Node::Binary(Binary::Divide, y, z) => {
                Some(self.product(of(y)?, &self.applied(of(z)?, Function::Inverse)?))
            }
            Node::Select(y, z, if_less, otherwise) => {
                let [least, most] = range(&difference(of(y)?, of(z)?));
                match (most.most() < 0.0, least.least() >= 0.0) {
                    (true, _) => of(if_less).cloned(),
                    (_, true) => of(otherwise).cloned(),
                    _ if [if_less, otherwise] == [z, y] => {
                        Some(extremum([of(y)?, of(z)?], [least, most], true))
                    }
                    _ if [if_less, otherwise] == [y, z] => {
                        Some(extremum([of(y)?, of(z)?], [least, most], false))
                    }
                    _ => Some(either(of(if_less)?, of(otherwise)?)),
                }
            }
        }
    }

    fn product<S: Decimal>(&self, one: &BoxPolynomial<S>, other: &BoxPolynomial<S>) -> BoxPolynomial<S> {
        one.times(other).truncated(self.degree)
    }

    /// A function of a polynomial; `None` if it is not defined everywhere.
    fn applied<S: Decimal>(&self, to: &BoxPolynomial<S>, function: Function) -> Option<BoxPolynomial<S>> {
        let (center, reach) = parted(to);
        let [least, most] = [center - reach, center + reach];
        let is_defined = match function {
            Function::Inverse => least.least() > 0.0 || most.most() < 0.0,
            Function::Root | Function::Logarithm => least.least() > 0.0,
            Function::Exponential => most.most().is_finite(),
        };
        // the root of zero exists, but not its derivative
        if to.is_zero() && matches!(function, Function::Root) {
            return Some(BoxPolynomial::zero());
        }
        if !is_defined {
            return None;
        }
        if to.as_constant().is_some() {
            return Some(BoxPolynomial::constant(function.at(center)));
        }
        let beside = to.plus(&BoxPolynomial::constant(-center));
        let coefficients = function.coefficients(center, self.degree);
        let mut out = BoxPolynomial::zero();
        for &coefficient in coefficients.iter().rev() {
            out = self.product(&out, &beside).plus(&BoxPolynomial::constant(coefficient));
        }
        let power = (0..=self.degree).fold(S::from(1.0), |product, _| product * reach);
        Some(out.with_rest(power * function.beyond([least, most], self.degree + 1)))
    }
}

impl Function {
    fn at<S: Decimal>(self, value: S) -> S {
        match self {
            Function::Inverse => S::from(1.0) / value,
            Function::Root => value.sqrt(),
            Function::Exponential => value.exp(),
            Function::Logarithm => value.ln(),
        }
    }

    /// Coefficients f_0 to f_d.
    fn coefficients<S: Decimal>(self, center: S, degree: usize) -> Vec<S> {
        let mut term = self.at(center);
        let mut out = vec![term];
        for k in 1..=degree {
            let order = k as f64;
            term = match self {
                Function::Inverse => -(term / center),
                Function::Root => term / center * S::from(1.5 - order) / S::from(order),
                Function::Exponential => term / S::from(order),
                Function::Logarithm if k == 1 => S::from(1.0) / center,
                Function::Logarithm => -(term / center * S::from(order - 1.0) / S::from(order)),
            };
            out.push(term);
        }
        out
    }

    /// Upper bound of |f_k| for every centre between two numbers.
    fn beyond<S: Decimal>(self, [least, most]: [S; 2], order: usize) -> S {
        let nearest = if least.least() > 0.0 { least } else { -most };
        let power = |of: S| (0..order).fold(S::from(1.0), |product, _| product * of);
        match self {
            Function::Inverse => S::from(1.0) / (power(nearest) * nearest),
            Function::Root => {
                let fraction = (1..=order)
                    .fold(S::from(1.0), |known, k| known * S::from(1.5 - k as f64) / S::from(k as f64));
                fraction.abs() * nearest.sqrt() / power(nearest)
            }
            Function::Exponential => (1..=order).fold(most.exp(), |known, k| known / S::from(k as f64)),
            Function::Logarithm => S::from(1.0) / (power(nearest) * S::from(order as f64)),
        }
    }
}
