//! Requirements in time from which limits of tracking follow: the verdict includes the linear steps
//! of the plants, whose closed forms are known here.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use crate::run_command::{self, number};
use phea_workbench::command::Request;
use serde_json::Value;

/// A single plant in a loop with gain 1 and a prefilter of 1, whose limits are satisfied at their
/// only frequency.
fn project(plant: &str, uncertainty: &str, controller: &str, lower: &str) -> String {
    format!(
        "schema = 1\ntitle = \"time\"\n[plant]\n{plant}\n[uncertainty]\n{uncertainty}\n\
         [controller]\nnumerator = \"1\"\ndenominator = \"1\"\n{controller}\n\
         [prefilter]\nnumerator = \"1\"\ndenominator = \"1\"\n\
         [[specification]]\nkind = \"tracking\"\nfrequencies = [0.01]\n\
         upper = {{ overshoot_percent = 20, settling_time = \"1 s\", settling_band_percent = 2 }}\n\
         lower = {lower}\n"
    )
}

fn verify(text: &str) -> (Value, String) {
    let source = phea_workbench::source::Memory::default().with("rig.toml", text);
    let loaded = phea_workbench::project::read(&source, "rig.toml", &[], &[])
        .unwrap_or_else(|report| panic!("{report}"));
    let request = Request::Verify { proof: false, on_machine: false };
    let answer = phea_workbench::command::answer(&source, &loaded, &[], &request).unwrap();
    (parsed(&answer.json), answer.text())
}

fn lower(settling_s: f64) -> String {
    format!("{{ settling_time = \"{settling_s} s\", settling_band_percent = 2 }}")
}

const GAINS: &str = "k = { nominal = 2, minimum = 1, maximum = 4, points = 3 }";

/// Plant k/s closed is 1/(s/k + 1): settled to 2 % after ln(50)/k, last for the least k. It is
/// within the limits over frequency in either case.
#[test]
fn a_lag_that_settles_too_late_is_not_met() {
    let latest = 50.0_f64.ln();
    for (required, verdict) in [(3.0, "violated"), (5.0, "met")] {
        let text = project("numerator = \"k\"\ndenominator = \"s\"", GAINS, "", &lower(required));
        let (object, words) = verify(&text);
        assert_eq!(object["verdict"], verdict, "{words}");
        assert_eq!(object["specifications"][0]["verdict"], "met");
        let found = &object["specifications"][0]["in_time"];
        assert_eq!((found["verdict"].as_str(), found["evidence"].as_str()), (Some(verdict), Some("search")));
        // the band is wider by the accuracy of a step, a hundredth of a percent
        let settled = number(found, "worst_settling_time_s");
        assert!((settled - latest).abs() < 0.01, "{settled} {latest}");
        assert_eq!(found["settling_plant"]["k"], 1.0);
        let word = if verdict == "met" { "is met" } else { "is not met" };
        assert!(words.contains(&format!("1 tracking in time {word}")), "{words}");
        assert_eq!(object["evidence"], "search");
    }
}

/// Plant k/s closed settles after ln(50)/k, here after forty times the requirement: a stable step
/// is computed until it settles, and its worst plant is the slowest.
#[test]
fn a_step_far_beyond_the_requirement_is_computed_until_it_settles() {
    let slow = "k = { nominal = 0.2, minimum = 0.1, maximum = 0.4, points = 3 }";
    let (object, words) = verify(&project("numerator = \"k\"\ndenominator = \"s\"", slow, "", &lower(1.0)));
    let found = &object["specifications"][0]["in_time"];
    run_command::near(number(found, "worst_settling_time_s"), 10.0 * 50.0_f64.ln(), 0.01);
    assert_eq!(found["settling_plant"]["k"], 0.1);
    assert!(words.contains("settled in 39"), "{words}");
}

