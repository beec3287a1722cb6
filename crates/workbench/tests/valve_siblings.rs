//! Three recordings for each kind that was once identified wrongly: oil that warms or cools, coarse
//! converters, instruments with a stated error.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::run_command::{HOSE, load};
use crate::valve_identification::{TRUTH, interval, recorded};
use crate::valve_instruments::covered;
use phea_workbench::command::{IdentifyRequest, identify_watched};
use phea_workbench::source::Memory;
use serde_json::Value;

/// Least number of 36 intervals of 95 % that must contain the truth: about 34 do; fewer than 30
/// would once in 500, if they were independent.
const LEAST_OF_THREE: usize = 30;

/// Coefficients are those at the mean temperature, at which the bench states its own here.
#[test]
fn oil_that_warms_or_cools() {
    for (start, end, mean) in [(40.0, 40.4, 40.2), (43.0, 41.0, 42.0), (30.0, 34.0, 32.0)] {
        let [start, end, mean] = [start, end, mean].map(|degrees| format!("\"{degrees} degC\""));
        let oil = format!("bench.oil_temperature={{ start = {start}, end = {end}, reference = {mean} }}");
        let held = covered(&[&oil], 31..34);
        assert!(held >= LEAST_OF_THREE, "{start} to {end}: {held}");
    }
}

#[test]
fn coarse_converters() {
    for bits in [10, 11, 13] {
        let held = covered(&[&format!("bench.converter_bits={bits}")], 31..34);
        assert!(held >= LEAST_OF_THREE, "{bits} bits: {held}");
    }
}

/// The recordings of the bench with one column changed, and the number of the twelve intervals that
/// contain the truth.
fn with_error(file: &str, heading: &str, error: impl Fn(f64) -> f64, accuracy: &str, seed: u32) -> usize {
    let files = recorded(&[&format!("bench.seed={seed}")]);
    let source = files.iter().fold(Memory::default(), |source, (name, text)| {
        let place = text.lines().next().unwrap().split(',').position(|one| one == heading);
        let line = |(index, line): (usize, &str)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_string).collect();
            let place = place.filter(|_| index > 0 && (file.is_empty() || name == file));
            if let Some(cell) = place.and_then(|place| cells.get_mut(place)) {
                *cell = error(cell.parse::<f64>().unwrap()).to_string();
            }
            cells.join(",")
        };
        source.with(name, text.lines().enumerate().map(line).collect::<Vec<_>>().join("\n"))
    });
    let of = |name: &str| match file.is_empty() || name == file {
        true => format!("{{ file = \"{name}\"{accuracy} }}"),
        false => format!("{{ file = \"{name}\" }}"),
    };
    let recordings = ["leakage.csv", "pressure_gain.csv", "metering.csv"].map(of).join(", ");
    let loaded = load(HOSE, &[&format!("identify.recording=[{recordings}]")], &[]);
    let request = IdentifyRequest { starts: Some(1), seed: 1, ..IdentifyRequest::default() };
    let found = identify_watched(&source, Some(&loaded), &request, &mut |_| true);
    let found: Value = parsed(&found.unwrap_or_else(|error| panic!("{error}")).json);
    let holds = |(path, truth): &&(&str, f64)| {
        interval(&found, path).is_some_and(|[low, high]| low <= *truth && *truth <= high)
    };
    TRUTH.iter().filter(holds).count()
}

/// An instrument that is wrong by half of the stated error: the intervals with its accuracy contain
/// the truth, those from the noise only do not. For a supply pressure known to 0.8 % the flow
/// coefficients are known to 0.4 %.
#[test]
fn instruments_whose_error_is_stated() {
    let cases = [
        ("metering.csv", "flow_l_per_min", 0.995, ", flow = { accuracy = \"1 %\" }"),
        ("leakage.csv", "leak_flow_l_per_min", 1.01, ", leak_flow = { accuracy = \"2 %\" }"),
        ("", "supply_pressure_bar", 1.004, ", supply_pressure = { accuracy = \"0.8 %\" }"),
    ];
    for (file, heading, factor, accuracy) in cases {
        let of_seeds = |accuracy: &str| -> usize {
            (31..34).map(|seed| with_error(file, heading, |value| factor * value, accuracy, seed)).sum()
        };
        let [stated, not_stated] = [accuracy, ""].map(of_seeds);
        assert!(stated >= LEAST_OF_THREE, "{heading}: {stated}");
        assert!(not_stated < stated, "{heading}: {not_stated} without");
    }
}
