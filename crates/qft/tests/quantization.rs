//! Converters and coefficients of finite resolution against closed forms and against loops with
//! rounding.
#![cfg(test)]

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Controller, Element, Section, Timing};
use phea_dynamics::linear::{Discretization, TransferFunction};
use phea_dynamics::portable::{cos, exp, magnitude, sin};
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::design::quantization::{
    CoefficientFormat, CoefficientTooLarge, Converter, LimitCycle, Quantization, QuantizationError, rounded,
    rounding_effects,
};

const SAMPLE: f64 = 0.01;

fn controller(elements: Vec<Element>, delay_s: f64) -> Controller {
    let timing = Timing { sample_time_s: Some(SAMPLE), delay_s, ..Timing::default() };
    Controller { feedback: Compensator::new(elements), timing, ..Controller::default() }
}

fn around(controller: &Controller) -> Compensation {
    Compensation::new(controller, TransferFunction::gain_only(1.0)).unwrap()
}

fn member(compensation: &Compensation, numerator: &[f64], denominator: &[f64]) -> Member {
    let command = RationalCoefficients { numerator: numerator.to_vec(), denominator: denominator.to_vec() };
    compensation
        .member(PlantCoefficients { command, disturbance: None, dead_time_s: 0.0, rate: None })
        .unwrap()
}

fn converters(command: f64, measurement: f64) -> Quantization {
    let converter = |step: f64| Some(Converter::new(1, [-step, step]).unwrap());
    Quantization {
        command: converter(command),
        measurement: converter(measurement),
        ..Quantization::default()
    }
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{found} is not {expected}");
}

/// Plant k/s with the gain g: z - 1 + K with K = g k T, for which every sum is a geometric series.
/// One plant oscillates before it settles (K > 1).
#[test]
fn an_integrator_under_proportional_control() {
    let gain = 4.0;
    let compensation = around(&controller(vec![Element::Gain(gain)], 0.0));
    let members = [5.0, 20.0, 40.0].map(|k| member(&compensation, &[k], &[1.0, 0.0]));
    for (index, k) in [5.0, 20.0, 40.0].into_iter().enumerate() {
        let found = rounding_effects(&compensation, &members[index..=index], &converters(0.1, 0.3)).unwrap();
        let closed: f64 = gain * k * SAMPLE;
        let pole = 1.0 - closed;
        // e_u: k T p^n;   e_y to the output: -K p^n;   to the command: -g, then g K p^n
        let sum = 1.0 / (1.0 - pole.abs());
        let squares = 1.0 / (1.0 - pole * pole);
        let root12 = 12.0_f64.sqrt();
        let effect = found.force_from_command.unwrap();
        close(effect.peak, 0.05 * k * SAMPLE * sum, 1e-6);
        close(effect.rms, 0.1 / root12 * k * SAMPLE * squares.sqrt(), 1e-6);
        let effect = found.force_from_measurement.unwrap();
        close(effect.peak, 0.15 * closed * sum, 1e-6);
        close(effect.rms, 0.3 / root12 * closed * squares.sqrt(), 1e-6);
        let effect = found.command_from_measurement.unwrap();
        close(effect.peak, 0.15 * gain * (1.0 + closed * sum), 1e-6);
        close(effect.rms, 0.3 / root12 * gain * (1.0 + closed * closed * squares).sqrt(), 1e-6);
        close(found.command_steps_at_once.unwrap(), gain * 3.0, 1e-12);
        assert_eq!(found.limit_cycle, Some(LimitCycle::NotIntegrating));
    }
    let found = rounding_effects(&compensation, &members, &converters(0.1, 0.3)).unwrap();
    let (force, command) = (found.force_from_command.unwrap(), found.command_from_measurement.unwrap());
    assert_eq!((force.peak_plant, command.peak_plant, command.rms_plant), (2, 2, 2));
}

