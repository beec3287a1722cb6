//! A second run at a tenth of the tolerance as an estimate of the error.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use phea_workbench::command::{self, Request, SimulateRequest};
use phea_workbench::project::{self, Loaded};
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{Metric, RunStatus, ScenarioRun, simulate_checked, simulate_project};
use phea_workbench::source::Memory;
use serde_json::Value;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");
const SHORT: &str = "scenario.0.duration=3.2 s";
/// The piston follows where its friction falls, and feeds a ringing that any error changes.
const SLOW: [&str; 2] = ["scenario.0.load_motion.duration=1.5 s", "scenario.0.load_motion.distance=10 mm"];

fn load(settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let source = Memory::default().with("rig.toml", BENCHMARK);
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn run(settings: &[&str]) -> ScenarioRun {
    simulate_project(&Memory::default(), &Setup::new(&load(settings).project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0)
}

fn checked(settings: &[&str]) -> ScenarioRun {
    let project = load(settings).project;
    simulate_checked(&Memory::default(), &Setup::new(&project).unwrap(), None, &mut |_| true)
        .unwrap()
        .remove(0)
}

fn with_check() -> Request {
    Request::Simulate(SimulateRequest { check: true, ..SimulateRequest::default() })
}

fn apart(one: &ScenarioRun, other: &ScenarioRun) -> f64 {
    let (one, other) = (one.record.signal(Signal::Force), other.record.signal(Signal::Force));
    assert_eq!(one.len(), other.len());
    one.iter().zip(&other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

/// The printed run is the one without a check, and the printed difference is that to a run at a
/// tenth of the tolerance.
#[test]
fn a_check_is_the_difference_of_two_runs() {
    let run_checked = checked(&[SHORT, "simulation.tolerance=1e-5"]);
    let [plain, tenth] = [1e-5, 0.1 * 1e-5].map(|tolerance: f64| {
        let tolerance = format!("simulation.tolerance={tolerance:e}");
        run(&[SHORT, tolerance.as_str()])
    });
    assert_eq!(run_checked.record, plain.record);
    assert_eq!(plain.check, None);
    let check = run_checked.check.unwrap();
    assert!((check.tolerance - 1e-6).abs() < 1e-18 && check.stopped.is_none());
    let force = check.force.unwrap();
    assert!(force.difference > 0.0 && force.difference == apart(&plain, &tenth));
    let peak = |run: &ScenarioRun| {
        run.record.signal(Signal::Force).iter().fold(0.0_f64, |most, f| most.max(f.abs()))
    };
    assert_eq!(force.peak, peak(&plain).max(peak(&tenth)));
    let disturbances = [&plain, &tenth].map(|run| run.windows[1].1.disturbance_peak_n.unwrap());
    let differences = check.metrics[1].differences;
    assert_eq!(differences[Metric::DisturbancePeak], Ok((disturbances[0] - disturbances[1]).abs()));
    assert_eq!(differences[Metric::Overshoot], run_checked.windows[1].1.overshoot_percent);
}

/// Twice the estimate covers the error relative to a run that is exact for this purpose.
#[test]
fn the_estimate_covers_the_error() {
    let exact = run(&[SHORT, "simulation.tolerance=1e-10"]);
    for tolerance in ["1e-4", "1e-5", "1e-6", "1e-7"] {
        let estimate = checked(&[SHORT, &format!("simulation.tolerance={tolerance}")]);
        let (error, force) = (apart(&estimate, &exact), estimate.check.unwrap().force.unwrap());
        assert!(error < 2.0 * force.difference, "{tolerance}: {error} N, estimated {}", force.difference);
        assert!(error > 0.2 * force.difference, "{tolerance}: {error} N, estimated {}", force.difference);
    }
}

#[test]
fn an_answer_contains_the_check_if_requested() {
    let run = |settings: &[&str], request: &Request| {
        let answer = command::answer(&Memory::default(), &load(settings), &[], request).unwrap();
        assert!(answer.affirmative);
        let json: Value = parsed(&answer.json);
        (json["scenarios"][0].clone(), answer.text)
    };
    let doubt = "more than a thousandth";
    let (plain, text) = run(&[SHORT], &Request::Simulate(Default::default()));
    assert!(plain["check"].is_null() && plain["check_reason"].is_string() && !text.contains("checked at"));
    let (sure, text) = run(&[SHORT], &with_check());
    let check = &sure["check"];
    assert!(check["part_of_peak"].as_f64().unwrap() < 1e-3 && !text.contains(doubt), "{check} {text}");
    assert!(text.contains("checked at the tolerance 1.00e-7: the force differs by"), "{text}");
    let of_step = &check["events"][0];
    assert_eq!((&check["status"], &of_step["kind"]), (&"completed".into(), &"reference_step".into()));
    let metrics = of_step["metrics"].as_array().unwrap();
    let metric = |name: &str| metrics.iter().find(|metric| metric["name"] == name).unwrap();
    assert!(metric("overshoot_percent")["difference"].is_f64());
    let absent = metric("disturbance_peak_n");
    assert!(absent["difference"].is_null() && absent["difference_reason"].is_string());
    let signals = check["signals"].as_array().unwrap();
    let named = |name: &str| signals.iter().find(|signal| signal["name"] == name).unwrap();
    assert_eq!(named("force_n")["difference"], check["force_difference_n"]);
    assert!(named("control_v")["part_of_peak"].is_f64());
    // repeated until its metrics agree, the run passes the check too
    let (right, text) = run(&SLOW, &with_check());
    assert!(right["check"]["part_of_peak"].as_f64().unwrap() < 1e-3 && !text.contains(doubt), "{text}");
    // too few steps for a second pass
    let passes: Vec<u64> = right["repetition"]["passes"].as_array().unwrap()[..2]
        .iter()
        .map(|pass| pass["steps"].as_u64().unwrap() + pass["rejected"].as_u64().unwrap())
        .collect();
    let few = format!("simulation.maximum_steps={}", (passes[0] + passes[1]) / 2);
    let (unsure, text) = run(&[&SLOW[..], &[few.as_str()]].concat(), &with_check());
    assert_eq!(unsure["repetition"]["status"], "stopped");
    assert!(unsure["check"]["part_of_peak"].as_f64().unwrap() > 1e-3 && text.contains(doubt), "{text}");
    assert!(text.contains("could not be confirmed"), "{text}");
}

/// A run without a check also reports where errors may have grown until they are visible: within
/// the motion in which the piston follows, at a frequency of the piston on the load cell, and not
/// where nothing grows.
#[test]
fn a_run_reports_where_errors_may_be_visible() {
    let run = |settings: &[&str]| {
        let answer =
            command::answer(&Memory::default(), &load(settings), &[], &Request::Simulate(Default::default()))
                .unwrap();
        let json: Value = parsed(&answer.json);
        (json["scenarios"][0].clone(), answer.text)
    };
    let words = "errors within the tolerance may become visible";
    let (calm, text) = run(&[SHORT]);
    assert!(calm["errors_amplified"].is_null() && calm["errors_amplified_reason"].is_string());
    assert!(!text.contains(words), "{text}");
    let (ringing, text) = run(&SLOW);
    assert!(text.contains(words), "{text}");
    let [from, until, frequency] = ["from_s", "until_s", "frequency_rad_per_s"]
        .map(|key| ringing["errors_amplified"][key].as_f64().unwrap());
    let begins = ringing["events"][1]["time_s"].as_f64().unwrap();
    assert!(begins <= from && from < until && until <= begins + 3.0, "{from} to {until} s after {begins} s");
    let project = load(&SLOW).project;
    let rig = Setup::rig_of(&project).unwrap().linear;
    let on_the_cell = (rig.sensor_stiffness / rig.moving_mass).sqrt();
    assert!((frequency / on_the_cell - 1.0).abs() < 0.3, "{frequency} rad/s, {on_the_cell} without oil");
}

/// A run that is stopped during its check is returned, with the time that the check reached.
#[test]
fn a_stopped_check_compares_the_rows_so_far() {
    let project = load(&[SHORT]).project;
    let mut watch = |progress: command::Progress| progress.fraction < 0.75;
    let stopped = simulate_checked(&Memory::default(), &Setup::new(&project).unwrap(), None, &mut watch)
        .unwrap()
        .remove(0);
    assert!(stopped.stopped().is_none());
    let check = stopped.check.unwrap();
    assert_eq!(check.stopped.unwrap().status, RunStatus::Cancelled);
    assert!(check.force.unwrap().time_s <= check.stopped.unwrap().time_s);
    let project = load(&[SHORT]).project;
    let mut watch = |progress: command::Progress| progress.fraction < 0.25;
    let first = simulate_checked(&Memory::default(), &Setup::new(&project).unwrap(), None, &mut watch)
        .unwrap()
        .remove(0);
    assert!(first.was_cancelled() && first.check.is_none());
}
