//! Accumulators at the chambers from the user's side: quantities derived by `check`, warnings above
//! a verdict, reports of a run, and refusals.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use phea_workbench::command::Request;
use phea_workbench::engineering::linearize::stiffness_over_force;
use phea_workbench::engineering::setup::Setup;
use phea_workbench::project::Severity;

use crate::run_command::{
    HOSE, answer, check, derived, json, near, number, project_of, size_request, try_answer, within,
};

const GAS: &str = include_str!("../../../examples/ybitu/accumulator.toml");
const SWITCHED: &str = include_str!("../../../examples/ybitu/switched_gas.toml");
const BOTH: &str = include_str!("../../project/tests/valid/accumulators.toml");
const ATMOSPHERE: f64 = 101_325.0;

/// Compliance by the polytropic law, at a gauge pressure.
fn gas_compliance(gas_volume: f64, precharge: f64, index: f64, pressure: f64) -> f64 {
    let ratio = (precharge + ATMOSPHERE) / (pressure + ATMOSPHERE);
    gas_volume / (index * (precharge + ATMOSPHERE)) * ratio.powf(1.0 + 1.0 / index)
}

/// The gas of each side at the pressure of its own chamber, with the two sides different.
#[test]
fn check_derives_the_compliance_of_gas_and_the_stiffness_with_and_without_it() {
    let output = check(BOTH, &["operating_point.load_force=1 kN"]);
    let pressures = ["a", "b"].map(|side| derived(&output, &format!("operating_point.pressure_{side}")));
    let expected =
        [gas_compliance(14e-6, 15e5, 1.3, pressures[0]), gas_compliance(6e-6, 10e5, 1.1, pressures[1])];
    for (side, expected) in ["a", "b"].into_iter().zip(expected) {
        near(derived(&output, &format!("line.{side}.accumulator.compliance")), expected, 1e-12);
    }
    let area = derived(&output, "cylinder.area_a");
    let oil = (area * 0.25 + derived(&output, "line.volume")) / 1.45e9;
    let stiffness = |gas: [f64; 2]| gas.map(|gas| area * area / (oil + gas)).iter().sum::<f64>();
    near(derived(&output, "stiffness.with_accumulators"), stiffness(expected), 1e-10);
    near(derived(&output, "stiffness.without_accumulators"), stiffness([0.0; 2]), 1e-10);
    near(derived(&output, "linear.hydraulic_stiffness"), stiffness(expected), 1e-10);
}

/// The force at which `check` reports that the gas is shut off brings a chamber down to its
/// precharge.
#[test]
fn at_the_limits_of_force_a_chamber_is_just_above_its_precharge() {
    let output = check(GAS, &[]);
    for (end, chamber) in [("least", "a"), ("greatest", "b")] {
        let force = derived(&output, &format!("line.{chamber}.accumulator.{end}_force"));
        let there = check(GAS, &[&format!("operating_point.load_force={} N", force * (1.0 - 1e-9))]);
        within(
            derived(&there, &format!("operating_point.pressure_{chamber}")),
            1.01 * (15e5 + ATMOSPHERE) - ATMOSPHERE,
            10.0,
        );
        let stiffness = derived(&output, &format!("stiffness.at_{end}_force"));
        near(derived(&there, "linear.hydraulic_stiffness"), stiffness, 1e-6);
    }
}

