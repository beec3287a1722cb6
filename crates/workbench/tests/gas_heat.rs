//! Heat and temperature of accumulators, from the project's keys to plant, family, verdict, runs
//! and output.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_dynamics::portable::pow;
use phea_hydraulics::signal::Signal;
use phea_workbench::command::{Request, SimulateRequest};
use phea_workbench::engineering::setup::Setup;
use phea_workbench::engineering::simulate::{ScenarioRun, simulate_project};
use phea_workbench::report::report;

use super::plant_of_verdicts::{assert_nominal_is_the_rig, responses, without_uncertainty};
use super::run_command::{answer, check, derived, json, load, near, project_of, source, try_answer};

const GAS: &str = include_str!("../../../examples/ybitu/accumulator.toml");
const HEAT: &str = include_str!("../../project/tests/valid/accumulator_heat.toml");
const LIMIT: &str =
    "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1, 10, 100] }]";
const ATMOSPHERE: f64 = 101_325.0;

/// Rigs with which the plants are compared: two pressures, a stated one, a limited pump, a neck,
/// and lines with waves.
const RIGS: [&[&str]; 6] = [
    &[],
    &["linear.hydraulic_stiffness=2e6"],
    &["supply.model=pump_limited"],
    &["line.accumulator.neck_diameter=\"6 mm\"", "line.accumulator.neck_length=\"40 mm\""],
    &["line.model=transmission_line"],
    &["line.model=transmission_line", "linear.hydraulic_stiffness=2e6"],
];

/// The example without its open values, and with gas of this exponent or time constant.
fn with_gas(own: &str) -> String {
    let text = without_uncertainty(GAS);
    let lines = text.lines().map(|line| if line.starts_with("polytropic_exponent") { own } else { line });
    let text = lines.collect::<Vec<_>>().join("\n");
    assert!(text.contains(own));
    text
}

/// Gas at constant temperature is that of exponent 1, in every form of the plant; with a time
/// constant of seconds it is not.
#[test]
fn heat_without_delay_is_isothermal() {
    let [isothermal, quick, slow] =
        ["polytropic_exponent = 1", "thermal_time_constant = \"1e-12 s\"", "thermal_time_constant = \"2 s\""]
            .map(with_gas);
    for settings in RIGS {
        let of = [&isothermal, &quick, &slow].map(|text| project_of(text, settings));
        let mut widest = 0.0_f64;
        for frequency in [1e-3, 1.0, 30.0, 300.0, 900.0, 2e3] {
            let of = of.each_ref().map(|project| responses(project, frequency));
            for path in [0, 1] {
                let gap = (of[1][path] / of[0][path] - 1.0).norm_sqr().sqrt();
                assert!(gap < 1e-8, "{settings:?} at {frequency}: {gap}");
                widest = widest.max((of[2][path] / of[0][path] - 1.0).norm_sqr().sqrt());
            }
        }
        assert!(widest > 0.05, "{settings:?}: {widest}");
    }
}

/// The nominal member of the recorded family is the rig, with stated linear parameters and without.
#[test]
fn the_family_is_the_rig_at_its_nominal() {
    let opened = "uncertainty={ \"line.accumulator.thermal_time_constant\" = { nominal = \"2 s\", minimum = \"1 s\", maximum = \"6 s\", points = 2 } }";
    let text = with_gas("thermal_time_constant = \"2 s\"");
    for settings in &RIGS[..4] {
        let project = project_of(&text, &[settings, &[opened][..]].concat());
        assert_nominal_is_the_rig(&project, settings);
    }
}

