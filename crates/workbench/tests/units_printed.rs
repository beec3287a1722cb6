//! The unit in which a quantity is printed: the one used in the text of the project, in every
//! table, sentence and figure.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::answer;
use phea_workbench::command::{Request, SimulateRequest};

const RIG: &str = include_str!("../../../examples/simulation/benchmark.toml");
const DRAWN: &str =
    "\n[campaign]\nruns = 2\nparameters = { \"cylinder.moving_mass\" = { spread = \"20 %\" } }\n";

/// The rig with its force step and its setting of rest in kN or in N.
fn rig(force: &str) -> String {
    let text = RIG.replace("force = \"4 kN\"", &format!("force = \"{force}\""));
    assert!(text.contains(force));
    format!("{text}{DRAWN}")
}

/// The texts of a page or of its figures, one per line.
fn texts(markup: &str) -> String {
    let texts = markup.split('<').map(|part| part.split_once('>').map_or("", |(_, text)| text));
    texts.collect::<Vec<_>>().join("\n").replace(['\u{a0}', '\u{202f}'], " ")
}

/// The places where a unit is a separate word: not part of another such as N/m.
fn places(text: &str, unit: &str) -> Vec<String> {
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '/' | '.' | '·' | '^');
    let words = text.match_indices(unit).filter(|(at, _)| {
        let before = text[..*at].chars().next_back();
        let mut after = text[at + unit.len()..].chars();
        let ends = match after.next() {
            Some('.') => !after.next().is_some_and(char::is_alphanumeric),
            next => !next.is_some_and(is_part),
        };
        ends && !before.is_some_and(is_part)
    });
    let around = |(at, _): (usize, &str)| text[..at].lines().next_back().unwrap_or_default().to_string();
    words.map(around).collect()
}

fn is_printed_in(project: &str, unit: &str, other: &str) {
    let simulate = Request::Simulate(SimulateRequest { check: true, ..SimulateRequest::default() });
    let requests = [
        Request::Report { files: false, alternatives: false },
        simulate,
        Request::Linearize { sweep: None },
        Request::Check,
    ];
    for request in requests {
        let name = request.name();
        let output = answer(project, &[], &[], &request);
        let pages = output.files.iter().filter(|file| file.name.ends_with(".html"));
        let page: String = pages.map(|file| texts(&String::from_utf8_lossy(&file.bytes))).collect();
        let all = format!("{}\n{page}", output.text);
        assert_eq!(places(&all, other), Vec::<String>::new(), "{name} prints {other} next to {unit}");
        let has_forces = !matches!(request, Request::Linearize { .. });
        assert_eq!(!places(&all, unit).is_empty(), has_forces, "{name} and {unit}");
    }
}

/// Friction in N leaves only forces in kN: it is a small part of them.
#[test]
fn a_project_in_kilonewtons_is_printed_in_kilonewtons() {
    is_printed_in(&rig("4 kN"), "kN", "N");
}

#[test]
fn a_project_in_newtons_is_printed_in_newtons() {
    is_printed_in(&rig("4000 N"), "N", "kN");
}
