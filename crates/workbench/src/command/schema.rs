//! The schemas of the project file and of answers, which need no project.

use super::answers::answers;
use crate::answer::{OutputFile, schema_of};
use crate::project;
use crate::quantity::MotionKind;

/// Name of the file that [`schema`] returns.
pub const SCHEMA_FILE: &str = "phea.schema.json";

/// The JSON Schema of the project file, as the file that editors take.
///
/// # Example
/// ```
/// use phea_workbench::command::{SCHEMA_FILE, schema};
/// let file = schema();
/// assert_eq!(file.name, SCHEMA_FILE);
/// assert!(file.bytes.starts_with(b"{\n") && file.bytes.ends_with(b"}\n"));
/// ```
pub fn schema() -> OutputFile {
    OutputFile::new(SCHEMA_FILE, format!("{:#}\n", project::schema()))
}

/// The name of the file that [`answers_schema`] gives.
pub const ANSWERS_SCHEMA_FILE: &str = "phea.answers.schema.json";

/// The JSON Schema of the answers of all commands.
///
/// # Example
/// ```
/// use phea_workbench::command::{ANSWERS_SCHEMA_FILE, answers_schema};
/// let file = answers_schema();
/// assert_eq!(file.name, ANSWERS_SCHEMA_FILE);
/// assert!(file.bytes.starts_with(b"{\n") && file.bytes.ends_with(b"}\n"));
/// ```
pub fn answers_schema() -> OutputFile {
    let schema = schema_of(&answers()).print(MotionKind::default());
    OutputFile::new(ANSWERS_SCHEMA_FILE, format!("{schema}\n"))
}
