//! Basis of a verdict, in words: every delay of the loop, the force of a region that states none,
//! and a valve that leaks most next to null.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use phea_hydraulics::servovalve::blocked_ports;
use phea_workbench::command::Request;
use phea_workbench::setup::Setup;

use super::run_command::{HOSE, answer, json, near, number, project_of};

const VERIFY: Request = Request::Verify { proof: false, on_machine: false };
const VANE: &str = include_str!("../../../examples/rotary/vane.toml");

const STRUCTURAL: &str = include_str!("../../../examples/structural/rig.toml");
const LOOP: &str = r#"
schema = 1
title = "Delays"
[plant]
numerator = "1"
denominator = "s + 1"
[controller]
numerator = "1"
denominator = "s"
[[specification]]
kind = "robust_stability"
limit = 2
frequencies = [0.1, 1]
"#;

fn loop_sentence(text: &str, settings: &[&str]) -> String {
    let statement = answer(text, settings, &[], &VERIFY).text;
    statement.lines().find(|line| line.trim_start().starts_with("Loop: ")).unwrap().trim().to_string()
}

/// The position of every plant is named, unless the family varies it or the stiffness that depends
/// on it.
#[test]
fn the_position_of_all_plants_is_named() {
    let statement = |text: &str, settings: &[&str]| answer(text, settings, &[], &VERIFY).text;
    let sentence = "Position: every plant is taken at 150 mm of 300 mm of stroke.";
    assert!(statement(STRUCTURAL, &["line.model=lumped"]).contains(sentence));
    let position = &json(STRUCTURAL, &["line.model=lumped"], &[], &VERIFY)["position"];
    assert_eq!(*position, serde_json::json!({ "position_m": 0.15, "stroke_m": 0.3 }));
    let region = "family.operating_region={ position = [\"140 mm\", \"160 mm\"], points = 2 }";
    for (text, settings) in
        [(STRUCTURAL, &["line.model=lumped", region][..]), (HOSE, &[]), (VANE, &[]), (LOOP, &[])]
    {
        assert!(!statement(text, settings).contains("Position: "), "{settings:?}");
    }
}

/// Dead time of plant, sensor, controller and lines, each named at its place.
#[test]
fn every_delay_of_a_loop_is_named() {
    let sensor = "sensor={ numerator = \"1\", denominator = \"0.01*s + 1\", delay = \"20 ms\" }";
    let range = ["plant.delay=T", "uncertainty.T={ nominal = 0.015, minimum = 0.01, maximum = 0.03 }"];
    for (settings, expected) in [
        (&[][..], "Loop: continuous, without delay."),
        (
            &["plant.delay=0.1 s"],
            "Loop: continuous, without delay of its own, with a dead time of 100 ms in the plant.",
        ),
        (
            &range,
            "Loop: continuous, without delay of its own, with a dead time of 10.0 ms to 30.0 ms in the plant.",
        ),
        (&[sensor], "Loop: continuous, without delay of its own, with a dead time of 20.0 ms in the sensor."),
        (
            &[sensor, "plant.delay=0.1 s", "controller.delay=5 ms"],
            "Loop: continuous, with a delay of 5.00 ms, with a dead time of 100 ms in the plant and 20.0 ms in the sensor.",
        ),
        (
            &["plant.delay=0.1 s", "controller.sample_time=50 ms"],
            "Loop: sampled every 50.0 ms with a zero-order hold, without delay of its own, with a dead time of 100 ms in the plant.",
        ),
    ] {
        assert_eq!(loop_sentence(LOOP, settings), expected, "{settings:?}");
    }
    assert_eq!(loop_sentence(HOSE, &[]), "Loop: continuous, without delay.");
    let waves = loop_sentence(HOSE, &["line.model=transmission_line"]);
    assert_eq!(waves, "Loop: continuous, without delay but that of its lines in motion.");
}

const POSITIONS_ONLY: &str = "family.operating_region has positions alone";

