//! Frequency responses from recorded signals.

use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::{cos, exp, exp_complex, magnitude, sin};
use phea_dynamics::random::{normal, stream};
use phea_dynamics::spectrum::{
    Transform, WithinRow, feedback, least_coherence, local_polynomials, period, periods, segments,
};

const STEP: f64 = 1e-3;
const PERIOD: usize = 500;

fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut state = stream(seed, 0);
    (0..count).map(|_| normal(&mut state)).collect()
}

#[test]
fn the_transform_is_the_sum_of_its_definition_for_every_length() {
    for length in [1, 2, 3, 8, 30, 64, 97, 250] {
        let samples: Vec<Complex64> = noise(length as u64, 2 * length)
            .chunks_exact(2)
            .map(|pair| Complex64::new(pair[0], pair[1]))
            .collect();
        let lines = Transform::new(length).of(&samples);
        assert_eq!(lines.len(), length);
        for (k, line) in lines.iter().enumerate() {
            let angle = |n: usize| -2.0 * PI * ((k * n) % length) as f64 / length as f64;
            let sum: Complex64 = samples
                .iter()
                .enumerate()
                .map(|(n, x)| x * Complex64::new(cos(angle(n)), sin(angle(n))))
                .sum();
            assert!(magnitude(line - sum) < 1e-12 * length as f64, "line {k} of {length}");
        }
    }
}

/// Parseval's theorem: sum |x|^2 = sum |X|^2 / N.
#[test]
fn the_transform_preserves_the_power() {
    for length in [256, 1000, 1009] {
        let signal = noise(3, length);
        let lines = Transform::new(length).of_real(&signal);
        let in_time: f64 = signal.iter().map(|value| value * value).sum();
        let in_frequency: f64 = lines.iter().map(|line| line.norm_sqr()).sum();
        assert!((in_frequency / length as f64 / in_time - 1.0).abs() < 1e-13, "{length}");
    }
}

/// Lag 1/(0.02 s + 1).
fn first_order() -> TransferFunction {
    TransferFunction::from_polynomials(&Polynomial::new(vec![1.0]), &Polynomial::new(vec![0.02, 1.0]))
        .unwrap()
}

/// A multisine of lines 1, 3, 7, 15, 31 and the steady-state response of a system to it.
fn multisine(repeats: usize) -> [Vec<f64>; 2] {
    let system = first_order();
    let lines = [1_usize, 3, 7, 15, 31];
    let of = |n: usize, response: bool| -> f64 {
        let at = |(index, line): (usize, &usize)| {
            let w = 2.0 * PI * *line as f64 / (PERIOD as f64 * STEP);
            let gain = if response { system.at_frequency(w) } else { Complex64::new(1.0, 0.0) };
            let phase = 2.0 * PI * ((line * n) % PERIOD) as f64 / PERIOD as f64 + index as f64 * index as f64;
            (gain * exp_complex(Complex64::new(0.0, phase))).re
        };
        lines.iter().enumerate().map(at).sum()
    };
    [false, true].map(|response| (0..repeats * PERIOD).map(|n| of(n, response)).collect())
}

#[test]
fn a_multisine_without_noise_gives_the_response_of_a_first_order_system_exactly() {
    let [input, output] = multisine(6);
    assert_eq!(period(&input), Some(PERIOD));
    let blocks = periods([&input, &output], STEP, PERIOD, PERIOD).unwrap();
    assert_eq!(blocks.count(), 5);
    let points = blocks.points();
    let excited: Vec<_> = points.iter().filter(|point| point.excitation > 1e-6).collect();
    assert_eq!(excited.len(), 5);
    for point in excited {
        let truth = first_order().at_frequency(point.frequency);
        assert!(magnitude(point.response / truth - 1.0) < 1e-12, "{point:?}");
        assert!((point.coherence - 1.0).abs() < 1e-12 && point.radius < 1e-12);
    }
}

#[test]
fn discarded_periods_remove_a_decaying_transient() {
    let [input, mut output] = multisine(8);
    for (n, value) in output.iter_mut().enumerate() {
        *value += 5.0 * exp(-(n as f64) * STEP / 0.02);
    }
    let worst = |settling: usize| -> f64 {
        let points = periods([&input, &output], STEP, PERIOD, settling).unwrap().points();
        let error = |point: &phea_dynamics::spectrum::SpectralPoint| {
            magnitude(point.response - first_order().at_frequency(point.frequency))
        };
        points.iter().filter(|point| point.excitation > 1e-6).map(error).fold(0.0, f64::max)
    };
    assert!(worst(0) > 1e-3);
    // ORIGIN: analytic, each period of 0.5 s lets a time constant of 20 ms decay by exp(-25)
    assert!(worst(PERIOD) < 1e-11);
}

