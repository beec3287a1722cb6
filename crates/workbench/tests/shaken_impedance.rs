//! The load of a controlled machine with a virtual impedance, shaken by small sines: the force is
//! that of the linear loop.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use std::f64::consts::TAU;

use crate::shaken_load::{SENSOR, WAVES, apart, loaded, of_machine, response};
use num_complex::Complex64;
use phea_workbench::engineering::rig::Rig;
use phea_workbench::engineering::setup::Setup;

const GENTLE: &str = "controller.numerator=0.0004*s + 0.0032";
const SPRUNG: &str =
    "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"5000 N.s/m\" }";
/// Impedances: a spring, a spring with a damper, and both with a mass.
const IMPEDANCES: [&str; 3] = [
    "controller.impedance={ stiffness = \"200 kN/m\" }",
    "controller.impedance={ stiffness = \"100 kN/m\", damping = \"2000 N.s/m\", filter_time = \"2 ms\" }",
    "controller.impedance={ stiffness = \"20 kN/m\", damping = \"2500 N.s/m\", mass = \"80 kg\", filter_time = \"5 ms\" }",
];
/// Response Pd + P u of the force, u = -G H (y/X)/(1 + L) of the linear loop around y = F_e + Z_v
/// X_L.
fn of_loop(settings: &[&str], hertz: u32) -> Complex64 {
    let project = loaded(settings, &[]);
    let setup = Setup::new(&project).unwrap();
    let compensation = setup.compensation(setup.controller.as_ref().unwrap()).unwrap();
    let frequency = TAU * f64::from(hertz);
    let of = |rig: Rig| response(&compensation, rig, frequency);
    let rig = setup.rig().unwrap();
    let (seen, force) = (of(rig.in_loop()), of(rig.without_impedance().in_loop()));
    let feedback = compensation.feedback().at_frequency(frequency);
    let command = -feedback * seen.sensor * seen.load_motion / (1.0 + seen.plant * seen.sensor * feedback);
    force.load_motion + force.plant * command
}

/// Checks that impedances change the force by the amount that the linear loop predicts; one of them
/// by at least five times the permitted difference.
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
fn with_a_prescribed_load() {
    check(&[], &[1, 7, 20]);
    check(&["controller.sample_time=1 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], &[7]);
    check(&["controller.delay=2 ms", WAVES, GENTLE], &[7]);
}

#[test]
fn with_a_yielding_load() {
    check(&[SPRUNG], &[1, 7]);
    check(&[SPRUNG, "controller.sample_time=2 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], &[5]);
    check(&[SPRUNG, "controller.sample_time=1 ms", "controller.delay=2 ms", WAVES, GENTLE], &[7]);
}

#[test]
fn with_a_velocity_that_is_fed_forward() {
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
