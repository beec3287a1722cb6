//! Sampled systems compared with closed forms, and with the continuous systems that they represent.
#![cfg(test)]

use nalgebra::DMatrix;
use num_complex::Complex64;
use phea_dynamics::linear::{Discretization, LinearError, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::{cos, exp, magnitude, sin, tan};

fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

fn factored(gain: f64, zeros: &[Complex64], poles: &[Complex64]) -> TransferFunction {
    TransferFunction::from_factors(gain, zeros.to_vec(), poles.to_vec()).unwrap()
}

fn close(found: f64, truth: f64, tolerance: f64) {
    assert!((found - truth).abs() <= tolerance * truth.abs(), "{found} is not {truth}");
}

/// A force loop: slow leak, valve, resonance on the load cell.
fn loop_system() -> TransferFunction {
    let poles = [c(-0.336, 0.0), c(-989.1, 479.0), c(-989.1, -479.0), c(-11.41, 2757.0), c(-11.41, -2757.0)];
    factored(3e16, &[c(-8.0, 0.0)], &poles)
}

#[test]
fn tustin_is_the_continuous_response_at_a_warped_frequency() {
    // ORIGIN: analytic. H_d(exp(jwT)) = H(j (2/T) tan(wT/2))
    let system = loop_system();
    for step in [1e-2, 1e-3, 1e-5] {
        let sampled = system.discretized(step, Discretization::Tustin).unwrap();
        for fraction in [1e-4, 1e-2, 0.3, 0.7, 0.99] {
            let w = fraction * std::f64::consts::PI / step;
            let warped = 2.0 / step * tan(w * step / 2.0);
            let (found, truth) = (sampled.at_frequency(w), system.at_frequency(warped));
            assert!(magnitude(found - truth) < 1e-9 * magnitude(truth), "{found} {truth} at {w}");
        }
        close(sampled.dc_gain(), system.dc_gain(), 1e-10);
        assert!(sampled.is_stable());
    }
}

#[test]
fn prewarping_is_exact_at_its_frequency() {
    let system = loop_system();
    let method = Discretization::PrewarpedTustin { frequency_rad_per_s: 2757.0 };
    let sampled = system.discretized(1e-3, method).unwrap();
    let (found, truth) = (sampled.at_frequency(2757.0), system.at_frequency(2757.0));
    assert!(magnitude(found - truth) < 1e-10 * magnitude(truth));
    let beyond = Discretization::PrewarpedTustin { frequency_rad_per_s: 3200.0 };
    assert!(matches!(system.discretized(1e-3, beyond), Err(LinearError::Frequency { .. })));
}

#[test]
fn held_first_order_lag_with_dead_time() {
    // ORIGIN: analytic. a/(s + a) exp(-s tau), tau = (1 - m) T: z^-1 ((1 - e^-amT)
    // z + e^-amT - e^-aT)/(z - e^-aT)
    let (a, step, m) = (2.0, 0.25, 0.3);
    let lag = factored(a, &[], &[c(-a, 0.0)]);
    let sampled = lag.discretized(step, Discretization::ZeroOrderHold).unwrap();
    close(sampled.gain(), 1.0 - exp(-a * step), 1e-15);
    close(sampled.poles()[0].re, exp(-a * step), 1e-15);
    let late = lag.with_dead_time((1.0 - m) * step).unwrap();
    let sampled = late.discretized(step, Discretization::ZeroOrderHold).unwrap();
    close(sampled.gain(), 1.0 - exp(-a * m * step), 1e-14);
    let zero = -(exp(-a * m * step) - exp(-a * step)) / (1.0 - exp(-a * m * step));
    close(sampled.zeros()[0].re, zero, 1e-13);
    assert_eq!(sampled.poles()[0], c(0.0, 0.0));
    assert_eq!(sampled.dead_time_s(), 0.0);
    let later = late.with_dead_time((3.0 - m) * step).unwrap();
    assert_eq!(later.discretized(step, Discretization::ZeroOrderHold).unwrap().dead_time_s(), 2.0 * step);
}

#[test]
fn held_double_integrator() {
    // ORIGIN: analytic. 1/s^2 -> (T^2/2)(z + 1)/(z - 1)^2
    let step = 0.1;
    let sampled =
        factored(1.0, &[], &[c(0.0, 0.0); 2]).discretized(step, Discretization::ZeroOrderHold).unwrap();
    close(sampled.gain(), step * step / 2.0, 1e-15);
    close(sampled.zeros()[0].re, -1.0, 1e-14);
    assert_eq!(sampled.poles(), [c(1.0, 0.0), c(1.0, 0.0)]);
}

#[test]
fn held_oscillator_and_feedthrough() {
    // ORIGIN: analytic. w^2/(s^2 + w^2) -> (1 - cos wT)(z + 1)/(z^2 - 2 cos wT z + 1)
    let (w, step) = (30.0, 0.02);
    let oscillator = factored(w * w, &[], &[c(0.0, w), c(0.0, -w)]);
    let sampled = oscillator.discretized(step, Discretization::ZeroOrderHold).unwrap();
    close(sampled.gain(), 1.0 - cos(w * step), 1e-14);
    close(sampled.zeros()[0].re, -1.0, 1e-13);
    assert!(magnitude(sampled.poles()[1] - c(cos(w * step), sin(w * step))) < 1e-15);
    // feedthrough: (s + 1)/(s + 2) = 1 - 1/(s + 2)
    let lead = factored(1.0, &[c(-1.0, 0.0)], &[c(-2.0, 0.0)]);
    let sampled = lead.discretized(0.5, Discretization::ZeroOrderHold).unwrap();
    assert_eq!(sampled.gain(), 1.0);
    close(sampled.zeros()[0].re, exp(-1.0) + (1.0 - exp(-1.0)) / 2.0, 1e-15);
}

#[test]
fn holds_in_series_of_half_the_step_agree_at_low_frequency() {
    // halving the sample time moves the response towards exp(-jwT/2) P
    let system = loop_system();
    let w = 20.0;
    for step in [1e-3, 5e-4, 2.5e-4] {
        let held = system.discretized(step, Discretization::ZeroOrderHold).unwrap().at_frequency(w);
        // ORIGIN: analytic. hold: exp(-jwT/2) sinc(wT/2); the images add terms of the order of P at
        // 2 pi/T
        let x = w * step / 2.0;
        let truth = system.at_frequency(w) * c(cos(x), -sin(x)) * (sin(x) / x);
        let image = magnitude(system.at_frequency(2.0 * std::f64::consts::PI / step - w));
        assert!(magnitude(held - truth) < 2.0 * image * x + 1e-9 * magnitude(truth));
    }
}

#[test]
fn matched_maps_each_root() {
    let system = loop_system();
    let step = 1e-4;
    let sampled = system.discretized(step, Discretization::Matched).unwrap();
    assert_eq!(sampled.poles().len(), 5);
    // one finite zero, four at infinity: three go to -1, one stays
    assert_eq!(sampled.zeros().len(), 4);
    assert_eq!(sampled.zeros().iter().filter(|zero| **zero == c(-1.0, 0.0)).count(), 3);
    close(sampled.dc_gain(), system.dc_gain(), 1e-10);
    for pole in system.poles() {
        let image = c(cos(pole.im * step), sin(pole.im * step)) * exp(pole.re * step);
        assert!(sampled.poles().iter().any(|found| magnitude(found - image) < 1e-15));
    }
    // integrators and differentiators preserve their low-frequency asymptote
    let integral = factored(3.0, &[c(-4.0, 0.0)], &[c(0.0, 0.0), c(0.0, 0.0), c(-9.0, 0.0)]);
    let sampled = integral.discretized(1e-2, Discretization::Matched).unwrap();
    let w = 1e-3;
    let ratio = magnitude(sampled.at_frequency(w)) / magnitude(integral.at_frequency(w));
    close(ratio, 1.0, 1e-6);
}

#[test]
fn states_and_factors_are_sampled_alike() {
    let system = loop_system();
    let states = StateSpace::from_transfer_function(&system).unwrap();
    for method in [Discretization::Tustin, Discretization::ZeroOrderHold] {
        let (by_factors, by_states) =
            (system.discretized(1e-3, method).unwrap(), states.discretized(1e-3, method).unwrap());
        for w in [1e-2, 0.336, 20.0, 500.0, 2757.0, 3100.0] {
            let (a, b) = (by_factors.at_frequency(w), by_states.at_frequency(w, 0, 0).unwrap());
            assert!(magnitude(a - b) < 1e-9 * magnitude(a), "{method:?} at {w}: {a} {b}");
        }
        for (a, b) in by_factors.poles().iter().zip(by_states.poles().unwrap()) {
            assert!(magnitude(a - b) < 1e-11, "{method:?}: {a} {b}");
        }
    }
    let delayed = states.held_with_dead_time(1e-3, 2.4e-3).unwrap();
    let factors = system.with_dead_time(2.4e-3).unwrap();
    let factors = factors.discretized(1e-3, Discretization::ZeroOrderHold).unwrap();
    for w in [1e-2, 20.0, 2757.0] {
        let (a, b) = (factors.at_frequency(w), delayed.at_frequency(w, 0, 0).unwrap());
        assert!(magnitude(a - b) < 1e-9 * magnitude(a), "{w}: {a} {b}");
    }
}

#[test]
fn stiff_systems_keep_their_slow_pole() {
    // seven decades inside one sample: exp(-1e6) underflows, which must not affect the slow pole
    let system = factored(1e6 * 0.1, &[], &[c(-0.1, 0.0), c(-1e6, 0.0)]);
    let states = StateSpace::from_transfer_function(&system).unwrap();
    let sampled = states.discretized(1.0, Discretization::ZeroOrderHold).unwrap();
    let poles = sampled.poles().unwrap();
    close(poles[1].re, exp(-0.1), 1e-15);
    // ORIGIN: analytic. 1 - y(1) = (1e6 exp(-0.1) - 0.1 exp(-1e6))/(1e6 - 0.1)
    let first = (sampled.c() * sampled.b())[(0, 0)];
    close(first, 1.0 - 1e6 * exp(-0.1) / (1e6 - 0.1), 1e-14);
}

#[test]
fn refusals_are_typed() {
    let lag = factored(1.0, &[], &[c(-1.0, 0.0)]);
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(lag.discretized(step, Discretization::Tustin), Err(LinearError::SampleTime { .. })));
    }
    let improper = factored(1.0, &[c(-1.0, 0.0)], &[]);
    assert!(matches!(improper.discretized(1.0, Discretization::Matched), Err(LinearError::Improper { .. })));
    let unstable = factored(1.0, &[], &[c(4.0, 0.0)]);
    assert_eq!(
        unstable.discretized(0.5, Discretization::Tustin),
        Err(LinearError::NoImage { root_rad_per_s: 4.0 })
    );
    let late = lag.clone().with_dead_time(0.15).unwrap();
    assert!(matches!(
        late.discretized(0.1, Discretization::Tustin),
        Err(LinearError::FractionalDeadTime { .. })
    ));
    let sampled = lag.discretized(0.1, Discretization::Tustin).unwrap();
    assert!(matches!(sampled.discretized(0.1, Discretization::Tustin), Err(LinearError::WrongDomain { .. })));
    let scalar = |value| DMatrix::from_element(1, 1, value);
    let states = StateSpace::new(scalar(-1.0), scalar(1.0), scalar(1.0), scalar(0.0), TimeDomain::Continuous);
    assert!(matches!(
        states.unwrap().discretized(0.1, Discretization::Matched),
        Err(LinearError::WrongDomain { .. })
    ));
}
