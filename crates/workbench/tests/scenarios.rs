//! Inputs of a scenario: kinds of reference, open-loop commands, external forces.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_hydraulics::signal::Signal;
use std::f64::consts::TAU;
use std::fmt::Write as _;

use phea_dynamics::portable;
use phea_workbench::campaign::Plan;
use phea_workbench::command::{self, Request};
use phea_workbench::project::{self, Loaded};
use phea_workbench::setup::Setup;
use phea_workbench::simulate::{Cause, NotSaved, ScenarioRun, Unmeasured, simulate_project};
use phea_workbench::source::Memory;
use serde_json::Value;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");

/// The benchmark with this scenario instead of its own.
fn rig(scenario: &str) -> String {
    let (rig, rest) = BENCHMARK.split_once("[[scenario]]").unwrap();
    let simulation = &rest[rest.find("[simulation]").unwrap()..];
    format!("{rig}[[scenario]]\nname = \"one\"\n{scenario}\n{simulation}")
}

const START: &str = "start = { position = \"250 mm\", pressure_a = \"35 bar\", pressure_b = \"35 bar\" }";

fn load(text: &str, source: &Memory) -> Loaded {
    let source = source.clone().with("rig.toml", text);
    project::read(&source, "rig.toml", &[], &[]).unwrap_or_else(|report| panic!("{report}"))
}

