//! Records of one plant at two amplitudes: a linear plant is hardly ever reported as nonlinear, but
//! a saturation is, with the size of its describing function.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "the platform's functions are exact enough for a test")]

use crate::answer_schema::parsed;
use std::f64::consts::PI;

use phea_dynamics::random::{normal, stream};
use phea_workbench::command::{ResponseRequest, response_watched};
use phea_workbench::engineering::response::{
    LevelComparison, ResponseSettings, SampledPair, compare_levels, members,
};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

const STEP: f64 = 1e-3;

fn record(operating_point: &str, input: Vec<f64>, output: Vec<f64>) -> SampledPair {
    SampledPair {
        file: "record.csv".to_string(),
        signals: ["input", "output"],
        units: ["1", "1"],
        time_step: STEP,
        input,
        output,
        reference: None,
        recorded_loop: None,
        controller: None,
        operating_point: Some(operating_point.to_string()),
        resampled: None,
    }
}

fn compared(records: &[SampledPair]) -> Vec<LevelComparison> {
    compare_levels(&members(records, &ResponseSettings::default(), &mut |_| true).unwrap())
}

fn is_reported(comparison: &LevelComparison) -> bool {
    comparison.frequencies.iter().any(|one| one.is_found())
}

fn white(seed: u64, size: f64, count: usize) -> Vec<f64> {
    let mut state = stream(seed, 0);
    (0..count).map(|_| size * normal(&mut state)).collect()
}

/// A resonance of 32 Hz with a damping ratio of 0.1, with its input held.
fn resonance(input: &[f64]) -> Vec<f64> {
    let [mut last, mut before, mut given] = [0.0; 3];
    let next = |now: &f64| {
        let output = 1.92 * last - 0.9604 * before + 0.04 * given;
        (before, last, given) = (last, output, *now);
        output
    };
    input.iter().map(next).collect()
}

fn plus(signal: Vec<f64>, noise: &[f64]) -> Vec<f64> {
    signal.iter().zip(noise).map(|(value, noise)| value + noise).collect()
}

/// A multisine of 20 lines over six periods of 200 rows.
fn multisine(amplitude: f64) -> Vec<f64> {
    let line = |n: usize, k: usize| (2.0 * PI * (k * n) as f64 / 200.0 + (k * k) as f64).cos();
    (0..1200).map(|n| amplitude * (1..=20).map(|k| line(n, k)).sum::<f64>()).collect()
}

/// False reports for a linear plant: 5 % of the pairs of records if the noise of one dominates, and
/// no more if both have equal noise.
#[test]
fn a_linear_plant_is_reported_as_often_as_stated() {
    let alarms = |levels: [f64; 2]| {
        let one = |seed: u64| {
            let record = |(index, level): (u64, f64)| {
                let input = multisine(level);
                let output = plus(resonance(&input), &white(2 * seed + index, 0.02, 1200));
                record("middle", input, output)
            };
            let found = compared(&[record((0, levels[0])), record((1, levels[1]))]);
            assert_eq!(found[0].frequencies.len(), 20);
            usize::from(is_reported(&found[0]))
        };
        (0..300).map(one).sum::<usize>()
    };
    // ORIGIN: analytic, 300 times 0.05, and 99.8 % of a binomial distribution: 3.1 deviations
    let spread = 3.1 * (300.0_f64 * 0.05 * 0.95).sqrt();
    let dominated = alarms([0.1, 1.0]);
    assert!((dominated as f64 - 15.0).abs() < spread, "{dominated} of 300");
    let alike = alarms([0.2, 0.25]);
    assert!((alike as f64) < 15.0 + spread, "{alike} of 300");
}

/// Records of noise with different lengths are compared between their frequencies.
#[test]
fn records_of_different_length_are_compared_between_their_frequencies() {
    let one = |seed: u64| {
        let record = |(index, level, count): (u64, f64, usize)| {
            let input = white(3 * seed + index, level, count);
            let output = plus(resonance(&input), &white(1000 + 3 * seed + index, 0.05, count));
            record("middle", input, output)
        };
        let found = compared(&[record((0, 1.0, 8000)), record((1, 0.3, 6500))]);
        let frequencies = &found[0].frequencies;
        assert!(frequencies.len() > 12, "{}", frequencies.len());
        usize::from(is_reported(&found[0]))
    };
    let alarms: usize = (0..60).map(one).sum();
    // ORIGIN: analytic, 60 times 0.05: 3, and 3.1 standard deviations of a binomial distribution
    assert!((alarms as f64) < 3.0 + 3.1 * (60.0_f64 * 0.05 * 0.95).sqrt(), "{alarms} of 60");
}

