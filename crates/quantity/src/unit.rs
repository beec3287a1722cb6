//! Units, with exact factors.

use super::dimension::Exponents;

/// Unit: `numerator / denominator · 10^ten · (2π)^turns` of its SI unit, all whole numbers, so
/// exact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    pub(crate) names: &'static [&'static str],
    pub(crate) exponents: Exponents,
    pub(crate) numerator: u64,
    pub(crate) denominator: u64,
    pub(crate) ten: i32,
    pub(crate) turns: i32,
    pub(crate) prefixes: bool,
}

const fn unit(names: &'static [&'static str], exponents: Exponents, numerator: u64, ten: i32) -> Unit {
    Unit { names, exponents, numerator, denominator: 1, ten, turns: 0, prefixes: false }
}

impl Unit {
    const fn over(mut self, denominator: u64) -> Unit {
        self.denominator = denominator;
        self
    }

    const fn turns(mut self) -> Unit {
        self.turns = 1;
        self
    }

    const fn prefixed(mut self) -> Unit {
        self.prefixes = true;
        self
    }
}

const LENGTH: Exponents = Exponents::whole(0, 1, 0, 0, 0);
const VOLUME: Exponents = Exponents::whole(0, 3, 0, 0, 0);
const FLOW: Exponents = Exponents::whole(0, 3, -1, 0, 0);
const MASS: Exponents = Exponents::whole(1, 0, 0, 0, 0);
const TIME: Exponents = Exponents::whole(0, 0, 1, 0, 0);
const FORCE: Exponents = Exponents::whole(1, 1, -2, 0, 0);
const PRESSURE: Exponents = Exponents::whole(1, -1, -2, 0, 0);
const ANGLE: Exponents = Exponents::whole(0, 0, 0, 0, 1);
const ROTATION: Exponents = Exponents::whole(0, 0, -1, 0, 1);

/// Table of units by definition: 1 in = 25.4 mm, 1 lb = 0.45359237 kg, g = 9.80665 m/s², 1 gal (US)
/// = 231 in³, all exact.
static UNITS: &[Unit] = &[
    unit(&["m"], LENGTH, 1, 0).prefixed(),
    unit(&["in", "inch", "inches"], LENGTH, 254, -4),
    unit(&["ft"], LENGTH, 3048, -4),
    unit(&["L", "l"], VOLUME, 1, -3).prefixed(),
    unit(&["cc", "ccm"], VOLUME, 1, -6),
    unit(&["gal"], VOLUME, 3_785_411_784, -12),
    unit(&["gpm", "GPM"], FLOW, 3_785_411_784, -12).over(60),
    unit(&["lpm", "LPM"], FLOW, 1, -3).over(60),
    unit(&["g"], MASS, 1, -3).prefixed(),
    unit(&["t"], MASS, 1, 3),
    unit(&["lb", "lbm"], MASS, 45_359_237, -8),
    unit(&["s"], TIME, 1, 0).prefixed(),
    unit(&["sec"], TIME, 1, 0),
    unit(&["min"], TIME, 60, 0),
    unit(&["h"], TIME, 3600, 0),
    unit(&["N"], FORCE, 1, 0).prefixed(),
    unit(&["daN"], FORCE, 1, 1),
    unit(&["kgf", "kp"], FORCE, 980_665, -5),
    unit(&["lbf"], FORCE, 44_482_216_152_605, -13),
    unit(&["kip"], FORCE, 44_482_216_152_605, -10),
    unit(&["Pa"], PRESSURE, 1, 0).prefixed(),
    unit(&["bar"], PRESSURE, 1, 5).prefixed(),
    unit(&["barg"], PRESSURE, 1, 5),
    unit(&["psi", "psig"], PRESSURE, 44_482_216_152_605, -5).over(64516),
    unit(&["ksi"], PRESSURE, 44_482_216_152_605, -2).over(64516),
    unit(&["atm"], PRESSURE, 101_325, 0),
    unit(&["St"], Exponents::whole(0, 2, -1, 0, 0), 1, -4).prefixed(),
    unit(&["V"], Exponents::whole(0, 0, 0, 1, 0), 1, 0).prefixed(),
    unit(&["A"], Exponents::whole(1, 2, -3, -1, 0), 1, 0).prefixed(),
    unit(&["J"], Exponents::whole(1, 2, -2, 0, 0), 1, 0).prefixed(),
    unit(&["W"], Exponents::whole(1, 2, -3, 0, 0), 1, 0).prefixed(),
    unit(&["rad"], ANGLE, 1, 0).prefixed(),
    unit(&["deg", "°", "degree", "degrees"], ANGLE, 1, 0).over(360).turns(),
    unit(&["rev", "U"], ANGLE, 1, 0).turns(),
    unit(&["Hz"], ROTATION, 1, 0).turns().prefixed(),
    unit(&["rpm"], ROTATION, 1, 0).over(60).turns(),
    unit(&["degC", "°C"], Exponents::celsius(1), 1, 0),
    unit(&["%", "percent"], Exponents::NONE, 1, -2),
    unit(&["1"], Exponents::NONE, 1, 0),
];

