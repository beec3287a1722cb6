//! Verdicts on rigs with waves in their lines: their responses, their stability, and their steps
//! compared with the machine's.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_dynamics::random::uniform;
use phea_workbench::command::Request;
use serde_json::Value;

use super::run_command::answer;

/// The hose, with its chambers by volume, without its family: one rig.
fn one_rig() -> String {
    let text = include_str!("../../../examples/ybitu/hose.toml");
    let (before, rest) = text.split_once("[uncertainty]").unwrap();
    let (_, after) = rest.split_once("[[specification]]").unwrap();
    format!("{before}[[specification]]{after}")
}

fn answer_of(request: &Request, settings: &[&str]) -> Value {
    let common = [
        "line.compliance=by_volume",
        "linear.flow_gain=5.4e-5",
        "linear.flow_pressure_coefficient=6.42e-13",
        "linear.viscous_friction=100",
        "linear.valve_natural_frequency=1099",
        "linear.valve_damping_ratio=0.9",
    ];
    let settings: Vec<&str> = common.into_iter().chain(settings.iter().copied()).collect();
    parsed(&answer(&one_rig(), &settings, &[], request).json)
}

/// Unstable poles that an answer reports.
fn unstable(object: &Value) -> usize {
    let reason = object["stability"]["reason"].as_str().unwrap();
    let before = reason.split_once(" unstable closed-loop pole").map(|(before, _)| before);
    before.map_or(0, |before| before.rsplit(' ').next().unwrap().parse().unwrap())
}

/// The published loop has gain beyond the quarter wave of its hoses: four poles are unstable, two
/// if the wall moves along too, and none with a wall that creeps fast enough.
#[test]
fn the_published_loop_is_unstable_with_waves() {
    let count = |settings: &[&str]| {
        unstable(&answer_of(&Request::Verify { proof: false, on_machine: false }, settings))
    };
    assert_eq!(count(&[]), 0);
    // ORIGIN: recomputed by comparisons/recompute_waves.py
    assert_eq!(count(&["line.model=transmission_line"]), 4);
    assert_eq!(count(&["line.model=two_wave"]), 2);
    for (relaxation, expected) in [("1 ms", 0), ("3 ms", 0), ("10 ms", 2)] {
        let relaxation = format!("line.relaxation_time={relaxation}");
        assert_eq!(
            count(&["line.model=segments", "line.segments=12", &relaxation]),
            expected,
            "{relaxation}"
        );
    }
}

/// The predicted step is the machine's, if the loop is stable.
#[test]
fn the_predicted_step_is_that_of_the_machine() {
    let object = answer_of(
        &Request::Verify { proof: false, on_machine: true },
        &["line.model=segments", "line.segments=8", "line.relaxation_time=1 ms"],
    );
    let first = &object["machine"]["runs"][0];
    let both = |key: &str| [&first["linear"], &first["steps"][0]].map(|of| of[key].as_f64().unwrap());
    let [overshoot, settling] = [both("overshoot_percent"), both("settling_time_s")];
    assert!(
        (overshoot[0] - overshoot[1]).abs() < 1.0 && (settling[1] / settling[0] - 1.0).abs() < 0.1,
        "{first}"
    );
    assert_eq!(first["agrees"], Value::from(true));
}

/// A valve that leaks leaves a loop with a tail that is slower than anything in the plant: waves
/// hardly change it, but it is part of the predicted step.
#[test]
fn a_tail_slower_than_the_plant_is_predicted() {
    let predicted = |settings: [&str; 2]| {
        let slow = [
            "linear.flow_pressure_coefficient=7e-11",
            "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
            "controller={ numerator = \"4e-4*s + 4e-3\", denominator = \"s\" }",
            "prefilter={ numerator = \"1\", denominator = \"1\" }",
            // no room for a larger step
            "force_sensor.capacity=3.4 kN",
            settings[0],
            settings[1],
        ];
        let object = answer_of(&Request::Verify { proof: false, on_machine: true }, &slow);
        let linear = &object["machine"]["runs"][0]["linear"];
        ["overshoot_percent", "settling_time_s"].map(|key| linear[key].as_f64().unwrap())
    };
    let [lumped, waves] = ["line.model=lumped", "line.model=transmission_line"];
    let [continuous, sampled] = ["controller.delay=0 s", "controller.sample_time=1 ms"];
    let lumps = predicted([lumped, continuous]);
    assert!(lumps[0] < 0.01 && lumps[1] > 1.0, "{lumps:?}");
    for settings in [[lumped, sampled], [waves, continuous], [waves, sampled]] {
        let other = predicted(settings);
        let settles_alike = (other[1] / lumps[1] - 1.0).abs() < 0.1;
        assert!(other[0] < 0.01 && settles_alike, "{lumps:?} {other:?} {settings:?}");
    }
}

