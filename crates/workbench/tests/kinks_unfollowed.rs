//! Runs in which no deviation can be followed from kink to kink report this; those that are judged
//! otherwise need not.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{Request, SimulateRequest};

use super::run_command::{HOSE, answer, json};

const CONTINUOUS: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
const SHORT: [&str; 4] = [
    "scenario.0.duration=0.4 s",
    "scenario.0.reference.0.at=0.05 s",
    "scenario.0.load_motion.start=0.2 s",
    "scenario.0.load_motion.duration=50 ms",
];
const SENTENCE: &str = "the growth of a deviation from one to the next is not followed";

#[test]
fn a_run_without_a_carried_deviation_reports_it() {
    let simulate = |settings: &[&str], check: bool| {
        let settings = [&SHORT, settings].concat();
        let request = Request::Simulate(SimulateRequest { check, ..SimulateRequest::default() });
        let run = json(CONTINUOUS, &settings, &[], &request)["scenarios"][0].clone();
        (run, answer(CONTINUOUS, &settings, &[], &request).text())
    };
    for (settings, cause) in [
        (&["controller.sample_time=1 ms"][..], "samples"),
        (&["controller.sample_time=1 ms", "controller.delay=0.4 ms"], "samples"),
        (&["controller.delay=0.5 ms"], "delays"),
        (&["simulation.method=dormand_prince"], "method"),
    ] {
        let (run, text) = simulate(settings, false);
        assert_eq!(run["kinks_unfollowed"]["cause"], cause, "{settings:?}");
        assert!(run["kinks_unfollowed"]["steps"].as_u64().unwrap() > 1, "{run}");
        assert!(text.contains(SENTENCE), "{settings:?}: {text}");
        let (run, text) = simulate(settings, true);
        assert!(run["kinks_unfollowed"].is_object() && run["check"].is_object(), "{run}");
        assert!(!text.contains(SENTENCE), "{text}");
    }
    let (run, text) = simulate(&[], false);
    assert!(run["kinks_unfollowed"].is_null() && run["kinks_unfollowed_reason"].is_string(), "{run}");
    assert!(!text.contains(SENTENCE), "{text}");
}

/// A line with waves contains a part of a deviation; a rig with a lumped line does not.
#[test]
fn waves_hold_a_part_of_a_deviation() {
    let scenario = "scenario=[{ name = \"there and back\", duration = 0.4, reference = [{ at = 0.02, force = 1000 }, { at = 0.2, force = -500 }] }]";
    let of = |model: &str| {
        let settings =
            ["line.compliance=by_volume", "controller.numerator=0.0005*s + 0.004", scenario, model];
        json(HOSE, &settings, &[], &Request::Simulate(SimulateRequest::default()))["scenarios"][0].clone()
    };
    let waves = of("line.model=transmission_line");
    assert_eq!(waves["kinks_unfollowed"]["cause"], "delays", "{waves}");
    assert!(of("line.model=lumped")["kinks_unfollowed"].is_null());
}
