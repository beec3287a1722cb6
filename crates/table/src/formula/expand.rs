//! Formula to polynomials.

use phea_dynamics::scalar::Scalar;

use super::parse::MAXIMUM_POWER;
use super::{Formula, FormulaError, FormulaNode, FormulaPart, Ratio};

pub(super) fn ratio<S: Scalar>(
    formula: &Formula,
    parameter: &dyn Fn(&str) -> Option<S>,
    objection: fn(&Ratio<S>) -> Option<&'static str>,
) -> Result<Ratio<S>, FormulaError> {
    let mut values: Vec<Ratio<S>> = Vec::with_capacity(formula.nodes.len());
    for node in &formula.nodes {
        let value = of_node(node, &values, parameter)?;
        let degree = value.numerator.len().max(value.denominator.len()) - 1;
        if degree > MAXIMUM_POWER {
            let message = format!("the power of the polynomial is above {MAXIMUM_POWER}");
            return Err(FormulaError::new(message, node.range.clone()));
        }
        if let Some(message) = objection(&value) {
            return Err(FormulaError::new(message, node.range.clone()));
        }
        values.push(value);
    }
    values.pop().ok_or_else(|| FormulaError::new("an empty formula", 0..formula.text.len()))
}

/// Reason why the coefficients are not plain numbers.
pub(super) fn not_finite(value: &Ratio<f64>) -> Option<&'static str> {
    let finite = value.numerator.iter().chain(&value.denominator).all(|c| c.is_finite());
    if finite { None } else { Some("a coefficient is too large, or divided by zero") }
}

/// Coefficients without leading zeros; one is kept.
pub(super) fn trimmed(coefficients: Vec<f64>) -> Vec<f64> {
    let zeros = coefficients.iter().take_while(|c| **c == 0.0).count();
    let kept = zeros.min(coefficients.len().saturating_sub(1));
    coefficients.into_iter().skip(kept).collect()
}

/// Value of a node whose operands are evaluated.
fn of_node<S: Scalar>(
    node: &FormulaNode,
    values: &[Ratio<S>],
    parameter: &dyn Fn(&str) -> Option<S>,
) -> Result<Ratio<S>, FormulaError> {
    let one = S::from(1.0);
    Ok(match &node.part {
        FormulaPart::Number(value) => constant(S::from(*value)),
        FormulaPart::Variable(_) => Ratio { numerator: vec![one, S::from(0.0)], denominator: vec![one] },
        FormulaPart::Parameter(name) => {
            let unknown = || FormulaError::new(format!("unknown parameter `{name}`"), node.range.clone());
            constant(parameter(name).ok_or_else(unknown)?)
        }
        FormulaPart::Negate(a) => scaled(&values[*a], S::from(-1.0)),
        FormulaPart::Add(a, b) => sum(&values[*a], &values[*b]),
        FormulaPart::Subtract(a, b) => sum(&values[*a], &scaled(&values[*b], S::from(-1.0))),
        FormulaPart::Multiply(a, b) => times(&values[*a], &values[*b]),
        FormulaPart::Divide(a, b) => over(&values[*a], &values[*b]),
        FormulaPart::Power(a, exponent) => {
            let base = &values[*a];
            let degree = base.numerator.len().max(base.denominator.len()) - 1;
            if degree.saturating_mul(*exponent as usize) > MAXIMUM_POWER {
                let message = format!("the power of the polynomial is above {MAXIMUM_POWER}");
                return Err(FormulaError::new(message, node.range.clone()));
            }
            (0..*exponent).fold(constant(one), |product, _| times(&product, base))
        }
    })
}

fn constant<S: Scalar>(value: S) -> Ratio<S> {
    Ratio { numerator: vec![value], denominator: vec![S::from(1.0)] }
}

fn scaled<S: Scalar>(a: &Ratio<S>, factor: S) -> Ratio<S> {
    let numerator = a.numerator.iter().map(|c| factor * *c).collect();
    Ratio { numerator, denominator: a.denominator.clone() }
}

/// Sum of ratios. A denominator without the variable is one, since such divisors are applied to the
/// coefficients.
fn sum<S: Scalar>(a: &Ratio<S>, b: &Ratio<S>) -> Ratio<S> {
    if a.denominator.len() == 1 && b.denominator.len() == 1 {
        return Ratio { numerator: add(&a.numerator, &b.numerator), denominator: a.denominator.clone() };
    }
    let left = multiply(&a.numerator, &b.denominator);
    let right = multiply(&b.numerator, &a.denominator);
    Ratio { numerator: add(&left, &right), denominator: multiply(&a.denominator, &b.denominator) }
}

fn times<S: Scalar>(a: &Ratio<S>, b: &Ratio<S>) -> Ratio<S> {
    Ratio {
        numerator: multiply(&a.numerator, &b.numerator),
        denominator: multiply(&a.denominator, &b.denominator),
    }
}

fn over<S: Scalar>(a: &Ratio<S>, b: &Ratio<S>) -> Ratio<S> {
    let numerator = multiply(&a.numerator, &b.denominator);
    if let [divisor] = b.numerator.as_slice() {
        let numerator = numerator.into_iter().map(|c| c / *divisor).collect();
        return Ratio { numerator, denominator: a.denominator.clone() };
    }
    Ratio { numerator, denominator: multiply(&a.denominator, &b.numerator) }
}

fn add<S: Scalar>(a: &[S], b: &[S]) -> Vec<S> {
    let (long, short) = if a.len() >= b.len() { (a, b) } else { (b, a) };
    let offset = long.len() - short.len();
    let mut result = long.to_vec();
    for (sum, term) in result.iter_mut().skip(offset).zip(short) {
        *sum = *sum + *term;
    }
    result
}

fn multiply<S: Scalar>(a: &[S], b: &[S]) -> Vec<S> {
    if let [factor] = a {
        return b.iter().map(|c| *factor * *c).collect();
    }
    if let [factor] = b {
        return a.iter().map(|c| *c * *factor).collect();
    }
    let mut result = vec![S::from(0.0); a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (sum, y) in result.iter_mut().skip(i).zip(b) {
            *sum = *sum + *x * *y;
        }
    }
    result
}
