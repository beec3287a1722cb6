//! Runs a command on a project in memory and reads its JSON, as another program would.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::sync::OnceLock;

use crate::answer_schema::parsed;
use phea_workbench::answer::Answer;
use phea_workbench::command::{self, CommandError, IdentifyError, Request};
use phea_workbench::engineering::alternatives::LengthUnknown;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project::{self, Loaded, Project};
use phea_workbench::report::{Report, report};
use phea_workbench::source::Memory;
use serde_json::Value;

pub(crate) const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
pub(crate) const PIPE: &str = include_str!("../../../examples/ybitu/pipe.toml");
pub(crate) const CONTRADICTORY: &str =
    include_str!("../../../examples/qft/mistakes/contradictory_bounds.toml");

/// A folder of fictitious hoses, and a file that gives another body to a built-in name.
pub(crate) const FICTITIOUS: &str = "fictitious";
pub(crate) const OVERRIDE: &str = "override/eaton_synflex_3130_08.toml";

const FICTITIOUS_FILES: [(&str, &str); 7] = [
    ("fictitious/rigid.toml", include_str!("catalogue/fictitious/rigid.toml")),
    ("fictitious/right.toml", include_str!("catalogue/fictitious/right.toml")),
    ("fictitious/slow.toml", include_str!("catalogue/fictitious/slow.toml")),
    ("fictitious/stubborn.toml", include_str!("catalogue/fictitious/stubborn.toml")),
    ("fictitious/surging.toml", include_str!("catalogue/fictitious/surging.toml")),
    ("fictitious/too_fast.toml", include_str!("catalogue/fictitious/too_fast.toml")),
    ("fictitious/weak.toml", include_str!("catalogue/fictitious/weak.toml")),
];

pub(crate) fn source(project: &str) -> Memory {
    FICTITIOUS_FILES
        .into_iter()
        .fold(Memory::default(), |source, (path, text)| source.with(path, text))
        .with(OVERRIDE, include_str!("catalogue/override/eaton_synflex_3130_08.toml"))
        .with("rig.toml", project)
}

/// Length from mount to mount, as reported by `alternatives`.
pub(crate) fn retracted_length(project: &Project) -> Result<f64, LengthUnknown> {
    let rig = Setup::rig_of(project).unwrap();
    phea_workbench::engineering::alternatives::retracted_length(project.actuator.as_ref().unwrap(), &rig)
}

fn owned(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| text.to_string()).collect()
}

#[track_caller]
pub(crate) fn load(project: &str, settings: &[&str], catalogues: &[&str]) -> Loaded {
    project::read(&source(project), "rig.toml", &owned(settings), &owned(catalogues))
        .unwrap_or_else(|report| panic!("{report}"))
}

#[track_caller]
pub(crate) fn project_of(text: &str, settings: &[&str]) -> Project {
    load(text, settings, &[]).project
}

#[track_caller]
pub(crate) fn try_answer(
    project: &str,
    settings: &[&str],
    catalogues: &[&str],
    request: &Request,
) -> Result<Answer, CommandError> {
    let loaded = load(project, settings, catalogues);
    command::answer(&source(project), &loaded, &owned(catalogues), request)
}

#[track_caller]
pub(crate) fn answer(project: &str, settings: &[&str], catalogues: &[&str], request: &Request) -> Answer {
    try_answer(project, settings, catalogues, request).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
pub(crate) fn json(project: &str, settings: &[&str], catalogues: &[&str], request: &Request) -> Value {
    parsed(&answer(project, settings, catalogues, request).json)
}

/// Answer of a design of the hose, with its repair: computed once for all tests that need it.
pub(crate) fn designed_hose() -> &'static Answer {
    static ANSWER: OnceLock<Answer> = OnceLock::new();
    let request = Request::Design { seed: None, stages: false, repair: true };
    ANSWER.get_or_init(|| answer(HOSE, &UNLIMITED, &[], &request))
}

/// Answer of the design within the limits of what may be built, computed once for all tests.
pub(crate) fn built_hose() -> &'static Answer {
    static ANSWER: OnceLock<Answer> = OnceLock::new();
    let request = Request::Design { seed: None, stages: false, repair: true };
    ANSWER.get_or_init(|| answer(HOSE, &[], &[], &request))
}

