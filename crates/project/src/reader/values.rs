//! Numbers and formulas, and their errors.

use super::{Hit, Reader};
use crate::text::{Place, RawFinding};
use crate::tree::{TreeNode, Value};
use phea_quantity::spelling::nearest;
use phea_quantity::{self as quantity, Price, PricedBy, QuantityError};
use phea_table::FormulaShape;
use phea_table::Key;
use phea_table::{Formula, Ratio};

impl Reader<'_> {
    /// SI value of a number or a quantity in text, within the key's range.
    pub(super) fn number(&mut self, key: Key, node: &TreeNode) -> Option<f64> {
        let key = key.in_motion(self.motion);
        let value = match &node.value {
            Value::Number(value) => *value,
            Value::Text(text) => match quantity::parse(text, key.dimension) {
                Ok(value) => value,
                Err(error) => {
                    let place = self.inside(node, text, error.range.clone());
                    self.findings.push(refused_quantity(place, &error));
                    return None;
                }
            },
            _ => {
                let examples = format!("{}, such as {}", key.dimension.name, key.dimension.examples);
                let message = format!("`{}` must be {}, not {}", key.name, key.dimension.name, node.kind());
                self.findings.push(RawFinding::error(node.place, message).expected(examples));
                return None;
            }
        };
        if key.range.contains(value) {
            return Some(value);
        }
        // a number that f64 cannot hold was rejected when it was read
        if !self.findings.has_error_within(node.place) {
            self.findings.push(RawFinding::error(node.place, objection(key, value)));
        }
        None
    }

    /// SI value, or NaN if it was rejected: NaN causes no contradictions in comparisons.
    pub(super) fn number_or_none(&mut self, key: Key, node: &TreeNode) -> f64 {
        self.number(key, node).unwrap_or_else(|| {
            let path = self.path(key.name);
            self.refused.push(path);
            f64::NAN
        })
    }

    /// Price, with its currency in text.
    pub(super) fn read_price(&mut self, key: Key, by: PricedBy, node: &TreeNode) -> Option<Price> {
        let Value::Text(text) = &node.value else {
            let message = format!("`{}` must be a price in text, not {}", key.name, node.kind());
            let over = if by == PricedBy::Length { "/m" } else { "" };
            let help = format!("write it with its currency, such as \"40 EUR{over}\"");
            self.findings.push(RawFinding::error(node.place, message).help(help));
            return None;
        };
        match quantity::parse_price(text, by) {
            Ok(price) => Some(price),
            Err(error) => {
                let place = self.inside(node, text, error.range.clone());
                self.findings.push(refused_quantity(place, &error));
                None
            }
        }
    }

    /// Whole number within the key's range.
    pub(super) fn whole(&mut self, key: Key, node: &TreeNode) -> Option<u32> {
        let number = self.number(key, node)?;
        if number.fract() == 0.0 && number >= 0.0 && number <= f64::from(u32::MAX) {
            return Some(number as u32);
        }
        let message = format!("`{}` must be a whole number", key.name);
        self.findings.push(RawFinding::error(node.place, message));
        None
    }

    /// Number, or a pair of real and imaginary part.
    pub(super) fn complex(&mut self, key: Key, node: &TreeNode) -> Option<[f64; 2]> {
        let Value::List(parts) = &node.value else { return Some([self.number(key, node)?, 0.0]) };
        if let [real, imaginary] = parts.as_slice() {
            return Some([self.number(key, real)?, self.number(key, imaginary)?]);
        }
        let message = format!("a complex number has two parts, not {}", parts.len());
        self.findings.push(RawFinding::error(node.place, message).help("write [real, imaginary]"));
        None
    }

    /// Formula of that shape; a number counts as one.
    pub(super) fn read_formula(&mut self, key: Key, shape: FormulaShape, node: &TreeNode) -> Option<Formula> {
        let (formula, text) = match &node.value {
            Value::Text(text) => {
                let parametric = matches!(shape, FormulaShape::Parametric | FormulaShape::Coefficient);
                let named = parametric && self.parameters.iter().any(|parameter| parameter == "z");
                let parse =
                    if named && !self.is_sampled() { Formula::parse_continuous } else { Formula::parse };
                (parse(text), text.as_str())
            }
            Value::Number(value) if value.is_finite() => (Ok(Formula::number(*value)), ""),
            _ => {
                let message = format!("`{}` must be a formula in text, not {}", key.name, node.kind());
                self.findings.push(RawFinding::error(node.place, message));
                return None;
            }
        };
        let checked = formula.and_then(|formula| {
            let ratio = if formula.parameters().is_empty() { Some(formula.numbers()?) } else { None };
            Ok((formula, ratio))
        });
        match checked {
            Ok((formula, ratio)) => {
                let known = self.check_parameters(&formula, shape, node, text);
                let plain = match (shape, formula.variable()) {
                    (FormulaShape::Coefficient, Some(variable)) => {
                        let message =
                            format!("`{}` is a number: `{}` has no meaning here", key.name, variable.name());
                        self.findings.push(RawFinding::error(node.place, message));
                        false
                    }
                    (FormulaShape::Coefficient, None) => true,
                    _ => self.check_shape(key, ratio.as_ref(), shape, node),
                };
                (known && plain).then_some(formula)
            }
            Err(error) => {
                let place = self.inside(node, text, error.range);
                self.findings.push(RawFinding::error(place, error.message).maybe_help(error.help));
                None
            }
        }
    }

    /// True if the loop contains a computer, so that `z` is a variable.
    fn is_sampled(&self) -> bool {
        let sampled =
            |table| self.root_entry(table).is_some_and(|entry| entry.node.get("sample_time").is_some());
        sampled("controller") || sampled("prefilter")
    }

    /// True if a text is intended as a formula rather than as a number with a unit.
    pub(super) fn reads_as_formula(&self, key: Key, text: &str) -> bool {
        let key = key.in_motion(self.motion);
        if quantity::parse(text, key.dimension).is_ok() {
            return false;
        }
        if std::ptr::eq(key.dimension, &quantity::GAIN) {
            return text.contains(['*', '(', '/', '+', '^', 's', 'z']);
        }
        let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        let named = words.any(|word| self.parameters.iter().any(|parameter| parameter == word));
        named || text.contains(['*', '(', '+', '^']) || text.trim_start().starts_with(char::is_alphabetic)
    }

    fn check_parameters(
        &mut self,
        formula: &Formula,
        shape: FormulaShape,
        node: &TreeNode,
        text: &str,
    ) -> bool {
        let mut known = true;
        let parametric = matches!(shape, FormulaShape::Parametric | FormulaShape::Coefficient);
        for (name, range) in formula.parameters() {
            if parametric && self.parameters.iter().any(|parameter| parameter == name) {
                continue;
            }
            known = false;
            let place = self.inside(node, text, range);
            let found = RawFinding::error(place, format!("unknown name `{name}`"));
            let near = nearest(name, self.parameters.iter().map(String::as_str));
            self.findings.push(match (parametric, near) {
                (true, Some(near)) => found.help(format!("did you mean `{near}`?")),
                (true, None) => found.help(format!("give `{name}` its range in [uncertainty]")),
                (false, _) => found.help("only `s` (or `z`) and numbers have a meaning here"),
            });
        }
        known
    }

    fn check_shape(
        &mut self,
        key: Key,
        ratio: Option<&Ratio<f64>>,
        shape: FormulaShape,
        node: &TreeNode,
    ) -> bool {
        let Some(ratio) = ratio else { return true };
        let message = if shape != FormulaShape::Ratio && ratio.denominator.len() > 1 {
            format!("`{}` must be a polynomial: here the variable is divided by", key.name)
        } else if ratio.numerator.iter().all(|c| *c == 0.0) || ratio.denominator.iter().all(|c| *c == 0.0) {
            format!("`{}` is zero", key.name)
        } else {
            return true;
        };
        self.findings.push(RawFinding::error(node.place, message));
        false
    }

    /// Position of a part of a decoded text in the file: exact unless the text has escapes.
    fn inside(&self, node: &TreeNode, text: &str, range: std::ops::Range<usize>) -> Place {
        let Place { text: index, start, end } = node.place;
        let raw = self.findings.content(index).get(start..end).unwrap_or_default();
        let quotes = raw.len().saturating_sub(text.len()) / 2;
        if raw.get(quotes..quotes + text.len()) != Some(text) {
            return node.place;
        }
        let last = end.saturating_sub(quotes);
        let from = (start + quotes + range.start).min(last);
        Place { text: index, start: from, end: (start + quotes + range.end).clamp(from, last) }
    }
}

