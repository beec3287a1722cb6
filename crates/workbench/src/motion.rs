//! What an answer says of a rig that turns: the border where torques, angles and inertias get their
//! names, units and words. Procedures compute and write in the names of linear motion.

mod json;
mod markup;
mod vocabulary;

pub(crate) use vocabulary::Vocabulary;

use crate::answer::Object;
use crate::project::{InputSignal, Loaded, Project};
use crate::quantity::MotionKind;
use crate::source::OutputFile;

/// The words for a project, in which the texts of its user stay as they are.
pub(crate) fn vocabulary(loaded: &Loaded) -> Vocabulary {
    vocabulary_of(std::slice::from_ref(loaded))
}

/// The words for projects of one motion.
pub(crate) fn vocabulary_of(projects: &[Loaded]) -> Vocabulary {
    if !projects.iter().any(|loaded| loaded.project.motion().is_rotary()) {
        return Vocabulary::default();
    }
    Vocabulary::rotary(projects.iter().flat_map(|loaded| texts_of_user(loaded, &loaded.project)).collect())
}

fn texts_of_user(loaded: &Loaded, project: &Project) -> Vec<String> {
    let mut texts = vec![project.title.clone(), loaded.path.clone()];
    texts.extend(loaded.settings.clone());
    if let Some(actuator) = &project.actuator {
        let lines = [&actuator.line.a, &actuator.line.b];
        texts.extend(lines.iter().filter_map(|line| line.hose_name().map(str::to_string)));
        texts.extend(lines.iter().filter_map(|line| line.pipe()?.model.clone()));
        texts.extend(actuator.valve.model.clone());
    }
    texts.extend(project.family.iter().flat_map(|family| family.measured.clone()));
    texts.extend(project.directions.iter().map(|direction| direction.name.clone()));
    for scenario in &project.scenarios {
        texts.push(scenario.name.clone());
        texts.extend(scenario.measured.iter().map(|measured| measured.file.clone()));
        for published in scenario.reference.iter().filter_map(InputSignal::published) {
            texts.extend(published.source.iter().chain(&published.remark).cloned());
        }
    }
    for one in &project.alternatives {
        texts.push(one.name.clone());
        texts.extend(one.settings());
    }
    for case in &project.load_cases {
        texts.push(case.name.clone());
        texts.extend(case.settings());
    }
    texts
}

/// What is said to programs of projects of one motion, as that has it.
pub(crate) fn object(object: Object, words: &Vocabulary) -> Object {
    if words.is_plain() { object } else { json::said(object, words) }
}

/// Pages, drawings and tables, as the motion has them.
pub(crate) fn files(files: Vec<OutputFile>, words: &Vocabulary) -> Vec<OutputFile> {
    match words.is_plain() {
        true => files,
        false => files.into_iter().map(|file| said_in(file, words)).collect(),
    }
}

fn said_in(file: OutputFile, words: &Vocabulary) -> OutputFile {
    let OutputFile { name, bytes } = file;
    let Ok(text) = String::from_utf8(bytes.clone()) else { return OutputFile { name, bytes } };
    let said = match name.rsplit('.').next() {
        Some("html" | "svg") => markup::said(&text, words),
        Some("csv") if name.ends_with("derived.csv") => words.of(&text),
        Some("csv") => headings(&text),
        _ => return OutputFile { name, bytes },
    };
    OutputFile::new(name, said)
}

/// A table whose columns are called as the motion has it.
fn headings(table: &str) -> String {
    let (first, rest) = table.split_once('\n').unwrap_or((table, ""));
    let names: Vec<_> = first.split(',').map(|name| MotionKind::Rotary.name(name)).collect();
    format!("{}\n{rest}", names.join(","))
}