/// Response of x' = (u - x)/tau to an input held between samples: exact in discrete time.
fn held_first_order(input: &[f64], decay: f64) -> Vec<f64> {
    let mut state = 0.0;
    input
        .iter()
        .map(|u| {
            let now = state;
            state = decay * state + (1.0 - decay) * u;
            now
        })
        .collect()
}

fn held_response(w: f64, decay: f64) -> Complex64 {
    let shift = exp_complex(Complex64::new(0.0, w * STEP));
    (1.0 - decay) / (shift - decay)
}

#[test]
fn a_gain_without_noise_has_a_coherence_of_one_for_any_input() {
    let input = noise(11, 5_000);
    let output: Vec<f64> = input.iter().map(|value| -3.0 * value).collect();
    for point in segments([&input, &output], STEP, 1000).unwrap().points() {
        assert!((point.coherence - 1.0).abs() < 1e-12 && point.radius < 1e-12, "{point:?}");
        assert!(magnitude(point.response + 3.0) < 1e-12, "{point:?}");
    }
}

/// A window includes the response of the system to the time before it: for a system that forgets
/// within tau, the fraction of the power is (tau/T)^2 for a window of length T.
#[test]
fn leakage_of_random_input_falls_with_the_square_of_the_segment() {
    let (input, decay) = (noise(11, 200_000), 0.8);
    let output = held_first_order(&input, decay);
    let incoherent = |length: usize| -> f64 {
        let points = segments([&input, &output], STEP, length).unwrap().points();
        for point in points.iter().skip(1) {
            let truth = held_response(point.frequency, decay);
            assert!(magnitude(point.response / truth - 1.0) < 10.0 / length as f64, "{point:?}");
        }
        points.iter().map(|point| 1.0 - point.coherence).sum::<f64>() / points.len() as f64
    };
    let ratio = incoherent(512) / incoherent(2048);
    assert!((ratio / 16.0 - 1.0).abs() < 0.1, "{ratio}");
}

/// White noise with a Hann window: neighbouring segments have 1/36 of their power in common.
#[test]
fn overlapping_segments_count_as_welch_says() {
    let signal = noise(5, 64 * 101);
    let blocks = segments([&signal, &signal], STEP, 128).unwrap();
    assert_eq!(blocks.count(), 100);
    // ORIGIN: analytic, overlap of two Hann windows shifted by half: 1/6 of their square
    assert!((blocks.independent() - 100.0 / (1.0 + 2.0 / 36.0 * 0.99)).abs() < 1e-9);
}

/// Discs around 40 responses per repetition contain the truth as often as they should: over 40
/// repetitions with noise in the output, 95 % of them, within chance.
#[test]
fn discs_of_periods_hold_the_truth_in_95_of_100_cases() {
    let [clean_input, clean_output] = multisine(6);
    let mut held = 0;
    let mut all = 0;
    for repetition in 0..40 {
        let noisy = |clean: &[f64], scale: f64, seed: u64| -> Vec<f64> {
            clean.iter().zip(noise(seed, clean.len())).map(|(value, noise)| value + scale * noise).collect()
        };
        let input = noisy(&clean_input, 0.05, 1000 + repetition);
        let output = noisy(&clean_output, 0.2, 2000 + repetition);
        assert_eq!(period(&input), Some(PERIOD));
        let points = periods([&input, &output], STEP, PERIOD, 0).unwrap().points();
        for point in points.iter().filter(|point| point.excitation > 0.1) {
            let error = magnitude(point.response - first_order().at_frequency(point.frequency));
            held += usize::from(error <= point.radius);
            all += 1;
        }
    }
    assert_eq!(all, 200);
    // ORIGIN: analytic, 99.8 % of a binomial distribution of 200 with 0.95
    assert!((179..=198).contains(&held), "{held} of {all}");
}

#[test]
fn discs_of_segments_hold_the_truth_in_95_of_100_cases() {
    let decay = 0.5;
    let mut held = 0;
    for repetition in 0..40 {
        let input = noise(100 + repetition, 128 * 21);
        let mut output = held_first_order(&input, decay);
        for (value, noise) in output.iter_mut().zip(noise(500 + repetition, input.len())) {
            *value += noise;
        }
        let points = segments([&input, &output], STEP, 256).unwrap().points();
        for point in points.iter().skip(9).step_by(25) {
            let error = magnitude(point.response - held_response(point.frequency, decay));
            held += usize::from(error <= point.radius);
        }
    }
    // ORIGIN: analytic, 99.8 % of a binomial distribution of 200 with 0.95
    assert!((179..=198).contains(&held), "{held} of 200");
}

