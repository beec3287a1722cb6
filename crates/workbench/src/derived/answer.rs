use std::collections::BTreeMap;

use serde::Serialize;

use super::Derived;
use crate::answer::{self, Number, OutputFile, significant, table};
use crate::family::{Extreme, VisitedRange};
use crate::project::{Loaded, Project};
use crate::specification::{CheckedWish, WishRow};

#[derive(Serialize)]
struct Body<'a> {
    derived: Vec<Row<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    visited_box: Option<Vec<RangeRow<'a>>>,
    wishes: Vec<WishRow>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct Row<'a> {
    name: &'a str,
    group: &'a str,
    symbol: &'a str,
    value: Number,
    unit: &'a str,
    equation: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    declared: Option<DeclaredRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
}

#[derive(Serialize)]
struct RangeRow<'a> {
    name: &'a str,
    symbol: &'a str,
    unit: &'a str,
    minimum: ExtremeRow<'a>,
    maximum: ExtremeRow<'a>,
}

#[derive(Serialize)]
struct ExtremeRow<'a> {
    value: Number,
    at: BTreeMap<&'a str, f64>,
}

#[derive(Serialize)]
struct DeclaredRow {
    value: Number,
    place: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    bounds: Option<[f64; 2]>,
    difference_percent: Number,
    contradicts: bool,
}

impl<'a> From<&'a VisitedRange> for RangeRow<'a> {
    fn from(range: &'a VisitedRange) -> RangeRow<'a> {
        let VisitedRange { name, symbol, unit, minimum, maximum } = range;
        RangeRow { name, symbol, unit, minimum: minimum.into(), maximum: maximum.into() }
    }
}

impl<'a> From<&'a Extreme> for ExtremeRow<'a> {
    fn from(extreme: &'a Extreme) -> ExtremeRow<'a> {
        let at = extreme.at.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        ExtremeRow { value: Number(extreme.value), at }
    }
}

/// The JSON object of `check`; `told` are warnings beside those of the reader.
pub fn json(
    loaded: &Loaded,
    derived: &[Derived],
    visited: Option<&[VisitedRange]>,
    wishes: &[CheckedWish],
    told: Vec<String>,
) -> String {
    let rows = derived.iter().map(|quantity| Row {
        name: &quantity.name,
        group: quantity.group,
        symbol: quantity.symbol,
        value: Number(quantity.value.unwrap_or(f64::NAN)),
        unit: quantity.unit,
        equation: quantity.equation,
        declared: quantity.stated.as_ref().map(|stated| DeclaredRow {
            value: Number(stated.value),
            place: stated.place,
            bounds: stated.bounds,
            difference_percent: Number(quantity.difference_percent().unwrap_or(f64::NAN)),
            contradicts: quantity.contradicts(),
        }),
        reason: quantity.value.err(),
    });
    let warnings = loaded.warnings.iter().map(|warning| warning.message.clone());
    let wishes = wishes.iter().map(WishRow::of);
    let body = Body {
        derived: rows.collect(),
        visited_box: visited.map(|ranges| ranges.iter().map(RangeRow::from).collect()),
        wishes: wishes.collect(),
        warnings: told.into_iter().chain(warnings).collect(),
    };
    answer::json("check", loaded, body)
}

/// The table of `check` for people, and a sentence for each contradiction.
pub fn text(derived: &[Derived]) -> String {
    let mut out = String::new();
    let mut group = "";
    let mut rows = table(&["quantity", "value", "unit", "equation"]);
    for quantity in derived {
        if quantity.group != group {
            if !group.is_empty() {
                out.push_str(&format!("{group}\n{}\n\n", rows.trim_fmt()));
                rows = table(&["quantity", "value", "unit", "equation"]);
            }
            group = quantity.group;
        }
        let value = shown(quantity.value, 5);
        rows.add_row([&quantity.name, &value, quantity.unit, &plain(quantity.equation)]);
    }
    out.push_str(&format!("{group}\n{}\n", rows.trim_fmt()));
    let stated = stated(derived);
    if !stated.is_empty() {
        out.push_str("\nStated by the project and used instead of the derived value\n");
    }
    for quantity in stated {
        out.push_str(&format!("  {}\n", sentence(quantity)));
    }
    out
}

/// The box of linear parameters that the family visits, for people.
pub fn visited_text(project: &Project, ranges: &[VisitedRange]) -> String {
    let mut rows = table(&["quantity", "least", "most", "unit"]);
    for range in ranges {
        let [least, most] = [&range.minimum, &range.maximum].map(|end| significant(end.value, 4));
        rows.add_row([range.symbol, &least, &most, range.unit]);
    }
    let place = |of: &str, symbol: &str, end: &Extreme| {
        let at: Vec<String> = end
            .at
            .iter()
            .map(|(name, value)| format!("{name} = {}", project.in_words(name, *value)))
            .collect();
        (!at.is_empty()).then(|| format!("  {of} {symbol} at {}\n", at.join(", ")))
    };
    let ends = ranges.iter().flat_map(|range| {
        [place("least", range.symbol, &range.minimum), place("most", range.symbol, &range.maximum)]
    });
    let places: String = ends.flatten().collect();
    format!(
        "The box of the family: what its operating points and numbers make of the linear model\n{}\n{places}",
        rows.trim_fmt()
    )
}

/// Difference in percent below which a stated value is unremarkable: it prints as zero.
const UNREMARKABLE: f64 = 0.05;

/// What the project states for quantities that also follow from the rest: contradictions first, then what differs, then
/// the unremarkable.
pub(crate) fn stated(derived: &[Derived]) -> Vec<&Derived> {
    let mut stated: Vec<&Derived> = derived.iter().filter(|quantity| quantity.stated.is_some()).collect();
    stated.sort_by_key(|quantity| match quantity.difference_percent() {
        _ if quantity.contradicts() => 0,
        Some(percent) if percent.abs() < UNREMARKABLE => 2,
        _ => 1,
    });
    stated
}

/// What is stated beside what follows, in a sentence.
pub(crate) fn sentence(quantity: &Derived) -> String {
    let Some(stated) = &quantity.stated else { return String::new() };
    let with_unit = match quantity.unit {
        "1" => significant(stated.value, 4),
        unit => format!("{} {unit}", significant(stated.value, 4)),
    };
    let bounds = stated.bounds.map_or(String::new(), |[minimum, maximum]| {
        format!(", from {} to {}", significant(minimum, 4), significant(maximum, 4))
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
        shown(quantity.value, 4)
    )
}

fn shown(value: Result<f64, &str>, digits: usize) -> String {
    value.map_or("-".to_string(), |value| significant(value, digits))
}

/// An equation without the braces that only typesetting needs.
fn plain(equation: &str) -> String {
    equation.replace(['{', '}'], "")
}

/// The list as a table for other programs.
pub fn files(derived: &[Derived]) -> Vec<OutputFile> {
    let mut csv = String::from("name,value,unit,equation,stated_value\n");
    for quantity in derived {
        let stated = quantity.stated.as_ref().map_or(String::new(), |stated| stated.value.to_string());
        csv.push_str(&format!(
            "{},{},{},\"{}\",{stated}\n",
            quantity.name,
            quantity.value.map_or("NaN".to_string(), |value| value.to_string()),
            quantity.unit,
            plain(quantity.equation)
        ));
    }
    vec![OutputFile { name: "derived.csv".to_string(), bytes: csv.into_bytes() }]
}
