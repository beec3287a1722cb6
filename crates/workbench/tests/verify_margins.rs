//! Margins of the nominal loop and the worst of the family, compared with closed forms.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::run_command::{HOSE, answer, json};
use phea_workbench::audit::above_one_again_words;
use phea_workbench::command::Request;
use phea_workbench::engineering::audit::Crossovers;
use serde_json::{Value, json as object_of};

const VERIFY: Request = Request::Verify { proof: false, on_machine: false };

fn close(value: &Value, expected: f64) {
    let number = value.as_f64().unwrap_or_else(|| panic!("{value} instead of {expected}"));
    assert!((number - expected).abs() <= 1e-5 * expected.abs(), "{number} instead of {expected}");
}

/// Plant k/s with a dead time, k from 1 to 4.
const DELAYED: &str = "schema = 1\ntitle = \"delayed\"\n[plant]\nnumerator = \"k\"\ndenominator = \"s\"\n\
    delay = \"0.1 s\"\n[uncertainty]\nk = { nominal = 2, minimum = 1, maximum = 4, points = 3 }\n[controller]\n\
    numerator = \"1\"\ndenominator = \"1\"\n[[specification]]\nkind = \"robust_stability\"\nlimit = 2\n\
    frequencies = [1, 5]\nband = [0, inf]\n";

/// The margins of k e^(-s T)/s.
fn assert_delayed(set: &Value, k: f64, dead_time_s: f64) {
    close(&set["gain_db"], 20.0 * (PI / (2.0 * dead_time_s * k)).log10());
    close(&set["phase_deg"], 90.0 - (k * dead_time_s).to_degrees());
    close(&set["delay_s"], FRAC_PI_2 / k - dead_time_s);
    assert_eq!(set["gain_reduction_db"], "-inf");
    let at = &set["at"];
    close(&at["gain_db"]["frequency_rad_per_s"], FRAC_PI_2 / dead_time_s);
    close(&at["phase_deg"]["frequency_rad_per_s"], k);
    close(&at["delay_s"]["frequency_rad_per_s"], k);
    for key in ["gain_db", "phase_deg", "modulus", "delay_s"] {
        close(&at[key]["plant"]["k"], k);
    }
    assert!(at["gain_reduction_db"]["frequency_rad_per_s"].is_null());
    assert_eq!(at["gain_reduction_db"]["frequency_rad_per_s_reason"], "nothing limits it");
}

#[test]
fn the_worst_of_a_family_of_gains_is_at_the_largest() {
    let output = answer(DELAYED, &[], &[], &VERIFY);
    let object: Value = parsed(&output.json);
    let margins = &object["margins"];
    assert_delayed(&margins["nominal"], 2.0, 0.1);
    assert_delayed(&margins["family"], 4.0, 0.1);
    for key in ["gain_db", "gain_reduction_db", "phase_deg", "modulus", "delay_s"] {
        assert_eq!(margins[key], margins["family"][key]);
    }
    // the least |1 + L| over a fine grid
    let distance = |w: f64| {
        let (re, im) = (1.0 - 4.0 * (0.1 * w).sin() / w, -4.0 * (0.1 * w).cos() / w);
        re.hypot(im)
    };
    let scan = (1..=400_000).map(|i| distance(f64::from(i) * 1e-4)).fold(f64::INFINITY, f64::min);
    close(&margins["modulus"], scan);
    assert_eq!(margins["evidence"], "search");
    // ORIGIN: analytic, 20 log10(5 pi/4) dB and 90 deg - 0.4 rad
    for part in ["gain may grow by", "11.9 dB", "67.1 deg", "worst of the family"] {
        assert!(output.text().contains(part), "{part} is missing in: {}", output.text());
    }
}

/// The plant 8/(s - 1) needs its gain: |L| = 8 at zero frequency, |1 + L| = |jw + 7|/|jw - 1| falls
/// to 1.
#[test]
fn around_an_unstable_plant_the_gain_may_not_fall() {
    let unstable = DELAYED
        .replace("denominator = \"s\"", "denominator = \"s - 1\"")
        .replace("delay = \"0.1 s\"\n", "")
        .replace("nominal = 2, minimum = 1, maximum = 4", "nominal = 8, minimum = 8, maximum = 16");
    let margins = &json(&unstable, &[], &[], &VERIFY)["margins"];
    let crossover = 63.0_f64.sqrt();
    assert_eq!(margins["gain_db"], "inf");
    close(&margins["gain_reduction_db"], -20.0 * 8.0_f64.log10());
    close(&margins["nominal"]["phase_deg"], crossover.atan().to_degrees());
    close(&margins["nominal"]["delay_s"], crossover.atan() / crossover);
    close(&margins["nominal"]["modulus"], 1.0);
    let at = &margins["family"]["at"];
    assert_eq!(at["modulus"]["frequency_rad_per_s"], "inf");
    assert_eq!(at["gain_reduction_db"]["frequency_rad_per_s"], 0.0);
    assert_eq!(at["gain_reduction_db"]["plant"]["k"], 8.0);
}

