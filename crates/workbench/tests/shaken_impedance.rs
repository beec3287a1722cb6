//! The load of a controlled machine with a virtual impedance, shaken by small sines: the force is that of the linear loop.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use std::f64::consts::TAU;
use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::portable::exp_complex;
use phea_dynamics::simulation::Status;
use phea_workbench::project::{self, Project};
use phea_workbench::rig::Rig;
use phea_workbench::setup::Setup;
use phea_workbench::simulate::simulate_project;
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/benchmark/closed_loop.toml");
/// Viscous friction and four equal edges: nothing has a kink. Nothing is asked of the controller, which starts at rest.
const SMOOTH: [&str; 6] = [
    "cylinder.friction={ model = \"viscous\", viscous = \"100 N.s/m\" }",
    "valve.flow_coefficients=[3e-7, 3e-7, 3e-7, 3e-7]",
    "valve.leakage_coefficients=[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]",
    "scenario.0.reference=[]",
    "scenario.0.output_step=1 ms",
    "simulation.tolerance=1e-9",
];
const WAVES: &str =
    "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"transmission_line\" }";
const GENTLE: &str = "controller.numerator=0.0004*s + 0.0032";
const SENSOR: &str = "sensor={ numerator = \"2000\", denominator = \"s + 2000\", delay = \"0.5 ms\" }";
const SPRUNG: &str =
    "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"5000 N.s/m\" }";
/// A spring alone, with a damper, and with a mass too.
const IMPEDANCES: [&str; 3] = [
    "controller.impedance={ stiffness = \"200 kN/m\" }",
    "controller.impedance={ stiffness = \"100 kN/m\", damping = \"2000 N.s/m\", filter_time = \"2 ms\" }",
    "controller.impedance={ stiffness = \"20 kN/m\", damping = \"2500 N.s/m\", mass = \"80 kg\", filter_time = \"5 ms\" }",
];
/// m/s
const SPEED: f64 = 2e-5;
/// What is looked at is the last second of these, s: periods and samples are whole in it.
const DURATION: f64 = 3.0;

fn loaded(settings: &[&str], more: &[String]) -> Project {
    let from_rest: Vec<&str> = BENCHMARK.lines().filter(|line| !line.starts_with("start = ")).collect();
    let source = Memory::default().with("rig.toml", from_rest.join("\n"));
    let settings = SMOOTH.iter().chain(settings).map(|text| (*text).to_string()).chain(more.iter().cloned());
    let settings: Vec<String> = settings.collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

/// Force over motion of the load or its ground in N/m at so many hertz, as the machine answers at the samples.
fn of_machine(settings: &[&str], hertz: u32) -> Complex64 {
    let frequency = TAU * f64::from(hertz);
    let amplitude = SPEED / frequency;
    let motion = format!(
        "scenario.0.load_motion={{ kind = \"sine\", amplitude = {amplitude:e}, frequency = \"{frequency} rad/s\" }}"
    );
    let project = loaded(settings, &[motion, format!("scenario.0.duration={DURATION} s")]);
    let run = simulate_project(&Memory::default(), &Setup::new(&project).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    assert_eq!(run.status, Status::Completed);
    let (times, force) = (&run.record.times_s, run.record.signal("force_n"));
    let sample_s = project.controller.as_ref().unwrap().sample_time.unwrap_or(1e-3);
    let at_samples = times.iter().zip(&force).filter(|(time, _)| {
        let samples = **time / sample_s;
        **time > DURATION - 1.0 + 5e-4 && (samples - samples.round()).abs() < 1e-6
    });
    let (mut sum, mut count) = (Complex64::ZERO, 0.0);
    for (time, force) in at_samples {
        sum += *force * exp_complex(Complex64::new(0.0, -frequency * time));
        count += 1.0;
    }
    assert!((count * sample_s - 1.0).abs() < 1e-9, "{count}");
    sum * Complex64::I * 2.0 / count / amplitude
}

/// Pd + P u of the force, u = -G H (y/X)/(1 + L) of the linear loop around y = F_e + Z_v X_L.
fn of_loop(settings: &[&str], hertz: u32) -> Complex64 {
    let project = loaded(settings, &[]);
    let setup = Setup::new(&project).unwrap();
    let compensation = setup.compensation(setup.controller.as_ref().unwrap()).unwrap();
    let frequency = TAU * f64::from(hertz);
    let of = |rig: Rig| {
        let member = match rig.in_motion {
            Some(moving) => compensation.responding(Arc::new(moving)),
            None => compensation.member(rig.plant.coefficients()).unwrap(),
        };
        member.response(frequency).unwrap()
    };
    let rig = setup.rig().unwrap();
    let (seen, force) = (of(rig.in_loop()), of(rig.without_impedance().in_loop()));
    let feedback = compensation.feedback().at_frequency(frequency);
    let command = -feedback * seen.sensor * seen.load_motion / (1.0 + seen.plant * seen.sensor * feedback);
    force.load_motion + force.plant * command
}

fn apart(one: Complex64, other: Complex64) -> f64 {
    (one / other - 1.0).norm_sqr().sqrt()
}

/// Impedances change the force, one of them at least five times as much as they may disagree, and the linear loop says by how much.
fn check(settings: &[&str], hertz: &[u32]) {
    let mut largest = 0.0_f64;
    for impedance in IMPEDANCES {
        for &hertz in hertz {
            let with = [settings, &[impedance]].concat();
            let (machine, linear) = (of_machine(&with, hertz), of_loop(&with, hertz));
            let error = apart(machine, linear);
            assert!(error < 1e-3, "{settings:?} {impedance} at {hertz} Hz: {machine}, not {linear}: {error}");
            largest = largest.max(apart(of_loop(settings, hertz), linear));
        }
    }
    assert!(largest > 0.005, "{settings:?}: {largest}");
}

#[test]
fn beside_a_prescribed_load() {
    check(&[], &[1, 7, 20]);
    check(&["controller.sample_time=1 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], &[7]);
    check(&["controller.delay=2 ms", WAVES, GENTLE], &[7]);
}

#[test]
fn of_a_load_that_yields() {
    check(&[SPRUNG], &[1, 7]);
    check(&[SPRUNG, "controller.sample_time=2 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], &[5]);
    check(&[SPRUNG, "controller.sample_time=1 ms", "controller.delay=2 ms", WAVES, GENTLE], &[7]);
}

#[test]
fn beside_a_velocity_that_is_fed_forward() {
    let fed = "controller.load_velocity_feed_forward.gain=20";
    check(&[fed], &[7]);
    check(
        &[
            SPRUNG,
            fed,
            "controller.sample_time=1 ms",
            "velocity_sensor={ filter_frequency = \"60 Hz\" }",
            GENTLE,
        ],
        &[7],
    );
    check(&[SPRUNG, fed, "controller.delay=2 ms", GENTLE], &[7]);
}
