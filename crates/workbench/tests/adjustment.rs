//! An adjustable accumulator, from the project's keys to plant, family, verdict, simulation and
//! output.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::Request;

use super::plant_of_verdicts::{assert_nominal_is_the_rig, responses, without_uncertainty};
use super::run_command::{answer, check, derived, json, near, project_of, try_answer};

const GAS: &str = include_str!("../../../examples/ybitu/accumulator.toml");
const LIMIT: &str =
    "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1, 10, 100] }]";

fn accumulator(gas_volume: &str, precharge: &str, more: &str) -> String {
    format!(
        "line.accumulator={{ gas_volume = \"{gas_volume}\", precharge_pressure = \"{precharge}\", polytropic_exponent = 1.2{more} }}"
    )
}

const MOVED: &str = ", adjustment = { kind = \"gas\", gas_volume = \"14 mL\", precharge_pressure = \"11 bar\", setting = SETTING }";
const VALVE: &str = ", adjustment = { kind = \"valve\", flow = \"20 L/min\", pressure_drop = \"5 bar\", transition_pressure = \"0.5 bar\", setting = SETTING }";

fn at(adjustment: &str, setting: f64) -> String {
    accumulator("6 mL", "15 bar", &adjustment.replace("SETTING", &setting.to_string()))
}

/// Rigs with which the plants are compared: two pressures, a stated one, a limited pump, and lines
/// with waves.
const RIGS: [&[&str]; 4] = [
    &[],
    &["linear.hydraulic_stiffness=2e6"],
    &["supply.model=pump_limited"],
    &["line.model=transmission_line"],
];

fn widest(one: &phea_workbench::project::Project, other: &phea_workbench::project::Project) -> f64 {
    let gaps = [1e-3, 1.0, 30.0, 300.0, 900.0].into_iter().flat_map(|frequency| {
        let [one, other] = [one, other].map(|project| responses(project, frequency));
        [0, 1].map(|path| (other[path] / one[path] - 1.0).norm_sqr().sqrt())
    });
    gaps.fold(0.0, f64::max)
}

/// A fixed setting is equivalent to an accumulator declared with the corresponding values, in every
/// form of the plant.
#[test]
fn a_setting_is_the_declared_accumulator() {
    let text = without_uncertainty(GAS);
    for settings in RIGS {
        for (setting, volume, precharge) in
            [(0.0, "6 mL", "15 bar"), (0.25, "8 mL", "14 bar"), (1.0, "14 mL", "11 bar")]
        {
            let of = |one: &str| project_of(&text, &[settings, &[one]].concat());
            let (adjusted, declared) = (of(&at(MOVED, setting)), of(&accumulator(volume, precharge, "")));
            assert!(widest(&adjusted, &declared) < 1e-9, "{settings:?} at {setting}");
        }
    }
}

/// A shut valve leaves the rig without an accumulator; an opening one does not.
#[test]
fn a_shut_valve_disconnects_the_accumulator() {
    let text = without_uncertainty(GAS);
    let (before, after) = text.split_once("[line.accumulator]").unwrap();
    let (_, after) = after.split_once("\n[").unwrap();
    let bare = format!("{before}[{after}");
    for settings in RIGS {
        let of = |text: &str, more: &[&str]| project_of(text, &[settings, more].concat());
        let none = of(&bare, &[]);
        assert!(widest(&of(&text, &[&at(VALVE, 0.0)]), &none) < 1e-9, "{settings:?}");
        assert!(widest(&of(&text, &[&at(VALVE, 0.5)]), &none) > 1e-2, "{settings:?}");
    }
}

/// The nominal member of the recorded family is the rig, with the setting open.
#[test]
fn the_family_is_the_rig_at_its_nominal() {
    for adjustment in [MOVED, VALVE] {
        let opened = "uncertainty={ \"line.accumulator.adjustment.setting\" = { nominal = 0.5, minimum = 0.1, maximum = 1, points = 3 } }";
        for settings in &RIGS[..3] {
            let own = at(adjustment, 0.5);
            let project =
                project_of(&without_uncertainty(GAS), &[settings, &[own.as_str(), opened][..]].concat());
            assert_nominal_is_the_rig(&project, settings);
        }
    }
}

