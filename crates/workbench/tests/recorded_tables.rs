//! Recorded tests of every kind: each file of the corpus is read like the reference, to the last
//! bit, or rejected with the text next to it.
//!
//! `NAME.expect` begins with the data that are read, and has a line for each finding: severity,
//! line, column and message, and indented below it the expected value and the remedy. `NAME.toml`
//! contains the keys of a project for the file.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_hydraulics::servovalve::TestInput;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::run_command::HOSE;
use phea_workbench::engineering::identify::{Known, RecordedFiles, Recording, SignalKind, recordings};
use phea_workbench::project::{self, Diagnostic, RecordedTest, Refusal, Severity};
use phea_workbench::source::Memory;

fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recorded");
    let files = std::fs::read_dir(folder).expect("the corpus is there");
    let mut files: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    files.retain(|file| !file.extension().is_some_and(|ending| ending == "expect" || ending == "toml"));
    files.sort();
    files
}

fn name(file: &Path) -> String {
    file.file_name().unwrap().to_string_lossy().into_owned()
}

/// Keys of a project for the file.
fn declared(file: &Path) -> RecordedTest {
    let Ok(keys) = std::fs::read_to_string(file.with_extension("toml")) else {
        return RecordedTest::of(&name(file));
    };
    let text = format!("{HOSE}\n[[identify.recording]]\nfile = \"{}\"\n{keys}", name(file));
    let source = Memory::default().with("rig.toml", text);
    let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    loaded.project.identify.unwrap().recordings.remove(0)
}

fn read(file: &Path) -> Result<RecordedFiles, Box<Refusal>> {
    let source = Memory::default().with(&name(file), std::fs::read(file).expect("readable"));
    recordings(&source, &[declared(file)], &Known::default())
}

/// The reference with the changes in the first line of an expectation: `without rows 2 3`,
/// `pressure_a not in rows 4`.
fn changed(reference: &Recording, description: &str) -> Recording {
    let mut changed = reference.clone();
    let rows = |text: &str| -> Vec<usize> {
        text.split(' ').filter_map(|word| word.parse::<usize>().ok()).map(|row| row - 1).collect()
    };
    for part in description.split(", ").skip(1) {
        let rows = rows(part);
        if let Some((signal, _)) = part.split_once(" not in ") {
            let kind = [SignalKind::PressureA, SignalKind::LeakFlow];
            let kind = kind.into_iter().find(|kind| kind.name() == signal).expect("a signal");
            let signal = changed.signals.iter_mut().find(|signal| signal.kind == kind).unwrap();
            rows.iter().for_each(|row| signal.values[*row] = None);
        } else {
            let remains = |row: usize| !rows.contains(&row);
            let inputs = changed.inputs.iter().enumerate().filter(|(row, _)| remains(*row));
            changed.inputs = inputs.map(|(_, input)| *input).collect();
            for signal in &mut changed.signals {
                let values = signal.values.iter().enumerate().filter(|(row, _)| remains(*row));
                signal.values = values.map(|(_, value)| *value).collect();
            }
        }
    }
    changed
}

/// The inputs as read, without the corners that omitted rows cause between the others.
fn read_rows(recording: &Recording) -> Vec<TestInput> {
    recording.inputs.iter().map(|input| TestInput { turn: None, ..*input }).collect()
}

fn write_findings(text: &mut String, diagnostics: &[Diagnostic]) {
    for found in diagnostics {
        let severity = if found.severity == Severity::Error { "error" } else { "warning" };
        writeln!(text, "{severity} {}:{} {}", found.line, found.column, found.message).unwrap();
        for more in [&found.expected, &found.help].into_iter().flatten() {
            writeln!(text, "    {more}").unwrap();
        }
    }
}

#[test]
fn every_kind_of_file_is_read_correctly_or_refused_with_the_reason() {
    let files = corpus();
    assert!(files.len() >= 60, "{} files", files.len());
    let reference = files.iter().find(|file| name(file) == "reference.csv").unwrap();
    let reference = read(reference).unwrap().recordings.remove(0);
    let mut wrong = String::new();
    for file in files {
        let expected = std::fs::read_to_string(file.with_extension("expect")).unwrap_or_default();
        let description = expected.lines().next().unwrap_or_default();
        let mut found = String::new();
        match read(&file) {
            Ok(recorded) => {
                let recording = &recorded.recordings[0];
                let wanted = changed(&reference, description);
                let same = read_rows(recording) == read_rows(&wanted) && recording.signals == wanted.signals;
                writeln!(found, "{}", if same { description } else { "reads other numbers" }).unwrap();
                let unused = recorded.contents[0].unused.join(", ");
                if !unused.is_empty() {
                    writeln!(found, "unused {unused}").unwrap();
                }
                write_findings(&mut found, &recorded.warnings);
            }
            Err(refusal) => {
                writeln!(found, "refused").unwrap();
                write_findings(&mut found, &refusal.diagnostics);
            }
        }
        if found != expected {
            writeln!(wrong, "== {}\n{found}", name(&file)).unwrap();
        }
    }
    assert!(wrong.is_empty(), "differs from what is expected; found:\n{wrong}");
}
