//! `identify`: recorded tests with or without a project.

use std::path::{Path, PathBuf};

use phea_files::{FileSystem, Inputs, write};
use phea_workbench::answer::Answer;
use phea_workbench::command::{
    self, FrictionRequest, IdentifyError, IdentifyRequest, LeakageModel, LineRequest, OutputNames,
    ResponseRequest, ResponseSettings,
};
use phea_workbench::project::{LineSide, Loaded};
use phea_workbench::quantity::{self, TIME};

use super::{load, styled};
use crate::arguments::{ChamberWord, IdentifyArguments, LeakageWord, SubjectWord};
use crate::failure::Failure;
use crate::interruption::Interruption;
use crate::messages::ProgressLine;

/// Name of the command.
const NAME: &str = "identify";

/// The answer, and the files that were written.
pub(super) fn answer_with_files(recorded: &IdentifyArguments) -> Result<(Answer, Vec<PathBuf>), Failure> {
    check_subject(recorded)?;
    let (project, files) = named(recorded)?;
    let loaded = project.map(|path| load(&path, &recorded.settings, &[], NAME)).transpose()?;
    let inputs = protected_inputs(recorded, loaded.as_ref(), &files)?;
    let request = IdentifyRequest {
        files,
        starts: recorded.starts.map(usize::from),
        seed: recorded.seed.unwrap_or(1),
        bootstrap: recorded.bootstrap.map_or(0, |count| count as usize),
        figures: recorded.out.is_some(),
        leakage_model: recorded.leakage_model.map(|word| match word {
            LeakageWord::EachEdge => LeakageModel::EachEdge,
            LeakageWord::OneCurve => LeakageModel::OneCurve,
        }),
    };
    let settings = response_settings(recorded)?;
    let mut line = ProgressLine::default();
    let interruption = Interruption::listen();
    let watch = &mut |progress| {
        line.show(progress);
        !interruption.is_requested()
    };
    let answer = match recorded.of {
        SubjectWord::Valve => command::identify_watched(&FileSystem, loaded.as_ref(), &request, watch),
        SubjectWord::Response => {
            let request = ResponseRequest { files: request.files, settings, figures: recorded.out.is_some() };
            command::response_watched(&FileSystem, loaded.as_ref(), &request, watch)
        }
        SubjectWord::Line => {
            let settings = ResponseSettings { coherence: recorded.coherence.unwrap_or(0.0), ..settings };
            let figures = recorded.out.is_some();
            let side = recorded.side.map(side_of);
            let request = LineRequest { files: request.files, side, settings, figures };
            command::line_watched(&FileSystem, loaded.as_ref(), &request, watch)
        }
        SubjectWord::Friction => {
            let request = FrictionRequest { files: request.files, figures: recorded.out.is_some() };
            command::friction_watched(&FileSystem, loaded.as_ref(), &request, watch)
        }
    };
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

/// Rejects options that the identification of the named subject does not have.
fn check_subject(recorded: &IdentifyArguments) -> Result<(), Failure> {
    const VALVE: &[SubjectWord] = &[SubjectWord::Valve];
    const RESPONSES: &[SubjectWord] = &[SubjectWord::Response, SubjectWord::Line];
    let options = [
        ("starts", recorded.starts.is_some(), VALVE),
        ("seed", recorded.seed.is_some(), VALVE),
        ("bootstrap", recorded.bootstrap.is_some(), VALVE),
        ("leakage-model", recorded.leakage_model.is_some(), VALVE),
        ("period", recorded.period.is_some(), RESPONSES),
        ("settling", recorded.settling.is_some(), RESPONSES),
        ("segment", recorded.segment.is_some(), RESPONSES),
        ("coherence", recorded.coherence.is_some(), RESPONSES),
        ("side", recorded.side.is_some(), &[SubjectWord::Line]),
    ];
    let unfit = options.iter().find(|(_, stated, subjects)| *stated && !subjects.contains(&recorded.of));
    let Some((name, _, subjects)) = unfit else { return Ok(()) };
    let takes: Vec<String> = subjects.iter().map(|subject| format!("`--of {}`", subject.name())).collect();
    let message = format!(
        "`--{name}` has no effect on `--of {}`: it belongs to {}",
        recorded.of.name(),
        takes.join(" and ")
    );
    Err(refused(&message))
}

/// Failure of an invalid command line.
fn refused(message: &str) -> Failure {
    let json = command::failure_json(Some(NAME), None, message);
    Failure::wrong_input(format!("error: {message}")).with_json(json)
}

/// Settings of a frequency response; an error if a time is not positive.
fn response_settings(recorded: &IdentifyArguments) -> Result<ResponseSettings, Failure> {
    let times =
        [("period", &recorded.period), ("settling", &recorded.settling), ("segment", &recorded.segment)];
    let coherence = recorded.coherence;
    if let Some(value) = coherence.filter(|value| !(0.0..1.0).contains(value)) {
        return Err(refused(&format!("`--coherence {value}` is not from 0 to below 1")));
    }
    let seconds = |(name, text): (&str, &Option<String>)| {
        let Some(text) = text else { return Ok(None) };
        match quantity::parse(text, &TIME) {
            Ok(value) if value > 0.0 || (value == 0.0 && name == "settling") => Ok(Some(value)),
            Ok(_) => Err(refused(&format!("`--{name} {text}` is not a positive time"))),
            Err(error) => Err(refused(&format!("`--{name} {text}`: {error}"))),
        }
    };
    let [period, settling, segment] = times.map(seconds);
    let usual = ResponseSettings::default();
    Ok(ResponseSettings {
        period: period?,
        settling: settling?,
        segment: segment?,
        coherence: coherence.unwrap_or(usual.coherence),
    })
}
