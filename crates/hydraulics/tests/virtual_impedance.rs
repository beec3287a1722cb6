//! The linear plant with a virtual impedance, y = F_e + Z_v X_L, compared with the machine's own
//! derivatives and with the separate force and motion of the load.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::analytic::Disc;
use phea_dynamics::controller::VirtualImpedance;
use phea_dynamics::portable::{exp_complex, pow};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_hydraulics::plant::{
    LinearElement, LinearPlant, LinearSeries, LinearSpring, PlantInMotion, SeriesOutput,
};

use super::plant_in_motion::drawn;

/// Spring, with a damper, with a mass, or only a mass.
fn impedance(number: u64) -> VirtualImpedance {
    let mut state = stream(61, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let (stiffness, damping, mass) = (spread(1e3, 1e7), spread(1e2, 1e5), spread(0.1, 200.0));
    let filter_time_s = spread(1e-4, 1e-1);
    let [spring, damper, heavy] = match number % 4 {
        0 => [1.0, 0.0, 0.0],
        1 => [1.0, 1.0, 0.0],
        2 => [1.0, 1.0, 1.0],
        _ => [0.0, 0.0, 1.0],
    };
    VirtualImpedance {
        stiffness: spring * stiffness,
        damping: damper * damping,
        mass: heavy * mass,
        filter_time_s,
    }
}

fn frequencies() -> impl Iterator<Item = f64> {
    (0..14).map(|step| 0.01 * pow(1e6, f64::from(step) / 13.0))
}

fn check(found: Complex64, expected: Complex64, what: &str) {
    let error = (found / expected - 1.0).norm_sqr().sqrt();
    assert!(error < 1e-7, "{what}: {error}");
}

/// Output of a rig with dynamic lines, and with the velocity of the load fed forward with a delay:
/// force and motion from the machine's derivatives.
#[test]
fn the_output_is_that_of_the_machine() {
    for number in 0..36 {
        let (rig, own_impedance) = (drawn(number), impedance(number));
        let moving = PlantInMotion::new(&rig.plant, &rig.behind).with_virtual_impedance(Some(own_impedance));
        let (fed, delay) = (25.0, 2e-3);
        let with_both = moving.fed_forward(Some(fed)).late(delay);
        for frequency in frequencies() {
            let s = Complex64::new(0.0, frequency);
            let own = own_impedance.response(s) / s;
            let [[force, velocity], [ground_force, ground_velocity]] = rig.force_and_velocity(frequency);
            let expected = [force + own * velocity, ground_force + own * ground_velocity];
            for (found, expected) in moving.response(s).into_iter().zip(expected) {
                check(found, expected, &format!("rig {number} at {frequency} rad/s"));
            }
            let late = fed * exp_complex(-s * delay);
            let command = expected[0] / (1.0 - late * velocity);
            let closed = [command, expected[1] + command * late * ground_velocity];
            for (found, expected) in with_both.response(s).into_iter().zip(closed) {
                check(found, expected, &format!("rig {number}, fed forward, at {frequency} rad/s"));
            }
        }
    }
}

/// Quotients of polynomials agree with the force and the motion of the load, with a series element
/// too; the rate remains that of the load.
#[test]
fn the_quotients_are_force_and_motion() {
    for number in 0..48 {
        let own_impedance = impedance(number);
        let output =
            [SeriesOutput::Sensor, SeriesOutput::Deflection, SeriesOutput::OnLoad][number as usize % 3];
        let spring = LinearSpring { stiffness: 8e5, damping: Some(300.0), mass: Some(4.0) };
        let series = LinearSeries { element: LinearElement::Spring(spring), output };
        let plain = LinearPlant {
            series: (number % 2 == 1).then_some(series),
            load_velocity_feed_forward: (number % 3 == 1).then_some(12.0),
            ..drawn(number).plant
        };
        let seen = LinearPlant { virtual_impedance: Some(own_impedance), ..plain }.coefficients();
        let force = plain.coefficients();
        let lumped = PlantInMotion::lumped(&plain);
        for frequency in frequencies() {
            let s = Complex64::new(0.0, frequency);
            let own = own_impedance.response(s) / s;
            let moved = lumped.load_velocity(s);
            let paths = [
                (&seen.command, &force.command, moved[0]),
                (seen.disturbance.as_ref().unwrap(), force.disturbance.as_ref().unwrap(), moved[1]),
            ];
            for (seen, force, velocity) in paths {
                let expected = force.at_frequency(frequency) + own * velocity;
                check(seen.at_frequency(frequency), expected, &format!("rig {number} at {frequency} rad/s"));
            }
        }
    }
}

/// Enclosures of the output between two frequencies, and bounds above one, are valid.
#[test]
fn enclosure_and_roll_off_hold() {
    let mut bounded = 0;
    for number in 0..36 {
        let rig = drawn(number);
        let moving =
            PlantInMotion::new(&rig.plant, &rig.behind).with_virtual_impedance(Some(impedance(number)));
        for from in [1.0, 30.0, 400.0, 3e3, 3e4] {
            let ends = [from, 1.02 * from];
            let disc: Disc = moving.enclosure(ends);
            for part in 0..5 {
                let frequency = from * (1.0 + 0.02 * f64::from(part) / 4.0);
                let [value, _] = moving.response(Complex64::new(0.0, frequency));
                assert!(disc.contains(value), "rig {number} at {frequency} rad/s");
            }
            let Some(bound) = moving.roll_off(from) else { continue };
            bounded += 1;
            for more in [1.0, 1.3, 2.0, 5.0, 20.0, 100.0] {
                let [value, _] = moving.response(Complex64::new(0.0, more * from));
                let size = value.norm_sqr().sqrt() * more * more * more;
                assert!(size <= bound * (1.0 + 1e-9), "rig {number} at {more} times {from} rad/s");
            }
        }
    }
    assert!(bounded > 30, "{bounded}");
}
