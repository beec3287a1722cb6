//! Prices in text: `"180 EUR"` for a piece, `"40 EUR/m"` for a length.

use super::dimension::LENGTH;
use super::error::{QuantityError, QuantityExpectation, QuantityFault, QuantityHint};
use super::parse::{DecimalNumber, parse};
use super::pattern::{UNSIGNED, length_units};
use super::print::print_bare;
use super::separators::refuse_thousands;
use crate::spelling::nearest;

/// Currency, by its code of ISO 4217.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Currency(&'static str);

impl Currency {
    /// Code of three letters.
    pub fn code(self) -> &'static str {
        self.0
    }
}

/// Unit of a price.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PricedBy {
    /// Per piece.
    Piece,
    /// Per metre.
    Length,
}

/// Price of a piece or a metre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// Amount in the currency, per piece or metre.
    pub amount: f64,
    /// Currency of the amount.
    pub currency: Currency,
}

/// Reads a price.
///
/// # Errors
/// [`QuantityError`] for a text that is not a price, a negative one, an unknown currency, and a
/// price per length instead of one per piece, or vice versa.
///
/// # Example
/// ```
/// use phea_quantity::{PricedBy, QuantityHint, parse_price};
/// let hose = parse_price("12.192 EUR/ft", PricedBy::Length)?;
/// assert!((hose.amount - 40.0).abs() < 1e-12 && hose.currency.code() == "EUR");
/// assert_eq!(parse_price("180 EURO", PricedBy::Piece).unwrap_err().help, Some(Box::new(QuantityHint::NearCurrency("EUR"))));
/// # Ok::<(), phea_quantity::QuantityError>(())
/// ```
pub fn parse_price(text: &str, by: PricedBy) -> Result<Price, QuantityError> {
    let expected = || match by {
        PricedBy::Piece => QuantityExpectation::Price,
        PricedBy::Length => QuantityExpectation::PriceForLength,
    };
    let error = |fault: QuantityFault, start: usize, help: Option<Box<QuantityHint>>| QuantityError {
        fault,
        range: start..text.len(),
        expected: Some(expected()),
        help,
    };
    let read = refuse_thousands(text).and_then(|()| DecimalNumber::read(text));
    let number = read.map_err(|mut found| {
        found.expected = Some(expected());
        found
    })?;
    let amount: f64 = text.get(..number.end).unwrap_or_default().trim().parse().unwrap_or(f64::INFINITY);
    if !amount.is_finite() || amount < 0.0 {
        return Err(error(QuantityFault::NegativePrice, 0, None));
    }
    let rest = text.get(number.end..).unwrap_or_default();
    let (code, unit) = match rest.split_once('/') {
        Some((code, unit)) => (code.trim(), Some(unit.trim())),
        None => (rest.trim(), None),
    };
    let Some(currency) = CURRENCIES.iter().find(|known| **known == code).map(|code| Currency(code)) else {
        let upper = code.to_uppercase();
        let near = nearest(&upper, CURRENCIES.iter().copied()).map(QuantityHint::NearCurrency);
        let help = near.unwrap_or(QuantityHint::CodeOfCurrency);
        let fault = if code.is_empty() { QuantityFault::NoCurrency } else { QuantityFault::UnknownCurrency };
        return Err(error(fault, number.end, Some(Box::new(help))));
    };
    let metres = match (by, unit) {
        (PricedBy::Piece, None) => 1.0,
        (PricedBy::Length, Some(unit)) => parse(&format!("1 {unit}"), &LENGTH)
            .map_err(|found| error(found.fault, number.end, found.help))?,
        (PricedBy::Piece, Some(_)) => {
            return Err(error(QuantityFault::PricePerLength, number.end, None));
        }
        (PricedBy::Length, None) => {
            return Err(error(QuantityFault::PricePerPiece, number.end, None));
        }
    };
    Ok(Price { amount: amount / metres, currency })
}

/// Price in TOML, with its quotes, that reads back unchanged.
///
/// # Example
/// ```
/// use phea_quantity::{PricedBy, parse_price, print_price};
/// let price = parse_price("40 EUR/m", PricedBy::Length)?;
/// assert_eq!(print_price(price, PricedBy::Length), "\"40 EUR/m\"");
/// # Ok::<(), phea_quantity::QuantityError>(())
/// ```
pub fn print_price(price: Price, by: PricedBy) -> String {
    let over = if by == PricedBy::Length { "/m" } else { "" };
    format!("\"{} {}{over}\"", print_bare(price.amount), price.currency.code())
}

/// Matches every text that [`parse_price`] accepts.
///
/// # Example
/// ```
/// use phea_quantity::{PricedBy, price_pattern};
/// assert!(price_pattern(PricedBy::Piece).contains("EUR"));
/// ```
pub fn price_pattern(by: PricedBy) -> String {
    let currencies = CURRENCIES.join("|");
    let over = match by {
        PricedBy::Piece => String::new(),
        PricedBy::Length => format!(r"\s*/\s*(?:{})", length_units()),
    };
    format!(r"^\s*\+?{UNSIGNED}\s*(?:{currencies}){over}\s*$")
}

/// Currencies of countries by ISO 4217.
pub(super) static CURRENCIES: [&str; 154] = [
    "AED", "AFN", "ALL", "AMD", "ANG", "AOA", "ARS", "AUD", "AWG", "AZN", "BAM", "BBD", "BDT", "BGN", "BHD",
    "BIF", "BMD", "BND", "BOB", "BRL", "BSD", "BTN", "BWP", "BYN", "BZD", "CAD", "CDF", "CHF", "CLP", "CNY",
    "COP", "CRC", "CUP", "CVE", "CZK", "DJF", "DKK", "DOP", "DZD", "EGP", "ERN", "ETB", "EUR", "FJD", "FKP",
    "GBP", "GEL", "GHS", "GIP", "GMD", "GNF", "GTQ", "GYD", "HKD", "HNL", "HTG", "HUF", "IDR", "ILS", "INR",
    "IQD", "IRR", "ISK", "JMD", "JOD", "JPY", "KES", "KGS", "KHR", "KMF", "KPW", "KRW", "KWD", "KYD", "KZT",
    "LAK", "LBP", "LKR", "LRD", "LSL", "LYD", "MAD", "MDL", "MGA", "MKD", "MMK", "MNT", "MOP", "MRU", "MUR",
    "MVR", "MWK", "MXN", "MYR", "MZN", "NAD", "NGN", "NIO", "NOK", "NPR", "NZD", "OMR", "PAB", "PEN", "PGK",
    "PHP", "PKR", "PLN", "PYG", "QAR", "RON", "RSD", "RUB", "RWF", "SAR", "SBD", "SCR", "SDG", "SEK", "SGD",
    "SHP", "SLE", "SOS", "SRD", "SSP", "STN", "SVC", "SYP", "SZL", "THB", "TJS", "TMT", "TND", "TOP", "TRY",
    "TTD", "TWD", "TZS", "UAH", "UGX", "USD", "UYU", "UZS", "VES", "VND", "VUV", "WST", "XAF", "XCD", "XOF",
    "XPF", "YER", "ZAR", "ZMW",
];
