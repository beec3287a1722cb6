//! `identify --of friction`: the friction that explains recorded runs of the cylinder.

use crate::answer::{Answer, picture_files};
use crate::friction::{self, KnownCylinder, friction_recordings, identify_friction};
use crate::identify::IdentifyError;
use crate::project::Loaded;
use crate::setup::Setup;
use crate::source::Source;

use super::Watch;

/// From which files, and what is wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrictionRequest {
    /// Recorded runs.
    pub files: Vec<String>,
    /// Whether figures are among the files of the answer.
    pub figures: bool,
}

/// Identifies the friction of a project's cylinder, whose areas and moving mass the project states.
///
/// # Errors
/// [`IdentifyError`] for a project without a cylinder, files that are no evenly sampled runs, and runs
/// that say nothing.
pub fn friction_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    asked: &FrictionRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    let refused = |message: &str| IdentifyError::Data(message.to_string());
    let loaded = loaded.ok_or_else(|| {
        refused("friction needs the project of the cylinder, for its areas and its moving mass: name it")
    })?;
    if asked.files.is_empty() {
        return Err(refused("there is no recorded run: name the files"));
    }
    let rig = Setup::rig_of(&loaded.project).map_err(|error| refused(&error.to_string()))?;
    let cylinder = rig.actuator.components().cylinder;
    let known =
        KnownCylinder { areas: [cylinder.area_a, cylinder.area_b], moving_mass: cylinder.moving_mass };
    let recordings = friction_recordings(source, &asked.files, &known)?;
    let found = identify_friction(recordings, &known, watch)?;
    let mut files = friction::files(&found);
    if asked.figures {
        let pictures = picture_files(&friction::pictures(&found));
        files.extend(pictures.map_err(|error| refused(&error.to_string()))?);
    }
    Ok(Answer {
        text: friction::text(&found),
        json: friction::json(loaded, &found),
        files,
        affirmative: found.has_converged() && found.estimates.iter().all(|one| one.untold.is_none()),
    })
}
