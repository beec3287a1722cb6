//! Pressure feedback: the loop closed by the linear plant is that of the machine.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use num_complex::Complex64;
use phea_hydraulics::signal::Signal;
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::Verdict;
use phea_workbench::engineering::audit::audit_project;
use phea_workbench::engineering::robust::robust_problem;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{
    FrequencyRequest, MachineResponses, frequency_response, simulate_project,
};
use phea_workbench::project::{self, Project};
use phea_workbench::source::Memory;

use super::run_command::project_of;
use super::shaken_load;

const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const STRUCTURAL: &str = include_str!("../../../examples/structural/rig.toml");

/// Viscous friction and four equal edges: nothing has a kink, so that derivatives exist at null.
const SMOOTH: [&str; 3] = [
    "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
    "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
    "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
];
const UNEQUAL: &str = "cylinder={ piston_diameter = \"50 mm\", rod_diameters = [\"0 mm\", \"36 mm\"], stroke = \"500 mm\", moving_mass = \"13.1 kg\" }";
const SPRUNG: &str =
    "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"5000 N.s/m\" }";
const WAVES: &str =
    "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
const LATE: &str = "controller.delay=0.7 ms";
const GENTLE: &str = "controller.numerator=0.0001*s + 0.0008";

/// Load pressure, difference, and both filters.
const FEEDBACKS: [&str; 3] = [
    "controller.pressure_feedback={ gain = \"0.02 V/bar\", signal = \"load_pressure\" }",
    "controller.pressure_feedback={ gain = \"0.05 V/bar\", signal = \"pressure_difference\", high_pass = \"3 Hz\" }",
    "controller.pressure_feedback={ gain = \"0.1 V/bar\", high_pass = \"1 Hz\", low_pass = \"100 Hz\" }",
];

fn read(text: &str, settings: &[&str]) -> Project {
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

fn shaken(project: &Project) -> MachineResponses {
    let request = FrequencyRequest {
        frequencies_rad_per_s: vec![20.0, 300.0],
        command_amplitude_v: Some(1e-4),
        reference_amplitude_n: Some(1.0),
    };
    frequency_response(&Setup::new(project).unwrap(), &request, &mut |_| true).unwrap()
}

fn apart(one: Complex64, other: Complex64) -> f64 {
    (one / other - 1.0).norm_sqr().sqrt()
}

/// The machine under its controller, by its exact derivatives to 1e-7 and by small sines, is the
/// loop closed by the linear plant; the feedback changes that loop.
fn check(settings: &[&str]) {
    let settings = [&SMOOTH[..], &[GENTLE], settings].concat();
    let plain = shaken(&read(BENCHMARK, &settings)).closed_loop.unwrap();
    let mut moved = 0.0_f64;
    for feedback in FEEDBACKS {
        let project = read(BENCHMARK, &[&settings[..], &[feedback]].concat());
        let closed = shaken(&project).closed_loop.unwrap();
        for (point, plain) in closed.points.iter().zip(&plain.points) {
            let linear = point.linear_plant;
            if let Some(exact) = point.linearised_machine {
                assert!(apart(exact, linear) < 1e-7, "{settings:?} {feedback}: {point:?}");
            }
            assert!(apart(point.machine, linear) < 2e-3, "{settings:?} {feedback}: {point:?}");
            moved = moved.max(apart(linear, plain.linear_plant));
        }
    }
    assert!(moved > 0.02, "{settings:?}: {moved}");
}

#[test]
fn the_loop_is_that_of_the_machine() {
    check(&[]);
    check(&[UNEQUAL, SPRUNG]);
}

#[test]
fn a_late_loop_is_that_of_the_machine() {
    check(&[LATE]);
    check(&[SPRUNG, WAVES, LATE]);
}

#[test]
fn a_sampled_loop_is_that_of_the_machine() {
    let sampled = "controller.sample_time=1 ms";
    check(&[sampled]);
    check(&[sampled, "controller.delay=1.4 ms", UNEQUAL, SPRUNG]);
    check(&[sampled, LATE, WAVES]);
}

/// Force per motion of the load or its ground, Pd - G H Pd P/(1 + L) with the pressures fed back.
fn of_loop(settings: &[&str], hertz: u32) -> Complex64 {
    let project = shaken_load::loaded(settings, &[]);
    let setup = Setup::new(&project).unwrap();
    let compensation = setup.compensation(setup.controller.as_ref().unwrap()).unwrap();
    let frequency = std::f64::consts::TAU * f64::from(hertz);
    let own = shaken_load::response(&compensation, setup.rig().unwrap().in_loop(), frequency);
    own.load_motion / (1.0 + own.plant * own.sensor * compensation.feedback().at_frequency(frequency))
}

/// The loop that acts on a moving load is that of the linear model, without delay, with delay,
/// sampled, and with waves.
#[test]
fn a_moving_load_is_in_the_loop() {
    let mut moved = 0.0_f64;
    for settings in [
        &[][..],
        &[LATE, SPRUNG],
        &["controller.sample_time=1 ms", "controller.delay=1.4 ms"],
        &["controller.sample_time=1 ms", SPRUNG],
        &["controller.sample_time=1 ms", "controller.delay=0.5 ms", WAVES, SPRUNG],
    ] {
        let settings = [settings, &[GENTLE]].concat();
        for feedback in [FEEDBACKS[0], FEEDBACKS[2]] {
            let with = [&settings[..], &[feedback]].concat();
            let (machine, linear) = (shaken_load::of_machine(&with, 7), of_loop(&with, 7));
            let error = apart(machine, linear);
            assert!(error < 1e-3, "{with:?}: {machine}, not {linear}: {error}");
            moved = moved.max(apart(of_loop(&settings, 7), linear));
        }
    }
    assert!(moved > 0.01, "{moved}");
}

/// A machine that rests under a controller without integral action: the feedback at rest is part of
/// its command.
#[test]
fn the_rig_rests_with_its_fed_back_pressure() {
    let proportional = ["controller.numerator=0.0005", "controller.denominator=1"];
    for (feedback, sampled) in FEEDBACKS.into_iter().flat_map(|one| [(one, ""), (one, "1 ms")]) {
        let sampled = format!("controller.sample_time={sampled}");
        let mut settings = [&SMOOTH[..], &proportional, &[UNEQUAL, feedback]].concat();
        settings.extend((!sampled.ends_with('=')).then_some(sampled.as_str()));
        let settings =
            [&settings[..], &["scenario.0.reference=[{ at = \"0 s\", force = \"1 kN\" }]"]].concat();
        let from_rest: Vec<&str> = BENCHMARK.lines().filter(|line| !line.starts_with("start = ")).collect();
        let project = read(&from_rest.join("\n"), &settings);
        let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
            .unwrap()
            .remove(0);
        let of = |signal: Signal| run.record.signal(signal)[0];
        let (force, command) = (of(Signal::Force), of(Signal::Command));
        let declared = project.controller.unwrap().pressure_feedback.unwrap();
        let areas = [1.963_495_408_5e-3, 0.945_619_389e-3];
        let ratio = match declared.signal {
            project::PressureSignal::LoadPressure => areas[1] / areas[0],
            project::PressureSignal::PressureDifference => 1.0,
        };
        let fed = if declared.high_pass.is_some() { 0.0 } else { declared.gain };
        let expected = 0.0005 * (1e3 - force) - fed * (of(Signal::PressureA) - ratio * of(Signal::PressureB));
        assert!((command - expected).abs() < 1e-7, "{feedback}: {command} {expected}");
    }
}

/// Enough feedback with the wrong sign makes the loop unstable, without delay, with delay and with
/// waves, and the machine swings up as predicted.
#[test]
fn it_is_part_of_the_stability_of_the_loop() {
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, specifications) = rest.split_once("[[specification]]").unwrap();
    let certain = format!("{start}[[specification]]{specifications}");
    let sampled = "controller.sample_time=0.5 ms";
    for line in [
        &[][..],
        &["controller.delay=0.2 ms"],
        &["line.model=transmission_line", GENTLE],
        &[sampled],
        &[sampled, "line.model=transmission_line", GENTLE],
    ] {
        for (gain, stable) in [("0.005 V/bar", true), ("-1 V/bar", false)] {
            let gain = format!("controller.pressure_feedback.gain={gain}");
            let settings = [line, &[gain.as_str(), "controller.pressure_feedback.high_pass=2 Hz"]].concat();
            let project = project_of(&certain, &settings);
            let problem = robust_problem(&Memory::default(), &Setup::new(&project).unwrap()).unwrap();
            let member = problem.nominal().unwrap().unwrap();
            let found = member_stability(&member, &problem.compensation).status;
            assert_eq!(found == StabilityStatus::Stable, stable, "{line:?} {gain}: {found:?}");
            assert!(stable || matches!(found, StabilityStatus::Unstable(_)), "{line:?} {gain}: {found:?}");
            assert!(problem.caveats.is_empty(), "{:?}", problem.caveats);
        }
    }
}

