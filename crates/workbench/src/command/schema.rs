//! The schema of the project file, which needs no project.

use crate::answer::OutputFile;
use crate::project;

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
