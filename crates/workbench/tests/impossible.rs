//! Requirements that no loop can satisfy are stated by `check` and `verify`, from where they begin.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::ask::json;
use phea_workbench::command::Request;
use serde_json::Value;

/// A plant with this denominator and delay, a controller, and specifications.
fn project(denominator: &str, delay: &str, specifications: &str) -> String {
    format!(
        "schema = 1\ntitle = \"impossible\"\n[plant]\nnumerator = \"1\"\ndenominator = \"{denominator}\"\n\
         delay = \"{delay}\"\n[controller]\nnumerator = \"2\"\ndenominator = \"1\"\n[prefilter]\n\
         numerator = \"1\"\ndenominator = \"1\"\n{specifications}"
    )
}

fn limit(kind: &str, limit: &str, band: &str) -> String {
    format!("[[specification]]\nkind = \"{kind}\"\nlimit = {limit}\nfrequencies = [1, 1.5]\nband = {band}\n")
}

/// What `check` and `verify` say, which is one and the same.
fn said(project: &str) -> Vec<Value> {
    let [one, other] = [Request::Check, Request::Verify { proof: false, on_machine: false }]
        .map(|request| json(project, &[], &[], &request)["impossible"].as_array().unwrap().clone());
    assert_eq!(one, other);
    one
}

#[track_caller]
fn assert_begins(of: impl Fn(f64) -> String, possible: f64, impossible: f64, key: &str, parts: &[&str]) {
    assert_eq!(said(&of(possible)), Vec::<Value>::new());
    let found = said(&of(impossible));
    let own =
        found.iter().find(|one| one["key"] == key).unwrap_or_else(|| panic!("{key} is missing in {found:?}"));
    let words = format!("{} {}", own["sentence"], own["cure"]);
    parts.iter().for_each(|part| assert!(words.contains(part), "{part} is missing in: {words}"));
    assert!(own["line"].as_u64().unwrap() > 0);
}

/// S + T = 1: limits of 0.5 on |T| and of less than 0.5 on |S| leave no loop.
#[test]
fn limits_of_s_and_t_that_add_up_to_less_than_one() {
    let of = |sensitivity: f64| {
        let both = [
            limit("sensitivity", &sensitivity.to_string(), "[1, 2]"),
            limit("robust_stability", "0.5", "[1, 2]"),
        ];
        project("s + 1", "0 s", &both.concat())
    };
    assert_begins(
        of,
        0.52,
        0.49,
        "specification[0].limit",
        &["S + T = 1", "|S| may be 0.5", "|T| may be 0.51"],
    );
}

/// A pole of the plant at 1 rad/s and a dead time of 0.5 s: T(1) = 1, so that max |T| is at least
/// e^0.5 = 1.649.
#[test]
fn a_delay_and_an_unstable_pole() {
    let of = |most: f64| project("s - 1", "0.5 s", &limit("robust_stability", &most.to_string(), "[0, inf]"));
    assert_begins(of, 1.66, 1.63, "specification[0].limit", &["raise its limits"]);
}

/// No step settles before the dead time has passed.
#[test]
fn a_settling_time_shorter_than_the_dead_time() {
    let of = |time: f64| {
        project("s", "0.1 s", &format!("[[specification]]\nkind = \"step\"\nsettling_time = \"{time} s\"\n"))
    };
    let parts =
        ["no step settles in 99.0 ms", "100 ms the dead time of the plant", "require more than 100 ms"];
    assert_begins(of, 0.101, 0.099, "specification[0].settling_time", &parts);
}

/// |a/(j + 1)| = a/sqrt(2) is below 0.9 for a below 1.273.
#[test]
fn limits_of_tracking_that_cross() {
    let of = |a: f64| {
        let upper = format!("{{ numerator = \"{a}\", denominator = \"s + 1\" }}");
        let limits = format!("upper = {upper}\nlower = 0.9\nfrequencies = [1]\n");
        project("s", "0 s", &format!("[[specification]]\nkind = \"tracking\"\n{limits}"))
    };
    assert_begins(of, 1.28, 1.26, "specification[0].lower", &["the limits cross", "raise `upper`"]);
}