/// The loop k e^(-s T)/s is stable up to k = pi/(2 T): a family beyond that has no margins, a
/// nominal loop below it has some.
#[test]
fn an_unstable_family_has_no_margins_with_the_reason() {
    let beyond = DELAYED.replace("maximum = 4", "maximum = 16");
    let margins = &json(&beyond, &[], &[], &VERIFY)["margins"];
    assert!(margins["family"].is_null() && margins["phase_deg"].is_null());
    let reason = "no margin: not every plant is known to be stable";
    assert_eq!((&margins["phase_deg_reason"], &margins["family_reason"]), (&reason.into(), &reason.into()));
    assert_delayed(&margins["nominal"], 2.0, 0.1);
}

/// Lines with waves have no polynomials: their margins tend to those of lumped lines as the waves
/// become fast, and the worst of a family is never better than its nominal loop.
#[test]
fn loops_without_polynomials_have_margins_too() {
    let settings = |model| {
        ["line.length=\"0.05 m\"".to_string(), format!("line.model={model}"), "uncertainty={}".into()]
    };
    let found = ["lumped", "transmission_line"].map(|model| {
        let settings = settings(model);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        json(HOSE, &settings, &[], &VERIFY)["margins"].clone()
    });
    let [lumped, waves] = &found;
    for key in ["gain_db", "phase_deg", "modulus", "delay_s"] {
        let [one, other] = [lumped, waves].map(|margins| margins["nominal"][key].as_f64().unwrap());
        assert!((one - other).abs() < 0.03 * one.abs(), "{key}: {one} {other}");
        assert!(waves["family"][key].as_f64().unwrap().abs() <= other.abs() * (1.0 + 1e-9), "{key}");
    }
}

/// The limits that a loop exceeds, by key.
fn below(project: &str, settings: &[&str]) -> Vec<Value> {
    json(project, settings, &[], &VERIFY)["below_design"].as_array().unwrap().clone()
}

fn of_key<'a>(below: &'a [Value], key: &str) -> Option<&'a Value> {
    below.iter().find(|one| one["key"] == key)
}

/// The modulus margin of the audit compared with the limit of a design, by default or as stated; a
/// plant of polynomials has no default.
#[test]
fn a_loop_lists_the_design_limits_that_it_violates() {
    let output = answer(HOSE, &[], &[], &VERIFY);
    let object: Value = parsed(&output.json);
    let found = object["below_design"].as_array().unwrap();
    let modulus = of_key(found, "modulus_margin").unwrap();
    assert_eq!(modulus["value"], object["margins"]["modulus"]);
    assert_eq!((&modulus["limit"], &modulus["origin"]), (&0.5.into(), &"default".into()));
    // the loop tolerates 2 ms and half a millisecond is enough
    assert!(of_key(found, "minimum_delay_margin").is_none());
    assert!(output.text().contains("`phea design` would refuse this loop"), "{}", output.text());
    let explained =
        output.text().contains("The bandwidth is the frequency above which |L/(1+L)| of every plant");
    assert_eq!(explained, of_key(found, "highest_bandwidth").is_some(), "{}", output.text());
    let reached = modulus["value"].as_f64().unwrap();
    for (fraction, is_below) in [(0.98, false), (1.02, true)] {
        let stated = format!("design.modulus_margin={}", fraction * reached);
        let found = below(HOSE, &[&stated]);
        let own = of_key(&found, "modulus_margin");
        assert_eq!(own.map(|own| own["origin"].clone()), is_below.then(|| "stated".into()), "{stated}");
    }
    let delay_s = object["margins"]["delay_s"].as_f64().unwrap();
    let found = below(HOSE, &[&format!("design.minimum_delay_margin={}", 1.1 * delay_s)]);
    close(&of_key(&found, "minimum_delay_margin").unwrap()["value_s"], delay_s);
    assert!(below(DELAYED, &[]).is_empty());
}