/// An error of bounded rms has at most the effect of the largest magnitude over frequency, a white
/// one no more than that, an arbitrary one of bounded size no less.
#[test]
fn sums_enclose_the_largest_magnitude() {
    let integral = Element::ProportionalIntegral { proportional_gain: 0.5, integral_gain: 1.0 };
    let compensation = around(&controller(vec![integral], 0.013));
    let member = member(&compensation, &[100.0], &[1.0, 4.0, 100.0]);
    let found =
        rounding_effects(&compensation, std::slice::from_ref(&member), &converters(1.0, 1.0)).unwrap();
    let largest = |of: &dyn Fn(Complex64, Complex64) -> Complex64| {
        let frequencies = (1..3141).map(|number| f64::from(number) * 0.1);
        let at = |frequency| {
            let plant = member.response(frequency).unwrap().plant;
            let controller = compensation.feedback().at_frequency(frequency);
            magnitude(of(plant, controller) / (1.0 + plant * controller))
        };
        frequencies.map(at).fold(0.0, f64::max)
    };
    let root12 = 12.0_f64.sqrt();
    for (effect, largest) in [
        (found.force_from_command.unwrap(), largest(&|plant, _| plant)),
        (found.force_from_measurement.unwrap(), largest(&|plant, controller| plant * controller)),
        (found.command_from_measurement.unwrap(), largest(&|_, controller| controller)),
    ] {
        assert!(2.0 * effect.peak >= largest * (1.0 - 1e-4), "{effect:?} {largest}");
        assert!(effect.rms * root12 <= largest, "{effect:?} {largest}");
        assert!(effect.peak < 50.0 * effect.rms);
    }
}

/// A lag a/(s + a) with one sample of delay under integral control, run with and without rounding:
/// output and command of every sample.
fn run(controller: &Controller, quantization: Option<&Quantization>, samples: usize) -> Vec<[f64; 2]> {
    let sampled = controller.sampled(SAMPLE).unwrap();
    let mut state = sampled.at_rest();
    let decay = exp(-5.0 * SAMPLE);
    let (mut output, mut pending) = (0.0, 0.0);
    let mut record = Vec::new();
    for sample in 0..samples {
        let reference = if sample < samples / 2 { 0.7 + 0.2 * sin(0.03 * sample as f64) } else { 0.618 };
        let (measure, act) = match quantization {
            Some(quantization) => (quantization.measurement, quantization.command),
            None => (None, None),
        };
        let measured = measure.map_or(output, |converter| converter.rounded(output));
        let command = sampled.step(&mut state, reference, measured).command;
        let command = act.map_or(command, |converter| converter.rounded(command));
        record.push([output, command]);
        output = decay * output + (1.0 - decay) * pending;
        pending = command;
    }
    record
}

fn integral_controller() -> Controller {
    controller(vec![Element::ProportionalIntegral { proportional_gain: 1.0, integral_gain: 3.0 }], SAMPLE)
}

/// The loop with rounding deviates from the one without by no more than the peaks, and by enough to
/// show that they are not far too large.
#[test]
fn a_loop_that_rounds_stays_within_the_peaks() {
    let controller = integral_controller();
    let compensation = around(&controller);
    let member = member(&compensation, &[5.0], &[1.0, 5.0]);
    let range = [-4.0, 4.0];
    for (command, measurement) in [(Some(8), None), (None, Some(8)), (Some(8), Some(10)), (Some(12), Some(7))]
    {
        let converter = |bits: Option<u32>| bits.map(|bits| Converter::new(bits, range).unwrap());
        let quantization = Quantization {
            command: converter(command),
            measurement: converter(measurement),
            ..Quantization::default()
        };
        let found = rounding_effects(&compensation, std::slice::from_ref(&member), &quantization).unwrap();
        let peak = [found.force_from_command, found.force_from_measurement]
            .iter()
            .map(|effect| effect.map_or(0.0, |effect| effect.peak))
            .sum::<f64>();
        let (exact, rounds) = (run(&controller, None, 4000), run(&controller, Some(&quantization), 4000));
        let off = exact.iter().zip(&rounds).map(|(one, other)| (one[0] - other[0]).abs()).fold(0.0, f64::max);
        assert!(
            off <= peak * (1.0 + 1e-6) && off > 0.05 * peak,
            "{command:?} {measurement:?}: {off} of {peak}"
        );
    }
}

