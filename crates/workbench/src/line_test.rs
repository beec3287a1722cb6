//! Output on a line from recordings of it: text, JSON, figures, and the fragment of a project.

mod answer;
mod document;
mod figures;
mod files;

pub use phea_engineering::line_test::*;

pub use answer::json;
pub(crate) use document::document;
pub(crate) use figures::pictures;
pub use files::files;

use crate::answer::significant;
use crate::estimate::Estimate;

/// What the line does not explain.
pub(crate) fn misfit_in_words(misfit: &LineMisfit) -> String {
    let share = significant(100.0 * misfit.share, 3);
    let LineMisfit { file, signal, .. } = misfit;
    match misfit.correlation {
        Some(correlation) => format!(
            "the model leaves {share} % of the range unexplained of the {signal} of {file}: neighbouring residuals are alike (correlation {})",
            significant(correlation, 2)
        ),
        None => format!("the model leaves {share} % of the {signal} of {file} unexplained beyond its noise"),
    }
}

/// The numbers of a line in the order in which they are printed: key, what it is, and the number.
pub(crate) fn numbers(
    found: &LineIdentification,
) -> [(&'static str, &'static str, &Result<Estimate, Undetermined>); 9] {
    [
        ("effective_bulk_modulus_pa", "effective bulk modulus at rest", &found.effective_bulk_modulus),
        ("dynamic_stiffening", "dynamic stiffening of the wall", &found.dynamic_stiffening),
        ("wave_speed_m_per_s", "wave speed", &found.wave_speed),
        ("dynamic_bulk_modulus_pa", "effective bulk modulus in fast motion", &found.dynamic_bulk_modulus),
        ("relaxation_time_s", "relaxation time of the wall", &found.relaxation_time),
        ("secant_bulk_modulus_pa", "secant bulk modulus of the pressure rise", &found.secant_bulk_modulus),
        ("entrained_air", "free air, of the mixture at atmospheric pressure", &found.entrained_air),
        ("density_kg_per_m3", "density of the oil, from its inertia", &found.density),
        ("modulus_slope", "growth of the modulus at rest with the pressure", &found.modulus_slope),
    ]
}
