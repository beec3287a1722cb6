//! Limits of the rig that a simulation exceeds, reported with their times.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::Request;
use serde_json::Value;

use super::run_command::answer;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

/// Limits exceeded in the first scenario, a step to 4 kN at 2 s; and the text.
fn exceeded(text: &str, settings: &[&str]) -> (Vec<Value>, String) {
    let output = answer(text, settings, &[], &Request::Simulate(Default::default()));
    let object: Value = parsed(&output.json);
    (object["scenarios"][0]["exceeded"].as_array().unwrap().clone(), output.text())
}

#[test]
fn a_rig_within_its_limits_exceeds_none() {
    assert!(exceeded(HOSE, &["force_sensor.capacity=10 kN"]).0.is_empty());
}

#[test]
fn an_overloaded_sensor_is_reported_with_its_time() {
    let (found, text) = exceeded(HOSE, &["force_sensor.capacity=3 kN"]);
    assert_eq!(found[0]["what"], "force_sensor_capacity");
    assert_eq!(found[0]["limit"], Value::from(3000.0));
    assert!(found[0]["peak"].as_f64().unwrap() > 4000.0);
    let first = found[0]["first_time_s"].as_f64().unwrap();
    assert!(first > 2.0 && first < 2.3 && first <= found[0]["peak_time_s"].as_f64().unwrap());
    assert!(text.contains("the force sensor is overloaded: its capacity is 3 kN"), "{text}");
}

/// Stall force of rods of 22 mm in a cylinder of 50 mm, with 70 bar relative to the tank: A p_S =
/// 11.08 kN, in either direction.
#[test]
fn a_reference_beyond_the_supply_is_reported() {
    let area = std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);
    for (reference, sign) in [("15 kN", 1.0), ("-15 kN", -1.0)] {
        let (found, text) = exceeded(HOSE, &[&format!("scenario.0.reference.0.force={reference}")]);
        let stall = found.iter().find(|one| one["what"] == "stall_force").unwrap();
        assert!((stall["limit"].as_f64().unwrap() - sign * area * 70e5).abs() < 1.0, "{stall}");
        assert_eq!((&stall["peak"], &stall["first_time_s"]), (&Value::from(sign * 15e3), &Value::from(2.0)));
        assert!(text.contains("the piston stalls at"), "{text}");
    }
}

#[test]
fn an_unlimited_command_is_reported() {
    let unlimited = HOSE.replace("saturation = \"10 V\"\n", "");
    // 0.01 V/N on 4 kN, which no prefilter reduces, are 40 V at once
    let settings = ["controller.numerator=0.01*s + 0.08", "prefilter.numerator=1", "prefilter.denominator=1"];
    let (found, _) = exceeded(&unlimited, &settings);
    let command = found.iter().find(|one| one["what"] == "nominal_voltage").unwrap();
    assert_eq!(command["limit"], Value::from(10.0));
    assert_eq!(command["first_time_s"], Value::from(2.0));
    assert!((40.0..41.0).contains(&command["peak"].as_f64().unwrap()), "{command}");
}

/// A pump with less flow than the valve takes: its relief valve is shut at 205 bar, and the supply
/// falls below that while the rig moves; with enough flow nothing is reported.
#[test]
fn a_pump_that_cannot_follow_is_reported() {
    let rig = include_str!("../../../examples/structural/rig.toml");
    let rig = &rig[..rig.find("[[scenario]]").unwrap()];
    let open = "[[scenario]]\nname = \"open\"\nduration = \"1 s\"\ncommand = [{ at = \"0.1 s\", voltage = \"8 V\" }]\n";
    let of = |flow: &str| exceeded(&format!("{rig}{open}"), &[&format!("supply.flow={flow} L/min")]);
    let pump = |found: &[Value]| found.iter().find(|one| one["what"] == "pump_flow").cloned();
    let (found, text) = of("4");
    let limit = pump(&found).unwrap();
    assert_eq!(limit["limit"], 205e5);
    assert!(limit["peak"].as_f64().unwrap() < 200e5, "{limit}");
    assert!(limit["first_time_s"].as_f64().unwrap() > 0.1, "{limit}");
    assert!(
        text.contains("on the pump delivers less than the rig takes: its relief valve is shut below"),
        "{text}"
    );
    assert_eq!(pump(&of("400").0), None);
}
