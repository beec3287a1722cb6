//! Fronts of alternatives over a swept number: table, findings, CSV and figure.

use std::borrow::Cow;

use phea_engineering::alternatives::{ColumnKey, ColumnSense};

use super::document::WHOLE;
use super::printed::{PrintedFront, PrintedPoint, PrintedValue};
use super::words::column_name;
use crate::answer::{Csv, OutputFile, quoted};
use crate::document::{Cell, Table};
use crate::figure::{Figure, FrontPlace, ParetoCurve, ParetoFront, ParetoPoint, Words};
use crate::quantity::DisplayUnit;

/// A row for each point.
pub(super) fn table(front: &PrintedFront) -> Table {
    let swept = match front.unit.symbol {
        "1" | "" => front.path.clone(),
        symbol => format!("{}, {symbol}", front.path),
    };
    let columns = (0..front.columns.len()).map(|index| column_words(front, index).to_string());
    let headings = ["alternative".to_string(), swept, "feasible".to_string()].into_iter().chain(columns);
    let mut rows = Table::new(headings.chain(["on the front".to_string()]));
    for (point, dominating) in front.placed() {
        let feasible = match (&point.feasible, point.comparable) {
            (Ok(true), false) => "contradicted".into(),
            (Ok(feasible), _) => Cell::from(if *feasible { "yes" } else { "no" }).marked(*feasible),
            (Err(_), _) => "not known".into(),
        };
        let value = |value: &Result<PrintedValue, String>| match value {
            Ok(found) if found.digits == 0 => Cell::short(found.value, WHOLE, DisplayUnit::ONE),
            Ok(found) => Cell::quantity(found.value, found.digits, found.unit),
            Err(_) => Cell::Missing,
        };
        let place = match (point.is_on_front(dominating), dominating.first()) {
            (true, _) => "yes".into(),
            (false, Some(first)) => Cell::from("dominated by ").then(named(front, *first)),
            (false, None) => Cell::Missing,
        };
        let own = [point.alternative.clone().into(), Cell::number_in(point.value, 4, front.unit), feasible];
        rows.row(own.into_iter().chain(point.values.iter().map(value)).chain([place]));
    }
    rows
}

/// The name of a column, as far as a point has it.
fn column_words(front: &PrintedFront, index: usize) -> Cow<'_, str> {
    let is_known = front.points.iter().any(|point| matches!(point.values.get(index), Some(Ok(_))));
    match front.columns.get(index) {
        Some(column) if is_known && column.key == ColumnKey::Swept => front.path.as_str().into(),
        Some(column) if is_known => column_name(column.key, front.motion).into(),
        Some(column) => column.key.quantity().text(front.motion),
        None => Cow::default(),
    }
}

/// A point by its index.
fn named(front: &PrintedFront, place: usize) -> Cell {
    front.points.get(place).map_or_else(Cell::empty, |point| point_cell(front, point))
}

fn point_cell(front: &PrintedFront, point: &PrintedPoint) -> Cell {
    let value = Cell::quantity(point.value, 4, front.unit);
    Cell::Code(point.alternative.clone()).then(" at ").then(value)
}

fn name_of(front: &PrintedFront, point: &PrintedPoint) -> String {
    point_cell(front, point).text()
}

/// Sentences on the front from its best end in the first column to the other, each step with its
/// price; on points without values and their reasons; on values that were not reached.
pub(super) fn findings(front: &PrintedFront) -> Vec<String> {
    let on_front = front.placed().filter(|(point, dominating)| point.is_on_front(dominating));
    let mut on_front: Vec<&PrintedPoint> = on_front.map(|(point, _)| point).collect();
    let first = |point: &PrintedPoint| point.numbers().and_then(|numbers| numbers.first().copied());
    on_front.sort_by(|one, other| {
        let [one, other] = [one, other].map(|point| first(point).unwrap_or_default());
        match front.columns.first().map(|column| column.sense) {
            Some(ColumnSense::More) => other.total_cmp(&one),
            _ => one.total_cmp(&other),
        }
    });
    let mut sentences = match on_front.as_slice() {
        [] if front.points.iter().any(|point| point.comparable) => {
            vec!["no point is on a front: none has a value in every column".to_string()]
        }
        [] => {
            vec![
                "no point is on a front: none satisfies every specification, in the nonlinear simulation too"
                    .to_string(),
            ]
        }
        [only] => vec![format!("{} dominates every other feasible point", name_of(front, only))],
        several => several.windows(2).map(|pair| step(front, pair[0], pair[1])).collect(),
    };
    for point in &front.points {
        if let Some(reason) = point.values.iter().find_map(|value| value.as_ref().err()) {
            sentences.push(format!("{}: {}", name_of(front, point), reason));
        }
    }
    if front.not_reached > 0 {
        sentences.push(format!("{} points were not reached", front.not_reached));
    }
    sentences
}

