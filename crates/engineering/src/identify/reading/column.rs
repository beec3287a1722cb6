//! Which column is what, in which unit.

use super::sheet::Sheet;
use crate::family::measured::table::MeasuredCell as Cell;
use crate::project::{Findings, Place, RawFinding};
use crate::quantity::{self, Dimension, FLOW, PRESSURE, TIME, VOLTAGE};
use crate::spelling::nearest;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Time,
    Command,
    SupplyPressure,
    TankPressure,
    PressureA,
    PressureB,
    LeakFlow,
    Flow,
}

impl Quantity {
    const ALL: [(&'static str, Quantity); 8] = [
        ("time", Quantity::Time),
        ("command", Quantity::Command),
        ("supply_pressure", Quantity::SupplyPressure),
        ("tank_pressure", Quantity::TankPressure),
        ("pressure_a", Quantity::PressureA),
        ("pressure_b", Quantity::PressureB),
        ("leak_flow", Quantity::LeakFlow),
        ("flow", Quantity::Flow),
    ];

    fn name(self) -> &'static str {
        Quantity::ALL.iter().find(|(_, quantity)| *quantity == self).map_or("", |(name, _)| name)
    }

    fn dimension(self) -> &'static Dimension {
        match self {
            Quantity::Time => &TIME,
            Quantity::Command => &VOLTAGE,
            Quantity::LeakFlow | Quantity::Flow => &FLOW,
            _ => &PRESSURE,
        }
    }

    /// Greatest magnitude in SI that a test of a valve has: 11 days, 1000 V, 2000 bar, 6000 L/min.
    fn plausible(self) -> f64 {
        match self {
            Quantity::Time => 1e6,
            Quantity::Command => 1e3,
            Quantity::LeakFlow | Quantity::Flow => 0.1,
            _ => 2e8,
        }
    }
}

/// Units as names of columns have them, and as quantities do.
const UNITS: [(&str, &str); 17] = [
    ("s", "s"),
    ("ms", "ms"),
    ("min", "min"),
    ("v", "V"),
    ("mv", "mV"),
    ("percent", "%"),
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
];

/// A column that is used.
pub(super) struct Column {
    pub(super) quantity: Quantity,
    index: usize,
    unit: String,
}

/// What a name means, and what of it is left for the unit.
pub(super) fn stem_of(name: &str) -> Option<(Quantity, String)> {
    let plain: String = name.trim().to_lowercase().replace([' ', '-'], "_");
    let mut stems: Vec<_> = Quantity::ALL.to_vec();
    // the longest first: `pressure_a` before what it could begin with
    stems.sort_by_key(|(stem, _)| std::cmp::Reverse(stem.len()));
    stems.into_iter().find_map(|(stem, quantity)| {
        let rest = plain.strip_prefix(stem)?;
        let unit = rest.trim_matches(['_', '[', ']', '(', ')']);
        let separated = rest.is_empty() || rest.starts_with(['_', '[', '(']);
        separated.then(|| (quantity, unit.to_string()))
    })
}

/// The columns that are used, in the order of the file; at least time and command.
pub(super) fn columns(sheet: &Sheet<'_>, findings: &mut Findings) -> Option<Vec<Column>> {
    let before = findings.error_count();
    let mut found: Vec<Column> = Vec::new();
    for (index, cell) in sheet.header.iter().enumerate() {
        let Some((quantity, suffix)) = stem_of(cell.text) else { continue };
        if found.iter().any(|column| column.quantity == quantity) {
            findings.push(RawFinding::error(cell.place, format!("a second column of `{}`", quantity.name())));
            continue;
        }
        let below = sheet.units.as_ref().and_then(|units| units.get(index)).map(|cell| cell.text);
        if let Some(unit) = unit_of(quantity, &suffix, below, cell, findings) {
            found.push(Column { quantity, index, unit });
        }
    }
    for quantity in [Quantity::Time, Quantity::Command] {
        if findings.error_count() == before && !found.iter().any(|column| column.quantity == quantity) {
            let missing =
                RawFinding::error(sheet.header_place(), format!("there is no column `{}`", quantity.name()));
            let names = || sheet.header.iter().map(|cell| cell.text);
            let near = nearest(quantity.name(), names()).map(|near| format!("did you mean `{near}`?"));
            findings.push(missing.maybe_help(near));
        }
    }
    let leak = found.iter().any(|column| column.quantity == Quantity::LeakFlow);
    if leak && found.iter().any(|column| column.quantity == Quantity::Flow) {
        let message = "`leak_flow` is of blocked ports, `flow` of joined ones: one file holds one test";
        findings.push(RawFinding::error(sheet.header_place(), message));
    }
    (findings.error_count() == before).then_some(found)
}

/// The unit of a column: of its name, or below it.
fn unit_of(
    quantity: Quantity,
    suffix: &str,
    below: Option<&str>,
    cell: &Cell<'_>,
    findings: &mut Findings,
) -> Option<String> {
    let written = if suffix.is_empty() {
        below.map(|unit| unit.trim_matches(['[', ']', '(', ')']))
    } else {
        Some(suffix)
    };
    let refuse = |message: String| {
        let known = UNITS
            .iter()
            .filter(|(_, unit)| is_of(quantity, unit))
            .map(|(name, _)| format!("`{}_{name}`", quantity.name()));
        RawFinding::error(cell.place, message)
            .expected(format!("one of {}", known.collect::<Vec<_>>().join(", ")))
    };
    let Some(written) = written.filter(|unit| !unit.is_empty()) else {
        findings.push(refuse(format!("`{}` has no unit", cell.text)));
        return None;
    };
    let plain = written.to_lowercase().replace('/', "_per_");
    let named = UNITS.iter().find(|(name, _)| *name == plain).map_or(written, |(_, unit)| unit);
    if is_of(quantity, named) {
        return Some(named.to_string());
    }
    findings.push(refuse(format!("`{written}` is no unit of {}", quantity.dimension().name)));
    None
}

/// Whether a unit measures it; a command may be in percent of the nominal voltage.
fn is_of(quantity: Quantity, unit: &str) -> bool {
    (quantity == Quantity::Command && unit == "%")
        || quantity::parse(&format!("1 {unit}"), quantity.dimension()).is_ok()
}

impl Column {
    /// Where its value stands in a row.
    pub(super) fn place(&self, row: &[Cell<'_>]) -> Place {
        row.get(self.index).map(|cell| cell.place).unwrap_or_default()
    }

    /// SI; what is no number, and no number of a test, is reported.
    pub(super) fn value(
        &self,
        row: &[Cell<'_>],
        sheet: &Sheet<'_>,
        nominal_voltage: f64,
        findings: &mut Findings,
    ) -> Option<f64> {
        let cell = row.get(self.index)?;
        let Some(number) = sheet.number(cell) else {
            let message = match cell.text {
                "" => format!("`{}` has a gap here", self.quantity.name()),
                text => format!("`{text}` is no number"),
            };
            findings
                .push(RawFinding::error(cell.place, message).expected(format!("a number in {}", self.unit)));
            return None;
        };
        let value = match (self.quantity, self.unit.as_str()) {
            (Quantity::Command, "%") => number / 100.0 * nominal_voltage,
            (quantity, unit) => quantity::parse(&format!("{number:e} {unit}"), quantity.dimension()).ok()?,
        };
        if value.abs() > self.quantity.plausible() {
            let message =
                format!("{} {} is no {} of a valve test", cell.text, self.unit, self.quantity.name());
            let found = RawFinding::error(cell.place, message);
            findings.push(found.help("is the unit of the column right?"));
            return None;
        }
        Some(value)
    }
}
