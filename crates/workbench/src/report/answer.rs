//! The answer of `report`.

use super::{DecisionAnswer, Report};
use crate::answer::Answer;

/// Answer of `report`.
#[derive(Answer)]
pub(crate) struct ReportAnswer {
    /// Content of the report in a few numbers.
    summary: Vec<ReportFactAnswer>,
    /// Names of the figures in the order of the page.
    figures: Vec<String>,
    /// Content of the first page.
    decision: DecisionAnswer,
}

/// Number or finding of a report.
#[derive(Answer)]
struct ReportFactAnswer {
    /// Name of the quantity.
    name: &'static str,
    /// Value in words, in the display units of the project.
    text: String,
}

/// Answer of `report`.
pub(crate) fn body(report: Report) -> ReportAnswer {
    ReportAnswer {
        summary: report.summary.into_iter().map(|(name, text)| ReportFactAnswer { name, text }).collect(),
        figures: report.figures.into_iter().map(|figure| figure.name).collect(),
        decision: report.decision,
    }
}
