//! Which alternative is at least as good as another in everything that is compared.

use super::AlternativeColumns;
use crate::quantity::DisplayUnit;

/// Which of two values of a column is the better one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnSense {
    /// The greater.
    More,
    /// The lesser.
    Less,
}

/// Every column by which alternatives can be compared, with the sense that it has unless another is
/// asked for.
pub const COLUMN_SENSES: [(&str, ColumnSense); 33] = {
    use ColumnSense::{Less, More};
    [
        ("relaxation_db", Less),
        ("order", Less),
        ("prefilter_order", Less),
        ("relative_degree", More),
        ("high_frequency_gain_db", Less),
        ("modulus_margin", More),
        ("delay_margin_s", More),
        ("worst_margin_db", More),
        ("stiffness_minimum_n_per_m", Less),
        ("stiffness_maximum_n_per_m", Less),
        ("equivalent_stiffness_n_per_m", Less),
        ("actuator_length_m", Less),
        ("lines_length_m", Less),
        ("moving_mass_kg", Less),
        ("lines_volume_m3", Less),
        ("oil_volume_m3", Less),
        ("oil_mass_kg", Less),
        ("gas_volume_m3", Less),
        ("power_at_rest_w", Less),
        ("parts_price", Less),
        ("parts_mass_kg", Less),
        ("sized_length_m", Less),
        ("sized_gain_v_per_n", More),
        ("impedance_open_n_s_per_m", Less),
        ("impedance_closed_n_s_per_m", Less),
        ("impedance_asked_n_s_per_m", Less),
        ("overshoot_percent", Less),
        ("settling_time_s", Less),
        ("disturbance_peak_n", Less),
        ("control_peak_v", Less),
        ("control_rms_v", Less),
        ("energy_from_supply_j", Less),
        ("swept", Less),
    ]
};

/// The sense of a column.
pub(super) fn sense_of(key: &str) -> Option<ColumnSense> {
    COLUMN_SENSES.iter().find(|(known, _)| *known == key).map(|(_, sense)| *sense)
}

/// Whether values are at least as good as others in every column, and better in one (Pareto
/// dominance):
///
/// ```text
/// a dominates b   <=>   a_i <= b_i for all i, and a_i < b_i for some i     (>= and > where more is better)
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

/// The measures of dominance, by the keys of their columns.
pub const MEASURES: [&str; 4] = ["disturbance_peak_n", "control_rms_v", "order", "delay_margin_s"];

/// Measures of dominance that count where all that are compared state them.
pub const MEASURES_IF_STATED: [&str; 2] = ["parts_price", "parts_mass_kg"];

/// A measure by which alternatives dominate each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedMeasure {
    /// Key of the column.
    pub key: &'static str,
    /// For people.
    pub unit: DisplayUnit,
}

impl ComparedMeasure {
    /// Those by which alternatives can be compared: the four, and what all of them state.
    pub fn of_all(all: &[AlternativeColumns]) -> Vec<ComparedMeasure> {
        let stated = |key: &str| !all.is_empty() && all.iter().all(|columns| columns.worst(key).is_some());
        let if_stated = MEASURES_IF_STATED.into_iter().filter(|key| stated(key));
        let unit = |key: &str| all.iter().find_map(|columns| Some(columns.first(key)?.unit));
        let measure = |key| ComparedMeasure { key, unit: unit(key).unwrap_or(DisplayUnit::ONE) };
        MEASURES.into_iter().chain(if_stated).map(measure).collect()
    }

    /// Whether the greater value is the better one.
    pub fn is_more(&self) -> bool {
        sense_of(self.key) == Some(ColumnSense::More)
    }
}

/// An alternative by its measures: of all scenarios the greatest.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedMeasures(pub Vec<f64>);

impl ComparedMeasures {
    /// Those of an alternative; `None` where one does not exist.
    pub fn of(columns: &AlternativeColumns, measures: &[ComparedMeasure]) -> Option<ComparedMeasures> {
        measures.iter().map(|measure| columns.worst(measure.key)).collect::<Option<_>>().map(ComparedMeasures)
    }

    /// Whether it dominates another of the same measures.
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
        let sense = |measure: &ComparedMeasure| sense_of(measure.key).unwrap_or(ColumnSense::Less);
        dominates(&self.0, &other.0, &measures.iter().map(sense).collect::<Vec<_>>())
    }
}
