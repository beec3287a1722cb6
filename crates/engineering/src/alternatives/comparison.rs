//! Pareto comparison of alternatives: one is at least as good as another in every compared measure.

use super::{ColumnKey, WorstColumns};
use crate::quantity::DisplayUnit;

/// Sense in which a value of a column is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnSense {
    /// The greater value is better.
    More,
    /// The lesser value is better.
    Less,
}

/// True if values are at least as good as others in every column, and better in one (Pareto
/// dominance):
///
/// ```text
/// a dominates b   <=>   a_i <= b_i for all i, and a_i < b_i for some i     (>= and > if more is better)
/// ```
///
/// # Example
/// ```
/// use phea_engineering::alternatives::{ColumnSense::{Less, More}, dominates};
/// assert!(dominates(&[1.0, 5.0], &[2.0, 5.0], &[Less, More]));
/// assert!(!dominates(&[1.0, 4.0], &[2.0, 5.0], &[Less, More]));
/// assert!(!dominates(&[1.0, 5.0], &[1.0, 5.0], &[Less, More]));
/// ```
pub fn dominates(own: &[f64], others: &[f64], senses: &[ColumnSense]) -> bool {
    let cost = |value: f64, sense: ColumnSense| if sense == ColumnSense::More { -value } else { value };
    let pairs = || own.iter().zip(others).zip(senses);
    let costs = || pairs().map(|((own, other), sense)| (cost(*own, *sense), cost(*other, *sense)));
    costs().all(|(own, other)| own <= other) && costs().any(|(own, other)| own < other)
}

/// Measures of dominance.
pub const MEASURES: [ColumnKey; 4] =
    [ColumnKey::DisturbancePeak, ColumnKey::ControlRms, ColumnKey::Order, ColumnKey::DelayMargin];

/// Measures of dominance that count if all compared alternatives state them.
pub const MEASURES_IF_STATED: [ColumnKey; 2] = [ColumnKey::PartsPrice, ColumnKey::PartsMass];

/// A measure by which alternatives dominate each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedMeasure {
    /// Key of the column.
    pub key: ColumnKey,
    /// Unit for display.
    pub unit: DisplayUnit,
}

impl ComparedMeasure {
    /// Measures by which alternatives can be compared: the four, and those that all of them state.
    pub fn of_all(all: &[WorstColumns]) -> Vec<ComparedMeasure> {
        let stated =
            |key: ColumnKey| !all.is_empty() && all.iter().all(|columns| columns.value(key).is_some());
        let if_stated = MEASURES_IF_STATED.into_iter().filter(|key| stated(*key));
        let unit = |key: ColumnKey| all.iter().find_map(|columns| Some(columns.find(key)?.unit));
        let measure = |key| ComparedMeasure { key, unit: unit(key).unwrap_or(DisplayUnit::ONE) };
        MEASURES.into_iter().chain(if_stated).map(measure).collect()
    }

    /// True if the greater value is the better one.
    pub fn is_more(&self) -> bool {
        self.key.sense() == ColumnSense::More
    }
}

/// Measures of an alternative: the greatest of all scenarios.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedMeasures(pub Vec<f64>);

impl ComparedMeasures {
    /// Measures of an alternative; `None` if one does not exist.
    pub fn of(columns: &WorstColumns, measures: &[ComparedMeasure]) -> Option<ComparedMeasures> {
        measures.iter().map(|measure| columns.value(measure.key)).collect::<Option<_>>().map(ComparedMeasures)
    }

    /// True if the alternative dominates another one in these measures.
    ///
    /// # Example
    /// ```
    /// use phea_engineering::alternatives::{ComparedMeasure, ComparedMeasures};
    /// let hose = ComparedMeasures(vec![400.0, 0.1, 3.0, 2e-3]);
    /// let pipe = ComparedMeasures(vec![2400.0, 0.1, 3.0, 1e-3]);
    /// let measures = ComparedMeasure::of_all(&[]);
    /// assert!(hose.dominates(&pipe, &measures) && !pipe.dominates(&hose, &measures));
    /// assert!(!hose.dominates(&hose, &measures));
    /// ```
    pub fn dominates(&self, other: &ComparedMeasures, measures: &[ComparedMeasure]) -> bool {
        let senses: Vec<ColumnSense> = measures.iter().map(|measure| measure.key.sense()).collect();
        dominates(&self.0, &other.0, &senses)
    }
}
