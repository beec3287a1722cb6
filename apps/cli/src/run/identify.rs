//! `identify`: recorded tests with or without a project.

use std::path::{Path, PathBuf};

use phea_files::{FileSystem, Inputs, write};
use phea_workbench::answer::Answer;
use phea_workbench::command::{
    self, IdentificationRequest, IdentifyError, IdentifyOptions, LeakageModel, OptionSpelling, OutputNames,
};
use phea_workbench::project::{LineSide, Loaded};

use super::{load, styled};
use crate::arguments::{ChamberWord, IdentifyArguments, LeakageWord};
use crate::failure::Failure;
use crate::interruption::Interruption;
use crate::messages::ProgressLine;

/// Name of the command.
const NAME: &str = "identify";

/// The answer, and the files that were written.
pub(super) fn answer_with_files(recorded: &IdentifyArguments) -> Result<(Answer, Vec<PathBuf>), Failure> {
    let (project, files) = named(recorded)?;
    let request = request(recorded, &files)?;
    let loaded = project.map(|path| load(&path, &recorded.settings, &[], NAME)).transpose()?;
    let inputs = protected_inputs(recorded, loaded.as_ref(), &files)?;
    let mut line = ProgressLine::default();
    let interruption = Interruption::listen();
    let watch = &mut |progress| {
        line.show(progress);
        !interruption.is_requested()
    };
    let answer = command::identification_watched(&FileSystem, loaded.as_ref(), &request, watch);
    line.clear();
    let hash = loaded.as_ref().map(|loaded| loaded.sha256.as_str());
    let explain = |message: &str| command::failure_json(Some(NAME), hash, message);
    let answer = answer.map_err(|error| unanswered(&error, line.stage(), hash))?;
    let written = match &recorded.out {
        Some(folder) => write(folder, &answer.files, &inputs)
            .map_err(|message| Failure::not_written(&message).with_json(explain(&message)))?,
        None => vec![],
    };
    Ok((answer, written))
}

/// The request of a command line.
fn request(recorded: &IdentifyArguments, files: &[String]) -> Result<IdentificationRequest, Failure> {
    let options = IdentifyOptions {
        of: recorded.of.part(),
        files: files.to_vec(),
        starts: recorded.starts.map(usize::from),
        seed: recorded.seed,
        bootstrap: recorded.bootstrap.map(|count| count as usize),
        leakage_model: recorded.leakage_model.map(|word| match word {
            LeakageWord::EachEdge => LeakageModel::EachEdge,
            LeakageWord::OneCurve => LeakageModel::OneCurve,
        }),
        period: recorded.period.clone(),
        settling: recorded.settling.clone(),
        segment: recorded.segment.clone(),
        coherence: recorded.coherence,
        side: recorded.side.map(side_of),
        figures: recorded.out.is_some(),
    };
    options.request().map_err(|fault| refused(&fault.words(OptionSpelling::CommandLine)))
}

/// Failure of an identification without an answer; `stage` is the last reported one.
fn unanswered(error: &IdentifyError, stage: Option<&str>, hash: Option<&str>) -> Failure {
    let explain = |message: &str| command::failure_json(Some(NAME), hash, message);
    match error {
        IdentifyError::Stopped => {
            let stage = stage.map_or(String::new(), |stage| format!(" in the stage `{stage}`"));
            let message = format!("stopped{stage}: there is no result yet; nothing was written");
            Failure::stopped(&message).with_json(explain(&message))
        }
        IdentifyError::Files(report) => {
            let json = command::files_json(NAME, hash, report);
            Failure::wrong_input(report.render(styled())).with_json(json)
        }
        other => Failure::wrong_input(format!("error: {other}")).with_json(explain(&other.to_string())),
    }
}

/// The files that must remain; an error if a written file would replace one.
fn protected_inputs(
    recorded: &IdentifyArguments,
    loaded: Option<&Loaded>,
    files: &[String],
) -> Result<Inputs, Failure> {
    let inputs = Inputs::of_projects(loaded).and(files.iter().cloned());
    if let Some(folder) = &recorded.out {
        let names = OutputNames::of_identification(files);
        inputs
            .reject_replacement_in(folder, |name| names.contains(name))
            .map_err(|message| refused(&message))?;
    }
    Ok(inputs)
}

/// The project, which may be among the files and is identified by its ending, and the tables.
fn named(recorded: &IdentifyArguments) -> Result<(Option<String>, Vec<String>), Failure> {
    let is_project = |file: &&String| Path::new(file).extension().is_some_and(|ending| ending == "toml");
    let (projects, files): (Vec<&String>, Vec<&String>) = recorded.files.iter().partition(is_project);
    let option = recorded.project.as_ref().map(|path| path.to_string_lossy().into_owned());
    let mut projects = option.into_iter().chain(projects.into_iter().cloned());
    let project = projects.next();
    if projects.next().is_some() {
        return Err(refused("one project describes one rig: several are named"));
    }
    if project.is_none() && !recorded.settings.is_empty() {
        return Err(refused("`--set` changes a project, and none is named"));
    }
    Ok((project, files.into_iter().cloned().collect()))
}

/// The line to a chamber.
fn side_of(chamber: ChamberWord) -> LineSide {
    match chamber {
        ChamberWord::A => LineSide::A,
        ChamberWord::B => LineSide::B,
    }
}

/// Failure of an invalid command line.
fn refused(message: &str) -> Failure {
    let json = command::failure_json(Some(NAME), None, message);
    Failure::wrong_input(format!("error: {message}")).with_json(json)
}