/// The settings that leave only the specifications to a design.
pub(crate) const UNLIMITED: [&str; 2] = ["design.limits=none", "design.structure=free"];

/// The report of a project whose specifications no controller satisfies: computed once for all
/// tests that need it.
pub(crate) fn contradictory_report() -> &'static Report {
    static REPORT: OnceLock<Report> = OnceLock::new();
    let make = || {
        let loaded = load(CONTRADICTORY, &[], &[]);
        let setup = Setup::new(&loaded.project).unwrap();
        report(&Memory::default(), &loaded, &setup, None, &mut |_| true).unwrap()
    };
    REPORT.get_or_init(make)
}

#[track_caller]
pub(crate) fn check(project: &str, settings: &[&str]) -> Value {
    json(project, settings, &[], &Request::Check)
}

#[track_caller]
pub(crate) fn linearize(project: &str, settings: &[&str]) -> Value {
    json(project, settings, &[], &Request::Linearize { sweep: None })
}

#[track_caller]
pub(crate) fn size(project: &str, settings: &[&str]) -> Value {
    json(project, settings, &[], &size_request(None, None))
}

#[track_caller]
pub(crate) fn size_for_gain(project: &str, settings: &[&str], gain: &str) -> Value {
    json(project, settings, &[], &size_request(Some(gain), None))
}

#[track_caller]
pub(crate) fn size_for_length(project: &str, settings: &[&str], length: &str) -> Value {
    json(project, settings, &[], &size_request(None, Some(length)))
}

pub(crate) fn size_request(gain: Option<&str>, length: Option<&str>) -> Request {
    Request::Size { gain: gain.map(str::to_string), length: length.map(str::to_string) }
}

/// The number at a path such as `stiffness.minimum_n_per_m` or `bands.0.1`; the strings "inf" and
/// "-inf" are infinite.
#[track_caller]
pub(crate) fn number(value: &Value, path: &str) -> f64 {
    let found = value.pointer(&format!("/{}", path.replace('.', "/")));
    match found {
        Some(Value::Number(number)) => number.as_f64().unwrap(),
        Some(Value::String(text)) if text == "inf" => f64::INFINITY,
        Some(Value::String(text)) if text == "-inf" => f64::NEG_INFINITY,
        other => panic!("no number at {path} but {other:?}"),
    }
}

/// The derived quantity of `check` by its name.
#[track_caller]
pub(crate) fn derived(check: &Value, name: &str) -> f64 {
    let rows = check["derived"].as_array().unwrap();
    let row = rows.iter().find(|row| row["name"] == name).unwrap_or_else(|| panic!("no {name}"));
    number(row, "value")
}

/// The candidates of `size` for a hose and a stiffness model.
pub(crate) fn candidates<'a>(size: &'a Value, hose: &str, compliance: &str) -> Vec<&'a Value> {
    let all = size["candidates"].as_array().unwrap().iter();
    all.filter(|row| row["hose"] == hose && row["compliance"] == compliance).collect()
}

/// The only such candidate.
#[track_caller]
pub(crate) fn candidate<'a>(size: &'a Value, hose: &str, compliance: &str) -> &'a Value {
    let found = candidates(size, hose, compliance);
    assert_eq!(found.len(), 1, "{hose}, {compliance}");
    found[0]
}

/// The reasons of a candidate, one per line.
pub(crate) fn reasons(candidate: &Value) -> String {
    let lines: Vec<&str> =
        candidate["reasons"].as_array().unwrap().iter().map(|line| line.as_str().unwrap()).collect();
    lines.join("\n")
}

/// Checks that an identification is rejected with a message that has every part.
#[track_caller]
pub(crate) fn refused(outcome: Result<Answer, IdentifyError>, expected: &[&str]) {
    let message = match outcome {
        Err(IdentifyError::Files(report)) => report.render(false),
        Err(other) => other.to_string(),
        Ok(answer) => panic!("{}", answer.text()),
    };
    for part in expected {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[track_caller]
pub(crate) fn within(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual - expected).abs() <= tolerance, "{actual} is not within {tolerance} of {expected}");
}

#[track_caller]
pub(crate) fn near(actual: f64, expected: f64, relative: f64) {
    within(actual, expected, relative * expected.abs());
}