/// Limits that are stated are only compared with the requirement.
#[test]
fn a_stated_limit_is_not_replaced_by_its_requirement() {
    let stated = "{ numerator = \"1\", denominator = \"10*s + 1\", settling_time = \"3 s\", settling_band_percent = 2 }";
    let text = project("numerator = \"k\"\ndenominator = \"s\"", GAINS, "", stated);
    let (object, _) = verify(&text);
    let found = &object["specifications"][0]["in_time"];
    assert_eq!((object["verdict"].as_str(), found["verdict"].as_str()), (Some("met"), Some("violated")));
    assert_eq!(found["part_of_verdict"], false);
}

/// Plant w^2/(s (s + 2 zeta w)) closed overshoots by exp(-pi zeta/sqrt(1 - zeta^2)), most for the
/// least zeta.
#[test]
fn the_overshoot_of_the_worst_plant_is_found() {
    let damping = "z = { nominal = 0.6, minimum = 0.3, maximum = 0.9, points = 2 }";
    let plant = "numerator = \"100\"\ndenominator = \"s*(s + 20*z)\"";
    let (object, _) = verify(&project(plant, damping, "", &lower(3.0)));
    let found = &object["specifications"][0]["in_time"];
    let expected = 100.0 * (-std::f64::consts::PI * 0.3 / (1.0_f64 - 0.09).sqrt()).exp();
    run_command::near(number(found, "worst_overshoot_percent"), expected, 1e-4);
    assert_eq!(found["overshoot_plant"]["z"], 0.3);
    assert_eq!(object["verdict"], "violated");
}

/// Dead time by the method of steps and by short samples gives equal settling times; without the
/// dead time the settling time differs.
#[test]
fn steps_of_delayed_and_of_sampled_loops_agree() {
    let gains = "k = { nominal = 1, minimum = 1, maximum = 1.0001, points = 2 }";
    let settled = |controller: &str| {
        let plant = "numerator = \"k\"\ndenominator = \"s\"";
        let (object, words) = verify(&project(plant, gains, controller, &lower(3.0)));
        assert!(words.contains("in time is"), "{words}");
        number(&object, "specifications.0.in_time.worst_settling_time_s")
    };
    let delayed = settled("delay = \"200 ms\"");
    let sampled = settled("delay = \"200 ms\"\nsample_time = \"1 ms\"");
    // a zero-order hold delays by half a sample
    assert!((delayed - sampled).abs() < 5e-3, "{delayed} {sampled}");
    let at_once = settled("");
    run_command::near(at_once, 50.0_f64.ln(), 2e-3);
    assert!((delayed - at_once).abs() > 0.1, "{delayed} {at_once}");
}

/// Prefilter F = (10 s + 1)/(0.1 s + 1) rises by a factor of a hundred, 40 dB; a lag amplifies
/// nothing.
#[test]
fn a_prefilter_that_amplifies_is_reported() {
    let plain = project("numerator = \"k\"\ndenominator = \"s\"", GAINS, "", &lower(5.0));
    let of = |prefilter: &str| {
        verify(&plain.replace("[prefilter]\nnumerator = \"1\"\ndenominator = \"1\"", prefilter))
    };
    let (object, words) = of("[prefilter]\nnumerator = \"10*s + 1\"\ndenominator = \"0.1*s + 1\"");
    let rise = number(&object, "amplifying_prefilter.rise_db");
    assert!((rise - 40.0).abs() < 0.01, "{rise}");
    assert!(words.contains("the prefilter amplifies"), "{words}");
    let (object, _) = of("[prefilter]\nnumerator = \"3\"\ndenominator = \"0.1*s + 1\"");
    run_command::near(number(&object, "amplifying_prefilter.gain_at_zero"), 3.0, 1e-12);
    for quiet in
        ["numerator = \"1\"\ndenominator = \"0.1*s + 1\"", "numerator = \"s + 1\"\ndenominator = \"s + 1\""]
    {
        let (object, words) = of(&format!("[prefilter]\n{quiet}"));
        assert!(object["amplifying_prefilter"].is_null() && !words.contains("amplifies"), "{words}");
    }
}
