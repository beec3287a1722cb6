//! Scenarios of whole projects on the nonlinear machine.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, Loaded, Project};
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{Cause, ScenarioRun, SimulateError, simulate_project};
use phea_workbench::source::{HeldFiles, Memory};
use serde_json::Value;
use std::fmt::Write as _;

/// Time in s and force in N.
// ORIGIN: other tool, CVODE BDF at 1e-12 on the same equations in C
const REFERENCE: [(f64, f64); 13] = [
    (0.01, 5.6607),
    (0.1, 10.8236),
    (1.0, 0.0342),
    (2.05, 1097.4226),
    (2.1, 2556.3422),
    (2.3, 3974.1914),
    (3.02, 3558.6266),
    (3.04, 2410.8010),
    (3.06, 2017.6796),
    (3.1, 4129.3740),
    (3.15, 4669.4950),
    (3.5, 4024.5844),
    (5.0, 4000.0003),
];
// ORIGIN: other tool, CVODE BDF at 1e-12, restarted at each sample
const REFERENCE_SAMPLED: [(f64, f64); 13] = [
    (0.01, 5.7510),
    (0.1, 10.8048),
    (1.0, 0.0342),
    (2.05, 1097.0817),
    (2.1, 2559.0154),
    (2.3, 3973.9799),
    (3.02, 3548.8161),
    (3.04, 2384.0655),
    (3.06, 2004.6445),
    (3.1, 4156.2337),
    (3.15, 4671.8227),
    (3.5, 4024.4565),
    (5.0, 4000.0003),
];

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");