/// A region that has positions only is that of a piston blocked at null; its force is stated, and
/// zero force is a different region.
#[test]
fn a_region_of_positions_only_states_its_force() {
    let region = |text: &str| format!("family.operating_region={{ position = {text} }}");
    let positions = region("[\"50 mm\", \"400 mm\"]");
    let none = "uncertainty={}";
    let statement = |text: &str, settings: &[&str]| {
        let sentence_of = answer(text, settings, &[], &VERIFY).text;
        sentence_of.lines().find(|line| line.contains(POSITIONS_ONLY)).map(str::to_string)
    };
    let project = project_of(HOSE, &[none]);
    let parts = *Setup::new(&project).unwrap().rig().unwrap().actuator.components();
    let ports = blocked_ports(&parts.valve, &parts.supply, 0.0);
    let [area_a, area_b] = parts.cylinder.greatest_areas();
    // ORIGIN: analytic, A_A p_A - A_B p_B of blocked ports
    let force_kn = 1e-3 * (area_a * ports.pressure_a - area_b * ports.pressure_b);
    let sentence_of = statement(HOSE, &[none, &positions]).unwrap();
    assert!(sentence_of.contains(&format!("{force_kn:.3} kN")), "{sentence_of} {force_kn}");
    // the stages of a telescopic piston, and valves with equal edges on a piston with one rod
    let equal = [
        "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
        "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
    ];
    let [one, other] = equal;
    assert_eq!(statement(HOSE, &[none, &positions, one, other]), None);
    let one_rod = HOSE.replace("rod_diameter = \"22 mm\"", "rod_diameters = [\"0 mm\", \"22 mm\"]");
    assert!(statement(&one_rod, &[none, &positions, one, other]).unwrap().contains("kN"));
    // regions with a force, or a velocity, or a stated zero force
    let at_rest = "operating_point.load_force=0";
    assert_eq!(statement(HOSE, &[none, &positions, at_rest]), None);
    let moving = "family.operating_region={ position = [\"50 mm\", \"400 mm\"], velocity = [0, \"1 mm/s\"] }";
    assert_eq!(statement(HOSE, &[none, moving]), None);
    let worst =
        |settings: &[&str]| number(&json(HOSE, settings, &[], &VERIFY), "specifications.0.worst_margin_db");
    let without_force = "family.operating_region={ position = [\"50 mm\", \"400 mm\"], load_force = [0, 0] }";
    let [stated, region] = [worst(&[none, &positions, at_rest]), worst(&[none, without_force])];
    near(stated, region, 1e-3);
    assert!((worst(&[none, &positions]) - stated).abs() > 0.5);
}

const NEXT_TO_NULL: &str = "the valve leaks most near null";

/// Two humps of the leakage are stated with the numbers of the blocked valve, for a cylinder and
/// for a motor; a leakage that is highest at null is not mentioned.
#[test]
fn a_valve_that_leaks_most_next_to_null_is_reported() {
    // every command on the linear loop states it, like `check`
    let humps = "valve.leakage_shape=40";
    for request in [Request::Check, VERIFY, Request::Linearize { sweep: None }] {
        let statement = json(HOSE, &[humps], &[], &request);
        let warnings = statement["warnings"].as_array().unwrap();
        let own =
            warnings.iter().filter(|one| one.as_str().is_some_and(|words| words.contains(NEXT_TO_NULL)));
        assert_eq!(own.count(), 1, "{}", request.name());
    }
    let sentence_of = |text: &str, settings: &[&str]| {
        let statement = answer(text, settings, &[], &Request::Check).text;
        statement.lines().find(|line| line.contains(NEXT_TO_NULL)).map(str::to_string)
    };
    for (text, shape) in [(HOSE, "40"), (super::against_the_load::RIG, "30"), (VANE, "60")] {
        let shape = format!("valve.leakage_shape={shape}");
        let sentence_of = sentence_of(text, &[&shape]).unwrap_or_else(|| panic!("{shape}"));
        let project = project_of(text, &[&shape]);
        let parts = *Setup::new(&project).unwrap().rig().unwrap().actuator.components();
        let leak = |opening: f64| blocked_ports(&parts.valve, &parts.supply, opening).supply_flow;
        let steps = (0..40_000).map(|step| 5e-5 * f64::from(step));
        let sides =
            [1.0, -1.0].map(|side| steps.clone().map(|opening| leak(side * opening)).fold(0.0, f64::max));
        // ORIGIN: analytic, the lower of both humps in L/min
        let lower = 6e4 * sides[0].min(sides[1]);
        let (_, after) = sentence_of.split_once("near null, ").unwrap();
        let printed: f64 = after.split_once(" L/min").unwrap().0.parse().unwrap();
        near(printed, lower, 6e-3);
    }
    for (text, shape) in [(HOSE, "400"), (super::against_the_load::RIG, "2000"), (VANE, "900")] {
        let shape = format!("valve.leakage_shape={shape}");
        assert_eq!(sentence_of(text, &[&shape]), None, "{shape}");
    }
}
