//! Feedback of the chambers' pressures: the damping that it adds in closed form, and the interface
//! of a plant without polynomials to robust design.

#![allow(clippy::unwrap_used, reason = "helpers of tests may fail the test")]

use num_complex::Complex64;
use phea_dynamics::analytic::Disc;
use phea_dynamics::controller::{InnerFeedback, VirtualImpedance};
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::{exp_complex, pow};
use phea_dynamics::random::{stream, uniform};
use phea_dynamics::uncertain_plant::RationalCoefficients;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_hydraulics::linear::LinearParameters;
use phea_hydraulics::plant::{
    LinearElement, LinearLoad, LinearPlant, LinearSeries, LinearSpring, PlantInMotion, PressureFeedback,
    SeriesOutput,
};
use phea_hydraulics::reference_rig::nominal_plant;

use super::plant_in_motion::drawn;

fn feedback(gain: f64) -> PressureFeedback {
    PressureFeedback { filter: InnerFeedback { gain, ..InnerFeedback::default() }, ratio: 1.0 }
}

fn roots(path: &RationalCoefficients<f64>) -> Vec<Complex64> {
    let [over, under] =
        [&path.numerator, &path.denominator].map(|coefficients| Polynomial::new(coefficients.clone()));
    TransferFunction::from_polynomials(&over, &under).unwrap().poles().to_vec()
}

/// The oscillating pole w^2 = (K_S + K_H)/M is damped, for a fixed load and a fast valve, by the
/// flow K_qU k p_L, if that is small:
///
/// ```text
/// -2 Re s = f_v/M + (K_c + K_qU k) K_H^2/(A^2 (K_S + K_H))
/// ```
#[test]
fn it_damps_as_leakage_does() {
    let parameters = LinearParameters {
        valve_natural_frequency: 1e7,
        viscous_friction: 0.0,
        flow_pressure_coefficient: 0.0,
        ..nominal_plant()
    };
    let LinearParameters { useful_area, flow_gain, hydraulic_stiffness, sensor_stiffness, .. } = parameters;
    for (gain, within) in [(1e-9, 1e-4), (1e-8, 1e-3), (1e-7, 1e-2)] {
        let plain = LinearPlant::of_load_pressure(&parameters, 0.0, LinearLoad::Prescribed);
        let plant = LinearPlant { pressure_feedback: Some(feedback(gain)), ..plain };
        let swinging = roots(&plant.coefficients().command).into_iter();
        let swinging = swinging.filter(|pole| pole.im > 0.0 && pole.norm_sqr() < 1e10).collect::<Vec<_>>();
        let added = gain * flow_gain * hydraulic_stiffness * hydraulic_stiffness
            / (useful_area * useful_area * (sensor_stiffness + hydraulic_stiffness));
        assert_eq!(swinging.len(), 1);
        assert!((-2.0 * swinging[0].re / added - 1.0).abs() < within, "{gain}: {swinging:?} {added}");
    }
}

/// A high pass leaves the plant at rest unchanged; without one the valve must hold k p_L against
/// the leakage, and the gain at rest falls by the factor K_c/(K_c + K_qU k).
#[test]
fn a_high_pass_leaves_the_equilibrium_unchanged() {
    let parameters = nominal_plant();
    let plain = LinearPlant::of_load_pressure(&parameters, 0.0, LinearLoad::Prescribed);
    let at_rest = |feedback| {
        let plant = LinearPlant { pressure_feedback: feedback, ..plain };
        plant.coefficients().command.at_frequency(1e-7).re
    };
    let fixed = feedback(2e-7);
    let high = InnerFeedback { high_pass_rad_per_s: Some(20.0), ..fixed.filter };
    let passed = PressureFeedback { filter: high, ..fixed };
    assert!((at_rest(Some(passed)) / at_rest(None) - 1.0).abs() < 1e-5);
    let own = parameters.flow_pressure_coefficient;
    let expected = own / (own + parameters.flow_gain * 2e-7);
    assert!((at_rest(Some(fixed)) / at_rest(None) / expected - 1.0).abs() < 1e-5);
}

/// Feedback with either sign, with each filter or without, of any reading of the pressures.
fn any(number: u64) -> PressureFeedback {
    let mut state = stream(62, number);
    let mut spread = |low: f64, high: f64| low * pow(high / low, uniform(&mut state));
    let corners = [spread(0.1, 300.0), spread(30.0, 3e4)];
    let gain = spread(1e-8, 3e-5) * if number % 4 == 3 { -1.0 } else { 1.0 };
    let filter = InnerFeedback {
        gain,
        high_pass_rad_per_s: number.is_multiple_of(2).then_some(corners[0]),
        low_pass_rad_per_s: number.is_multiple_of(3).then_some(corners[1]),
    };
    PressureFeedback { filter, ratio: spread(0.3, 2.0) }
}