/// Plant k/s under a gain of 1: |1 + L| is 1 at least, and the phase may lag by a right angle.
#[test]
fn a_loop_lists_the_design_limits_that_it_satisfies() {
    let plant = DELAYED.replace("delay = \"0.1 s\"\n", "");
    let output = answer(&plant, &["design.modulus_margin=0.9"], &[], &VERIFY);
    let object: Value = parsed(&output.json);
    assert_eq!(
        (&object["below_design"], &object["satisfied_limits_of_design"]),
        (&object_of!([]), &object_of!(["modulus_margin"]))
    );
    let sentence = "the loop keeps every limit of `[design]` that a given loop is held against, stated or by default: modulus margin";
    assert!(output.text().contains(sentence), "{}", output.text());
    assert!(output.text().contains("90.0 deg of lag"), "{}", output.text());
    let nothing = answer(&plant, &[], &[], &VERIFY);
    assert!(!nothing.text().contains("`[design]`"), "{}", nothing.text());
}

/// A lag that brings L to -1 is a delay, which the delay margin does not exceed: the angle of the
/// rig with hoses, 0.32 ms at its frequency where 2.4 ms are tolerated, is a lead.
#[test]
fn a_phase_on_the_side_of_lead_is_negative() {
    let output = answer(HOSE, &[], &[], &VERIFY);
    let object: Value = parsed(&output.json);
    for loops in ["nominal", "family"] {
        let found = &object["margins"][loops];
        let number = |key: &str| found[key].as_f64().unwrap();
        let frequency = found["at"]["phase_deg"]["frequency_rad_per_s"].as_f64().unwrap();
        let time_s = number("phase_deg").to_radians() / frequency;
        assert!(time_s.abs() < number("delay_s") && time_s < 0.0, "{loops}: {time_s} s");
    }
    assert!(output.text().contains("deg of lead"), "{}", output.text());
}

/// The noise in the command equals its value at the limit if a limit just above it is satisfied and
/// one just below it is not.
#[test]
fn the_noise_that_a_loop_passes_to_its_command_is_that_of_its_limit() {
    let rig = include_str!("../../../examples/structural/rig.toml");
    let at = |percent: f64| below(rig, &[&format!("design.noise_to_command={}", percent / 100.0)]);
    let reached = of_key(&at(1e-4), "noise_to_command").unwrap()["value"].as_f64().unwrap();
    assert!(of_key(&at(101.0 * reached), "noise_to_command").is_none());
    close(&of_key(&at(99.0 * reached), "noise_to_command").unwrap()["value"], reached);
}

/// The loop |L| = e^p(w) crosses 1 at the roots of p: the crossover is where it falls through 1 for
/// the first time, whatever is beyond.
#[test]
fn the_crossover_is_the_first_fall_through_one() {
    let of = |roots: &[f64], sign: f64| {
        let exponent = |w: f64| roots.iter().fold(sign, |product, root| product * (root - w));
        Crossovers::of(roots.to_vec(), |w| Some(exponent(w).exp()))
    };
    let lag = of(&[1.0], 1.0);
    assert_eq!((lag.first_rad_per_s, lag.again_rad_per_s), (Some(1.0), None));
    let resonant = of(&[1.0, 3.0, 5.0], 1.0);
    assert_eq!((resonant.first_rad_per_s, resonant.again_rad_per_s), (Some(1.0), Some([3.0, 5.0])));
    assert_eq!(above_one_again_words(&resonant).as_deref(), Some("between 3.00 and 5.00 rad/s"));
    let twice = of(&[1.0, 3.0, 5.0, 7.0, 9.0], 1.0);
    assert_eq!(twice.again_rad_per_s, Some([3.0, 9.0]));
    // a peak that touches 1 is no crossing: e^-(w - 2)^2
    assert_eq!(of(&[1.0, 2.0, 2.0], 1.0).again_rad_per_s, None);
    // below 1 at zero frequency, and then above 1
    let resonance = of(&[2.0, 4.0], -1.0);
    assert_eq!((resonance.first_rad_per_s, resonance.again_rad_per_s), (Some(4.0), None));
    assert_eq!(of(&[2.0], -1.0), Crossovers::default());
    assert_eq!(of(&[1.0, 3.0], 1.0).again_rad_per_s, Some([3.0, f64::INFINITY]));
    assert_eq!(of(&[], -1.0).first_rad_per_s, None);
}
