//! Facts about a problem that hold whatever a search finds, in JSON.

use phea_engineering::design::{Explanation, ProjectDesign};
use phea_engineering::plant_names::NamedPlant;

use crate::answer::{Answer, words};
use crate::explanation::explanation_sentence;

/// Fact that is impossible or hard for any controller.
#[derive(Answer)]
pub(super) struct ExplanationAnswer {
    /// Fact in a sentence.
    sentence: String,
    /// Consequence of the fact.
    severity: ExplanationSeverity,
    /// Frequency of the fact, only if it has one.
    #[answer(optional)]
    frequency_rad_per_s: Option<f64>,
    /// Plants that it concerns.
    plants: Vec<NamedPlant>,
    /// Indices of the limits that it concerns, from 0: the specifications over frequency in the
    /// order of the file, then the limits of `[design]`.
    specifications: Vec<usize>,
    /// Least common relaxation of all limits that may help.
    #[answer(optional)]
    relaxation_db: Option<f64>,
}

/// Consequence of a fact for a design.
enum ExplanationSeverity {
    Impossible,
    Warning,
}

words! {
    /// Consequence of a fact: no controller satisfies the specifications, or one is hard to find.
    ExplanationSeverity { Impossible => "impossible", Warning => "warning" }
}

/// The facts.
pub(super) fn explanations(view: &ProjectDesign) -> Vec<ExplanationAnswer> {
    view.explanations.iter().map(|one| row(view, one)).collect()
}

fn row(view: &ProjectDesign, explanation: &Explanation) -> ExplanationAnswer {
    let names = &view.designed.view.names;
    ExplanationAnswer {
        sentence: explanation_sentence(explanation),
        severity: match explanation.is_impossible {
            true => ExplanationSeverity::Impossible,
            false => ExplanationSeverity::Warning,
        },
        frequency_rad_per_s: explanation.frequency_rad_per_s,
        plants: explanation.plants.iter().map(|plant| names.named(plant)).collect(),
        specifications: explanation.specifications.clone(),
        relaxation_db: explanation.relaxation_db,
    }
}
