use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use phea_workbench::answer::Answer;
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, STARTER};

use crate::arguments::{Arguments, Command, Common};
use crate::file_system::{FileSystem, write, write_starter};

/// The answer is yes, no, or the input is wrong.
const DONE: u8 = 0;
const NO: u8 = 1;
const WRONG_INPUT: u8 = 2;

pub(crate) fn run(arguments: Arguments) -> ExitCode {
    let outcome = match arguments.command {
        Command::New { folder } => new(&folder),
        Command::Check(common) => on_project(&common, &Request::Check),
        Command::Size { common, gain, length } => on_project(&common, &Request::Size { gain, length }),
        Command::Linearize(common) => on_project(&common, &Request::Linearize),
        Command::Report(common) => on_project(&common, &Request::Report),
    };
    ExitCode::from(outcome.unwrap_or_else(|message| {
        complain(&message);
        WRONG_INPUT
    }))
}

fn new(folder: &Path) -> Result<u8, String> {
    let path = write_starter(folder, STARTER)?;
    say(&format!("Wrote {}. Next: phea check {0}\n", path.display()));
    Ok(DONE)
}

fn on_project(common: &Common, request: &Request) -> Result<u8, String> {
    let path = common.project.to_string_lossy();
    let loaded = project::read(&FileSystem, &path, &common.settings, &common.catalogues);
    let loaded = match loaded {
        Ok(loaded) => loaded,
        Err(report) => {
            if common.json {
                say(&format!("{}\n", command::refusal_json(request, &report)));
            }
            return Err(report.render(styled()));
        }
    };
    if !loaded.warnings.is_empty() {
        complain(&project::render(&loaded.warnings, &loaded.texts, styled()));
    }
    let answer = command::answer(&FileSystem, &loaded, &common.catalogues, request)
        .map_err(|error| error.to_string())?;
    let written = write_files(common, request, &answer)?;
    if common.json {
        say(&format!("{}\n", answer.json));
    } else {
        say(&answer.text);
        for path in written {
            say(&format!("Wrote {}\n", path.display()));
        }
    }
    Ok(if answer.affirmative { DONE } else { NO })
}

/// The report is written even without `--out`, as one page named after the project; other files only when asked for.
fn write_files(common: &Common, request: &Request, answer: &Answer) -> Result<Vec<PathBuf>, String> {
    if let Some(folder) = &common.out {
        return write(folder, &answer.files);
    }
    if *request != Request::Report {
        return Ok(vec![]);
    }
    let stem = common.project.file_stem().unwrap_or_default().to_string_lossy();
    let mut page: Vec<_> = answer.files.iter().filter(|file| file.name == "report.html").cloned().collect();
    for file in &mut page {
        file.name = format!("{stem}-report.html");
    }
    write(Path::new("."), &page)
}

/// Colours for a person at a terminal who has not asked for none.
fn styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}

#[expect(clippy::print_stdout, reason = "the command's one voice to standard output")]
fn say(text: &str) {
    print!("{text}");
}

#[expect(clippy::print_stderr, reason = "the command's one voice to standard error")]
fn complain(text: &str) {
    eprintln!("{}", text.trim_end());
}