/// The stiffness over the force is that of the rig that declares the force, and ends where `check`
/// reports that the gas is shut off.
#[test]
fn stiffness_over_the_force_is_that_of_the_rig_under_this_force() {
    // a pump that yields to leakage has another pressure at each force
    let pump = "accumulator = { gas_volume = \"1 L\", precharge_pressure = \"50 bar\", maximum_pressure_ratio = 4 }\n";
    let both = BOTH.replace("pump_limited", "constant").replace(pump, "");
    for text in [GAS, &both] {
        let project = project_of(text, &[]);
        let found = stiffness_over_force(&Setup::rig_of(&project).unwrap()).unwrap();
        assert!(found.at_settings.is_empty() && found.forces.is_sorted_by(|one, next| one < next));
        assert!(found.forces.len() > 100 && found.forces.len() == found.at_rest.len());
        for index in [1, found.forces.len() / 2, found.forces.len() - 2] {
            let there = check(text, &[&format!("operating_point.load_force={:e} N", found.forces[index])]);
            near(found.at_rest[index], derived(&there, "linear.hydraulic_stiffness"), 1e-6);
        }
        let output = check(text, &[]);
        let last = found.forces.len() - 1;
        for (index, side, end) in [(0, "a", "least"), (last, "b", "greatest")] {
            near(
                found.forces[index],
                derived(&output, &format!("line.{side}.accumulator.{end}_force")),
                1e-9,
            );
            near(found.at_rest[index], derived(&output, &format!("stiffness.at_{end}_force")), 1e-9);
        }
    }
    let of = |text: &str, settings: &[&str]| {
        stiffness_over_force(&Setup::rig_of(&project_of(text, settings)).unwrap())
    };
    assert_eq!(of(HOSE, &[]), None, "without gas");
    // a shut valve leaves no gas, an open one that of the rig without a valve
    let shut = "line.accumulator.adjustment.setting=0";
    assert_eq!(of(SWITCHED, &[shut]), None);
    let [open, bare] = [of(SWITCHED, &[]).unwrap(), of(GAS, &[]).unwrap()];
    assert_eq!(open.at_settings.iter().map(|(setting, _)| *setting).collect::<Vec<_>>(), [0.0]);
    for (one, other) in open.at_rest.iter().zip(&bare.at_rest) {
        near(*one, *other, 1e-6);
    }
}

/// The report draws it if there is gas, and only then.
#[test]
fn the_report_draws_the_stiffness_over_the_force() {
    let drawn = |text: &str| {
        let answer =
            try_answer(text, &[], &[], &Request::Report { files: true, alternatives: false }).unwrap();
        answer.files.iter().any(|file| file.name == "stiffness-force.svg")
    };
    assert!(drawn(BOTH) && !drawn(include_str!("../../project/tests/valid/telescopic.toml")));
}

/// The example is as soft as the thesis requires, and a verdict names the forces beyond which its
/// gas is shut off.
#[test]
fn a_verdict_names_the_forces_beyond_which_the_gas_is_shut_off() {
    let output = json(GAS, &[], &[], &Request::Verify { proof: false, on_machine: false });
    let message = output.to_string();
    assert!(message.contains("line.accumulator is counted for small motions"), "{message}");
    assert!(message.contains("below -5.26 kN and above 4.95 kN"), "{message}");
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
    let text = answer(GAS, &[], &[], &Request::Check).text();
    for one in [&soft, &stiff] {
        let shown = format!("{:.3}e6", derived(one, "linear.hydraulic_stiffness") / 1e6);
        assert!(text.contains(&shown), "{shown} is not in {text}");
    }
}

/// A run driven to a force beyond the limit reports when the gas is shut off and when it is in use
/// again.
#[test]
fn a_run_reports_where_the_gas_is_shut_off() {
    let scenario = "scenario=[{ name = \"push\", duration = \"2 s\", reference = [{ at = \"0.2 s\", force = \"7 kN\" }, { at = \"1 s\", force = \"0 N\" }] }]";
    let run = |settings: &[&str]| answer(GAS, settings, &[], &Request::Simulate(Default::default())).text();
    let output = run(&[scenario]);
    assert!(output.contains("the gas at chamber B is shut off"), "{output}");
    assert!(output.contains("the gas at chamber B is in use again"), "{output}");
    let low = run(&[
        scenario,
        "line.accumulator.precharge_pressure=4 bar",
        "line.accumulator.maximum_pressure_ratio=20",
    ]);
    assert!(!low.contains("shut off"), "{low}");
}