/// Stiffness at both ends of the setting and between them: that of accumulators declared with these
/// values.
#[test]
fn check_derives_the_stiffness_of_each_setting() {
    let text = without_uncertainty(GAS);
    let output = check(&text, &[&at(MOVED, 0.25)]);
    for (name, volume, precharge) in
        [("0", "6 mL", "15 bar"), ("half", "10 mL", "13 bar"), ("1", "14 mL", "11 bar")]
    {
        let declared = check(&text, &[&accumulator(volume, precharge, "")]);
        let found = derived(&output, &format!("stiffness.at_setting_{name}"));
        near(found, derived(&declared, "stiffness.with_accumulators"), 1e-9);
    }
    let valve = check(&text, &[&at(VALVE, 0.5)]);
    near(derived(&valve, "stiffness.at_setting_0"), derived(&valve, "stiffness.without_accumulators"), 1e-12);
    near(derived(&valve, "stiffness.at_setting_1"), derived(&valve, "stiffness.with_accumulators"), 1e-12);
}

/// Settings that a verdict does not cover are reported.
#[test]
fn a_verdict_reports_that_settings_are_frozen() {
    let text = without_uncertainty(GAS);
    let warned = |more: &[&str]| {
        json(&text, &[&[LIMIT], more].concat(), &[], &Request::Verify { proof: false, on_machine: false })
            .to_string()
    };
    let moved = warned(&[&at(MOVED, 0.25)]);
    assert!(moved.contains("line.accumulator.adjustment is counted at its setting of rest, 0.25"), "{moved}");
    let valve = warned(&[&at(VALVE, 0.5)]);
    assert!(valve.contains("has no drop at rest"), "{valve}");
    assert!(!warned(&[&accumulator("6 mL", "15 bar", "")]).contains("adjustment"));
    let models = answer(&text, &[&at(VALVE, 0.5)], &[], &Request::Linearize { sweep: None }).text();
    assert!(models.contains("the valve of line.accumulator.adjustment is counted in the plant"), "{models}");
}

/// A simulation of a moving setting states its work; one of a setting beyond its range is rejected.
#[test]
fn a_simulation_reports_the_work_of_a_setting() {
    let text = without_uncertainty(GAS);
    let scenario = |change: &str| {
        format!(
            "scenario=[{{ name = \"moves\", duration = \"0.3 s\", reference = {{ at = 0, force = \"1 kN\" }}, setting_change = {change} }}]"
        )
    };
    let ramp = scenario("{ kind = \"ramp\", change = 0.75, start = \"0.05 s\", duration = \"0.1 s\" }");
    let run = |adjustment: &str, scenario: &str| {
        json(&text, &[&at(adjustment, 0.25), scenario], &[], &Request::Simulate(Default::default()))
    };
    let found = run(MOVED, &ramp);
    let scenario_of = &found["scenarios"][0];
    assert_eq!(scenario_of["status"], "completed", "{found}");
    assert_eq!(scenario_of["events"][0]["kind"], "setting_change", "{found}");
    let work = |name: &str| scenario_of[name].as_f64().unwrap();
    assert!(work("adjustment_brought_j") + work("adjustment_taken_j") > 1e-3, "{found}");
    let steps = scenario("[{ at = \"0.05 s\", change = 0.75 }, { at = \"0.2 s\", change = -0.25 }]");
    let switched = run(VALVE, &steps);
    assert_eq!(switched["scenarios"][0]["status"], "completed", "{switched}");
    assert_eq!(switched["scenarios"][0]["adjustment_brought_j"], 0.0);
    let beyond = scenario("{ kind = \"sine\", amplitude = 0.8, frequency = \"5 Hz\" }");
    let settings_beyond = [at(MOVED, 0.25), beyond];
    let refused = try_answer(
        &text,
        &[&settings_beyond[0], &settings_beyond[1]],
        &[],
        &Request::Simulate(Default::default()),
    )
    .unwrap_err()
    .to_string();
    assert!(refused.contains("a setting stays from 0 to 1"), "{refused}");
}

/// A run of the rig with this accumulator and scenario: its answer and its rows.
fn rows_of(settings: &[&str]) -> (serde_json::Value, Vec<std::collections::BTreeMap<String, f64>>) {
    let found = answer(&without_uncertainty(GAS), settings, &[], &Request::Simulate(Default::default()));
    let file = found.files.iter().find(|file| file.name == "moves.csv").unwrap();
    let text = String::from_utf8(file.bytes.clone()).unwrap();
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells = line.split(',').zip(&heads);
        cells.map(|(cell, head)| ((*head).to_string(), cell.parse().unwrap_or(f64::NAN))).collect()
    };
    (parsed(&found.json), lines.map(row).collect())
}