fn load(text: &str, settings: &[&str]) -> Loaded {
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    let source = Memory::default().with("rig.toml", text);
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn run_of(text: &str, settings: &[&str]) -> ScenarioRun {
    let mut project = load(text, settings).project;
    project.scenarios.truncate(1);
    simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap().remove(0)
}

/// The value of a signal at a time of the record.
fn at(run: &ScenarioRun, signal: Signal, time_s: f64) -> f64 {
    let row = run.record.times_s.iter().position(|time| *time >= time_s - 1e-9).unwrap();
    run.record.signal(signal)[row]
}

#[test]
fn the_benchmark_gives_the_force_of_its_reference_solution() {
    let run = run_of(BENCHMARK, &["simulation.tolerance=1e-8"]);
    // ORIGIN: other tool, CVODE BDF at 1e-12 on equal equations in C
    for (time_s, force_n) in REFERENCE {
        let found = at(&run, Signal::Force, time_s);
        assert!((found - force_n).abs() < 0.02, "{time_s} s: {found} N, not {force_n}");
    }
    assert_eq!(run.stopped(), None);
    assert_eq!(run.occurrences, []);
}

#[test]
fn sampled_with_a_continuous_prefilter_it_gives_that_of_the_sampled_loop() {
    let settings = ["simulation.tolerance=1e-8", "controller.sample_time=1 ms", "prefilter.continuous=true"];
    let run = run_of(BENCHMARK, &settings);
    // ORIGIN: other tool, CVODE BDF at 1e-12, restarted at each sample
    for (time_s, force_n) in REFERENCE_SAMPLED {
        let found = at(&run, Signal::Force, time_s);
        assert!((found - force_n).abs() < 0.02, "{time_s} s: {found} N, not {force_n}");
    }
}

/// Metrics do not depend on the rows: they agree to the last bit for a hundred thousand rows and
/// for ten.
#[test]
fn metrics_do_not_depend_on_the_rows() {
    for more in
        [&[] as &[&str], &["controller.sample_time=1 ms"], &["controller.load_velocity_feed_forward={}"]]
    {
        let of = |step: &str| {
            let setting = format!("scenario.0.output_step={step}");
            run_of(BENCHMARK, &[&[setting.as_str()], more].concat()).windows
        };
        let expected = of("1 ms");
        for step in ["0.05 ms", "50 ms", "0.5 s"] {
            assert_eq!(of(step), expected, "{step} {more:?}");
        }
    }
}

/// A scenario of a day has the peaks of one of five seconds.
#[test]
fn metrics_do_not_depend_on_the_duration() {
    let of = |duration: &str| {
        let (duration, rows) = (format!("scenario.0.duration={duration}"), "scenario.0.output_step=1 s");
        run_of(BENCHMARK, &[&duration, rows]).windows
    };
    for ((_, short), (_, long)) in of("5 s").iter().zip(&of("1e5 s")) {
        let pairs = [
            (short.overshoot_percent, long.overshoot_percent),
            (short.disturbance_peak_n, long.disturbance_peak_n),
            (short.control_peak_v, long.control_peak_v),
            (short.settling_time_s, long.settling_time_s),
            (short.rise_time_s, long.rise_time_s),
        ];
        for (short, long) in pairs {
            match (short, long) {
                (Ok(short), Ok(long)) => {
                    assert!((short - long).abs() <= 1e-6 * short.abs(), "{short} {long}")
                }
                (short, long) => assert_eq!(short, long),
            }
        }
    }
}

/// A step at seventeen samples of 0.7 ms, a number that is not the decimal fraction, acts there
/// like one at sixteen.
#[test]
fn a_step_at_a_sample_is_not_a_sample_late() {
    let of = |samples: u32| {
        let step_s = f64::from(7 * samples) / 1e4;
        let settings = [
            "controller.sample_time=0.7 ms".to_string(),
            format!("scenario.0.reference=[{{ at = {step_s}, force = \"4 kN\" }}]"),
            "scenario.0.load_motion.start=1".to_string(),
            "scenario.0.duration=0.5".to_string(),
            "simulation.tolerance=1e-9".to_string(),
        ];
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        // from rest: only the step moves
        let run = run_of(&BENCHMARK.replace("start = {", "# {"), &settings);
        let (_, metrics) = run.windows[0];
        [metrics.overshoot_percent, metrics.rise_time_s, metrics.control_peak_v].map(|value| value.unwrap())
    };
    let [one, other] = [16, 17].map(of);
    for (one, other) in one.iter().zip(&other) {
        assert!((one - other).abs() < 1e-6 * one.abs(), "{one} {other}");
    }
}

/// A machine at rest stays at rest, sampled or not, with all its imperfections.
#[test]
fn an_equilibrium_is_maintained() {
    let everything = include_str!("../../project/tests/valid/simulation.toml");
    let still = "[[scenario]]\nname = \"still\"\nduration = \"0.2 s\"\n";
    let of = |text: &str| {
        let start = text.find("[[scenario]]").unwrap();
        format!("{}{still}", &text[..start])
    };
    let noiseless = "force_sensor.noise=0 N";
    let cases = [(of(BENCHMARK), vec![]), (of(everything), vec![noiseless])];
    for (text, settings) in cases {
        let run = run_of(&text, &settings);
        let force = run.record.signal(Signal::Force);
        let most = force.iter().map(|force| force.abs()).fold(0.0, f64::max);
        assert!(most < 1.0, "{most} N");
        assert_eq!(run.windows, []);
    }
}

#[test]
fn the_feed_forward_reduces_the_effect_of_the_load_on_the_force() {
    let peak = |settings: &[&str]| {
        let run = run_of(BENCHMARK, settings);
        let (window, metrics) = run.windows[1];
        assert_eq!(window.cause, Cause::LoadMotion);
        metrics.disturbance_peak_n.unwrap()
    };
    let (without, derived) = (peak(&[]), peak(&["controller.load_velocity_feed_forward={}"]));
    assert!(derived < 0.5 * without, "{derived} {without}");
    assert_eq!(peak(&["controller.load_velocity_feed_forward.gain=0"]), without);
}

#[test]
fn noise_depends_on_its_seed_only() {
    let noisy = |seed: &str, noise: &str| {
        let settings = ["controller.sample_time=1 ms", "scenario.0.duration=0.3 s", seed, noise];
        run_of(BENCHMARK, &settings).record.signal(Signal::Force)
    };
    let quiet = noisy("simulation.seed=1", "force_sensor.noise=0 N");
    let one = noisy("simulation.seed=1", "force_sensor.noise=5 N");
    assert_eq!(one, noisy("simulation.seed=1", "force_sensor.noise=5 N"));
    assert_ne!(one, noisy("simulation.seed=2", "force_sensor.noise=5 N"));
    assert_ne!(one, quiet);
}

#[test]
fn converters_round_the_command() {
    let quantized = [
        "controller.sample_time=1 ms",
        "controller.quantization={ command_bits = 8, command_range = [-10, 10] }",
    ];
    let run = run_of(BENCHMARK, &quantized);
    let step = 20.0 / 256.0;
    for command in &run.record.signal(Signal::Control) {
        assert_eq!((command / step).round() * step, *command);
    }
    assert!(run.record.signal(Signal::Control).iter().any(|command| *command != 0.0));
}

#[test]
fn a_limit_that_is_reached_is_reported_with_its_time() {
    for extra in [vec![], vec!["controller.sample_time=1 ms"]] {
        let mut settings = vec!["controller.saturation=0.3 V", "controller.anti_windup=clamping"];
        settings.extend(extra);
        let run = run_of(BENCHMARK, &settings);
        let first = run.occurrences.first().unwrap();
        assert!(first.kind == "command_limit" && first.begins && first.time_s >= 2.0, "{first:?}");
        assert!(run.record.signal(Signal::Control).iter().all(|command| command.abs() <= 0.3));
    }
}

/// A load pulled away by 100 mm in 10 ms empties a chamber: reported, not clamped.
#[test]
fn cavitation_is_reported() {
    let run = run_of(
        BENCHMARK,
        &["scenario.0.load_motion.duration=10 ms", "scenario.0.load_motion.distance=100 mm"],
    );
    let kinds: Vec<&str> = run.occurrences.iter().map(|occurrence| occurrence.kind).collect();
    assert!(kinds.iter().any(|kind| kind.starts_with("cavitation")), "{kinds:?}");
}

fn with_motion(content: &str) -> (Memory, Project) {
    let settings = [
        "scenario.0.load_motion={ kind = \"file\", file = \"motion.csv\", start = 3 }",
        "scenario.0.duration=3.5 s",
    ];
    (Memory::default().with("motion.csv", content), load(BENCHMARK, &settings).project)
}

/// The quintic step of the benchmark as a table of 101 points moves the load in an equal way.
#[test]
fn a_measured_motion_is_reproduced() {
    let mut text = "# a quintic step\ntime_ms, position_mm\n".to_string();
    for row in 0..=100 {
        let u = f64::from(row) / 100.0;
        writeln!(text, "{row}, {:e}", 7.0 + 5.0 * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)).unwrap();
    }
    let (source, project) = with_motion(&text);
    let run = simulate_project(&source, &Setup::new(&project).unwrap(), &mut |_| true).unwrap().remove(0);
    let same = run_of(BENCHMARK, &["scenario.0.duration=3.5 s"]);
    for time_s in [2.9, 3.03, 3.06, 3.11, 3.3] {
        let (found, expected) = (at(&run, Signal::Force, time_s), at(&same, Signal::Force, time_s));
        assert!((found - expected).abs() < 3.0, "{time_s}: {found} {expected}");
    }
}

