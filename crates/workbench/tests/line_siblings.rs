//! Lines similar to those that were once identified wrongly: other fractions of air, other
//! pressures, other wave speeds and end volumes, from equations that have no code in common with
//! the model.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::engineering::estimate::Estimate;
use phea_workbench::engineering::line_test::NotIdentifiableLine;

use crate::line_as_recorded::{OfVolume, Rise, compliance, found, of_oil, response, rise_of};
use crate::line_coverage::{WAVES, known, project};

/// Checks that a number contains the truth, with three standard deviations instead of two.
#[track_caller]
fn holds(number: &Result<Estimate, NotIdentifiableLine>, truth: f64) {
    let Estimate { value, interval: [low, high] } = *number.as_ref().unwrap_or_else(|why| panic!("{why:?}"));
    let [low, high] = [value + 1.5 * (low - value), value + 1.5 * (high - value)];
    assert!(low <= truth && truth <= high, "{truth}: {value}, {low} to {high}");
}

#[track_caller]
fn air_is_found(fraction: f64, bar: [f64; 2], seed: u64) {
    let loaded = project(&WAVES);
    let known = known(&loaded);
    let pressures = bar.map(|bar| 1e5 * bar);
    let record = rise_of(&known, Rise { fraction, pressures, of: OfVolume::Mixture }, seed);
    let found = found(record, &known);
    holds(&found.entrained_air, fraction);
    holds(&found.effective_bulk_modulus, 1.0 / compliance(fraction, found.pressure));
    assert!(found.misfits().is_empty(), "{:?}", found.misfits());
}

#[test]
fn one_per_cent_of_air() {
    air_is_found(0.01, [2.0, 60.0], 1);
}

#[test]
fn three_per_cent_of_air() {
    air_is_found(0.03, [2.0, 60.0], 2);
}

#[test]
fn two_per_cent_of_air_between_other_pressures() {
    air_is_found(0.02, [5.0, 40.0], 3);
}

/// A fraction of the oil that fills the line at its pressure, instead of the mixture at atmospheric
/// pressure: 2 % of the one are 1.96 % of the other, and the moduli are equal.
#[test]
fn air_is_a_fraction_of_the_mixture_at_atmospheric_pressure() {
    let loaded = project(&WAVES);
    let known = known(&loaded);
    let pressures = [2e5, 60e5];
    for seed in 1..=3 {
        let record = rise_of(&known, Rise { fraction: 0.02, pressures, of: OfVolume::Line }, seed);
        let found = found(record, &known);
        let air = found.entrained_air.as_ref().unwrap();
        let ratio = 0.02 / air.value - 1.0;
        assert!((0.012..0.022).contains(&ratio), "{air:?}");
        holds(&found.effective_bulk_modulus, 1.0 / of_oil(0.02, found.pressure));
        assert!(found.misfits().is_empty(), "{:?}", found.misfits());
    }
}

/// The speed of a wave in a line with a fraction of the compliance at each end, within three
/// thousandths.
#[track_caller]
fn the_speed_is_found(
    settings: &[&str],
    speed: f64,
    end_share: f64,
    seed: u64,
) -> Result<Estimate, NotIdentifiableLine> {
    let loaded = project(&[&WAVES[..], settings].concat());
    let known = known(&loaded);
    let found = found(response(&known, [speed, end_share], seed), &known);
    let value = found.wave_speed.as_ref().unwrap_or_else(|why| panic!("{why:?}")).value;
    assert!((value / speed - 1.0).abs() < 3e-3, "{value} {speed}");
    assert!(found.misfits().is_empty(), "{:?}", found.misfits());
    found.wave_speed
}

#[test]
fn a_slower_wave() {
    holds(&the_speed_is_found(&[], 430.0, 0.0, 1), 430.0);
}

#[test]
fn a_faster_wave() {
    holds(&the_speed_is_found(&[], 680.0, 0.0, 2), 680.0);
}

#[test]
fn a_wave_between_end_volumes_that_are_stated() {
    holds(&the_speed_is_found(&["line.end_share=0.02"], 535.0, 0.02, 3), 535.0);
}

#[test]
fn a_wave_between_larger_end_volumes() {
    assert!(the_speed_is_found(&["line.end_share=0.05"], 600.0, 0.05, 4).is_ok());
}
