//! Common unit of many numbers to be read.

use super::dimension::Dimension;
use super::error::QuantityError;
use super::parse::{DecimalNumber, UnitProduct, decibels, unit_of};

/// Unit that is ready to read a column of numbers: each as [`crate::parse`] reads it with this
/// unit, to the last bit, but without reading the unit again. A number may end in its point (`5.`).
///
/// # Example
/// ```
/// use phea_quantity::{FLOW, UnitScale, parse};
/// let litres = UnitScale::new("L/min", &FLOW)?;
/// assert_eq!(litres.read("9.8"), parse("9.8 L/min", &FLOW).ok());
/// assert_eq!(litres.read("9.8 L/min"), None);
/// # Ok::<(), phea_quantity::QuantityError>(())
/// ```
#[derive(Clone, Debug)]
pub struct UnitScale {
    product: UnitProduct,
    over: Option<u128>,
    under: Option<u128>,
    is_decibel: bool,
}

/// Largest whole number up to which all are exact in f64.
const EXACT: u128 = 1 << 53;
/// Largest number of decimal digits that is read without arithmetic of arbitrary size.
const MOST_DIGITS: usize = 19;

impl UnitScale {
    /// Scale of a unit of this dimension; an empty text is the unit of a pure number.
    ///
    /// # Errors
    /// [`QuantityError`] for a text that is not a unit, or one of another dimension.
    pub fn new(unit: &str, dimension: &Dimension) -> Result<UnitScale, QuantityError> {
        let (product, is_decibel) = unit_of(unit, dimension)?;
        let of = |factors: &[u64]| {
            factors.iter().try_fold(1_u128, |product, factor| product.checked_mul(u128::from(*factor)))
        };
        let (over, under) = (of(&product.over), of(&product.under));
        Ok(UnitScale { product, over, under, is_decibel })
    }

    /// SI value; `None` for a text that is not a decimal number, and for one that f64 cannot
    /// represent.
    pub fn read(&self, number: &str) -> Option<f64> {
        let value = self.read_quickly(number.as_bytes()).or_else(|| self.read_exactly(number))?;
        let value = if self.is_decibel { decibels(value) } else { value };
        value.is_finite().then_some(value)
    }

    fn read_exactly(&self, number: &str) -> Option<f64> {
        // a number may end in its point
        let whole = number.trim_end_matches('.');
        let is_whole =
            number.len() == whole.len() + 1 && whole.bytes().all(|byte| byte != b'.' && byte != b'e');
        let text = if is_whole { whole } else { number };
        let read = DecimalNumber::read(text).ok()?;
        (read.end == text.len() && !read.is_infinite()).then(|| read.times(&self.product, text).ok())?
    }

    /// Nearest f64, if numerator and denominator are no longer than the processor's numbers;
    /// otherwise `None`.
    fn read_quickly(&self, number: &[u8]) -> Option<f64> {
        let decimal = ScaledDecimal::read(number)?;
        let ten = self.product.ten + i64::from(decimal.ten);
        let power = 10_u128.checked_pow(u32::try_from(ten.unsigned_abs()).ok()?)?;
        let [mut over, mut under] = [u128::from(decimal.digits).checked_mul(self.over?)?, self.under?];
        let scaled = if ten < 0 { &mut under } else { &mut over };
        *scaled = scaled.checked_mul(power)?;
        let magnitude = nearest(over, under)? * self.product.rounded;
        Some(if decimal.is_negative { -magnitude } else { magnitude })
    }
}

/// Quotient over/under, rounded once.
fn nearest(over: u128, under: u128) -> Option<f64> {
    if over <= EXACT && under <= EXACT {
        return Some(over as f64 / under as f64);
    }
    if over == 0 {
        return Some(0.0);
    }
    let shift = over.leading_zeros();
    let shifted = over << shift;
    let quotient = shifted / under;
    // the last bit represents all that were cut off: below the rounding there are at least two
    let inexact = quotient * under != shifted;
    let power = f64::from_bits(u64::from(1023 - shift) << 52);
    (quotient >> 55 != 0).then(|| (quotient | u128::from(inexact)) as f64 * power)
}

/// Decimal number digits · 10^ten.
struct ScaledDecimal {
    is_negative: bool,
    digits: u64,
    ten: i32,
}

impl ScaledDecimal {
    /// Decimal number of a text; `None` for a text that is not one, and for one of more digits.
    fn read(text: &[u8]) -> Option<ScaledDecimal> {
        let (is_negative, text) = match text {
            [b'-', rest @ ..] => (true, rest),
            [b'+', rest @ ..] => (false, rest),
            _ => (false, text),
        };
        let (mut digits, mut count, mut behind, mut at, mut is_behind) = (0_u64, 0, 0_i32, 0, false);
        while let Some(&byte) = text.get(at) {
            match byte {
                b'0'..=b'9' => {
                    digits = digits.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                    count += usize::from(digits > 0);
                    behind += i32::from(is_behind);
                }
                b'.' if !is_behind => is_behind = true,
                _ => break,
            }
            at += 1;
        }
        if count > MOST_DIGITS || at == usize::from(is_behind) {
            return None;
        }
        let exponent = match text.get(at..)? {
            [] => 0,
            [b'e' | b'E', rest @ ..] => exponent(rest)?,
            _ => return None,
        };
        Some(ScaledDecimal { is_negative, digits, ten: exponent - behind })
    }
}

/// Whole number of up to three digits.
fn exponent(text: &[u8]) -> Option<i32> {
    let (sign, text) = match text {
        [b'-', rest @ ..] => (-1, rest),
        [b'+', rest @ ..] => (1, rest),
        _ => (1, text),
    };
    if text.is_empty() || text.len() > 3 || !text.iter().all(u8::is_ascii_digit) {
        return None;
    }
    Some(sign * text.iter().fold(0, |number, digit| number * 10 + i32::from(digit - b'0')))
}
