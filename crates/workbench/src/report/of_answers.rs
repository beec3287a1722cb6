//! Figures of the chapters as parts of the answers of single commands, for those that show a page.

use phea_dynamics::linear::LinearError;
use phea_engineering::audit::ProjectAudit;
use phea_engineering::design::ProjectDesign;
use phea_engineering::linearize::Linearization;
use phea_engineering::robust::RobustProblem;
use phea_engineering::sizing::{Sizing, SizingProblem};
use phea_engineering::trial::Trial;

use super::{audit, design, impedance, models, sizing};
use crate::document::Document;
use crate::figure::Figure;

/// Figures of `verify`.
pub(crate) fn of_audit(problem: &RobustProblem, view: &ProjectAudit, trial: Option<&Trial>) -> Document {
    let mut out = Document::default();
    match audit::figures(problem, view) {
        Ok((figures, refused)) => {
            out.figures_below("Closed loops of the family", figures);
            out.explanations(refused);
        }
        Err(error) => out.explanation(no_figures(&error)),
    }
    out.figures(trial.into_iter().flat_map(audit::figures_of_trial));
    out
}

/// Figures of `size`.
pub(crate) fn of_sizing(problem: &SizingProblem, found: &Sizing) -> Document {
    let mut out = Document::default();
    out.figures_below("Figures", sizing::figures(problem, found));
    out
}

/// Figures of `linearize`.
pub(crate) fn of_models(linearization: &Linearization) -> Document {
    let figures = models::figures(linearization).and_then(|models| {
        let impedance = impedance::figure(linearization)?;
        Ok(models.into_iter().chain([impedance]).collect())
    });
    below("Figures", figures)
}

/// Figures of `design`.
pub(crate) fn of_design(view: &ProjectDesign) -> Document {
    let mut out = below("The closed loops of the family", design::magnitudes(view));
    out.append(below("The prefilter", design::prefilters(view)));
    out.append(design::family_steps_of(view));
    out.figures(view.trial.iter().flat_map(design::figures_of_trial));
    out
}

fn below(title: &str, figures: Result<Vec<Figure>, LinearError>) -> Document {
    let mut out = Document::default();
    match figures {
        Ok(figures) => out.figures_below(title, figures),
        Err(error) => out.explanation(no_figures(&error)),
    }
    out
}

fn no_figures(error: &LinearError) -> String {
    format!("No figures: {error}.")
}