/// A command finer than the measurement lets the loop come to rest; with a coarser one it
/// alternates between two levels indefinitely.
#[test]
fn a_coarse_command_makes_a_limit_cycle() {
    let controller = integral_controller();
    let compensation = around(&controller);
    let member = member(&compensation, &[5.0], &[1.0, 5.0]);
    for (command, measurement, rests) in [(12, 10, true), (9, 12, false)] {
        let quantization = Quantization {
            command: Some(Converter::new(command, [-4.0, 4.0]).unwrap()),
            measurement: Some(Converter::new(measurement, [-4.0, 4.0]).unwrap()),
            ..Quantization::default()
        };
        let found = rounding_effects(&compensation, std::slice::from_ref(&member), &quantization)
            .unwrap()
            .limit_cycle;
        let steps = [quantization.command.unwrap().step(), quantization.measurement.unwrap().step()];
        let (rest_step, measurement_step, can_rest) = match found.unwrap() {
            LimitCycle::CanRest { rest_step, measurement_step } => (rest_step, measurement_step, true),
            LimitCycle::Expected { plant: 0, rest_step, measurement_step } => {
                (rest_step, measurement_step, false)
            }
            other => panic!("{other:?}"),
        };
        assert_eq!(can_rest, rests);
        close(rest_step, steps[0], 1e-12);
        close(measurement_step, steps[1], 1e-15);
        let commands = settled_commands(&controller, &quantization);
        assert_eq!(commands.windows(2).all(|pair| pair[0] == pair[1]), rests, "{command} {measurement}");
    }
}

/// Last commands of a loop whose reference is a level of the measurement, between two levels of a
/// coarse command.
fn settled_commands(controller: &Controller, quantization: &Quantization) -> Vec<f64> {
    let sampled = controller.sampled(SAMPLE).unwrap();
    let mut state = sampled.at_rest();
    let decay = exp(-5.0 * SAMPLE);
    let (mut output, mut pending) = (0.0, 0.0);
    let (measure, act) = (quantization.measurement.unwrap(), quantization.command.unwrap());
    let reference = measure.rounded(0.6155);
    let mut commands = Vec::new();
    for _ in 0..20_000 {
        let command = act.rounded(sampled.step(&mut state, reference, measure.rounded(output)).command);
        commands.push(command);
        output = decay * output + (1.0 - decay) * pending;
        pending = command;
    }
    commands.split_off(15_000)
}

/// Single precision would move the integrator of (z - 1)(z - p): 1 + p and p are not rounded alike.
/// A rounded integrator remains one, and the limit of the loop at zero frequency is unchanged.
#[test]
fn an_integrator_remains_an_integrator() {
    for frequency in [3.0, 11.0, 70.0, 500.0] {
        let elements = vec![Element::Integrator, Element::Gain(2.0), Element::RealPole { frequency }];
        let controller = controller(elements, 0.0);
        let fixed = CoefficientFormat::Fixed { integer_bits: 2, fraction_bits: 20 };
        for format in [CoefficientFormat::Single, fixed] {
            let found = rounded(&controller, format).unwrap();
            let [a1, a2] = found.feedback.last().unwrap().denominator;
            assert_eq!(1.0 + a1 + a2, 0.0, "{frequency} {format:?}");
            assert_eq!((format.rounded(a1), format.rounded(a2)), (Ok(a1), Ok(a2)));
            let compensation = around(&found.controller);
            assert!(compensation.feedback().poles().contains(&Complex64::new(1.0, 0.0)));
        }
    }
    // rounded coefficient by coefficient it would have moved
    let satisfied_at = |frequency| {
        let controller = controller(vec![Element::Integrator, Element::RealPole { frequency }], 0.0);
        let [a1, a2] = Section::in_series(around(&controller).feedback()).unwrap()[0].denominator;
        1.0 + f64::from(a1 as f32) + f64::from(a2 as f32) == 0.0
    };
    assert!(!(satisfied_at(3.0) && satisfied_at(11.0) && satisfied_at(70.0)));
}

