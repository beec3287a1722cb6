//! Friction that differs by direction: declared, recorded by the bench, identified, and reported
//! with a verdict on the linear loop.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::answer_schema::parsed;
use phea_workbench::command::{self, Request};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

use crate::friction_identification::{SLIDING, TRUTH, identified, recorded};
use crate::run_command;

const BACK: &str =
    "cylinder.friction.retracting={ coulomb = \"95 N\", static = \"150 N\", viscous = \"140 N.s/m\" }";

/// The bench's noise-free runs of a friction with other levels on the way back give all of them,
/// and the fragment recovers the friction.
#[test]
fn levels_of_both_directions_come_back_from_the_bench() {
    let settings = [
        "bench.pressure_noise=0",
        "bench.converter_bits=0",
        "bench.friction={ velocities = 8, position_noise = 0 }",
        BACK,
    ];
    let source = recorded(&settings);
    let answer = identified(&source, &[SLIDING]).unwrap();
    let found: Value = parsed(&answer.json);
    let back = [("coulomb_n", 95.0), ("static_n", 150.0), ("viscous_n_s_per_m", 140.0)];
    let own = TRUTH[..5].iter().map(|truth| (&found["friction"], *truth));
    let other = back.iter().map(|truth| (&found["friction"]["retracting"], *truth));
    for (friction, (key, truth)) in own.chain(other) {
        let value = friction[key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {found}"));
        assert!((value / truth - 1.0).abs() < 1e-3, "{key}: {value}, {truth}");
    }
    let fragment = answer.files.iter().find(|file| file.name == "friction.toml").unwrap();
    let text = String::from_utf8(fragment.bytes.clone()).unwrap();
    let start = run_command::HOSE.find("[cylinder.friction]").unwrap();
    let end = run_command::HOSE.find("[line]").unwrap();
    let whole = format!("{}{text}{}", &run_command::HOSE[..start], &run_command::HOSE[end..]);
    // coefficients that the runs may leave open are comments there
    let bristles = ["cylinder.friction.bristle_stiffness=1e7", "cylinder.friction.bristle_damping=2000"];
    let read = run_command::load(&whole, &bristles, &[]).project;
    let declared = read.actuator.unwrap().cylinder.friction.unwrap().retracting.unwrap();
    assert!((declared.static_friction.unwrap() / 150.0 - 1.0).abs() < 1e-3, "{text}");
}

/// A family must contain the viscous friction of both directions.
#[test]
fn a_family_without_the_viscous_friction_of_one_direction_is_reported() {
    let anything =
        "specification=[{ kind = \"robust_stability\", limit = 1000, frequencies = [1], band = [1, 2] }]";
    let verify = |settings: &[&str]| {
        let loaded = run_command::load(run_command::HOSE, &[&[anything], settings].concat(), &[]);
        let request = Request::Verify { proof: false, on_machine: false };
        let answer = command::answer(&Memory::default(), &loaded, &[], &request).unwrap();
        (parsed(&answer.json)["verdict"].clone(), answer.text())
    };
    let range = |minimum: f64, maximum: f64| {
        format!(
            "uncertainty.viscous_friction={{ nominal = {minimum}, minimum = {minimum}, maximum = {maximum} }}"
        )
    };
    let missing = "(cylinder.friction.retracting.viscous)";
    let (verdict, text) = verify(&[BACK, &range(100.0, 140.0)]);
    assert!(verdict == "met" && !text.contains(missing), "{text}");
    for without in [range(100.0, 139.0), range(120.0, 140.0)] {
        let (verdict, text) = verify(&[BACK, &without]);
        assert!(verdict == "not_proven" && text.contains(missing), "{text}");
    }
    // different levels only are in no linear plant
    let levels = "cylinder.friction.retracting={ coulomb = \"95 N\", static = \"150 N\" }";
    let (verdict, text) = verify(&[levels, &range(100.0, 100.5)]);
    assert!(verdict == "met" && !text.contains("retracting"), "{text}");
}

/// Impossible levels, and levels that a model does not have, are rejected with their key.
#[test]
fn impossible_levels_of_a_direction_are_refused() {
    let refused = |setting: &str| {
        let settings = [setting.to_string()];
        let report =
            project::read(&run_command::source(run_command::HOSE), "rig.toml", &settings, &[]).unwrap_err();
        report.to_string()
    };
    let message = refused("cylinder.friction.retracting={ coulomb = \"130 N\" }");
    assert!(message.contains("`coulomb`, 130 N, is above `static`, 120 N"), "{message}");
    assert!(message.contains("retracting={ coulomb"), "{message}");
    let message =
        refused("cylinder.friction={ model = \"viscous\", viscous = 100, retracting = { viscous = 120 } }");
    assert!(message.contains("the same both ways"), "{message}");
}
