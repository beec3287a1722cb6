//! `identify --of line`: the effective bulk modulus of a line from recordings.

use phea_engineering::identify_error::{IdentifyError, LineFitError, NothingToIdentify};
use phea_engineering::line_test::{KnownLine, identify_line, line_records};
use phea_engineering::response::ResponseSettings;
use phea_engineering::setup::Setup;

use crate::answer::{Answer, picture_files};
use crate::line_test;
use crate::project::{LineSide, Loaded};
use crate::source::Source;

use super::Watch;

/// Request for the identification of a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineRequest {
    /// Recordings, as text or Parquet; if empty, those of the project's `[identify] line`.
    pub files: Vec<String>,
    /// The line; if absent, that of `[bench.line]`, or the line to chamber A.
    pub side: Option<LineSide>,
    /// Settings for the estimation of the frequency response.
    pub settings: ResponseSettings,
    /// True if figures are among the files of the answer.
    pub figures: bool,
}

/// Identifies a line of a project from recordings of it with its far end blocked.
///
/// # Errors
/// [`IdentifyError`] without a project that describes the line, for files that are not recordings,
/// and for recordings that no line explains.
pub fn line_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    request: &LineRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    let loaded = loaded.ok_or(NothingToIdentify::NoProjectOfLine)?;
    let project = &loaded.project;
    let setup = Setup::new(project)?;
    let side = request.side.or(project.bench.line.map(|bench| bench.side)).unwrap_or_default();
    let known = KnownLine::of(&setup, side).map_err(LineFitError::from)?;
    let declared = project.identify.iter().flat_map(|identify| &identify.line);
    let files: Vec<String> = match request.files.is_empty() {
        true => declared.map(|file| project.path_of(file)).collect(),
        false => request.files.clone(),
    };
    if files.is_empty() {
        return Err(NothingToIdentify::NoLineRecording.into());
    }
    let records = line_records(source, &files, known.piston_area)?;
    let found = identify_line(records, known, &request.settings, watch)?;
    let drawn = if request.figures { line_test::pictures(&found) } else { Vec::new() };
    let pictures = picture_files(&drawn);
    let affirmative = found.effective_bulk_modulus.is_ok() || found.dynamic_bulk_modulus.is_ok();
    Ok(Answer {
        document: line_test::document(&found),
        json: line_test::json(loaded, &found),
        files: line_test::files(&found).into_iter().chain(pictures).collect(),
        affirmative,
    })
}