/// The audited controller has the response of the deployed sections, and more bits bring it closer
/// to the controller designed.
#[test]
fn the_verified_controller_is_the_deployed_one() {
    let elements = vec![
        Element::ProportionalIntegral { proportional_gain: 0.3, integral_gain: 0.7 },
        Element::Notch { natural_frequency: 60.0, zero_damping_ratio: 0.05, pole_damping_ratio: 0.7 },
        Element::RealPole { frequency: 150.0 },
        Element::ComplexPoles { natural_frequency: 100.0, damping_ratio: 0.5 },
    ];
    for discretization in [Discretization::Tustin, Discretization::ZeroOrderHold, Discretization::Matched] {
        let mut controller = controller(elements.clone(), 0.004);
        controller.timing.discretization = discretization;
        controller.prefilter = Compensator::new(vec![Element::RealPole { frequency: 20.0 }]);
        let designed = around(&controller);
        let mut last = f64::INFINITY;
        for fraction_bits in [12, 16, 20, 24, 28] {
            let format = CoefficientFormat::Fixed { integer_bits: 3, fraction_bits };
            let found = rounded(&controller, format).unwrap();
            let audited = around(&found.controller);
            let (mut off, mut largest) = (0.0_f64, 0.0_f64);
            for number in 1..=100 {
                let frequency = 3.1 * f64::from(number);
                let angle = frequency * SAMPLE;
                let back = Complex64::new(cos(angle), -sin(angle));
                let run = |sections: &[Section]| {
                    sections.iter().fold(Complex64::new(1.0, 0.0), |product, section| {
                        let ([b0, b1, b2], [a1, a2]) = (section.numerator, section.denominator);
                        product * (b0 + b1 * back + b2 * back * back) / (1.0 + a1 * back + a2 * back * back)
                    })
                };
                let response = audited.response(frequency);
                let before = designed.response(frequency);
                for (sections, audited) in
                    [(&found.feedback, response.feedback), (&found.prefilter, response.prefilter)]
                {
                    let run = run(sections);
                    assert!(magnitude(run - audited) <= 1e-9 * magnitude(audited), "{run} {audited}");
                }
                off = off.max(magnitude(response.feedback - before.feedback));
                largest = largest.max(magnitude(before.feedback));
            }
            assert!(off < last && off > 0.0, "{fraction_bits}: {off} after {last}");
            last = off;
            let ratio = audited.prefilter().dc_gain() / designed.prefilter().dc_gain();
            assert!((ratio - 1.0).abs() < 20.0 * exp(-0.693 * f64::from(fraction_bits)));
            if fraction_bits == 28 {
                assert!(off < 1e-6 * largest, "{off} of {largest}");
            }
        }
    }
}

#[test]
fn impossible_requests_are_refused() {
    for (bits, range) in [(0, [0.0, 1.0]), (33, [0.0, 1.0]), (8, [1.0, 1.0]), (8, [0.0, f64::INFINITY])] {
        assert!(Converter::new(bits, range).is_err());
    }
    // ORIGIN: analytic, 2^32 levels
    let full = Converter::new(32, [0.0, 1.0]).unwrap();
    assert_eq!((full.step(), full.rounded(7.0)), (1.0 / 4_294_967_296.0, 1.0));
    let small = CoefficientFormat::Fixed { integer_bits: 0, fraction_bits: 8 };
    let gain = |gain| controller(vec![Element::Gain(gain)], 0.0);
    assert_eq!(rounded(&gain(1e-3), small), Err(QuantizationError::Vanished([1e-3, 0.0, 0.0])));
    assert_eq!(
        rounded(&gain(2.0), small),
        Err(QuantizationError::from(CoefficientTooLarge { value: 2.0, largest: 1.0 - 1.0 / 256.0 }))
    );
    assert!(rounded(&gain(1e39), CoefficientFormat::Single).is_err());
    let continuous = Controller::default();
    assert_eq!(rounded(&continuous, small), Err(QuantizationError::Continuous));
    let compensation = around(&continuous);
    let plant = member(&compensation, &[1.0], &[1.0, 1.0]);
    let found = rounding_effects(&compensation, &[plant], &converters(1.0, 1.0));
    assert_eq!(found, Err(QuantizationError::Continuous));
    // unstable: 1.1 of the limit
    let unstable = around(&gain(2.2 / SAMPLE));
    let plant = member(&unstable, &[1.0], &[1.0, 0.0]);
    let found = rounding_effects(&unstable, &[plant], &converters(1.0, 1.0));
    assert!(matches!(found, Err(QuantizationError::NotSettled { plant: 0, .. })));
}
