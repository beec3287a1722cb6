//! Numbers of section 5.2 of the thesis, read from recorded tests: the published ones for the
//! published valve, and those derived from the declaration of that valve.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use crate::run_command::{HOSE, answer, json, load};
use phea_workbench::command::{IdentifyRequest, Request, identify_watched};
use phea_workbench::source::Memory;
use serde_json::Value;

const IDEAL: [&str; 7] = [
    "bench.pressure_noise=0",
    "bench.leak_meter.noise=0",
    "bench.flow_meter.noise=0",
    "bench.flow_meter.minimum=0",
    "bench.flow_meter.pressure_drop=0",
    "bench.converter_bits=0",
    "bench.sample_time=\"200 ms\"",
];

/// Null bias and hysteresis that section 5.2.1 measured.
const MEASURED: [&str; 4] = [
    "valve.null_bias=\"14 mV\"",
    "valve.hysteresis=\"128 mV\"",
    // two cycles, so that null is passed in both directions
    "bench.duration=\"480 s\"",
    "bench.cycles=2",
];

/// One coefficient for all edges, and the rated flow as rounded in the thesis.
fn equal_edges() -> Vec<String> {
    let edges = ["supply_to_a", "a_to_tank", "supply_to_b", "b_to_tank"];
    let each = edges.into_iter().flat_map(|edge| {
        [
            format!("valve.flow_coefficients.{edge}=2.97e-7"),
            format!("valve.leakage_coefficients.{edge}=2.488e-9"),
        ]
    });
    let rated = ["valve.nominal_flow=6.31e-4", "valve.nominal_pressure_drop=\"70 bar\""];
    each.chain(rated.map(str::to_string)).collect()
}

/// The complete answer of `identify` to the tests of the bench.
fn identified(settings: &[&str]) -> phea_workbench::answer::Answer {
    let recorded = answer(HOSE, settings, &[], &Request::Bench).files;
    let files: Vec<String> = recorded.iter().map(|file| file.name.clone()).collect();
    let source = recorded.into_iter().fold(Memory::default(), |source, file| {
        source.with(&file.name, String::from_utf8(file.bytes).unwrap())
    });
    let request = IdentifyRequest { files, starts: Some(1), ..IdentifyRequest::default() };
    identify_watched(&source, Some(&load(HOSE, settings, &[])), &request, &mut |_| true).unwrap()
}

fn numbers(settings: &[&str]) -> Value {
    let found: Value = parsed(&identified(settings).json);
    found["simple_calculations"].clone()
}

#[track_caller]
fn near(numbers: &Value, name: &str, expected: f64, fraction: f64) {
    let found = numbers[name].as_f64().unwrap_or_else(|| panic!("no {name} in {numbers}"));
    assert!((found / expected - 1.0).abs() < fraction, "{name}: {found:e} is not {expected:e}");
}

/// The first column of Table 5.1 with one curve for the whole leakage, as in equations 4.12 to
/// 4.14: the calculations return every number printed in section 5.2.
#[test]
fn the_published_numbers_are_identified_from_their_valve() {
    let edges = equal_edges();
    let edges: Vec<&str> = edges.iter().map(String::as_str).collect();
    let settings = [&IDEAL[..], &MEASURED, &edges, &["valve.leakage_model=one_curve"]].concat();
    let found = numbers(&settings);
    // ORIGIN: thesis section 5.2.1
    near(&found, "tare_flow_m3_per_s", 7.55e-6, 1e-3);
    near(&found, "null_leakage_m3_per_s", 9.31e-6, 5e-3);
    near(&found, "tare_fraction", 0.4477, 5e-3);
    near(&found, "leakage_coefficient", 2.488e-9, 5e-3);
    near(&found, "null_rising_v", 0.078, 2e-2);
    near(&found, "null_falling_v", -0.05, 4e-2);
    // ORIGIN: thesis section 5.2.2
    near(&found, "flow_coefficient_extending", 2.97e-7, 5e-3);
    near(&found, "flow_coefficient_retracting", 2.97e-7, 5e-3);
    near(&found, "fraction_of_nominal_flow", 0.88, 5e-3);
}

