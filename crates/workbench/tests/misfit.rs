//! Misfit of the valve's model with its recordings, which reaches every verdict on the valve.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use phea_workbench::command::{self, Request, SimulateRequest};
use phea_workbench::identify::{Identification, Known, Search, SignalKind, identify, recordings};
use phea_workbench::project::RecordedTest;
use phea_workbench::source::{Memory, Source};
use serde_json::Value;

use crate::friction_identification::{SLIDING, identified as friction_of, recorded};
use crate::run_command;

const RECORDED: [(&str, &str); 4] = [
    ("leakage.csv", include_str!("../../../examples/ybitu/recorded/leakage.csv")),
    ("metering.csv", include_str!("../../../examples/ybitu/recorded/metering.csv")),
    ("metering_low_flow.csv", include_str!("../../../examples/ybitu/recorded/metering_low_flow.csv")),
    ("pressure_gain.csv", include_str!("../../../examples/ybitu/recorded/pressure_gain.csv")),
];
const COMMAND: usize = 1;
const FLOW: usize = 5;

/// The recordings with the flows of the metering tests changed: a function of the completed
/// fraction of the test, the command in V and the flow in L/min.
fn identified(change: impl Fn(f64, f64, f64) -> f64) -> Identification {
    let mut source = Memory::default();
    for (name, text) in RECORDED {
        let rows = text.lines().count() as f64;
        let line = |(row, line): (usize, &str)| {
            let mut cells: Vec<String> = line.split(',').map(ToString::to_string).collect();
            if name.starts_with("metering")
                && let Ok(flow) = cells[FLOW].parse::<f64>()
            {
                cells[FLOW] = change(row as f64 / rows, cells[COMMAND].parse().unwrap(), flow).to_string();
            }
            cells.join(",") + "\n"
        };
        source = source.with(name, text.lines().enumerate().map(line).collect::<String>());
    }
    let files = RECORDED.map(|(name, _)| RecordedTest::of(name));
    let known = Known { supply_pressure: Some(70e5), ..Known::default() };
    let read = recordings(&source, &files, &known).unwrap_or_else(|refusal| panic!("{refusal:?}"));
    identify(read.recordings, &known, Search::default(), &mut phea_dynamics::watch::unwatched).unwrap()
}

/// Recordings of the model itself leave only noise.
#[test]
fn recordings_of_the_model_have_no_misfit() {
    let found = identified(|_, _, flow| flow);
    assert!(found.misfits().is_empty(), "{:?}", found.misfits());
}

/// A flow that ends at the flow of the supply; a meter whose gain drifts by a tenth over the test;
/// a meter that loses a constant flow, which the pressures do not show: in each case the flow is
/// named, and its residual has the size of the change that no coefficients produce.
#[test]
fn a_flow_that_no_valve_of_the_model_has_is_reported() {
    let limited = identified(|_, _, flow| flow.min(9.0));
    let drifting = identified(|fraction, _, flow| flow * (1.0 + 0.1 * fraction));
    let losing = identified(|_, command, flow| flow * (1.0 - (0.3 / command.abs().max(0.3))));
    for (found, what) in [(&limited, "limited"), (&drifting, "drift"), (&losing, "loss")] {
        let misfits = found.misfits();
        let first = misfits.first().unwrap_or_else(|| panic!("{what}: {:?}", found.signals));
        assert_eq!(first.kind, SignalKind::PortFlowMagnitude, "{what}");
        assert!(found.recordings[first.recording].file.starts_with("metering"), "{what}");
        assert!(
            first.correlation > 0.9 && first.fraction > 5e-3 && first.fraction < 0.3,
            "{what}: {first:?}"
        );
    }
    // the loss is greatest where the flow is
    let misfits = limited.misfits();
    let place = misfits[0].place.unwrap();
    let inputs = &limited.recordings[misfits[0].recording].inputs;
    let greatest = inputs.iter().map(|input| input.command.abs()).fold(0.0, f64::max);
    let farthest = place.command.iter().fold(0.0, |most: f64, end| most.max(end.abs()));
    assert!((farthest / greatest - 1.0).abs() < 1e-9, "{place:?} of {greatest} V");
    assert!(place.fraction > 0.0, "the model shows more there: {place:?}");
}

/// A small misfit is reported next to a verdict that is met; with a large one no verdict is met.
#[test]
fn no_verdict_on_a_valve_of_a_large_misfit_is_met() {
    let anything =
        "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1], band = [1, 2] }]";
    let verify = |misfit: &str| {
        let loaded =
            run_command::load(run_command::HOSE, &[anything, &format!("valve.misfit={misfit}")], &[]);
        let request = Request::Verify { proof: false, on_machine: false };
        let answer = command::answer(&Memory::default(), &loaded, &[], &request).unwrap();
        (parsed(&answer.json), answer.text)
    };
    let [small, large] =
        ["{ share = 0.004 }", "{ share = \"1.2 %\", at = \"flow of metering.csv\" }"].map(verify);
    assert_eq!(small.0["verdict"], "met", "{}", small.1);
    assert!(small.1.contains("leave 0.400 % of the range"), "{}", small.1);
    assert_eq!(large.0["verdict"], "not_proven", "{}", large.1);
    assert!(large.1.contains("(valve.misfit, flow of metering.csv)"), "{}", large.1);
}

