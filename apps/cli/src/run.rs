mod campaign;
mod identify;

use std::ffi::OsString;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use clap::error::ContextKind;
use phea_files::{FileSystem, Folder, Inputs, expect_folder, reason, write, write_as};
use phea_workbench::answer::{Answer, OutputFile};
use phea_workbench::audit::{CERTIFICATE_FILE, check_certificate, check_certificate_of};
use phea_workbench::command::{
    self, AlternativesRequest, CommandError, FrequencyOptions, OutputNames, Request, SimulateRequest,
};
use phea_workbench::engineering::design::DESIGNED_PROJECT;
use phea_workbench::engineering::linearize::SweepRequest;
use phea_workbench::engineering::shaping::Shaped;
use phea_workbench::project::{self, Loaded, STARTER};
use phea_workbench::shaping::SHAPED_PROJECT;
use phea_workbench::source::Destination;

use crate::arguments::{Arguments, Certified, Command, Common, Several};
use crate::failure::{DONE, Failure, NO, WRONG_INPUT};
use crate::installation::{TITLE_LINE, completions, manual_pages};
use crate::interruption::Interruption;
use crate::messages::{ProgressLine, print, print_error};

/// Runs a command and returns its exit status.
pub(crate) fn run(arguments: Arguments) -> u8 {
    let outcome = match arguments.command {
        Command::New { folder } => new(&folder),
        Command::Schema { answers, out } => schema(answers, out.as_deref()),
        Command::Check(common) => on_project(&common, &Request::Check, None),
        Command::Size { common, gain, length } => on_project(&common, &Request::Size { gain, length }, None),
        Command::Linearize { common, sweep, points } => linearize(&common, sweep, points),
        Command::Verify { common, on_machine, prove, certificate } => {
            let request = Request::Verify { proof: prove || certificate.is_some(), on_machine };
            on_project(&common, &request, certificate.as_deref())
        }
        Command::CheckCertificate(arguments) => print_answer(arguments.json, checked_certificate(&arguments)),
        Command::Shape { common, changes, prefilter, save } => {
            let shaped = if prefilter { Shaped::Prefilter } else { Shaped::Controller };
            on_project(&common, &Request::Shape { shaped, changes: changes.0 }, save.as_deref())
        }
        Command::Design { common, seed, save, no_repair } => {
            let request = Request::Design { seed, stages: common.out.is_some(), repair: !no_repair };
            on_project(&common, &request, save.as_deref())
        }
        Command::Simulate {
            common,
            table,
            no_figures,
            frequency_response,
            frequencies,
            amplitude,
            reference_amplitude,
            check,
        } => {
            let options = FrequencyOptions { frequencies, amplitude, reference_amplitude };
            let request = Request::Simulate(SimulateRequest {
                table: table.unwrap_or_default(),
                figures: common.out.is_some() && !no_figures,
                frequency_response: frequency_response.then_some(options),
                check,
                ledgers: common.json,
            });
            on_project(&common, &request, None)
        }
        Command::Compare(several) => print_answer(several.json, compared(&several)),
        Command::Alternatives { common, front, sweep, points, frequencies } => {
            let files = common.out.is_some();
            let requested = AlternativesRequest { files, front, sweep, points, frequencies };
            on_project(&common, &Request::Alternatives(requested), None)
        }
        Command::Campaign { common, runs, seed, run, threads } => {
            let request = campaign::request(runs, seed, run, (threads, common.out.is_some()));
            print_answer(common.json, campaign::answer_with_files(&common, &request))
        }
        Command::Export { kind, common } => on_project(&common, &Request::Export { kind: kind.kind() }, None),
        Command::Bench(common) => on_project(&common, &Request::Bench, None),
        Command::Identify(recorded) => print_answer(recorded.json, identify::answer_with_files(&recorded)),
        Command::Report { common, alternatives } => {
            on_project(&common, &Request::Report { files: common.out.is_some(), alternatives }, None)
        }
        Command::Completions { shell } => print_file(&completions(shell)),
        Command::Man { out } => manual(out.as_deref()),
    };
    exit_status(outcome)
}

/// Linear models, at one value or over a sweep.
fn linearize(common: &Common, sweep: Option<String>, points: Option<usize>) -> Result<u8, Failure> {
    let sweep = sweep.map(|range| SweepRequest { range, points });
    on_project(common, &Request::Linearize { sweep }, None)
}

