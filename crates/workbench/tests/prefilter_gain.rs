//! A designed prefilter that amplifies no more than it may, so that the loop does by itself what
//! the reference asks for.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::ask::{json, number};
use phea_workbench::command::Request;
use serde_json::Value;

/// One plant, 1/(s (s/50 + 1)), whose response is to settle in 0.8 s: the least gain at high
/// frequencies leaves all of it to the prefilter.
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

/// The largest |F| from 1e-3 to 1e5 rad/s, from gain, zeros and poles of the answer.
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

/// Without a limit the loop crosses over far below what the response needs; with one the prefilter
/// keeps it, and the loop is fast enough.
#[test]
fn a_prefilter_keeps_its_gain_and_the_loop_does_the_work() {
    let free = designed(&[], "");
    let limited = designed(&["design.prefilter_gain=1.5"], "");
    let crossover = |design: &Value| number(design, "figures.crossover_rad_per_s");
    assert!(largest_gain(&free) > 5.0, "{}", largest_gain(&free));
    assert_eq!(limited["status"], "met", "{limited:#}");
    assert!(largest_gain(&limited) <= 1.5 * (1.0 + 1e-9), "{}", largest_gain(&limited));
    assert!(crossover(&free) < 1.0 && crossover(&limited) > 2.0);
    let limit = &limited["limits"][0];
    assert_eq!((&limit["key"], &limit["kept"]), (&"prefilter_gain".into(), &true.into()));
}

/// What is required of one plant alone, a prefilter could do without a loop: that is told until
/// something limits what a disturbance leaves.
#[test]
fn that_nothing_asks_for_feedback_is_told() {
    let tells = |design: &Value| design["explanations"].to_string().contains("nothing asks for feedback");
    assert!(tells(&designed(&[], "")));
    let limit = "[[specification]]\nkind = \"sensitivity\"\nlimit = 0.5\nfrequencies = [1]\nband = [0, 1]\n";
    assert!(!tells(&designed(&[], limit)));
    // plants that differ by more than the limits allow need one
    let uncertain = "[uncertainty]\nk = { nominal = 1, minimum = 0.5, maximum = 2, points = 3 }\n";
    let settings = ["plant.numerator=\"50*k\""];
    assert!(!tells(&designed(&settings, uncertain)));
}
