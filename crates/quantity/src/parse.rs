//! Reading a quantity: a decimal number and a product of units.
//!
//! ```text
//! quantity = number [unit]
//! unit     = factor { ("." | "·" | "*" | " ") factor } { "/" factor }
//! factor   = (name | "1" | "(" unit ")") [exponent]
//! exponent = ["^"] a whole or half number | "²" | "³"
//! ```

use std::f64::consts::{LN_10, TAU};
use std::ops::Range;

use super::dimension::{CURRENT, DIMENSIONS, Dimension, Exponents, GAIN, PERCENT, VOLTAGE};
use super::error::{QuantityError, QuantityExpectation, QuantityFault, QuantityHint};
use super::exact::Whole;
use super::separators::refuse_thousands;
use super::unit::{self, Unit};
use crate::spelling::nearest;

/// Longest text read as a quantity, in bytes.
const MAXIMUM_LENGTH: usize = 120;
/// Largest number of factors in one unit.
const MAXIMUM_FACTORS: usize = 12;
/// Largest exponent of one factor, in halves.
const MAXIMUM_EXPONENT: i32 = 16;

/// SI value of a text such as `"9.8 L/min"`.
///
/// The decimal number and the factors of its units are multiplied exactly and rounded once (π and
/// square roots are rounded on their own). `Hz` counts cycles: for an angular frequency, `"175 Hz"`
/// is 2π·175 rad/s. The value of a percentage is the number of percent: `"2 %"` and `"2"` are 2.
/// `inf` is read as infinity; each key decides whether to accept it.
///
/// # Errors
/// [`QuantityError`] for text that is not a quantity, an unknown unit, another dimension, a missing
/// unit, or a number that f64 cannot hold.
///
/// # Example
/// ```
/// use phea_quantity::{FLOW, PERCENT, PRESSURE, parse};
/// assert_eq!(parse("70 bar", &PRESSURE), Ok(70e5));
/// assert_eq!(parse("10 gpm", &FLOW), Ok(6.30901964e-4));
/// assert_eq!(parse("2.5 %", &PERCENT), Ok(2.5));
/// assert_eq!(parse("70 mm", &PRESSURE).unwrap_err().to_string(), "expected a pressure, found a length");
/// ```
pub fn parse(text: &str, dimension: &Dimension) -> Result<f64, QuantityError> {
    if text.len() > MAXIMUM_LENGTH {
        return Err(QuantityError::new(QuantityFault::TooLong, 0..text.len()));
    }
    let (name, examples) = (dimension.name, dimension.examples);
    let expected = || Some(QuantityExpectation::OfDimension { name, examples });
    let with_expected = |mut error: QuantityError| {
        error.expected = error.expected.or_else(expected);
        error
    };
    refuse_thousands(text).map_err(with_expected)?;
    let number = DecimalNumber::read(text).map_err(with_expected)?;
    let unit_start = number.end + text[number.end..].len() - text[number.end..].trim_start().len();
    let unit_text = text[unit_start..].trim_end();
    let unit_range = unit_start..unit_start + unit_text.len();
    if unit_text.is_empty() {
        return unitless(text, &number, dimension).map_err(with_expected);
    }
    if unit_text == "dB" && std::ptr::eq(dimension, &GAIN) {
        let value = number.times(&UnitProduct::default(), text).map_err(with_expected)?;
        return finite(decibels(value), text);
    }
    let product = product_of(text, unit_range, dimension).map_err(with_expected)?;
    number.times(&product, text).map_err(with_expected)
}

/// Unit in a part of a text.
fn product_of(text: &str, range: Range<usize>, dimension: &Dimension) -> Result<UnitProduct, QuantityError> {
    let product = UnitReader { text, at: range.start, end: range.end, factors: 0 }.unit()?;
    let is_angular = dimension.exponents == Exponents::whole(0, 0, -1, 0, 1);
    if is_angular && product.exponents == PER_SECOND && product.over != product.under {
        let error = QuantityError::new(QuantityFault::AmbiguousRotation, range);
        return Err(error.help(QuantityHint::UnitsOfRotation));
    }
    if accepts(dimension, product.exponents) {
        let ten = if std::ptr::eq(dimension, &PERCENT) { product.ten + 2 } else { product.ten };
        return Ok(UnitProduct { ten, ..product });
    }
    let error = QuantityError::new(other_dimension(dimension.name, product.exponents), range);
    let is_current = product.exponents == CURRENT.exponents && dimension.exponents == VOLTAGE.exponents;
    Err(if is_current { error.help(QuantityHint::CommandsAreVoltages) } else { error })
}

