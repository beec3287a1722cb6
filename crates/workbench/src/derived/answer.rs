use super::Derived;
use crate::answer::{Csv, Object, OutputFile, quoted};
use crate::family::{Extreme, VisitedRange};
use crate::project::Loaded;
use crate::replaced::{ReplacedRange, replaced_ranges};
use crate::specification::{CheckedWish, wish_row};

/// What `check` says to programs; `told` are warnings in addition to those of the reader.
pub(crate) fn body(
    loaded: &Loaded,
    derived: &[Derived],
    visited: Option<&[VisitedRange]>,
    wishes: &[CheckedWish],
    told: Vec<String>,
) -> Object {
    let warnings = loaded.warnings.iter().map(|warning| warning.message.clone());
    Object::new()
        .each("derived", derived, row)
        .maybe("visited_box", visited.map(|ranges| ranges.iter().map(range).collect::<Vec<_>>()))
        .maybe("visited_box_evidence", visited.map(|_| "search"))
        .each("replaced", &replaced_ranges(&loaded.project, visited.unwrap_or_default()), replaced)
        .each("wishes", wishes, wish_row)
        .with("warnings", told.into_iter().chain(warnings).collect::<Vec<_>>())
}

fn replaced(range: &ReplacedRange) -> Object {
    Object::new()
        .with("symbol", range.symbol)
        .with("unit", range.unit)
        .with("replaced", range.stated)
        .with("visited", range.visited)
        .with("share", range.share)
        .with("beyond", range.beyond().to_vec())
}

fn row(quantity: &Derived) -> Object {
    let declared = quantity.stated.as_ref().map(|stated| {
        Object::new()
            .with("value", stated.value)
            .with("place", stated.place)
            .maybe("bounds", stated.bounds)
            .with("difference_percent", quantity.difference_percent())
            .with("contradicts", quantity.contradicts())
    });
    Object::new()
        .with("name", quantity.name.as_str())
        .with("group", quantity.group)
        .with("symbol", quantity.symbol)
        .with("value", quantity.value.ok())
        .with("unit", quantity.unit)
        .with("equation", quantity.equation)
        .maybe("declared", declared)
        .maybe("reason", quantity.value.err())
}

fn range(range: &VisitedRange) -> Object {
    Object::new()
        .with("name", range.name)
        .with("symbol", range.symbol)
        .with("unit", range.unit)
        .with("minimum", extreme(&range.minimum))
        .with("maximum", extreme(&range.maximum))
}

fn extreme(extreme: &Extreme) -> Object {
    let mut at: Vec<_> = extreme.at.iter().collect();
    at.sort_by(|one, other| one.0.cmp(&other.0));
    let at = at.into_iter().fold(Object::new(), |all, (name, value)| all.with(name.as_str(), *value));
    Object::new().with("value", extreme.value).with("at", at)
}

/// The list as a table for other programs.
pub fn files(derived: &[Derived]) -> Vec<OutputFile> {
    let mut csv = Csv::new("name,value,unit,equation,stated_value");
    for quantity in derived {
        let stated = quantity.stated.as_ref().map_or(String::new(), |stated| stated.value.to_string());
        let value = quantity.value.unwrap_or(f64::NAN);
        let equation = quoted(&quantity.equation.replace(['{', '}'], ""));
        csv.row(&[&quantity.name, &value, &quantity.unit, &equation, &stated]);
    }
    vec![OutputFile::new("derived.csv", csv.text())]
}
