//! Formulas in text: `"2116*(s + 75)/75"`, `"(s^2 + 40*s + 400)*(s + 50)"`, `"k*a"`.
//!
//! ```text
//! sum     = ["-" | "+"] product { ("+" | "-") product }
//! product = power { ("*" | "/") power }
//! power   = atom ["^" whole number]
//! atom    = number | name | "(" sum ")"
//! ```
//! `s` and `z` are the variables; every other name is a parameter.

mod expand;
mod parse;

use std::ops::Range;

use phea_dynamics::scalar::Scalar;

/// Formula in `s` or `z` and named parameters. Two are equal if they are written identically.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    /// Operands before their operators; the last node is the whole formula.
    nodes: Vec<FormulaNode>,
}

/// Part of a formula, and its position in the text.
#[derive(Clone, Debug)]
struct FormulaNode {
    part: FormulaPart,
    range: Range<usize>,
}

/// Kind of a part; operands by their index.
#[derive(Clone, Debug)]
enum FormulaPart {
    Number(f64),
    Variable(Variable),
    Parameter(String),
    Negate(usize),
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Power(usize, u32),
}

/// Variable of a transfer function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Continuous time.
    S,
    /// Discrete time.
    Z,
}

impl Variable {
    /// Symbol of the variable.
    pub fn name(self) -> &'static str {
        match self {
            Variable::S => "s",
            Variable::Z => "z",
        }
    }
}

/// Error in a formula, with its position in the text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct FormulaError {
    /// Fault, in one sentence.
    pub message: String,
    /// Range in bytes of the text.
    pub range: Range<usize>,
    /// Remedy.
    pub help: Option<String>,
}

impl FormulaError {
    fn new(message: impl Into<String>, range: Range<usize>) -> Self {
        FormulaError { message: message.into(), range, help: None }
    }

    fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Numerator and denominator by their coefficients, highest power first.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratio<S> {
    /// Numerator coefficients, never empty.
    pub numerator: Vec<S>,
    /// Denominator coefficients, never empty.
    pub denominator: Vec<S>,
}

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// [`FormulaError`] for text outside the grammar, both `s` and `z`, a power above 50, or
    /// nesting above 32.
    ///
    /// # Example
    /// ```
    /// use phea_table::Formula;
    /// let formula = Formula::parse("2116*(s + 75)/75")?;
    /// assert_eq!(formula.polynomial(), Some(vec![2116.0 / 75.0, 2116.0]));
    /// assert_eq!(Formula::parse("2*s + k*").unwrap_err().message, "the formula ends where a number or name should follow");
    /// # Ok::<(), phea_table::FormulaError>(())
    /// ```
    pub fn parse(text: &str) -> Result<Formula, FormulaError> {
        parse::formula(text, true)
    }

    /// Reads a formula in `s` in which `z` is a parameter, as is possible if nothing is sampled.
    ///
    /// # Errors
    /// Errors of [`Formula::parse`].
    ///
    /// # Example
    /// ```
    /// use phea_table::Formula;
    /// let formula = Formula::parse_continuous("s^2 + 2*z*s + 1")?;
    /// assert_eq!(formula.parameters(), [("z", 8..9)]);
    /// # Ok::<(), phea_table::FormulaError>(())
    /// ```
    pub fn parse_continuous(text: &str) -> Result<Formula, FormulaError> {
        parse::formula(text, false)
    }

    /// Formula of a number.
    pub fn number(value: f64) -> Formula {
        let text = format!("{value}");
        let range = 0..text.len();
        Formula { text, nodes: vec![FormulaNode { part: FormulaPart::Number(value), range }] }
    }

    /// Text as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Variable, if it occurs.
    pub fn variable(&self) -> Option<Variable> {
        self.nodes
            .iter()
            .find_map(|node| if let FormulaPart::Variable(v) = node.part { Some(v) } else { None })
    }

    /// Names of the parameters and the first occurrence of each, in text order.
    pub fn parameters(&self) -> Vec<(&str, Range<usize>)> {
        let mut found: Vec<(&str, Range<usize>)> = Vec::new();
        for node in &self.nodes {
            if let FormulaPart::Parameter(name) = &node.part
                && found.iter().all(|(known, _)| known != name)
            {
                found.push((name, node.range.clone()));
            }
        }
        found.sort_by_key(|(_, range)| range.start);
        found
    }

    /// Ratio of polynomials in the variable, with its parameters given as numbers of any kind:
    /// plain, dual or recorded. A divisor without the variable divides the coefficients.
    ///
    /// # Errors
    /// [`FormulaError`] for a missing parameter, or a power above 50.
    pub fn ratio<S: Scalar>(&self, parameter: &dyn Fn(&str) -> Option<S>) -> Result<Ratio<S>, FormulaError> {
        expand::ratio(self, parameter, |_| None)
    }

    /// Ratio of polynomials of a formula without parameters, leading zeros dropped.
    ///
    /// # Errors
    /// [`FormulaError`] for a parameter, a power above 50, or a coefficient that f64 cannot hold.
    pub fn numbers(&self) -> Result<Ratio<f64>, FormulaError> {
        let ratio = expand::ratio(self, &|_| None, expand::not_finite)?;
        let [numerator, denominator] = [ratio.numerator, ratio.denominator].map(expand::trimmed);
        Ok(Ratio { numerator, denominator })
    }

    /// Coefficients of a polynomial without parameters, highest power first, leading zeros dropped;
    /// `None` if there are parameters, the variable in a divisor, or coefficients that f64 cannot
    /// hold.
    pub fn polynomial(&self) -> Option<Vec<f64>> {
        let ratio = self.numbers().ok()?;
        if ratio.denominator.len() != 1 { None } else { Some(ratio.numerator) }
    }
}

impl Default for Formula {
    fn default() -> Self {
        Formula::number(0.0)
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}
