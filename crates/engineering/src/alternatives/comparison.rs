//! Which alternative is at least as good as another in everything that is compared.

use super::AlternativeColumns;

/// The measures of dominance: the key of the column, its name for people, and whether more of it is
/// better.
pub const MEASURES: [(&str, &str, bool); 4] = [
    ("disturbance_peak_n", "disturbance", false),
    ("control_rms_v", "control rms", false),
    ("order", "order", false),
    ("delay_margin_s", "delay tolerated", true),
];

/// An alternative by its measures: of all scenarios the greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedMeasures(pub [f64; MEASURES.len()]);

impl ComparedMeasures {
    /// Those of an alternative; `None` where one does not exist.
    pub fn of(columns: &AlternativeColumns) -> Option<ComparedMeasures> {
        let mut values = [0.0; MEASURES.len()];
        for (value, (key, _, _)) in values.iter_mut().zip(MEASURES) {
            *value = columns.greatest(key)?;
        }
        Some(ComparedMeasures(values))
    }

    /// Whether it is at least as good as another in every measure, and better in one (Pareto
    /// dominance):
    ///
    /// ```text
    /// a dominates b   <=>   a_i <= b_i for all i, and a_i < b_i for some i     (>= and > where more is better)
    /// ```
    ///
    /// # Example
    /// ```
    /// use phea_engineering::alternatives::ComparedMeasures;
    /// let hose = ComparedMeasures([400.0, 0.1, 3.0, 2e-3]);
    /// let pipe = ComparedMeasures([2400.0, 0.1, 3.0, 1e-3]);
    /// assert!(hose.dominates(&pipe) && !pipe.dominates(&hose) && !hose.dominates(&hose));
    /// ```
    pub fn dominates(&self, other: &ComparedMeasures) -> bool {
        let costs = |measures: &ComparedMeasures| {
            let mut costs = measures.0;
            for (cost, (_, _, more_is_better)) in costs.iter_mut().zip(MEASURES) {
                *cost = if more_is_better { -*cost } else { *cost };
            }
            costs
        };
        let (own, others) = (costs(self), costs(other));
        let pairs = || own.iter().zip(&others);
        pairs().all(|(own, other)| own <= other) && pairs().any(|(own, other)| own < other)
    }
}
