//! Identification of a cylinder's known friction from the files that the bench writes.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use std::sync::LazyLock;

use crate::run_command::{HOSE, answer, load};
use phea_workbench::answer::Answer;
use phea_workbench::command::{FrictionRequest, IdentifyError, Request, friction_watched};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

/// The coefficients of the rig, with their names in the answer.
pub(crate) const TRUTH: [(&str, f64); 7] = [
    ("coulomb_n", 80.0),
    ("static_n", 120.0),
    ("stribeck_velocity_m_per_s", 0.01),
    ("stribeck_exponent", 2.0),
    ("viscous_n_s_per_m", 100.0),
    ("bristle_stiffness_n_per_m", 1e7),
    ("bristle_damping_n_s_per_m", 2e3),
];

pub(crate) const SLIDING: &str = "sliding.csv";
pub(crate) const PRESSED: [&str; 2] = ["breakaway.csv", "breakaway_back.csv"];
pub(crate) const SHAKEN: &str = "shaken.csv";

/// Setting with which the tests of the valve take no time.
pub(crate) const SHORT: &str = "bench.duration=1 s";

/// No noise, and ideal converters.
const EXACT: [&str; 2] = ["bench.pressure_noise=0", "bench.converter_bits=0"];

/// Eight velocities, and the bench's defaults for everything else.
const NOISY: &str = "bench.friction={ velocities = 8 }";

/// The friction of that bench from all four recordings, and from those without the shaken piston:
/// each identified once for all tests.
pub(crate) fn from_all() -> &'static Answer {
    static ANSWER: LazyLock<Answer> = LazyLock::new(|| {
        identified(&recorded(&[NOISY]), &[SLIDING, PRESSED[0], PRESSED[1], SHAKEN]).unwrap()
    });
    &ANSWER
}

fn without_the_shaken() -> &'static Answer {
    static ANSWER: LazyLock<Answer> =
        LazyLock::new(|| identified(&recorded(&[NOISY]), &[SLIDING, PRESSED[0], PRESSED[1]]).unwrap());
    &ANSWER
}

/// The files of a bench with these settings, and one with the given text in addition.
pub(crate) fn recorded(settings: &[&str]) -> Memory {
    let files = answer(HOSE, &[&[SHORT], settings].concat(), &[], &Request::Bench).files;
    files.into_iter().fold(Memory::default(), |source, file| {
        source.with(&file.name, String::from_utf8(file.bytes).unwrap())
    })
}

pub(crate) fn identified(source: &Memory, files: &[&str]) -> Result<Answer, IdentifyError> {
    let request =
        FrictionRequest { files: files.iter().map(|file| file.to_string()).collect(), figures: false };
    friction_watched(source, Some(&load(HOSE, &[], &[])), &request, &mut |_| true)
}

#[track_caller]
pub(crate) fn found(settings: &[&str], files: &[&str]) -> Value {
    let answer = identified(&recorded(settings), files).unwrap_or_else(|error| panic!("{error}"));
    parsed(&answer.json)
}

pub(crate) fn interval(found: &Value, key: &str) -> [f64; 2] {
    let ends = &found["friction"][key]["confidence_95"];
    [0, 1].map(|end| ends[end].as_f64().unwrap_or(f64::INFINITY))
}

#[track_caller]
pub(crate) fn is_open(found: &Value, key: &str, reason: &str) {
    let one = &found["friction"][key];
    assert!(one["value"].is_null(), "{key}: {one}");
    assert!(one["reason"].as_str().is_some_and(|message| message.contains(reason)), "{key}: {one}");
}

