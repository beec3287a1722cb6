//! Limits of lines and chambers, monitored at every node over the solution, and balances of oil and
//! energy that close.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use phea_workbench::command::{CampaignRequest, CampaignRuns, Request, SimulateRequest};
use phea_workbench::engineering::campaign::{Effort, RequestedRuns};
use serde_json::Value;

use super::run_command::{HOSE, json};

/// A valve that shuts within a millisecond at the end of a pipe of 10 m: the column of oil in the
/// pipe is torn off.
const HAMMER: &str = include_str!("projects/hammer.toml");

fn run(settings: &[&str]) -> Value {
    scenario(HAMMER, settings, false)
}

fn scenario(text: &str, settings: &[&str], ledgers: bool) -> Value {
    let request = Request::Simulate(SimulateRequest { ledgers, ..SimulateRequest::default() });
    json(text, settings, &[], &request)["scenarios"][0].clone()
}

fn exceeded<'a>(run: &'a Value, what: &str, place: &str) -> Option<&'a Value> {
    run["exceeded"].as_array().unwrap().iter().find(|one| one["what"] == what && one["place"] == place)
}

fn begins(run: &Value, kind: &str) -> Option<f64> {
    let found = run["occurrences"].as_array().unwrap();
    found.iter().find(|one| one["kind"] == kind && one["begins"] == true)?["time_s"].as_f64()
}

const SEGMENTS: &str = "line.model=segments";
const WAVES: &str = "line.model=transmission_line";

/// Shut at once, the pressure at the valve falls by rho c v (Joukowsky 1898): with 100 L/min in a
/// bore of 10 mm far below zero, in segments and in waves.
#[test]
fn a_line_that_is_shut_cavitates_at_its_valve() {
    for model in [SEGMENTS, WAVES] {
        let run = run(&[model]);
        let found = exceeded(&run, "vapour_pressure", "line_a").unwrap();
        // ORIGIN: analytic, vacuum is an atmosphere below zero gauge pressure
        assert_eq!(found["limit"].as_f64().unwrap(), -101325.0);
        assert!(found["peak"].as_f64().unwrap() < -50e5, "{found}");
        let first = found["first_time_s"].as_f64().unwrap();
        // 0.4 s plus the milliseconds in which the spool moves
        assert!((0.4..0.402).contains(&first), "{found}");
        assert_eq!(found["distance_m"], Value::from(0.0));
        assert_eq!(begins(&run, "cavitation_line_a"), Some(first));
        assert_eq!(run["outside_model_s"].as_f64(), Some(first));
        assert_eq!(run["status"], "outside_model");
    }
    let calm = run(&[SEGMENTS, "scenario.0.command.0.voltage=0.1 V"]);
    assert!(exceeded(&calm, "vapour_pressure", "line_a").is_none() && calm["outside_model_s"].is_null());
    assert_eq!(calm["status"], "completed");
}

/// Re = 4 q/(pi d nu): the bore and the viscosity at which an equal flow is laminar.
#[test]
fn flow_beyond_laminar_is_reported_where_laminar_friction_is_computed() {
    for model in [SEGMENTS, WAVES] {
        let thin = run(&[model]);
        let found = exceeded(&thin, "laminar_flow", "line_a").unwrap();
        let flow = thin["exceeded"].as_array().unwrap();
        assert!(!flow.is_empty() && found["limit"].as_f64().unwrap().abs() == 2300.0, "{found}");
        assert!(found["peak"].as_f64().unwrap().abs() > 5e3, "{found}");
        assert!(begins(&thin, "turbulent_line_a").is_some());
        let thick = run(&[model, "fluid.kinematic_viscosity=200 cSt"]);
        assert!(exceeded(&thick, "laminar_flow", "line_a").is_none());
    }
    // a line with one pressure has no friction
    assert!(exceeded(&run(&["line.model=lumped"]), "laminar_flow", "line_a").is_none());
}

/// Permissible pressures of a pipe, at every node: they are reported if they are below the peak of
/// a run without them.
#[test]
fn pressures_beyond_the_limit_of_a_pipe_are_reported() {
    let free = run(&[SEGMENTS]);
    assert!(exceeded(&free, "working_pressure", "line_a").is_none());
    let with = |working: &str, burst: &str| {
        let settings = [
            SEGMENTS,
            &format!("line.pipe.working_pressure={working}"),
            &format!("line.pipe.burst_pressure={burst}"),
        ]
        .map(String::from);
        run(&settings.each_ref().map(String::as_str))
    };
    let any = |run: &Value, what: &str| {
        let all = run["exceeded"].as_array().unwrap();
        all.iter()
            .filter(|one| one["what"] == what)
            .map(|one| one["peak"].as_f64().unwrap())
            .fold(0.0, f64::max)
    };
    // the supply has 100 bar, and the surge exceeds it
    let strong = with("1000 bar", "2000 bar");
    assert_eq!((any(&strong, "working_pressure"), any(&strong, "burst_pressure")), (0.0, 0.0));
    let yields = with("40 bar", "45 bar");
    let peak = any(&yields, "working_pressure");
    assert!(peak > 45e5 && any(&yields, "burst_pressure") == peak, "{yields}");
    assert!(begins(&yields, "working_pressure_a") <= begins(&yields, "burst_pressure_a"));
    // a chamber without a separate node is monitored as well
    let lumped = run(&["line.model=lumped", "line.pipe.working_pressure=40 bar"]);
    assert!(exceeded(&lumped, "working_pressure", "chamber_a").is_some(), "{lumped}");
}