/// Feedback with a delay d is H e^(-s d) around the plant without it: the comparison with the
/// machine's derivatives is in `together`.
#[test]
fn a_delay_turns_what_is_fed_back() {
    for number in 0..24 {
        let (rig, back, delay) = (drawn(number), any(number), 2e-3);
        let plain = PlantInMotion::new(&rig.plant, &rig.behind);
        for frequency in [1.0, 30.0, 400.0, 3e3] {
            let s = Complex64::new(0.0, frequency);
            let at = |filter: InnerFeedback, delay: f64| {
                plain.fed_back(Some(PressureFeedback { filter, ..back }), delay).response(s)
            };
            // the signal by the command follows from the effect of a gain only
            let unit = InnerFeedback { gain: 1e-7, ..InnerFeedback::default() };
            let [[without_feedback, _], [with, _]] = [plain.response(s), at(unit, 0.0)];
            let signal = (without_feedback / with - 1.0) / unit.gain;
            let expected =
                without_feedback / (1.0 + back.filter.response(s) * exp_complex(-s * delay) * signal);
            let found = at(back.filter, delay)[0];
            let error = (found / expected - 1.0).norm_sqr().sqrt();
            assert!(error < 1e-6, "rig {number} at {frequency} rad/s: {error}");
        }
    }
}

/// Pressure signal that a loop around the plant samples: closed around the plant without feedback,
/// it gives the plant with the feedback inside, by command and by the motion of the load or its
/// ground, as polynomials and with lines in motion, with a series element and a virtual impedance
/// too.
#[test]
fn the_signal_closes_to_the_feedback() {
    let impedance = VirtualImpedance { stiffness: 1e5, damping: 2e3, mass: 0.0, filter_time_s: 2e-3 };
    for number in 0..72 {
        let (rig, back) = (drawn(number), any(number));
        let output =
            [SeriesOutput::Sensor, SeriesOutput::Deflection, SeriesOutput::OnLoad][number as usize % 3];
        let spring = LinearSpring { stiffness: 8e5, damping: Some(300.0), mass: Some(4.0) };
        let series = LinearSeries { element: LinearElement::Spring(spring), output };
        let plain = LinearPlant {
            series: (number % 2 == 1).then_some(series),
            virtual_impedance: (number % 4 < 2).then_some(impedance),
            ..rig.plant
        };
        let shown = LinearPlant { pressure_signal: Some(back.ratio), ..plain };
        let moving = PlantInMotion::new(&plain, &rig.behind);
        let coefficients = shown.coefficients();
        let [by_command, by_motion] =
            coefficients.rate.as_ref().unwrap().inner.clone().unwrap().map(|numerator| {
                let denominator = coefficients.command.denominator.clone();
                RationalCoefficients { numerator, denominator }
            });
        for frequency in [0.3, 10.0, 200.0, 1e3, 7e3] {
            let s = Complex64::new(0.0, frequency);
            let pairs = [
                (
                    PlantInMotion::lumped(&plain).response(s),
                    [by_command.at_frequency(frequency), by_motion.at_frequency(frequency)],
                    PlantInMotion::lumped(&plain).fed_back(Some(back), 0.0).response(s),
                ),
                (
                    moving.response(s),
                    moving.showing(Some(back.ratio)).inner(frequency),
                    moving.fed_back(Some(back), 0.0).response(s),
                ),
            ];
            for ([command, motion], [inner, pressed], within) in pairs {
                let fed = back.filter.response(s);
                let closed = command / (1.0 + fed * inner);
                let found = [closed, motion - closed * fed * pressed];
                for (found, within) in found.into_iter().zip(within) {
                    let error = (found / within - 1.0).norm_sqr().sqrt();
                    assert!(error < 1e-7, "rig {number} at {frequency} rad/s: {error}");
                }
            }
        }
    }
}

/// Unstable poles counted by the turns of the response are those of the polynomials.
#[test]
fn unstable_poles_are_those_of_the_polynomials() {
    let mut seen = [0; 3];
    for number in 0..200 {
        let plant = LinearPlant { pressure_feedback: Some(any(number)), ..drawn(number).plant };
        let poles = roots(&plant.coefficients().command);
        let fastest = poles.iter().map(|pole| pole.norm_sqr().sqrt()).fold(0.0, f64::max);
        // a pole at the edge may be of either kind
        if poles.iter().any(|pole| pole.re.abs() < 1e-9 * fastest) {
            continue;
        }
        let unstable = poles.iter().filter(|pole| pole.re > 0.0).count();
        let found = PlantInMotion::lumped(&plant).unstable_poles();
        assert_eq!(found, Some(unstable), "rig {number}: {poles:?}");
        seen[unstable.min(2)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
}

/// Enclosures of the response between two frequencies, and bounds above one, are valid.
#[test]
fn enclosure_and_roll_off_hold() {
    let mut bounded = 0;
    for number in 0..36 {
        let (rig, back) = (drawn(number), any(number));
        let [area_a, area_b] = rig.plant.chambers.areas();
        let ratio = if number.is_multiple_of(2) { area_b / area_a } else { back.ratio };
        let moving = PlantInMotion::new(&rig.plant, &rig.behind)
            .fed_back(Some(PressureFeedback { ratio, ..back }), 1e-3);
        for from in [1.0, 30.0, 400.0, 3e3, 3e4, 1e6] {
            let ends = [from, 1.01 * from];
            let disc: Disc = moving.enclosure(ends);
            for part in 0..5 {
                let frequency = from * (1.0 + 0.01 * f64::from(part) / 4.0);
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
    assert!(bounded > 15, "{bounded}");
}
