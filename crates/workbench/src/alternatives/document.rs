//! Alternatives for people: a summary, the findings, then the table of all numbers.

use super::findings::findings;
use super::front;
use super::summary::{self, machine, motion_of};
use super::words::{NOT_STATED, column_name, is_unstated, no_number_words};
use super::{
    AlternativeColumn, AlternativeColumns, Alternatives, ColumnKey, ColumnPart, JudgedAlternative, NoNumber,
};
use crate::caveat::outside_parameters;
use crate::document::{Cell, Document, Table};
use crate::linearize::PortView;
use crate::quantity::{DisplayUnit, significant};
use crate::rig::OutsideParameter;
use crate::simulate::ScenarioRun;
use crate::specification::subject_words;
use phea_qft::verification::Verdict;

/// The table and the findings, after the most important warnings.
pub(crate) fn output(found: &Alternatives) -> Document {
    let mut out = Document::default();
    out.warnings(first_warnings(found));
    out.append(document(found));
    out
}

/// The table and the findings; the figures follow.
pub(crate) fn document(found: &Alternatives) -> Document {
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

/// Number of alternatives side by side on the paper.
const PART: usize = 6;

/// The rigs that their families do not contain, and the remedy.
pub(crate) fn first_warnings(found: &Alternatives) -> Vec<String> {
    let all = summary::groups(found).into_iter().flat_map(|(_, judged)| judged);
    let mut warnings: Vec<String> = Vec::new();
    for sentence in
        all.filter_map(|one| Some(outside_words(&one.name, one.outside.as_ref()?, !one.moved.is_empty())))
    {
        if !warnings.contains(&sentence) {
            warnings.push(sentence);
        }
    }
    warnings
}

/// A sentence on ranges that do not contain the rig of an alternative, whether or not they were
/// moved.
pub(crate) fn outside_words(name: &str, outside: &[OutsideParameter], moved: bool) -> String {
    let remedy = match moved {
        false => "state them in `set`, or let them follow by `recentre = true`",
        true => {
            "`recentre` moved them by what the rigs differ, and the declared rig lies outside of its own: state them in `set`"
        }
    };
    format!(
        "{name}: the ranges of [uncertainty] do not contain its rig ({}): {remedy}",
        outside_parameters(outside)
    )
}

/// A row for each column, and a column for each alternative.
fn table(found: &Alternatives) -> Table {
    let names = found.judged.iter().map(|one| one.name.clone());
    let mut rows = Table::grouped_by("", std::iter::once(String::new()).chain(names));
    let all: Vec<AlternativeColumns> = found.judged.iter().map(JudgedAlternative::columns).collect();
    let motion = motion_of(found);
    let has_rig = found.judged.iter().any(|one| one.linearization.is_ok());
    for part in parts(&all) {
        let keys = keys(&all, &part);
        let always = part == ColumnPart::Loop || (part == ColumnPart::Rig && has_rig);
        if keys.is_empty() && !always {
            continue;
        }
        rows.group(group(&part));
        if part == ColumnPart::Loop {
            rows.row(words("feasible", found, feasible));
            rows.row(words("stable with its load", found, stable));
            rows.row(words("nonlinear simulation", found, machine));
        }
        let settling = summary::settling(found.judged.iter(), |run| is_of(run, &part));
        for key in keys {
            let name =
                if key == ColumnKey::SettlingTime { settling.as_str() } else { column_name(key, motion) };
            let cells = all.iter().map(|columns| cell(columns, &part, key));
            rows.row(std::iter::once(Cell::from(name)).chain(cells));
        }
        if part == ColumnPart::Rig && has_rig {
            rows.row(words("passive, open loop", found, |one| port(one, false)));
            rows.row(words("passive, closed loop", found, |one| port(one, true)));
        }
    }
    rows
}

fn is_of(run: &ScenarioRun, part: &ColumnPart) -> bool {
    matches!(part, ColumnPart::Scenario(name) if *name == run.name)
}

fn words(name: &str, found: &Alternatives, of: fn(&JudgedAlternative) -> Cell) -> Vec<Cell> {
    std::iter::once(name.into()).chain(found.judged.iter().map(of)).collect()
}

fn feasible(one: &JudgedAlternative) -> Cell {
    match one.feasible() {
        Some(true) => Cell::from("yes").marked(true),
        Some(false) => Cell::from("no").marked(false),
        None => "not known".into(),
    }
}

/// Cell that shows whether every plant of the family, with the declared load, is stable in the
/// designed loop.
pub(super) fn stable(one: &JudgedAlternative) -> Cell {
    let view = one.design.as_ref().ok();
    match view.map(|view| view.designed.view.audit.stability.verdict) {
        Some(Verdict::Met) => Cell::from("yes").marked(true),
        Some(Verdict::Violated) => Cell::from("no").marked(false),
        Some(Verdict::NotProven) => "not proven".into(),
        None => Cell::Missing,
    }
}

/// Cell that shows whether the impedance at the load is passive, or the number of bands in which it
/// is not.
pub(super) fn port(one: &JudgedAlternative, closed: bool) -> Cell {
    let Ok(found) = &one.linearization else { return Cell::Missing };
    let designed = found.closed_loop.as_ref().filter(|_| one.deployed.is_ok());
    let view: Option<&PortView> = if closed { designed } else { Some(&found.open_loop) };
    let Some(report) = view.map(|view| &view.passivity) else { return Cell::Missing };
    match (report.passive, report.bands.first(), report.bands.len()) {
        (true, ..) => "yes".into(),
        (false, Some(band), 1) => {
            let [from, to] =
                [band.from_rad_per_s, band.to_rad_per_s].map(|end| DisplayUnit::HERTZ.number(end, 3));
            format!("not in {from} to {to} Hz").into()
        }
        (false, None, _) => "no".into(),
        (false, Some(_), bands) => format!("not in {bands} bands").into(),
    }
}

/// The parts of all alternatives, in the order in which they first come.
pub(super) fn parts(all: &[AlternativeColumns]) -> Vec<ColumnPart> {
    let mut parts = Vec::new();
    for (part, _) in all.iter().flat_map(|columns| &columns.0) {
        if !parts.contains(part) {
            parts.push(part.clone());
        }
    }
    parts
}

/// The keys of a part for which some alternative has a value, or should state one.
fn keys(all: &[AlternativeColumns], part: &ColumnPart) -> Vec<ColumnKey> {
    let mut keys = Vec::new();
    let columns = all.iter().flat_map(|columns| &columns.0).filter(|(own, _)| own == part);
    for (_, AlternativeColumn { key, .. }) in columns.filter(|(_, column)| is_shown(column)) {
        if !keys.contains(key) {
            keys.push(*key);
        }
    }
    keys
}

fn is_shown(column: &AlternativeColumn) -> bool {
    column.value.as_ref().map_or_else(is_unstated, |_| true)
}

/// A column of an alternative.
pub(super) fn at<'c>(
    columns: &'c AlternativeColumns,
    part: &ColumnPart,
    key: ColumnKey,
) -> Option<&'c AlternativeColumn> {
    columns.0.iter().find(|(own, column)| own == part && column.key == key).map(|(_, column)| column)
}

fn cell(columns: &AlternativeColumns, part: &ColumnPart, key: ColumnKey) -> Cell {
    let Some(column) = at(columns, part, key) else { return Cell::Missing };
    match &column.value {
        Ok(value) if key == ColumnKey::WorstMargin => Cell::margin(*value),
        Ok(value) if column.digits == 0 => value.to_string().into(),
        Ok(value) => Cell::quantity(*value, column.digits, column.unit),
        // the table of its part lists what is missing
        Err(reason @ NoNumber::Parts(_)) if is_unstated(reason) => no_number_words(reason).into(),
        Err(reason) if is_unstated(reason) => NOT_STATED.into(),
        Err(_) => Cell::Missing,
    }
}

fn group(part: &ColumnPart) -> String {
    match part {
        ColumnPart::Loop => "loop".to_string(),
        ColumnPart::Rig => "rig".to_string(),
        ColumnPart::Impedance(frequency) => format!("|Z| at {} rad/s", significant(*frequency, 4)),
        ColumnPart::Specification(index, name) => format!("{} {}", index + 1, subject_words(*name)),
        ColumnPart::Scenario(name) => name.clone(),
    }
}
