//! Names for programs of a rig that turns: procedures compute and write in those of linear motion.

mod json;

use crate::answer::Object;
use crate::quantity::MotionKind;
use crate::source::OutputFile;

/// What is printed for programs of projects of one motion, with its keys.
pub(crate) fn object(object: Object, motion: MotionKind) -> Object {
    if motion.is_rotary() { json::said(object) } else { object }
}

/// Files of projects of one motion, whose tables have its columns.
pub(crate) fn files(files: Vec<OutputFile>, motion: MotionKind) -> Vec<OutputFile> {
    match motion {
        MotionKind::Linear => files,
        MotionKind::Rotary => files.into_iter().map(said_in).collect(),
    }
}

fn said_in(file: OutputFile) -> OutputFile {
    let OutputFile { name, bytes } = file;
    if !name.ends_with(".csv") {
        return OutputFile { name, bytes };
    }
    match String::from_utf8(bytes) {
        Ok(text) => OutputFile::new(name, headings(&text)),
        Err(error) => OutputFile { name, bytes: error.into_bytes() },
    }
}

/// A table whose columns are called as the motion has it.
fn headings(table: &str) -> String {
    let (first, rest) = table.split_once('\n').unwrap_or((table, ""));
    let names: Vec<_> = first.split(',').map(|name| MotionKind::Rotary.name(name)).collect();
    format!("{}\n{rest}", names.join(","))
}