/// Prints the reason why a command line is invalid, or the help that it requests, and returns the
/// exit status.
pub(crate) fn usage_error(error: &clap::Error, words: &[OsString]) -> u8 {
    if !error.use_stderr() {
        return exit_status(print(&error.render().to_string()).map(|()| DONE));
    }
    let number = misread_number(error);
    if words.iter().any(|word| word == "--json") {
        let text = number.unwrap_or_else(|| error.to_string());
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        let printed = print(&format!("{}\n", command::failure_json(None, None, message)));
        return exit_status(printed.and(Err(Failure::wrong_input(text))));
    }
    match number {
        Some(text) => print_error(&text),
        None => {
            let _ = error.print();
        }
    }
    WRONG_INPUT
}

/// The usage error of a value that is not a number, with the remedy; `None` for any other error.
fn misread_number(error: &clap::Error) -> Option<String> {
    let context = |kind: ContextKind| error.get(kind).map(ToString::to_string);
    let reason = std::error::Error::source(error)?.to_string();
    let (option, value) = (context(ContextKind::InvalidArg)?, context(ContextKind::InvalidValue)?);
    let with_point = value.replace(',', ".");
    let words = match (reason.as_str(), with_point.parse::<f64>()) {
        ("invalid float literal", Ok(_)) => format!("a comma inside a number; write {with_point}"),
        ("invalid digit found in string", Ok(number)) if number >= 0.0 => {
            let [below, above] = [number.floor(), number.ceil()];
            let remedy = if below == above { format!("{below}") } else { format!("{below} or {above}") };
            format!("a whole number is needed, without comma or point; write {remedy}")
        }
        ("invalid digit found in string", _) => "a whole number is needed, such as 20".to_string(),
        _ => return None,
    };
    let option = option.split(' ').next().unwrap_or_default();
    Some(format!("error: {option} {value}: {words}"))
}

fn exit_status(outcome: Result<u8, Failure>) -> u8 {
    outcome.unwrap_or_else(|failure| {
        print_error(&failure.text);
        failure.status
    })
}

/// Writes the starter project into a folder that must be empty or absent.
fn new(folder: &Path) -> Result<u8, Failure> {
    let occupied = match folder.read_dir() {
        Ok(mut entries) => entries.next().is_some(),
        // a folder that cannot be listed may contain a project
        Err(_) => folder.symlink_metadata().is_ok(),
    };
    if occupied {
        let text = format!("{} exists and is not an empty folder; nothing was written", folder.display());
        return Err(Failure::wrong_input(format!("error: {text}")));
    }
    let file = OutputFile::new("project.toml", STARTER);
    let path = write_as(&folder.join(&file.name), &file, &Inputs::default())
        .map_err(|message| Failure::not_written(&message))?;
    print(&format!("Wrote {}. Next: phea check {0}\n", path.display()))?;
    Ok(DONE)
}

/// The key that identifies a JSON Schema.
const SCHEMA_KEY: &str = "\"$schema\"";

/// A schema, printed or written into a folder, where it replaces nothing but a schema.
fn schema(answers: bool, out: Option<&Path>) -> Result<u8, Failure> {
    let file = if answers { command::answers_schema() } else { command::schema() };
    match out {
        Some(folder) => write_generated(folder, &[file], SCHEMA_KEY, "a schema"),
        None => print_file(&file.bytes),
    }
}

/// The manual page of the program, printed, or all pages written into a folder, where they replace
/// nothing but pages of this manual.
fn manual(out: Option<&Path>) -> Result<u8, Failure> {
    let pages = manual_pages();
    match (out, pages.first()) {
        (Some(folder), _) => write_generated(folder, &pages, TITLE_LINE, "a manual page of phea"),
        (None, first) => print_file(first.map_or(&[], |page| &page.bytes)),
    }
}

fn print_file(bytes: &[u8]) -> Result<u8, Failure> {
    print(&String::from_utf8_lossy(bytes)).map(|()| DONE)
}

/// Writes generated files into a folder; an older file is replaced only if it contains the mark of
/// its kind.
fn write_generated(folder: &Path, files: &[OutputFile], mark: &str, kind: &str) -> Result<u8, Failure> {
    for path in files.iter().map(|file| folder.join(&file.name)) {
        let known = std::fs::read_to_string(&path).unwrap_or_default();
        if path.exists() && !known.contains(mark) {
            let text = format!("{} exists and is not {kind}; nothing was written", path.display());
            return Err(Failure::wrong_input(format!("error: {text}")));
        }
    }
    let written = write(folder, files, &Inputs::default());
    let written = written.map_err(|message| Failure::not_written(&message))?;
    print(&written_sentence(&written)).map(|()| DONE)
}