/// The verdict over the box of the hose is that of the plants with their feedback.
#[test]
fn it_is_part_of_the_family() {
    let margin = |settings: &[&str]| {
        let project = project_of(HOSE, settings);
        let view = audit_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap();
        let worst = view.audit.specifications[0].worst.as_ref().unwrap().margin_db;
        (view.audit.verdict, worst)
    };
    let (_, plain) = margin(&[]);
    let (verdict, with) = margin(&["controller.pressure_feedback.gain=0.1 V/bar"]);
    assert_ne!(verdict, Verdict::NotProven);
    assert!((with - plain).abs() > 0.01, "{plain} {with}");
}

/// The tolerated delay acts on the controller and on the paths within its loop equally: with a
/// little less the family is stable, with a little more it is not: with pressure feedback, with
/// waves in the lines too, and with the velocity of the load fed forward.
#[test]
fn the_delay_margin_is_that_of_all_loops() {
    let high_pass = "controller.pressure_feedback.high_pass=60 Hz";
    let [less, more] = ["0.05", "0.09"].map(|gain| format!("controller.pressure_feedback.gain={gain} V/bar"));
    let [less, more] = [&less, &more].map(|gain| vec![high_pass, gain]);
    let waves = [&more[..], &["line.model=transmission_line"]].concat();
    let velocity = vec!["controller.load_velocity_feed_forward={ gain = \"5 V.s/m\" }"];
    let cases = [(&more, 1e-3), (&waves, 1e-3), (&velocity, 1e-3), (&velocity, 0.0), (&less, 0.0)];
    for (settings, delay_s) in cases {
        let audited = |delay_s: f64| {
            let delay = format!("controller.delay={delay_s} s");
            let settings = [&settings[..], &[delay.as_str()]].concat();
            let project = project_of(STRUCTURAL, &settings);
            audit_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true).unwrap().audit
        };
        let margin_s = audited(delay_s).delay_margin.expect("a stable family").delay_s;
        assert!(margin_s > 1e-4 && margin_s < 5e-3, "{margin_s}");
        let verdict = |fraction: f64| audited(delay_s + fraction * margin_s).stability.verdict;
        assert_eq!(verdict(0.97), Verdict::Met, "{settings:?} {margin_s}");
        assert_eq!(verdict(1.03), Verdict::Violated, "{settings:?} {margin_s}");
    }
}
