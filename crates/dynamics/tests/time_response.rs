//! Responses in time compared with closed forms, step metrics, second-order specifications and
//! their inverse.
#![cfg(test)]

use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, StateSpace, TimeDomain, TransferFunction};
use phea_dynamics::portable::{cos, exp, ln, pow, sin};
use phea_dynamics::time_response::{
    Interpolation, SampledSignal, SecondOrder, Settling, SettlingRule, StepBaseline, TimeResponseError,
    damping_ratio_from_overshoot, delayed_loop_step, forced_response, forced_response_of_states,
    sampled_loop_step, step_metrics, step_response, uniform_times,
};

fn c(re: f64, im: f64) -> Complex64 {
    Complex64::new(re, im)
}

fn factored(gain: f64, zeros: &[Complex64], poles: &[Complex64]) -> TransferFunction {
    TransferFunction::from_factors(gain, zeros.to_vec(), poles.to_vec()).unwrap()
}

fn close(found: f64, truth: f64, tolerance: f64) {
    assert!((found - truth).abs() <= tolerance * truth.abs(), "{found} is not {truth}");
}

#[test]
fn real_poles_over_six_decades() {
    // ORIGIN: analytic. Partial fractions of prod p_i/(s + p_i): y = 1 - sum w_i exp(-p_i t)
    let rates: [f64; 4] = [1e-2, 1.0, 1e2, 1e4];
    let poles: Vec<Complex64> = rates.iter().map(|rate| c(-rate, 0.0)).collect();
    let system = factored(rates.iter().product(), &[], &poles);
    for duration in [1e-3, 1.0, 1e3] {
        let times = uniform_times(duration, 501).unwrap();
        let values = step_response(&system, &times).unwrap();
        for (time, value) in times.iter().zip(values) {
            let mut truth = 1.0;
            for rate in rates {
                let others = rates.iter().filter(|other| **other != rate);
                let weight: f64 = others.map(|other| other / (other - rate)).product();
                truth -= weight * exp(-rate * time);
            }
            assert!((value - truth).abs() < 1e-13, "{value} {truth} at {time} s");
        }
    }
}

#[test]
fn an_integrator_next_to_a_resonance() {
    // ORIGIN: analytic. w^2/(s (s^2 + w^2)): y = t - sin(wt)/w, here a thousand periods
    let w = 2938.0;
    let system = factored(w * w, &[], &[c(0.0, 0.0), c(0.0, w), c(0.0, -w)]);
    let times = uniform_times(2.0, 4001).unwrap();
    for (time, value) in times.iter().zip(step_response(&system, &times).unwrap()) {
        assert!((value - (time - sin(w * time) / w)).abs() < 1e-12);
    }
}

#[test]
fn repeated_poles_and_zeros() {
    // ORIGIN: analytic. (1 - s)/(s + 1)^3: y = 1 - exp(-t)(1 + t + t^2)
    let system = factored(-1.0, &[c(1.0, 0.0)], &[c(-1.0, 0.0); 3]);
    let times = uniform_times(20.0, 201).unwrap();
    for (t, value) in times.iter().zip(step_response(&system, &times).unwrap()) {
        assert!((value - (1.0 - exp(-t) * (1.0 + t + t * t))).abs() < 1e-14);
    }
}

#[test]
fn a_ramp_and_a_staircase_are_exact() {
    // ORIGIN: analytic. 1/(s + 1) to a ramp from 1 s: y = (t - 1) - 1 + exp(-(t - 1))
    let lag = factored(1.0, &[], &[c(-1.0, 0.0)]);
    let ramp = SampledSignal::new(vec![1.0, 4.0], vec![0.0, 3.0], Interpolation::Linear).unwrap();
    let times = [0.0, 0.5, 1.0, 1.7, 2.0, 4.0, 7.5];
    for (time, value) in times.iter().zip(forced_response(&lag, &ramp, &times).unwrap()) {
        let since = (time - 1.0).clamp(0.0, 3.0);
        let at_end = since - 1.0 + exp(-since);
        let truth = 3.0 + (at_end - 3.0) * exp(-(time - 4.0).max(0.0));
        let truth = if *time > 4.0 { truth } else { at_end };
        assert!((value - truth).abs() < 1e-15, "{value} {truth} at {time}");
    }
    // a staircase is a sum of late steps, whatever the output times
    let heights = [1.0, -2.0, 0.5];
    let starts = [0.1, 0.35, 1.234_567];
    let levels = vec![1.0, -1.0, -0.5];
    let stairs = SampledSignal::new(starts.to_vec(), levels, Interpolation::Hold).unwrap();
    let times: Vec<f64> = (0..200).map(|k| 0.017 * f64::from(k)).collect();
    for (time, value) in times.iter().zip(forced_response(&lag, &stairs, &times).unwrap()) {
        let step = |start: f64| if *time > start { 1.0 - exp(-(time - start)) } else { 0.0 };
        let truth: f64 = heights.iter().zip(starts).map(|(height, start)| height * step(start)).sum();
        assert!((value - truth).abs() < 1e-14);
    }
}

