//! Static tests of the valve: the records of a virtual bench.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::{HOSE, load};
use phea_workbench::answer::Answer;
use phea_workbench::command::{Request, answer};
use phea_workbench::source::Memory;

const IDEAL: [&str; 5] = [
    "bench.pressure_noise=0",
    "bench.leak_meter.noise=0",
    "bench.flow_meter.noise=0",
    "bench.converter_bits=0",
    "bench.flow_meter.minimum=0",
];

fn tested(settings: &[&str]) -> Answer {
    let loaded = load(HOSE, settings, &[]);
    answer(&Memory::default(), &loaded, &[], &Request::Bench).expect("a bench")
}

/// A column of a table.
fn column(answer: &Answer, file: &str, name: &str) -> Vec<f64> {
    let file = answer.files.iter().find(|one| one.name == file).expect("the file");
    let text = String::from_utf8(file.bytes.clone()).unwrap();
    let mut lines = text.lines();
    let index = lines.next().unwrap().split(',').position(|column| column == name).expect("the column");
    lines.map(|line| line.split(',').nth(index).unwrap().parse().unwrap()).collect()
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Thesis (4.13) inverted at null, and two edges in series at full amplitude.
#[test]
fn ideal_instruments_show_the_closed_forms() {
    let found = tested(&IDEAL);
    let (leak, command) =
        (column(&found, "leakage.csv", "leak_flow_l_per_min"), column(&found, "leakage.csv", "command_v"));
    assert_eq!(command[0], 0.0);
    // ORIGIN: analytic, K_i K_j/sqrt(K_i^2 + K_j^2) of edges 3, 4 and 5, 6 of thesis Table 5.1, 70
    // bar, and the tare flow
    let series = |first: f64, second: f64| first * second / (first * first + second * second).sqrt();
    let null = (series(2.35e-9, 2.2e-9) + series(1.7e-9, 2.35e-9)) * 70e5_f64.sqrt() + 7.55e-6;
    assert!((leak[0] / 60_000.0 / null - 1.0).abs() < 1e-6);
    let base = leak.iter().copied().fold(f64::INFINITY, f64::min);
    assert!((base / 60_000.0 / 7.55e-6 - 1.0).abs() < 1e-5);
    let flow = column(&found, "metering.csv", "flow_l_per_min");
    let extending = series(3.2e-7, 3.85e-7) * 0.3 * 70e5_f64.sqrt();
    let quarter = flow[600] / 60_000.0;
    assert!(quarter < extending && quarter > 0.99 * extending, "the meter takes a little of it");
    let (a, b) =
        (column(&found, "metering.csv", "pressure_a_bar"), column(&found, "metering.csv", "pressure_b_bar"));
    let meter = 2.0 * (flow[600] / 60.0) * (flow[600] / 60.0);
    // the root is regular below a few kilopascals: half a per cent at the seven of the meter
    assert!((a[600] - b[600] - meter).abs() < 1e-2 * meter);
}

#[test]
fn with_a_small_pump_the_pressure_falls_and_a_meter_stalls() {
    let found = tested(&["bench.pump_flow=\"9.8 L/min\"", "bench.flow_meter.minimum=\"3 L/min\""]);
    assert!(found.text().contains("The pump does not keep 70 bar"));
    let flow = column(&found, "metering.csv", "flow_l_per_min");
    assert!(most(&flow) < 9.8 - 0.2);
    assert!(flow.iter().all(|flow| *flow == 0.0 || *flow > 2.5), "noise aside, nothing between");
    assert_eq!(flow[0], 0.0);
}

/// The leakage is greatest at null: null is passed late by half the width, in either direction.
#[test]
fn null_is_passed_with_hysteresis_in_both_directions() {
    let mut settings = IDEAL.to_vec();
    settings.extend([
        "valve.null_bias=\"14 mV\"",
        "valve.hysteresis=\"128 mV\"",
        "bench.sample_time=\"10 ms\"",
    ]);
    let found = tested(&settings);
    let [command, a, b] =
        ["command_v", "pressure_a_bar", "pressure_b_bar"].map(|name| column(&found, "leakage.csv", name));
    let crossings: Vec<f64> = (6000..command.len() - 1)
        .filter(|row| (a[*row] - b[*row] > 0.0) != (a[row + 1] - b[row + 1] > 0.0))
        .map(|row| command[row])
        .collect();
    // equal pressures occur away from null if the edges differ, by an equal distance in either
    // direction
    assert_eq!(crossings.len(), 1, "{crossings:?}");
    let [falling, rising] = [crossings[0], {
        let back = tested(&[settings.as_slice(), &["bench.cycles=2", "bench.duration=\"480 s\""]].concat());
        let [command, a, b] =
            ["command_v", "pressure_a_bar", "pressure_b_bar"].map(|name| column(&back, "leakage.csv", name));
        let row = (20_000..28_000).find(|row| a[*row] < b[*row] && a[row + 1] >= b[row + 1]).unwrap();
        command[row]
    }];
    assert!((rising - falling - 0.128).abs() < 2e-3, "{rising} {falling}");
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let (first, again, other) = (tested(&[]), tested(&[]), tested(&["bench.seed=2"]));
    assert_eq!(first, again);
    assert!(first.files != other.files);
}
