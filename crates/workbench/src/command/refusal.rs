//! What a program is told where a command has no answer.

use serde::Serialize;

use super::{CommandError, Request};
use crate::answer;
use crate::project::{Loaded, Refusal, Severity, sha256};
use crate::source::Source;

#[derive(Serialize)]
struct RefusalBody<'a> {
    schema: u32,
    version: &'static str,
    command: Option<&'a str>,
    project_sha256: Option<&'a str>,
    errors: Vec<RefusalRow<'a>>,
}

#[derive(Serialize)]
struct RefusalRow<'a> {
    severity: &'static str,
    message: &'a str,
    file: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
    expected: Option<&'a str>,
    help: Option<&'a str>,
}

/// The JSON object of a command whose project, at `path`, was refused.
pub fn refusal_json(source: &dyn Source, path: &str, command: &str, refusal: &Refusal) -> String {
    let hash = source.read(path).ok().map(|bytes| sha256(&bytes));
    refusal_body(Some(command), hash.as_deref(), refusal_rows(refusal))
}

/// The JSON object of a command that has no answer on a sound project: a row for every finding in its files, or one for the
/// error itself.
pub fn error_json(loaded: &Loaded, request: &Request, error: &CommandError) -> String {
    let (command, hash) = (Some(request.name()), Some(loaded.sha256.as_str()));
    match error.refusal() {
        Some(refusal) => refusal_body(command, hash, refusal_rows(refusal)),
        None => failure_json(command, hash, &error.to_string()),
    }
}

/// The JSON object of a command whose files beside a project were refused.
pub fn files_json(command: &str, project_sha256: Option<&str>, refusal: &Refusal) -> String {
    refusal_body(Some(command), project_sha256, refusal_rows(refusal))
}

fn refusal_rows(refusal: &Refusal) -> Vec<RefusalRow<'_>> {
    let place = |number: usize| Some(number).filter(|number| *number > 0);
    let rows = refusal.diagnostics.iter().map(|diagnostic| RefusalRow {
        severity: if diagnostic.severity == Severity::Error { "error" } else { "warning" },
        message: &diagnostic.message,
        file: Some(&diagnostic.file),
        line: place(diagnostic.line),
        column: place(diagnostic.column),
        expected: diagnostic.expected.as_deref(),
        help: diagnostic.help.as_deref(),
    });
    rows.collect()
}

/// The JSON object of a command that failed beyond its project file; `command` is absent where the command line is none.
///
/// # Example
/// ```
/// let json = phea_workbench::command::failure_json(Some("size"), None, "cannot write out: permission denied");
/// assert!(json.contains("\"command\": \"size\"") && json.contains("permission denied"));
/// ```
pub fn failure_json(command: Option<&str>, project_sha256: Option<&str>, message: &str) -> String {
    let error = RefusalRow {
        severity: "error",
        message,
        file: None,
        line: None,
        column: None,
        expected: None,
        help: None,
    };
    refusal_body(command, project_sha256, vec![error])
}

fn refusal_body(command: Option<&str>, project_sha256: Option<&str>, errors: Vec<RefusalRow<'_>>) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let body = RefusalBody { schema: answer::SCHEMA, version, command, project_sha256, errors };
    serde_json::to_string_pretty(&body).unwrap_or_default()
}
