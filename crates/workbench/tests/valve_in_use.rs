//! A project that takes its valve from its recordings: every command uses the result of `identify`.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, Loaded, sha256};
use phea_workbench::source::{Memory, Source as _};
use serde_json::Value;

pub(crate) const IDENTIFIED: &str = include_str!("../../../examples/ybitu/identified.toml");
pub(crate) const RECORDED: [(&str, &str); 4] = [
    ("recorded/leakage.csv", include_str!("../../../examples/ybitu/recorded/leakage.csv")),
    ("recorded/metering.csv", include_str!("../../../examples/ybitu/recorded/metering.csv")),
    (
        "recorded/metering_low_flow.csv",
        include_str!("../../../examples/ybitu/recorded/metering_low_flow.csv"),
    ),
    ("recorded/pressure_gain.csv", include_str!("../../../examples/ybitu/recorded/pressure_gain.csv")),
];

/// The project with this number of its recordings.
pub(crate) fn source(text: &str, files: usize) -> Memory {
    let all = RECORDED.iter().take(files);
    all.fold(Memory::default().with("rig.toml", text), |source, (name, text)| source.with(name, *text))
}

pub(crate) fn read(source: &Memory, settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    project::read(source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn refusal(source: &Memory, settings: &[&str]) -> String {
    match command::answer(source, &read(source, settings), &[], &Request::Check) {
        Ok(answer) => panic!("{}", answer.text()),
        Err(error) => error.to_string(),
    }
}

/// The bench records the declared valve, and reports this: its recordings may not exist yet.
#[test]
fn the_bench_reports_the_declared_valve() {
    let quick = "bench={ sample_time = \"10 s\" }";
    let check_of = |settings: &[&str]| {
        let source = source(IDENTIFIED, 0);
        command::answer(&source, &read(&source, settings), &[], &Request::Bench).unwrap()
    };
    let answer = check_of(&[quick]);
    assert!(
        answer.text().trim_start().starts_with("The valve under test is the declared one"),
        "{}",
        answer.text()
    );
    assert!(answer.json.contains("\"remarks\""), "{}", answer.json);
    assert!(!check_of(&[quick, "identify.use=nothing"]).json.contains("\"remarks\""));
}

/// Values used by `check` are the truth of the bench that made the files; the hash is that of the
/// project followed by them.
#[test]
fn every_identified_number_is_the_true_one_of_the_bench() {
    let source = source(IDENTIFIED, 4);
    let loaded = read(&source, &[]);
    let answer = command::answer(&source, &loaded, &[], &Request::Check).unwrap();
    let json: Value = parsed(&answer.json);
    // ORIGIN: thesis, Table 5.1, used in examples/ybitu/bench.toml: the valve whose tests were
    // recorded
    let truth = [3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7, 2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9];
    let values = json["identified"]["values"].as_array().unwrap();
    assert_eq!(values.len(), 12, "{values:?}");
    for (value, truth) in values.iter().zip(truth) {
        let path = value["path"].as_str().unwrap();
        // three half widths, 5.9 deviations: exceeded once in 250 million
        let ends = value["confidence_95"].as_array().unwrap();
        let [low, high] = [0, 1].map(|index| ends[index].as_f64().unwrap());
        let middle = 0.5 * (low + high);
        assert!((truth - middle).abs() < 1.5 * (high - low), "{path}: {truth} and {low} to {high}");
    }
    assert!(answer.text().contains("The valve as identified from its recordings"), "{}", answer.text());
    // cat rig.toml recorded/... | sha256sum
    let together = RECORDED.iter().fold(IDENTIFIED.to_string(), |all, (_, text)| all + text);
    assert_eq!(json["project_sha256"], sha256(together.as_bytes()).as_str());
    assert_eq!(json["identified"]["project_file_sha256"], loaded.sha256.as_str());
    let first = source.read("recorded/leakage.csv").unwrap();
    assert_eq!(json["identified"]["files"][0]["sha256"], sha256(&first).as_str());
}

/// The tare flow varies with the root of the pressure, and the table states the pressure for which
/// it holds: here that of the data sheet, 3000 psi, while the tests were made at 70 bar.
#[test]
fn the_tare_flow_has_its_pressure() {
    let source = source(IDENTIFIED, 4);
    let answer = command::answer(&source, &read(&source, &[]), &[], &Request::Check).unwrap();
    let json: Value = parsed(&answer.json);
    let values = json["identified"]["values"].as_array().unwrap();
    let tare = values.iter().find(|one| one["path"] == "valve.tare_flow").unwrap();
    let pressure = json["identified"]["tare_pressure_pa"].as_f64().unwrap();
    // ORIGIN: analytic, 3000 psi
    assert!((pressure / 206.8427e5 - 1.0).abs() < 1e-6, "{pressure}");
    // ORIGIN: thesis section 5.2.1, 7.55e-6 m3/s at 70 bar
    let at_seventy = tare["value"].as_f64().unwrap() * (70e5 / pressure).sqrt();
    assert!((at_seventy / 7.55e-6 - 1.0).abs() < 5e-3, "{at_seventy}");
    let words = "`valve.tare_flow` is that at 206.8 bar from supply to tank.";
    assert!(answer.text().contains(words), "{}", answer.text());
}

/// Port pressures determine only ratios of the coefficients: the command rejects them and names the
/// open coefficients.
#[test]
fn a_valve_that_the_recordings_do_not_determine_is_refused() {
    let [start, end] = ["[[identify.recording]]", "[cylinder] "].map(|at| IDENTIFIED.find(at).unwrap());
    let pressures = "[[identify.recording]]\nfile = \"recorded/pressure_gain.csv\"\n\n";
    let text = format!("{}{pressures}{}", &IDENTIFIED[..start], &IDENTIFIED[end..]);
    let message = refusal(&source(&text, 4), &[]);
    assert!(message.contains("cannot take the place of [valve]"), "{message}");
    assert!(message.contains("identify.use"), "{message}");
}

/// A setting that contradicts the recordings, or the family that they leave, is rejected; so is a
/// missing file.
#[test]
fn declarations_that_contradict_the_recordings_are_refused() {
    let all = source(IDENTIFIED, 4);
    let message = refusal(&all, &["valve.leakage_shape=50"]);
    assert!(message.contains("a setting states `valve.leakage_shape`"), "{message}");
    assert!(refusal(&source(IDENTIFIED, 3), &[]).contains("pressure_gain.csv"));
}

/// The declared valve is used if nothing is taken from recordings: the answer is that of the
/// project without them.
#[test]
fn nothing_is_identified_unless_requested() {
    let source = source(IDENTIFIED, 0);
    let loaded = read(&source, &["identify.use=nothing"]);
    let answer = command::answer(&source, &loaded, &[], &Request::Check).unwrap();
    let json: Value = parsed(&answer.json);
    assert!(json["identified"].is_null(), "{json}");
    assert_eq!(json["project_sha256"], loaded.sha256.as_str());
}
