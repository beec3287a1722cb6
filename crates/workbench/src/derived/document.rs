//! The derived quantities of a project, for people.

use super::Derived;
use crate::answer::significant;
use crate::document::{Cell, Document, StatusMark, Table};
use crate::family::{Extreme, VisitedRange};
use crate::project::{Project, WrittenUnits};
use crate::replaced::{ReplacedRange, replaced_ranges};

/// Every derived quantity, and the values that the project states instead.
pub(crate) fn document(derived: &[Derived], units: &WrittenUnits) -> Document {
    let mut out = Document::default();
    let mut groups: Vec<&str> = derived.iter().map(|quantity| quantity.group).collect();
    groups.dedup();
    for group in groups {
        let own = derived.iter().filter(|quantity| quantity.group == group);
        out.section(
            group,
            Table::new(["quantity", "value", "unit", "equation"]).with(own.map(|one| cells(one, units))),
        );
    }
    let absent = derived.iter().filter_map(|quantity| Some((&quantity.name, quantity.value.err()?)));
    out.sentences(absent.map(|(name, reason)| format!("`{name}`: {reason}")));
    let stated = stated(derived);
    if !stated.is_empty() {
        out.heading("Stated by the project and used instead of the derived value");
        out.explanation("The linear models use these values. Where a stated value and the derived one differ, the nonlinear simulation follows the derived one.");
        out.marked(
            stated
                .into_iter()
                .map(|one| (one.contradicts().then_some(StatusMark::Bad), sentence(one, units))),
        );
    }
    out
}

fn cells(quantity: &Derived, units: &WrittenUnits) -> [Cell; 4] {
    let displayed = |value: f64| units.displayed(&quantity.name, value, quantity.unit);
    let (_, unit) = displayed(quantity.value.unwrap_or_default());
    [
        Cell::Name {
            name: quantity.name.clone(),
            words: quantity.words.clone(),
            symbol: quantity.symbol.to_string(),
        },
        quantity.value.map_or(Cell::Missing, |value| Cell::number(displayed(value).0, 5)),
        Cell::unit(unit),
        Cell::Equation(quantity.equation.to_string()),
    ]
}

/// Method by which the box was found.
const SEARCHED: &str =
    "found by a search from the members and both sides of null, not proven: the family may reach beyond";

/// The box of linear parameters that the family visits, for people.
pub(crate) fn visited(project: &Project, ranges: &[VisitedRange]) -> Document {
    let mut out = Document::default();
    out.heading(
        "The box of the family: the parameters of the linear model over its operating points and numbers",
    );
    let row = |range: &VisitedRange| {
        let [least, most] = [&range.minimum, &range.maximum].map(|end| Cell::number(end.value, 4));
        [range.symbol.into(), least, most, Cell::unit(range.unit)]
    };
    out.table(Table::new(["quantity", "least", "most", "unit"]).with(ranges.iter().map(row)));
    let place = |of: &str, symbol: &str, end: &Extreme| {
        let at = end.at.iter().map(|(name, value)| format!("{name} = {}", project.in_words(name, *value)));
        (!end.at.is_empty()).then(|| format!("{of} {symbol} at {}", at.collect::<Vec<_>>().join(", ")))
    };
    let ends = ranges.iter().flat_map(|range| {
        [place("least", range.symbol, &range.minimum), place("most", range.symbol, &range.maximum)]
    });
    out.sentences(ends.flatten());
    out.sentences([SEARCHED.to_string()]);
    let replaced = replaced_ranges(project, ranges);
    if !replaced.is_empty() {
        out.section("The ranges that the family replaces", replaced_table(&replaced));
        out.sentences(replaced_sentences(&replaced));
    }
    out
}

/// The ranges that a family replaces, with the ranges that it visits.
pub(crate) fn replaced_table(ranges: &[ReplacedRange]) -> Table {
    let row = |range: &ReplacedRange| {
        let ends = [range.stated[0], range.stated[1], range.visited[0], range.visited[1]];
        let [least, most, low, high] = ends.map(|end| Cell::number(end, 3));
        let percent = Cell::from(format!("{} %", significant(100.0 * range.fraction, 2)));
        [range.symbol.into(), least, most, low, high, Cell::unit(range.unit), percent]
    };
    let headings = ["quantity", "replaced from", "to", "visited from", "to", "unit", "share visited"];
    Table::new(headings).with(ranges.iter().map(row))
}

/// Ranges in which the family extends beyond those that it replaces.
pub(crate) fn replaced_sentences(ranges: &[ReplacedRange]) -> Vec<String> {
    let sentence = |range: &ReplacedRange| {
        let side = match range.beyond() {
            [false, false] => return None,
            [true, false] => "below",
            [false, true] => "above",
            [true, true] => "on both sides of",
        };
        let symbol = range.symbol;
        Some(format!(
            "The rig reaches values of {symbol} {side} the range: a controller designed for the stated range has not been judged for all plants of the rig."
        ))
    };
    ranges.iter().filter_map(sentence).collect()
}

/// Difference in percent below which a stated value is unremarkable: it prints as zero.
const UNREMARKABLE: f64 = 0.05;

/// The values that the project states for derived quantities: contradictions first, then those that
/// differ, then the unremarkable ones.
fn stated(derived: &[Derived]) -> Vec<&Derived> {
    let mut stated: Vec<&Derived> = derived.iter().filter(|quantity| quantity.stated.is_some()).collect();
    stated.sort_by_key(|quantity| match quantity.difference_percent() {
        _ if quantity.contradicts() => 0,
        Some(percent) if percent.abs() < UNREMARKABLE => 2,
        _ => 1,
    });
    stated
}

/// A stated value next to the derived one, in a sentence.
fn sentence(quantity: &Derived, units: &WrittenUnits) -> String {
    let Some(stated) = &quantity.stated else { return String::new() };
    let displayed = |value: f64| significant(units.displayed(&quantity.name, value, quantity.unit).0, 4);
    let with_unit = match units.displayed(&quantity.name, stated.value, quantity.unit).1.as_str() {
        "1" => displayed(stated.value),
        unit => format!("{} {unit}", displayed(stated.value)),
    };
    let bounds = stated.bounds.map_or(String::new(), |[minimum, maximum]| {
        format!(", from {} to {}", displayed(minimum), displayed(maximum))
    });
    let own = if quantity.outside_own_bounds() { "; the stated value lies outside these bounds" } else { "" };
    let verdict = match (quantity.contradicts_derived(), stated.bounds) {
        (true, Some(_)) => "; the derived value lies outside these bounds",
        (true, None) => "; they contradict each other",
        (false, _) => "",
    };
    let difference = quantity.difference_percent().filter(|percent| percent.is_finite());
    let percent = difference.map_or(String::new(), |percent| format!(" ({percent:+.1} %)"));
    format!(
        "{} = {} in {}{bounds}; derived {}{percent}{own}{verdict}.",
        quantity.symbol,
        with_unit,
        stated.place,
        quantity.value.map_or("-".to_string(), displayed)
    )
}