/// Unit, and a flag for numbers in decibels; an empty text is the unit of a pure number.
pub(crate) fn unit_of(unit: &str, dimension: &Dimension) -> Result<(UnitProduct, bool), QuantityError> {
    let is_pure = dimension.exponents == Exponents::NONE;
    if unit == "dB" && std::ptr::eq(dimension, &GAIN) {
        return Ok((UnitProduct::default(), true));
    }
    match unit.trim() {
        "" if is_pure => Ok((UnitProduct::default(), false)),
        "" => Err(QuantityError::new(QuantityFault::NoUnit, 0..unit.len())),
        _ if unit.len() > MAXIMUM_LENGTH => {
            Err(QuantityError::new(QuantityFault::TooLongUnit, 0..unit.len()))
        }
        trimmed => product_of(trimmed, 0..trimmed.len(), dimension).map(|product| (product, false)),
    }
}

/// Ratio 10^(x/20).
pub(crate) fn decibels(decibels: f64) -> f64 {
    phea_dynamics::scalar::Scalar::exp(decibels * LN_10 / 20.0)
}

fn unitless(text: &str, number: &DecimalNumber, dimension: &Dimension) -> Result<f64, QuantityError> {
    if number.infinite || dimension.exponents == Exponents::NONE {
        return number.times(&UnitProduct::default(), text);
    }
    let zero = if text.trim().starts_with('.') { "0" } else { "" };
    let bare = format!("{zero}{}", text.trim());
    let help = QuantityHint::AddUnit { bare, si: dimension.si };
    Err(QuantityError::new(QuantityFault::NumberWithoutUnit, 0..text.len()).help(help))
}

const PER_SECOND: Exponents = Exponents::whole(0, 0, -1, 0, 0);

/// True if the dimension accepts these exponents. An angular frequency may also be written 1/s.
pub(crate) fn accepts(dimension: &Dimension, found: Exponents) -> bool {
    let rotation = Exponents::whole(0, 0, -1, 0, 1);
    found == dimension.exponents || (dimension.exponents == rotation && found == PER_SECOND)
}

fn other_dimension(expected: &'static str, found: Exponents) -> QuantityFault {
    match DIMENSIONS.iter().find(|dimension| dimension.exponents == found) {
        Some(found) => QuantityFault::OtherDimension { expected, found: found.name },
        None => QuantityFault::UnnamedDimension { expected, found },
    }
}

fn finite(value: f64, text: &str) -> Result<f64, QuantityError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(QuantityError::new(QuantityFault::TooLarge, 0..text.len()))
    }
}

/// Decimal number, as written.
pub(crate) struct DecimalNumber {
    negative: bool,
    infinite: bool,
    digits: String,
    ten: i64,
    /// First byte after it.
    pub(crate) end: usize,
}

impl DecimalNumber {
    pub(crate) fn is_infinite(&self) -> bool {
        self.infinite
    }

    pub(crate) fn read(text: &str) -> Result<DecimalNumber, QuantityError> {
        let start = text.len() - text.trim_start().len();
        let bytes = text.as_bytes();
        let mut at = start;
        let sign = bytes.get(at).copied();
        if matches!(sign, Some(b'+' | b'-')) {
            at += 1;
        }
        let negative = sign == Some(b'-');
        if text[at..].trim_end() == "inf" {
            return Ok(DecimalNumber {
                negative,
                infinite: true,
                digits: String::new(),
                ten: 0,
                end: text.len(),
            });
        }
        let take = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        let whole_end = take(at);
        let mut digits = text[at..whole_end].to_string();
        let mut end = whole_end;
        if bytes.get(end) == Some(&b'.') && bytes.get(end + 1).is_some_and(u8::is_ascii_digit) {
            end = take(whole_end + 1);
            digits.push_str(&text[whole_end + 1..end]);
        }
        if digits.is_empty() {
            return Err(DecimalNumber::missing(text, start));
        }
        let mut ten = -i64::try_from(end - whole_end).unwrap_or(0).saturating_sub(1).max(0);
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let signed = matches!(bytes.get(end + 1), Some(b'+' | b'-'));
            let exponent_start = end + 1 + usize::from(signed);
            let exponent_end =
                if exponent_start <= bytes.len() { take(exponent_start) } else { exponent_start };
            if exponent_end > exponent_start {
                let exponent: i64 = text[end + 1..exponent_end].parse().unwrap_or(i64::MAX);
                ten = ten.saturating_add(exponent.clamp(-100_000, 100_000));
                end = exponent_end;
            }
        }
        Ok(DecimalNumber { negative, infinite: false, digits, ten, end })
    }

    fn missing(text: &str, start: usize) -> QuantityError {
        let rest = text[start..].chars().next().map_or(0, char::len_utf8);
        let fault = if rest == 0 { QuantityFault::Empty } else { QuantityFault::NoNumber };
        QuantityError::new(fault, start..start + rest)
    }

    pub(crate) fn times(&self, product: &UnitProduct, text: &str) -> Result<f64, QuantityError> {
        if self.infinite {
            return Ok(if self.negative { f64::NEG_INFINITY } else { f64::INFINITY });
        }
        let mut whole = Whole::from_digits(&self.digits);
        for factor in &product.over {
            whole.multiply(*factor);
        }
        let magnitude = whole.to_f64(self.ten + product.ten, &product.under) * product.rounded;
        let value = finite(if self.negative { -magnitude } else { magnitude }, text)?;
        let nothing = self.digits.chars().all(|digit| digit == '0');
        if value == 0.0 && !nothing {
            return Err(QuantityError::new(QuantityFault::TooSmall, 0..text.len()));
        }
        Ok(value)
    }
}

