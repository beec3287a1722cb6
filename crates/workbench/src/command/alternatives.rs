//! `alternatives`: one project with several sets of values, judged side by side.

use super::{CommandError, Watch};
use crate::alternatives::{self, judge};
use crate::answer::Answer;
use crate::project::{Loaded, read_alternative};
use crate::source::Source;
use phea_engineering::error::ProcedureError;

pub(super) fn alternatives_answer(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
    files: bool,
    watch: Watch<'_>,
) -> Result<Answer, CommandError> {
    let found = judge(source, loaded, catalogues, watch)?;
    let written = files.then(|| alternatives::files(&found)).transpose().map_err(CommandError::Figure)?;
    Ok(Answer {
        text: alternatives::text(&found),
        json: alternatives::json(loaded, &found),
        files: written.unwrap_or_default(),
        affirmative: found.is_complete(),
    })
}

/// Reads every alternative, so that a wrong one is found before anything is designed.
pub(super) fn read_alternatives(
    source: &dyn Source,
    loaded: &Loaded,
    catalogues: &[String],
) -> Result<(), CommandError> {
    for index in 0..loaded.project.alternatives.len() {
        read_alternative(source, loaded, catalogues, index).map_err(ProcedureError::Catalogue)?;
    }
    Ok(())
}