#[test]
fn a_motion_file_is_refused_with_its_place() {
    let cases = [
        ("time_s, position_m\n0, 0\n0, 1\n", "3:1", "the time of the row before, with other values"),
        (
            "time_s, position_m\n0, 0\n1, 1\n9, 1\n3, 1\n4, 1\n",
            "4:1",
            "a time that is not before that of the next row",
        ),
        ("time_s, position_m\n0, 0\n1, 1;2\n", "3:4", "`1;2` is not a number"),
        ("time_s, positon_mm\n0, 0\n1, 1\n", "1:9", "unknown column `positon_mm`"),
        ("time_s\n0\n1\n", "1:1", "there is no column `position`"),
        ("time_s, position_m\n0, 0\n", "1:1", "a motion needs two rows at least"),
    ];
    for (content, place, message) in cases {
        let (source, project) = with_motion(content);
        let error = simulate_project(&source, &Setup::new(&project).unwrap(), &mut |_| true).unwrap_err();
        let SimulateError::Motion(report) = error else { panic!("{error}") };
        let found: Vec<String> =
            report.diagnostics.iter().map(|d| format!("{}:{} {}", d.line, d.column, d.message)).collect();
        assert!(found.contains(&format!("{place} {message}")), "{found:?}");
    }
}

fn answer(text: &str, settings: &[&str], request: &Request) -> command::CommandError {
    let loaded = load(text, settings);
    command::answer(&Memory::default(), &loaded, &[], request).unwrap_err()
}

