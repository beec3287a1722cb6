//! Output on a line from recordings of it: text, JSON, figures, and the fragment of a project.

mod answer;
mod document;
mod figures;
mod files;

pub(crate) use answer::IdentifiedLineAnswer;
pub use answer::json;
pub(crate) use document::document;
pub(crate) use figures::pictures;
pub use files::files;
use phea_engineering::estimate::Estimate;
use phea_engineering::line_test::{
    KnownLine, LineIdentification, LineMisfit, NotIdentifiableLine, WideQuantity,
};

use crate::answer::significant;
use crate::quantity::DisplayUnit;

/// Remark on an accumulator, which is left out.
pub(crate) fn remark(known: &KnownLine) -> Option<&'static str> {
    known.leaves_accumulator.then_some(
        "The accumulator at the chamber is not part of the blocked line: neither test nor result includes it.",
    )
}

/// Reason why a number is not determined.
pub(crate) fn because(reason: NotIdentifiableLine) -> String {
    let hertz = |frequency: f64| significant(DisplayUnit::HERTZ.of(frequency), 4);
    let text = match reason {
        NotIdentifiableLine::NoRise => "there is no slow pressure rise among the recordings",
        NotIdentifiableLine::NoRiseOfHose => {
            "there is no slow pressure rise among the recordings; in motion the wall of a hose is stiffer than at rest"
        }
        NotIdentifiableLine::NoResponse => "there is no frequency response among the recordings",
        NotIdentifiableLine::Wide { quantity, .. } => {
            let what = match quantity {
                WideQuantity::ModulusAtRest => "the modulus at rest",
                WideQuantity::DynamicModulus => "the dynamic modulus",
                WideQuantity::SecantModulus => "the secant modulus",
                WideQuantity::DynamicStiffening => "the dynamic stiffening",
            };
            return format!("{what} is known to no better than a factor of one and a half");
        }
        NotIdentifiableLine::PressureDoesNotRise { .. } => "the pressure does not rise with the volume",
        NotIdentifiableLine::NoAir => {
            "the pressure rise is explained as well without free air in the declared oil"
        }
        NotIdentifiableLine::ConstantCompliance => {
            "the compliance does not change with the pressure beyond its noise"
        }
        NotIdentifiableLine::NoHose => "only the wall of a hose stiffens",
        NotIdentifiableLine::StifferThanOil { .. } => {
            "the line yields less than the declared oil alone: `fluid.bulk_modulus` is too low"
        }
        NotIdentifiableLine::NoWallCompliance => "the line yields less than the declared oil alone",
        NotIdentifiableLine::NoCreep => {
            "the declared model of the line has no creep (`line.relaxation_time`)"
        }
        NotIdentifiableLine::AwayFromCreep { .. } => {
            "the frequencies of the response are not around the corner of the creep"
        }
        NotIdentifiableLine::NoLength => "a plain volume has no length",
        NotIdentifiableLine::TwoWaves => "two waves travel in the declared model: `two_wave`",
        NotIdentifiableLine::NoWave { highest } => {
            return format!("the response shows no wave up to {} Hz", hertz(highest));
        }
        NotIdentifiableLine::BelowQuarterWave { highest, quarter_wave } => {
            return format!(
                "the frequencies end at {} Hz, too far below the quarter wave at about {quarter_wave:.0} Hz",
                hertz(highest)
            );
        }
    };
    text.to_string()
}

/// Misfit of the line, in a sentence.
pub(crate) fn misfit_in_words(misfit: &LineMisfit) -> String {
    let percent = significant(100.0 * misfit.fraction, 3);
    let LineMisfit { file, signal, .. } = misfit;
    match misfit.correlation {
        Some(correlation) => format!(
            "the model leaves {percent} % of the range unexplained of the {signal} of {file}: neighbouring residuals are alike (correlation {})",
            significant(correlation, 2)
        ),
        None => {
            format!("the model leaves {percent} % of the {signal} of {file} unexplained beyond its noise")
        }
    }
}

/// The numbers of a line in the order in which they are printed: key, name, and number.
pub(crate) fn numbers(
    found: &LineIdentification,
) -> [(&'static str, &'static str, &Result<Estimate, NotIdentifiableLine>); 9] {
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
