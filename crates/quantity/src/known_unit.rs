//! Display units by their symbols.

use super::dimension::DIMENSIONS;
use super::display_unit::DisplayUnit;
use super::price::CURRENCIES;
use super::units::SYMBOLS;

/// Display unit of this size, if the symbol is that of a display unit, an SI unit or a currency.
///
/// # Example
/// ```
/// use phea_quantity::{DisplayUnit, known_unit};
/// let unit = DisplayUnit::MEGANEWTON_PER_METRE;
/// assert_eq!(known_unit("MN/m", 1e6), Some(unit));
/// assert_eq!(known_unit("furlong", 201.168), None);
/// ```
pub fn known_unit(symbol: &str, in_si: f64) -> Option<DisplayUnit> {
    let of_dimensions = DIMENSIONS.iter().flat_map(|dimension| dimension.units.iter().chain([&dimension.si]));
    let all = of_dimensions.chain(&SYMBOLS).chain(&CURRENCIES).copied();
    let symbol = all.chain(DisplayUnit::ALL.map(|unit| unit.symbol)).find(|known| *known == symbol)?;
    Some(DisplayUnit { symbol, in_si })
}