/// Checks a certificate again.
fn checked_certificate(
    Certified { file, project, settings, .. }: &Certified,
) -> Result<(Answer, Vec<PathBuf>), Failure> {
    let explain = |reason: String| {
        let message = format!("{}: {reason}", file.display());
        let json = command::failure_json(Some("check-certificate"), None, &message);
        Failure::wrong_input(format!("error: {message}")).with_json(json)
    };
    let text = std::fs::read_to_string(file).map_err(|error| explain(reason(&error)))?;
    let answer = match project {
        None => check_certificate(&text),
        Some(project) => {
            let loaded = load(&project.to_string_lossy(), settings, &[], "check-certificate")?;
            let problem = command::robust_problem_of(&FileSystem, &loaded, &mut |_| true)
                .map_err(|error| explain(error.to_string()))?;
            check_certificate_of(&text, &problem)
        }
    };
    Ok((answer.map_err(|error| explain(error.to_string()))?, vec![]))
}

/// Answers a request on a project; if a path is named, the designed or shaped project or the
/// certificate is also written to it.
fn on_project(common: &Common, request: &Request, save: Option<&Path>) -> Result<u8, Failure> {
    print_answer(common.json, answer_with_files(common, request, save))
}

/// Prints an answer with the files that were written, or the reason why there is none.
fn print_answer(json: bool, outcome: Result<(Answer, Vec<PathBuf>), Failure>) -> Result<u8, Failure> {
    match outcome {
        Ok((answer, _)) if json => print(&format!("{}\n", answer.json)).map(|()| status(&answer)),
        Ok((answer, written)) => {
            print(&format!("{}{}", answer.text(), written_sentence(&written))).map(|()| status(&answer))
        }
        Err(failure) => {
            if json {
                print(&format!("{}\n", failure.json))?;
            }
            Err(failure)
        }
    }
}

/// Several projects in one answer.
fn compared(several: &Several) -> Result<(Answer, Vec<PathBuf>), Failure> {
    let request = Request::Compare;
    let paths = several.projects.iter().map(|path| path.to_string_lossy());
    let loaded = paths.map(|path| load(&path, &several.settings, &several.catalogues, request.name()));
    let loaded = loaded.collect::<Result<Vec<_>, _>>()?;
    // the command line requires at least one project
    let Some(first) = loaded.first() else {
        return Err(Failure::wrong_input("error: no project"));
    };
    let inputs = Inputs::of_projects(&loaded);
    reject_replaced_inputs(&inputs, (&request, first), [several.out.as_deref(), None])?;
    expect_folders([several.out.as_deref(), None]).map_err(|message| failed(&request, first, &message))?;
    let mut line = ProgressLine::default();
    let interruption = Interruption::listen();
    let figures = several.out.is_some();
    let answer = command::compare_watched(&FileSystem, &loaded, figures, &mut |progress| {
        line.show(progress);
        !interruption.is_requested()
    });
    line.clear();
    let answer = answer.map_err(|error| refused(first, &request, (&error, line.stage())))?;
    let written = match &several.out {
        Some(folder) => {
            write(folder, &answer.files, &inputs).map_err(|message| failed(&request, first, &message))?
        }
        None => vec![],
    };
    Ok((answer, written))
}

fn status(answer: &Answer) -> u8 {
    if answer.affirmative { DONE } else { NO }
}

/// Returns the answer, and the files that were written.
fn answer_with_files(
    common: &Common,
    request: &Request,
    save: Option<&Path>,
) -> Result<(Answer, Vec<PathBuf>), Failure> {
    let path = common.project.to_string_lossy();
    let loaded = load(&path, &common.settings, &common.catalogues, request.name())?;
    let explain = |message: String| failed(request, &loaded, &message);
    let inputs = Inputs::of_projects([&loaded]);
    let page = default_report_path(common, request);
    reject_replaced_inputs(&inputs, (request, &loaded), [common.out.as_deref(), save.or(page.as_deref())])?;
    expect_folders([common.out.as_deref(), save.and_then(Path::parent)]).map_err(explain)?;
    let mut line = ProgressLine::default();
    // commands that can return their best result so far receive a stop request; all others have
    // nothing to save
    let returns_partial_result =
        matches!(request, Request::Design { .. } | Request::Simulate(_) | Request::Alternatives(_));
    let interruption = returns_partial_result.then(Interruption::listen);
    let tables = common.out.as_deref().map(|folder| Folder::new(folder, &inputs));
    let destination = tables.as_ref().map(|tables| tables as &dyn Destination);
    let mut watch = |progress| {
        line.show(progress);
        !interruption.as_ref().is_some_and(Interruption::is_requested)
    };
    let catalogues = &common.catalogues;
    let answer = command::answer_into(&FileSystem, &loaded, catalogues, request, destination, &mut watch);
    line.clear();
    let answer = answer.map_err(|error| refused(&loaded, request, (&error, line.stage())))?;
    let mut written = tables.map(Folder::into_begun).unwrap_or_default();
    written.extend(match (&common.out, &page) {
        (Some(folder), _) => write(folder, &answer.files, &inputs).map_err(explain)?,
        (None, Some(page)) => {
            let file = answer.files.iter().map(|file| write_as(page, file, &inputs));
            file.collect::<Result<Vec<_>, _>>().map_err(explain)?
        }
        (None, None) => vec![],
    });
    let saved = [DESIGNED_PROJECT, SHAPED_PROJECT, CERTIFICATE_FILE];
    let saved = answer.files.iter().find(|file| saved.contains(&file.name.as_str()));
    if let (Some(path), Some(saved)) = (save, saved) {
        written.insert(0, write_as(path, saved, &inputs).map_err(explain)?);
    }
    Ok((answer, written))
}

