//! A point with all margins known in its neighbourhood.

use std::collections::BTreeMap;

use super::super::search::{Aim, Judgement, MarginRow, Slopes};
use super::super::subproblem::dot;

/// A point with its evaluation, its slopes, and margins that a rejected step has shown to matter
/// nearby.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DescentPoint {
    pub(super) x: Vec<f64>,
    pub(super) judgement: Judgement,
    pub(super) slopes: Slopes,
    /// Margins that are missing among the slopes here, as seen from the end of a rejected step.
    pub(super) beyond: Vec<MarginRow>,
}

impl DescentPoint {
    /// All margins known here, those from other points last.
    pub(super) fn rows(&self) -> Vec<MarginRow> {
        self.slopes.margins.iter().chain(&self.beyond).cloned().collect()
    }

    fn by_sample(&self) -> BTreeMap<usize, &MarginRow> {
        self.slopes.margins.iter().map(|row| (row.sample, row)).collect()
    }

    /// The margins of another point that are missing here, extrapolated to this point along their
    /// slopes. None of them is worse here than the worst margin, which is known.
    fn unknown_rows(&self, there: &DescentPoint) -> Vec<MarginRow> {
        let known = self.by_sample();
        let back: Vec<f64> = self.x.iter().zip(&there.x).map(|(here, there)| here - there).collect();
        let unknown = there.slopes.margins.iter().filter(|row| !known.contains_key(&row.sample));
        let continued = unknown.map(|row| {
            let margin_db = row.margin_db + dot(&row.slopes, &back);
            let worst = row.rate * self.judgement.worst_margin_db;
            MarginRow { margin_db: margin_db.max(worst), ..row.clone() }
        });
        continued.collect()
    }

    /// The rows here, shifted so that they have the margins found at the end of a step, and those
    /// that appear only there.
    pub(super) fn corrected_rows(&self, there: &DescentPoint, step: &[f64]) -> Vec<MarginRow> {
        let found = there.by_sample();
        let corrected = |row: &MarginRow| match found.get(&row.sample) {
            Some(seen) => MarginRow { margin_db: seen.margin_db - dot(&row.slopes, step), ..row.clone() },
            None => row.clone(),
        };
        let mut rows: Vec<MarginRow> = self.slopes.margins.iter().map(corrected).collect();
        rows.extend(self.unknown_rows(there));
        rows
    }

    /// Copy of this point with the margins that appear only at the end of a rejected step.
    pub(super) fn with_rows_of(mut self, there: &DescentPoint) -> DescentPoint {
        let unknown = self.unknown_rows(there);
        self.beyond.retain(|row| unknown.iter().all(|new| new.sample != row.sample));
        self.beyond.extend(unknown);
        self
    }

    /// Change of the slopes of the Lagrangian f - sum lambda_i m_i between two points; a margin not
    /// given at both points is taken as linear.
    pub(super) fn change_of_slopes(&self, there: &DescentPoint, aim: Aim, multipliers: &[f64]) -> Vec<f64> {
        let slopes = there.slopes.objective_slopes.iter().zip(&self.slopes.objective_slopes);
        let mut change: Vec<f64> = match aim {
            Aim::WorstMargin => vec![0.0; self.x.len()],
            Aim::Objective => slopes.map(|(there, here)| there - here).collect(),
        };
        let found = there.by_sample();
        for (row, multiplier) in self.slopes.margins.iter().zip(multipliers) {
            let Some(seen) = found.get(&row.sample) else { continue };
            for ((change, there), here) in change.iter_mut().zip(&seen.slopes).zip(&row.slopes) {
                *change -= multiplier * (there - here);
            }
        }
        change
    }
}
