//! The errors of a design in words.

use phea_engineering::design::DesignError;

use crate::explanation::explanation_sentence;
use crate::impossible::late_of_steps;
use crate::project::LateError;

/// The error of a design: of one without a controller with the facts that are known of its problem,
/// of required steps that no controller makes each with its cure.
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
