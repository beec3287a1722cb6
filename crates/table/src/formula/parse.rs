//! Text to formula.

use super::{Formula, FormulaError, FormulaNode, FormulaPart, Variable};

/// Longest formula, in bytes.
const MAXIMUM_LENGTH: usize = 2000;
/// Deepest nesting of parentheses.
const MAXIMUM_DEPTH: usize = 32;
/// Highest power.
pub(super) const MAXIMUM_POWER: usize = 50;

/// Formula of a text; `sampled` is true if `z` is the variable of a sampled system, and not a
/// parameter.
pub(super) fn formula(text: &str, sampled: bool) -> Result<Formula, FormulaError> {
    if text.len() > MAXIMUM_LENGTH {
        return Err(FormulaError::new("too long for a formula", 0..text.len()));
    }
    let mut reader = FormulaReader { text, sampled, at: 0, nodes: Vec::new(), depth: 0, variable: None };
    reader.skip_spaces();
    if reader.rest().is_empty() {
        return Err(FormulaError::new("an empty formula", 0..text.len()));
    }
    reader.sum()?;
    if let Some(c) = reader.rest().chars().next() {
        return Err(reader.unexpected(c));
    }
    Ok(Formula { text: text.to_string(), nodes: reader.nodes })
}

/// Reads from left to right; each method returns the index of its node.
struct FormulaReader<'a> {
    text: &'a str,
    sampled: bool,
    at: usize,
    nodes: Vec<FormulaNode>,
    depth: usize,
    variable: Option<Variable>,
}

impl<'a> FormulaReader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_spaces(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.rest().starts_with(wanted);
        if found {
            self.at += wanted.len_utf8();
            self.skip_spaces();
        }
        found
    }

    fn push(&mut self, part: FormulaPart, start: usize) -> usize {
        let end = start + self.text[start..self.at].trim_end().len();
        self.nodes.push(FormulaNode { part, range: start..end });
        self.nodes.len() - 1
    }

    fn sum(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        let negative = self.take('-');
        if !negative {
            self.take('+');
        }
        let mut left = self.product()?;
        if negative {
            left = self.push(FormulaPart::Negate(left), start);
        }
        loop {
            let add = self.take('+');
            if !add && !self.take('-') {
                return Ok(left);
            }
            let right = self.product()?;
            let part = if add { FormulaPart::Add(left, right) } else { FormulaPart::Subtract(left, right) };
            left = self.push(part, start);
        }
    }

    fn product(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        let mut left = self.power()?;
        loop {
            let multiply = self.take('*');
            if !multiply && !self.take('/') {
                return Ok(left);
            }
            let right = self.power()?;
            let part =
                if multiply { FormulaPart::Multiply(left, right) } else { FormulaPart::Divide(left, right) };
            left = self.push(part, start);
        }
    }

    fn power(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        let base = self.atom()?;
        if !self.take('^') {
            return Ok(base);
        }
        let exponent_start = self.at;
        let digits: &str = self.rest().split(|c: char| !c.is_ascii_digit()).next().unwrap_or_default();
        self.at += digits.len();
        let exponent = digits.parse::<u32>().ok().filter(|n| *n as usize <= MAXIMUM_POWER);
        let fractional = self.rest().starts_with('.');
        let Some(exponent) = exponent.filter(|_| !fractional) else {
            let end = self.at.max(exponent_start + self.rest().chars().next().map_or(0, char::len_utf8));
            let message = format!("expected a whole power from 0 to {MAXIMUM_POWER}");
            return Err(FormulaError::new(message, exponent_start..end));
        };
        self.skip_spaces();
        Ok(self.push(FormulaPart::Power(base, exponent), start))
    }

    fn atom(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        match self.rest().chars().next() {
            None => {
                let message = "the formula ends where a number or name should follow";
                Err(FormulaError::new(message, start..start))
            }
            Some('(') => self.group(),
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            Some('-' | '+') => {
                let error = FormulaError::new("a second sign", start..start + 1);
                Err(error.help("put the signed number in parentheses"))
            }
            Some(c) => Err(self.unexpected(c)),
        }
    }

    fn group(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        self.depth += 1;
        if self.depth > MAXIMUM_DEPTH {
            let message = format!("parentheses nested deeper than {MAXIMUM_DEPTH}");
            return Err(FormulaError::new(message, start..start + 1));
        }
        self.take('(');
        let inner = self.sum()?;
        if !self.rest().starts_with(')') {
            return Err(match self.rest().chars().next() {
                Some(c) => self.unexpected(c),
                None => FormulaError::new("this parenthesis is not closed", start..start + 1),
            });
        }
        self.take(')');
        self.depth -= 1;
        Ok(inner)
    }

    fn number(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let digits = |from: usize| bytes.iter().skip(from).take_while(|b| b.is_ascii_digit()).count();
        let mut end = start + digits(start);
        if bytes.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let signed = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits(end + 1 + signed);
            if exponent > 0 {
                end += 1 + signed + exponent;
            }
        }
        let value = self.text[start..end].parse::<f64>();
        self.at = end;
        let node = match value {
            Ok(value) if value.is_finite() => self.push(FormulaPart::Number(value), start),
            Ok(_) => return Err(FormulaError::new("the number is too large", start..end)),
            Err(_) => return Err(FormulaError::new("this is not a number", start..end)),
        };
        self.skip_spaces();
        Ok(node)
    }

    fn name(&mut self) -> Result<usize, FormulaError> {
        let start = self.at;
        let inside = |c: &char| c.is_alphanumeric() || *c == '_';
        self.at += self.rest().chars().take_while(inside).map(char::len_utf8).sum::<usize>();
        let name = &self.text[start..self.at];
        let variable = match name {
            "s" => Some(Variable::S),
            "z" if self.sampled => Some(Variable::Z),
            _ => None,
        };
        if let (Some(now), Some(before)) = (variable, self.variable)
            && now != before
        {
            return Err(FormulaError::new("both `s` and `z` in one formula", start..self.at));
        }
        self.variable = self.variable.or(variable);
        let part = variable.map_or_else(|| FormulaPart::Parameter(name.to_string()), FormulaPart::Variable);
        let node = self.push(part, start);
        self.skip_spaces();
        Ok(node)
    }

    fn unexpected(&self, c: char) -> FormulaError {
        let error = FormulaError::new(format!("unexpected `{c}`"), self.at..self.at + c.len_utf8());
        if c.is_alphanumeric() || c == '(' {
            return error.help("write a product with `*`, as in 2*s");
        }
        match c {
            ',' => error.help("write the decimal sign as a point"),
            ')' => error.help("no parenthesis is open here"),
            _ => error,
        }
    }
}