#[test]
fn gas_that_is_shut_off_at_the_operating_point_is_refused() {
    let refused = try_answer(GAS, &["line.accumulator.precharge_pressure=40 bar"], &[], &Request::Check);
    let message = refused.unwrap_err().to_string();
    for part in ["line.accumulator.precharge_pressure", "40.00 bar", "chamber A", "lower the precharge"] {
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// Gas that is shut off is rejected at the key, in the file or in the alternative that sets it.
#[test]
fn a_precharge_above_the_chamber_pressure_is_refused_at_its_place() {
    let line_of = |text: &str, key: &str| 1 + text.lines().position(|line| line.contains(key)).unwrap();
    let place = |text: &str, request: &Request| {
        let refused = try_answer(text, &[], &[], request).unwrap_err();
        let found = &refused.refusal().unwrap().diagnostics;
        let error = found.iter().find(|one| one.severity == Severity::Error).unwrap().clone();
        (error.line, error.message, error.help.unwrap())
    };
    let text = GAS.replacen("precharge_pressure = \"15 bar\"", "precharge_pressure = \"40 bar\"", 1);
    for request in [Request::Check, Request::Verify { proof: false, on_machine: false }] {
        let (line, message, help) = place(&text, &request);
        assert_eq!(line, line_of(&text, "precharge_pressure"), "{message}");
        assert!(message.contains("is above the") && help.contains("lower the precharge"), "{message} {help}");
    }
    let own = "\n[[alternative]]\nname = \"thesis\"\n[alternative.set]\n\"line.accumulator.precharge_pressure\" = \"35 bar\"\n";
    let text = format!("{GAS}{own}");
    let (line, message, _) = place(&text, &Request::Check);
    assert_eq!(line, line_of(&text, "\"line.accumulator.precharge_pressure\" = "), "{message}");
    assert!(message.contains("alternative `thesis`"), "{message}");
}

/// A family whose precharge exceeds the pressure of a chamber states at how many of its plants;
/// otherwise it states nothing.
#[test]
fn a_verdict_counts_the_plants_whose_gas_is_shut_off() {
    let caveat = |most: f64| {
        let range = format!(
            "uncertainty.\"line.accumulator.precharge_pressure\"={{ nominal = 15e5, minimum = 15e5, maximum = {most:e}, points = 3 }}"
        );
        json(GAS, &[&range], &[], &Request::Verify { proof: false, on_machine: false }).to_string()
    };
    // chamber B of the example is below the 30 bar of one of the three points of the range
    let output = check(GAS, &[]);
    assert!(derived(&output, "operating_point.pressure_b") < 30e5);
    let message = caveat(30e5);
    assert!(message.contains("it is shut off") && message.contains("chamber B"), "{message}");
    assert!(message.contains("line.accumulator.precharge_pressure = 30"), "{message}");
    assert!(!caveat(20e5).contains("it is shut off"));
}

/// The sizing of a hose does not include gas, and reports this instead of an answer.
#[test]
fn sizing_refuses_gas() {
    let gas = "line.accumulator={ gas_volume = \"1 mL\", precharge_pressure = \"10 bar\" }";
    let message = try_answer(HOSE, &[gas], &[], &size_request(None, None)).unwrap_err().to_string();
    assert!(message.contains("counts no gas"), "{message}");
    assert!(number(&json(HOSE, &[], &[], &size_request(None, None)), "candidates.0.length_m") > 0.0);
    // a report has a sentence instead of the chapter
    let found = answer(
        HOSE,
        &["specification=[]", "scenario=[]", gas],
        &[],
        &Request::Report { files: true, alternatives: false },
    );
    let page = String::from_utf8_lossy(&found.files[0].bytes).into_owned();
    assert!(page.contains("No hose is sized") && page.contains("counts no gas"));
}
