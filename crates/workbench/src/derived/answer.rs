use std::collections::BTreeMap;

use serde::Serialize;

use super::Derived;
use crate::answer::{self, Csv, Number, OutputFile, quoted};
use crate::family::{Extreme, VisitedRange};
use crate::project::Loaded;
use crate::specification::{CheckedWish, WishRow};

#[derive(Serialize)]
struct CheckAnswer<'a> {
    derived: Vec<DerivedAnswer<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    visited_box: Option<Vec<RangeRow<'a>>>,
    wishes: Vec<WishRow>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct DerivedAnswer<'a> {
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
    let rows = derived.iter().map(|quantity| DerivedAnswer {
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
    let body = CheckAnswer {
        derived: rows.collect(),
        visited_box: visited.map(|ranges| ranges.iter().map(RangeRow::from).collect()),
        wishes: wishes.collect(),
        warnings: told.into_iter().chain(warnings).collect(),
    };
    answer::json("check", loaded, body)
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
    vec![csv.file("derived.csv")]
}