/// A step from one point of the front to the next: its cost and its gain.
fn step(front: &PrintedFront, from: &PrintedPoint, to: &PrintedPoint) -> String {
    let changes = from.values.iter().zip(&to.values).enumerate().filter_map(|(index, (from, to))| {
        let (from, to) = (from.as_ref().ok()?, to.as_ref().ok()?);
        let words = column_words(front, index);
        (from.value != to.value).then(|| format!("{words} {} in place of {}", text(to), text(from)))
    });
    let changes: Vec<String> = changes.collect();
    let changed = if changes.is_empty() { "no difference".to_string() } else { changes.join(", ") };
    format!("{} instead of {}: {changed}", name_of(front, to), name_of(front, from))
}

fn text(found: &PrintedValue) -> String {
    match found.digits {
        0 => found.value.to_string(),
        digits => found.unit.text(found.value, digits),
    }
}

/// A row for each point, in SI; a value that does not exist is empty.
pub(super) fn csv(front: &PrintedFront) -> OutputFile {
    let keys: Vec<_> = front.columns.iter().map(|column| column.key.quantity().text(front.motion)).collect();
    let mut csv = Csv::new(&format!("name,value,feasible,comparable,{},on_front", keys.join(",")));
    for (point, dominating) in front.placed() {
        let feasible = point.feasible.as_ref().map_or(String::new(), |feasible| feasible.to_string());
        let value = |value: &Result<PrintedValue, String>| {
            value.as_ref().map_or(String::new(), |found| found.value.to_string())
        };
        csv.cells(&[&quoted(&point.alternative), &point.value, &feasible, &point.comparable]);
        point.values.iter().for_each(|found| csv.cells(&[&value(found)]));
        csv.row(&[&point.is_on_front(dominating)]);
    }
    OutputFile::new("front.csv", csv.text())
}

/// The points of every alternative; `None` if no point has all values.
pub(super) fn figure(front: &PrintedFront) -> Option<Figure> {
    let mut curves: Vec<ParetoCurve> = Vec::new();
    for (point, dominating) in front.placed() {
        let Some(values) = point.numbers() else { continue };
        let place = match (point.is_on_front(dominating), point.comparable) {
            (true, _) => FrontPlace::OnFront,
            (false, true) => FrontPlace::Dominated,
            (false, false) => FrontPlace::NotToBeHad,
        };
        let drawn = ParetoPoint { values, label: front.unit.text(point.value, 4), place };
        match curves.last_mut().filter(|curve| curve.name == point.alternative) {
            Some(curve) => curve.points.push(drawn),
            None => curves.push(ParetoCurve { name: point.alternative.clone(), points: vec![drawn] }),
        }
    }
    let unit = |index: usize| {
        let known = front.points.iter().find_map(|point| point.values.get(index)?.as_ref().ok());
        known.map_or(DisplayUnit::ONE, |found| found.unit)
    };
    let columns = (0..front.columns.len()).map(|index| (column_words(front, index).to_string(), unit(index)));
    let chart = ParetoFront { columns: columns.collect(), curves };
    let caption = format!(
        "Each alternative over {}, every point with a controller of its own. Points on the front are dominated by no other.",
        front.path
    );
    let words = Words::new("front", format!("Front over {}", front.path), caption);
    (!chart.curves.is_empty()).then(|| chart.draw(&words))
}