#[test]
fn impossible_simulations_are_refused_in_words() {
    let refused_with = |settings: &[&str], words: &str| {
        let error = answer(BENCHMARK, settings, &Request::Simulate(Default::default())).to_string();
        assert!(error.contains(words), "{error}");
    };
    refused_with(&["cylinder.friction.model=stribeck"], "regular velocity");
    let wall = ["load={ model = \"wall\", mass = 10, stiffness = 1e6 }", "scenario.0.start.force=-5 N"];
    refused_with(&["load={ model = \"wall\", stiffness = 1e6 }"], "`mass`");
    refused_with(&wall, "a start with force of -5 is impossible");
    let thick = answer(
        HOSE,
        &["line.model=transmission_line", "fluid.kinematic_viscosity=1 m2/s"],
        &Request::Simulate(Default::default()),
    );
    assert!(thick.to_string().contains("[line] model: the dissipation number"), "{thick}");
}

#[test]
fn the_answer_has_the_stable_keys() {
    let loaded = load(BENCHMARK, &["scenario.0.duration=2.6 s"]);
    let answer =
        command::answer(&Memory::default(), &loaded, &[], &Request::Simulate(Default::default())).unwrap();
    assert!(answer.affirmative);
    let json: Value = parsed(&answer.json);
    let scenario = &json["scenarios"][0];
    assert_eq!(
        (&scenario["name"], &scenario["status"]),
        (&"step and load motion".into(), &"completed".into())
    );
    assert!(scenario["work"]["steps"].as_u64() > Some(20) && scenario["work"]["evaluations"].is_u64());
    let metrics = &scenario["events"][0]["metrics"];
    for key in ["overshoot_percent", "settling_time_s", "steady_state_error_n", "control_peak_v"] {
        assert!(metrics[key].is_f64(), "{key}: {metrics}");
    }
    assert!(metrics["disturbance_peak_n"].is_null() && metrics["disturbance_peak_n_reason"].is_string());
    assert_eq!(metrics["settling_band_percent"], 1.0);
    let table = String::from_utf8(answer.files[0].bytes.clone()).unwrap();
    assert_eq!(answer.files[0].name, "step and load motion.csv");
    let head = "time_s,reference_n,force_n,control_v,spool_v,pressure_a_pa,pressure_b_pa,position_m,";
    assert!(table.starts_with(head));
    assert!(
        table.lines().next().unwrap().contains(
            ",port_pressure_b_pa,hydraulic_force_n,filtered_reference_n,opening_v,command_v,unlimited_control_v,integral_v,measurement_n"
        )
    );
    assert_eq!(table.lines().count(), 2602);
    assert!(table.lines().nth(1).unwrap().starts_with("0,0,0,0,0,3500000,3500000,0.25,"));
}