#[test]
fn dead_time_shifts_the_response() {
    let system = factored(50.0, &[c(-3.0, 0.0)], &[c(-2.0, 7.0), c(-2.0, -7.0), c(-30.0, 0.0)]);
    let late = system.clone().with_dead_time(0.123_456).unwrap();
    let times = uniform_times(3.0, 301).unwrap();
    let shifted: Vec<f64> = times.iter().map(|time| time + 0.123_456).collect();
    let (first, second) = (step_response(&system, &times).unwrap(), step_response(&late, &shifted).unwrap());
    for (a, b) in first.iter().zip(second) {
        assert!((a - b).abs() < 1e-12);
    }
}

#[test]
fn initial_states_and_several_inputs() {
    // an oscillator released at one, pushed by a second input
    let system = StateSpace::new(
        DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -4.0, 0.0]),
        DMatrix::from_row_slice(2, 2, &[0.0, 0.0, 1.0, 4.0]),
        DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.0]),
        DMatrix::zeros(2, 2),
        TimeDomain::Continuous,
    )
    .unwrap();
    let inputs = [SampledSignal::step(0.0), SampledSignal::step(0.5)];
    let start = DVector::from_vec(vec![1.0, 0.0]);
    let times = [0.0, 0.3, 5.0, 100.0];
    let outputs = forced_response_of_states(&system, &start, &inputs, &times).unwrap();
    for (time, output) in times.iter().zip(outputs) {
        // ORIGIN: analytic. x = 1/2 + cos(2t)/2
        assert!((output[0] - 0.5 - 0.5 * cos(2.0 * time)).abs() < 1e-13);
        assert!((output[1] + sin(2.0 * time)).abs() < 1e-13);
    }
}

#[test]
fn a_sampled_system_steps_at_its_instants() {
    // y(k+1) = 0.5 y(k) + u(k): 1 - 0.5^k, times two
    let system =
        factored(1.0, &[], &[c(0.5, 0.0)]).in_domain(TimeDomain::Discrete { sample_time_s: 0.1 }).unwrap();
    let times: Vec<f64> = (0..40).map(|k| 0.05 * f64::from(k)).collect();
    for (index, value) in step_response(&system, &times).unwrap().iter().enumerate() {
        close(1.0 - value / 2.0, pow(0.5, (index / 2) as f64), 1e-15);
    }
    let late = system.with_dead_time(0.3).unwrap();
    assert_eq!(step_response(&late, &[0.3, 0.4, 0.5]), Ok(vec![0.0, 1.0, 1.5]));
}

#[test]
fn the_zero_order_hold_passes_through_the_samples() {
    use phea_dynamics::linear::Discretization;
    let system = factored(
        4e8,
        &[c(-40.0, 0.0)],
        &[c(-0.5, 0.0), c(-3.0, 0.0), c(-100.0, 2000.0), c(-100.0, -2000.0), c(-30.0, 0.0)],
    );
    for dead_time in [0.0, 2e-3, 3.7e-4, 2.37e-3] {
        let late = system.clone().with_dead_time(dead_time).unwrap();
        let sampled = late.discretized(1e-3, Discretization::ZeroOrderHold).unwrap();
        let times: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        let (exact, held) = (step_response(&late, &times).unwrap(), step_response(&sampled, &times).unwrap());
        let size = exact.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        for (a, b) in exact.iter().zip(held) {
            assert!((a - b).abs() < 1e-10 * size, "{a} {b} with dead time {dead_time}");
        }
    }
}

