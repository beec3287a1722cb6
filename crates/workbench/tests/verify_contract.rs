//! Answer of `verify`: the keys that other programs read, and the findings of the audit of the
//! thesis' controller.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use crate::run_command::{self, HOSE, answer, json, try_answer};
use phea_workbench::command::{CommandError, Progress, Request, answer_into};
use phea_workbench::plant_names::{PlantNames, plant_text};
use phea_workbench::shaping::Shaped;
use serde_json::Value;

fn verify(project: &str, settings: &[&str]) -> Value {
    json(project, settings, &[], &Request::Verify { proof: false, on_machine: false })
}

fn close(value: &Value, expected: f64, relative: f64) {
    let value = value.as_f64().unwrap();
    assert!((value - expected).abs() <= relative * expected.abs(), "{value} instead of {expected}");
}

/// A single plant, k/s, closed with gain 1.
const INTEGRATOR: &str = "schema = 1\ntitle = \"integrator\"\n[plant]\nnumerator = \"k\"\ndenominator = \"s\"\n\
    [uncertainty]\nk = { nominal = 1, minimum = 1, maximum = 2, points = 2 }\n[controller]\nnumerator = \"1\"\n\
    denominator = \"1\"\n[[specification]]\nkind = \"robust_stability\"\nlimit = 1.1\nfrequencies = [1, 5]\nband = [0, inf]\n";

#[test]
fn the_stable_keys_are_present() {
    let object = verify(INTEGRATOR, &[]);
    assert_eq!(object["verdict"], "met");
    assert_eq!(object["evidence"], "search");
    assert_eq!(object["tolerance_db"], 0.01);
    assert_eq!(object["stable"], true);
    // pi/2 at k = 2, where |L| = 1 at 2 rad/s: ORIGIN: analytic
    close(&object["delay_margin_s"], std::f64::consts::FRAC_PI_4, 1e-6);
    let row = &object["specifications"][0];
    assert_eq!(row["kind"], "robust_stability");
    assert_eq!(row["verdict"], "met");
    // |T| tends to 1 towards zero frequency
    close(&row["worst_margin_db"], 20.0 * 1.1_f64.log10(), 1e-9);
    assert_eq!(row["frequency_rad_per_s"], 0.0);
    assert!(row["plant"]["k"].is_number());
    let design = row["at_design_frequencies"].as_array().unwrap();
    assert_eq!(design.len(), 2);
    // |T| = 2/|j + 2| at k = 2 and 1 rad/s
    close(&design[0]["margin_db"], 20.0 * (1.1 * 5.0_f64.sqrt() / 2.0).log10(), 1e-6);
    assert_eq!(design[0]["frequency_rad_per_s"], 1.0);
    assert_eq!(design[0]["plant"]["k"], 2.0);
}

#[test]
fn the_audit_of_the_thesis_finds_violations_between_its_grid_points() {
    let object = verify(HOSE, &[]);
    assert_eq!((object["verdict"].as_str(), object["stable"].as_bool()), (Some("violated"), Some(true)));
    let robust = &object["specifications"][0];
    // ORIGIN: recomputed by comparisons/recompute_audit.py
    close(&robust["frequency_rad_per_s"], 1304.4, 1e-3);
    let peak = 1.3 * 10.0_f64.powf(-robust["worst_margin_db"].as_f64().unwrap() / 20.0);
    assert!((peak - 11.887).abs() < 0.012, "{peak}");
    close(&robust["plant"]["hydraulic_stiffness"], 3.71e6, 2e-3);
    for (name, corner) in
        [("viscous_friction", 100.0), ("flow_gain", 5.61e-5), ("valve_natural_frequency", 1319.0)]
    {
        assert_eq!(robust["plant"][name], corner);
    }
    let designs = robust["at_design_frequencies"].as_array().unwrap();
    assert!(designs.iter().all(|case| case["margin_db"].as_f64().unwrap() > 0.0));
}

#[test]
fn unreachable_limits_are_not_reported_as_met() {
    // unstable: it meets no specification
    let unstable = verify(INTEGRATOR, &["controller.numerator=\"-1\"", "specification.0.limit=1000"]);
    assert_eq!((unstable["verdict"].as_str(), unstable["stable"].as_bool()), (Some("violated"), Some(false)));
    assert!(unstable["delay_margin_s"].is_null() && unstable["delay_margin_s_reason"].is_string());
    let row = &unstable["specifications"][0];
    assert_eq!(row["verdict"], "violated");
    assert!(row["worst_margin_db"].is_null() && row["reason"].is_string());
    // a negative margin within the tolerance counts as met, one beyond it as violated
    for (limit, verdict) in [("0.9995", "met"), ("0.99", "violated")] {
        let setting = format!("specification.0.limit={limit}");
        assert_eq!(verify(INTEGRATOR, &[&setting])["verdict"], verdict, "{limit}");
    }
}