/// The rows of a stopped run are printed and the answer is no.
#[test]
fn a_stopped_run_returns_its_rows_so_far() {
    let loaded = load(BENCHMARK, &[]);
    let held = HeldFiles::default();
    let answer = command::answer_into(
        &Memory::default(),
        &loaded,
        &[],
        &Request::Simulate(Default::default()),
        Some(&held),
        &mut |progress| progress.fraction < 0.5,
    );
    let answer = answer.unwrap();
    assert!(!answer.affirmative);
    let json: Value = parsed(&answer.json);
    let scenario = &json["scenarios"][0];
    assert_eq!(scenario["status"], "cancelled");
    let end_s = scenario["end_time_s"].as_f64().unwrap();
    assert!((2.5..5.0).contains(&end_s), "{end_s}");
    assert_eq!(scenario["events"][1]["metrics"]["settling_time_s_reason"], "the run ended before");
    assert!(!held.into_files()[0].bytes.is_empty());
}

/// Scenarios of hours are not stored for drawing at every quarter of a millisecond, and this is
/// reported.
#[test]
fn a_long_scenario_reports_its_sample_interval() {
    for (duration, interval_s, long) in [("5 s", 0.25e-3, false), ("2000 s", 5e-3, true)] {
        let (duration, rows) = (format!("scenario.0.duration={duration}"), "scenario.0.output_step=5 s");
        let loaded = load(BENCHMARK, &[&duration, rows]);
        let answer =
            command::answer(&Memory::default(), &loaded, &[], &Request::Simulate(Default::default()))
                .unwrap();
        let json: Value = parsed(&answer.json);
        let found = json["scenarios"][0]["sample_interval_s"].as_f64().unwrap();
        assert!((found / interval_s - 1.0).abs() < 1e-9, "{found}");
        assert_eq!(answer.text.contains("is drawn from samples every 5.00 ms only"), long, "{}", answer.text);
    }
}

#[test]
fn projects_are_compared_side_by_side() {
    let [one, other] = [("1.9e-4", "10 kN", 1), ("3.03e-5", "3 kN", 2)].map(|(volume, capacity, band)| {
        let band = format!("scenario.0.settling_band_percent={band}");
        let settings = [format!("line.volume={volume}"), format!("force_sensor.capacity={capacity}"), band];
        load(BENCHMARK, &[&settings[0], &settings[1], &settings[2], "scenario.0.duration=3.4 s"])
    });
    let answer = command::compare_watched(&Memory::default(), &[one, other], true, &mut |_| true).unwrap();
    let json: Value = parsed(&answer.json);
    let peak = |project: usize| {
        let events = &json["projects"][project]["scenarios"][0]["events"];
        events[1]["metrics"]["disturbance_peak_n"].as_f64().unwrap()
    };
    assert!(peak(0) < peak(1), "the softer line feels less: {} {}", peak(0), peak(1));
    assert_eq!(json["command"], "compare");
    let names: Vec<&str> = answer.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names.len(), 3, "{names:?}");
    assert!(names.contains(&"compare-1.svg") && names.contains(&"compare-1-event-2.svg"), "{names:?}");
    assert!(answer.text.contains("disturbance peak"), "{}", answer.text);
    assert!(answer.text.contains("settling (1 %, 2 %)"), "{}", answer.text);
    let overloads: Vec<&str> = answer.text.lines().filter(|line| line.contains("is overloaded")).collect();
    assert!(overloads.len() == 1 && overloads[0].starts_with("   B: from 2."), "{}", answer.text);
    assert!(overloads[0].contains("its capacity is 3 kN"), "{}", answer.text);
}