#[test]
fn metrics_of_a_second_order_step() {
    let times = uniform_times(8.0, 80_001).unwrap();
    for ratio in [0.2, 0.5, 0.7, 0.9] {
        let model = SecondOrder::new(5.0, ratio).unwrap();
        let values = step_response(&model.transfer_function(), &times).unwrap();
        let deviation = |(time, value): (&f64, &f64)| (value - model.step_value(*time)).abs();
        let worst = times.iter().zip(&values).map(deviation).fold(0.0, f64::max);
        assert!(worst < 1e-13, "{worst:e}");
        for band in [1.0, 2.0, 5.0] {
            let metrics = step_metrics(&times, &values, StepBaseline::unit(), band).unwrap();
            close(metrics.overshoot_percent, model.overshoot_percent(), 1e-4);
            close(metrics.peak_time_s, model.peak_time_s().unwrap(), 1e-3);
            assert_eq!(metrics.settling_band_percent, band);
            let exact = model.settling_time_s(band).unwrap().unwrap();
            let found = metrics.settling.time_s().unwrap();
            assert!((found - exact).abs() <= 1e-4, "{ratio} {band}: {found} {exact}");
        }
    }
}

#[test]
fn baselines_and_falling_steps() {
    let times = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    // a step from 4 kN down to 1 kN at 1 s, with undershoot first and overshoot after
    let values = [4.0, 4.0, 4.3, 0.7, 1.0, 1.0];
    let baseline = StepBaseline { step_time_s: 1.0, initial_value: 4.0, final_value: 1.0 };
    let metrics = step_metrics(&times, &values, baseline, 2.0).unwrap();
    close(metrics.overshoot_percent, 10.0, 1e-14);
    assert_eq!((metrics.peak_value, metrics.peak_time_s), (0.7, 2.0));
    close(metrics.settling.time_s().unwrap(), 2.8, 1e-14);
    // these samples never settle to another final value
    let elsewhere = StepBaseline { final_value: 0.5, ..baseline };
    let metrics = step_metrics(&times, &values, elsewhere, 2.0).unwrap();
    assert!(
        matches!(metrics.settling, Settling::NotSettled { deviation_percent } if deviation_percent > 14.0)
    );
    assert_eq!(metrics.overshoot_percent, 0.0);
}

#[test]
fn refusals_are_typed() {
    use TimeResponseError::{Count, Linear, NoStep, OutOfRange, TimeOrder};
    let lag = factored(1.0, &[], &[c(-1.0, 0.0)]);
    assert!(matches!(step_response(&lag, &[0.0, 2.0, 1.0]), Err(TimeOrder { index: 2, .. })));
    assert!(matches!(step_response(&lag, &[-1.0]), Err(TimeOrder { index: 0, .. })));
    assert!(matches!(step_response(&lag, &[f64::NAN]), Err(TimeOrder { .. })));
    assert_eq!(step_response(&lag, &[]), Ok(vec![]));
    let derivative = factored(1.0, &[c(0.0, 0.0)], &[]);
    assert!(matches!(step_response(&derivative, &[0.0]), Err(Linear(LinearError::Improper { .. }))));
    let (times, values) = ([0.0, 1.0], [0.0, 1.0]);
    assert!(matches!(step_metrics(&times, &values[..1], StepBaseline::unit(), 2.0), Err(Count { .. })));
    assert!(matches!(step_metrics(&[], &[], StepBaseline::unit(), 2.0), Err(Count { .. })));
    assert!(matches!(step_metrics(&times, &values, StepBaseline::to_value(0.0), 2.0), Err(NoStep { .. })));
    for band in [0.0, -1.0, 100.0, f64::NAN] {
        assert!(matches!(step_metrics(&times, &values, StepBaseline::unit(), band), Err(OutOfRange { .. })));
        assert!(matches!(SecondOrder::new(1.0, 0.5).unwrap().settling_time_s(band), Err(OutOfRange { .. })));
    }
    assert!(matches!(SecondOrder::new(0.0, 0.5), Err(OutOfRange { .. })));
    assert!(matches!(SecondOrder::new(1.0, -0.1), Err(OutOfRange { .. })));
    for overshoot in [-1.0, 100.0, f64::NAN] {
        assert!(matches!(damping_ratio_from_overshoot(overshoot), Err(OutOfRange { .. })));
    }
    let unsorted = SampledSignal::new(vec![1.0, 1.0], vec![0.0, 0.0], Interpolation::Hold);
    assert!(matches!(unsorted, Err(TimeOrder { index: 1, .. })));
    assert!(matches!(SampledSignal::new(vec![1.0], vec![], Interpolation::Hold), Err(Count { .. })));
}

