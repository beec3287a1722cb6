//! Relief and check valves at the ports from the user's side: quantities derived by `check`,
//! warnings above a verdict, openings of a run, and limits of the force.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use phea_workbench::command::Request;
use serde_json::Value;

use crate::answer_schema::parsed;
use crate::run_command::{HOSE, PIPE, answer, check, derived, json, near, size_request};

const VISCOUS: &str = "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }";
const LOADED: &str = "operating_point.load_force=2 kN";

/// Relief valves that open at a pressure in bar, of 20 L/min at 5 bar, with a transition in bar.
fn relief(cracking: f64, transition: f64) -> String {
    format!(
        "port_valves={{ cracking_pressure = \"{cracking} bar\", override = \"5 bar\", flow = \"20 L/min\", transition_pressure = \"{transition} bar\" }}"
    )
}

/// Pressures at which the valves open, conductances, and what flows at rest.
#[test]
fn check_derives_what_a_valve_passes_at_rest() {
    let output = check(PIPE, &[&relief(60.0, 0.1), LOADED]);
    let conductance = 20.0 / 6e4 / 5e5;
    near(derived(&output, "port_valves.a.relief_pressure"), 60e5, 1e-12);
    near(derived(&output, "port_valves.a.relief_conductance"), conductance, 1e-12);
    for name in ["flow", "conductance", "loss"] {
        assert_eq!(derived(&output, &format!("port_valves.b.{name}")), 0.0, "{name}");
    }
    let tight = "port_valves={ cracking_pressure = \"30 bar\", override = \"50 bar\", flow = \"0.1 L/min\" }";
    let output = check(PIPE, &[tight, LOADED]);
    let pressure = derived(&output, "operating_point.pressure_a");
    let (conductance, flow) = (0.1 / 6e4 / 50e5, derived(&output, "port_valves.a.flow"));
    near(flow, conductance * (pressure - 30e5), 1e-9);
    near(derived(&output, "port_valves.a.loss"), flow * pressure, 1e-9);
    // it adds to K_c of its chamber, and not to that of the servovalve
    let valve = derived(&output, "valve.flow_pressure_a");
    let bare = check(PIPE, &[LOADED]);
    assert!(derived(&output, "operating_point.command") > derived(&bare, "operating_point.command"));
    let [with, without] = [&output, &bare].map(|of| derived(of, "linear.flow_pressure_coefficient"));
    assert!(with > without && valve > 0.0, "{with} {without}");
}

/// The caveats of a verdict: none for valves that the supply does not open, and for others what the
/// plant includes.
#[test]
fn a_verdict_states_the_opening_of_a_valve() {
    let verdict = |valves: &str| {
        let request = Request::Verify { proof: false, on_machine: false };
        answer(PIPE, &[valves, LOADED, VISCOUS], &[], &request).text()
    };
    let states = |text: &str, words: &str| assert!(text.contains(words), "{words}: {text}");
    let far = verdict(&relief(90.0, 0.1));
    assert!(!far.contains("port_valves"), "{far}");
    states(
        &verdict(&relief(60.0, 0.1)),
        "the relief valve of chamber A opens above 60 bar, which the supply reaches",
    );
    let at_rest = derived(&check(PIPE, &[LOADED]), "operating_point.pressure_a") / 1e5;
    let within = verdict(&relief(at_rest, 0.5));
    states(&within, "the relief valve of chamber A is within its transition");
    let open = verdict(
        "port_valves={ cracking_pressure = \"30 bar\", override = \"50 bar\", flow = \"0.1 L/min\" }",
    );
    states(&open, "the relief valve of chamber A is open at the operating point");
}

/// The step of the linear loop is that of the machine with a valve that is open all the time, and a
/// step that opens a valve differs for that reason.
#[test]
fn a_run_on_the_machine_names_the_valve_that_opens() {
    let (before, rest) = PIPE.split_once("[uncertainty]").unwrap();
    let (_, specifications) = rest.split_once("[[specification]]").unwrap();
    let pipe = format!("{before}[[specification]]{specifications}");
    let request = Request::Verify { proof: false, on_machine: true };
    let run = |valves: &str| {
        let message = answer(&pipe, &[valves, VISCOUS, "controller.numerator=0.001*s + 0.1"], &[], &request);
        let object: Value = parsed(&message.json);
        object["machine"]["runs"][0].clone()
    };
    let far = run(&relief(90.0, 0.1));
    assert_eq!(far["agrees"], Value::from(true), "{far}");
    let opens = run(&relief(37.0, 0.1));
    assert_ne!(opens["agrees"], Value::from(true), "{opens}");
    assert!(opens.to_string().contains("relief valve"), "{opens}");
}

/// A load that drives the piston opens the relief valve of one chamber and the check valve of the
/// other; the run states when.
#[test]
fn a_run_states_its_openings() {
    let text = include_str!("../../../examples/benchmark/closed_loop.toml");
    let valves = |check: &str| {
        format!(
            "port_valves={{ cracking_pressure = \"42 bar\", override = \"1 bar\", flow = \"2 L/min\"{check} }}"
        )
    };
    let object = json(text, &[&valves("")], &[], &Request::Simulate(Default::default()));
    let occurrences = object["scenarios"][0]["occurrences"].as_array().unwrap().clone();
    let kinds: Vec<&str> = occurrences.iter().map(|one| one["kind"].as_str().unwrap()).collect();
    assert!(kinds.contains(&"relief_valve_a"), "{kinds:?}");
}

/// Sizing, whose chambers hold their oil, states every valve that acts within the supply, in text
/// and in JSON; a valve that the supply does not open is not mentioned.
#[test]
fn sizing_states_the_valves_that_it_does_not_include() {
    let warnings = |cracking: f64| {
        let sized = answer(HOSE, &[&relief(cracking, 0.1)], &[], &size_request(None, None));
        let all: Vec<String> = parsed(&sized.json)["warnings"]
            .as_array()
            .map(|all| all.iter().map(|one| one.as_str().unwrap().to_string()).collect())
            .unwrap_or_default();
        for sentence in &all {
            assert!(sized.text().contains(sentence.split(':').next().unwrap()), "{sentence}");
        }
        all
    };
    assert!(warnings(90.0).is_empty());
    let [of_a, of_b] = &warnings(60.0)[..] else { panic!("one warning a chamber") };
    for (sentence, chamber) in [(of_a, "A"), (of_b, "B")] {
        let begin = format!(
            "port_valves: the relief valve of chamber {chamber} opens above 60 bar, which the supply reaches"
        );
        assert!(sentence.starts_with(&begin), "{sentence}");
    }
    // the load needs 30 bar in chamber A, whose valve begins to open there
    let [of_a, of_b] = &warnings(30.0)[..] else { panic!("one warning a chamber") };
    assert!(of_a.contains("opens above 30 bar and passes oil at the operating point"), "{of_a}");
    assert!(of_b.contains("opens above 30 bar, which the supply reaches"), "{of_b}");
}
