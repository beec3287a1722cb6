//! Accumulators at the chambers as an engineer meets them: what `check` derives, what a verdict says first, what a run reports,
//! and what is refused.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use phea_workbench::command::Request;

use crate::ask::{HOSE, answer, check, derived, json, near, number, size_request, try_answer, within};

const GAS: &str = include_str!("../../../examples/ybitu/accumulator.toml");
const BOTH: &str = include_str!("../../project/tests/valid/accumulators.toml");
const ATMOSPHERE: f64 = 101_325.0;

/// By the polytropic law, at a gauge pressure.
fn gas_compliance(gas_volume: f64, precharge: f64, index: f64, pressure: f64) -> f64 {
    let ratio = (precharge + ATMOSPHERE) / (pressure + ATMOSPHERE);
    gas_volume / (index * (precharge + ATMOSPHERE)) * ratio.powf(1.0 + 1.0 / index)
}

/// The gas of each side at the pressure of its own chamber, its two sides apart.
#[test]
fn check_derives_what_the_gas_yields_and_the_stiffness_with_and_without() {
    let told = check(BOTH, &["operating_point.load_force=1 kN"]);
    let pressures = ["a", "b"].map(|side| derived(&told, &format!("operating_point.pressure_{side}")));
    let expected =
        [gas_compliance(14e-6, 15e5, 1.3, pressures[0]), gas_compliance(6e-6, 10e5, 1.1, pressures[1])];
    for (side, expected) in ["a", "b"].into_iter().zip(expected) {
        near(derived(&told, &format!("line.{side}.accumulator.compliance")), expected, 1e-12);
    }
    let area = derived(&told, "cylinder.area_a");
    let oil = (area * 0.25 + derived(&told, "line.volume")) / 1.45e9;
    let stiffness = |gas: [f64; 2]| gas.map(|gas| area * area / (oil + gas)).iter().sum::<f64>();
    near(derived(&told, "stiffness.with_accumulators"), stiffness(expected), 1e-10);
    near(derived(&told, "stiffness.without_accumulators"), stiffness([0.0; 2]), 1e-10);
    near(derived(&told, "linear.hydraulic_stiffness"), stiffness(expected), 1e-10);
}

/// The force at which `check` says that the gas is shut off is one that brings a chamber down to its precharge.
#[test]
fn at_the_limits_of_force_a_chamber_stands_just_above_its_precharge() {
    let told = check(GAS, &[]);
    for (end, chamber) in [("least", "a"), ("greatest", "b")] {
        let force = derived(&told, &format!("line.{chamber}.accumulator.{end}_force"));
        let there = check(GAS, &[&format!("operating_point.load_force={} N", force * (1.0 - 1e-9))]);
        within(
            derived(&there, &format!("operating_point.pressure_{chamber}")),
            1.01 * (15e5 + ATMOSPHERE) - ATMOSPHERE,
            10.0,
        );
        let stiffness = derived(&told, &format!("stiffness.at_{end}_force"));
        near(derived(&there, "linear.hydraulic_stiffness"), stiffness, 1e-6);
    }
}

/// The example is as soft as the thesis wished, and a verdict names the forces beyond which its gas is shut off.
#[test]
fn a_verdict_names_the_forces_beyond_which_the_gas_is_shut_off() {
    let told = json(GAS, &[], &[], &Request::Verify);
    let said = told.to_string();
    assert!(said.contains("line.accumulator is counted for small motions"), "{said}");
    assert!(said.contains("below -5.26 kN and above 4.95 kN"), "{said}");
    // ORIGIN: thesis 6.4.1
    within(derived(&check(GAS, &[]), "linear.hydraulic_stiffness"), 2.24e6, 0.005e6);
}