/// Compliance at rest, compliance without heat exchange, and the frequency between them; the
/// precharge at both temperatures.
#[test]
fn check_derives_both_compliances_and_both_precharges() {
    let output = check(HEAT, &["line.b.accumulator.thermal_time_constant=0.6"]);
    // ORIGIN: analytic, 10 bar at 20 degC become this at 45 degC in the same volume, absolute
    let warm = (10e5 + ATMOSPHERE) * 318.15 / 293.15;
    near(derived(&output, "line.b.accumulator.working_precharge"), warm - ATMOSPHERE, 1e-12);
    let absolute = derived(&output, "operating_point.pressure_b") + ATMOSPHERE;
    near(derived(&output, "line.b.accumulator.compliance"), warm * 6e-6 / (absolute * absolute), 1e-12);
    let fast = derived(&output, "line.b.accumulator.compliance") / 1.4;
    near(derived(&output, "line.b.accumulator.fast_compliance"), fast, 1e-12);
    near(derived(&output, "line.b.accumulator.isothermal_below"), 1.0 / (1.4 * 0.6), 1e-12);
    let text = answer(HEAT, &[], &[], &Request::Check).text();
    for part in ["line.b.accumulator.working_precharge", "precharge_temperature"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

/// Gas stated at one temperature or at the other gives one machine and one plant.
#[test]
fn a_precharge_may_be_stated_at_either_temperature() {
    let cold = "line.b.accumulator={ gas_volume = \"6 mL\", precharge_pressure = \"10 bar\", precharge_temperature = \"20 degC\", working_temperature = \"45 degC\" }";
    let working = (10e5 + ATMOSPHERE) * 318.15 / 293.15 - ATMOSPHERE;
    let warm =
        format!("line.b.accumulator={{ gas_volume = \"6 mL\", precharge_pressure = \"{working:?} Pa\" }}");
    let [cold, warm] = [cold, &warm].map(|gas| project_of(HEAT, &[gas]));
    for frequency in [1.0, 300.0] {
        for (one, other) in responses(&cold, frequency).into_iter().zip(responses(&warm, frequency)) {
            assert!((one / other - 1.0).norm_sqr() < 1e-24);
        }
    }
}

/// Warm gas that is shut off at the operating point is rejected, with both of its precharges.
#[test]
fn a_precharge_that_is_too_high_when_warm_is_refused() {
    let gas = "line.b.accumulator={ gas_volume = \"6 mL\", precharge_pressure = \"30 bar\", precharge_temperature = \"0 degC\", working_temperature = \"80 degC\" }";
    let cold = "line.b.accumulator={ gas_volume = \"6 mL\", precharge_pressure = \"30 bar\" }";
    let output = check(HEAT, &["line.b.accumulator.precharge_pressure=10 bar"]);
    let pressure = derived(&output, "operating_point.pressure_b");
    assert!(pressure > 30e5 && pressure < 39e5, "{pressure}");
    check(HEAT, &[cold]);
    let message = try_answer(HEAT, &[gas], &[], &Request::Check).unwrap_err().to_string();
    for part in ["39.08 bar", "at `working_temperature`, from 30.00 bar"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// Effects that the reduced models leave out are reported.
#[test]
fn models_without_it_are_reported() {
    let text = with_gas("thermal_time_constant = \"2 s\"");
    let models = answer(&text, &[], &[], &Request::Linearize { sweep: None }).text();
    assert!(models.contains("line.accumulator.thermal_time_constant is counted in the plant"), "{models}");
    let both = answer(&text, RIGS[3], &[], &Request::Linearize { sweep: None }).text();
    assert!(
        both.contains("the neck of line.accumulator and its thermal_time_constant are counted"),
        "{both}"
    );
}

/// Every frequency of every plant of the box is proven or refuted with heat as without.
#[test]
fn verify_includes_heat() {
    let opened = "uncertainty={ \"line.accumulator.thermal_time_constant\" = { nominal = \"2 s\", minimum = \"1 s\", maximum = \"6 s\", points = 2 } }";
    let text = with_gas("thermal_time_constant = \"2 s\"");
    let output = json(&text, &[LIMIT, opened], &[], &Request::Verify { proof: false, on_machine: false });
    assert_eq!(output["stable"].as_bool(), Some(true), "{output}");
}

/// No precharge below the declared one, for which the maker's limit would not apply.
const CERTAIN: &str = "uncertainty.\"line.accumulator.precharge_pressure\".minimum=15 bar";

/// A run reports the time at which the gas exceeds the maker's limit, which the supply pressure
/// does not do.
#[test]
fn a_run_reports_where_the_limit_of_the_manufacturer_is_exceeded() {
    let scenario = "scenario=[{ name = \"pressed\", duration = \"0.6 s\", load_motion = { kind = \"smooth_step\", start = \"0.1 s\", duration = \"20 ms\", distance = \"-20 mm\" } }]";
    let run = |ratio: &str| {
        let limit = format!("line.accumulator.maximum_pressure_ratio={ratio}");
        answer(GAS, &[scenario, &limit, CERTAIN], &[], &Request::Simulate(Default::default())).text()
    };
    let output = run("4.44");
    assert!(output.contains("is above its maximum_pressure_ratio"), "{output}");
    assert!(output.contains("is within its maximum_pressure_ratio again"), "{output}");
    assert!(!run("20").contains("maximum_pressure_ratio"));
    let loaded = load(HEAT, &[scenario, "line.accumulator.maximum_pressure_ratio=4.44"], &[]);
    let setup = Setup::new(&loaded.project).unwrap();
    let page = report(&source(HEAT), &loaded, &setup, None, &mut |_| true).unwrap().html;
    assert!(page.contains("the gas at chamber A is above its maximum_pressure_ratio"));
}

/// A run of the rig with this gas at chamber A, behind a neck, and at B.
fn run_of(settings: &[&str]) -> ScenarioRun {
    let loaded = load(HEAT, settings, &[]);
    let setup = Setup::new(&loaded.project).unwrap();
    simulate_project(&source(HEAT), &setup, &mut |_| true).unwrap().remove(0)
}

/// A load that is moved without a chamber falling below its precharge.
const PRESSED: &str = "scenario=[{ name = \"pressed\", duration = \"0.4 s\", load_motion = { kind = \"smooth_step\", start = \"0.1 s\", duration = \"20 ms\", distance = \"-0.7 mm\" } }]";

/// Gas without time for heat exchange has the adiabatic temperature of its pressure, with a neck
/// and without; at rest it has the pressure of its chamber and the temperature of its wall.
#[test]
fn the_gas_of_a_run_is_adiabatic_where_it_has_no_time_for_heat() {
    let slow = ["line.accumulator.thermal_time_constant=1e9", "line.b.accumulator.thermal_time_constant=1e9"];
    let record = run_of(&[&slow[..], &[PRESSED]].concat()).record;
    let [end_of_line_a, chamber_a, chamber_b, ratio_a, ratio_b, celsius_b] = [
        Signal::GasPressureA,
        Signal::PressureA,
        Signal::PressureB,
        Signal::GasTemperatureRatioA,
        Signal::GasTemperatureRatioB,
        Signal::GasTemperatureB,
    ]
    .map(|signal| record.signal(signal));
    assert!((end_of_line_a[0] - chamber_a[0]).abs() < 1.0, "{} {}", end_of_line_a[0], chamber_a[0]);
    assert!(ratio_a[0] == 1.0 && ratio_b[0] == 1.0 && celsius_b[0] == 45.0);
    let mut widest = [0.0_f64; 2];
    for (side, pressures, ratios) in [(0, &end_of_line_a, &ratio_a), (1, &chamber_b, &ratio_b)] {
        for (pressure, ratio) in pressures.iter().zip(ratios) {
            // ORIGIN: analytic, T_2/T_1 = (P_2/P_1)^((gamma - 1)/gamma), absolute, with gamma = 1.4
            let expected = pow((pressure + ATMOSPHERE) / (pressures[0] + ATMOSPHERE), 0.4 / 1.4);
            assert!((ratio - expected).abs() < 2e-4, "{side}: {ratio} {expected}");
            widest[side] = widest[side].max((ratio - 1.0).abs());
        }
    }
    assert!(widest.iter().all(|width| *width > 0.02), "{widest:?}");
    for (celsius, ratio) in celsius_b.iter().zip(&ratio_b) {
        assert!((celsius + 273.15 - 318.15 * ratio).abs() < 1e-9);
    }
    // chamber B has no neck, and the project does not state the temperature of the gas at A
    for signal in [Signal::GasPressureB, Signal::GasTemperatureA] {
        assert!(record.signal(signal).is_empty(), "{signal:?}");
    }
}

/// Figures show the gas of a rig that has such gas, side by side, and of no other.
#[test]
fn figures_show_the_declared_gas() {
    let request = Request::Simulate(SimulateRequest { figures: true, ..SimulateRequest::default() });
    let drawn = |text: &str| {
        let files = answer(text, &[PRESSED], &[], &request).files;
        let figure = files.iter().find(|file| file.name == "simulation-1.svg").unwrap();
        String::from_utf8(figure.bytes.clone()).unwrap()
    };
    let (with, without) = (drawn(HEAT), drawn(GAS));
    for part in ["at A", "at B"] {
        assert!(with.contains(part) && !without.contains(part), "{part}");
    }
}
