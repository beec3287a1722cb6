//! Limiting cases of textbooks: a free mass, a valve on the cylinder, and plants by their zeros,
//! poles and gain.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::run_command::{check, derived, json, linearize, near, number, source};
use phea_workbench::command::Request;
use phea_workbench::project;
use serde_json::Value;

/// A double-rod cylinder at mid stroke with its valve on it, on a free mass.
const MASS: &str = r#"
schema = 1
title = "Valve on the cylinder, free mass"
[fluid]
bulk_modulus = "1.4 GPa"
density = "860 kg/m3"
[supply]
model = "constant"
pressure = "140 bar"
[valve]
nominal_voltage = "10 V"
natural_frequency = "5000 rad/s"
damping_ratio = 0.8
flow_coefficients = [1e-6, 1e-6, 1e-6, 1e-6]
leakage_coefficients = [1e-12, 1e-12, 1e-12, 1e-12]
[cylinder]
piston_diameter = "50 mm"
rod_diameter = "25 mm"
stroke = "400 mm"
moving_mass = "1 kg"
dead_volume = "20 mL"
[line]
volume = "0 mL"
effective_bulk_modulus = "1.4 GPa"
[force_sensor]
stiffness = "1e12 N/m"
[load]
model = "spring_mass_damper"
mass = "99 kg"
stiffness = 0
damping = "500 N.s/m"
"#;

fn area() -> f64 {
    std::f64::consts::FRAC_PI_4 * (0.05 * 0.05 - 0.025 * 0.025)
}

/// Hydraulic natural frequency of a mass between two trapped volumes.
///
/// ```text
/// ω = sqrt(4 β A^2/(V m)),    V = A L + 2 V_0
/// ```
#[test]
fn the_hydraulic_natural_frequency() {
    for (mass, stroke, dead) in [(99.0, 0.4, 20e-6), (250.0, 0.1, 5e-6), (30.0, 0.8, 100e-6)] {
        let settings = [
            format!("load.mass={mass}"),
            format!("cylinder.stroke={stroke}"),
            format!("cylinder.dead_volume={dead}"),
            "load.damping=0".to_string(),
        ];
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let output = check(MASS, &settings);
        let volume = area() * stroke + 2.0 * dead;
        let expected = (4.0 * 1.4e9 * area() * area() / (volume * (mass + 1.0))).sqrt();
        near(derived(&output, "dynamics.mode_1.frequency"), expected, 1e-3);
        assert!(derived(&output, "dynamics.mode_1.damping_ratio") < 1e-4);
        assert_eq!(derived(&output, "line.compliance"), 0.0);
    }
}

/// A constant command moves a free mass at a constant velocity, at which its damper takes a force;
/// the poles do not include the position.
///
/// ```text
/// F = c v,    K_qU U = A v + K_c (f_v + c) v/A
/// ```
#[test]
fn a_free_mass_has_no_position() {
    for damping in [500.0, 2000.0, 5e4] {
        let settings = [
            format!("load.damping={damping}"),
            "cylinder.friction={ model = \"viscous\", viscous = 300 }".to_string(),
        ];
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let (output, linear) = (check(MASS, &settings), linearize(MASS, &settings));
        let [gain, leak] =
            ["linear.flow_gain", "linear.flow_pressure_coefficient"].map(|name| derived(&output, name));
        let velocity = gain / (area() + leak * (300.0 + damping) / area());
        let command = &linear["plant"]["command"];
        let product = |name: &str| -> f64 {
            let roots = command[name].as_array().unwrap().iter();
            roots.map(|root| root[0].as_f64().unwrap().hypot(root[1].as_f64().unwrap())).product()
        };
        near(number(command, "gain").abs() * product("zeros") / product("poles"), damping * velocity, 1e-6);
        let origin = |root: &Value| root[0].as_f64() == Some(0.0) && root[1].as_f64() == Some(0.0);
        assert!(!linear["poles"]["plant"].as_array().unwrap().iter().any(origin));
    }
}

fn refused(text: &str, settings: &[&str]) -> String {
    let settings: Vec<String> = settings.iter().map(|one| one.to_string()).collect();
    project::read(&source(text), "rig.toml", &settings, &[]).unwrap_err().to_string()
}

/// A limit that leaves no rig is rejected at its place, with a remedy.
#[test]
fn limits_without_a_rig_have_a_place_and_a_remedy() {
    let empty = refused(&MASS.replace("dead_volume = \"20 mL\"\n", ""), &[]);
    assert!(empty.contains("rig.toml:22") && empty.contains("cylinder.dead_volume"), "{empty}");
    let shut = refused(&MASS.replacen("1e-12", "0", 1), &[]);
    assert!(shut.contains("rig.toml:15") && shut.contains("small coefficients"), "{shut}");
    let held = refused(MASS, &["operating_point.load_force=\"1 kN\""]);
    assert!(held.contains("load_force") && held.contains("load.stiffness"), "{held}");
}

const FACTORS: &str = r#"
schema = 1
title = "A plant by its factors"
[plant]
gain = 2
zeros = [-30]
poles = [0, -2, [-1, 5], [-1, -5]]
[[specification]]
kind = "robust_stability"
limit = 2
frequencies = [0.1, 1, 10]
[controller]
numerator = "3"
denominator = "1"
"#;

/// A plant by factors and its equivalent by polynomials.
#[test]
fn a_plant_by_its_zeros_poles_and_gain() {
    let polynomials = "numerator = \"2*(s + 30)\"\ndenominator = \"s*(s + 2)*(s^2 + 2*s + 26)\"";
    let same = FACTORS.replace("gain = 2\nzeros = [-30]\npoles = [0, -2, [-1, 5], [-1, -5]]", polynomials);
    let uncertain = FACTORS.replace("gain = 2\n", "gain = \"k/2 + 1\"\n")
        + "[uncertainty]\nk = { nominal = 2, minimum = 2, maximum = 2, points = 1 }\n";
    let verify = Request::Verify { proof: false, on_machine: false };
    let margin = |text: &str| number(&json(text, &[], &[], &verify), "specifications.0.worst_margin_db");
    let expected = margin(&same);
    for text in [FACTORS, &uncertain] {
        near(margin(text), expected, 1e-9);
    }
}

/// A form that is incomplete, or mixed, is rejected with the missing part, and without
/// consequential errors.
#[test]
fn an_incomplete_plant_is_refused_once() {
    let without = refused(&FACTORS.replace("gain = 2\n", ""), &[]);
    assert!(without.contains("missing `gain`") && !without.contains("zero at the nominal"), "{without}");
    let unpaired = refused(&FACTORS.replace(", [-1, -5]]", "]"), &[]);
    assert!(unpaired.contains("has no conjugate"), "{unpaired}");
    let both = refused(&FACTORS.replace("gain = 2", "gain = 2\nnumerator = \"1\"\ndenominator = \"s\""), &[]);
    assert!(both.contains("numerator") && both.contains("gain"), "{both}");
    let half = refused(
        &FACTORS.replace("gain = 2\nzeros = [-30]\npoles = [0, -2, [-1, 5], [-1, -5]]", "numerator = \"1\""),
        &[],
    );
    assert!(half.contains("missing `denominator`") && !half.contains("zero at the nominal"), "{half}");
}