/// Product of units: `over / under · 10^ten · rounded`.
#[derive(Clone, Debug)]
pub(crate) struct UnitProduct {
    exponents: Exponents,
    pub(crate) over: Vec<u64>,
    pub(crate) under: Vec<u64>,
    pub(crate) ten: i64,
    pub(crate) rounded: f64,
}

impl Default for UnitProduct {
    fn default() -> Self {
        UnitProduct { exponents: Exponents::NONE, over: Vec::new(), under: Vec::new(), ten: 0, rounded: 1.0 }
    }
}

impl UnitProduct {
    fn of(unit: &Unit) -> UnitProduct {
        let rounded = if unit.turns == 1 { TAU } else { 1.0 };
        let (over, under) = (vec![unit.numerator], vec![unit.denominator]);
        UnitProduct { exponents: unit.exponents, over, under, ten: i64::from(unit.ten), rounded }
    }

    /// Power `halves`/2 of the product.
    fn power(&self, halves: i32) -> Option<UnitProduct> {
        let exponents = self.exponents.to_halves(i8::try_from(halves).ok()?)?;
        let mut result = UnitProduct::default();
        let half = halves % 2 != 0;
        if half {
            let mut square = Whole::from_digits("1");
            for factor in &self.over {
                square.multiply(*factor);
            }
            let root = (square.to_f64(self.ten, &self.under) * self.rounded).sqrt();
            result.rounded = if halves > 0 { root } else { 1.0 / root };
        }
        for _ in 0..(halves / 2).unsigned_abs() {
            let factor = if halves > 0 { self.clone() } else { self.inverse() };
            result = result.times(&factor)?;
        }
        result.exponents = exponents;
        Some(result)
    }

    fn inverse(&self) -> UnitProduct {
        UnitProduct {
            exponents: Exponents(self.exponents.0.map(|exponent| -exponent)),
            over: self.under.clone(),
            under: self.over.clone(),
            ten: -self.ten,
            rounded: 1.0 / self.rounded,
        }
    }

    fn times(mut self, other: &UnitProduct) -> Option<UnitProduct> {
        for (sum, term) in self.exponents.0.iter_mut().zip(other.exponents.0) {
            *sum = sum.checked_add(term)?;
        }
        self.over.extend(&other.over);
        self.under.extend(&other.under);
        self.ten += other.ten;
        self.rounded *= other.rounded;
        Some(self)
    }
}

/// Reads a unit from left to right.
struct UnitReader<'a> {
    text: &'a str,
    at: usize,
    end: usize,
    factors: usize,
}

