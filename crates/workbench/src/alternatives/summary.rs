//! A row for each alternative, under the declared load and under each load case: the numbers needed
//! for a decision, before the table of all numbers.

use phea_engineering::alternatives::{AlternativeColumns, Alternatives, ColumnKey, JudgedAlternative};
use phea_engineering::simulate::ScenarioRun;

use super::document::WHOLE;
use crate::document::{Cell, Table};
use crate::quantity::{DisplayUnit, MotionKind};
use crate::simulate::settling_cell;
use crate::verdict_words::agreement_word;

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

/// The motion of all alternatives: none replaces its cylinder by a motor.
pub(super) fn motion_of(found: &Alternatives) -> MotionKind {
    found.judged.first().map(|one| one.loaded.project.motion()).unwrap_or_default()
}

/// The table.
pub(super) fn table(found: &Alternatives) -> Table {
    let groups = groups(found);
    let all: Vec<Vec<AlternativeColumns>> =
        groups.iter().map(|(_, judged)| judged.iter().map(JudgedAlternative::columns).collect()).collect();
    let shown = shown(all.iter().flatten());
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
    for ((name, judged), columns) in groups.iter().zip(&all) {
        if groups.len() > 1 {
            rows.group(*name);
        }
        for (one, columns) in judged.iter().zip(columns) {
            let numbers = shown.iter().map(|(key, _)| number(columns, *key));
            let own = [one.name.clone().into(), specifications(one), machine(one)];
            rows.row(own.into_iter().chain(numbers));
        }
    }
    rows
}

/// The word for the settling times of some runs, with the bands in which they settle.
pub(super) fn settling<'a>(
    all: impl Iterator<Item = &'a JudgedAlternative>,
    counts: impl Fn(&ScenarioRun) -> bool,
) -> Cell {
    let runs = all.filter_map(|one| one.runs.as_ref().ok()).flatten().filter(|run| counts(run));
    let metrics = runs.flat_map(|run| &run.windows).map(|(_, metrics)| metrics);
    let settled = metrics.filter(|metrics| metrics.settling_time_s.is_ok());
    settling_cell(settled.map(|metrics| metrics.settling_band_percent))
}

/// The declared load and the load cases, each with its alternatives.
pub(super) fn groups(found: &Alternatives) -> Vec<(&str, &[JudgedAlternative])> {
    let cases = found.cases.iter().map(|case| (case.name.as_str(), case.judged.as_slice()));
    std::iter::once((DECLARED_LOAD, found.judged.as_slice())).chain(cases).collect()
}

/// The columns for which some alternative has a value.
fn shown<'c>(all: impl Iterator<Item = &'c AlternativeColumns> + Clone) -> Vec<(ColumnKey, &'static str)> {
    let has = |key: ColumnKey| all.clone().any(|columns| columns.worst(key).is_some());
    COMPARED_AT_A_GLANCE.into_iter().filter(|(key, _)| has(*key)).collect()
}

/// The worst value of a column, as the table of all numbers prints it.
fn number(columns: &AlternativeColumns, key: ColumnKey) -> Cell {
    let (Some(value), Some(column)) = (columns.worst(key), columns.first(key)) else { return Cell::Missing };
    match column.digits {
        0 => Cell::short(value, WHOLE, DisplayUnit::ONE),
        digits => Cell::quantity(value, digits, column.unit),
    }
}

/// Cell that shows whether the specifications are met, or by how much they are missed.
fn specifications(one: &JudgedAlternative) -> Cell {
    let columns = one.columns();
    let relaxation = columns.first(ColumnKey::Relaxation).and_then(|column| column.value.clone().ok());
    match (one.feasible(), relaxation) {
        (Some(true), _) => Cell::from("met").marked(true),
        (Some(false), Some(relaxation)) => {
            let by = Cell::quantity(relaxation, 2, DisplayUnit::DECIBEL);
            Cell::from("missed by ").then(by).marked(false)
        }
        (Some(false), None) => Cell::from("missed").marked(false),
        (None, _) => "not known".into(),
    }
}

/// Cell that shows whether the machine confirms the verdict.
pub(super) fn machine(one: &JudgedAlternative) -> Cell {
    let trial = one.design.as_ref().ok().and_then(|view| view.trial.as_ref());
    trial.map(|trial| Cell::from(agreement_word(trial.agreement())).marked(trial.agreement())).into()
}
