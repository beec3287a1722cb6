//! Quantities in text: `"70 bar"`, `"4.7 cc/ft"`, `"9.8 L/min"`, and back.
//!
//! The only place of the workspace with factors between units. Internally, every number is SI.
//! Pressures are gauge unless the name of their key includes `absolute`.

mod celsius;
mod dimension;
mod display_unit;
mod error;
mod exact;
mod known_unit;
mod motion;
mod parse;
mod pattern;
mod price;
mod print;
mod quantity_name;
mod scale;
mod separators;
mod shortest;
mod significant;
pub mod spelling;
mod unit;
mod unit_of_name;
mod units;

pub use celsius::ZERO_CELSIUS;
pub use dimension::*;
pub use display_unit::DisplayUnit;
pub use error::{QuantityError, QuantityExpectation, QuantityFault, QuantityHint};
pub use known_unit::known_unit;
pub use motion::{MotionKind, MotionSymbols, MotionWords};
pub use parse::parse;
pub use pattern::{any_quantity_pattern, compound_unit_pattern, single_unit_pattern};
pub use price::{Currency, Price, PricedBy, parse_price, price_pattern, print_price};
pub use print::print_bare;
pub use print::{display, fitting, print};
pub use quantity_name::QuantityName;
pub use scale::UnitScale;
pub use significant::significant;
pub use unit_of_name::unit_of_name;
pub use units::Units;
