//! Differences of the linear models for programs.

use phea_engineering::linearize::{Linearization, ReductionDifference};

use crate::answer::Answer;

/// Largest differences of the responses of two models over frequency.
#[derive(Answer)]
pub(super) struct ResponseDifferenceAnswer {
    /// Largest difference of the magnitudes, positive.
    magnitude_db: f64,
    /// Frequency of the largest difference of the magnitudes.
    magnitude_at_rad_per_s: f64,
    /// Largest difference of the phases, from 0 to 180.
    phase_deg: f64,
    /// Frequency of the largest difference of the phases.
    phase_at_rad_per_s: f64,
    /// Largest differences at frequencies below 1000 rad/s.
    below_1000_rad_per_s: LowDifferenceAnswer,
}

/// Largest differences of the responses of two models below 1000 rad/s.
#[derive(Answer)]
struct LowDifferenceAnswer {
    /// Largest difference of the magnitudes, positive.
    magnitude_db: f64,
    /// Largest difference of the phases, from 0 to 180.
    phase_deg: f64,
}

/// Differences of the decomposed model from the fifth-order one.
#[derive(Answer)]
pub(super) struct DecompositionErrorAnswer {
    #[answer(flatten)]
    corrected: ResponseDifferenceAnswer,
    /// Differences of the decomposed model as the thesis prints it.
    as_printed: ResponseDifferenceAnswer,
}

pub(super) fn decomposition(linearization: &Linearization) -> DecompositionErrorAnswer {
    DecompositionErrorAnswer {
        corrected: difference(&linearization.corrected_decomposition),
        as_printed: difference(&linearization.printed_decomposition),
    }
}

pub(super) fn difference(comparison: &ReductionDifference) -> ResponseDifferenceAnswer {
    let ReductionDifference { all, low } = comparison;
    ResponseDifferenceAnswer {
        magnitude_db: all.magnitude_db,
        magnitude_at_rad_per_s: all.magnitude_frequency,
        phase_deg: all.phase_deg,
        phase_at_rad_per_s: all.phase_frequency,
        below_1000_rad_per_s: LowDifferenceAnswer {
            magnitude_db: low.magnitude_db,
            phase_deg: low.phase_deg,
        },
    }
}