/// Two pulses, sent from both ends at once, meet in the middle half a travelling time later and add
/// up: oil cavitates there and at neither end. Segments are the other model.
#[test]
fn a_line_cavitates_where_its_waves_meet() {
    let found = |model: &str| {
        let text = include_str!("projects/meeting_pulses.toml");
        let run = json(text, &[model], &[], &Request::Simulate(Default::default()))["scenarios"][0].clone();
        assert!(exceeded(&run, "vapour_pressure", "chamber_a").is_none(), "{run}");
        assert_eq!(run["status"], "outside_model", "{model}");
        let one = exceeded(&run, "vapour_pressure", "line_a").unwrap();
        let number = |key: &str| one[key].as_f64().unwrap();
        // the pulse of the valve is a little longer than that of the chamber
        assert!((number("distance_m") - 5.0).abs() < 0.25, "{model}: {one}");
        // 10 m at 1283 m/s: half of that after the valve opened and shut
        // ORIGIN: analytic, c = sqrt(1.4e9/850)
        let half_s = 5.0 / (1.4e9_f64 / 850.0).sqrt();
        assert!((2e-3 + half_s..4.5e-3 + half_s).contains(&number("peak_time_s")), "{model}: {one}");
        number("peak_time_s")
    };
    let [waves, segments] = [
        "line.model=transmission_line",
        "line={ model = \"segments\", segments = 16, length = \"10 m\", pipe = { bore = \"10 mm\" } }",
    ]
    .map(found);
    assert!((waves - segments).abs() < 0.1e-3, "{waves} {segments}");
}

/// Re = 4 q/(pi d nu) in the neck of an accumulator and in the line of a transmission: turbulent
/// with thin oil, laminar with thick.
#[test]
fn flow_in_necks_and_transmissions_is_reported_if_not_laminar() {
    let neck = ["line.accumulator.neck_diameter=6 mm", "line.accumulator.neck_length=40 mm"];
    let accumulator = include_str!("../../../examples/ybitu/accumulator.toml");
    let transmission = include_str!("../../../examples/ybitu/transmission.toml");
    for (text, own, place) in [(accumulator, &neck[..], "neck_a"), (transmission, &[], "transmission")] {
        let found = |viscosity: &str| {
            let settings = [own, &[viscosity]].concat();
            let run =
                json(text, &settings, &[], &Request::Simulate(Default::default()))["scenarios"][0].clone();
            exceeded(&run, "laminar_flow", place).cloned()
        };
        let thin = found("fluid.kinematic_viscosity=1 cSt").unwrap();
        assert!(
            thin["peak"].as_f64().unwrap().abs() > 2300.0 && thin["limit"].as_f64().unwrap().abs() == 2300.0
        );
        assert_eq!(found("fluid.kinematic_viscosity=400 cSt"), None);
    }
}

/// A campaign lists them with the other occurrences of a run, as the single run has them.
#[test]
fn a_campaign_lists_limits_of_lines() {
    let text = format!(
        "{HAMMER}[campaign]\nparameters = {{ \"supply.pressure\" = {{ minimum = \"99 bar\", maximum = \"101 bar\" }} }}\n"
    );
    let request = |runs| Request::Campaign(CampaignRequest { seed: 1, runs, files: false });
    let runs = RequestedRuns { runs: 2, effort: Effort::default() };
    let all = json(&text, &[SEGMENTS], &[], &request(CampaignRuns::All(runs)));
    let kinds: Vec<&str> =
        all["occurrences"].as_array().unwrap().iter().map(|one| one["kind"].as_str().unwrap()).collect();
    for kind in ["cavitation_line_a", "turbulent_line_a"] {
        assert!(kinds.contains(&kind), "{kinds:?}");
    }
    assert_eq!((&all["statuses"]["outside_model"], &all["statuses"]["completed"]), (&2.into(), &0.into()));
}

/// The inflow of each part minus its losses is its change of content, to a millionth of the total;
/// energy that is lost is positive.
#[test]
fn accounts_of_oil_and_energy_close() {
    for run in [scenario(HOSE, &[], true), scenario(HAMMER, &[SEGMENTS], true)] {
        for account in ["oil_m3", "energy_j"] {
            let rows = run["ledgers"][account].as_array().unwrap();
            assert!(rows.len() >= 3 && rows.last().unwrap()["part"] == "rig");
            for row in rows {
                let number = |key: &str| row[key].as_f64().unwrap();
                let held = [0, 1].map(|end: usize| row["stored"][end].as_f64().unwrap());
                let error = held[1] - held[0] - number("inflow") + number("lost");
                assert!(
                    (error - number("closing_error")).abs() <= 1e-12 * (held[1].abs() + number("lost").abs())
                );
                // for parts with very little flow, the tolerance of the run is a larger fraction
                let most = if row["part"] == "rig" { 1e-6 } else { 1e-5 };
                assert!(number("relative_error") < most, "{row}");
            }
        }
    }
    for without in [scenario(HAMMER, &[WAVES], true), run(&[SEGMENTS])] {
        assert!(without["ledgers"].is_null() && without["ledgers_reason"].is_string());
    }
}
