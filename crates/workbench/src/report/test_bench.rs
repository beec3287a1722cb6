//! The chapter on the recorded tests of the valve, chapter 5 of the thesis.

use phea_engineering::identify::{Identification, Known, RecordedFiles, Search, identify, recordings};
use phea_engineering::identify_error::IdentifyError;

use super::chapter::Chapter;
use crate::document::Document;
use crate::error::CommandError;
use crate::identify::{
    Read, ValveFigures, is_valve_of_thesis, recorded_files, write_coefficients, write_numbers, write_signals,
};
use crate::project::{Loaded, Project};
use crate::source::Source;
use phea_dynamics::watch::Watch;

/// Findings of the recordings of the project on its valve; nothing if the project declares none.
pub(super) fn chapter(
    source: &dyn Source,
    loaded: &Loaded,
    watch: Watch<'_>,
) -> Result<Option<Chapter>, CommandError> {
    let project = &loaded.project;
    let files = recorded_files(project);
    if files.is_empty() {
        return Ok(None);
    }
    let known = Known::of(project);
    let RecordedFiles { recordings, contents, warnings } = recordings(source, &files, &known)
        .map_err(|report| CommandError::Identify(IdentifyError::Files(report)))?;
    let found = identify(recordings, &known, Search::default(), watch)?;
    Ok(Some(Chapter::of(
        "test_bench",
        "From the test bench to the model",
        document(&found, project, &Read { contents, warnings }),
    )))
}

/// A function for each section, in the order of the thesis.
fn document(found: &Identification, project: &Project, read: &Read) -> Document {
    let of_thesis = project.actuator.as_ref().is_some_and(is_valve_of_thesis);
    let ValveFigures { circuits, series, curves, comparison, residuals } = ValveFigures::of(found);
    let mut out = Document::default();
    out.explanation("The coefficients of the servovalve follow from slow tests after ISO 10770-1: the command goes through its range in minutes, so that nothing but the valve's own memory lags (the method of Ledezma, 2019, chapter 5).");
    out.figures(circuits);
    read.write(&mut out);
    out.figures_below("What was recorded", series);
    write_numbers(found, of_thesis, &mut out);
    out.figures(curves);
    write_coefficients(found, &mut out);
    out.explanation(simple_against_identified(found, of_thesis));
    write_signals(found, &mut out);
    out.figures_below("Test against model", comparison);
    out.figures(residuals);
    out
}

/// Table 5.1 has both columns, and states in words that one does not reproduce the tests.
fn simple_against_identified(found: &Identification, of_thesis: bool) -> String {
    let squares = |coefficients| -> f64 {
        let fractions = found.signals.iter().map(|one| found.residual_rms_of(one, coefficients) / one.range);
        let count = found.signals.len().max(1) as f64;
        (fractions.map(|fraction| fraction * fraction).sum::<f64>() / count).sqrt()
    };
    let percent = |fraction: f64| crate::answer::significant(100.0 * fraction, 3);
    format!(
        "With the coefficients by hand, the model differs from the recordings by {} % of the range of each signal (root mean square); with the identified ones by {} %.{}",
        percent(squares(&found.first_guess)),
        percent(squares(&found.coefficients)),
        if of_thesis {
            " Table 5.1 of the thesis compares the same two columns: equal edges by hand, unequal ones by optimisation."
        } else {
            ""
        }
    )
}