/// The optimised column of Table 5.1 on the bench of the example, with its instruments. Tare flow
/// and nulls agree with those read from the curves of the thesis. The others cannot: the optimised
/// edges are unequal, and two of them in series pass less than a mean of the four; and its leakage
/// coefficients are all below the 2.488e-9 of the peak.
#[test]
fn the_optimised_valve_agrees_where_comparable() {
    let found = numbers(&MEASURED);
    // ORIGIN: thesis section 5.2.1
    near(&found, "tare_flow_m3_per_s", 7.55e-6, 5e-3);
    // the curve of unequal edges is not even about null: its centre is 8 mV below, in both
    // directions
    for (name, published) in [("null_rising_v", 0.078), ("null_falling_v", -0.05)] {
        let offset: f64 = found[name].as_f64().unwrap() - published;
        assert!((-0.016..0.0).contains(&offset), "{name}: {offset}");
    }
    near(&found, "hysteresis_v", 0.128, 2e-2);
    // ORIGIN: analytic, sqrt(2) K_i K_j/sqrt(K_i^2 + K_j^2) of edges 3 and 6, and 4 and 5, of
    // thesis Table 5.1
    near(&found, "flow_coefficient_extending", 3.4803e-7, 1e-2);
    near(&found, "flow_coefficient_retracting", 2.2086e-7, 1e-2);
    let number = |name: &str| found[name].as_f64().unwrap();
    let mean = f64::midpoint(number("flow_coefficient_extending"), number("flow_coefficient_retracting"));
    assert!((0.95..0.965).contains(&(mean / 2.97e-7)), "4 % below the published one: {mean:e}");
    assert!((0.90..0.96).contains(&(number("null_leakage_m3_per_s") / 9.31e-6)));
    // an interval contains its true value
    let interval = |name: &str| -> [f64; 2] {
        serde_json::from_value(found["confidence_95"][name].clone()).unwrap_or_else(|_| panic!("{name}"))
    };
    let [low, high] = interval("tare_flow_m3_per_s");
    assert!(low <= 7.56e-6 && high >= 7.54e-6 && high - low < 2e-8, "{low:e} {high:e}");
}

/// Intervals of nulls and hysteresis read from the leakage contain the truth. Readings from the
/// flow or the pressures only have an interval too, whatever their accuracy: straight lines through
/// the flow give a null 8 mV too high, because the spool still remembers the reversal where they
/// begin.
#[test]
fn nulls_and_derived_quantities_have_intervals() {
    // ORIGIN: thesis section 5.2.1, and the null between its two directions
    const TRUTH: [(&str, f64); 4] = [
        ("null_rising_v", 0.078),
        ("null_falling_v", -0.05),
        ("null_bias_v", 0.014),
        ("hysteresis_v", 0.128),
    ];
    const SEEDS: u32 = 8;
    const ALL: [&str; 3] = ["leakage.csv", "metering.csv", "pressure_gain.csv"];
    let edges = equal_edges();
    let edges: Vec<&str> = edges.iter().map(String::as_str).collect();
    let model = ["valve.leakage_model=one_curve", "bench.sample_time=\"1 s\""];
    let settings = [&MEASURED[..], &edges, &model].concat();
    let of = |found: &Value, name: &str| -> [f64; 2] {
        serde_json::from_value(found["confidence_95"][name].clone()).expect(name)
    };
    let read: Vec<Value> = (1..=SEEDS).map(|seed| read_from(&ALL, &settings, seed)).collect();
    for (name, truth) in TRUTH {
        let all: Vec<[f64; 2]> = read.iter().map(|found| of(found, name)).collect();
        let held = all.iter().filter(|[low, high]| (*low..=*high).contains(&truth)).count();
        // ORIGIN: analytic, 8 trials at 95 %: 6 or more with a probability of 99.4 %
        assert!(held >= 6, "{name}: {held} of {SEEDS}: {all:?}");
        // ORIGIN: analytic, noise of 0.005 L/min over the slope of the flank, 2.9 L/(min V), at
        // both ends
        assert!(all.iter().all(|[low, high]| high - low < 0.02), "{name}: {all:?}");
    }
    let [low, high] = of(&read[0], "tare_fraction");
    let fraction = read[0]["tare_fraction"].as_f64().unwrap();
    assert!(low < fraction && fraction < high && high - low < 0.02 * fraction, "{low} {fraction} {high}");
    assert_eq!(read[0]["null_methods"], serde_json::json!(["leakage_centre", "leakage_centre"]));
    for (file, method) in [("metering.csv", "flow_lines"), ("pressure_gain.csv", "equal_pressures")] {
        let found = read_from(&[file], &[&settings[..], &["bench.sample_time=\"2 s\""]].concat(), 1);
        assert_eq!(found["null_methods"], serde_json::json!([method, method]));
        for (name, _) in TRUTH {
            let [low, high] = of(&found, name);
            let value = found[name].as_f64().unwrap();
            assert!(low < value && value < high && high - low < 0.15, "{file} {name}: {low} {value} {high}");
        }
    }
}

