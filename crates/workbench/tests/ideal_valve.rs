//! A valve without leakage: the limit of equal leakage that tends to zero.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::run_command::{self, HOSE, derived};
use phea_workbench::engineering::rig::Rig;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

const EDGES: &str =
    "valve.flow_coefficients={ supply_to_a = 3e-7, a_to_tank = 3e-7, supply_to_b = 3e-7, b_to_tank = 3e-7 }";

fn rig(leakage: [f64; 4], settings: &[&str]) -> Result<Rig, String> {
    // values of the linear model stated in `[uncertainty]` would replace those that follow from the
    // valve
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let source = Memory::default().with("p.toml", format!("{start}[[specification]]{end}"));
    let leakage = format!("valve.leakage_coefficients={leakage:?}");
    let settings: Vec<String> =
        [EDGES, &leakage].iter().chain(settings).map(|setting| setting.to_string()).collect();
    let read = project::read(&source, "p.toml", &settings, &[]).map_err(|report| report.to_string())?;
    Setup::rig_of(&read.project).map_err(|error| error.to_string())
}

/// Null of an ideal valve: p_A and p_B are halfway between supply and tank, K_c vanishes, and K_qU
/// = K_v root((p_S - p_T)/2)/U_Cn; under a load p_A + p_B = p_S + p_T.
#[test]
fn an_ideal_valve_is_the_limit_of_equal_leakage() {
    for (tank, supply) in [(0.0, 70e5), (4e5, 100e5)] {
        let pressures = [format!("supply.tank_pressure={tank}"), format!("supply.pressure={supply}")];
        let pressures: Vec<&str> = pressures.iter().map(String::as_str).collect();
        let ideal = rig([0.0; 4], &pressures).unwrap();
        let middle = 0.5 * (supply + tank);
        for pressure in [ideal.point.pressure_a, ideal.point.pressure_b] {
            assert!((pressure / middle - 1.0).abs() < 1e-12, "{pressure}");
        }
        // ORIGIN: analytic, equal edges at null
        let gain = 3e-7 * (0.5 * (supply - tank)).sqrt() / 10.0;
        assert!((ideal.linear.flow_gain / gain - 1.0).abs() < 1e-6, "{:e}", ideal.linear.flow_gain);
        let mut before = f64::INFINITY;
        for leakage in [1e-10, 1e-12, 1e-14] {
            let near = rig([leakage; 4], &pressures).unwrap();
            let coefficient = near.linear.flow_pressure_coefficient;
            assert!((coefficient / before - 0.01).abs() < 1e-3 || before.is_infinite());
            assert!(ideal.linear.flow_pressure_coefficient == 0.0 && coefficient > 0.0);
            assert!((near.linear.flow_gain / ideal.linear.flow_gain - 1.0).abs() < leakage / 1e-12);
            assert!((near.point.pressure_a / ideal.point.pressure_a - 1.0).abs() < 1e-12);
            before = coefficient;
        }
        for force in [-3e3, 500.0, 4e3] {
            let force = format!("operating_point.load_force={force}");
            let settings: Vec<&str> = pressures.iter().copied().chain([force.as_str()]).collect();
            let [ideal, near] = [0.0, 1e-14].map(|leakage| rig([leakage; 4], &settings).unwrap());
            let sum = ideal.point.pressure_a + ideal.point.pressure_b;
            assert!((sum / (supply + tank) - 1.0).abs() < 1e-6, "{sum}");
            assert!((ideal.point.pressure_a / near.point.pressure_a - 1.0).abs() < 1e-6);
        }
    }
}

/// The settings of an ideal valve in a project without stated linear parameters.
fn ideal_project() -> String {
    let (start, rest) = HOSE.split_once("[uncertainty]").unwrap();
    let (_, end) = rest.split_once("[[specification]]").unwrap();
    let stated = ["flow_gain = 5.62e-5", "flow_pressure_coefficient = 6.42e-13"];
    let start = stated.iter().fold(start.to_string(), |text, one| text.replace(one, ""));
    format!("{start}[[specification]]{end}")
}

/// Printed values for an ideal valve are the limits: zero if the leakage is a factor, infinite if
/// something is divided by it, and no number of its stand-in.
#[test]
fn no_command_prints_the_substitute_of_an_ideal_valve() {
    let text = ideal_project();
    let range = "uncertainty={ \"supply.pressure\" = { nominal = \"70 bar\", minimum = \"60 bar\", maximum = \"80 bar\" } }";
    let differential = text.replace("rod_diameter = \"22 mm\"", "rod_diameters = [\"22 mm\", \"36 mm\"]");
    let cases = [
        (&text, vec![]),
        (&text, vec!["operating_point.load_force=4e3"]),
        (&text, vec![range]),
        (&differential, vec!["supply.model=pump_limited"]),
    ];
    for (text, more) in cases {
        let settings = [vec![EDGES, "valve.leakage_coefficients=[0, 0, 0, 0]"], more].concat();
        let check = run_command::check(text, &settings);
        for name in ["linear.flow_pressure_coefficient", "valve.flow_pressure_a", "dynamics.hydraulic_pole"] {
            assert_eq!(derived(&check, name), 0.0, "{name} {settings:?}");
        }
        let rows = check["derived"].as_array().unwrap();
        let gain = rows.iter().find(|row| row["name"] == "valve.pressure_gain").unwrap();
        assert!(gain["value"].is_null() && gain["reason"].as_str().unwrap().starts_with("infinite"));
        let linear = run_command::linearize(text, &settings);
        assert_eq!(linear["plant"]["command"]["poles"][0].to_string(), "[0.0,0.0]");
        for number in
            [check, linear, run_command::size_for_length(text, &settings, "1.5 m")].iter().flat_map(numbers)
        {
            assert!(number == 0.0 || number.abs() > 1e-17, "{number:e} {settings:?}");
        }
    }
}

/// Numbers in an answer.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Number(number) => vec![number.as_f64().unwrap()],
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        Value::Object(all) => all.values().flat_map(numbers).collect(),
        _ => vec![],
    }
}

/// A valve of which only some edges leak has no such limit.
#[test]
fn one_edge_without_leakage_is_refused() {
    let refused = rig([2e-9, 0.0, 2e-9, 2e-9], &[]).unwrap_err();
    assert!(refused.contains("state four zeros for an ideal valve"), "{refused}");
}
