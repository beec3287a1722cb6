use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use phea_workbench::answer::{Answer, OutputFile};
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, Loaded, STARTER};
use phea_workbench::shaping::Shaped;

use crate::arguments::{Arguments, Command, Common};
use crate::file_system::{FileSystem, write, write_starter};
use crate::voice::{ProgressLine, complain, say};

/// The answer is yes, no, or the input is wrong.
const DONE: u8 = 0;
const NO: u8 = 1;
const WRONG_INPUT: u8 = 2;

/// Why there is no answer: for people, and as one JSON object.
struct Refused {
    text: String,
    json: String,
}

pub(crate) fn run(arguments: Arguments) -> ExitCode {
    let outcome = match arguments.command {
        Command::New { folder } => new(&folder),
        Command::Check(common) => on_project(&common, &Request::Check),
        Command::Size { common, gain, length } => on_project(&common, &Request::Size { gain, length }),
        Command::Linearize(common) => on_project(&common, &Request::Linearize),
        Command::Verify(common) => on_project(&common, &Request::Verify),
        Command::Shape { common, changes, prefilter, save } => {
            let shaped = if prefilter { Shaped::Prefilter } else { Shaped::Controller };
            shape(&common, &Request::Shape { shaped, changes: changes.0 }, save.as_deref())
        }
        Command::Report(common) => {
            let request = if common.out.is_some() { Request::Report } else { Request::Page };
            on_project(&common, &request)
        }
    };
    ended(outcome)
}

/// A command line that is none, or that asks for help.
pub(crate) fn misused(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return ended(say(&error.render().to_string()).map(|()| DONE));
    }
    if std::env::args_os().any(|argument| argument == "--json") {
        let text = error.to_string();
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        return ended(say(&format!("{}\n", command::failure_json(None, None, message))).and(Err(text)));
    }
    let _ = error.print();
    ExitCode::from(WRONG_INPUT)
}

fn ended(outcome: Result<u8, String>) -> ExitCode {
    ExitCode::from(outcome.unwrap_or_else(|message| {
        complain(&message);
        WRONG_INPUT
    }))
}

fn new(folder: &Path) -> Result<u8, String> {
    let path = write_starter(folder, STARTER).map_err(|message| format!("error: {message}"))?;
    say(&format!("Wrote {}. Next: phea check {0}\n", path.display()))?;
    Ok(DONE)
}

fn on_project(common: &Common, request: &Request) -> Result<u8, String> {
    told(common, answered(common, request))
}

/// The changed project, the first of the files, is written where `--save` says and nowhere else.
fn shape(common: &Common, request: &Request, save: Option<&Path>) -> Result<u8, String> {
    let unwritten = Common { out: None, ..common.clone() };
    let outcome = answered(&unwritten, request).and_then(|(answer, _)| {
        let written = write_shaped(common.out.as_deref(), save, &answer).map_err(|message| Refused {
            text: format!("error: {message}"),
            json: command::failure_json(Some(request.name()), None, &message),
        })?;
        Ok((answer, written))
    });
    told(common, outcome)
}

fn write_shaped(out: Option<&Path>, save: Option<&Path>, answer: &Answer) -> Result<Vec<PathBuf>, String> {
    let Some((project, others)) = answer.files.split_first() else { return Ok(vec![]) };
    let mut written = Vec::new();
    if let Some(path) = save {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        write(folder, &[OutputFile { name, ..project.clone() }])?;
        written.push(path.to_path_buf());
    }
    if let Some(folder) = out {
        written.extend(write(folder, others)?);
    }
    Ok(written)
}

fn told(common: &Common, outcome: Result<(Answer, Vec<PathBuf>), Refused>) -> Result<u8, String> {
    match outcome {
        Ok((answer, _)) if common.json => say(&format!("{}\n", answer.json)).map(|()| status(&answer)),
        Ok((answer, written)) => {
            say(&format!("{}{}", answer.text, written_sentence(&written))).map(|()| status(&answer))
        }
        Err(refused) => {
            if common.json {
                say(&format!("{}\n", refused.json))?;
            }
            Err(refused.text)
        }
    }
}

fn status(answer: &Answer) -> u8 {
    if answer.affirmative { DONE } else { NO }
}

/// The answer, and the files that were written.
fn answered(common: &Common, request: &Request) -> Result<(Answer, Vec<PathBuf>), Refused> {
    let path = common.project.to_string_lossy();
    let loaded =
        project::read(&FileSystem, &path, &common.settings, &common.catalogues).map_err(|report| {
            Refused {
                json: command::refusal_json(&FileSystem, &path, request, &report),
                text: report.render(styled()),
            }
        })?;
    if !loaded.warnings.is_empty() {
        complain(&project::render(&loaded.warnings, &loaded.texts, styled()));
    }
    let mut line = ProgressLine::default();
    let answer =
        command::answer_watched(&FileSystem, &loaded, &common.catalogues, request, &mut |progress| {
            line.show(progress)
        });
    line.clear();
    let answer = answer.map_err(|error| Refused {
        json: command::error_json(&loaded, request, &error),
        text: match error.refusal() {
            Some(report) => report.render(styled()),
            None => format!("error: {error}"),
        },
    })?;
    let written =
        write_files(common, request, &answer).map_err(|message| failed(request, &loaded, &message))?;
    Ok((answer, written))
}

fn failed(request: &Request, loaded: &Loaded, message: &str) -> Refused {
    Refused {
        text: format!("error: {message}"),
        json: command::failure_json(Some(request.name()), Some(&loaded.sha256), message),
    }
}

fn written_sentence(written: &[PathBuf]) -> String {
    match written {
        [] => String::new(),
        [only] => format!("Wrote {}\n", only.display()),
        [first, more @ ..] => {
            format!("Wrote {} and {} more files beside it\n", first.display(), more.len())
        }
    }
}

/// The report is written even without `--out`, as one page named after the project; other files only when asked for.
fn write_files(common: &Common, request: &Request, answer: &Answer) -> Result<Vec<PathBuf>, String> {
    if let Some(folder) = &common.out {
        return write(folder, &answer.files);
    }
    if *request != Request::Page {
        return Ok(vec![]);
    }
    let stem = common.project.file_stem().unwrap_or_default().to_string_lossy();
    let mut page = answer.files.clone();
    for file in &mut page {
        file.name = format!("{stem}-report.html");
    }
    write(Path::new("."), &page)
}

/// Colours for a person at a terminal who has not asked for none.
fn styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}
