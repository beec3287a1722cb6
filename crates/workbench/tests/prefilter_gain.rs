//! A designed prefilter whose amplification is limited, so that the loop itself follows the
//! reference.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::run_command::{json, number};
use phea_workbench::command::Request;
use serde_json::Value;

/// A single plant, 1/(s (s/50 + 1)), whose response must settle in 0.8 s: the least gain at high
/// frequencies leaves everything to the prefilter.
const SERVO: &str = r#"schema = 1
title = "one plant"
[plant]
numerator = "50"
denominator = "s*(s + 50)"
[design]
maximum_order = 2
limits = "none"
[[specification]]
kind = "robust_stability"
limit = 1.3
frequencies = [0.1, 1, 10, 50, 100]
band = [0, inf]
[[specification]]
kind = "tracking"
frequencies = [0.1, 1, 5, 10]
[specification.upper]
overshoot_percent = 5
settling_time = "0.3 s"
settling_band_percent = 2
zero = "40 rad/s"
[specification.lower]
settling_time = "0.8 s"
settling_band_percent = 2
pole = "40 rad/s"
"#;

fn designed(settings: &[&str], further: &str) -> Value {
    json(
        &format!("{SERVO}{further}"),
        settings,
        &[],
        &Request::Design { seed: None, stages: false, repair: false },
    )
}

/// The largest |F| from 1e-3 to 1e5 rad/s, computed from gain, zeros and poles of the answer.
fn largest_gain(design: &Value) -> f64 {
    let of = |key: &str| -> Vec<[f64; 2]> {
        let roots = design["prefilter"][key].as_array().unwrap().iter();
        roots.map(|root| [0, 1].map(|part| root[part].as_f64().unwrap())).collect()
    };
    let (zeros, poles, gain) = (of("zeros"), of("poles"), number(design, "prefilter.gain"));
    let distance = |w: f64, [re, im]: [f64; 2]| ((w - im).powi(2) + re * re).sqrt();
    let size = |w: f64| {
        let product = |roots: &[[f64; 2]]| roots.iter().map(|root| distance(w, *root)).product::<f64>();
        gain.abs() * product(&zeros) / product(&poles)
    };
    (0..=8000).map(|place| size(10f64.powf(-3.0 + f64::from(place) / 1000.0))).fold(0.0, f64::max)
}

/// The loop without a limit has a crossover far below that of the response; with a limit the
/// prefilter satisfies it, and the loop is fast enough.
#[test]
fn a_prefilter_has_its_gain_and_the_loop_tracks() {
    let free = designed(&[], "");
    let limited = designed(&["design.prefilter_gain=1.5"], "");
    let crossover = |design: &Value| number(design, "figures.crossover_rad_per_s");
    assert!(largest_gain(&free) > 5.0, "{}", largest_gain(&free));
    assert_eq!(limited["status"], "met", "{limited:#}");
    assert!(largest_gain(&limited) <= 1.5 * (1.0 + 1e-9), "{}", largest_gain(&limited));
    assert!(crossover(&free) < 1.0 && crossover(&limited) > 2.0);
    let limit = &limited["limits"][0];
    assert_eq!((&limit["key"], &limit["satisfied"]), (&"prefilter_gain".into(), &true.into()));
}

/// A prefilter without a loop could satisfy the requirements on a single plant: this is reported
/// until something limits the effect of a disturbance.
#[test]
fn superfluous_feedback_is_reported() {
    let explains = |design: &Value| design["explanations"].to_string().contains("nothing requires feedback");
    assert!(explains(&designed(&[], "")));
    let limit = "[[specification]]\nkind = \"sensitivity\"\nlimit = 0.5\nfrequencies = [1]\nband = [0, 1]\n";
    assert!(!explains(&designed(&[], limit)));
    // plants that differ by more than the limits allow need feedback
    let uncertain = "[uncertainty]\nk = { nominal = 1, minimum = 0.5, maximum = 2, points = 3 }\n";
    let settings = ["plant.numerator=\"50*k\""];
    assert!(!explains(&designed(&settings, uncertain)));
}

