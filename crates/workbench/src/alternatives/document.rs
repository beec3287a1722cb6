//! Alternatives for people: a summary, the findings, then the table of all numbers.

use phea_engineering::alternatives::ColumnKey;

use super::findings::findings;
use super::front;
use super::printed::{
    MarkedOutcome, PassivityStatus, PrintedAlternative, PrintedAlternatives, PrintedColumn, PrintedPart,
    Unprintable, at, parts,
};
use super::summary;
use super::words::column_name;
use crate::document::{Cell, Document, Table};
use crate::quantity::DisplayUnit;

/// The table and the findings, after the most important warnings.
pub(crate) fn output(found: &PrintedAlternatives) -> Document {
    let mut out = Document::default();
    out.warnings(first_warnings(found));
    out.append(document(found));
    out
}

/// The table and the findings; the figures follow.
pub(crate) fn document(found: &PrintedAlternatives) -> Document {
    let mut out = Document::default();
    out.table(summary::table(found));
    out.heading_on_page("Findings");
    out.sentences(findings(found));
    if let Some(front) = &found.front {
        out.heading_on_page("Front");
        out.table(front::table(front));
        out.sentences(front::findings(front));
    }
    out.heading_on_page("All numbers");
    out.table(table(found).in_parts_of(PART));
    out
}

/// Digits of a number that is printed as it is, such as an order.
pub(super) const WHOLE: usize = 17;

/// Number of alternatives side by side on the paper.
const PART: usize = 6;

/// The rigs that their families do not contain, and the remedy.
pub(crate) fn first_warnings(found: &PrintedAlternatives) -> Vec<String> {
    let all = summary::groups(found).into_iter().flat_map(|(_, judged)| judged);
    let mut warnings: Vec<String> = Vec::new();
    for sentence in all.filter_map(|one| one.sentences.outside.clone()) {
        if !warnings.contains(&sentence) {
            warnings.push(sentence);
        }
    }
    warnings
}

/// A row for each column, and a column for each alternative.
fn table(found: &PrintedAlternatives) -> Table {
    let names = found.judged.iter().map(|one| one.name.clone());
    let mut rows = Table::grouped_by("", std::iter::once(String::new()).chain(names));
    let all: Vec<&[PrintedColumn]> = found.judged.iter().map(|one| one.columns.as_slice()).collect();
    let has_rig = found.judged.iter().any(|one| one.has_models);
    for part in parts(&all) {
        let keys = keys(&all, &part);
        let always = part == PrintedPart::Loop || (part == PrintedPart::Rig && has_rig);
        if keys.is_empty() && !always {
            continue;
        }
        rows.group(group(&part));
        if part == PrintedPart::Loop {
            rows.row(words("feasible", found, feasible));
            rows.row(words("stable with its load", found, |one| status(one.stable.as_ref())));
            rows.row(words("nonlinear simulation", found, |one| status(one.machine.as_ref())));
        }
        let settling = summary::settling(found.judged.iter(), |scenario| is_of(scenario, &part));
        for key in keys {
            let name = match key {
                ColumnKey::SettlingTime => settling.clone(),
                key => column_name(key, found.motion).into(),
            };
            let cells = all.iter().map(|columns| cell(columns, &part, key));
            rows.row(std::iter::once(name).chain(cells));
        }
        if part == PrintedPart::Rig && has_rig {
            rows.row(words("passive, open loop", found, |one| passivity(one.passive[0])));
            rows.row(words("passive, closed loop", found, |one| passivity(one.passive[1])));
        }
    }
    rows
}

fn is_of(scenario: &str, part: &PrintedPart) -> bool {
    matches!(part, PrintedPart::Scenario(name) if name == scenario)
}

fn words(name: &str, found: &PrintedAlternatives, of: fn(&PrintedAlternative) -> Cell) -> Vec<Cell> {
    std::iter::once(name.into()).chain(found.judged.iter().map(of)).collect()
}

fn feasible(one: &PrintedAlternative) -> Cell {
    match one.feasible {
        Some(true) => Cell::from("yes").marked(true),
        Some(false) => Cell::from("no").marked(false),
        None => "not known".into(),
    }
}

/// Cell of an outcome.
pub(super) fn status(status: Option<&MarkedOutcome>) -> Cell {
    status.map(MarkedOutcome::cell).into()
}

/// Cell of the passivity of the impedance at the load.
pub(super) fn passivity(status: Option<PassivityStatus>) -> Cell {
    status.map(PassivityStatus::cell).into()
}

/// The keys of a part for which some alternative has a value, or should state one.
fn keys(all: &[&[PrintedColumn]], part: &PrintedPart) -> Vec<ColumnKey> {
    let mut keys = Vec::new();
    let columns = all.iter().copied().flatten().filter(|column| column.part == *part);
    for PrintedColumn { key, .. } in columns.filter(|column| column.is_shown()) {
        if !keys.contains(key) {
            keys.push(*key);
        }
    }
    keys
}

fn cell(columns: &[PrintedColumn], part: &PrintedPart, key: ColumnKey) -> Cell {
    let Some(column) = at(columns, part, key) else { return Cell::Missing };
    match &column.value {
        Ok(value) if key == ColumnKey::WorstMargin => Cell::margin(*value),
        Ok(value) if column.digits == 0 => Cell::short(*value, WHOLE, DisplayUnit::ONE),
        Ok(value) => Cell::quantity(*value, column.digits, column.unit),
        Err(Unprintable::NotStated(words)) => words.as_str().into(),
        Err(Unprintable::Absent) => Cell::Missing,
    }
}

fn group(part: &PrintedPart) -> Cell {
    match part {
        PrintedPart::Loop => "loop".into(),
        PrintedPart::Rig => "rig".into(),
        PrintedPart::Impedance(frequency) => {
            Cell::from("|Z| at ").then(Cell::quantity(*frequency, 4, DisplayUnit::RADIAN_PER_SECOND))
        }
        PrintedPart::Specification(index, subject) => Cell::count(index + 1).then(" ").then(subject.as_str()),
        PrintedPart::Scenario(name) => Cell::Code(name.clone()),
    }
}
