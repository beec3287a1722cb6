//! Output of `check` on scenarios before any of them is run.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{self, CommandError, Request};
use phea_workbench::project;
use phea_workbench::source::Memory;

use crate::run_command::HOSE;

/// The example with this scenario instead of its own.
fn with_scenario(lines: &str) -> String {
    let (before, _) = HOSE.split_once("[[scenario]]").unwrap();
    format!("{before}[[scenario]]\nname = \"only\"\nduration = \"2 s\"\n{lines}\n")
}

fn check(text: &str, settings: &[&str], files: &[(&str, &str)]) -> Result<String, CommandError> {
    let source = Memory::default().with("rig.toml", text);
    let source = files.iter().fold(source, |source, (path, text)| source.with(path, *text));
    let settings: Vec<String> = settings.iter().map(ToString::to_string).collect();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    command::answer(&source, &loaded, &[], &Request::Check).map(|answer| answer.text)
}

/// The warnings on the scenario.
fn warnings(text: &str, settings: &[&str]) -> Vec<String> {
    let answer = check(text, settings, &[]).unwrap();
    assert!(answer.contains("The project is valid"));
    let lines = answer.lines().filter_map(|line| line.strip_prefix("warning: scenario \"only\": "));
    lines.map(|line| line.split(" (line ").next().unwrap_or_default().to_string()).collect()
}

#[test]
fn a_reference_beyond_the_stall_force_is_warned_of() {
    // ORIGIN: analytic, A = pi/4 (50^2 - 22^2) mm2 = 1583.4 mm2: 11.084 kN at 70 bar
    let at = |force: &str| with_scenario(&format!("reference = {{ at = \"1 s\", force = \"{force}\" }}"));
    assert_eq!(warnings(&at("11 kN"), &[]), Vec::<String>::new());
    let beyond = "the reference goes to 11.2 kN at 1 s, and at a supply of 70 bar the piston stalls at 11.08 kN: no controller reaches it";
    assert_eq!(warnings(&at("11.2 kN"), &[]), [beyond]);
    assert!(warnings(&at("-11.2 kN"), &[])[0].starts_with("the reference goes to -11.2 kN at 1 s"));
    // a sine on a ramp reaches the sum of both
    let sum = with_scenario(
        "reference = [{ kind = \"ramp\", force = \"8 kN\", duration = \"0.5 s\" }, \
         { kind = \"sine\", start = \"1 s\", amplitude = \"3.5 kN\", frequency = \"1 Hz\" }]",
    );
    assert!(
        warnings(&sum, &[])[0].starts_with("the reference goes to 11.5 kN at 1.25 s"),
        "{:?}",
        warnings(&sum, &[])
    );
    // the lowest supply of the family
    let family = at("9 kN").split("[uncertainty]").next().unwrap().to_string()
        + "[uncertainty]\n\"supply.pressure\" = { nominal = \"70 bar\", minimum = \"50 bar\", maximum = \"70 bar\" }\n[[scenario]]"
        + at("9 kN").split("[[scenario]]").nth(1).unwrap();
    assert!(warnings(&family, &[])[0].contains("at a supply of 50 bar the piston stalls at 7.917 kN"));
}

/// A relief valve limits the force before the piston stalls: to what the fully open servovalve
/// holds against it.
#[test]
fn a_reference_beyond_the_relief_valves_is_warned_of() {
    let at = |force: &str| with_scenario(&format!("reference = {{ at = \"1 s\", force = \"{force}\" }}"));
    let valves = "port_valves={ cracking_pressure = \"50 bar\", override = \"0.1 bar\", flow = \"20 L/min\", transition_pressure = \"0.1 bar\" }";
    // ORIGIN: analytic, 1583.4 mm2 at 50 bar: 7.917 kN, less what the other chamber holds; at most
    // 0.1 bar more
    assert_eq!(warnings(&at("7.8 kN"), &[valves]), Vec::<String>::new());
    let beyond = &warnings(&at("8 kN"), &[valves])[0];
    let expected =
        "the reference goes to 8 kN at 1 s, and the relief valve that opens at 50 bar holds it to 7.9";
    assert!(beyond.starts_with(expected), "{beyond}");
    let one = "port_valves.b={ cracking_pressure = \"50 bar\", override = \"0.1 bar\", flow = \"20 L/min\" }";
    assert_eq!(warnings(&at("8 kN"), &[one]), Vec::<String>::new());
    assert_eq!(warnings(&at("-8 kN"), &[one]).len(), 1);
}

#[test]
fn the_capacity_of_the_sensor_and_the_stroke_are_warned_of() {
    let reference = with_scenario("reference = { at = \"1 s\", force = \"4 kN\" }");
    let beyond = "the reference goes to 4 kN at 1 s, beyond the sensor's `capacity` of 3 kN";
    assert_eq!(warnings(&reference, &["force_sensor.capacity=\"3 kN\""]), [beyond]);
    let motion = |distance: &str| {
        with_scenario(&format!(
            "start = {{ position = \"250 mm\", pressure_a = \"35 bar\", pressure_b = \"35 bar\" }}\n\
             load_motion = {{ kind = \"smooth_step\", start = \"1 s\", duration = \"0.5 s\", distance = \"{distance}\" }}"
        ))
    };
    assert_eq!(warnings(&motion("240 mm"), &[]), Vec::<String>::new());
    let warnings = warnings(&motion("-300 mm"), &[]);
    assert!(
        warnings[0].ends_with("takes the piston from 250 mm to -50 mm, beyond its stroke of 500 mm"),
        "{warnings:?}"
    );
}

#[test]
fn a_file_that_is_missing_or_malformed_is_an_error_with_its_place() {
    let text = with_scenario("reference = { kind = \"file\", file = \"force.csv\" }");
    let refusal = |files: &[(&str, &str)]| {
        let error = check(&text, &[], files).unwrap_err();
        let refusal = error.refusal().unwrap();
        let found = refusal.diagnostics.first().unwrap();
        (found.message.clone(), found.file.clone(), found.line)
    };
    let line = text.lines().position(|line| line.starts_with("reference")).unwrap() + 1;
    let (message, file, at) = refusal(&[]);
    assert!(message.starts_with("cannot read force.csv"), "{message}");
    assert_eq!((file.as_str(), at), ("rig.toml", line));
    let malformed = ("force.csv", "time_s,force_n\n0,0\n0.1,abc\n");
    assert_eq!(refusal(&[malformed]), ("`abc` is not a number".to_string(), "force.csv".to_string(), 3));
    assert!(check(&text, &[], &[("force.csv", "time_s,force_n\n0,0\n0.1,3000\n")]).is_ok());
}