fn saturated(input: &[f64]) -> Vec<f64> {
    input.iter().map(|value| value.clamp(-1.0, 1.0)).collect()
}

/// Noise through a saturation at 1: its gain is erf(1/(sqrt 2 sigma)) (Bussgang 1952), whatever the
/// frequency.
#[test]
fn a_saturation_is_found_with_the_gain_it_has_for_noise() {
    let record = |(seed, level): (u64, f64)| {
        let input = white(seed, level, 80_000);
        let output = plus(resonance(&saturated(&input)), &white(10 + seed, 0.01, 80_000));
        record("middle", input, output)
    };
    let found = compared(&[record((1, 1.0)), record((2, 0.3))]);
    let comparison = &found[0];
    assert_eq!(comparison.members, [1, 0]);
    assert!(comparison.has_two_levels());
    // ORIGIN: analytic, erf(1/sqrt 2) = 0.682689 and erf(1/(0.3 sqrt 2)) = 0.999142
    let expected = 0.682689 / 0.999142;
    let ratio = |one: &phea_workbench::engineering::response::LevelDifference| {
        let [small, large] = one.pair.responses;
        assert!((large - expected * small).norm_sqr().sqrt() < one.by_noise);
        let weight = small.norm_sqr() / (one.by_noise * one.by_noise);
        (weight, weight * (large / small).re)
    };
    let frequencies = &comparison.frequencies;
    let (weights, ratios): (Vec<f64>, Vec<f64>) = frequencies.iter().map(ratio).unzip();
    let mean = ratios.iter().sum::<f64>() / weights.iter().sum::<f64>();
    assert!((mean / expected - 1.0).abs() < 0.02, "{mean}");
    let found = frequencies.iter().filter(|one| one.is_found()).count();
    assert!(found > frequencies.len() / 2, "{found} of {}", frequencies.len());
}

/// A sine with twice the amplitude of the limit: N = 2/pi (asin(1/2) + 1/2 sqrt(3/4)).
#[test]
fn the_answer_has_the_describing_function_of_a_saturation() {
    let text = |seed: u64, amplitude: f64| {
        let input: Vec<f64> =
            (0..1200).map(|n| amplitude * (2.0 * PI * f64::from(n) / 200.0).sin()).collect();
        let output = plus(resonance(&saturated(&input)), &white(seed, 1e-4, 1200));
        let rows = input.iter().zip(&output).enumerate();
        rows.fold("time_s,input,output\n".to_string(), |text, (row, (input, output))| {
            format!("{text}{},{input},{output}\n", row as f64 * STEP)
        })
    };
    let project = |name: &str| {
        let of = |file: &str| {
            format!("[[identify.response]]\nfile = \"{file}.csv\"\noperating_point = \"{name}\"\n")
        };
        let both = [of("large"), of("small")].concat();
        format!("schema = 1\n[plant]\nnumerator = \"1\"\ndenominator = \"s + 1\"\n{both}")
    };
    let output = |amplitudes: [f64; 2]| {
        let [large, small] = amplitudes;
        let source = Memory::default()
            .with("rig.toml", project("middle"))
            .with("large.csv", text(1, large))
            .with("small.csv", text(2, small));
        let loaded = project::read(&source, "rig.toml", &[], &[]).unwrap();
        let answer = response_watched(&source, Some(&loaded), &ResponseRequest::default(), &mut |_| true);
        let answer = answer.unwrap();
        let json: Value = parsed(&answer.json);
        (answer.text(), json["response"]["comparisons"][0].clone())
    };
    let (text, found) = output([2.0, 0.5]);
    assert_eq!(found["files"], serde_json::json!(["small.csv", "large.csv"]));
    assert_eq!(found["differences"], 1);
    let one = &found["frequencies"][0];
    let gain = 2.0 / PI * (0.5_f64.asin() + 0.5 * 0.75_f64.sqrt());
    let [decibels, degrees] = ["difference_db", "difference_deg"].map(|name| one[name].as_f64().unwrap());
    assert!((decibels - 20.0 * gain.log10()).abs() < 0.01 && degrees.abs() < 0.1, "{decibels} {degrees}");
    for part in ["not linear between these amplitudes", "-4.3", "at 5.00 Hz", "members of the family"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let (text, found) = output([0.8, 0.5]);
    assert_eq!(found["differences"], 0);
    assert!(text.contains("a linear plant explains both"), "{text}");
}
