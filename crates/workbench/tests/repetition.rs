//! Runs whose errors may be visible are repeated; runs that diverge are reported.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_dynamics::portable;
use phea_workbench::answer::Answer;
use phea_workbench::command::{self, Request};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

const CONTINUOUS: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
const SAMPLED: &str = include_str!("../../../examples/benchmark/closed_loop_sampled.toml");

/// The first scenario of an answer.
fn simulated(text: &str, settings: &[&str]) -> (Value, Answer) {
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    let answer = command::answer(&source, &loaded, &[], &Request::Simulate(Default::default())).unwrap();
    let json: Value = parsed(&answer.json);
    (json["scenarios"][0].clone(), answer)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Friction feeds the ringing of the load cell in a slow motion: at the default tolerance the peak
/// is wrong by a tenth.
#[test]
fn a_peak_disturbed_by_errors_is_computed_again() {
    let (run, answer) = simulated(
        CONTINUOUS,
        &["scenario.0.load_motion.duration=1", "scenario.0.load_motion.distance=0.005"],
    );
    let peak = number(&run["events"][1]["metrics"]["disturbance_peak_n"]);
    let repetition = &run["repetition"];
    let spread = number(&repetition["spread"]["part"]);
    // ORIGIN: other tool, CVODE at 1e-11 on a separate model
    let truth = 192.2;
    assert!((peak / truth - 1.0).abs() < spread.max(1e-3) + 1e-3, "{peak} {repetition}");
    assert!((peak / truth - 1.0).abs() < 5e-3, "{peak}");
    let passes = repetition["passes"].as_array().unwrap();
    let tolerances: Vec<f64> = passes.iter().map(|pass| number(&pass["tolerance"])).collect();
    for (place, tolerance) in tolerances.iter().enumerate() {
        let expected = (6e-7 * portable::pow(0.1, place as f64)).max(1e-10);
        assert!((tolerance / expected - 1.0).abs() < 1e-12, "{tolerances:?}");
    }
    assert_eq!(number(&run["tolerance"]), *tolerances.last().unwrap());
    let steps = &passes.last().unwrap()["steps"];
    assert_eq!(&run["work"]["steps"], steps);
    let agreed = repetition["status"] == "agreed";
    assert_eq!(agreed, spread <= 1e-3, "{repetition}");
    assert!(answer.text.contains("of the last two passes"), "{}", answer.text);
}

/// A run without growth of errors is made once.
#[test]
fn a_run_without_growth_is_computed_once() {
    for text in [CONTINUOUS, SAMPLED] {
        let (run, answer) = simulated(text, &["scenario.0.duration=2.5 s"]);
        assert!(run["repetition"].is_null() && run["errors_amplified"].is_null(), "{run}");
        assert!(run["divergence"].is_null() && run["status"] == "completed" && answer.affirmative);
    }
}

/// A sampled loop that is unstable grows from rounding: the logarithm of the growth is that of the
/// force itself, and no solver determines the time at which it is large.
#[test]
fn an_unstable_sampled_loop_is_reported() {
    let (run, answer) = simulated(SAMPLED, &["controller.numerator=0.03*s+0.1", "scenario.0.duration=2.5 s"]);
    assert!(number(&run["errors_amplified"]["growth_logarithm"]) > 7.0, "{run}");
    assert!(run["repetition"]["passes"].as_array().unwrap().len() > 1);
    assert_eq!(run["errors_amplified"]["cause"], "closed_loop");
    assert!(answer.text.contains("the closed loop is unstable"), "{}", answer.text);
    assert!(answer.text.contains("errors within the tolerance may become visible"), "{}", answer.text);
    let rest = [
        "controller.numerator=0.03*s+0.1",
        "scenario=[{ name = \"rest\", duration = 1.0, output_step = 1e-3, reference = [{ at = 0.0, force = 0.0 }] }]",
    ];
    let (run, answer) = simulated(SAMPLED, &rest);
    assert!(number(&run["errors_amplified"]["growth_logarithm"]) > 30.0, "{run}");
    assert_eq!(run["repetition"]["status"], "undetermined", "{run}");
    assert!(answer.text.contains("no solver determines"), "{}", answer.text);
    // numbers that rounding decides are not results
    let (run, answer) = simulated(include_str!("projects/unstable_rest_sampled.toml"), &[]);
    assert_eq!(run["errors_amplified"]["cause"], "closed_loop");
    assert_eq!(run["repetition"]["status"], "undetermined");
    assert_eq!((&run["status"], answer.affirmative), (&"undetermined".into(), false));
}

/// A step of 1 uN excites the unstable loop: the force grows like that of the frozen loop.
#[test]
fn the_growth_of_a_sampled_loop_is_that_of_its_force() {
    for more in [&[][..], &["controller.delay=0.7 ms"], &["controller.delay=2 ms"]] {
        let rest = [
            "controller.numerator=0.02*s+0.1",
            "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
            "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
            "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
            "scenario=[{ name = \"rest\", duration = 0.06, output_step = 2.5e-4, reference = [{ at = 0.01, force = 1e-6 }] }]",
        ];
        let settings = [&rest[..], more].concat();
        let source = Memory::default().with("rig.toml", SAMPLED);
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
        let loaded = project::read(&source, "rig.toml", &settings, &[]).unwrap();
        let answer = command::answer(&source, &loaded, &[], &Request::Simulate(Default::default())).unwrap();
        let json: Value = parsed(&answer.json);
        let grown = &json["scenarios"][0]["errors_amplified"];
        let [from, until, logarithm] =
            ["from_s", "until_s", "growth_logarithm"].map(|key| number(&grown[key]));
        let text = String::from_utf8(answer.files[0].bytes.clone()).unwrap();
        let rows = text.lines().skip(1).map(|line| {
            let mut cells = line.split(',').map(|cell| cell.parse::<f64>().unwrap());
            [cells.next().unwrap(), cells.nth(1).unwrap()]
        });
        let rows: Vec<[f64; 2]> = rows.collect();
        // the envelope, where the force is far above rounding and far below friction and limits
        let peaks: Vec<[f64; 2]> = rows
            .windows(3)
            .filter(|three| three[1][1].abs() > three[0][1].abs() && three[1][1].abs() >= three[2][1].abs())
            .map(|three| [three[1][0], three[1][1].abs()])
            .filter(|[_, force]| (1e-5..1.0).contains(force))
            .collect();
        let (first, last) = (peaks[0], peaks[peaks.len() - 1]);
        let measured = portable::ln(last[1] / first[1]) / (last[0] - first[0]);
        let rate = logarithm / (until - from);
        assert!((rate / measured - 1.0).abs() < 0.1, "{more:?}: {rate} {measured} {grown}");
    }
}

/// Loops that leave the valve's range for good, swing from end to end, or push without end.
#[test]
fn a_diverging_run_is_reported() {
    let (run, answer) = simulated(CONTINUOUS, &["controller.numerator=-0.001*s - 0.008"]);
    assert_eq!((&run["status"], answer.affirmative), (&"diverged".into(), false), "{run}");
    assert_eq!(run["divergence"]["kind"], "command_beyond_range");
    assert!(
        run["end_time_s"].is_null() && answer.text.contains("the loop does not come back"),
        "{}",
        answer.text
    );
    let unstable = ["controller.numerator=0.03*s+0.1", "scenario.0.duration=2.5 s"];
    let (run, answer) = simulated(SAMPLED, &unstable);
    assert_eq!((&run["status"], answer.affirmative), (&"diverged".into(), false), "{run}");
    assert_eq!(run["divergence"]["kind"], "command_swings");
}

/// A command that is at its limit on the way to the reference and then leaves it is no divergence,
/// and neither is a load that shakes a small reference.
#[test]
fn transient_saturation_is_not_reported_as_divergence() {
    let (run, answer) = simulated(CONTINUOUS, &["controller.saturation=0.2 V"]);
    let limited = |kind: &Value| kind["kind"] == "command_limit" && kind["begins"] == true;
    assert!(run["occurrences"].as_array().unwrap().iter().any(limited), "{run}");
    assert!(run["divergence"].is_null() && answer.affirmative, "{run}");
    let shaken = [
        "scenario.0.reference.0.force=10 N",
        "scenario.0.load_motion={ kind = \"sine\", start = 2.5, amplitude = \"1 mm\", frequency = \"5 Hz\" }",
    ];
    let (run, _) = simulated(CONTINUOUS, &shaken);
    assert!(number(&run["events"][1]["metrics"]["disturbance_peak_n"]) > 100.0, "{run}");
    assert!(run["divergence"].is_null(), "{run}");
}