#[test]
fn the_text_begins_with_the_verdict_and_its_basis() {
    let text = answer(HOSE, &[], &[], &Request::Verify { proof: false, on_machine: false }).text;
    assert!(text.starts_with("Verdict: violated\n"));
    for words in ["11.89", "at the design frequencies alone it would have passed", "a search is not a proof"]
    {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
}

/// An effect that a simulation adds to the command and that a model does not include is reported by
/// every command on that model.
#[test]
fn a_neglected_feed_forward_is_reported() {
    let words = "that [controller] feeds forward";
    let shape = Request::Shape { shaped: Shaped::Controller, changes: vec![] };
    for (text, request) in [
        (HOSE, Request::Linearize { sweep: None }),
        (INTEGRATOR, Request::Verify { proof: false, on_machine: false }),
        (INTEGRATOR, shape),
    ] {
        for (settings, is_reported) in [
            (vec![], false),
            (vec!["controller.load_velocity_feed_forward={ gain = 0 }"], false),
            (vec!["controller.load_velocity_feed_forward={ gain = 20 }"], true),
        ] {
            let output = answer(text, &settings, &[], &request);
            let object: Value = parsed(&output.json);
            let warnings = object["warnings"].as_array().unwrap();
            let of_it = warnings.iter().filter(|warning| warning.as_str().unwrap().contains(words));
            assert_eq!(
                (output.text.contains(words), of_it.count()),
                (is_reported, usize::from(is_reported)),
                "{}",
                request.name()
            );
        }
    }
}

#[test]
fn without_a_controller_there_is_nothing_to_verify() {
    let bare = HOSE.split("[controller]").next().unwrap();
    let refused = try_answer(bare, &[], &[], &Request::Verify { proof: false, on_machine: false });
    assert!(matches!(refused, Err(CommandError::Refused(_))), "{refused:?}");
    assert!(refused.unwrap_err().to_string().contains("no [controller] to be verified"));
}

#[test]
fn progress_increases_and_the_command_can_be_stopped() {
    let loaded = run_command::load(HOSE, &[], &[]);
    let source = run_command::source(HOSE);
    let mut fractions = Vec::new();
    let mut watch = |progress: Progress| {
        fractions.push(progress.fraction);
        fractions.len() < 50
    };
    let stopped = answer_into(
        &source,
        &loaded,
        &[],
        &Request::Verify { proof: false, on_machine: false },
        None,
        &mut watch,
    );
    assert!(matches!(stopped, Err(CommandError::Stopped(_))));
    assert_eq!(fractions.len(), 50);
    assert!(fractions.is_sorted() && fractions.iter().all(|fraction| (0.0..=1.0).contains(fraction)));
}

#[test]
fn a_number_set_outside_of_its_range_is_refused_with_the_remedy() {
    let refused = try_answer(
        HOSE,
        &["linear.flow_pressure_coefficient=0"],
        &[],
        &Request::Verify { proof: false, on_machine: false },
    );
    let words = refused.unwrap_err().to_string();
    for part in ["`linear.flow_pressure_coefficient` = 0", "6.42e-13 to 7e-11", "widen the range"] {
        assert!(words.contains(part), "{part} is missing in: {words}");
    }
}

/// The numbers of a plant have the units of their keys, and none if the project does not know them.
#[test]
fn plants_are_named_with_the_units_of_their_numbers() {
    let hose = include_str!("../../../examples/ybitu/hose.toml");
    let source = phea_workbench::source::Memory::default().with("rig.toml", hose);
    let settings =
        ["load={ model = \"spring_mass_damper\", mass = 80, stiffness = 2e6, damping = 500 }".to_string()];
    let loaded = phea_workbench::project::read(&source, "rig.toml", &settings, &[]).unwrap();
    let names = ["load.mass", "load.stiffness", "viscous_friction", "operating_point.velocity", "other"];
    let names = PlantNames::of_parameters(&loaded.project, names.into_iter());
    let plant = phea_qft::verification::PlantPoint::Parameters(vec![80.0, 2e6, 100.0, 0.02, 3.0]);
    let expected = "load.mass 80 kg, load.stiffness 2 kN/mm, viscous_friction 100 N.s/m, \
                    operating_point.velocity 20 mm/s, other 3";
    assert_eq!(plant_text(&names, &plant), expected);
}

/// Plant k/(s - 1) closed with gain 2 is stable for k above 1/2: from k = 4 its gain may fall to an
/// eighth. An integrator may lose all of it, and has no such sentence.
#[test]
fn a_loop_around_an_unstable_plant_states_how_far_its_gain_may_fall() {
    let unstable = INTEGRATOR
        .replace("denominator = \"s\"", "denominator = \"s - 1\"")
        .replace("k = { nominal = 1, minimum = 1, maximum = 2", "k = { nominal = 4, minimum = 4, maximum = 8")
        .replace("numerator = \"1\"", "numerator = \"2\"");
    let request = Request::Verify { proof: false, on_machine: false };
    let output = answer(&unstable, &[], &[], &request);
    let object: Value = parsed(&output.json);
    // ORIGIN: analytic, 20 log10(1/8)
    close(&object["gain_reduction_db"], -18.0618, 1e-5);
    assert!(output.text.contains("becomes unstable where that falls by 18.1 dB"), "{}", output.text);
    let output = answer(INTEGRATOR, &[], &[], &request);
    assert!(!output.text.contains("needs its gain"), "{}", output.text);
    assert_eq!(verify(INTEGRATOR, &[])["gain_reduction_db"], "-inf");
}
