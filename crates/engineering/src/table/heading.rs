//! Parts of a heading: a name and a unit.

use crate::quantity::{Dimension, UnitScale};

/// Spellings of units in names of columns, and as quantities.
const UNITS: [(&str, &str); 42] = [
    ("s", "s"),
    ("ms", "ms"),
    ("min", "min"),
    ("v", "V"),
    ("mv", "mV"),
    ("pa", "Pa"),
    ("kpa", "kPa"),
    ("mpa", "MPa"),
    ("bar", "bar"),
    ("psi", "psi"),
    ("l_per_min", "L/min"),
    ("ml_per_min", "mL/min"),
    ("m3_per_s", "m3/s"),
    ("cm3_per_s", "cm3/s"),
    ("gpm", "gpm"),
    ("l_per_s", "L/s"),
    ("m", "m"),
    ("mm", "mm"),
    ("n", "N"),
    ("kn", "kN"),
    ("hz", "Hz"),
    ("rad_per_s", "rad/s"),
    ("db", "dB"),
    ("deg", "deg"),
    ("rad", "rad"),
    ("ml", "mL"),
    ("cm3", "cm3"),
    ("m3", "m3"),
    ("percent", "%"),
    ("sec", "s"),
    ("volt", "V"),
    ("volts", "V"),
    ("second", "s"),
    ("seconds", "s"),
    ("newton", "N"),
    ("newtons", "N"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radians", "rad"),
    ("hertz", "Hz"),
    ("ma", "mA"),
    ("a", "A"),
];
/// Number of them that are not suggested.
const UNUSUAL: usize = 14;

/// Remainder of a heading next to a name: its unit, or nothing. `None` if the heading has another
/// name.
pub(super) fn unit_beside<'h>(heading: &'h str, name: &str) -> Option<&'h str> {
    let heading = heading.trim();
    let plain = |byte: u8| if matches!(byte, b' ' | b'-') { b'_' } else { byte.to_ascii_lowercase() };
    let begins = heading.len() >= name.len()
        && heading
            .bytes()
            .zip(name.bytes())
            .all(|(written, named)| plain(written) == named.to_ascii_lowercase());
    let rest = heading.get(name.len()..).filter(|_| begins)?;
    let is_separated = rest.is_empty() || rest.starts_with(|sign| BESIDE.contains(&sign));
    let unit = rest.trim_matches(BESIDE);
    is_separated.then(|| unit.strip_prefix("in ").unwrap_or(unit))
}

/// Signs around a unit.
const BESIDE: [char; 14] = ['_', '-', ' ', '\n', ',', ':', '/', '[', ']', '(', ')', '{', '}', '<'];

/// A unit without the brackets around it.
pub(super) fn bare(unit: &str) -> &str {
    unit.trim().trim_matches(['[', ']', '(', ')', '{', '}', '<', '>']).trim()
}

/// Unit that is meant by a heading, in the spelling of quantities.
pub(super) fn unit_meant(written: &str, dimension: &'static Dimension) -> Option<String> {
    let is_unit = |unit: &str| UnitScale::new(unit, dimension).is_ok();
    let lower = written.to_lowercase();
    let in_words = lower.replace('/', "_per_");
    let shortened = lower.replace('_', "_per_");
    let known = [in_words.as_str(), shortened.as_str()].into_iter().find_map(|word| {
        UNITS.iter().find(|(name, unit)| *name == word && is_unit(unit)).map(|(_, unit)| *unit)
    });
    let spelled = [written, lower.as_str()].into_iter().find(|unit| is_unit(unit));
    known.or(spelled).map(str::to_string)
}

/// Suggested endings of names that state a unit, for a heading without one.
pub(super) fn endings(dimension: &'static Dimension) -> impl Iterator<Item = &'static str> {
    let usual = UNITS.iter().take(UNITS.len() - UNUSUAL);
    usual.filter(move |(_, unit)| UnitScale::new(unit, dimension).is_ok()).map(|(name, _)| *name)
}
