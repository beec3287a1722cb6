//! A measured load velocity that is fed forward, compared with the machine's own derivatives.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::controller::RateFilter;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::portable::{exp_complex, pow};
use phea_hydraulics::impedance::closed_loop_port;
use phea_hydraulics::plant::{
    LinearElement, LinearLoad, LinearPlant, LinearSeries, LinearSpring, PlantInMotion, SeriesOutput,
    VelocitySensor,
};

use super::plant_in_motion::drawn;

/// A filter, a gain error and a delay of the measured velocity: the machine's own derivatives with
/// K_x (1 + e) H_v e^(-s tau), with lines in motion; with lumped lines and without delay the
/// quotient of polynomials, which without error equals that without sensor.
#[test]
fn a_measured_feed_forward_is_the_machine_with_its_sensor_reading() {
    for number in 0..36 {
        let rig = drawn(number);
        let (fed, error) = (25.0, -0.3 + 0.6 * number as f64 / 35.0);
        let frequency_rad_per_s = 10.0 * pow(300.0, number as f64 / 35.0);
        let filter = match number % 3 {
            0 => RateFilter::FirstOrder { frequency_rad_per_s },
            _ => RateFilter::SecondOrder {
                frequency_rad_per_s,
                damping_ratio: 0.2 * (number % 7) as f64 + 0.1,
            },
        };
        let delay = if number % 2 == 0 { 2e-3 } else { 0.0 };
        let shown = VelocitySensor { gain: Some(1.0 + error), ..VelocitySensor::default() };
        let plant = LinearPlant { velocity_sensor: shown, ..rig.plant };
        let moving =
            PlantInMotion::new(&plant, &rig.behind).fed_forward(Some(fed)).filtered(filter).late(delay);
        let within = VelocitySensor { filter, ..shown };
        let rational =
            LinearPlant { velocity_sensor: within, load_velocity_feed_forward: Some(fed), ..plant };
        let (rational, without_sensor) = (rational.coefficients(), rig.plant.coefficients());
        let lumped = PlantInMotion::lumped(&rig.plant);
        for step in 0..14 {
            let frequency = 0.01 * pow(1e6, f64::from(step) / 13.0);
            let s = Complex64::new(0.0, frequency);
            let at_once = fed * (1.0 + error) * filter.response(s);
            let late = at_once * exp_complex(-s * delay);
            let closed = |gain: Complex64,
                          [force, ground]: [Complex64; 2],
                          [by_command, by_ground]: [Complex64; 2]| {
                let command = force / (1.0 - gain * by_command);
                [command, ground + command * gain * by_ground]
            };
            let [[force, velocity], [ground_force, ground_velocity]] = rig.force_and_velocity(frequency);
            let expected = closed(late, [force, ground_force], [velocity, ground_velocity]);
            let quotients = [&without_sensor.command, without_sensor.disturbance.as_ref().unwrap()]
                .map(|path| path.at_frequency(frequency));
            let of_quotients = closed(at_once, quotients, lumped.load_velocity(s));
            let found_response = [&rational.command, rational.disturbance.as_ref().unwrap()]
                .map(|path| path.at_frequency(frequency));
            let pairs = moving
                .response(s)
                .into_iter()
                .zip(expected)
                .chain(found_response.into_iter().zip(of_quotients));
            for (found_response, expected) in pairs {
                let error = (found_response / expected - 1.0).norm_sqr().sqrt();
                assert!(error < 1e-7, "rig {number} at {frequency} rad/s: {error}");
            }
        }
    }
    let plant = LinearPlant { load_velocity_feed_forward: Some(20.0), ..drawn(1).plant };
    let exact = VelocitySensor { gain: Some(1.0), ..VelocitySensor::default() };
    let shown = LinearPlant { velocity_sensor: exact, ..plant }.coefficients();
    assert_eq!(
        (shown.command, shown.disturbance),
        (plant.coefficients().command, plant.coefficients().disturbance)
    );
}

/// Closed over the force, the impedance at the load is the quotient of its own paths, with the
/// filter of the velocity that is fed forward, with and without a spring and a mass on the rod.
#[test]
fn the_closed_impedance_has_the_filter_once() {
    let zero = Complex64::new(0.0, 0.0);
    let law = TransferFunction::from_factors(1e-4, vec![Complex64::new(-8.0, 0.0)], vec![zero]).unwrap();
    let filter = RateFilter::SecondOrder { frequency_rad_per_s: 800.0, damping_ratio: 0.7 };
    let spring = LinearSpring { stiffness: 2e6, damping: Some(500.0), mass: Some(2.0) };
    let spring = |output| LinearSeries { element: LinearElement::Spring(spring), output };
    for number in 0..12 {
        let plant = LinearPlant {
            load: LinearLoad::Prescribed,
            series: (number % 2 == 0).then(|| spring(SeriesOutput::Sensor)),
            velocity_sensor: VelocitySensor { gain: Some(0.9), filter },
            load_velocity_feed_forward: Some(25.0),
            ..drawn(number).plant
        };
        let found = closed_loop_port(&plant, &law).unwrap();
        let on_load = LinearPlant { series: plant.series.map(|_| spring(SeriesOutput::OnLoad)), ..plant };
        let (measured, felt) = (plant.coefficients(), on_load.coefficients());
        for step in 0..14 {
            let frequency = 0.1 * pow(1e4, f64::from(step) / 13.0);
            let (s, law) = (Complex64::new(0.0, frequency), law.at_frequency(frequency));
            let by_command = felt.command.at_frequency(frequency);
            let by_motion = felt.disturbance.as_ref().unwrap().at_frequency(frequency);
            let shaken = plant.series.map_or(zero, |_| law * 2.0 * s * s * by_command);
            let loop_gain = law * measured.command.at_frequency(frequency);
            let expected = -(by_motion - shaken) / (s * (1.0 + loop_gain));
            let error = (found.at_frequency(frequency) / expected - 1.0).norm_sqr();
            assert!(error < 1e-12, "{number} at {frequency}: {error}");
        }
    }
}