/// A loop below the quarter wave of the hoses satisfies everything for the one rig, and the machine
/// agrees.
#[test]
fn one_rig_with_waves_is_designed_for() {
    let object = answer_of(
        &Request::Design { seed: None, stages: false, repair: false },
        &["line.model=transmission_line"],
    );
    assert_eq!(object["status"], Value::from("met"));
    assert_eq!(object["verification"]["verdict"], Value::from("met"));
    // a step six times as large settles more slowly than the linear loop, and is reported as such
    assert_ne!(object["machine"]["verdict"], Value::from("contradicts"), "{}", object["machine"]);
    assert_eq!(object["machine"]["runs"][0]["agreement"], Value::from("agrees"), "{}", object["machine"]);
}

/// A family with lines in motion names its plants by their parameters, like every other family.
#[test]
fn worst_plants_have_their_parameters() {
    let text = include_str!("../../../examples/ybitu/hose.toml");
    let settings = ["line.model=segments", "line.segments=4", "line.relaxation_time=0.3 ms"];
    let output = answer(text, &settings, &[], &Request::Verify { proof: false, on_machine: false });
    let object: Value = parsed(&output.json);
    let worst = &object["specifications"][1]["plant"];
    let flow_gain = worst["flow_gain"].as_f64().unwrap();
    assert!((3.23e-5..=5.61e-5).contains(&flow_gain), "{worst}");
    assert!(output.text.contains("every plant by its response with lines in motion"), "{}", output.text);
}

/// A box with lines in motion is searched between its members too: no rig that is declared anywhere
/// in it is worse than the worst plant found, which is worse than any corner.
#[test]
fn a_box_is_searched_between_its_members() {
    let (start, specifications) = {
        let text = one_rig();
        let (start, specifications) = text.split_once("[[specification]]").unwrap();
        (start.to_string(), specifications.to_string())
    };
    let range = "[uncertainty]\n\"operating_point.position\" = { nominal = 0.25, minimum = 0.05, maximum = 0.45, points = 2 }\n\
                 \"line.length\" = { nominal = 1.5, minimum = 0.8, maximum = 2.2, points = 2 }\n";
    let text = format!("{start}{range}[[specification]]{specifications}");
    let moving = ["line.model=segments", "line.segments=6", "line.relaxation_time=0.5 ms"];
    let margin = |text: &str, settings: &[&str]| {
        let output = answer(text, settings, &[], &Request::Verify { proof: false, on_machine: false });
        let object: Value = parsed(&output.json);
        assert_eq!(object["stability"]["verdict"], Value::from("met"), "{}", output.text);
        object["specifications"][0]["worst_margin_db"].as_f64().unwrap()
    };
    let found = margin(&text, &moving);
    let mut state = 3;
    let declared = |position: f64, length: f64| {
        let stated = [format!("operating_point.position={position}"), format!("line.length={length}")];
        let settings: Vec<&str> = moving.into_iter().chain(stated.iter().map(String::as_str)).collect();
        margin(&one_rig(), &settings)
    };
    for _ in 0..20 {
        let position = 0.05 + 0.4 * uniform(&mut state);
        let length = 0.8 + 1.4 * uniform(&mut state);
        let own = declared(position, length);
        assert!(own > found - 2e-3, "{own} dB at {position} m, {length} m; found {found} dB");
    }
    let corners = [[0.05, 0.8], [0.05, 2.2], [0.45, 0.8], [0.45, 2.2]];
    let corners = corners.map(|[position, length]| declared(position, length));
    let worst = corners.into_iter().fold(f64::INFINITY, f64::min);
    assert!(found < worst - 0.02, "{found} dB, corners {corners:?}");
}
