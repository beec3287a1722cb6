//! The JSON if a command has no answer.

use super::{CommandError, Request};
use crate::answer::{Answer, Body, SCHEMA, VERSION, words};
use crate::project::{Diagnostic, Loaded, Refusal, Severity, sha256};
use crate::quantity::MotionKind;
use crate::source::Source;

/// Errors of a command that has no answer.
#[derive(Answer)]
pub(super) struct RefusedAnswer {
    /// Version of the layout of answers.
    schema: u32,
    /// Version of phea.
    version: &'static str,
    /// Name of the command; null if the command line is invalid.
    command: Option<String>,
    /// SHA-256 of the bytes of the project file; null if it was not read.
    project_sha256: Option<String>,
    /// Errors, and warnings found with them.
    errors: Vec<DiagnosticAnswer>,
}

/// Error or warning in a file, or of the command line.
#[derive(Answer)]
struct DiagnosticAnswer {
    /// Severity of the finding.
    severity: Severity,
    /// Sentence on the finding.
    message: String,
    /// Path of the file; null if no file is concerned.
    file: Option<String>,
    /// Line in the file, from 1; null if none is concerned.
    line: Option<usize>,
    /// Column in the line, from 1; null if none is concerned.
    column: Option<usize>,
    /// Line and column after the last character of the place; null if none is concerned.
    end: Option<[usize; 2]>,
    /// Expected value, if it can be named.
    expected: Option<String>,
    /// Change that would help, if one is known.
    help: Option<String>,
}

words! {
    /// Severity of a finding.
    Severity { Error => "error", Warning => "warning" }
}

/// The JSON object of a command whose project, at `path`, was rejected.
pub fn refusal_json(source: &dyn Source, path: &str, command: &str, refusal: &Refusal) -> String {
    let hash = source.read(path).ok().map(|bytes| sha256(&bytes));
    refusal_body(Some(command), hash.as_deref(), refusal_rows(refusal))
}

/// The JSON object of a command that has no answer on a valid project: a row for every finding in
/// its files, or one for the error itself.
pub fn error_json(loaded: &Loaded, request: &Request, error: &CommandError) -> String {
    let (command, hash) = (Some(request.name()), Some(loaded.sha256.as_str()));
    match error.refusal() {
        Some(refusal) => refusal_body(command, hash, refusal_rows(refusal)),
        None => failure_json(command, hash, &error.to_string()),
    }
}

/// Reason why a command that was stopped has no answer: the stage that was running (none before the
/// first), and the stages that were not begun.
///
/// # Example
/// ```
/// use phea_workbench::command::{Request, stopped_text};
/// let text = stopped_text(&Request::Design { seed: None, stages: false, repair: true }, Some("trying PI"));
/// assert!(text.starts_with("stopped in the stage `trying PI`: no controller was found yet"));
/// assert!(stopped_text(&Request::Bench, None).starts_with("stopped before the first stage: there is no result"));
/// ```
pub fn stopped_text(request: &Request, stage: Option<&str>) -> String {
    let place = stage.map_or("before the first stage".to_string(), |stage| format!("in the stage `{stage}`"));
    let missing = match request {
        Request::Design { .. } => {
            "no controller was found yet, so that its audit, its trial on the nonlinear rig and its proof were not begun"
        }
        _ => "there is no result yet",
    };
    format!("stopped {place}: {missing}; nothing was written")
}

/// Returns the JSON object of a command whose other files were rejected.
pub fn files_json(command: &str, project_sha256: Option<&str>, refusal: &Refusal) -> String {
    refusal_body(Some(command), project_sha256, refusal_rows(refusal))
}

fn refusal_rows(refusal: &Refusal) -> Vec<DiagnosticAnswer> {
    refusal.diagnostics.iter().map(refusal_row).collect()
}

fn refusal_row(found: &Diagnostic) -> DiagnosticAnswer {
    let place = |number: usize| Some(number).filter(|number| *number > 0);
    DiagnosticAnswer {
        severity: found.severity,
        message: found.message.clone(),
        file: Some(found.file.clone()),
        line: place(found.line),
        column: place(found.column),
        end: found.end,
        expected: found.expected.clone(),
        help: found.help.clone(),
    }
}

/// The JSON object of a command that failed for another reason than its project file; `command` is
/// absent if the command line is invalid.
///
/// # Example
/// ```
/// let json = phea_workbench::command::failure_json(Some("size"), None, "cannot write out: permission denied");
/// assert!(json.contains("\"command\": \"size\"") && json.contains("permission denied"));
/// ```
pub fn failure_json(command: Option<&str>, project_sha256: Option<&str>, message: &str) -> String {
    let row = DiagnosticAnswer {
        severity: Severity::Error,
        message: message.to_string(),
        file: None,
        line: None,
        column: None,
        end: None,
        expected: None,
        help: None,
    };
    refusal_body(command, project_sha256, vec![row])
}

fn refusal_body(
    command: Option<&str>,
    project_sha256: Option<&str>,
    errors: Vec<DiagnosticAnswer>,
) -> String {
    let body = RefusedAnswer {
        schema: SCHEMA,
        version: VERSION,
        command: command.map(str::to_string),
        project_sha256: project_sha256.map(str::to_string),
        errors,
    };
    body.into_object().print(MotionKind::default())
}