/// The verdict and the text of a check that any controller satisfies, with these settings.
fn judged(settings: &[&str]) -> (Value, String) {
    let anything =
        "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1], band = [1, 2] }]";
    let loaded = run_command::load(run_command::HOSE, &[&[anything], settings].concat(), &[]);
    let request = Request::Verify { proof: false, on_machine: false };
    let answer = command::answer(&Memory::default(), &loaded, &[], &request).unwrap();
    (parsed(&answer.json)["verdict"].clone(), answer.text)
}

/// The moduli of the lines are in every plant; of a friction the plant contains `viscous`, unless
/// the project states its viscous friction, as the example does by an interval.
#[test]
fn misfits_of_line_and_friction_reach_the_verdicts_that_rest_on_them() {
    let (verdict, text) = judged(&["line.misfit={ share = \"0.2 %\", at = \"volume of rise.csv\" }"]);
    assert_eq!(verdict, "met", "{text}");
    assert_eq!(text.matches("(line.misfit, volume of rise.csv)").count(), 1, "{text}");
    let (verdict, text) = judged(&["line.b={ misfit = { share = \"2 %\" } }"]);
    assert_eq!(verdict, "not_proven", "{text}");
    assert!(text.contains("(line.b.misfit)") && !text.contains("(line.a.misfit)"), "{text}");
    let friction = "cylinder.friction.misfit={ share = \"2 %\", at = \"force of runs.csv\" }";
    let (verdict, text) = judged(&[friction]);
    assert_eq!(verdict, "met", "{text}");
    assert!(text.contains("has its viscous friction from elsewhere"), "{text}");
    let of_friction =
        "uncertainty={ flow_gain = { nominal = 5.4e-5, minimum = 3.23e-5, maximum = 5.61e-5 } }";
    let (verdict, text) = judged(&[friction, of_friction]);
    assert_eq!(verdict, "not_proven", "{text}");
    assert!(text.contains("(cylinder.friction.misfit, force of runs.csv)"), "{text}");
}

/// Runs of the machine, which include all of a friction, warn of its misfit.
#[test]
fn runs_of_the_machine_warn_of_a_misfit() {
    let settings = [
        "cylinder.friction.misfit={ share = \"0.1 %\" }",
        "scenario=[{ name = \"rest\", duration = \"1 ms\" }]",
    ];
    let loaded = run_command::load(run_command::HOSE, &settings, &[]);
    let request = Request::Simulate(SimulateRequest::default());
    let answer = command::answer(&Memory::default(), &loaded, &[], &request).unwrap();
    let json: Value = parsed(&answer.json);
    let warning = json["warnings"][0].as_str().unwrap_or_else(|| panic!("{json}"));
    assert!(warning.contains("cylinder.friction.misfit") && answer.text.contains(warning), "{}", answer.text);
}

/// The greatest misfit of recorded friction is in the fragment, which the project reads.
#[test]
fn a_misfit_of_friction_is_in_its_fragment() {
    let bench = "bench.friction={ velocities = 8, slowest = \"2 mm/s\", fastest = \"200 mm/s\" }";
    let table = String::from_utf8(recorded(&[bench]).read(SLIDING).unwrap()).unwrap();
    let (heading, rows) = table.split_once('\n').unwrap();
    let count = rows.lines().count();
    // each velocity, out and back, with seals that are a tenth harder or softer than at the
    // previous one
    let changed = |(row, line): (usize, &str)| {
        let mut cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let way = if (8 * row / count).is_multiple_of(2) { 0.1 } else { -0.1 };
        cells[2] += way * (cells[2] - cells[3]);
        cells.iter().map(f64::to_string).collect::<Vec<_>>().join(",") + "\n"
    };
    let harder: String = rows.lines().enumerate().map(changed).collect();
    let source = Memory::default().with(SLIDING, format!("{heading}\n{harder}"));
    let answer = friction_of(&source, &[SLIDING]).unwrap();
    let json: Value = parsed(&answer.json);
    let fraction = json["misfits"][0]["fraction"].as_f64().unwrap_or_else(|| panic!("{json}"));
    let fragment = answer.files.iter().find(|file| file.name == "friction.toml").unwrap();
    let text = String::from_utf8(fragment.bytes.clone()).unwrap();
    let misfit =
        text.lines().find_map(|line| line.strip_prefix("misfit = ")).unwrap_or_else(|| panic!("{text}"));
    let loaded = run_command::load(run_command::HOSE, &[&format!("cylinder.friction.misfit={misfit}")], &[]);
    let friction = loaded.project.actuator.as_ref().unwrap().cylinder.friction.clone().unwrap();
    let declared = friction.misfit.unwrap();
    assert!((declared.fraction / fraction - 1.0).abs() < 0.01, "{declared:?} {fraction}");
    assert!(declared.at.is_some_and(|at| at.starts_with("force of sliding.csv, most at")), "{text}");
}
