//! Output on the friction of a cylinder from recorded runs: text, JSON, figures, and the
//! fragment of a project file.

mod answer;
mod document;
mod figures;
mod files;

pub use phea_engineering::friction::*;

pub(crate) use answer::IdentifiedFrictionAnswer;
pub use answer::json;
pub(crate) use document::document;
pub(crate) use document::write;
pub(crate) use figures::pictures;
pub use files::files;

use crate::answer::significant;
use crate::estimate::Estimate;
use crate::project::DeclaredMisfit;
use crate::quantity::{DisplayUnit, TIME, VELOCITY, display};

/// Reasons for which a coefficient is not determined, in words.
pub(crate) fn because(open: &OpenCoefficient) -> String {
    let reasons: Vec<String> = open.reasons.iter().map(|reason| in_words(*reason)).collect();
    reasons.join("; ")
}

fn in_words(reason: NotIdentifiableFriction) -> String {
    match reason {
        NotIdentifiableFriction::NothingSlides => "nothing slides at a constant velocity".to_string(),
        NotIdentifiableFriction::NoFall => {
            "no fall of the friction from static to sliding is seen: record slower runs".to_string()
        }
        NotIdentifiableFriction::FewOnFall { below } => format!(
            "too few runs slide on the fall from static to Coulomb friction: record more constant velocities up to {}",
            display(below, &VELOCITY, 2)
        ),
        NotIdentifiableFriction::NotApproached => {
            "no run is slow enough for it and no piston breaks away: press the piston from rest until it moves"
                .to_string()
        }
        NotIdentifiableFriction::NothingPressed => {
            "nothing is pressed from rest while its position is recorded".to_string()
        }
        NotIdentifiableFriction::NothingShaken { ringing, breaking } => not_shaken(ringing, breaking),
        NotIdentifiableFriction::TooFewRows { time_step } => format!(
            "the shaken piston has too few rows in a period of its ringing: record one every {} or oftener",
            display(time_step, &TIME, 2)
        ),
        NotIdentifiableFriction::ShakenTooLittle { factor } => format!(
            "noise hides it: a force {} times as great around the frequency of the ringing, below the static friction, or a recording {} times as long, would show it",
            significant(factor, 2),
            significant(factor * factor, 2)
        ),
        NotIdentifiableFriction::QuickForce => {
            "the force changes too quickly: record one that rises slowly".to_string()
        }
        NotIdentifiableFriction::NotExplained { residual } => format!(
            "no bristles explain what is recorded before breakaway: {} times the noise is left",
            significant(residual, 2)
        ),
        NotIdentifiableFriction::Hidden => "noise hides its effect in these recordings".to_string(),
    }
}

/// The coefficients, each with the path of its key below `[cylinder.friction]`, and its unit.
pub(crate) fn coefficients(
    found: &FrictionIdentification,
) -> impl Iterator<Item = (String, &'static str, &Result<Estimate, OpenCoefficient>)> {
    let both = FRICTION_NAMES.iter().zip(&found.estimates);
    let both = both.map(|((name, unit), one)| ((*name).to_string(), *unit, one));
    let back = RETRACTING_NAMES.iter().zip(found.retracting.iter().flatten());
    both.chain(back.map(|((name, unit), one)| (format!("retracting.{name}"), *unit, one)))
}

/// Misfit of the friction, in a sentence.
pub(crate) fn misfit_in_words(found: &FrictionIdentification, misfit: &FrictionMisfit) -> String {
    let file = found.recordings.get(misfit.recording).map_or("", |one| one.file.as_str());
    let at = misfit.place.map_or_else(String::new, |[velocity, more]| {
        let than = if more > 0.0 { "more" } else { "less" };
        let (velocity, force) = (display(velocity, &VELOCITY, 3), significant(more.abs(), 2));
        format!(", most at {velocity}, where the model shows {force} N {than} than was recorded")
    });
    format!(
        "the model leaves {} % of the range unexplained of the {} of {file}{at}: neighbouring residuals are alike (correlation {})",
        significant(100.0 * misfit.fraction, 3),
        misfit.signal.name(),
        significant(misfit.correlation, 2)
    )
}

/// The greatest misfit in the form of `[cylinder.friction]`.
pub(crate) fn declared_misfit(found: &FrictionIdentification) -> Option<DeclaredMisfit> {
    let misfit = found.misfits.first()?;
    let file = found.recordings.get(misfit.recording).map_or("", |one| one.file.as_str());
    let most = misfit
        .place
        .map_or_else(String::new, |[velocity, _]| format!(", most at {}", display(velocity, &VELOCITY, 3)));
    let at = Some(format!("{} of {file}{most}", misfit.signal.name()));
    Some(DeclaredMisfit { fraction: misfit.fraction, at })
}

/// Test that would show the damping of the bristles.
fn not_shaken(ringing: Option<f64>, breaking: Option<f64>) -> String {
    let below = breaking.map_or("below the static friction".to_string(), |force| {
        format!("below the static friction of {} N", significant(force, 3))
    });
    let around = ringing.map_or("around which the mass rings on its bristles".to_string(), |ringing| {
        let rows = DisplayUnit::HERTZ.of(ROWS_OF_RINGING * ringing);
        let ringing = DisplayUnit::HERTZ.of(ringing);
        format!(
            "around {} Hz, where the mass rings on its bristles, with {} rows a second or more",
            significant(ringing, 3),
            significant(rows, 2)
        )
    });
    format!("slow runs do not show it: shake the piston {below} at frequencies {around}")
}