impl UnitReader<'_> {
    fn unit(&mut self) -> Result<UnitProduct, QuantityError> {
        let product = self.product(true)?;
        if self.at < self.end {
            let range = self.at..self.at + self.peek().map_or(0, char::len_utf8);
            return Err(QuantityError::new(QuantityFault::UnexpectedCharacter, range));
        }
        Ok(product)
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..self.end].chars().next()
    }

    fn skip_spaces(&mut self) -> bool {
        let rest = &self.text[self.at..self.end];
        let spaces = rest.len() - rest.trim_start().len();
        self.at += spaces;
        spaces > 0
    }

    fn product(&mut self, group_allowed: bool) -> Result<UnitProduct, QuantityError> {
        let mut result = self.factor(group_allowed)?;
        let mut divided = false;
        loop {
            let spaced = self.skip_spaces();
            let operator_at = self.at;
            let (divide, length) = match self.peek() {
                Some('/') => (true, 1),
                Some(c @ ('.' | '*' | '·')) => (false, c.len_utf8()),
                None | Some(')') => return Ok(result),
                Some(_) if spaced => (false, 0),
                Some(_) => return Ok(result),
            };
            if divided && !divide {
                let range = operator_at..operator_at + self.peek().map_or(0, char::len_utf8);
                let error = QuantityError::new(QuantityFault::ProductAfterDivision, range);
                return Err(error.help(QuantityHint::Parentheses));
            }
            divided |= divide;
            self.at += length;
            self.skip_spaces();
            let factor = self.factor(group_allowed)?;
            let factor = if divide { factor.inverse() } else { factor };
            let range = operator_at..self.at;
            result =
                result.times(&factor).ok_or_else(|| QuantityError::new(QuantityFault::NotInUse, range))?;
        }
    }

    fn factor(&mut self, group_allowed: bool) -> Result<UnitProduct, QuantityError> {
        self.factors += 1;
        let start = self.at;
        if self.factors > MAXIMUM_FACTORS {
            return Err(QuantityError::new(QuantityFault::TooManyFactors, start..self.end));
        }
        let base = match self.peek() {
            Some('(') if group_allowed => {
                self.at += 1;
                self.skip_spaces();
                let inner = self.product(false)?;
                if self.peek() != Some(')') {
                    return Err(QuantityError::new(QuantityFault::OpenParenthesis, start..start + 1));
                }
                self.at += 1;
                inner
            }
            _ => self.named()?,
        };
        match self.exponent()? {
            None => Ok(base),
            Some(halves) => base
                .power(halves)
                .ok_or_else(|| QuantityError::new(QuantityFault::ImpossiblePower, start..self.at)),
        }
    }

    fn named(&mut self) -> Result<UnitProduct, QuantityError> {
        let start = self.at;
        let unity = self.text[self.at..self.end].strip_prefix('1').map(str::trim_start);
        if unity.is_some_and(|rest| rest.starts_with('/')) {
            self.at += 1;
            return Ok(UnitProduct::default());
        }
        let letters = |c: &char| c.is_alphabetic() || matches!(c, '%' | '°');
        let length: usize =
            self.text[self.at..self.end].chars().take_while(letters).map(char::len_utf8).sum();
        if length == 0 {
            let wide = self.peek().map_or(0, char::len_utf8);
            return Err(QuantityError::new(QuantityFault::NoName, start..start + wide));
        }
        self.at += length;
        let name = &self.text[start..self.at];
        named(name).ok_or_else(|| unknown(name, start..self.at))
    }

    /// Exponent in halves; `None` if it is absent.
    fn exponent(&mut self) -> Result<Option<i32>, QuantityError> {
        let start = self.at;
        match self.peek() {
            Some(c @ ('²' | '³')) => {
                self.at += c.len_utf8();
                return Ok(Some(if c == '²' { 4 } else { 6 }));
            }
            Some('^') => self.at += 1,
            Some(c) if c.is_ascii_digit() => {}
            _ => return Ok(None),
        }
        let rest = &self.text[self.at..self.end];
        let part = |c: &char| c.is_ascii_digit() || matches!(c, '.' | '-');
        let written: String = rest.chars().take_while(part).collect();
        let written = written.trim_end_matches(['.', '-']);
        self.at += written.len();
        let halves = written.parse::<f64>().ok().map(|power| 2.0 * power);
        let in_range =
            halves.filter(|h| h.fract() == 0.0 && h.abs() <= f64::from(MAXIMUM_EXPONENT) && *h != 0.0);
        match in_range {
            Some(halves) => Ok(Some(halves as i32)),
            None => Err(QuantityError::new(QuantityFault::NoExponent, start..self.at.max(start + 1))),
        }
    }
}

/// Unit by its name, or several written as one word (`kNm`, `Ns`).
fn named(name: &str) -> Option<UnitProduct> {
    if let Some(unit) = unit::find(name) {
        return Some(UnitProduct::of(&unit));
    }
    let mut units = unit::written_together(name)?.into_iter();
    let first = UnitProduct::of(&units.next()?);
    units.try_fold(first, |product, unit| product.times(&UnitProduct::of(&unit)))
}

fn unknown(name: &str, range: Range<usize>) -> QuantityError {
    let error = QuantityError::new(QuantityFault::UnknownUnit(name.to_string()), range);
    if ["bara", "barA", "psia", "PSIA"].contains(&name) {
        return error.help(QuantityHint::GaugePressures);
    }
    match nearest(name, unit::names()) {
        Some(name) => error.help(QuantityHint::NearUnit(name)),
        None => error,
    }
}
