//! A telescopic piston from the user's side: quantities derived by `check`, one controller for all
//! its stages, the machine within a transition, and refusals.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use phea_workbench::audit::{CERTIFICATE_FILE, check_certificate};
use phea_workbench::command::{FrictionRequest, Request, friction_watched};
use phea_workbench::source::Memory;

use crate::run_command::{
    HOSE, answer, check, derived, load, near, retracted_length, size_request, try_answer,
};

const TELESCOPIC: &str = include_str!("../../../examples/ybitu/telescopic.toml");
const VISCOUS: &str = "cylinder.friction={ model = \"viscous\", viscous = \"1 kN.s/m\" }";
/// The slope of a symmetric motion about null, for which the example was designed.
const MIDDLE: &str = "operating_point.spool_side=0";
/// A second stage for a rig that has none.
const STAGE: &str = "cylinder.stage=[{ from = \"300 mm\", piston_area = \"10 cm2\" }]";

/// Areas, swept volumes, greatest forces and length of both stages.
#[test]
fn check_derives_its_stages() {
    let output = check(TELESCOPIC, &[]);
    let first = std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.022 * 0.022);
    near(derived(&output, "cylinder.stage_2.area_a"), 10e-4, 1e-12);
    // ORIGIN: analytic, 300 mm of the first stage and 200 mm of the second: the transition is even
    // about its middle
    near(derived(&output, "cylinder.swept_volume_a"), 0.3 * first + 0.2 * 10e-4, 1e-12);
    near(derived(&output, "cylinder.stall_force"), 70e5 * first, 1e-12);
    let softer = check(TELESCOPIC, &["operating_point.position=400 mm"]);
    let [stiff, soft] = [&output, &softer].map(|output| derived(output, "linear.hydraulic_stiffness"));
    // ORIGIN: thesis (6.3), one modulus of 2.609e8 Pa and both lines of 0.19002 L: areas and
    // volumes at 250 mm and at 400 mm
    let by_hand = |area: f64, from_a: f64, to_b: f64| {
        area * area * 2.609e8 * (1.0 / (0.19002e-3 + from_a) + 1.0 / (0.19002e-3 + to_b))
    };
    near(stiff, by_hand(first, first * 0.25, first * 0.05 + 10e-4 * 0.2), 1e-3);
    near(soft, by_hand(10e-4, first * 0.3 + 10e-4 * 0.1, 10e-4 * 0.1), 1e-3);
    let project = load(TELESCOPIC, &["cylinder.dead_length=0.2 m"], &[]).project;
    // ORIGIN: analytic, the longer stage of 300 mm and 200 mm
    near(retracted_length(&project).unwrap(), 0.5, 1e-12);
}

/// The controller of the example is proven to stabilise every position, and its certificate holds.
#[test]
fn every_position_is_proven_to_be_stable() {
    let answered = answer(TELESCOPIC, &[MIDDLE], &[], &Request::Verify { proof: true, on_machine: false });
    let object: serde_json::Value = parsed(&answered.json);
    assert_eq!(object["proof"]["stable"]["proven"], true, "{}", object["proof"]);
    for index in [0, 1] {
        assert_eq!(object["specifications"][index]["proven"], true, "{}", object["specifications"]);
    }
    let file = answered.files.iter().find(|file| file.name == CERTIFICATE_FILE).unwrap();
    assert!(check_certificate(&String::from_utf8(file.bytes.clone()).unwrap()).unwrap().affirmative);
    assert!(
        answered.text().contains("only a simulation shows a motion from one stage to the next"),
        "{}",
        answered.text()
    );
}

/// Small steps at either stage and in the middle of the transition are those of the linear loop.
#[test]
fn the_machine_agrees_with_the_linear_loop() {
    for position in ["100 mm", "300 mm", "400 mm"] {
        let place = format!("operating_point.position={position}");
        let scenario = "scenario=[{ name = \"step\", duration = \"1 s\", reference = [{ at = \"0.1 s\", force = \"100 N\" }] }]";
        let answered = answer(
            TELESCOPIC,
            &[VISCOUS, &place, scenario],
            &[],
            &Request::Verify { proof: false, on_machine: true },
        );
        let object: serde_json::Value = parsed(&answered.json);
        let run = &object["machine"]["runs"][0];
        assert_eq!(run["agrees"], serde_json::Value::from(true), "{position}: {run}");
    }
}

/// The machine agrees with a linkage, too.
#[test]
fn with_a_linkage_the_machine_agrees_too() {
    let rig = include_str!("../../project/tests/valid/linkage.toml");
    let stage = "cylinder.stage=[{ from = \"30 mm\", piston_area = \"10 cm2\" }]";
    for position in ["20 mm", "30 mm", "45 mm"] {
        let place = format!("operating_point.position={position}");
        let limit = "specification=[{ kind = \"robust_stability\", limit = 3, frequencies = [1, 10, 100] }]";
        let answered =
            answer(rig, &[stage, &place, limit], &[], &Request::Verify { proof: false, on_machine: true });
        let object: serde_json::Value = parsed(&answered.json);
        for run in object["machine"]["runs"].as_array().unwrap() {
            assert_eq!(run["agrees"], serde_json::Value::from(true), "{position}: {run}");
        }
    }
}

/// A steady motion through a transition is in no linear plant, and then no specification is proven.
#[test]
fn a_steady_motion_through_a_transition_is_not_proven() {
    let verdict = |settings: &[&str]| {
        let answered =
            answer(TELESCOPIC, settings, &[], &Request::Verify { proof: false, on_machine: false });
        let object: serde_json::Value = parsed(&answered.json);
        (object["verdict"].clone(), answered.text())
    };
    assert_eq!(verdict(&[MIDDLE]).0, "met");
    let (moving, text) = verdict(&[MIDDLE, "operating_point.velocity=10 mm/s"]);
    assert_ne!(moving, "met", "{text}");
    assert!(text.contains("their change at a steady velocity"), "{text}");
}

/// Parts that accept one pair of areas only reject several.
#[test]
fn one_pair_of_areas_is_distinguished_from_several() {
    let answered = try_answer(HOSE, &[STAGE], &[], &size_request(None, None)).unwrap_err().to_string();
    assert!(answered.contains("sizing has one area over the stroke"), "{answered}");
    let source = Memory::default().with("run.csv", "time_s,position_mm,force_n\n0,1,2\n");
    let request = FrictionRequest { files: vec!["run.csv".to_string()], figures: false };
    let rig = load(HOSE, &[STAGE], &[]);
    let answered = friction_watched(&source, Some(&rig), &request, &mut |_| true).unwrap_err().to_string();
    assert!(answered.contains("those of a telescopic piston change"), "{answered}");
}
