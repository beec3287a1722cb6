//! `identify --of response`: frequency responses from recorded signals.

use phea_engineering::identify_error::{IdentifyError, NothingToIdentify};
use phea_engineering::response::{ResponseSettings, TestController, compare_levels, members, sampled_pairs};
use phea_engineering::setup::Setup;

use crate::answer::{Answer, picture_files};
use crate::project::{Loaded, RecordedController, RecordedResponse};
use crate::response::{self, Compared};
use crate::source::Source;

use super::Watch;

/// Request for the estimation of responses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResponseRequest {
    /// Records, one for each member.
    pub files: Vec<String>,
    /// Settings of the estimation.
    pub settings: ResponseSettings,
    /// True if diagrams are among the files of the answer.
    pub figures: bool,
}

/// The records that a project declares, with unchanged paths.
fn declared(loaded: Option<&Loaded>) -> Vec<RecordedResponse> {
    let Some((project, identify)) =
        loaded.and_then(|loaded| Some((&loaded.project, loaded.project.identify.as_ref()?)))
    else {
        return Vec::new();
    };
    let with_path =
        |one: &RecordedResponse| RecordedResponse { file: project.path_of(&one.file), ..one.clone() };
    identify.responses.iter().map(with_path).collect()
}

/// Estimates the response of each file, and compares it with the linear plant of a project, if
/// there is one.
///
/// # Errors
/// [`IdentifyError`] for files that are not evenly sampled records, and for records without
/// information.
pub fn response_watched(
    source: &dyn Source,
    loaded: Option<&Loaded>,
    request: &ResponseRequest,
    watch: Watch<'_>,
) -> Result<Answer, IdentifyError> {
    let declared = declared(loaded);
    let of_file = |file: &String| {
        let known = declared.iter().find(|one| one.file == *file).cloned();
        known.unwrap_or_else(|| RecordedResponse::of(file))
    };
    let files =
        if request.files.is_empty() { declared.clone() } else { request.files.iter().map(of_file).collect() };
    if files.is_empty() {
        return Err(NothingToIdentify::NoRecord.into());
    }
    let mut records = sampled_pairs(source, &files)?;
    let by_controller =
        |one: &RecordedResponse| one.recorded_controller == Some(RecordedController::Declared);
    if let Some(loaded) = loaded.filter(|_| files.iter().any(by_controller)) {
        let controller = TestController::declared(&loaded.project)?.map(Box::new);
        for (record, _) in records.iter_mut().zip(&files).filter(|(_, file)| by_controller(file)) {
            record.controller.clone_from(&controller);
        }
    }
    let found = members(&records, &request.settings, watch)?;
    let comparisons = compare_levels(&found);
    let rig = loaded
        .filter(|loaded| loaded.project.actuator.is_some())
        .map(|loaded| Setup::rig_of(&loaded.project))
        .transpose()?;
    let found: Vec<Compared> = found.into_iter().map(|member| Compared::with(member, rig.as_ref())).collect();
    let drawn = if request.figures { response::pictures(&found) } else { Vec::new() };
    let pictures = picture_files(&drawn);
    let files = response::files(&found).into_iter().chain(pictures).collect();
    Ok(Answer {
        document: response::document(&found, &comparisons),
        json: response::json(loaded, &found, &comparisons),
        files,
        affirmative: true,
    })
}
