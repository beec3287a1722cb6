//! Signals that the identified valve does not explain, in words.

use super::{Identification, Misfit, MisfitPlace};
use crate::answer::significant;
use crate::project::DeclaredMisfit;
use crate::quantity::{VOLTAGE, display};

/// Misfit of a signal, in a sentence.
pub(super) fn misfit_in_words(found: &Identification, misfit: &Misfit) -> String {
    let percent = |fraction: f64| format!("{} %", significant(100.0 * fraction, 3));
    let by = misfit.place.map_or_else(String::new, |place| {
        let more = if place.fraction > 0.0 { "more" } else { "less" };
        format!(", where the model shows {} {more} than was recorded", percent(place.fraction.abs()))
    });
    format!(
        "the model leaves {} of the range unexplained of the {}{by}: neighbouring residuals are alike (correlation {})",
        percent(misfit.fraction),
        misfit_at(found, misfit),
        significant(misfit.correlation, 2)
    )
}

/// The greatest misfit in the form of the project's `valve.misfit`.
pub(super) fn declared_misfit(found: &Identification) -> Option<DeclaredMisfit> {
    let misfit = found.misfits().into_iter().next()?;
    Some(DeclaredMisfit { fraction: misfit.fraction, at: Some(misfit_at(found, &misfit)) })
}

/// Signal and recording of a misfit, and the range of the command.
fn misfit_at(found: &Identification, misfit: &Misfit) -> String {
    let file = found.recordings.get(misfit.recording).map_or("", |one| one.file.as_str());
    let signal = misfit.kind.name().replace('_', " ");
    let Some(MisfitPlace { is_rising, command, .. }) = misfit.place else {
        return format!("{signal} of {file}");
    };
    let [from, to] = command.map(|end| display(end, &VOLTAGE, 3));
    let (way, from, to) = if is_rising { ("rises", from, to) } else { ("falls", to, from) };
    format!("{signal} of {file}, most while the command {way} from {from} to {to}")
}
