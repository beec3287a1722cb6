//! The errors of a design in words.

use phea_engineering::design::DesignError;

use crate::explanation::explanation_sentence;
use crate::impossible_steps::late_of_steps;
use crate::project::LateError;

/// The error of a design in words; for a design without a controller with the known facts on its
/// problem, for required steps that no controller makes each with its remedy.
pub(crate) fn design_error_words(error: &DesignError) -> String {
    match error {
        DesignError::NoController(known) => {
            let known = known.iter().map(|one| format!("; {}", explanation_sentence(one)));
            format!("{error}{}", known.collect::<String>())
        }
        DesignError::ImpossibleSteps(found) => {
            late_of_steps(found).iter().map(LateError::sentence).collect::<Vec<_>>().join("; ")
        }
        error => error.to_string(),
    }
}
