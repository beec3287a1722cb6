//! Requirements of the sampled controller: it follows its transfer function, and recovers from its
//! limit.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::controller::{AntiWindup, Compensator, Controller, Element, SampledController, Timing};
use phea_dynamics::linear::{Discretization, TimeDomain, TransferFunction};
use phea_dynamics::portable::{cos, magnitude, sin};

fn controller(elements: Vec<Element>, discretization: Discretization) -> Controller {
    let timing = Timing { discretization, ..Timing::default() };
    Controller { feedback: Compensator::new(elements), timing, ..Controller::default() }
}

/// Steady response to a sampled cosine, after `settle` samples: the complex amplitude over one
/// period.
fn measured_response(sampled: &SampledController, period: usize, settle: usize) -> Complex64 {
    let mut state = sampled.at_rest();
    let turn = 2.0 * PI / period as f64;
    let mut amplitude = Complex64::new(0.0, 0.0);
    for sample in 0..settle + period {
        let angle = turn * (sample % period) as f64;
        let command = sampled.step(&mut state, cos(angle), 0.0).command;
        if sample >= settle {
            amplitude += command * Complex64::new(cos(angle), -sin(angle)) * 2.0 / period as f64;
        }
    }
    amplitude
}

/// Response of the difference equations compared with the sampled transfer function, independent of
/// the construction of the sections.
#[test]
fn the_running_controller_has_the_response_of_its_transfer_function() {
    let shaped = vec![
        Element::Gain(3.0),
        Element::LeadLag { zero_frequency: 20.0, pole_frequency: 200.0 },
        Element::Notch { natural_frequency: 60.0, zero_damping_ratio: 0.05, pole_damping_ratio: 0.7 },
        Element::RealPole { frequency: 90.0 },
        Element::ComplexPoles { natural_frequency: 300.0, damping_ratio: 0.4 },
    ];
    let sample_time_s = 1e-3;
    for method in [Discretization::Tustin, Discretization::ZeroOrderHold, Discretization::Matched] {
        let controller = controller(shaped.clone(), method);
        let function =
            controller.feedback.transfer_function().unwrap().discretized(sample_time_s, method).unwrap();
        let sampled = controller.sampled(sample_time_s).unwrap();
        for period in [20, 125, 800] {
            let expected = function.at_frequency(2.0 * PI / (period as f64 * sample_time_s));
            // 8000 samples: whole periods, and long enough for the slowest pole (20 rad/s) to have
            // died away.
            let measured = measured_response(&sampled, period, 8000);
            let error = magnitude(measured - expected) / magnitude(expected);
            assert!(error < 1e-9, "{method:?}, period {period}: {measured} for {expected}");
        }
    }
}

#[test]
fn a_sampled_compensator_is_used_unchanged_and_refused_at_another_sample_time() {
    let pole = vec![Complex64::new(0.5, 0.0)];
    let domain = TimeDomain::Discrete { sample_time_s: 0.01 };
    let function = TransferFunction::from_factors(0.5, vec![], pole).unwrap().in_domain(domain).unwrap();
    let controller = controller(vec![Element::General(function)], Discretization::Tustin);
    let sampled = controller.sampled(0.01).unwrap();
    let mut state = sampled.at_rest();
    // ORIGIN: analytic, 0.5/(z - 0.5) responds to a step with 0, 1/2, 3/4, 7/8
    let answers = [1.0; 4].map(|reference| sampled.step(&mut state, reference, 0.0).command);
    assert_eq!(answers, [0.0, 0.5, 0.75, 0.875]);
    assert!(controller.sampled(0.02).is_err());
}

#[test]
fn an_improper_compensator_cannot_run() {
    let advance = TransferFunction::from_factors(1.0, vec![Complex64::new(0.5, 0.0)], vec![]).unwrap();
    let advance = advance.in_domain(TimeDomain::Discrete { sample_time_s: 0.01 }).unwrap();
    assert!(controller(vec![Element::General(advance)], Discretization::Tustin).sampled(0.01).is_err());
}

/// Samples that an integrating controller needs to leave its limit after the error has changed
/// sign.
fn samples_to_unwind(anti_windup: AntiWindup) -> usize {
    let elements = vec![Element::ProportionalIntegral { proportional_gain: 0.1, integral_gain: 1.0 }];
    let limited =
        Controller { anti_windup, command_limit: Some(1.0), ..controller(elements, Discretization::Tustin) };
    let sampled = limited.sampled(0.01).unwrap();
    let mut state = sampled.at_rest();
    for _ in 0..1000 {
        let output = sampled.step(&mut state, 1.0, 0.0);
        assert!(output.command <= 1.0);
    }
    (0..2000).find(|_| !sampled.step(&mut state, -1.0, 0.0).limited).unwrap()
}

/// Ten seconds at an error of one take the integral to 10; without anti-windup it takes nine
/// seconds to bring it back.
#[test]
fn anti_windup_leaves_the_limit_at_once() {
    // ORIGIN: analytic, 10 - 0.1 - t = 1 at t = 8.9 s
    let wound_up = samples_to_unwind(AntiWindup::None);
    assert!((885..895).contains(&wound_up), "{wound_up}");
    assert!(samples_to_unwind(AntiWindup::BackCalculation) <= 1);
    assert!(samples_to_unwind(AntiWindup::Clamping) <= 1);
}

#[test]
fn the_prefilter_acts_on_the_reference_only() {
    let unit = Controller {
        feedback: Compensator::new(vec![Element::Gain(2.0)]),
        prefilter: Compensator::new(vec![Element::Gain(0.5)]),
        ..Controller::default()
    };
    let sampled = unit.sampled(1e-3).unwrap();
    let output = sampled.step(&mut sampled.at_rest(), 8.0, 1.0);
    assert_eq!((output.filtered_reference, output.command, output.limited), (4.0, 6.0, false));
}
