//! Columns of a scenario's table, each compared with its definition.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_hydraulics::signal::Signal;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{Record, simulate_project};
use phea_workbench::project;
use phea_workbench::source::Memory;

const BENCHMARK: &str = include_str!("../../../examples/simulation/benchmark.toml");

fn record_of(settings: &[&str]) -> Record {
    let mut settings: Vec<String> = settings.iter().map(|text| (*text).to_string()).collect();
    settings.push("scenario.0.duration=2.3 s".to_string());
    let source = Memory::default().with("rig.toml", BENCHMARK);
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).unwrap_or_else(|report| panic!("{report}"));
    simulate_project(&source, &Setup::new(&loaded.project).unwrap(), &mut |_| true).unwrap().remove(0).record
}

/// The largest magnitude of a difference of two columns, and of the first of them.
fn apart(one: &[f64], other: &[f64]) -> (f64, f64) {
    assert!(one.len() == other.len() && one.len() > 1000);
    let largest =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, value| most.max(value.abs()));
    (largest(&mut one.iter().zip(other).map(|(one, other)| one - other)), largest(&mut one.iter().copied()))
}

/// Lead or lag y = U - U_0 - z: without hysteresis the opening is the spool less the null bias,
/// with it the spool leads or lags.
#[test]
fn spool_and_opening_differ_by_bias_and_hysteresis() {
    let of = |settings: &[&str]| {
        let record = record_of(settings);
        [record.signal(Signal::Spool), record.signal(Signal::Opening)]
    };
    let [spool, opening] = of(&["valve.null_bias=0.05 V"]);
    let shifted: Vec<f64> = opening.iter().map(|opening| opening + 0.05).collect();
    assert!(apart(&spool, &shifted).0 < 1e-15);
    let [spool, opening] = of(&["valve.hysteresis=0.2 V"]);
    let (lag, most) = apart(&spool, &opening);
    // the lag is within half the width
    assert!(lag > 0.02 && lag <= 0.1 + 1e-6 && most > 0.3, "{lag} {most}");
    let [spool, opening] = of(&[]);
    assert_eq!(spool, opening);
}

/// The command at the valve is the controller's output one delay earlier.
#[test]
fn the_command_after_the_delay_is_the_earlier_one_before_it() {
    let delay_samples = 8;
    // a sample every quarter of a millisecond
    let continuous = record_of(&["controller.delay=2 ms", "simulation.tolerance=1e-9"]);
    let sampled = record_of(&["controller.delay=2 ms", "controller.sample_time=1 ms"]);
    for (record, tolerance) in [(continuous, 1e-5), (sampled, 0.0)] {
        // between two samples, where rounding of times has no effect
        let between = |values: &[f64]| values.iter().skip(2).step_by(4).copied().collect::<Vec<_>>();
        let (before, after) = (&record.signal(Signal::Control), record.signal(Signal::Command));
        let (difference, most) =
            apart(&between(&after[delay_samples..]), &between(&before[..before.len() - delay_samples]));
        assert!(difference <= tolerance && most > 0.1, "{difference} V of {most} V");
        assert!(apart(&after, before).0 > 0.01);
    }
    let without = record_of(&[]);
    assert_eq!(without.signal(Signal::Control), without.signal(Signal::Command));
}

/// Command u = K_p e + the integral part, for a law K_p + K_i/s; sampled by the bilinear rule, half
/// a sample's integral belongs to K_p.
#[test]
fn proportional_and_integral_part_are_the_command() {
    for (sample_time_s, setting) in [(0.0, None), (1e-3, Some("controller.sample_time=1 ms"))] {
        let settings: Vec<&str> = setting.into_iter().collect();
        let record = record_of(&settings);
        let filtered = record.signal(Signal::FilteredReference);
        let error = filtered.iter().zip(record.signal(Signal::Measurement));
        let proportional = 0.001 + 0.5 * 0.008 * sample_time_s;
        let expected: Vec<f64> = error
            .zip(record.signal(Signal::Integral))
            .map(|((reference, measured), integral)| proportional * (reference - measured) + integral)
            .collect();
        let (difference, most) = apart(&record.signal(Signal::Control), &expected);
        assert!(difference < 1e-12 && most > 0.3, "{difference} V of {most} V");
        assert!(record.signal(Signal::Integral).iter().any(|part| part.abs() > 0.1));
    }
    let strictly_proportional = record_of(&["controller={ numerator = \"0.001\", denominator = \"1\" }"]);
    assert!(strictly_proportional.signal(Signal::Integral).iter().all(|part| *part == 0.0));
}

#[test]
fn the_limit_is_the_only_difference_between_unlimited_and_issued_command() {
    for extra in [None, Some("controller.sample_time=1 ms")] {
        let mut settings = vec!["controller.saturation=0.3 V"];
        settings.extend(extra);
        let record = record_of(&settings);
        let unlimited = record.signal(Signal::UnlimitedControl);
        assert!(unlimited.iter().any(|command| command.abs() > 0.35));
        for (unlimited, given) in unlimited.iter().zip(&record.signal(Signal::Control)) {
            assert_eq!(unlimited.clamp(-0.3, 0.3), *given);
        }
    }
}

/// A sensor H = 1 measures the force itself; with 1/(tau s + 1) the measurement satisfies its
/// equation, here by the trapezoid rule.
#[test]
fn the_measurement_is_the_force_after_the_sensor() {
    let plain = record_of(&[]);
    assert_eq!(plain.signal(Signal::Measurement), plain.signal(Signal::Force));
    let late = record_of(&["sensor={ numerator = \"100\", denominator = \"s + 100\" }"]);
    let (force, measured) = (late.signal(Signal::Force), late.signal(Signal::Measurement));
    let half = 0.5 * 100.0 * 0.25e-3;
    let mut state = measured[0];
    let mut largest: f64 = 0.0;
    for row in 1..force.len() {
        state = ((1.0 - half) * state + half * (force[row] + force[row - 1])) / (1.0 + half);
        largest = largest.max((state - measured[row]).abs());
    }
    assert!(largest < 0.5 && apart(&force, &measured).0 > 20.0, "{largest} N");
}

/// A lumped line has one pressure, that of its chamber; with segments the pressure at the valve
/// differs while oil flows.
#[test]
fn pressures_at_both_ends_of_a_line() {
    let [port, chamber] =
        [Signal::PortPressureA, Signal::PressureA].map(|signal| record_of(&[]).signal(signal));
    assert_eq!(port, chamber);
    let line = "line={ hose = \"eaton_synflex_3130_08\", length = \"1.5 m\", model = \"segments\" }";
    let [port, chamber] =
        [Signal::PortPressureA, Signal::PressureA].map(|signal| record_of(&[line]).signal(signal));
    assert!(apart(&port, &chamber).0 > 1e3, "{} Pa", apart(&port, &chamber).0);
}
