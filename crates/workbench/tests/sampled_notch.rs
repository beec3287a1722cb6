//! A notch that sampling moves is reported, and one that is held at its frequency is not moved.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::{answer, json, load, near};
use phea_dynamics::linear::Discretization;
use phea_workbench::command::Request;
use phea_workbench::engineering::setup::Setup;

/// A load cell's mode and a notch on it, sampled at three times its frequency.
const LOOP: &str = r#"
schema = 1
title = "Load cell with a notch"
[plant]
numerator = "1e6"
denominator = "s*(s^2 + 20*s + 1e6)"
[[specification]]
kind = "robust_stability"
limit = 1.5
frequencies = [1, 10, 100, 800, 1000]
[controller]
sample_time = "2 ms"
elements = [
  { kind = "gain", value = 60 },
  { kind = "notch", frequency = "1000 rad/s", damping_ratio = 0.6, numerator_damping_ratio = 0.01 },
]
"#;
const PRESERVED: &str = "controller.discretization_frequency=\"1000 rad/s\"";
const VERIFY: Request = Request::Verify { proof: false, on_machine: false };

/// Tustin's rule moves w to 2/T atan(w T/2), which makes the loop unstable and is reported; with
/// the frequency stated, or matched roots, it is stable and nothing is reported.
#[test]
fn a_moved_notch_is_reported_and_can_be_preserved() {
    let moved = answer(LOOP, &[], &[], &VERIFY);
    // ORIGIN: analytic, 1000 atan(1)
    assert!(
        moved.text().contains("moves the zero at 1000 rad/s with a damping ratio of 0.010 to 785.4 rad/s"),
        "{}",
        moved.text()
    );
    assert!(moved.text().contains("discretization_frequency = \"1000 rad/s\""));
    assert_eq!(json(LOOP, &[], &[], &VERIFY)["stable"], false);
    for preserved in [PRESERVED, "controller.discretization=\"matched\""] {
        assert!(!answer(LOOP, &[preserved], &[], &VERIFY).text().contains("moves the zero"), "{preserved}");
        assert_eq!(json(LOOP, &[preserved], &[], &VERIFY)["stable"], true, "{preserved}");
    }
    // nothing moves by more than two percent if the sample time is short compared with the notch:
    // (w T/2)^2/3
    let fast = answer(LOOP, &["controller.sample_time=\"0.4 ms\""], &[], &VERIFY);
    assert!(!fast.text().contains("moves the zero"), "{}", fast.text());
    // a frequency elsewhere moves it in the other direction
    let beyond = answer(LOOP, &["controller.discretization_frequency=\"1300 rad/s\""], &[], &VERIFY);
    assert!(beyond.text().contains("moves the zero") && beyond.text().contains("keeps one frequency alone"));
}

/// Commands use the sampled controller, whose response is that of the continuous one at the stated
/// frequency.
#[test]
fn the_response_is_preserved_at_the_stated_frequency() {
    for frequency in [200.0, 777.0, 1500.0] {
        let key = format!("controller.discretization_frequency={frequency}");
        let loaded = load(LOOP, &[&key], &[]);
        let setup = Setup::new(&loaded.project).unwrap();
        let given = setup.controller.unwrap();
        let rule = Discretization::PrewarpedTustin { frequency_rad_per_s: frequency };
        assert_eq!([given.timing.discretization, setup.timing.discretization], [rule; 2]);
        let continuous = given.feedback.transfer_function().unwrap();
        let sampled = continuous.discretized(2e-3, rule).unwrap();
        let (one, other) = (continuous.at_frequency(frequency), sampled.at_frequency(frequency));
        near(other.re, one.re, 1e-9);
        near(other.im, one.im, 1e-9);
    }
}

/// A stated frequency that cannot be preserved is rejected, or reported to have no effect.
#[test]
fn a_frequency_that_cannot_be_preserved() {
    let read = |settings: &[&str]| {
        let settings: Vec<String> = settings.iter().map(|one| one.to_string()).collect();
        phea_workbench::project::read(&crate::run_command::source(LOOP), "rig.toml", &settings, &[])
    };
    let beyond = read(&["controller.discretization_frequency=1600"]).unwrap_err().to_string();
    assert!(beyond.contains("half the sampling frequency"), "{beyond}");
    let other = read(&[PRESERVED, "controller.discretization=\"matched\""]).unwrap_err().to_string();
    assert!(other.contains("discretization = \"tustin\""), "{other}");
}
