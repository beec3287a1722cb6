//! Force as seen by a sampled controller: noise, converters, and the filter after them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_hydraulics::signal::Signal;
use phea_workbench::project::{self, Project};
use phea_workbench::setup::Setup;
use phea_workbench::simulate::simulate_project;
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");
/// Controller gain, V/N, so small that the machine remains at rest with any noise.
const OPEN: f64 = 1e-9;
const SAMPLE_TIME_S: f64 = 1e-3;

/// The benchmark at rest, with equal edges: without a command it remains at rest.
fn still(settings: &[&str]) -> Project {
    let (rig, _) = BENCHMARK.split_once("[[scenario]]").unwrap();
    let rig = rig.replace("[3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7]", "[3e-7, 3e-7, 3e-7, 3e-7]");
    let rig = rig.replace("[2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9]", "[2.4e-9, 2.4e-9, 2.4e-9, 2.4e-9]");
    let text = format!("{rig}[[scenario]]\nname = \"still\"\nduration = \"20 s\"\n");
    let source = Memory::default().with("rig.toml", text);
    let settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}")).project
}

/// Commands and forces at the samples.
fn samples(settings: &[&str]) -> (Vec<f64>, Vec<f64>) {
    let run = simulate_project(&Memory::default(), &Setup::new(&still(settings)).unwrap(), &mut |_| true)
        .unwrap()
        .remove(0);
    assert_eq!(run.stopped(), None);
    let at_samples =
        |values: &[f64]| values.iter().copied().step_by(run.samples_per_row).collect::<Vec<f64>>();
    let [commands, forces] =
        [&run.record.signal(Signal::Control), &run.record.signal(Signal::Force)].map(|one| at_samples(one));
    assert_eq!(commands.len(), 20_001);
    (commands, forces)
}

/// A sampled controller with this gain and further keys in its table.
fn sampled(gain: f64, more: &str) -> String {
    let gain = format!("{{ kind = \"gain\", value = {gain:e} }}");
    format!("controller={{ sample_time = \"1 ms\", elements = [{gain}{more} }}")
}