/// A member of a family has the stiffness of its own gas.
#[test]
fn families_have_the_stiffness_of_their_gas() {
    let soft = check(
        GAS,
        &["line.accumulator.polytropic_exponent=1", "line.accumulator.precharge_pressure=16.5 bar"],
    );
    let stiff = check(GAS, &["line.accumulator.precharge_pressure=13.5 bar"]);
    let text = answer(GAS, &[], &[], &Request::Check).text;
    for one in [&soft, &stiff] {
        let shown = format!("{:.3}e6", derived(one, "linear.hydraulic_stiffness") / 1e6);
        assert!(text.contains(&shown), "{shown} is not in {text}");
    }
}

/// Driven to a force beyond the limit, the run says when the gas is shut off and when it is in use again.
#[test]
fn a_run_reports_where_the_gas_is_shut_off() {
    let scenario = "scenario=[{ name = \"push\", duration = \"2 s\", reference = [{ at = \"0.2 s\", force = \"7 kN\" }, { at = \"1 s\", force = \"0 N\" }] }]";
    let ask = |settings: &[&str]| answer(GAS, settings, &[], &Request::Simulate).text;
    let told = ask(&[scenario]);
    assert!(told.contains("the gas at chamber B is shut off"), "{told}");
    assert!(told.contains("the gas at chamber B is in use again"), "{told}");
    let low = ask(&[
        scenario,
        "line.accumulator.precharge_pressure=4 bar",
        "line.accumulator.maximum_pressure_ratio=20",
    ]);
    assert!(!low.contains("shut off"), "{low}");
}

#[test]
fn gas_that_is_shut_off_at_the_operating_point_is_refused() {
    let refused = try_answer(GAS, &["line.accumulator.precharge_pressure=40 bar"], &[], &Request::Check);
    let said = refused.unwrap_err().to_string();
    for part in ["line.accumulator.precharge_pressure", "40.00 bar", "chamber A", "lower the precharge"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

/// A neck: its resonance is told, it is in the plant, and where a stated stiffness leaves no place for it a verdict says so first.
#[test]
fn a_neck_is_told_and_counted() {
    const NECK: &str = include_str!("../../project/tests/valid/accumulator_neck.toml");
    let told = check(NECK, &[]);
    let area = std::f64::consts::FRAC_PI_4 * 36e-6;
    for (side, gas) in [("a", "a"), ("b", "b")].into_iter().take(1) {
        let compliance = derived(&told, &format!("line.{gas}.accumulator.compliance")) + area * 0.04 / 1.45e9;
        // ORIGIN: analytic, sqrt(A/(rho L C))
        let expected = (area / (870.0 * 0.04 * compliance)).sqrt();
        near(derived(&told, &format!("line.{side}.accumulator.neck_resonance")), expected, 1e-9);
    }
    let stiffness = |text: &str| derived(&check(text, &[]), "linear.hydraulic_stiffness");
    near(stiffness(NECK), stiffness(BOTH), 1e-12);
    let said = answer(NECK, &[], &[], &Request::Linearize).text;
    assert!(said.contains("the neck of line.accumulator is counted in the plant and the impedance"), "{said}");
    let verdict = |settings: &[&str]| json(NECK, settings, &[], &Request::Verify).to_string();
    let limit = "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1, 10, 100] }]";
    assert!(!verdict(&[limit]).contains("the neck of line.accumulator is not counted"));
    let stated = verdict(&[limit, "linear.hydraulic_stiffness=2e6"]);
    assert!(stated.contains("the neck of line.accumulator is not counted") && stated.contains("not_proven"), "{stated}");
}

/// The sizing of a hose leaves gas out, and says so rather than answer.
#[test]
fn sizing_refuses_gas() {
    let gas = "line.accumulator={ gas_volume = \"1 mL\", precharge_pressure = \"10 bar\" }";
    let said = try_answer(HOSE, &[gas], &[], &size_request(None, None)).unwrap_err().to_string();
    assert!(said.contains("counts no gas"), "{said}");
    assert!(number(&json(HOSE, &[], &[], &size_request(None, None)), "candidates.0.length_m") > 0.0);
}