const PREFIXES: [(&str, i32); 12] = [
    ("n", -9),
    ("u", -6),
    ("\u{b5}", -6),
    ("\u{3bc}", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// All units except the pure number, without prefixes.
pub(crate) fn all() -> impl Iterator<Item = &'static Unit> {
    UNITS.iter().filter(|unit| unit.names != ["1"])
}

/// All prefixes, each one letter.
pub(crate) fn prefixes() -> impl Iterator<Item = &'static str> {
    PREFIXES.iter().map(|(prefix, _)| *prefix)
}

/// Unit of that name, with its prefix included.
pub(crate) fn find(name: &str) -> Option<Unit> {
    let named = |wanted: &str| UNITS.iter().find(|unit| unit.names.contains(&wanted));
    if let Some(unit) = named(name) {
        return Some(*unit);
    }
    PREFIXES.iter().find_map(|(prefix, ten)| {
        let unit = named(name.strip_prefix(prefix)?).filter(|unit| unit.prefixes)?;
        Some(Unit { ten: unit.ten + ten, ..*unit })
    })
}

/// Units that may begin a word of several units, and those that continue it.
pub(crate) const BEGINNINGS: [&str; 6] = ["N", "daN", "Pa", "V", "A", "W"];
pub(crate) const CONTINUATIONS: [&str; 6] = ["mm", "cm", "min", "m", "s", "h"];

/// Units of a word that combines several, as data sheets write `kNm`, `Ns`, `Nms`. Milliseconds are
/// excluded: `Nms` is N.m.s.
pub(crate) fn written_together(name: &str) -> Option<Vec<Unit>> {
    let is_beginning = |unit: &Unit| unit.names.iter().any(|name| BEGINNINGS.contains(name));
    (1..name.len()).filter(|at| name.is_char_boundary(*at)).find_map(|at| {
        let mut units = vec![find(&name[..at]).filter(is_beginning)?];
        let mut rest = &name[at..];
        while let Some(next) = CONTINUATIONS.iter().find(|next| rest.starts_with(**next)) {
            units.push(find(next)?);
            rest = &rest[next.len()..];
        }
        rest.is_empty().then_some(units)
    })
}

/// Candidates for a misspelt unit: every plain name, and the prefixed ones in common use.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    let common = [
        "mm", "cm", "um", "mL", "kg", "ms", "us", "kN", "MN", "kPa", "MPa", "GPa", "mbar", "cSt", "mV", "kV",
        "mrad", "kHz", "kJ", "kW", "dB",
    ];
    let plain = UNITS.iter().flat_map(|unit| unit.names.iter().copied()).filter(|name| *name != "1");
    plain.chain(common)
}
