//! The linear loop and the impedance of a rig whose force is measured through a sensor.

#![allow(clippy::expect_used, clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::time_response::step_response;
use phea_workbench::engineering::linear_loop::{LoopStability, linear_loop};
use phea_workbench::engineering::linearize::linearize;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project;
use phea_workbench::source::Memory;

fn rational(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
    let polynomial = |coefficients: &[f64]| Polynomial::new(coefficients.to_vec());
    TransferFunction::from_polynomials(&polynomial(numerator), &polynomial(denominator)).unwrap()
}

/// Loop with P = 1/s, G = 2, H = 10/(s + 10): Y/R = 2 (s + 10)/(s^2 + 10 s + 20) and U/R = s Y/R.
#[test]
fn the_step_goes_around_the_sensor() {
    let feedback = Compensator::new(vec![Element::Gain(2.0)]);
    let (plant, sensor) = (rational(&[1.0], &[1.0, 0.0]), rational(&[10.0], &[1.0, 10.0]));
    let continuous = Controller { feedback: feedback.clone(), ..Controller::default() };
    let closed = linear_loop(&plant, &continuous, &sensor, 1.0).unwrap();
    assert_eq!(closed.stability, LoopStability::Stable);
    let step = closed.step.unwrap();
    let expected = step_response(&rational(&[2.0, 20.0], &[1.0, 10.0, 20.0]), &step.times_s).unwrap();
    for (found, expected) in step.response.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    assert_eq!(step.command_v_per_n[0], 2.0);

    // Sampled fast, the loop is nearly the continuous one; the sensor is held with the plant.
    let timing = Timing { sample_time_s: Some(1e-4), ..Timing::default() };
    let sampled =
        linear_loop(&plant, &Controller { feedback, timing, ..Controller::default() }, &sensor, 1.0);
    let step = sampled.unwrap().step.unwrap();
    let at = step.times_s.iter().position(|time| (time - 0.5).abs() < 5e-5).unwrap();
    let limit = step_response(&rational(&[2.0, 20.0], &[1.0, 10.0, 20.0]), &step.times_s[..=at]).unwrap();
    assert!((step.response[at] - limit[at]).abs() < 1e-3);
}

/// A sensor that lags destabilises: with P G = K/s and H = 1/(s + 1)^3 the loop lags by 180 degrees
/// at w = 1/sqrt(3), where
/// |L| = K sqrt(3) (sqrt(3)/2)^3 is one for K = 8/9.
#[test]
fn stability_is_that_of_the_loop_with_its_sensor() {
    let (plant, sensor) = (rational(&[1.0], &[1.0, 0.0]), rational(&[1.0], &[1.0, 3.0, 3.0, 1.0]));
    for (gain, stability) in [(0.88, LoopStability::Stable), (0.9, LoopStability::Unstable)] {
        let feedback = Compensator::new(vec![Element::Gain(gain)]);
        let given = Controller { feedback, ..Controller::default() };
        assert_eq!(linear_loop(&plant, &given, &sensor, 1.0).unwrap().stability, stability);
    }
}

/// Impedance Z = Z_open/(1 + P G H) at every frequency.
#[test]
fn impedance_is_closed_through_the_sensor() {
    let hose = include_str!("../../../examples/ybitu/hose.toml");
    let text = hose
        .replace("[prefilter]", "[sensor]\nnumerator = \"300\"\ndenominator = \"s + 300\"\n\n[prefilter]");
    let source = Memory::default().with("p.toml", text);
    let project = project::read(&source, "p.toml", &[], &[]).unwrap().project;
    let setup = Setup::new(&project).unwrap();
    let (given, sensor) = (setup.controller.clone().unwrap(), setup.sensor.clone());
    let linearization = linearize(setup.rig().unwrap(), Some(&given), &sensor).unwrap();
    let feedback = given.feedback.transfer_function().unwrap();
    let closed = linearization.closed_loop.unwrap().impedance;
    for frequency in [0.1, 10.0, 300.0, 2000.0] {
        let [open, p, g, h] =
            [&linearization.open_loop.impedance, &linearization.full.command, &feedback, &sensor]
                .map(|function| function.at_frequency(frequency));
        let ratio = closed.at_frequency(frequency) / (open / (1.0 + p * g * h));
        assert!(portable::magnitude(ratio - 1.0) < 1e-9, "{frequency}: {ratio}");
    }
}