/// Squared coherence of unrelated signals exceeds its threshold in one case out of twenty.
#[test]
fn signals_without_relation_are_coherent_in_5_of_100_cases() {
    let blocks = segments([&noise(21, 256 * 200), &noise(22, 256 * 200)], STEP, 256 * 20).unwrap();
    let points = blocks.points();
    let limit = least_coherence(blocks.independent());
    let count = points.iter().filter(|point| point.coherence > limit).count();
    let fraction = count as f64 / points.len() as f64;
    assert!((0.03..0.07).contains(&fraction), "{fraction} of {}", points.len());
}

#[test]
fn records_too_short_for_two_blocks_have_none() {
    let signal = noise(1, 99);
    assert!(periods([&signal, &signal], STEP, 50, 0).is_none());
    assert!(periods([&signal, &signal], STEP, 20, 200).is_none());
    assert!(segments([&signal, &signal], STEP, 80).is_none());
}

/// A sweep from 2 to 100 Hz, of which no two parts of the record are alike.
fn sweep(count: usize) -> Vec<f64> {
    let span = count as f64 * STEP;
    let phase = |time: f64| 2.0 * PI * (2.0 + 98.0 / (2.0 * span) * time) * time;
    (0..count).map(|n| sin(phase(n as f64 * STEP))).collect()
}

/// A line of the input that is noise passes as excited in one of 100,000 cases, even with two
/// periods.
#[test]
fn lines_of_noise_do_not_pass_as_excited() {
    let mut passed = 0;
    for seed in 0..4 {
        let input = noise(900 + seed, 2 * 4096);
        let points = periods([&input, &input], STEP, 4096, 0).unwrap().points();
        passed += points.iter().filter(|point| point.excitation > 0.0).count();
    }
    // ORIGIN: analytic, 8188 lines with a chance of 0.00001 each: 3 once in ten thousand
    assert!(passed < 3, "{passed}");
}

/// A record of a single sweep has one realisation, and its discs are valid.
#[test]
fn discs_of_a_single_sweep_hold_the_truth_in_95_of_100_cases() {
    let (decay, input) = (0.8, sweep(4000));
    let (mut held, mut all) = (0, 0);
    for repetition in 0..40 {
        let mut output = held_first_order(&input, decay);
        for (value, noise) in output.iter_mut().zip(noise(700 + repetition, input.len())) {
            *value += 0.1 * noise;
        }
        for point in local_polynomials(&input, [&input, &output], STEP) {
            if (2.0 * PI * 3.0..2.0 * PI * 95.0).contains(&point.frequency) {
                let error = magnitude(point.response - held_response(point.frequency, decay));
                held += usize::from(error <= point.radius);
                all += 1;
            }
        }
    }
    let expected = 0.95 * f64::from(all);
    // ORIGIN: analytic, 99.8 % of a binomial distribution: 3.1 standard deviations
    let apart = (held as f64 - expected).abs() / (0.05 * expected).sqrt();
    assert!(all > 600 && apart < 3.1, "{held} of {all}");
}

/// A loop u = k (r - y) around the plant, with output noise twice as large as the effect of the
/// reference: from the input the response tends to -1/k, from the reference to the plant.
#[test]
fn a_reference_shows_the_plant_in_a_closed_loop() {
    let (decay, gain, count) = (0.8, 3.0, 40_000);
    let (reference, noises) = (noise(31, count), noise(32, count));
    let mut state = 0.0;
    let [mut input, mut output] = [Vec::new(), Vec::new()];
    for (reference, noise) in reference.iter().zip(&noises) {
        let shown = state + 2.0 * noise;
        let given = gain * (reference - shown);
        state = decay * state + (1.0 - decay) * given;
        input.push(given);
        output.push(shown);
    }
    let signals = [input.as_slice(), output.as_slice()];
    let points = local_polynomials(&reference, signals, STEP);
    let (mut held, mut fooled) = (0, 0);
    for (point, direct) in points.iter().zip(local_polynomials(&input, signals, STEP)) {
        let truth = held_response(point.frequency, decay);
        held += usize::from(magnitude(point.response - truth) <= point.radius);
        fooled += usize::from(magnitude(direct.response - truth) > 3.0 * direct.radius);
    }
    let expected = 0.95 * points.len() as f64;
    assert!((held as f64 - expected).abs() < 3.1 * (0.05 * expected).sqrt(), "{held} of {}", points.len());
    assert!(2 * fooled > points.len(), "{fooled} of {}", points.len());
}

