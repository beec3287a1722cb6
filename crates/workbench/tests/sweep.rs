//! `linearize --sweep`: each value agrees with `linearize` for the project with that value.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::run_command::{HOSE, answer, try_answer};
use phea_workbench::command::Request;
use phea_workbench::engineering::linearize::SweepRequest;
use serde_json::Value;

fn request(range: &str, points: Option<usize>) -> Request {
    Request::Linearize { sweep: Some(SweepRequest { range: range.to_string(), points }) }
}

fn swept(project: &str, range: &str, points: usize) -> Value {
    parsed(&answer(project, &[], &[], &request(range, Some(points))).json)
}

fn refused(range: &str, points: Option<usize>) -> String {
    try_answer(HOSE, &[], &[], &request(range, points)).unwrap_err().to_string()
}

/// The hose without the ranges that state the parameters of its linear model.
fn derived_hose() -> String {
    let (before, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[controller] ").unwrap();
    format!("{before}[controller] {after}")
}

#[test]
fn each_value_is_that_of_linearize() {
    let hose = derived_hose();
    let swept = swept(&hose, "line.length=0.5 m..3 m", 6);
    let rows = swept["sweep"].as_array().unwrap();
    assert_eq!(
        (rows.len(), &swept["swept"]["key"], &swept["swept"]["plant_follows"]),
        (6, &"line.length".into(), &true.into())
    );
    let mut before = f64::INFINITY;
    for (row, length) in rows.iter().zip([0.5, 1.0, 1.5, 2.0, 2.5, 3.0]) {
        assert_eq!(row["value"].as_f64(), Some(length));
        let setting = format!("line.length={length}");
        let single: Value =
            parsed(&answer(&hose, &[&setting], &[], &Request::Linearize { sweep: None }).json);
        for end in ["minimum_n_per_m", "maximum_n_per_m"] {
            assert_eq!(row["stiffness"][end], single["stiffness"][end], "{length} {end}");
        }
        assert_eq!(row["poles"]["plant"], single["poles"]["plant"], "{length}");
        assert_eq!(row["passive"]["closed_loop"], single["passivity"]["closed_loop"]["passive"], "{length}");
        // more hose, more compliance
        let stiffness = row["stiffness"]["minimum_n_per_m"].as_f64().unwrap();
        assert!(stiffness < before, "{length}");
        before = stiffness;
        assert!(row["bandwidth_rad_per_s"].as_f64().unwrap() > 1.0, "{row}");
    }
}

/// The stated parameters fix the plant, and this is reported.
#[test]
fn a_key_without_effect_on_the_plant_is_reported() {
    let swept = swept(HOSE, "line.length=0.5..3", 3);
    let rows = swept["sweep"].as_array().unwrap();
    assert_eq!(swept["swept"]["plant_follows"], false);
    assert_eq!(rows[0]["poles"]["plant"], rows[2]["poles"]["plant"]);
    assert_ne!(rows[0]["poles"]["derived"], rows[2]["poles"]["derived"]);
    let text = answer(HOSE, &[], &[], &request("line.length=0.5..3", None)).text();
    assert!(text.contains("does not follow `line.length`") && text.contains("line.length, m"), "{text}");
}

#[test]
fn ends_take_units_as_in_the_file() {
    let values = |range: &str| {
        let swept = swept(HOSE, range, 3);
        let rows = swept["sweep"].as_array().unwrap().clone();
        rows.iter().map(|row| row["value"].as_f64().unwrap()).collect::<Vec<_>>()
    };
    for range in [
        "line.length=0.5..3",
        "line.length=0.5 m..3 m",
        "line.length = 0.5..3 m",
        "line.length=500..3000 mm",
        "line.length=50 cm..3",
    ] {
        for (value, expected) in values(range).iter().zip([0.5, 1.75, 3.0]) {
            assert!((value - expected).abs() < 1e-12, "{range}: {value}");
        }
    }
    assert_eq!(values("line.length=3..0.5"), [3.0, 1.75, 0.5]);
    // more than a factor of a hundred apart: by ratio
    let viscous = values("cylinder.friction.viscous=100..1e6");
    assert!((viscous[1] - 1e4).abs() < 1e-6, "{viscous:?}");
}

#[test]
fn an_invalid_sweep_is_refused_with_a_valid_one() {
    for (range, words) in [
        ("line.lenght=0.5..3", "did you mean `line.length`?"),
        ("valve.model=1..2", "only a number can be swept"),
        ("line.length", "KEY=FROM..TO"),
        ("line.length=0.5", "KEY=FROM..TO"),
        ("line.length=..3", "KEY=FROM..TO"),
        ("line.length=1..1", "both ends are the same"),
        ("line.length=1 bar..3 bar", "a length"),
        ("line.length=1..3 mm2", "a length"),
        ("line.length=-1..3", "outside"),
        ("line.length=1..inf", "KEY=FROM..TO"),
    ] {
        let message = refused(range, None);
        assert!(
            message.starts_with("--sweep") && (message.contains(words) || range.ends_with("inf")),
            "{range}: {message}"
        );
    }
    assert!(refused("line.length=1..3", Some(1)).contains("2 to 1000 points"));
}

#[test]
fn it_writes_a_figure_and_a_table() {
    let answer = answer(&derived_hose(), &[], &[], &request("line.length=0.5..3", Some(4)));
    let names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    for name in ["poles.csv", "sweep.csv", "sweep.svg"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let drawn = answer.files.iter().find(|file| file.name == "sweep.svg").unwrap();
    let drawn = std::str::from_utf8(&drawn.bytes).unwrap();
    for words in ["line.length (m)", "pair of poles", "bandwidth of the loop", "least "] {
        assert!(drawn.contains(words), "{words}");
    }
}
