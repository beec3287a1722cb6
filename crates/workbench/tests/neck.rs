//! The neck of an accumulator, from the project's keys to plant, family, verdict and output.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::Request;

use super::plant_of_verdicts::{assert_nominal_is_the_rig, responses, without_uncertainty};
use super::run_command::{answer, check, derived, json, near, project_of};

const GAS: &str = include_str!("../../../examples/ybitu/accumulator.toml");
const NECK: &str = include_str!("../../project/tests/valid/accumulator_neck.toml");
const BOTH: &str = include_str!("../../project/tests/valid/accumulators.toml");
const LIMIT: &str =
    "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1, 10, 100] }]";
const NECKS: [&str; 2] =
    ["line.accumulator.neck_diameter=\"6 mm\"", "line.accumulator.neck_length=\"40 mm\""];
const SHORT: [&str; 2] =
    ["line.accumulator.neck_diameter=\"6 mm\"", "line.accumulator.neck_length=\"1e-9 mm\""];

/// Rigs with which the plants are compared: two pressures, a stated one, both with a limited pump,
/// and lines with waves.
const RIGS: [&[&str]; 6] = [
    &[],
    &["linear.hydraulic_stiffness=2e6"],
    &["supply.model=pump_limited"],
    &["supply.model=pump_limited", "linear.hydraulic_stiffness=2e6", "operating_point.load_force=2 kN"],
    &["line.model=transmission_line"],
    &["line.model=transmission_line", "linear.hydraulic_stiffness=2e6"],
];

/// A neck whose length tends to zero has no effect, in every form of the plant; the one of an
/// example is not short.
#[test]
fn a_short_neck_has_no_effect() {
    let text = without_uncertainty(GAS);
    for settings in RIGS {
        let [none, short, own] =
            [&[][..], &SHORT, &NECKS].map(|neck| project_of(&text, &[settings, neck].concat()));
        let mut widest = 0.0_f64;
        for frequency in [1e-3, 1.0, 30.0, 300.0, 600.0, 900.0, 2e3] {
            let of = [&none, &short, &own].map(|project| responses(project, frequency));
            for path in [0, 1] {
                let gap = (of[1][path] / of[0][path] - 1.0).norm_sqr().sqrt();
                assert!(gap < 1e-9, "{settings:?} at {frequency}: {gap}");
                widest = widest.max((of[2][path] / of[0][path] - 1.0).norm_sqr());
            }
        }
        assert!(widest > 0.1, "{settings:?}: {widest}");
    }
}

/// The nominal member of the recorded family is the rig, with stated linear parameters and without.
#[test]
fn the_family_is_the_rig_at_its_nominal() {
    let opened = "uncertainty={ \"line.accumulator.neck_length\" = { nominal = \"40 mm\", minimum = \"30 mm\", maximum = \"60 mm\", points = 2 }, \
                  \"line.accumulator.neck_diameter\" = { nominal = \"6 mm\", minimum = \"5 mm\", maximum = \"8 mm\", points = 2 } }";
    for settings in &RIGS[..4] {
        let project = project_of(&without_uncertainty(GAS), &[settings, &NECKS[..], &[opened]].concat());
        assert_nominal_is_the_rig(&project, settings);
    }
}

/// The resonance and damping ratio of a neck are printed, and nothing at rest changes.
#[test]
fn check_derives_the_resonance_of_a_neck() {
    let own = ["line.b.accumulator.neck_diameter=\"4 mm\"", "line.b.accumulator.neck_length=\"20 mm\""];
    let is_warned = check(NECK, &own);
    for (side, diameter, length) in [("a", 6e-3, 0.04), ("b", 4e-3, 0.02)] {
        let area = std::f64::consts::FRAC_PI_4 * diameter * diameter;
        let of_gas = derived(&is_warned, &format!("line.{side}.accumulator.compliance"));
        // ORIGIN: analytic, sqrt(A/(rho L C)) and 16 nu/(w d^2), with the oil of the neck in
        // addition to the gas
        let resonance = (area / (870.0 * length * (of_gas + area * length / 1.45e9))).sqrt();
        near(derived(&is_warned, &format!("line.{side}.accumulator.neck_resonance")), resonance, 1e-9);
        let damping = 16.0 * 46e-6 / (resonance * diameter * diameter);
        near(derived(&is_warned, &format!("line.{side}.accumulator.neck_damping_ratio")), damping, 1e-9);
    }
    let plain = check(BOTH, &[]);
    for key in ["linear.hydraulic_stiffness", "operating_point.pressure_a", "stiffness.with_accumulators"] {
        near(derived(&is_warned, key), derived(&plain, key), 1e-12);
    }
}

/// Effects that a verdict and the reduced models leave out are reported, and nothing otherwise.
#[test]
fn models_without_it_are_reported() {
    let lossless = "line.accumulator.neck_loss_coefficient=0";
    for (text, necks, is_warned) in [(NECK, &[][..], true), (NECK, &[lossless], false), (BOTH, &[], false)] {
        let verdict = json(
            text,
            &[&[LIMIT][..], necks].concat(),
            &[],
            &Request::Verify { proof: false, on_machine: false },
        )
        .to_string();
        assert_eq!(
            verdict.contains("neck_loss_coefficient is not counted for small motions"),
            is_warned,
            "{verdict}"
        );
        let models = answer(text, necks, &[], &Request::Linearize { sweep: None }).text();
        let sentence = "the neck of line.accumulator is counted in the plant and the impedance";
        assert_eq!(models.contains(sentence), text == NECK, "{models}");
    }
}

/// The controller of the example stabilises every plant of its family with the gas at the chamber,
/// but not with a neck between them.
#[test]
fn a_verdict_includes_the_resonance() {
    let stable = |necks: &[&str]| {
        json(GAS, necks, &[], &Request::Verify { proof: false, on_machine: false })["stable"]
            .as_bool()
            .unwrap()
    };
    assert_eq!([&[][..], &SHORT, &NECKS].map(stable), [true, true, false]);
}