/// No response is returned if the reference does not move the input: it would be a response to
/// noise.
#[test]
fn a_reference_that_moves_nothing_excites_nothing() {
    let [reference, input, output] = [41, 42, 43].map(|seed| noise(seed, 20_000));
    let points = local_polynomials(&reference, [&input, &output], STEP);
    // ORIGIN: analytic, one out of 10,000 points by chance
    assert!(points.len() > 100 && points.iter().filter(|point| point.excitation > 0.0).count() <= 1);
}

/// Loop u = c (r - y) around the plant, with coloured noise in the output; the controller acts in
/// the same row, or a row later.
fn closed_loop(seed: u64, noisy: f64, late: usize) -> [Vec<f64>; 2] {
    let (references, noises) = (noise(seed, 4000), noise(seed + 1, 4000));
    let (mut state, mut colour, mut reference) = (0.0, 0.0, 0.0);
    let [mut input, mut output] = [Vec::<f64>::new(), Vec::new()];
    for (moved, noise) in references.iter().zip(&noises) {
        colour = 0.9 * colour + noisy * noise;
        reference = 0.95 * reference + moved;
        output.push(state + colour);
        let wanted = 3.0 * (reference - state - colour);
        let given = if late == 0 { wanted } else { input.last().copied().unwrap_or(0.0) };
        let given = if late == 0 { given } else { 0.9 * given + 0.1 * wanted };
        input.push(given);
        state = 0.8 * state + 0.2 * given;
    }
    [input, output]
}

#[test]
fn feedback_is_seen_where_noise_returns() {
    for seed in [1, 11, 21, 31] {
        for late in [0, 1] {
            let [input, output] = closed_loop(seed, 1.0, late);
            assert!(feedback(&input, &output, WithinRow::Possible) > 0.01, "{seed} {late}");
        }
    }
}

/// Feedback is indicated by an output that follows the input of its own row if no plant could be as
/// fast.
#[test]
fn an_input_that_is_held_cannot_act_within_its_row() {
    for seed in 0..4 {
        let input = noise(500 + seed, 4000);
        let earlier = std::iter::once(&0.0).chain(&input);
        let signals = input.iter().zip(earlier).zip(noise(600 + seed, 4000));
        let output: Vec<f64> = signals.map(|((now, last), noise)| last + 0.5 * now + noise).collect();
        assert_eq!(feedback(&input, &output, WithinRow::Possible), 0.0, "{seed}");
        // ORIGIN: analytic, 0.25 of a variance of 1.25
        let fraction = feedback(&input, &output, WithinRow::Impossible);
        assert!((fraction - 0.2).abs() < 0.04, "{seed}: {fraction}");
    }
}

/// Signals of the closed loop's input and output, but with independent noise: nothing returns.
#[test]
fn an_open_loop_has_no_feedback_whatever_its_input_is() {
    for seed in 0..20 {
        let [closed, _] = closed_loop(100 + seed, 1.0, 1);
        let swept = sweep(4000);
        let stepped: Vec<f64> = (0..4000).map(|n| f64::from(u8::from(n > 1200))).collect();
        let held: Vec<f64> = noise(300 + seed, 400).iter().flat_map(|value| [*value; 10]).collect();
        for input in [closed, swept, stepped, held, noise(200 + seed, 4000)] {
            for size in [0.0, 0.01, 1.0] {
                let mut colour = 0.0;
                let mut output = held_first_order(&input, 0.8);
                for (value, noise) in output.iter_mut().zip(noise(400 + seed, 4000)) {
                    colour = 0.9 * colour + size * noise;
                    *value += colour;
                }
                assert_eq!(feedback(&input, &output, WithinRow::Possible), 0.0, "{seed} {size}");
            }
        }
    }
}

/// Nonlinearity y + y^3/10 on odd lines: it produces odd lines, an offset drift produces neither.
#[test]
fn distortion_is_found_at_the_lines_that_are_not_excited() {
    let [input, clean] = multisine(6);
    let with = |shape: fn(f64) -> f64, size: f64| -> Vec<f64> {
        let noises = noise(77, clean.len());
        clean.iter().zip(noises).map(|(value, noise)| shape(*value) + size * noise).collect()
    };
    let of = |output: &[f64]| periods([&input, output], STEP, PERIOD, PERIOD).unwrap().distortion();
    let linear = of(&with(|value| value, 0.1));
    assert_eq!((linear.even, linear.odd), (0.0, 0.0));
    let cubic = of(&with(|value| value + value * value * value / 10.0, 0.1));
    assert!(cubic.odd > 0.01 && cubic.even == 0.0, "{cubic:?}");
    let square = of(&with(|value| value + value * value / 10.0, 0.1));
    assert!(square.even > 0.01 && square.odd == 0.0, "{square:?}");
}
