//! The load of a controlled machine shaken by small sines, with its velocity fed forward, delayed
//! or sampled: the force is that of the linear loop.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use std::f64::consts::TAU;

use crate::shaken_load::{SENSOR, WAVES, apart, loaded, of_machine, response};
use num_complex::Complex64;
use phea_workbench::engineering::setup::Setup;

const GENTLE: &str = "controller.numerator=0.0002*s + 0.0016";
const SPRUNG: &str =
    "load={ model = \"spring_mass_damper\", mass = 100, stiffness = \"200 kN/m\", damping = \"500 N.s/m\" }";
/// Errors of the velocity sensor: gain, delay, filter.
const SHOWN: [&str; 3] = [
    "velocity_sensor={ gain_error = \"-20 %\", delay = \"0.7 ms\" }",
    "velocity_sensor={ gain_error = \"10 %\", filter_frequency = \"60 Hz\" }",
    "velocity_sensor={ filter_frequency = \"40 Hz\", filter_damping_ratio = 0.6, delay = \"3.2 ms\" }",
];
/// Response (Pd + K V_d P)/(1 + L) of the linear loop.
fn of_loop(settings: &[&str], hertz: u32) -> Complex64 {
    let project = loaded(settings, &[]);
    let setup = Setup::new(&project).unwrap();
    let rig = setup.rig().unwrap().in_loop();
    let compensation = setup.compensation(setup.controller.as_ref().unwrap()).unwrap();
    let frequency = TAU * f64::from(hertz);
    let found = response(&compensation, rig, frequency);
    let feedback = compensation.feedback().at_frequency(frequency);
    found.load_motion / (1.0 + found.plant * found.sensor * feedback)
}

/// Checks each sensor of the velocity, which changes the force as predicted by the linear loop.
fn check_shown(settings: &[&str], hertz: u32) {
    for shown in SHOWN {
        check(&[settings, &[shown]].concat(), &[hertz]);
        let fed = [settings, &["controller.load_velocity_feed_forward.gain=20"]].concat();
        assert!(apart(of_loop(&fed, hertz), of_loop(&[&fed[..], &[shown]].concat(), hertz)) > 0.01);
    }
}

/// Checks that the feed-forward changes the force by the amount that the linear loop predicts.
fn check(settings: &[&str], hertz: &[u32]) {
    for &hertz in hertz {
        let fed = [settings, &["controller.load_velocity_feed_forward.gain=20"]].concat();
        let (machine, linear) = (of_machine(&fed, hertz), of_loop(&fed, hertz));
        let error = apart(machine, linear);
        assert!(error < 1e-3, "{settings:?} at {hertz} Hz: {machine}, not {linear}: {error}");
        assert!(apart(of_loop(settings, hertz), linear) > 0.01, "{settings:?} at {hertz} Hz");
    }
}

#[test]
fn with_a_prescribed_load_it_is_a_path_of_its_motion() {
    let sampled = "controller.sample_time=1 ms";
    check(&[sampled], &[1, 7, 40, 150]);
    check(&[sampled, "controller.delay=1.4 ms", SENSOR, GENTLE], &[7, 40]);
    check(&["controller.sample_time=4 ms", "controller.delay=1 ms", WAVES, GENTLE], &[7, 40]);
    check(&["controller.delay=2 ms", GENTLE], &[7, 40]);
    check(&["controller.delay=2 ms", WAVES, GENTLE], &[7, 40]);
}

#[test]
fn the_reading_of_a_prescribed_velocity_is_fed_forward() {
    check_shown(&[GENTLE], 20);
    check_shown(&["controller.delay=2 ms", WAVES, GENTLE], 20);
    check_shown(&["controller.sample_time=2 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], 20);
}

#[test]
fn the_reading_of_a_yielding_velocity_is_fed_back() {
    check_shown(&[SPRUNG, GENTLE], 20);
    check_shown(&[SPRUNG, "controller.delay=2 ms", GENTLE], 20);
    check_shown(&[SPRUNG, "controller.sample_time=2 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], 20);
    check_shown(&[SPRUNG, "controller.sample_time=1 ms", "controller.delay=2 ms", WAVES, GENTLE], 20);
}

#[test]
fn with_a_yielding_load_it_is_fed_back() {
    check(&[SPRUNG, "controller.sample_time=1 ms"], &[1, 7, 20]);
    check(&[SPRUNG, "controller.sample_time=2 ms", "controller.delay=1.4 ms", SENSOR, GENTLE], &[7, 20]);
    check(&[SPRUNG, "controller.sample_time=1 ms", "controller.delay=2 ms", WAVES, GENTLE], &[7, 20]);
    check(&[SPRUNG, "controller.delay=2 ms", GENTLE], &[7, 20]);
}
