//! What an answer says of a rig that turns: the border where torques, angles and inertias get their
//! names, units and words. Procedures compute and write in the names of linear motion.

mod json;
mod lines;
mod markup;

use crate::answer::Answer;
use crate::project::{Loaded, Project, Signal};
use crate::quantity::{MotionKind, Vocabulary};
use crate::source::OutputFile;

/// The words for a project, in which the texts of its user stay as they are.
pub(crate) fn vocabulary(loaded: &Loaded) -> Vocabulary {
    vocabulary_of(std::slice::from_ref(loaded))
}

/// The words for projects of one motion.
fn vocabulary_of(projects: &[Loaded]) -> Vocabulary {
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
        texts.extend(actuator.valve.model.clone());
    }
    texts.extend(project.directions.iter().map(|direction| direction.name.clone()));
    for scenario in &project.scenarios {
        texts.push(scenario.name.clone());
        texts.extend(scenario.measured.iter().map(|measured| measured.file.clone()));
        for published in scenario.reference.iter().filter_map(Signal::published) {
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

/// An answer about projects of one motion, as that has it.
pub(crate) fn said(answer: Answer, projects: &[Loaded]) -> Answer {
    let words = vocabulary_of(projects);
    if words.is_plain() {
        return answer;
    }
    Answer {
        text: lines::said(&answer.text, &words),
        json: json::said(&answer.json, &words),
        files: answer.files.into_iter().map(|file| said_in(file, &words)).collect(),
        affirmative: answer.affirmative,
    }
}

fn said_in(file: OutputFile, words: &Vocabulary) -> OutputFile {
    let OutputFile { name, bytes } = file;
    let Ok(text) = String::from_utf8(bytes.clone()) else { return OutputFile { name, bytes } };
    let said = match name.rsplit('.').next() {
        Some("html" | "svg") => markup::said(&text, words),
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
