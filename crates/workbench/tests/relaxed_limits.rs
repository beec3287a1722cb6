//! Gain from relaxing a limit, compared with closed forms and with designs for the relaxed limit.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::run_command::{json, number, within};
use phea_workbench::command::Request;
use serde_json::Value;

const DESIGN: Request = Request::Design { seed: None, stages: false, repair: false };

/// Plant k/s under a gain, with |1/(1+L)| at most LIMIT at up to 1 rad/s.
const GAIN: &str = r#"schema = 1
title = "an integrator under a gain"
[plant]
numerator = "k"
denominator = "s"
[uncertainty]
k = { nominal = 1, minimum = 1, maximum = 4 }
[[specification]]
kind = "sensitivity"
limit = LIMIT
frequencies = [0.1, 1]
band = [0, 1]
[design]
limits = "none"
structure = "p"
"#;

/// Plant 1/(s (s/50 + 1)) under a gain and a pole: the modulus margin needs a fast pole.
const LAG: &str = r#"schema = 1
title = "a servo under a gain and a pole"
[plant]
numerator = "50"
denominator = "s*(s + 50)"
[[specification]]
kind = "sensitivity"
limit = 0.1
frequencies = [0.3, 1]
band = [0, 1]
[design]
limits = "none"
modulus_margin = 0.7
structure = [{ kind = "pole", frequency = ["1 rad/s", "1000 rad/s"] }]
gain = [0.1, 1000]
"#;

fn designed(project: &str, settings: &[&str]) -> Value {
    json(project, settings, &[], &DESIGN)
}

fn relaxation(design: &Value, name: &str) -> f64 {
    let all = design["relaxations"].as_array().unwrap();
    let found = all.iter().find(|one| one["name"] == name);
    let found = found.unwrap_or_else(|| panic!("{name}: {all:#?}"));
    within(number(found, "relaxed_by"), 0.1, 1e-12);
    number(
        found,
        if found["objective_gained_db"].is_null() { "worst_margin_gained_db" } else { "objective_gained_db" },
    )
}

/// Sensitivity |1/(1 + g/j)| = limit needs g^2 = 1/limit^2 - 1 for the plant 1/s at 1 rad/s.
#[test]
fn a_gain_falls_as_its_sensitivity_limit_allows() {
    let gain_db = |limit: f64| 10.0 * (1.0 / (limit * limit) - 1.0).log10();
    let design = designed(&GAIN.replace("LIMIT", "0.5"), &[]);
    assert_eq!(design["status"], "met", "{design:#}");
    within(relaxation(&design, "1 sensitivity"), gain_db(0.5) - gain_db(0.55), 0.02);
}

/// Two limits that bind, each compared with a design for the relaxed one.
#[test]
fn a_relaxed_limit_permits_the_margin_of_its_design() {
    let design = designed(LAG, &[]);
    assert_eq!(design["status"], "met", "{design:#}");
    let reached = |design: &Value| number(design, "objective.value_db");
    let margin = designed(LAG, &["design.modulus_margin=0.63"]);
    let sensitivity = designed(&LAG.replace("limit = 0.1", "limit = 0.11"), &[]);
    let bought = [relaxation(&design, "modulus margin"), relaxation(&design, "1 sensitivity")];
    let expected = [margin, sensitivity].map(|other| reached(&design) - reached(&other));
    assert!(expected.iter().all(|gained| *gained > 0.3), "{expected:?}");
    for (bought, expected) in bought.into_iter().zip(expected) {
        within(bought, expected, 0.03);
    }
    let limit = &design["limits"][0];
    assert_eq!(limit["key"], "modulus_margin");
    within(number(limit, "relaxed.value"), 0.63, 1e-12);
    within(number(limit, "relaxed.objective_gained_db"), bought[0], 1e-12);
}

/// Two limits that no loop satisfies: |S| and |T| of an integrator under a gain at 1 rad/s.
#[test]
fn a_relaxed_limit_recovers_a_part_of_the_deficit() {
    let both = |sensitivity: &str| {
        let further = "[[specification]]\nkind = \"robust_stability\"\nlimit = 0.7\nfrequencies = [0.1, 1]\nband = [0.5, 1]\n[design]";
        GAIN.replace("LIMIT", sensitivity)
            .replace("[design]", further)
            .replace("minimum = 1, maximum = 4", "minimum = 1, maximum = 1")
    };
    let design = designed(&both("0.5"), &[]);
    assert_eq!(design["status"], "infeasible", "{design:#}");
    let missing = |design: &Value| number(design, "relaxation_db");
    let returned = missing(&design) - missing(&designed(&both("0.55"), &[]));
    assert!(returned > 0.1, "{returned}");
    within(relaxation(&design, "1 sensitivity"), returned, 0.02);
}