/// The steady curve is recovered without noise, to the rounding of the files.
#[test]
fn the_steady_curve_comes_back_without_noise() {
    let settings = [&EXACT[..], &["bench.friction={ velocities = 8, position_noise = 0 }"]].concat();
    let found = found(&settings, &[SLIDING]);
    for (key, truth) in &TRUTH[..5] {
        let value = found["friction"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {found}"));
        assert!((value / truth - 1.0).abs() < 1e-5, "{key}: {value}");
    }
}

/// Coefficients from noise and all three recordings: everything except the damping of the bristles
/// is determined, and the intervals contain the truth: three standard deviations here, because six
/// numbers are checked.
#[test]
fn a_noisy_bench_identifies_all_but_the_damper() {
    let found: Value = parsed(&without_the_shaken().json);
    is_open(&found, "bristle_damping_n_s_per_m", "slow runs do not show it");
    holds_the_truth(&found, &TRUTH[..6]);
}

/// Every coefficient is determined with all four recordings.
#[test]
fn a_noisy_bench_identifies_all_of_the_friction() {
    let answer = from_all();
    assert!(answer.affirmative, "{}", answer.text());
    holds_the_truth(&parsed(&answer.json), &TRUTH);
}

#[track_caller]
fn holds_the_truth(found: &Value, truths: &[(&str, f64)]) {
    assert_eq!(found["converged"], true, "{found}");
    for (key, truth) in truths {
        let one = &found["friction"][key];
        let value = one["value"].as_f64().unwrap_or_else(|| panic!("{key}: {one}"));
        let [low, high] = interval(found, key);
        assert!((value - truth).abs() < 1.5 * (high - low) / 2.0, "{key}: {one}");
        assert!(high - low < 0.8 * truth, "{key}: {one}");
    }
}

/// A coefficient on which nothing in the recordings depends is open, with the reason.
#[test]
fn parameters_that_are_not_identifiable_are_left_open() {
    let settings = ["bench.friction={ velocities = 6, releases = 0 }"];
    let sliding = found(&settings, &[SLIDING]);
    is_open(&sliding, "bristle_damping_n_s_per_m", "slow runs do not show it");
    // a slow force never moves the damper
    let slow = found(&settings, &[SLIDING, PRESSED[0]]);
    is_open(&slow, "bristle_damping_n_s_per_m", "slow runs do not show it");
    assert!(slow["friction"]["bristle_stiffness_n_per_m"]["value"].is_f64(), "{slow}");
    let pressed = found(&settings, &PRESSED);
    is_open(&pressed, "coulomb_n", "nothing slides");
    is_open(&pressed, "viscous_n_s_per_m", "nothing slides");
    assert!(pressed["friction"]["bristle_stiffness_n_per_m"]["value"].is_f64(), "{pressed}");
}

/// A force that changes within a few rows is not known between them, and the stiffness is open
/// instead of wrong.
#[test]
fn a_quick_force_leaves_the_stiffness_open() {
    let found = found(&["bench.friction={ velocities = 6, releases = 2 }"], &[SLIDING, PRESSED[0]]);
    is_open(&found, "bristle_stiffness_n_per_m", "record one that rises slowly");
}

/// Zero errors of the pressures: runs in both directions separate them from friction.
#[test]
fn an_error_of_the_zero_is_no_friction() {
    let source = recorded(&["bench.friction={ velocities = 6 }"]);
    let table = String::from_utf8(phea_workbench::source::Source::read(&source, SLIDING).unwrap()).unwrap();
    let mut lines = table.lines();
    let mut shifted = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        // 0.1 bar on 15.83 cm2
        shifted += &format!("{},{},{},{}\n", cells[0], cells[1], cells[2] + 0.1, cells[3]);
    }
    let answer = identified(&source.with("shifted.csv", shifted), &["shifted.csv"]).unwrap();
    let found: Value = parsed(&answer.json);
    let zero = found["force_zero_n"]["value"].as_f64().unwrap();
    let area = std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);
    assert!((zero - 1e4 * area).abs() < 1.0, "{zero}");
    let [low, high] = interval(&found, "coulomb_n");
    assert!(low < 80.5 && 79.5 < high, "{found}");
}

/// The fragment is a table of a project, except for open coefficients.
#[test]
fn the_fragment_is_a_table_of_a_project() {
    let open = "# bristle_damping: not determined, slow runs do not show it";
    let message = String::from_utf8(without_the_shaken().files[0].bytes.clone()).unwrap();
    assert!(message.contains(open), "{message}");
    let answer = from_all();
    let fragment = answer.files.iter().find(|file| file.name == "friction.toml").unwrap();
    let fragment = String::from_utf8(fragment.bytes.clone()).unwrap();
    let (before, rest) = HOSE.split_once("[cylinder.friction]").unwrap();
    let (_, after) = rest.split_once("[line]").unwrap();
    let rig = format!("{before}{fragment}\n[line]{after}");
    let source = Memory::default().with("rig.toml", rig);
    let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"));
    let friction = loaded.project.actuator.unwrap().cylinder.friction.unwrap();
    let json: Value = parsed(&answer.json);
    let viscous = json["friction"]["viscous_n_s_per_m"]["value"].as_f64().unwrap();
    assert!((friction.law.viscous() / viscous - 1.0).abs() < 1e-4, "{fragment}");
}

#[track_caller]
fn refused(table: &str, expected: &[&str]) {
    let source = Memory::default().with("run.csv", table);
    let error = identified(&source, &["run.csv"]).map(|answer| answer.text()).unwrap_err();
    let message = match &error {
        IdentifyError::Files(report) => report.to_string(),
        other => other.to_string(),
    };
    for text in expected {
        assert!(message.contains(text), "{message}\nlacks: {text}");
    }
}

#[test]
fn other_files_are_refused_with_their_places() {
    refused(
        "time_s,positon_mm,pressure_a_bar,pressure_b_bar\n0,1,2,3\n",
        &["run.csv:1", "position", "positon_mm"],
    );
    refused("time_s,position_mm,pressure_a_bar\n0,1,2\n", &["run.csv:1", "pressure_b"]);
    refused("time_s,position_mm\n0,1\n", &["run.csv:1", "pressure_a"]);
    refused("time_s,position_bar,force_n\n0,1,2\n", &["run.csv:1", "bar"]);
    refused("time_s,position_mm,force_n\n0,1,2\n0.1,one,2\n", &["run.csv:3", "one"]);
    refused(
        "time_s,position_mm,force_n\n0,1,2\n0.1,1,2\n",
        &["2 rows are too few for a run of the cylinder"],
    );
    // a piston at rest shows nothing
    let rest: String = (0..200).map(|row| format!("{},5,0\n", f64::from(row) * 0.01)).collect();
    refused(&format!("time_s,position_mm,force_n\n{rest}"), &["no recording determines the friction"]);
}