/// Peaks of the force deviation for a load that moves by 5 mm as a first-order lag, for hose and
/// pipe, each with its own controller.
#[test]
fn the_hose_transmits_less_force_than_the_pipe() {
    let hose = ["line.volume=1.9e-4", "line.effective_bulk_modulus=2.609e8"];
    let pipe = [
        "line.volume=3.03e-5",
        "line.effective_bulk_modulus=1.45e9",
        "controller.numerator=0.0005*s + 0.002",
        "prefilter.numerator=484",
        "prefilter.denominator=s^2 + 44*s + 484",
    ];
    // ORIGIN: other tool, independent runs of equal equations, which differ by up to 3 %
    let cases = [("20 ms", 5810.0, 8900.0), ("50 ms", 2800.0, 4500.0), ("100 ms", 1600.0, 2550.0)];
    for (time_constant, with_hose, with_pipe) in cases {
        let motion = format!(
            "scenario.0.load_motion={{ kind = \"first_order\", start = 3, distance = 5e-3, time_constant = \"{time_constant}\" }}"
        );
        let peak = |line: &[&str]| {
            let mut settings = line.to_vec();
            settings.push(&motion);
            run_of(BENCHMARK, &settings).windows[1].1.disturbance_peak_n.unwrap()
        };
        for (found, expected) in [(peak(&hose), with_hose), (peak(&pipe), with_pipe)] {
            assert!((found / expected - 1.0).abs() < 0.05, "{time_constant}: {found} N, not {expected}");
        }
    }
}

/// A delayed measurement and a delayed command are one delay in the loop: the load feels no
/// difference.
#[test]
fn a_late_sensor_is_a_late_command() {
    let motion_of = |settings: &[&str]| {
        let run = run_of(BENCHMARK, settings);
        let (force, row) =
            (run.record.signal(Signal::Force), run.record.times_s.iter().position(|time| *time >= 3.0));
        force[row.unwrap()..].to_vec()
    };
    let sensor = motion_of(&["sensor={ numerator = \"1\", denominator = \"1\", delay = \"0.5 ms\" }"]);
    let command = motion_of(&["controller.delay=0.5 ms"]);
    let none = motion_of(&[]);
    let largest = |one: &[f64], other: &[f64]| {
        one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
    };
    assert!(largest(&sensor, &command) < 0.1, "{}", largest(&sensor, &command));
    assert!(largest(&sensor, &none) > 5.0);
    // a filter of 1/20000 s delays by its time constant, as far as the loop is concerned
    let fast = motion_of(&["sensor={ numerator = \"20000\", denominator = \"s + 20000\" }"]);
    let late = motion_of(&["controller.delay=50 us"]);
    assert!(largest(&fast, &late) < 0.1 * largest(&fast, &none), "{}", largest(&fast, &late));
}

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");

/// Waves in the hose are faster than a loop of half the published gain: it is little more affected
/// by them than by a lumped line. (The loop with the published gain rings for seconds, because its
/// margin is exhausted.)
#[test]
fn waves_in_the_lines_change_little_for_the_loop() {
    let metrics_of = |model: &str| {
        let model = format!("line.model={model}");
        let gain = "controller.numerator=0.0005*s + 0.004";
        let run = run_of(HOSE, &["line.compliance=by_volume", "scenario.0.duration=3.5 s", &model, gain]);
        assert_eq!(run.stopped(), None, "{model}");
        let [(_, step), (_, motion)] = run.windows[..] else { panic!() };
        [step.settling_time_s.unwrap(), motion.disturbance_peak_n.unwrap()]
    };
    let (lumped, with_waves) = (metrics_of("lumped"), metrics_of("transmission_line"));
    for (found, lumped) in with_waves.iter().zip(lumped) {
        assert!((found / lumped - 1.0).abs() < 0.01 && *found != lumped, "{found}, lumped {lumped}");
    }
}

#[test]
fn lines_with_waves_rest_too() {
    let still = "[[scenario]]\nname = \"still\"\nduration = \"0.2 s\"\n";
    let start = HOSE.find("[[scenario]]").unwrap();
    let text = format!("{}{still}", &HOSE[..start]);
    for settings in
        [vec!["line.model=two_wave"], vec!["line.model=transmission_line", "controller.delay=1 ms"]]
    {
        let force = run_of(&text, &settings).record.signal(Signal::Force);
        let most = force.iter().map(|force| force.abs()).fold(0.0, f64::max);
        assert!(most < 1.0, "{settings:?}: {most} N");
    }
}
