//! The answer of `check`.

use phea_engineering::family::{Extreme, VisitedRange};
use phea_engineering::replaced::{ReplacedRange, replaced_ranges};
use phea_engineering::specification::CheckedRequirement;

use super::Derived;
use crate::answer::{Answer, Csv, Entries, OutputFile, quoted, words};
use crate::project::Loaded;
use crate::specification::{CheckedRequirementAnswer, requirement_answer};

/// Quantities that follow from a project, and the warnings about it.
#[derive(Answer)]
pub(crate) struct DerivedAnswer {
    /// Quantities that follow from the project.
    derived: Vec<DerivedQuantityAnswer>,
    /// Ranges of the coefficients of the plant over the family.
    #[answer(optional)]
    visited_box: Option<Vec<VisitedRangeAnswer>>,
    /// Evidence for the visited ranges.
    #[answer(optional)]
    visited_box_evidence: Option<VisitedEvidence>,
    /// Ranges that the project states as replaced by its family.
    replaced: Vec<ReplacedRangeAnswer>,
    /// Requirements in time of tracking limits.
    requirements_in_time: Vec<CheckedRequirementAnswer>,
    /// Warnings about the project.
    warnings: Vec<String>,
}

/// Evidence for the visited ranges.
enum VisitedEvidence {
    Search,
}

words! {
    /// Evidence for the visited ranges.
    VisitedEvidence { Search => "search" }
}

/// Quantity that follows from a project.
#[derive(Answer)]
struct DerivedQuantityAnswer {
    /// Unique name, with dots between its parts.
    name: String,
    /// Chapter of the list.
    group: &'static str,
    /// Symbol as in the notation, such as `K_H`.
    symbol: &'static str,
    /// Value in `unit`; null if it does not exist.
    value: Option<f64>,
    /// SI unit of the value.
    unit: &'static str,
    /// Equation of the value.
    equation: &'static str,
    /// Value that the project states instead.
    #[answer(optional)]
    declared: Option<StatedAnswer>,
    /// Reason for which there is no value.
    #[answer(optional)]
    reason: Option<&'static str>,
}

/// Value that the project states for a quantity that also follows from the rest.
#[derive(Answer)]
struct StatedAnswer {
    /// Stated value.
    value: f64,
    /// Table of the file that states it, such as `[linear]`.
    place: &'static str,
    /// Least and greatest stated value.
    #[answer(optional, interval)]
    bounds: Option<[f64; 2]>,
    /// Difference of the stated value from the derived one, of the latter; null if that does not
    /// exist.
    difference_percent: Option<f64>,
    /// True if the stated value contradicts itself or the derived value.
    contradicts: bool,
}

/// Range of a coefficient of the plant over the family.
#[derive(Answer)]
struct VisitedRangeAnswer {
    /// Name of the coefficient.
    name: &'static str,
    /// Symbol of the coefficient.
    symbol: &'static str,
    /// SI unit of its values.
    unit: &'static str,
    /// Least value.
    minimum: ExtremeAnswer,
    /// Greatest value.
    maximum: ExtremeAnswer,
}

/// Extreme value of a coefficient.
#[derive(Answer)]
struct ExtremeAnswer {
    /// Extreme value.
    value: f64,
    /// Place of the extreme: SI values by the names of the uncertain numbers.
    at: Entries<f64>,
}

/// Range that the project states as replaced by its family, and the range that the family visits.
#[derive(Answer)]
struct ReplacedRangeAnswer {
    /// Symbol of the coefficient.
    symbol: &'static str,
    /// SI unit of its values.
    unit: &'static str,
    /// Replaced range, from low to high.
    #[answer(interval)]
    replaced: [f64; 2],
    /// Visited range, from low to high.
    #[answer(interval)]
    visited: [f64; 2],
    /// Fraction of the replaced range that is visited, of its logarithm where it is spaced by equal
    /// factors.
    fraction: f64,
    /// True if the family goes below the replaced range, and above it.
    beyond: [bool; 2],
}

/// JSON of `check`; `further_warnings` are added to the warnings of the reader.
pub(crate) fn body(
    loaded: &Loaded,
    derived: &[Derived],
    visited: Option<&[VisitedRange]>,
    requirements_in_time: &[CheckedRequirement],
    further_warnings: Vec<String>,
) -> DerivedAnswer {
    let warnings = loaded.warnings.iter().map(|warning| warning.message.clone());
    let all_replaced = replaced_ranges(&loaded.project, visited.unwrap_or_default());
    DerivedAnswer {
        derived: derived.iter().map(row).collect(),
        visited_box: visited.map(|ranges| ranges.iter().map(range).collect()),
        visited_box_evidence: visited.map(|_| VisitedEvidence::Search),
        replaced: all_replaced.iter().map(replaced).collect(),
        requirements_in_time: requirements_in_time.iter().map(requirement_answer).collect(),
        warnings: further_warnings.into_iter().chain(warnings).collect(),
    }
}

fn replaced(range: &ReplacedRange) -> ReplacedRangeAnswer {
    ReplacedRangeAnswer {
        symbol: range.symbol,
        unit: range.unit,
        replaced: range.stated,
        visited: range.visited,
        fraction: range.fraction,
        beyond: range.beyond(),
    }
}

fn row(quantity: &Derived) -> DerivedQuantityAnswer {
    let declared = quantity.stated.as_ref().map(|stated| StatedAnswer {
        value: stated.value,
        place: stated.place,
        bounds: stated.bounds,
        difference_percent: quantity.difference_percent(),
        contradicts: quantity.contradicts(),
    });
    DerivedQuantityAnswer {
        name: quantity.name.clone(),
        group: quantity.group,
        symbol: quantity.symbol,
        value: quantity.value.ok(),
        unit: quantity.unit,
        equation: quantity.equation,
        declared,
        reason: quantity.value.err(),
    }
}

fn range(range: &VisitedRange) -> VisitedRangeAnswer {
    VisitedRangeAnswer {
        name: range.name,
        symbol: range.symbol,
        unit: range.unit,
        minimum: extreme(&range.minimum),
        maximum: extreme(&range.maximum),
    }
}

fn extreme(extreme: &Extreme) -> ExtremeAnswer {
    let mut at = extreme.at.clone();
    at.sort_by(|one, other| one.0.cmp(&other.0));
    ExtremeAnswer { value: extreme.value, at: Entries(at) }
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
