//! `identify`: the valve that explains recorded tests.

use phea_engineering::identify::{
    Known, RecordedFiles, SMALLEST_EFFECT, Search, identify, joint_region, recordings,
};
use phea_engineering::identify_error::{IdentifyError, NothingToIdentify};

use crate::answer::{Answer, picture_files};
use crate::identify::{self, Read, ValveFigures, recorded_files};
use crate::project::{Loaded, RecordedTest};
use crate::source::Source;
use phea_hydraulics::servovalve::LeakageModel;

use super::Watch;

/// Request for the identification of a valve.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct IdentifyRequest {
    /// Recorded tests, as text or Parquet; if empty, those of the project's `[identify]`.
    pub files: Vec<String>,
    /// Number of starting points of the search; 6 if absent.
    pub starts: Option<usize>,
    /// Seed of the starting points and of the bootstrap.
    pub seed: u32,
    /// Number of repetitions of the bootstrap; no bootstrap if zero.
    pub bootstrap: usize,
    /// The model of the leakage; if absent, the one that the recordings support.
    pub leakage_model: Option<LeakageModel>,
    /// True if the figures are requested as files.
    pub figures: bool,
}

/// Identifies a valve from files, with the data that a project states: nominal voltage, supply
/// pressure, tank pressure, transition pressure and the drop at which the tare flow is stated.
///
/// # Errors
/// [`IdentifyError`] for files that are not tests, and recordings that no valve explains.
pub fn identify_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    request: &IdentifyRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    let known = loaded.map_or(Known::default(), |loaded| Known::of(&loaded.project));
    let files = files(loaded, request)?;
    let RecordedFiles { recordings, contents, warnings } =
        recordings(source, &files, &known).map_err(IdentifyError::Files)?;
    let read = Read { contents, warnings };
    let usual = Search::default();
    let search = Search {
        starts: request.starts.unwrap_or(usual.starts),
        seed: request.seed,
        leakage_model: request.leakage_model,
        bootstrap: request.bootstrap,
    };
    let found = identify(recordings, &known, search, watch)?;
    let actuator = loaded.and_then(|loaded| loaded.project.actuator.as_ref());
    let of_thesis = actuator.is_some_and(identify::is_valve_of_thesis);
    let rig = loaded.filter(|loaded| loaded.project.actuator.is_some());
    let region = rig.map(|rig| joint_region(&found, &rig.project, SMALLEST_EFFECT));
    let mut written = identify::files(&found);
    written.extend(region.iter().flatten().map(|region| identify::file(&found, region)));
    if request.figures {
        written.extend(picture_files(&ValveFigures::of(&found).all()));
    }
    Ok(Answer {
        document: identify::document(&found, of_thesis, &read, region.as_ref()),
        json: identify::json(loaded, &found, &read, region.as_ref()),
        files: written,
        affirmative: found.has_converged() && found.not_identifiable.is_empty(),
    })
}

/// The requested files, or those of the project, with paths relative to it.
fn files(loaded: Option<&Loaded>, request: &IdentifyRequest) -> Result<Vec<RecordedTest>, IdentifyError> {
    if !request.files.is_empty() {
        return Ok(request.files.iter().map(|file| RecordedTest::of(file)).collect());
    }
    let project = loaded.map(|loaded| &loaded.project);
    let files = project.map(recorded_files).unwrap_or_default();
    if files.is_empty() {
        return Err(NothingToIdentify::NoTest.into());
    }
    Ok(files)
}
