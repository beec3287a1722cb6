//! `alternatives` says of each what the single commands say of it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use std::sync::OnceLock;

use crate::ask::{HOSE, answer, load, source};
use crate::json_contract::unexplained;
use phea_workbench::answer::Answer;
use phea_workbench::command::{Request, answer_watched};
use serde_json::Value;

const ASKED: Request = Request::Alternatives { files: false };

const LOOP: &str = r#"
schema = 1
title = "A lag"
[plant]
numerator = "k"
denominator = "s + 1"
[uncertainty]
k = { nominal = 1, minimum = 1, maximum = 2 }
[[specification]]
kind = "sensitivity"
limit = 2
frequencies = [1]
band = [0, inf]
[[alternative]]
name = "faster"
set = { "plant.denominator" = "s + 3" }
[[alternative]]
name = "late"
set = { "plant.delay" = "10 ms" }
"#;

/// A rig with one plant, driven for half a second.
fn rig() -> String {
    let (head, _) = HOSE.split_once("[uncertainty]").unwrap();
    format!(
        "{head}{}",
        r#"
[[specification]]
kind = "robust_stability"
limit = 1.5
frequencies = [1, 10, 100]
band = [0, inf]

[[specification]]
kind = "sensitivity"
limit = { numerator = "s", denominator = "s + 5" }
frequencies = [1, 5]

[[scenario]]
name = "step and motion"
duration = "0.5 s"
reference = [{ at = "0.1 s", force = "1 kN" }]
load_motion = { kind = "smooth_step", start = "0.3 s", duration = "0.1 s", distance = "1 mm" }

[[alternative]]
name = "pipe"
[alternative.set]
"line" = { pipe = { bore = "10.5 mm" }, length = "0.35 m", compliance = "uniform" }
"#
    )
}

fn parsed(answer: &Answer) -> Value {
    serde_json::from_str(&answer.json).unwrap()
}

/// The rig with its files, once for all tests.
fn judged() -> &'static (Answer, Value) {
    static JUDGED: OnceLock<(Answer, Value)> = OnceLock::new();
    JUDGED.get_or_init(|| {
        let found = answer(&rig(), &[], &[], &Request::Alternatives { files: true });
        let json = parsed(&found);
        (found, json)
    })
}

/// Sizing, rig and scenario of each, and nothing without a reason.
#[test]
fn every_alternative_has_its_columns_and_reasons() {
    for json in [&judged().1, &parsed(&answer(LOOP, &[], &[], &ASKED))] {
        let mut found = Vec::new();
        unexplained("", json, &mut found);
        // the ends of a proof's interval have their reason beside the interval
        found.retain(|path| !path.contains(".enclosure_db."));
        assert!(found.is_empty(), "{}", found.join("\n"));
        for one in json["alternatives"].as_array().unwrap() {
            for key in ["name", "verdict", "design", "machine", "columns"] {
                assert!(one.get(key).is_some(), "{key}");
            }
        }
    }
    let columns = |index: usize| &judged().1["alternatives"][index]["columns"];
    let (hose, pipe) = (columns(0), columns(1));
    // ORIGIN: analytic, 2 pi/4 (10.5 mm)^2 0.35 m
    assert!((pipe["lines_volume_m3"].as_f64().unwrap() - 6.0613e-5).abs() < 1e-9);
    assert_eq!(pipe["lines_length_m"], 0.7);
    // what the hose is there for
    let least = |columns: &Value| columns["stiffness_minimum_n_per_m"].as_f64().unwrap();
    assert!(least(pipe) > 5.0 * least(hose));
}

/// The design of an alternative is that of the project with the same settings.
#[test]
fn each_design_is_that_of_design_with_set() {
    let json = parsed(&answer(LOOP, &[], &[], &ASKED));
    let designed = Request::Design { seed: None, stages: false, repair: false };
    let settings: [&[&str]; 3] = [&[], &["plant.denominator=\"s + 3\""], &["plant.delay=\"10 ms\""]];
    for (index, settings) in settings.into_iter().enumerate() {
        let alone = parsed(&answer(LOOP, settings, &[], &designed));
        let one = &json["alternatives"][index];
        for key in ["controller", "prefilter", "verification", "status", "figures"] {
            assert_eq!(one["design"][key], alone[key], "{settings:?} {key}");
        }
        assert_eq!(one["columns"]["order"], alone["figures"]["order"]);
        assert_eq!(one["columns"]["delay_margin_s"], alone["verification"]["delay_margin_s"]);
        assert_eq!(one["verdict"], alone["verification"]["verdict"]);
    }
}

/// The written project is the alternative with its controller: `simulate` finds the same numbers.
#[test]
fn each_written_project_is_the_one_that_was_driven() {
    let (found, json) = judged();
    for (index, name) in ["as declared", "pipe"].into_iter().enumerate() {
        let file = found.files.iter().find(|file| file.name == format!("{name}.toml")).unwrap();
        let text = std::str::from_utf8(&file.bytes).unwrap();
        let alone = parsed(&answer(text, &[], &[], &Request::Simulate));
        let columns = &json["alternatives"][index]["columns"]["scenarios"][0];
        let events = &alone["scenarios"][0]["events"];
        let peak = |event: usize, key: &str| events[event]["metrics"][key].as_f64().unwrap();
        let close = |one: f64, other: f64| (one - other).abs() <= 1e-9 * one.abs();
        assert!(close(columns["disturbance_peak_n"].as_f64().unwrap(), peak(1, "disturbance_peak_n")));
        assert!(close(columns["overshoot_percent"].as_f64().unwrap(), peak(0, "overshoot_percent")));
        let most = peak(0, "control_rms_v").max(peak(1, "control_rms_v"));
        assert!(close(columns["control_rms_v"].as_f64().unwrap(), most));
    }
    let names: Vec<&str> = found.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(
        names,
        ["alternatives.csv", "as declared.toml", "pipe.toml", "alternatives.svg", "alternatives.png"]
    );
}

/// What is finished when the watch stops is kept; the rest is named.
#[test]
fn a_stop_keeps_what_is_finished() {
    let mut watch = |progress: phea_workbench::command::Progress| progress.share < 0.34;
    let stopped = answer_watched(&source(LOOP), &load(LOOP, &[], &[]), &[], &ASKED, &mut watch).unwrap();
    let json = parsed(&stopped);
    assert_eq!(json["alternatives"].as_array().unwrap().len(), 1);
    assert_eq!(json["not_reached"], serde_json::json!(["faster", "late"]));
    assert!(!stopped.affirmative && stopped.text.contains("late: not reached"));
}