/// The numbers of section 5.2 from some files of the bench.
fn read_from(files: &[&str], settings: &[&str], seed: u32) -> Value {
    let seed = format!("bench.seed={seed}");
    let settings = [settings, &[&seed]].concat();
    let recorded = answer(HOSE, &settings, &[], &Request::Bench).files;
    let source = recorded.into_iter().fold(Memory::default(), |source, file| {
        source.with(&file.name, String::from_utf8(file.bytes).unwrap())
    });
    let files: Vec<String> = files.iter().map(|file| (*file).to_string()).collect();
    let request = IdentifyRequest { files, starts: Some(1), ..IdentifyRequest::default() };
    let found =
        identify_watched(&source, Some(&load(HOSE, &settings, &[])), &request, &mut |_| true).unwrap();
    let found: Value = parsed(&found.json);
    found["simple_calculations"].clone()
}

/// The flow gain, and the flow-pressure coefficient computed from it and the pressure sensitivity,
/// are those of the linear model of the identified valve.
#[test]
fn slopes_at_null_are_those_of_the_linear_model() {
    let edges = equal_edges();
    let edges: Vec<&str> = edges.iter().map(String::as_str).collect();
    let fine = ["bench.pressure_gain_amplitude=0.01", "bench.sample_time=\"100 ms\""];
    let settings = [&IDEAL[..], &edges, &fine].concat();
    let found = numbers(&settings);
    let derived = json(HOSE, &settings, &[], &Request::Check);
    let derived = |name: &str| -> f64 {
        let all = derived["derived"].as_array().unwrap();
        let one = all.iter().find(|one| one["name"] == name).unwrap_or_else(|| panic!("no {name}"));
        one["value"].as_f64().unwrap()
    };
    let gain = derived("valve.flow_gain_extending");
    near(&found, "flow_gain_extending_m3_per_s_v", gain, 3e-3);
    near(&found, "flow_gain_retracting_m3_per_s_v", gain, 3e-3);
    near(&found, "flow_pressure_coefficient", derived("valve.flow_pressure_coefficient_extending"), 1e-2);
}

/// The pressure sensitivity of valves that leak less and less, with fewer and fewer rows about
/// null: ORIGIN: analytic, p_A - p_B with shut ports by both pairs of edges as dividers, its slope
/// where both pressures are equal.
#[test]
fn the_pressure_sensitivity_is_that_of_the_dividers() {
    let [flow, leak] = [[3.2e-7, 2.5e-7, 2.0e-7, 3.85e-7], [2.35e-9, 2.2e-9, 1.7e-9, 2.35e-9]];
    for fraction in [1.0, 0.4, 0.2] {
        let load = |command: f64| {
            let u = command / 10.0;
            let secant = 1.0 / phea_dynamics::portable::cosh(100.0 * u);
            let [forward, backward] = [u.max(0.0), (-u).max(0.0)];
            let openings = [forward, backward, backward, forward];
            let edge = |index: usize| flow[index] * openings[index] + fraction * leak[index] * secant;
            let between = |supply: f64, tank: f64| supply * supply / (supply * supply + tank * tank);
            70e5 * (between(edge(0), edge(1)) - between(edge(2), edge(3)))
        };
        let [mut low, mut high] = [-0.2, 0.2];
        while high - low > 1e-9 {
            let middle = 0.5 * (low + high);
            if load(middle) < 0.0 { low = middle } else { high = middle }
        }
        let truth = (load(high + 1e-5) - load(low - 1e-5)) / (high - low + 2e-5);
        let edges = leak.map(|one| format!("{:e}", fraction * one)).join(", ");
        let setting = format!("valve.leakage_coefficients=[{edges}]");
        let settings = [&setting, "valve.leakage_shape=100", "bench.duration=\"480 s\""];
        let found = numbers(&settings);
        let value = found["pressure_sensitivity_pa_per_v"].as_f64().unwrap();
        let interval = &found["confidence_95"]["pressure_sensitivity_pa_per_v"];
        let [low, high] = [0, 1].map(|end| interval[end].as_f64().unwrap());
        // the curve is not quite a cubic with a kink: 1 % remains
        assert!((value / truth - 1.0).abs() < 0.02, "{fraction}: {truth}, {value}");
        assert!((0.98 * low..1.02 * high).contains(&truth) && high - low < 0.2 * truth, "{low} {high}");
    }
}

