//! A row for each alternative, under the declared load and under each load case: the numbers needed
//! for a decision, before the table of all numbers.

use phea_engineering::alternatives::{ColumnKey, WorstColumns};

use super::document::{WHOLE, status};
use super::printed::{PrintedAlternative, PrintedAlternatives};
use crate::document::{Cell, Table};
use crate::quantity::DisplayUnit;
use crate::simulate::settling_cell;

/// Name of the group of the project's declared load, if there are load cases too.
pub(super) const DECLARED_LOAD: &str = "declared load";

/// Columns for a decision at a glance, with their names for people. The worst value counts if a
/// column exists for several scenarios.
const COMPARED_AT_A_GLANCE: [(ColumnKey, &str); 9] = [
    (ColumnKey::Order, "order of G"),
    (ColumnKey::DelayMargin, "delay tolerated"),
    (ColumnKey::SettlingTime, "settling"),
    (ColumnKey::DisturbancePeak, "disturbance"),
    (ColumnKey::ControlRms, "control rms"),
    (ColumnKey::ControlPeak, "control peak"),
    (ColumnKey::ActuatorLength, "length"),
    (ColumnKey::PartsPrice, "price"),
    (ColumnKey::PartsMass, "mass"),
];

/// The table.
pub(super) fn table(found: &PrintedAlternatives) -> Table {
    let groups = groups(found);
    let shown = shown(groups.iter().flat_map(|(_, judged)| judged.iter()));
    let settling = settling(groups.iter().flat_map(|(_, judged)| judged.iter()), |_| true);
    let words = shown.iter().map(|(key, words)| match *key {
        ColumnKey::SettlingTime => settling.text(),
        _ => (*words).to_string(),
    });
    let headings = ["alternative", "specifications", "nonlinear simulation"].map(String::from);
    let headings = headings.into_iter().chain(words);
    let mut rows = match groups.len() {
        1 => Table::new(headings),
        _ => Table::grouped_by("load", headings),
    };
    for (name, judged) in &groups {
        if groups.len() > 1 {
            rows.group(*name);
        }
        for one in *judged {
            let numbers = shown.iter().map(|(key, _)| number(&one.worst, *key));
            let own = [one.name.clone().into(), specifications(one), status(one.machine.as_ref())];
            rows.row(own.into_iter().chain(numbers));
        }
    }
    rows
}

/// The word for the settling times in some scenarios, with the bands in which they settle.
pub(super) fn settling<'a>(
    all: impl Iterator<Item = &'a PrintedAlternative>,
    counts: impl Fn(&str) -> bool,
) -> Cell {
    let bands = all.flat_map(|one| &one.settling_bands).filter(|(scenario, _)| counts(scenario));
    settling_cell(bands.map(|(_, band_percent)| *band_percent))
}

/// The declared load and the load cases, each with its alternatives.
pub(super) fn groups(found: &PrintedAlternatives) -> Vec<(&str, &[PrintedAlternative])> {
    let cases = found.cases.iter().map(|case| (case.name.as_str(), case.judged.as_slice()));
    std::iter::once((DECLARED_LOAD, found.judged.as_slice())).chain(cases).collect()
}

/// The columns for which some alternative has a value.
fn shown<'p>(all: impl Iterator<Item = &'p PrintedAlternative> + Clone) -> Vec<(ColumnKey, &'static str)> {
    let has = |key: ColumnKey| all.clone().any(|one| one.worst.value(key).is_some());
    COMPARED_AT_A_GLANCE.into_iter().filter(|(key, _)| has(*key)).collect()
}

/// The worst value of a column, as the table of all numbers prints it.
fn number(columns: &WorstColumns, key: ColumnKey) -> Cell {
    let Some(column) = columns.find(key) else { return Cell::Missing };
    let Some(value) = column.value else { return Cell::Missing };
    match column.digits {
        0 => Cell::short(value, WHOLE, DisplayUnit::ONE),
        digits => Cell::quantity(value, digits, column.unit),
    }
}

/// Cell that shows whether the specifications are met, or by how much they are missed.
fn specifications(one: &PrintedAlternative) -> Cell {
    match (one.feasible, one.worst.value(ColumnKey::Relaxation)) {
        (Some(true), _) => Cell::from("met").marked(true),
        (Some(false), Some(relaxation)) => {
            let by = Cell::quantity(relaxation, 2, DisplayUnit::DECIBEL);
            Cell::from("missed by ").then(by).marked(false)
        }
        (Some(false), None) => Cell::from("missed").marked(false),
        (None, _) => "not known".into(),
    }
}