/// Torque control of a motor of 80 cm3 against a torsional specimen, with a friction of a tenth of
/// the torque.
const MOTOR: &str = r#"schema = 1
title = "motor"
[fluid]
bulk_modulus = "1.5 GPa"
density = "870 kg/m3"
kinematic_viscosity = "46 cSt"
[supply]
model = "constant"
pressure = "200 bar"
tank_pressure = "2 bar"
[valve]
nominal_voltage = "10 V"
nominal_flow = "38 L/min"
nominal_pressure_drop = "70 bar"
natural_frequency = "60 Hz"
damping_ratio = 0.8
null_leakage = "1.5 L/min"
null_leakage_pressure = "200 bar"
leakage_shape = 60
[motor]
displacement = "80 cc/rev"
inertia = "0.01 kg.m2"
dead_volume = "100 mL"
internal_leakage = "0.004 L/(min.bar)"
[motor.friction]
model = "stribeck"
viscous = "0.15 N.m.s/rad"
coulomb = "7 N.m"
static = "10 N.m"
stribeck_velocity = "1 rad/s"
regular_velocity = "0.2 rad/s"
[line]
model = "lumped"
bore = "12.7 mm"
volumetric_expansion = "4 mL/m"
volumetric_expansion_pressure = "200 bar"
length = "1 m"
[force_sensor]
stiffness = "60 kN.m/rad"
[load]
model = "spring_mass_damper"
mass = "0.7 kg.m2"
damping = "1.5 N.m.s/rad"
stiffness = "2 kN.m/rad"
[operating_point]
load_force = "80 N.m"
[uncertainty]
"load.mass" = { nominal = "0.7 kg.m2", minimum = "0.4 kg.m2", maximum = "1.4 kg.m2", points = 3 }
[controller]
sample_time = "1 ms"
delay = "1 ms"
saturation = "10 V"
[design]
maximum_order = 3
"#;

/// The requirements of the servo above for a motor: the loop itself follows the reference, and if
/// friction delays the nonlinear rig, the design allows for it.
#[test]
fn a_motor_that_friction_delays_satisfies_what_is_required() {
    let requirements = &SERVO[SERVO.find("[[specification]]").unwrap()..];
    let request = Request::Design { seed: None, stages: false, repair: false };
    let found = json(&format!("{MOTOR}{requirements}"), &[], &[], &request);
    assert_eq!(found["status"], "met", "{found:#}");
    assert!(number(&found, "figures.crossover_rad_per_s") > 3.0);
    assert!(largest_gain(&found) <= 2.0);
    assert_eq!(found["machine"]["requirements"], "satisfies", "{:#}", found["machine"]);
    assert_ne!(found["machine"]["verdict"], "contradicts");
}

/// A pure gain is tested with a prefilter of gain 1/T(0), and taken if it satisfies the
/// requirements: for k/(s + 1) with k from 1 to 1.1 a gain of 10 gives |T(0)| from 0.909 to 0.917,
/// well within 5 %.
#[test]
fn a_pure_gain_is_chosen_if_it_satisfies() {
    let text = "schema = 1\ntitle = \"lag\"\n[plant]\nnumerator = \"k\"\ndenominator = \"s + 1\"\n\
        [uncertainty]\nk = { nominal = 1, minimum = 1, maximum = 1.1, points = 3 }\n\
        [[specification]]\nkind = \"step\"\novershoot_percent = 10\nsettling_time = \"0.5 s\"\n\
        settling_band_percent = 5\n\
        [[specification]]\nkind = \"robust_stability\"\nlimit = 1.3\nfrequencies = [1, 10, 100]\n";
    let object = json(text, &[], &[], &Request::Design { seed: None, stages: false, repair: false });
    let structures = object["structures"].as_array().unwrap();
    let taken: Vec<&Value> = structures.iter().filter(|one| one["taken"] == true).collect();
    assert_eq!((&object["status"], taken[0]["words"].as_str()), (&"met".into(), Some("P")), "{object:#}");
}