/// Message for a number outside its key's range.
fn objection(key: Key, value: f64) -> String {
    let name = key.name;
    let show = |number: f64| quantity::display(number, key.dimension, 6);
    if value.is_nan() {
        return format!("`{name}` must be a number");
    }
    if value.is_infinite() {
        return format!("`{name}` must be finite");
    }
    let range = key.range;
    if range.minimum == range.maximum {
        return format!("`{name}` must be {}", show(range.minimum));
    }
    let low = if range.above_minimum { value <= range.minimum } else { value < range.minimum };
    let side = match (low, range.above_minimum, range.below_maximum) {
        (true, true, _) => format!("above {}", show(range.minimum)),
        (true, false, _) => format!("at least {}", show(range.minimum)),
        (false, _, true) => format!("below {}", show(range.maximum)),
        (false, _, false) => format!("at most {}", show(range.maximum)),
    };
    format!("`{name}` must be {side}; it is {}", show(value))
}

/// Finding for a text that is not a quantity.
fn refused_quantity(place: Place, error: &QuantityError) -> RawFinding {
    RawFinding::error(place, error.fault.to_string())
        .maybe_help(error.help.as_ref().map(ToString::to_string))
        .maybe_expected(error.expected.as_ref().map(ToString::to_string))
}

impl<'a> Reader<'a> {
    /// Reads the tables of a list.
    pub(super) fn each_table<T: Default>(
        &mut self,
        key: Key,
        items: &[&'a TreeNode],
        hit: Hit<'a>,
        field: &mut Vec<T>,
        visit: impl Fn(&mut T, &mut Self),
    ) {
        for (index, &node) in items.iter().enumerate() {
            let path = format!("{}[{index}]", self.path(key.name));
            self.item_places.insert(path.clone(), node.place);
            if self.enter(key, Hit { node, entry: hit.entry }, path) {
                let mut value = T::default();
                visit(&mut value, self);
                self.close();
                field.push(value);
            }
        }
    }
}
