//! A project that takes its valve from its recordings: every command computes with what `identify`
//! finds.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, Loaded, sha256};
use phea_workbench::source::{Memory, Source as _};
use serde_json::Value;

const IDENTIFIED: &str = include_str!("../../../examples/ybitu/identified.toml");
const RECORDED: [(&str, &str); 4] = [
    ("recorded/leakage.csv", include_str!("../../../examples/ybitu/recorded/leakage.csv")),
    ("recorded/metering.csv", include_str!("../../../examples/ybitu/recorded/metering.csv")),
    (
        "recorded/metering_low_flow.csv",
        include_str!("../../../examples/ybitu/recorded/metering_low_flow.csv"),
    ),
    ("recorded/pressure_gain.csv", include_str!("../../../examples/ybitu/recorded/pressure_gain.csv")),
];

/// The project and as many of its recordings as this.
fn source(text: &str, files: usize) -> Memory {
    let all = RECORDED.iter().take(files);
    all.fold(Memory::default().with("rig.toml", text), |source, (name, text)| source.with(name, *text))
}

fn read(source: &Memory, settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    project::read(source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn refusal(source: &Memory, settings: &[&str]) -> String {
    match command::answer(source, &read(source, settings), &[], &Request::Check) {
        Ok(answer) => panic!("{}", answer.text),
        Err(error) => error.to_string(),
    }
}

/// The bench records the declared valve, and says so: its recordings may not be there yet.
#[test]
fn the_bench_says_that_its_valve_is_the_declared_one() {
    let quick = "bench={ sample_time = \"10 s\" }";
    let told = |settings: &[&str]| {
        let source = source(IDENTIFIED, 0);
        command::answer(&source, &read(&source, settings), &[], &Request::Bench).unwrap()
    };
    let answer = told(&[quick]);
    assert!(
        answer.text.trim_start().starts_with("The valve under test is the declared one"),
        "{}",
        answer.text
    );
    assert!(answer.json.contains("\"remarks\""), "{}", answer.json);
    assert!(!told(&[quick, "identify.use=nothing"]).json.contains("\"remarks\""));
}

/// What `check` computes with is the truth of the bench that made the files; the hash is that of
/// the project followed by them.
#[test]
fn every_number_that_is_used_is_the_truth_of_the_bench() {
    let source = source(IDENTIFIED, 4);
    let loaded = read(&source, &[]);
    let answer = command::answer(&source, &loaded, &[], &Request::Check).unwrap();
    let json: Value = parsed(&answer.json);
    // ORIGIN: thesis, Table 5.1, which examples/ybitu/bench.toml has: the valve whose tests were
    // recorded
    let truth = [3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7, 2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9];
    let values = json["identified"]["values"].as_array().unwrap();
    assert_eq!(values.len(), 12, "{values:?}");
    for (value, truth) in values.iter().zip(truth) {
        let path = value["path"].as_str().unwrap();
        // three half widths, 5.9 deviations: beyond it is one in 250 million
        let ends = value["confidence_95"].as_array().unwrap();
        let [low, high] = [0, 1].map(|index| ends[index].as_f64().unwrap());
        let middle = 0.5 * (low + high);
        assert!((truth - middle).abs() < 1.5 * (high - low), "{path}: {truth} and {low} to {high}");
    }
    assert!(answer.text.contains("The valve as identified from its recordings"), "{}", answer.text);
    // cat rig.toml recorded/... | sha256sum
    let together = RECORDED.iter().fold(IDENTIFIED.to_string(), |all, (_, text)| all + text);
    assert_eq!(json["project_sha256"], sha256(together.as_bytes()).as_str());
    assert_eq!(json["identified"]["project_file_sha256"], loaded.sha256.as_str());
    let first = source.read("recorded/leakage.csv").unwrap();
    assert_eq!(json["identified"]["files"][0]["sha256"], sha256(&first).as_str());
}

/// The tare flow goes with the root of the pressure, and the table says at which it holds: here
/// that of the data sheet, 3000 psi, where the tests were made at 70 bar.
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
    assert!(answer.text.contains(words), "{}", answer.text);
}

/// Port pressures alone determine ratios of the coefficients: the command refuses and says which
/// are open.
#[test]
fn a_valve_that_the_recordings_do_not_determine_is_refused() {
    let [start, end] = ["[[identify.recording]]", "[cylinder] "].map(|at| IDENTIFIED.find(at).unwrap());
    let pressures = "[[identify.recording]]\nfile = \"recorded/pressure_gain.csv\"\n\n";
    let text = format!("{}{pressures}{}", &IDENTIFIED[..start], &IDENTIFIED[end..]);
    let message = refusal(&source(&text, 4), &[]);
    assert!(message.contains("cannot take the place of [valve]"), "{message}");
    assert!(message.contains("identify.use"), "{message}");
}

/// What contradicts the recordings, or the family that they leave, is refused; a file that is
/// missing too.
#[test]
fn what_contradicts_the_recordings_is_refused() {
    let all = source(IDENTIFIED, 4);
    let message = refusal(&all, &["valve.leakage_shape=50"]);
    assert!(message.contains("a setting states `valve.leakage_shape`"), "{message}");
    assert!(refusal(&source(IDENTIFIED, 3), &[]).contains("pressure_gain.csv"));
}

/// As declared where nothing is taken: the answer is that of the project without its recordings.
#[test]
fn nothing_is_taken_where_nothing_is_wanted() {
    let source = source(IDENTIFIED, 0);
    let loaded = read(&source, &["identify.use=nothing"]);
    let answer = command::answer(&source, &loaded, &[], &Request::Check).unwrap();
    let json: Value = parsed(&answer.json);
    assert!(json["identified"].is_null(), "{json}");
    assert_eq!(json["project_sha256"], loaded.sha256.as_str());
}