#[test]
fn specification_formulas() {
    // ORIGIN: thesis (3.6), (3.8); (3.7) and (3.9) corrected, against the response itself
    for ratio in [0.05, 0.3, 0.6, 0.95] {
        let model = SecondOrder::new(20.0, ratio).unwrap();
        close(model.step_value(model.rise_time_s().unwrap()), 1.0, 1e-14);
        let peak = model.peak_time_s().unwrap();
        close(model.step_value(peak), 1.0 + model.overshoot_percent() / 100.0, 1e-14);
        assert!(model.step_value(peak) > model.step_value(0.99 * peak).max(model.step_value(1.01 * peak)));
        close(damping_ratio_from_overshoot(model.overshoot_percent()).unwrap(), ratio, 1e-13);
    }
    // (3.9), as printed, has no real value at 1 %: ln^2(0.01) = 21.2 > pi^2
    close(damping_ratio_from_overshoot(1.0).unwrap(), 0.826_085, 1e-6);
    assert_eq!(damping_ratio_from_overshoot(0.0), Ok(1.0));
}

#[test]
fn settling_rules_carry_their_band() {
    let rules = [
        (SettlingRule::FivePercent, 5.0, 3.0),
        (SettlingRule::TwoPercent, 2.0, 4.0),
        (SettlingRule::OnePercent, 1.0, 4.6),
        (SettlingRule::OnePercentThesis, 1.0, 5.0),
    ];
    for (rule, band, factor) in rules {
        assert_eq!((rule.band_percent(), rule.factor()), (band, factor));
    }
    // the envelope exp(-4.6) is 1 %, exp(-5) is 0.67 %
    close(exp(-4.6), 0.01, 6e-3);
    // critically damped, 2 %: the rule is exact
    let critical = SecondOrder::new(3.0, 1.0).unwrap();
    let rule = SettlingRule::CriticallyDampedTwoPercent;
    let exact = critical.settling_time_s(2.0).unwrap().unwrap();
    close(rule.factor() / 3.0, exact, 1e-14);
    let x = rule.factor();
    close((1.0 + x) * exp(-x), 0.02, 1e-14);
}

#[test]
fn exact_settling_times() {
    for ratio in [0.01, 0.1, 0.4, 0.69, 0.7797, 0.8, 0.9, 0.999, 1.0, 1.000_001, 1.2, 5.0, 1e3] {
        for band in [0.1, 1.0, 2.0, 5.0, 20.0] {
            let model = SecondOrder::new(7.0, ratio).unwrap();
            let settled = model.settling_time_s(band).unwrap().unwrap();
            // on the band there, and inside it afterwards
            close((model.step_value(settled) - 1.0).abs(), band / 100.0, 1e-9);
            for step in 1..2000 {
                let later = settled * (1.0 + 1e-3 * f64::from(step));
                assert!((model.step_value(later) - 1.0).abs() <= band / 100.0 * (1.0 + 1e-12));
            }
            assert!((model.step_value(settled * (1.0 - 1e-6)) - 1.0).abs() > band / 100.0);
        }
    }
    assert_eq!(SecondOrder::new(7.0, 0.0).unwrap().settling_time_s(2.0), Ok(None));
    // strongly overdamped: one slow pole, ln(1/band)/p
    let slow = SecondOrder::new(1.0, 1e3).unwrap();
    let pole = 1.0 / (1e3 + (1e6_f64 - 1.0).sqrt());
    close(slow.settling_time_s(2.0).unwrap().unwrap(), ln(50.0) / pole, 1e-6);
}

#[test]
fn from_a_specification_to_the_model_and_back() {
    for overshoot in [0.0, 0.5, 1.0, 4.3, 16.3, 60.0] {
        let model = SecondOrder::new(3.0, damping_ratio_from_overshoot(overshoot).unwrap()).unwrap();
        assert!((model.overshoot_percent() - overshoot).abs() < 1e-11);
    }
    let by_rule = SecondOrder::from_overshoot_and_settling_rule(1.0, 0.1, SettlingRule::TwoPercent).unwrap();
    let decay_rate = by_rule.damping_ratio() * by_rule.natural_frequency_rad_per_s();
    close(SettlingRule::TwoPercent.factor() / decay_rate, 0.1, 1e-15);
}

