//! Further tests of the virtual bench: hysteresis and threshold, a second meter, and oil that
//! warms.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::run_command::{HOSE, answer};
use phea_workbench::answer::Answer;
use phea_workbench::command::Request;
use serde_json::Value;

const IDEAL: [&str; 6] = [
    "bench.pressure_noise=0",
    "bench.leak_meter.noise=0",
    "bench.low_flow_meter.noise=0",
    "bench.low_flow_meter.minimum=0",
    "bench.converter_bits=0",
    "bench.sample_time=\"200 ms\"",
];

fn bench(settings: &[&str]) -> Answer {
    answer(HOSE, settings, &[], &Request::Bench)
}

fn file(answer: &Answer, name: &str) -> String {
    let file = answer.files.iter().find(|one| one.name == name).expect("the file");
    String::from_utf8(file.bytes.clone()).unwrap()
}

fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let index = lines.next().unwrap().split(',').position(|column| column == name).expect("the column");
    lines.map(|line| line.split(',').nth(index).unwrap().parse().unwrap()).collect()
}

/// Results of the reversals: threshold and hysteresis in V, each with its interval.
fn shown(settings: &[&str]) -> [(f64, [f64; 2]); 2] {
    let found: Value = parsed(&bench(settings).json);
    let tests = found["tests"].as_array().unwrap();
    let reversals = &tests.iter().find(|one| one["name"] == "reversals").unwrap()["reversals"];
    ["threshold_v", "hysteresis_v"].map(|name| {
        let number = |value: &Value| value.as_f64().unwrap();
        let ends = &reversals[name]["confidence_95"];
        (number(&reversals[name]["value"]), [number(&ends[0]), number(&ends[1])])
    })
}

/// The reversals without noise show the declared values, whatever the null bias.
#[test]
fn ideal_reversals_show_the_declared_threshold_and_hysteresis() {
    for (threshold, width) in [(0.04, 0.128), (0.05, 0.055)] {
        let valve = [
            format!("valve.threshold=\"{threshold} V\""),
            format!("valve.hysteresis=\"{width} V\""),
            "valve.null_bias=\"14 mV\"".to_string(),
            "bench.reversals.size=0.02".to_string(),
        ];
        let valve: Vec<&str> = valve.iter().map(String::as_str).collect();
        let found = shown(&[&IDEAL[..], &valve[..]].concat());
        for ((value, _), truth) in found.into_iter().zip([threshold, width]) {
            assert!((value - truth).abs() < 2e-3 * width, "{value} is not {truth}");
        }
    }
}

/// Intervals with the noise of the instruments contain the truth and are narrow enough to be
/// useful.
#[test]
fn noisy_reversals_identify_the_threshold() {
    let valve = ["valve.threshold=\"40 mV\"", "valve.hysteresis=\"128 mV\"", "bench.reversals.size=0.02"];
    let [threshold, hysteresis] = shown(&[&valve[..], &["bench.low_flow_meter.range=\"5 L/min\""]].concat());
    for ((value, [low, high]), truth) in [(threshold, 0.04), (hysteresis, 0.128)] {
        let half = (high - low) / 2.0;
        assert!((value - truth).abs() < 2.0 * half, "{value} {low} {high}");
        assert!(half < 0.1 * truth, "{half} is too wide");
    }
}

/// A constant temperature adds its column and changes nothing else, and none of the further tests
/// changes the others.
#[test]
fn a_steady_temperature_changes_no_other_byte() {
    let usual = bench(&[]);
    let steady = bench(&["bench.oil_temperature.start=\"37 degC\"", "bench.low_flow_meter.amplitude=0.1"]);
    for name in ["leakage.csv", "metering.csv", "pressure_gain.csv"] {
        let without = |line: &str| line.rsplit_once(',').unwrap().0.to_string();
        let text = file(&steady, name);
        assert!(text.lines().next().unwrap().ends_with(",oil_temperature_degC"));
        let stripped: Vec<String> = text.lines().map(without).collect();
        assert_eq!(file(&usual, name).lines().collect::<Vec<_>>(), stripped);
        assert!(column(&text, "oil_temperature_degC").iter().all(|value| *value == 37.0));
    }
    assert_eq!(usual.files.len() + 1, steady.files.len());
}

/// Oil that is always ten degrees warmer: flow by the root of the density, leakage by the
/// viscosity.
#[test]
fn warm_oil_flows_by_its_density_and_leaks_by_its_viscosity() {
    let ideal = [&IDEAL[..], &["bench.flow_meter.noise=0", "bench.flow_meter.pressure_drop=0"]].concat();
    let warm = [
        &ideal[..],
        &[
            "bench.oil_temperature.start=\"47 degC\"",
            "bench.oil_temperature.end=\"47 degC\"",
            "bench.oil_temperature.reference=\"37 degC\"",
        ],
    ]
    .concat();
    let (cold, warm) = (bench(&ideal), bench(&warm));
    let of = |answer: &Answer, name: &str, signal: &str| column(&file(answer, name), signal);
    // ORIGIN: analytic, sqrt(1/(1 - 7e-4 10)) and exp(0.045 10)
    let (turbulent, laminar) = (1.003_518_47, 1.568_312_19);
    let [cold_flow, warm_flow] = [&cold, &warm].map(|one| of(one, "metering.csv", "flow_l_per_min")[300]);
    assert!((warm_flow / cold_flow / turbulent - 1.0).abs() < 1e-6, "{warm_flow} {cold_flow}");
    let null = |answer: &Answer| {
        let leak = of(answer, "leakage.csv", "leak_flow_l_per_min");
        [leak[0], leak[300]]
    };
    let ([cold_null, cold_base], [warm_null, warm_base]) = (null(&cold), null(&warm));
    assert!((warm_base / cold_base / turbulent - 1.0).abs() < 1e-5);
    assert!(((warm_null - warm_base) / (cold_null - cold_base) / laminar - 1.0).abs() < 1e-4);
}

/// The small meter takes more of the pressure, and reads flows where the large one reads zero.
#[test]
fn two_meters_have_two_ranges() {
    let found = bench(&[
        "bench.flow_meter.minimum=\"3 L/min\"",
        "bench.low_flow_meter.minimum=\"0.1 L/min\"",
        "bench.sample_time=\"500 ms\"",
    ]);
    let (large, small) = (file(&found, "metering.csv"), file(&found, "metering_low_flow.csv"));
    let turning = |text: &str| {
        let flows = column(text, "flow_l_per_min");
        flows.into_iter().filter(|flow| *flow > 0.0).fold(f64::INFINITY, f64::min)
    };
    assert!(turning(&large) > 2.7 && turning(&small) < 0.3);
    let drop_at = |text: &str, flow: f64| {
        let flows = column(text, "flow_l_per_min");
        let row = flows.iter().position(|one| *one > flow).unwrap();
        column(text, "pressure_a_bar")[row] - column(text, "pressure_b_bar")[row]
    };
    assert!(drop_at(&small, 4.0) > 20.0 * drop_at(&large, 4.0));
}
