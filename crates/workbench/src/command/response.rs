//! `identify --of response`: frequency responses from recorded signals.

use crate::answer::{Answer, picture_files};
use crate::identify::IdentifyError;
use crate::project::Loaded;
use crate::response::{self, Compared, ResponseSettings, members, sampled_pairs};
use crate::setup::Setup;
use crate::source::Source;

use super::Watch;

/// What is estimated, and from which files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResponseRequest {
    /// Records, one for each member.
    pub files: Vec<String>,
    /// How.
    pub settings: ResponseSettings,
    /// Whether diagrams are among the files of the answer.
    pub figures: bool,
}

/// Estimates the response of each file, compared with the linear plant of a project where there is
/// one.
///
/// # Errors
/// [`IdentifyError`] for files that are not evenly sampled records, and records that say nothing.
pub fn response_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    asked: &ResponseRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    if asked.files.is_empty() {
        return Err(IdentifyError::Data("there is no record: name a file for each member".to_string()));
    }
    let records = sampled_pairs(source, &asked.files)?;
    let found = members(&records, &asked.settings, watch)?;
    let rig = loaded
        .filter(|loaded| loaded.project.actuator.is_some())
        .map(|loaded| Setup::rig_of(&loaded.project))
        .transpose()
        .map_err(|error| IdentifyError::Data(error.to_string()))?;
    let found: Vec<Compared> = found.into_iter().map(|member| Compared::with(member, rig.as_ref())).collect();
    let drawn = if asked.figures { response::pictures(&found) } else { Vec::new() };
    let pictures = picture_files(&drawn);
    let files = response::files(&found).into_iter().chain(pictures).collect();
    Ok(Answer {
        text: response::document(&found).text(),
        json: response::json(loaded, &found),
        files,
        affirmative: true,
    })
}