/// The flow gain of a valve with an overlap is that beyond the overlap, and is not called the gain
/// at null: K_c at null does not follow from it.
#[test]
fn the_numbers_of_a_valve_with_lap_state_their_command() {
    let overlap = "valve.lap={ positive = 0.003, negative = 0.003 }";
    let [with, without] = [vec![overlap], vec![]].map(|lap| identified(&[&MEASURED[..], &lap].concat()));
    let [of_lap, proportional] = [&with, &without].map(|answer| -> Value {
        let found: Value = parsed(&answer.json);
        found["simple_calculations"].clone()
    });
    for found in [&of_lap, &proportional] {
        // ORIGIN: analytic, K_i K_j/sqrt(K_i^2 + K_j^2) sqrt(p_S)/U_n of thesis Table 5.1, edges 3
        // and 6, and 4 and 5, at 70 bar
        near(found, "flow_gain_extending_m3_per_s_v", 6.511e-5, 1e-2);
        near(found, "flow_gain_retracting_m3_per_s_v", 4.132e-5, 1e-2);
        near(found, "flow_gain_pressure_pa", 7e6, 1e-3);
        near(found, "leakage_pressure_pa", 7e6, 1e-3);
        // 3 and 15 % of 10 V
        assert_eq!(found["flow_gain_commands_v"], serde_json::json!([0.3, 1.5]));
    }
    assert!(
        of_lap["flow_pressure_coefficient"].is_null() && proportional["flow_pressure_coefficient"].is_f64()
    );
    for words in ["flow gain beyond the lap K_qU, positive command", "between 300 mV and 1.5 V from null"] {
        assert!(with.text.contains(words), "{words} is not in\n{}", with.text);
    }
    assert!(!with.text.contains("at null K_qU") && !with.text.contains("at null K_c  "), "{}", with.text);
    assert!(without.text.contains("flow gain at null K_qU, positive command"), "{}", without.text);
}

/// The numbers are printed with their equations and the published values.
#[test]
fn the_table_is_next_to_the_published_numbers() {
    let text = identified(&MEASURED).text;
    for words in ["Numbers of section 5.2", "tare flow in the leakage at null", "2.488e-9", "42.6 to 65.0 %"]
    {
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
}

/// The recordings next to the example are those of its bench, byte for byte; every figure of
/// chapter 5 is drawn from them, and the identified valve is the one that produced them.
#[test]
fn the_recordings_of_the_example_are_made_by_its_bench() {
    const BENCH: &str = include_str!("../../../examples/ybitu/bench.toml");
    const RECORDED: [(&str, &str); 4] = [
        ("leakage.csv", include_str!("../../../examples/ybitu/recorded/leakage.csv")),
        ("metering.csv", include_str!("../../../examples/ybitu/recorded/metering.csv")),
        ("pressure_gain.csv", include_str!("../../../examples/ybitu/recorded/pressure_gain.csv")),
        ("metering_low_flow.csv", include_str!("../../../examples/ybitu/recorded/metering_low_flow.csv")),
    ];
    let made = answer(BENCH, &[], &[], &Request::Bench).files;
    assert_eq!(made.len(), RECORDED.len());
    for (file, (name, text)) in made.iter().zip(RECORDED) {
        assert_eq!(file.name, name);
        assert!(file.bytes == text.as_bytes(), "{name} is not what the bench makes");
    }
    let source = RECORDED
        .into_iter()
        .fold(Memory::default(), |source, (name, text)| source.with(&format!("recorded/{name}"), text));
    let request = IdentifyRequest { starts: Some(1), figures: true, ..IdentifyRequest::default() };
    let found = identify_watched(&source, Some(&load(BENCH, &[], &[])), &request, &mut |_| true).unwrap();
    let drawn: Vec<&str> = found.files.iter().filter_map(|file| file.name.strip_suffix(".svg")).collect();
    // ORIGIN: thesis Figures 5.3, 5.6, 5.4, 5.7, 5.8, the pressure gain, 5.5, 5.9, 5.10, the
    // sensitivity, 5.11, 5.12
    let expected = [
        "circuit_blocked",
        "circuit_joined",
        "series_1_leakage",
        "series_2_metering",
        "series_3_metering_low_flow",
        "series_4_pressure_gain",
        "leakage_both_ways",
        "flow_gain",
        "flow_gain_at_null",
        "pressure_sensitivity",
        "test_and_model_rising",
        "test_and_model_falling",
        "residuals",
    ];
    assert_eq!(drawn, expected);
    let numbers: Value = parsed(&found.json);
    let edges = &numbers["flow_coefficients"];
    // ORIGIN: thesis Table 5.1
    for (edge, truth) in
        [("supply_to_a", 3.2e-7), ("a_to_tank", 2.5e-7), ("supply_to_b", 2.0e-7), ("b_to_tank", 3.85e-7)]
    {
        let value = edges[edge]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 2e-3, "{edge}: {value:e}");
    }
}