/// Measurement of the controller, from its command: u = -G m.
fn seen(more: &str, noise: &str) -> (Vec<f64>, Vec<f64>) {
    let (commands, forces) = samples(&[&sampled(OPEN, more), noise]);
    (commands.iter().map(|command| -command / OPEN).collect(), forces)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn rms(values: &[f64]) -> f64 {
    mean(&values.iter().map(|value| value * value).collect::<Vec<f64>>()).sqrt()
}

fn difference(one: &[f64], other: &[f64]) -> Vec<f64> {
    one.iter().zip(other).map(|(one, other)| one - other).collect()
}

/// Mean, rms and correlation from sample to sample, each within five standard errors.
#[test]
fn the_noise_is_white_and_has_the_stated_rms() {
    for (noise, stated) in [("force_sensor.noise=2 N", 2.0), ("force_sensor.noise=35 N", 35.0)] {
        let (measured, forces) = seen("]", noise);
        let noise = difference(&measured, &forces);
        let error = 5.0 / (noise.len() as f64).sqrt();
        let found = rms(&noise);
        assert!((found / stated - 1.0).abs() < error / 2.0_f64.sqrt(), "{found}");
        assert!(mean(&noise).abs() < error * stated, "{}", mean(&noise));
        let neighbours: Vec<f64> = noise.windows(2).map(|pair| pair[0] * pair[1]).collect();
        assert!(mean(&neighbours).abs() < error * stated * stated, "{}", mean(&neighbours));
    }
}

/// The noise with and without a converter of the measurement: a whole number of steps, at most half
/// a step away, uniformly distributed.
#[test]
fn the_measurement_is_rounded_to_its_levels() {
    let converter = "], quantization = { measurement_bits = 16, measurement_range = [-1e4, 1e4] }";
    let (plain, _) = seen("]", "force_sensor.noise=2 N");
    let (rounded, _) = seen(converter, "force_sensor.noise=2 N");
    let step = 2e4 / 65536.0;
    for measured in &rounded {
        let levels = measured / step;
        assert!((levels - levels.round()).abs() < 1e-6, "{measured}");
    }
    let error = difference(&rounded, &plain);
    assert!(error.iter().all(|error| error.abs() <= 0.5 * step * (1.0 + 1e-6)));
    // the square of a uniform error has a standard deviation of 0.894 of its mean
    let allowed = 5.0 * 0.447 / (error.len() as f64).sqrt();
    let found = rms(&error) * 12.0_f64.sqrt() / step;
    assert!((found - 1.0).abs() < allowed, "{found}");
}

/// A converter with 16 bits over 10 V on either side has steps of 20 V/65536, and its ends limit
/// the command.
#[test]
fn the_command_is_rounded_to_its_levels() {
    let converter = "], quantization = { command_bits = 16, command_range = [-10, 10] }";
    let setting = sampled(1e-3, converter);
    let converter = Setup::new(&still(&[&setting])).unwrap().quantization.command.unwrap();
    // ORIGIN: analytic, 20 V/65536, and 1 V between the levels 3276 and 3277, at 3276.8
    assert_eq!(converter.step(), 0.00030517578125);
    assert_eq!(converter.rounded(1.0), 3277.0 * 0.00030517578125);
    assert_eq!((converter.rounded(10.2), converter.rounded(-11.0)), (10.0, -10.0));
    assert_eq!((converter.rounded(0.00015), converter.rounded(0.00016)), (0.0, converter.step()));
    let (commands, _) = samples(&[&setting, "force_sensor.noise=2 N"]);
    assert!(commands.iter().all(|command| (command / converter.step()).fract() == 0.0));
    assert!(commands.iter().any(|command| *command != 0.0));
}

/// A filter 1/(1 + tau s) by Tustin's rule leaves sqrt(T/(2 tau + T)) of white noise.
#[test]
fn a_filter_passes_its_fraction_of_the_noise() {
    for frequency in [100.0, 400.0] {
        let filter = format!(", {{ kind = \"pole\", frequency = {frequency} }}]");
        let (filtered, _) = seen(&filter, "force_sensor.noise=20 N");
        let lag = 1.0 / frequency;
        let fraction = (SAMPLE_TIME_S / (2.0 * lag + SAMPLE_TIME_S)).sqrt();
        // neighbours with a correlation of a = (2 tau - T)/(2 tau + T) carry less information on
        // the rms, by (1 + a^2)/(1 - a^2)
        let alike = (2.0 * lag - SAMPLE_TIME_S) / (2.0 * lag + SAMPLE_TIME_S);
        let fewer = (1.0 + alike * alike) / (1.0 - alike * alike);
        let allowed = 5.0 * (fewer / (2.0 * filtered.len() as f64)).sqrt();
        let found = rms(&filtered) / (20.0 * fraction);
        assert!((found - 1.0).abs() < allowed, "{frequency}: {found}");
    }
}

/// The force contains sqrt(w_c T/2) of the noise, for a loop that is nearly of first order.
#[test]
fn the_force_contains_the_noise_within_the_bandwidth() {
    let gain = 2e-4;
    let setting = sampled(gain, "]");
    let settings = [
        setting.as_str(),
        "force_sensor.noise=20 N",
        "cylinder.friction={ model = \"viscous\", viscous = 3000 }",
    ];
    let linear = Setup::rig_of(&still(&settings)).unwrap().linear;
    let crossover = gain * linear.flow_gain * linear.equivalent_stiffness() / linear.useful_area;
    let (_, forces) = samples(&settings);
    let found = rms(&forces) / 20.0;
    let expected = (crossover * SAMPLE_TIME_S / 2.0).sqrt();
    assert!((found / expected - 1.0).abs() < 0.15, "{found}, not {expected}");
}