/// The loss in the valves is the integral of their drops times their flows, which the rows contain
/// too.
#[test]
fn the_loss_of_switching_is_reported() {
    let scenario = "scenario=[{ name = \"moves\", duration = \"0.3 s\", output_step = \"0.02 ms\", reference = [{ at = 0, force = \"1 kN\" }, \
         { at = \"0.05 s\", force = \"3 kN\" }], setting_change = [{ at = \"0.15 s\", change = 0.5 }] }]";
    let (found, rows) = rows_of(&[&at(VALVE, 0.0), scenario]);
    let output = found["scenarios"][0]["gas_valve_throttled_j"].as_f64().unwrap();
    // ORIGIN: analytic, q = s K dp/(dp^2 + dp_t^2)^(1/4) with the flow of 20 L/min at 5 bar wide
    // open
    let coefficient = 20e-3 / 60.0 / 5e5_f64.sqrt();
    let mut expected = 0.0;
    for two in rows.windows(2) {
        let length = two[1]["time_s"] - two[0]["time_s"];
        // the setting steps between two rows
        let opening = two[1]["setting_a_ratio"].min(two[0]["setting_a_ratio"]);
        for side in ["a", "b"] {
            let power = |row: &std::collections::BTreeMap<String, f64>| {
                let drop =
                    (row[&format!("pressure_{side}_pa")] - row[&format!("gas_pressure_{side}_pa")]).abs();
                drop * opening * coefficient * drop / (drop * drop + 0.5e5 * 0.5e5).sqrt().sqrt()
            };
            expected += 0.5 * length * (power(&two[0]) + power(&two[1]));
        }
    }
    assert!(output > 0.05 && (output / expected - 1.0).abs() < 1e-3, "{output} {expected}");
    let text = answer(
        &without_uncertainty(GAS),
        &[&at(VALVE, 0.0), scenario],
        &[],
        &Request::Simulate(Default::default()),
    )
    .text();
    assert!(text.contains("the valves between chambers and gas throttle"), "{text}");
}

/// Peaks of gas are those of the solution; the temperature of gas too fast for heat exchange
/// follows the adiabate.
#[test]
fn peaks_of_gas_are_reported() {
    let scenario = "scenario=[{ name = \"moves\", duration = \"0.5 s\", output_step = \"0.1 ms\", reference = [{ at = 0, force = \"1 kN\" }, \
         { at = \"0.1 s\", force = \"3 kN\" }] }]";
    let gas = "line.accumulator={ gas_volume = \"14 mL\", precharge_pressure = \"15 bar\", thermal_time_constant = \"1e7 s\" }";
    let (found, rows) = rows_of(&[gas, scenario]);
    let output = found["scenarios"][0]["gas"].as_array().unwrap();
    assert_eq!(output.len(), 2);
    for (of_gas, side) in output.iter().zip(["a", "b"]) {
        assert_eq!(of_gas["chamber"], side);
        let number = |name: &str| of_gas[name].as_f64().unwrap();
        let pressures: Vec<f64> = rows.iter().map(|row| row[&format!("pressure_{side}_pa")]).collect();
        let [least, most] = [f64::min, f64::max].map(|of| pressures.iter().copied().reduce(of).unwrap());
        let peak = number("peak_pressure_pa");
        assert!(peak >= most && peak < most * (1.0 + 1e-6), "{peak} {most}");
        // ORIGIN: analytic, theta = (P/P_rest)^(2/7)
        let theta = |pressure: f64| {
            let ratio: f64 = (pressure + 101_325.0) / (pressures[0] + 101_325.0);
            phea_dynamics::portable::pow(ratio, 2.0 / 7.0)
        };
        near(number("temperature_peak_ratio"), theta(peak), 1e-5);
        near(number("temperature_least_ratio"), theta(least), 1e-5);
    }
    // a rig with an exponent has no temperatures, and one without gas has none of these values
    let (found, _) = rows_of(&[&accumulator("14 mL", "15 bar", ""), scenario]);
    assert!(found["scenarios"][0]["gas"][0]["temperature_peak_ratio"].is_null());
}
