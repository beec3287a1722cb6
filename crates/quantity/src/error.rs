//! Error for a text that is not a quantity.

use std::ops::Range;

use super::dimension::Exponents;

/// Error of a quantity, with its location in the text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{fault}")]
pub struct QuantityError {
    /// Fault of the text.
    pub fault: QuantityFault,
    /// Location, in bytes of the text.
    pub range: Range<usize>,
    /// Text that was expected there.
    pub expected: Option<QuantityExpectation>,
    /// Remedy.
    pub help: Option<Box<QuantityHint>>,
}

/// Fault of a text that is not a quantity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QuantityFault {
    /// A text longer than any quantity.
    #[error("too long for a quantity")]
    TooLong,
    /// A unit longer than any unit.
    #[error("too long for a unit")]
    TooLongUnit,
    /// A text of spaces only.
    #[error("an empty text")]
    Empty,
    /// A text without a number at its beginning.
    #[error("a quantity begins with a number")]
    NoNumber,
    /// A number beyond f64.
    #[error("the number is too large")]
    TooLarge,
    /// A number that f64 rounds to zero.
    #[error("the number is too small to be distinguished from zero")]
    TooSmall,
    /// A number with a sign that may be a decimal sign or a thousands separator.
    #[error("`{written}` can be read as {readings} or as {other}", readings = readings[0], other = readings[1])]
    TwoReadings {
        /// The number as written.
        written: String,
        /// Both readings of it.
        readings: Box<[String; 2]>,
    },
    /// A comma.
    #[error("a comma inside a number")]
    Comma,
    /// Another sign between digits.
    #[error("a sign between the digits of a number")]
    SignBetweenDigits,
    /// A number that needs a unit.
    #[error("this number has no unit")]
    NumberWithoutUnit,
    /// An empty unit.
    #[error("there is no unit")]
    NoUnit,
    /// A unit of angles in a time whose factor is ambiguous.
    #[error("revolutions or radians in this time")]
    AmbiguousRotation,
    /// A unit of another dimension.
    #[error("expected {expected}, found {found}")]
    OtherDimension {
        /// Name of the dimension of the quantity.
        expected: &'static str,
        /// Name of the dimension of the unit.
        found: &'static str,
    },
    /// A unit of a dimension without a name.
    #[error("expected {expected}, found something in {}", found.in_base_units())]
    UnnamedDimension {
        /// Name of the dimension of the quantity.
        expected: &'static str,
        /// Exponents of the unit.
        found: Exponents,
    },
    /// A character that occurs in no unit.
    #[error("unexpected character in a unit")]
    UnexpectedCharacter,
    /// A product after a division.
    #[error("a product after \"/\" can be read in two ways")]
    ProductAfterDivision,
    /// Exponents that no unit in use has.
    #[error("no such unit is in use")]
    NotInUse,
    /// Too many factors for a unit.
    #[error("too many factors in one unit")]
    TooManyFactors,
    /// A parenthesis without its partner.
    #[error("this parenthesis is not closed")]
    OpenParenthesis,
    /// A power that gives an exponent other than a half or whole number.
    #[error("no unit of this grammar has that power")]
    ImpossiblePower,
    /// A missing name.
    #[error("expected the name of a unit")]
    NoName,
    /// A missing or impossible exponent.
    #[error("expected an exponent such as 2, -1 or 0.5")]
    NoExponent,
    /// An unknown name of a unit.
    #[error("unknown unit `{0}`")]
    UnknownUnit(String),
    /// A negative or infinite price.
    #[error("a price is a number that is not negative")]
    NegativePrice,
    /// A price without a currency.
    #[error("this price has no currency")]
    NoCurrency,
    /// An unknown code of a currency.
    #[error("there is no such currency")]
    UnknownCurrency,
    /// A price per length for a piece.
    #[error("this is a price per length; expected a price per piece")]
    PricePerLength,
    /// A price per piece for a length.
    #[error("this is a price per piece; expected a price per length")]
    PricePerPiece,
}

/// Text that is expected in place of a wrong one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QuantityExpectation {
    /// A quantity of a dimension.
    #[error("{name}, such as {examples}")]
    OfDimension {
        /// Name of the dimension.
        name: &'static str,
        /// Example quantities.
        examples: &'static str,
    },
    /// A price per piece.
    #[error("a price such as \"180 EUR\"")]
    Price,
    /// A price per length.
    #[error("a price for a length, such as \"40 EUR/m\"")]
    PriceForLength,
}

/// Remedy of a text that is not a quantity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QuantityHint {
    /// Unit with a similar spelling.
    #[error("did you mean `{0}`?")]
    NearUnit(&'static str),
    /// Currency with a similar spelling.
    #[error("did you mean {0}?")]
    NearCurrency(&'static str),
    /// Remedy of an unknown currency.
    #[error("write its code of three letters, such as EUR or USD")]
    CodeOfCurrency,
    /// Remedy of a number without a unit.
    #[error("add one, or write {bare} without quotes for {si}")]
    AddUnit {
        /// The number.
        bare: String,
        /// The SI unit.
        si: &'static str,
    },
    /// Remedy of a current in place of a command.
    #[error("commands are voltages: write the voltage at which the amplifier gives this current")]
    CommandsAreVoltages,
    /// Remedy of an ambiguous rotation.
    #[error("write rpm, Hz, rad/s or rad/min")]
    UnitsOfRotation,
    /// Remedy of a product after a division.
    #[error("put parentheses around what is divided by, as in m3/(s.Pa)")]
    Parentheses,
    /// Remedy of an absolute pressure.
    #[error("pressures are gauge here: subtract the atmospheric pressure")]
    GaugePressures,
    /// Remedy of separators without a reading.
    #[error("write the decimal sign as a point and no separators")]
    NoSeparators,
    /// Readings of a number with its unit.
    #[error("write {}", .0.join(" or "))]
    WriteOneOf(Vec<String>),
}

impl QuantityError {
    pub(crate) fn new(fault: QuantityFault, range: Range<usize>) -> Self {
        QuantityError { fault, range, expected: None, help: None }
    }

    pub(crate) fn help(mut self, help: QuantityHint) -> Self {
        self.help = Some(Box::new(help));
        self
    }
}