/// Rejects the folders of `--out` and `--save` that cannot be created.
fn expect_folders(folders: [Option<&Path>; 2]) -> Result<(), String> {
    folders.into_iter().flatten().try_for_each(expect_folder)
}

/// Reads a project and prints its warnings.
fn load(path: &str, settings: &[String], catalogues: &[String], command: &str) -> Result<Loaded, Failure> {
    let loaded = project::read(&FileSystem, path, settings, catalogues).map_err(|report| {
        let json = command::refusal_json(&FileSystem, path, command, &report);
        Failure::wrong_input(report.render(styled())).with_json(json)
    })?;
    if !loaded.warnings.is_empty() {
        print_error(&project::render(&loaded.warnings, &loaded.texts, styled()));
    }
    Ok(loaded)
}

/// Failure of a request without an answer; `stage` is the last reported one.
fn refused(loaded: &Loaded, request: &Request, (error, stage): (&CommandError, Option<&str>)) -> Failure {
    if let CommandError::Stopped(_) = error {
        let message = command::stopped_text(request, stage);
        let json = command::failure_json(Some(request.name()), Some(&loaded.sha256), &message);
        return Failure::stopped(&message).with_json(json);
    }
    let failure = match error.refusal() {
        _ if error.is_of_files() => Failure::not_written(&error.to_string()),
        Some(report) => Failure::wrong_input(report.render(styled())),
        None => Failure::wrong_input(format!("error: {error}")),
    };
    failure.with_json(command::error_json(loaded, request, error))
}

/// Failure of writing.
fn failed(request: &Request, loaded: &Loaded, message: &str) -> Failure {
    let json = command::failure_json(Some(request.name()), Some(&loaded.sha256), message);
    Failure::not_written(message).with_json(json)
}

fn written_sentence(written: &[PathBuf]) -> String {
    match written {
        [] => String::new(),
        [only] => format!("Wrote {}\n", only.display()),
        [first, _] => format!("Wrote {} and one more file next to it\n", first.display()),
        [first, more @ ..] => {
            format!("Wrote {} and {} more files next to it\n", first.display(), more.len())
        }
    }
}

/// Path of a report without `--out`: one page named after the project.
fn default_report_path(common: &Common, request: &Request) -> Option<PathBuf> {
    let is_default = common.out.is_none() && matches!(request, Request::Report { .. });
    let stem = common.project.file_stem().unwrap_or_default().to_string_lossy();
    is_default.then(|| Path::new(".").join(format!("{stem}-report.html")))
}

/// Rejects, before any work, a folder or a file in which the answer would replace an input.
fn reject_replaced_inputs(
    inputs: &Inputs,
    (request, loaded): (&Request, &Loaded),
    [folder, file]: [Option<&Path>; 2],
) -> Result<(), Failure> {
    let names = OutputNames::of(loaded, request);
    let in_folder =
        folder.map_or(Ok(()), |folder| inputs.reject_replacement_in(folder, |name| names.contains(name)));
    let outcome = in_folder.and_then(|()| file.map_or(Ok(()), |file| inputs.reject_replacement(file)));
    outcome.map_err(|message| {
        let json = command::failure_json(Some(request.name()), Some(&loaded.sha256), &message);
        Failure::wrong_input(format!("error: {message}")).with_json(json)
    })
}

/// Colours for a person at a terminal who has not disabled them.
fn styled() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none()
}
