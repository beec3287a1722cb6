//! `identify --of friction`: the friction that explains recorded runs of the cylinder.

use phea_engineering::friction::{KnownCylinder, friction_recordings, identify_friction, recorded_runs};
use phea_engineering::identify_error::{IdentifyError, NothingToIdentify};

use crate::answer::{Answer, picture_files};
use crate::friction;
use crate::project::Loaded;
use crate::source::Source;

use super::Watch;

/// Request for the identification of friction.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrictionRequest {
    /// Recorded runs; if empty, those of the project's `[identify]`.
    pub files: Vec<String>,
    /// True if figures are among the files of the answer.
    pub figures: bool,
}

/// Identifies the friction of a project's cylinder, whose areas and moving mass the project states.
///
/// # Errors
/// [`IdentifyError`] for a project without a cylinder, files that are not evenly sampled runs, and
/// runs without information.
pub fn friction_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    request: &FrictionRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    let loaded = loaded.ok_or(NothingToIdentify::NoProjectOfCylinder)?;
    let project = &loaded.project;
    let files = if request.files.is_empty() { recorded_runs(project) } else { request.files.clone() };
    if files.is_empty() {
        return Err(NothingToIdentify::NoRun.into());
    }
    let known = KnownCylinder::of(project)?;
    let found = identify_friction(friction_recordings(source, &files, &known)?, &known, watch)?;
    let mut files = friction::files(&found);
    if request.figures {
        files.extend(picture_files(&friction::pictures(&found)));
    }
    Ok(Answer {
        document: friction::document(&found),
        json: friction::json(loaded, &found),
        files,
        affirmative: found.has_converged()
            && found.estimates.iter().chain(found.retracting.iter().flatten()).all(Result::is_ok),
    })
}