#[test]
fn the_printed_tracking_bounds_miss_their_requirements() {
    // ORIGIN: thesis section 6.4, its tracking bounds evaluated: upper 2.2 % and 0.126 s, lower
    // 0.356 s (1 % bands)
    let upper = factored(2116.0 / 75.0, &[c(-75.0, 0.0)], &[c(-36.8, 27.6), c(-36.8, -27.6)]);
    let lower = factored(400.0 * 50.0, &[], &[c(-20.0, 0.0), c(-20.0, 0.0), c(-50.0, 0.0)]);
    let times = uniform_times(1.0, 100_001).unwrap();
    let metrics = |system: &TransferFunction| {
        let values = step_response(system, &times).unwrap();
        step_metrics(&times, &values, StepBaseline::unit(), 1.0).unwrap()
    };
    let (upper, lower) = (metrics(&upper), metrics(&lower));
    assert!((upper.overshoot_percent - 2.2).abs() < 0.05, "{}", upper.overshoot_percent);
    assert!((upper.settling.time_s().unwrap() - 0.126).abs() < 5e-4);
    assert!((lower.settling.time_s().unwrap() - 0.356).abs() < 5e-4);
}

/// Sampled recursion compared with the closed-loop poles: P with its sensor has other dynamics than
/// P, and the controller has direct feedthrough.
#[test]
fn a_sampled_loop_by_samples_is_that_by_its_poles() {
    let domain = TimeDomain::Discrete { sample_time_s: 0.02 };
    let in_z = |system: TransferFunction| system.in_domain(domain).unwrap();
    let sensor = in_z(factored(0.4, &[], &[c(0.6, 0.0)]));
    for (gain, pole) in [(0.05, 0.9), (0.2, 0.7), (0.02, 1.0)] {
        let plant = in_z(factored(gain, &[c(-0.4, 0.0)], &[c(pole, 0.0), c(0.3, 0.0)]));
        let feedback = in_z(factored(0.8, &[c(0.8, 0.0)], &[c(1.0, 0.0)]));
        let prefilter = in_z(factored(0.1, &[], &[c(0.9, 0.0)]));
        let with_sensor = plant.series(&sensor).unwrap();
        let (times, values) = sampled_loop_step(&plant, &with_sensor, &feedback, &prefilter, 400).unwrap();
        let forward = plant.series(&feedback).unwrap();
        let closed = prefilter.series(&forward.feedback(&sensor).unwrap()).unwrap();
        let expected = step_response(&closed, &times).unwrap();
        for (value, expected) in values.iter().zip(&expected) {
            assert!((value - expected).abs() < 1e-9, "{value} {expected}");
        }
    }
    let other = TransferFunction::gain_only(1.0);
    assert!(sampled_loop_step(&sensor, &sensor, &sensor, &other, 3).is_err());
}

/// Dead time of the sensor or of the plant: the loop is identical, the output is later by the dead
/// time of the plant; and a quarter of the error for half the step.
#[test]
fn dead_time_may_be_moved_around_the_loop() {
    let (delay_s, steps) = (0.2, 2000);
    let path = factored(3.0, &[], &[c(0.0, 0.0), c(-4.0, 0.0)]);
    let (one, late) = (TransferFunction::gain_only(1.0), TransferFunction::gain_only(1.0));
    let late = late.with_dead_time(delay_s).unwrap();
    let prefilter = factored(2.0, &[], &[c(-2.0, 0.0)]);
    let of = |path: &TransferFunction, sensor: &TransferFunction, steps| {
        delayed_loop_step(path, sensor, &prefilter, 4.0, steps).unwrap()
    };
    let delayed = path.clone().with_dead_time(delay_s).unwrap();
    let (times, plant) = of(&delayed, &one, steps);
    let (_, sensor) = of(&path, &late, steps);
    let shift = times.partition_point(|time| *time < delay_s - 1e-9);
    for (later, earlier) in plant.iter().skip(shift).zip(&sensor) {
        assert!((later - earlier).abs() < 1e-12, "{later} {earlier}");
    }
    let at_end = |steps| *of(&delayed, &one, steps).1.last().unwrap();
    let (coarse, fine, exact) = (at_end(400), at_end(800), at_end(12_800));
    let ratio = (coarse - exact) / (fine - exact);
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
}
