//! The largest flow of the lines, for which the bores are sized.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use std::f64::consts::{FRAC_PI_4, PI};

use crate::run_command::{self, HOSE, candidate, derived, near, number, size_for_length};
use serde_json::Value;

const LITRE_PER_MINUTE: f64 = 1e-3 / 60.0;

/// The example with a valve of a data sheet, 24 L/min at 70 bar over both edges, and without a
/// stated pump.
fn rated() -> String {
    let (before, rest) = HOSE.split_once("[valve.flow_coefficients]").unwrap();
    let (_, after) = rest.split_once("[valve.leakage_coefficients]").unwrap();
    let valve = "nominal_flow = \"24 L/min\"\nnominal_pressure_drop = \"70 bar\"\n";
    let text = format!("{before}{valve}[valve.leakage_coefficients]{after}");
    text.lines().filter(|line| !line.starts_with("flow = ")).map(|line| format!("{line}\n")).collect()
}

fn sized(text: &str, settings: &[&str]) -> Value {
    size_for_length(text, settings, "1.5 m")
}

fn decision<'a>(size: &'a Value, word: &str) -> &'a str {
    let all = size["decisions"].as_array().unwrap().iter();
    all.map(|one| one["text"].as_str().unwrap()).find(|text| text.contains(word)).unwrap()
}

/// A rated flow refers to the rated drop: the valve passes more at a higher supply.
#[test]
fn the_valve_passes_more_than_its_rating_at_a_higher_supply() {
    for (supply, tank) in [(70.0, 0.0), (160.0, 0.0), (210.0, 10.0)] {
        let settings =
            [format!("supply.pressure=\"{supply} bar\""), format!("supply.tank_pressure=\"{tank} bar\"")];
        let size = sized(&rated(), &[&settings[0], &settings[1]]);
        let flow = 24.0 * LITRE_PER_MINUTE * ((supply - tank) / 70.0_f64).sqrt();
        near(number(&size, "maximum_flow_m3_per_s"), flow, 1e-9);
        near(number(&size, "valve_flow_m3_per_s"), flow, 1e-9);
        assert_eq!(size["maximum_flow_limit"], "valve");
        near(number(&size, "bore_range_m.0"), (4.0 * flow / (PI * 4.6)).sqrt(), 1e-9);
        let velocity = flow / (FRAC_PI_4 * 0.0127_f64.powi(2));
        near(
            number(candidate(&size, "eaton_synflex_3130_08", "uniform"), "oil_velocity_m_per_s"),
            velocity,
            1e-9,
        );
        let check = run_command::check(&rated(), &[&settings[0], &settings[1]]);
        near(derived(&check, "line.oil_velocity"), velocity, 1e-9);
    }
}

#[test]
fn the_pump_limits_what_the_valve_would_pass() {
    // ORIGIN: analytic, edges 3 and 6 of Table 5.1 in series at 70 bar: 39.07 L/min extending
    let [supplying, returning] = [3.2e-7_f64, 3.85e-7];
    let valve = (70e5 / (1.0 / supplying.powi(2) + 1.0 / returning.powi(2))).sqrt();
    for (pump, limit) in [(9.8, "pump"), (20.0, "pump"), (60.0, "valve")] {
        let size = sized(HOSE, &[&format!("supply.flow=\"{pump} L/min\"")]);
        near(number(&size, "maximum_flow_m3_per_s"), valve.min(pump * LITRE_PER_MINUTE), 1e-9);
        near(number(&size, "valve_flow_m3_per_s"), valve, 1e-9);
        assert_eq!(size["maximum_flow_limit"], limit);
        assert!(decision(&size, "Largest flow").contains(if limit == "pump" {
            "the valve passes up to 39.07 L/min without load"
        } else {
            "the pump gives 60.00 L/min"
        }));
    }
}

/// The pump fills the rod side of a differential cylinder, and the other line takes the return flow
/// of the larger area.
#[test]
fn a_line_carries_the_return_flow_of_the_larger_area() {
    let text = HOSE.replace("rod_diameter = \"22 mm\"", "rod_diameters = [\"0 mm\", \"36 mm\"]");
    assert_ne!(text, HOSE);
    let size = sized(&text, &[]);
    let ratio = 1.0 / (1.0 - (36.0_f64 / 50.0).powi(2));
    near(number(&size, "maximum_flow_m3_per_s"), 9.8 * LITRE_PER_MINUTE * ratio, 1e-9);
    let text = decision(&size, "Largest flow");
    assert!(text.contains("the pump's 9.800 L/min times the ratio of the areas"), "{text}");
}

/// The accumulator of the supply delivers more than the pump for a time.
#[test]
fn with_an_accumulator_the_pump_limits_nothing() {
    let pump = "supply.model=pump_limited";
    let gas = "supply.accumulator={ gas_volume = \"1 L\", precharge_pressure = \"40 bar\" }";
    assert_eq!(sized(HOSE, &[pump])["maximum_flow_limit"], "pump");
    let size = sized(HOSE, &[pump, gas]);
    near(number(&size, "maximum_flow_m3_per_s"), number(&size, "valve_flow_m3_per_s"), 1e-12);
    assert!(decision(&size, "Largest flow").contains("the supply's accumulator more for a time"));
}