fn run_with(text: &str, source: &Memory) -> ScenarioRun {
    let run = simulate_project(source, &Setup::new(&load(text, source).project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    assert_eq!(run.stopped(), None);
    run
}

fn run(scenario: &str) -> ScenarioRun {
    run_with(&rig(scenario), &Memory::default())
}

fn row(run: &ScenarioRun, time_s: f64) -> usize {
    run.record.times_s.iter().position(|time| *time >= time_s - 1e-9).unwrap()
}

fn last(values: Vec<f64>) -> f64 {
    *values.last().unwrap()
}

// ORIGIN: analytic, the sum of the parts
/// Parts of a reference add up: steps hold until the next, all others are added from their start on
/// and hold their final value.
#[test]
fn a_reference_is_the_sum_of_its_parts() {
    let scenario = format!(
        "duration = \"1 s\"\n{START}\nreference = [ {{ at = \"0.1 s\", force = \"1 kN\" }}, \
         {{ at = \"0.4 s\", force = \"2 kN\" }}, \
         {{ kind = \"ramp\", start = \"0.2 s\", duration = \"0.1 s\", force = \"500 N\" }}, \
         {{ kind = \"sine\", start = \"0.5 s\", duration = \"0.25 s\", amplitude = \"100 N\", frequency = \"5 Hz\" }} ]"
    );
    let run = run(&scenario);
    let expected = |time: f64| {
        let steps = if time < 0.1 {
            0.0
        } else if time < 0.4 {
            1e3
        } else {
            2e3
        };
        let ramp = 5e3 * (time - 0.2).clamp(0.0, 0.1);
        let sine = 100.0 * portable::sin(TAU * 5.0 * (time - 0.5).clamp(0.0, 0.25));
        steps + ramp + sine
    };
    for (time, reference) in run.record.times_s.iter().zip(&run.record.reference_n) {
        // a sample that rounding moves to a break has either side
        let at_break = [0.1, 0.4].iter().any(|brk| (time - brk).abs() < 1e-9);
        assert!(at_break || (reference - expected(*time)).abs() < 1e-9, "{time}: {reference}");
    }
    let causes: Vec<Cause> = run.windows.iter().map(|(window, _)| window.cause).collect();
    assert_eq!(
        causes,
        [
            Cause::ReferenceStep { from_n: 0.0, to_n: 1e3 },
            Cause::ReferenceMotion { kind: "ramp" },
            Cause::ReferenceStep { from_n: 1.5e3, to_n: 2.5e3 },
            Cause::ReferenceMotion { kind: "sine" },
        ]
    );
    // a sine has no overshoot; the part after it has an error, and the largest is that of its rows
    let (window, metrics) = &run.windows[3];
    assert_eq!(metrics.overshoot_percent, Err(Unmeasured::ReferenceMoves));
    let from = row(&run, window.start_s);
    let errors = run.record.reference_n.iter().zip(run.record.signal(Signal::Force)).skip(from);
    let largest = errors.map(|(reference, force)| (reference - force).abs()).fold(0.0, f64::max);
    let found = metrics.tracking_error_peak_n.unwrap();
    assert!(found >= largest && found < 1.001 * largest + 0.1, "{found} {largest}");
    assert!(metrics.steady_state_error_n.is_ok() && run.windows[0].1.tracking_error_peak_n.is_err());
}

/// A function of time in two forms gives one run, byte for byte.
#[test]
fn forms_of_one_reference_give_one_run() {
    let pairs = [
        (
            "[{ at = \"0.1 s\", force = \"1 kN\" }, { at = \"0.3 s\", force = \"500 N\" }]",
            "{ kind = \"steps\", times = [\"0.1 s\", \"0.3 s\"], forces = [\"1 kN\", \"500 N\"] }",
        ),
        (
            "{ kind = \"sine\", start = \"0.1 s\", amplitude = \"1 kN\", frequency = \"3 Hz\" }",
            "{ kind = \"multisine\", start = \"0.1 s\", amplitude = \"1 kN\", frequencies = [\"3 Hz\"] }",
        ),
        ("{ kind = \"step\", at = 0.1, force = \"1 kN\" }", "[{ at = \"100 ms\", force = 1000 }]"),
    ];
    for (one, other) in pairs {
        let [one, other] = [one, other]
            .map(|reference| run(&format!("duration = \"0.5 s\"\n{START}\nreference = {reference}")));
        assert_eq!(one.record, other.record);
    }
}

/// Points on a straight line are a ramp that holds its end.
#[test]
fn a_recorded_reference_gives_its_recorded_run() {
    let source = Memory::default()
        .with("ramp.csv", "time_ms,force_kn\n1000,0\n1040,0.2\n1190,0.95\n1200,1\n1300,1\n1400,1\n");
    let of = |reference: &str| {
        let text = rig(&format!("duration = \"0.6 s\"\n{START}\nreference = {reference}"));
        run_with(&text, &source)
    };
    let ramp = of("{ kind = \"ramp\", start = \"0.1 s\", duration = \"0.2 s\", force = \"1 kN\" }");
    let file = of("{ kind = \"file\", start = \"0.1 s\", file = \"ramp.csv\" }");
    let forces = ramp.record.signal(Signal::Force).into_iter().zip(file.record.signal(Signal::Force));
    let apart = forces.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    // ORIGIN: analytic, the cubic bends at the end of the ramp, by at most 4/27 of the 50 N by
    // which the last interval rises
    assert!(apart < 50.0 * 4.0 / 27.0, "{apart}");
    let end = |run: &ScenarioRun| last(run.record.signal(Signal::Force));
    assert!((end(&ramp) - end(&file)).abs() < 1.0, "{} {}", end(&ramp), end(&file));
    let text = rig("duration = 1\nreference = { kind = \"file\", file = \"ramp.csv\" }");
    let wrong = Memory::default().with("ramp.csv", "time_ms,force_nm\n0,0\n1,1\n");
    let error = simulate_project(&wrong, &Setup::new(&load(&text, &wrong).project).unwrap(), &mut |_| true)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("`nm` is not a unit of a force") && error.contains("did you mean `force_n`?"),
        "{error}"
    );
}

// ORIGIN: analytic, the command of one run is that of the other
/// The command of a closed loop, played back to the machine without the controller, gives the force
/// of the closed loop.
#[test]
fn a_command_played_back_gives_the_force_it_was_recorded_with() {
    let closed = run(&format!(
        "duration = \"1 s\"\noutput_step = \"0.25 ms\"\n{START}\nreference = {{ at = \"0.1 s\", force = \"4 kN\" }}"
    ));
    let mut recorded = "time_s,voltage_v\n".to_string();
    for (time, command) in closed.record.times_s.iter().zip(&closed.record.signal(Signal::Control)) {
        writeln!(recorded, "{time},{command}").unwrap();
    }
    let text =
        rig(&format!("duration = \"1 s\"\n{START}\ncommand = {{ kind = \"file\", file = \"command.csv\" }}"));
    // no control: the law is absent
    let (before, rest) = text.split_once("[controller]").unwrap();
    let text = format!("{before}{}", &rest[rest.find("[[scenario]]").unwrap()..]);
    let open = run_with(&text, &Memory::default().with("command.csv", recorded));
    for time_s in [0.05, 0.11, 0.15, 0.2, 0.4, 1.0] {
        let [one, other] = [&closed, &open].map(|run| run.record.signal(Signal::Force)[row(run, time_s)]);
        assert!((one - other).abs() < 2.0, "{time_s}: {one} {other}");
    }
    let (window, metrics) = &open.windows[0];
    assert_eq!(window.cause, Cause::CommandMotion { kind: "file" });
    assert!(open.record.reference_n.is_empty() && open.record.signal(Signal::FilteredReference).is_empty());
    assert_eq!(metrics.overshoot_percent, Err(Unmeasured::OpenLoop));
    let largest = open.record.signal(Signal::Force).into_iter().map(f64::abs).fold(0.0, f64::max);
    let found = metrics.force_peak_n.unwrap();
    assert!(found >= largest && found < 1.001 * largest, "{found} {largest}");
}

/// Neither the limit of a controller nor its samples act on a stated command, and the answer
/// reports this.
#[test]
fn an_open_loop_ignores_its_controller() {
    let scenario =
        format!("duration = \"0.2 s\"\n{START}\ncommand = {{ at = \"0.05 s\", voltage = \"3 V\" }}");
    let text = rig(&scenario);
    let plain = run(&scenario);
    let other = text
        .replace("saturation = \"10 V\"", "saturation = \"1 V\"\nsample_time = \"1 ms\"\ndelay = \"0.5 ms\"");
    let limited = run_with(&other, &Memory::default());
    assert_eq!(plain.record, limited.record);
    assert_eq!(plain.windows[0].0.cause, Cause::CommandStep { from_v: 0.0, to_v: 3.0 });
    let loaded = load(&text, &Memory::default());
    let answer =
        command::answer(&Memory::default(), &loaded, &[], &Request::Simulate(Default::default())).unwrap();
    assert!(
        answer.text.contains("one: completed open loop (") && answer.text.contains("command to 3 V at 50 ms"),
        "{}",
        answer.text
    );
    let json: Value = parsed(&answer.json);
    let run = &json["scenarios"][0];
    assert_eq!((&run["open_loop"], &run["events"][0]["kind"]), (&true.into(), &"command_step".into()));
    assert_eq!(run["events"][0]["metrics"]["overshoot_percent"], Value::Null);
    let table = String::from_utf8(answer.files[0].bytes.clone()).unwrap();
    let [names, second] = [0, 1].map(|line| table.lines().nth(line).unwrap().split(',').collect::<Vec<_>>());
    // no reference, before or after a prefilter
    assert_eq!((names[1], names[21]), ("reference_n", "filtered_reference_n"));
    assert_eq!((second[1], second[21]), ("", ""));
}

const SPRUNG: &str = "[load]\nmodel = \"spring_mass_damper\"\nmass = \"20 kg\"\nstiffness = \"2 MN/m\"\ndamping = \"3 kN.s/m\"\n";

/// Equilibrium of a load on a spring is where F_e + F_x holds it, and the loop maintains F_e.
#[test]
fn an_external_force_moves_the_load_by_its_spring() {
    let of = |outside: &str| {
        let text = rig(&format!(
            "duration = \"4 s\"\n{START}\nreference = {{ at = \"0.1 s\", force = \"1 kN\" }}\n{outside}"
        ));
        run_with(&text.replace("[controller]", &format!("{SPRUNG}[controller]")), &Memory::default())
    };
    let unpushed = of("");
    let pushed =
        of("external_force = { kind = \"ramp\", start = \"1 s\", duration = \"0.2 s\", force = \"800 N\" }");
    let end = |run: &ScenarioRun, signal: Signal| last(run.record.signal(signal));
    // ORIGIN: analytic, F_x/k = 800/2e6
    let moved = end(&pushed, Signal::LoadPosition) - end(&unpushed, Signal::LoadPosition);
    assert!((moved - 4e-4).abs() < 2e-6, "{moved}");
    assert!(
        (end(&pushed, Signal::Force) - 1e3).abs() < 2.0 && (end(&unpushed, Signal::Force) - 1e3).abs() < 2.0
    );
    assert_eq!(last(pushed.record.signal(Signal::ExternalForce)), 800.0);
    assert!(unpushed.record.signal(Signal::ExternalForce).is_empty());
    let (window, metrics) = pushed.windows.last().unwrap();
    assert_eq!((window.cause, window.start_s), (Cause::ExternalForce { about_joint: false }, 1.0));
    assert!(metrics.disturbance_peak_n.unwrap() > 1.0);
    // no effect before it begins
    let before = row(&unpushed, 0.9);
    let known = |run: &ScenarioRun| run.record.signal(Signal::Force)[before];
    assert!((known(&unpushed) - known(&pushed)).abs() < 0.1, "{} {}", known(&unpushed), known(&pushed));
}

#[test]
fn a_campaign_takes_an_open_loop_and_other_references() {
    let campaign = "[campaign]\nparameters = { \"supply.pressure\" = { spread = 0.1 } }\n";
    let plan = |scenario: &str| {
        let text = format!("{}\n{campaign}", rig(&format!("duration = \"0.3 s\"\n{START}\n{scenario}")));
        Plan::new(&Memory::default(), &load(&text, &Memory::default()), 1)
    };
    let open = plan("command = { at = 0.1, voltage = 1 }").unwrap();
    assert_eq!(open.windows()[0].cause, Cause::CommandStep { from_v: 0.0, to_v: 1.0 });
    let sine = "reference = { kind = \"sine\", amplitude = \"1 kN\", frequency = \"5 Hz\" }";
    assert_eq!(plan(sine).unwrap().windows()[0].cause, Cause::ReferenceMotion { kind: "sine" });
}

/// Continues from the end of another run, with its state file in the source.
fn continued(first: &str, second: &str, change: impl Fn(String) -> String) -> [ScenarioRun; 2] {
    let text = change(rig(first));
    let loaded = load(&text, &Memory::default());
    let answer =
        command::answer(&Memory::default(), &loaded, &[], &Request::Simulate(Default::default())).unwrap();
    let file = answer.files.iter().find(|file| file.name == "one.state.toml").unwrap();
    let run = run_with(&text, &Memory::default());
    let source = Memory::default().with("one.state.toml", file.bytes.clone());
    [run, run_with(&change(rig(second)), &source)]
}

/// Two seconds at once, and two halves of which the second continues the first: equal within the
/// tolerance.
fn halves_are_the_whole(change: impl Fn(String) -> String + Copy, tolerance_n: f64) {
    let start = format!("output_step = \"1 ms\"\n{START}");
    let step = "reference = [{ at = \"0.1 s\", force = \"4 kN\" }, { at = \"0.55 s\", force = \"3 kN\" }]";
    let motion = "load_motion = { kind = \"smooth_step\", start = \"0.2 s\", duration = \"0.1 s\", distance = \"3 mm\" }";
    let whole =
        run_with(&change(rig(&format!("duration = \"1 s\"\n{start}\n{step}\n{motion}"))), &Memory::default());
    let first = format!("duration = \"0.5 s\"\n{start}\n{step}\n{motion}");
    // from its own time zero: the reference as written, and its step
    let second = "duration = \"0.5 s\"\noutput_step = \"1 ms\"\nstart = { file = \"one.state.toml\" }\n\
                  reference = [{ at = 0, force = \"4 kN\" }, { at = \"0.05 s\", force = \"3 kN\" }]";
    let [one, other] = continued(&first, second, change);
    let forces = whole.record.signal(Signal::Force);
    let half = row(&whole, 0.5);
    let forces_of = |run: &ScenarioRun| run.record.signal(Signal::Force);
    // steps that end at other breaks than those of the whole run
    let first =
        forces.iter().zip(forces_of(&one)).map(|(whole, half)| (whole - half).abs()).fold(0.0, f64::max);
    assert!(first < tolerance_n, "{first}");
    let apart = |signal: Signal| {
        let (whole, other) = (whole.record.signal(signal), other.record.signal(signal));
        assert_eq!(whole.len(), half + other.len());
        whole[half..].iter().zip(&other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
    };
    assert!(apart(Signal::Force) < tolerance_n, "{} N", apart(Signal::Force));
    assert!(apart(Signal::LoadPosition) < 1e-12, "{}", apart(Signal::LoadPosition));
    assert!(apart(Signal::PressureA) < 1e3 * tolerance_n, "{} Pa", apart(Signal::PressureA));
    // nothing is integrated yet at the first instant: the bits are those of the end
    assert_eq!(other.record.samples[0].machine, one.record.samples.last().unwrap().machine);
    let command = |run: &ScenarioRun| run.record.signal(Signal::Control);
    let difference =
        command(&whole)[half..].iter().zip(command(&other)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-3 * tolerance_n.max(0.1), "{difference} V");
}

#[test]
fn a_saved_state_continues_to_the_same_bytes() {
    // a tolerance of 1e-8 of 1.1 kN and more, a hundred steps
    let tight = |text: String| text.replace("tolerance = 1e-6", "tolerance = 1e-8");
    halves_are_the_whole(tight, 0.02);
}

/// A setting that moves across the end of a run continues from its value, and is rejected
/// elsewhere.
#[test]
fn a_setting_continues_from_its_saved_value() {
    for part in [
        "kind = \"gas\", gas_volume = \"6 mL\"",
        "kind = \"valve\", flow = \"20 L/min\", pressure_drop = \"5 bar\", transition_pressure = \"0.5 bar\"",
    ] {
        let adjusted = |text: String| {
            let gas = format!(
                "[line.accumulator]\ngas_volume = \"12 mL\"\nprecharge_pressure = \"15 bar\"\nadjustment = {{ {part}, setting = 0.1 }}\n\n[force_sensor]"
            );
            text.replace("[force_sensor]", &gas).replace("tolerance = 1e-6", "tolerance = 1e-8")
        };
        let common =
            format!("output_step = \"1 ms\"\n{START}\nreference = {{ at = \"0.1 s\", force = \"2 kN\" }}");
        let ramp =
            "setting_change = { kind = \"ramp\", change = 0.8, start = \"0.2 s\", duration = \"0.4 s\" }";
        let whole =
            run_with(&adjusted(rig(&format!("duration = \"1 s\"\n{common}\n{ramp}"))), &Memory::default());
        let second = |change: &str| {
            format!(
                "duration = \"0.6 s\"\noutput_step = \"1 ms\"\nstart = {{ file = \"one.state.toml\" }}\nreference = {{ at = 0, force = \"2 kN\" }}\n{change}"
            )
        };
        let first = format!("duration = \"0.4 s\"\n{common}\n{ramp}");
        let continues = "setting_change = [{ at = 0, change = 0.4 }, { kind = \"ramp\", change = 0.4, duration = \"0.2 s\" }]";
        let [_, other] = continued(&first, &second(continues), adjusted);
        let half = row(&whole, 0.4);
        for (signal, tolerance) in
            [(Signal::Force, 0.05), (Signal::PressureA, 50.0), (Signal::SettingA, 1e-9)]
        {
            let (whole, other) = (whole.record.signal(signal), other.record.signal(signal));
            assert_eq!(whole.len(), half + other.len());
            let apart =
                whole[half..].iter().zip(&other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            assert!(apart < tolerance, "{part} {signal:?}: {apart}");
        }
        let text = adjusted(rig(&first));
        let answer = command::answer(
            &Memory::default(),
            &load(&text, &Memory::default()),
            &[],
            &Request::Simulate(Default::default()),
        )
        .unwrap();
        let state = answer.files.iter().find(|file| file.name == "one.state.toml").unwrap().bytes.clone();
        let source = Memory::default().with("one.state.toml", state);
        for elsewhere in ["", "setting_change = { kind = \"ramp\", change = 0.4, duration = \"0.2 s\" }"] {
            let text = adjusted(rig(&second(elsewhere)));
            let refused =
                simulate_project(&source, &Setup::new(&load(&text, &source).project).unwrap(), &mut |_| true)
                    .unwrap_err()
                    .to_string();
            assert!(refused.contains("has moved by 0.400000 at the end of that run, and by 0"), "{refused}");
        }
    }
}

#[test]
fn a_sampled_controller_continues_with_its_state() {
    let sampled = |text: String| {
        text.replace("tolerance = 1e-6", "tolerance = 1e-8").replace(
            "saturation = \"10 V\"",
            "saturation = \"10 V\"\nsample_time = \"1 ms\"\ndelay = \"0.4 ms\"",
        )
    };
    halves_are_the_whole(sampled, 0.02);
    // noise, so that its random numbers continue too
    let noisy = |text: String| sampled(text).replace("[force_sensor]", "[force_sensor]\nnoise = \"5 N\"");
    halves_are_the_whole(noisy, 0.02);
}

#[test]
fn mismatched_states_are_refused_and_incomplete_ones_not_written() {
    let first = format!("duration = \"0.01 s\"\n{START}\nreference = []");
    let loaded = load(&rig(&first), &Memory::default());
    let answer =
        command::answer(&Memory::default(), &loaded, &[], &Request::Simulate(Default::default())).unwrap();
    let json: Value = parsed(&answer.json);
    assert_eq!(json["scenarios"][0]["state_file"], "one.state.toml");
    let state = String::from_utf8(answer.files[1].bytes.clone()).unwrap();
    assert!(state.contains(&format!("project_sha256 = \"{}\"", loaded.sha256)), "{state}");
    let refused = |state: &str, change: &dyn Fn(String) -> String| {
        let source = Memory::default().with("one.state.toml", state);
        let text = change(rig("duration = 1\nstart = { file = \"one.state.toml\" }"));
        simulate_project(&source, &Setup::new(&load(&text, &source).project).unwrap(), &mut |_| true)
            .unwrap_err()
            .to_string()
    };
    let same = |text: String| text;
    let sampled = |text: String| text.replace("saturation", "sample_time = \"1 ms\"\nsaturation");
    let viscous = |text: String| {
        let (before, rest) = text.split_once("[cylinder.friction]").unwrap();
        format!(
            "{before}[cylinder.friction]\nmodel = \"viscous\"\nviscous = \"100 N.s/m\"\n\n{}",
            &rest[rest.find("[line]").unwrap()..]
        )
    };
    for (found, words) in [
        (refused(&state, &viscous), "this machine and its controller have no state `bristle_m`"),
        (refused(&state, &sampled), "the state `held_command_v` is missing"),
        (refused(&state.replace("deflection_m", "deflexion_m"), &same), "no state `deflexion_m`"),
        (refused(&state.replace("schema = 1", "schema = 2"), &same), "a saved state says `schema = 1`"),
        (refused("schema = ", &same), "one.state.toml"),
    ] {
        assert!(found.contains(words), "{words}: {found}");
    }
    let unsaved = |change: &dyn Fn(String) -> String| {
        run_with(&change(rig(&first)), &Memory::default()).end.unwrap_err()
    };
    let delayed = |text: String| text.replace("saturation", "delay = \"0.5 ms\"\nsaturation");
    assert_eq!(unsaved(&delayed), NotSaved::InTransit);
    let slow = |text: String| text.replace("saturation", "sample_time = \"3 ms\"\nsaturation");
    assert_eq!(unsaved(&slow), NotSaved::BetweenSamples);
    let late =
        |text: String| text.replace("saturation", "sample_time = \"1 ms\"\ndelay = \"1 ms\"\nsaturation");
    assert_eq!(unsaved(&late), NotSaved::CommandDelayed);
}

/// The expansion of a hose is known up to the pressure at which it is stated: beyond it, supply and
/// chambers are reported with both numbers.
#[test]
fn an_expansion_is_carried_on_beyond_its_pressure_with_a_warning() {
    let hose = include_str!("../../../examples/ybitu/hose.toml");
    let settings =
        ["supply.pressure=100 bar", "scenario.0.duration=0.02 s", "scenario.0.start.pressure_a=80 bar"];
    let read = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
        let source = Memory::default().with("rig.toml", hose);
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"))
    };
    let warned = |loaded: &Loaded| {
        let expansion_warnings = loaded.warnings.iter().filter(|found| found.message.contains("expansion"));
        expansion_warnings.map(|found| found.message.clone()).collect::<Vec<_>>()
    };
    let loaded = read(&settings);
    let words = "the expansion of the hose is stated at 70 bar, and the supply has 100 bar: in between it is carried on along its slope";
    assert_eq!(warned(&loaded), [words]);
    let run = simulate_project(&Memory::default(), &Setup::new(&loaded.project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    let beyond: Vec<char> = run.beyond_expansion.iter().map(|beyond| beyond.chamber).collect();
    assert_eq!((beyond, run.beyond_expansion[0].stated_pa), (vec!['a'], 7e6));
    assert!(run.beyond_expansion[0].peak_pa >= 8e6);
    let loaded = read(&["scenario.0.duration=0.02 s"]);
    assert!(warned(&loaded).is_empty());
    let run = simulate_project(&Memory::default(), &Setup::new(&loaded.project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    assert!(run.beyond_expansion.is_empty());
}
