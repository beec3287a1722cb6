//! Cost and mass of the parts of a rig, compared with sums by hand.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::alternatives::{judged, rig};
use crate::answer_schema::parsed;
use crate::run_command::{HOSE, answer, try_answer};
use phea_workbench::command::Request;
use serde_json::Value;

const COSTS: &str = include_str!("../../project/tests/valid/costs.toml");

fn derived(text: &str, settings: &[&str]) -> Vec<Value> {
    let json: Value = parsed(&answer(text, settings, &[], &Request::Check).json);
    json["derived"].as_array().unwrap().clone()
}

fn of<'d>(derived: &'d [Value], name: &str) -> &'d Value {
    derived.iter().find(|one| one["name"] == name).unwrap_or_else(|| panic!("{name}"))
}

/// A hose, a pipe of steel with an accumulator, a valve between the chambers, a spring and a
/// servovalve.
#[test]
fn a_sum_is_that_of_its_parts() {
    let found = derived(COSTS, &[]);
    let value = |name: &str| of(&found, name)["value"].as_f64().unwrap();
    // ORIGIN: analytic; 12.192 EUR/ft are 40 EUR/m
    let hose = 25.5 + 40.0 * 1.5;
    assert!((value("parts.hose.a.price") - hose).abs() < 1e-9);
    assert!((value("parts.price") - (hose + 9.0 + 500.0 + 0.0 + 320.0 + 1450.0)).abs() < 1e-9);
    assert_eq!(of(&found, "parts.price")["unit"], "EUR");
    // ORIGIN: analytic; a ring of 10 mm inner and 14 mm outer diameter
    let pipe = std::f64::consts::PI / 4.0 * (0.014_f64.powi(2) - 0.010_f64.powi(2)) * 7850.0;
    assert!((value("parts.pipe.b.mass") / pipe - 1.0).abs() < 1e-12);
    let oil = 870.0 * std::f64::consts::PI / 4.0 * (0.0127_f64.powi(2) * 1.5 + 0.010_f64.powi(2));
    assert!((value("parts.oil_in_lines.mass") / oil - 1.0).abs() < 1e-12);
    let parts = (0.4 + 0.3 * 1.5) + pipe + 2.0 + 0.0 + 4.0 + 1.1;
    assert!((value("parts.mass") / (parts + oil) - 1.0).abs() < 1e-12);
}

/// A stated mass of a pipe replaces that of its wall; coils have the mass of their wire.
#[test]
fn masses_follow_from_walls_and_coils() {
    let value = |settings: &[&str], name: &str| of(&derived(COSTS, settings), name)["value"].as_f64();
    assert_eq!(value(&["line.b.pipe.mass_per_length=0.7"], "parts.pipe.b.mass"), Some(0.7));
    let spring =
        "series={ stiffness = \"2.24 MN/m\", coil = { index = 4, allowed_shear_stress = \"600 MPa\" } }";
    let [coil, part] = ["series.coil.mass", "parts.series.mass"].map(|name| value(&[spring], name).unwrap());
    assert!(coil > 1.0 && part == coil);
}

/// A part that states nothing is named, and nothing is summed without it; if no part states
/// anything there is no chapter.
#[test]
fn a_part_that_is_missing_is_named() {
    let line = "line.b.pipe={ bore = \"10 mm\", wall_thickness = \"2 mm\", youngs_modulus = \"206 GPa\" }";
    let found = derived(COSTS, &[line]);
    for quantity in ["price", "mass"] {
        let part = of(&found, &format!("parts.pipe.b.{quantity}"));
        assert!(part["value"].is_null() && part["reason"] == "not stated", "{part}");
        let sum = of(&found, &format!("parts.{quantity}"));
        assert!(sum["value"].is_null(), "{sum}");
    }
    let none = derived(HOSE, &[]);
    assert!(!none.iter().any(|one| one["name"].as_str().unwrap().starts_with("parts.")));
}

/// Two currencies are not added, within a project and between alternatives.
#[test]
fn prices_in_two_currencies_are_refused() {
    let text = rig().replace("price = \"12 EUR\"", "price = \"12 USD\"");
    let refused = try_answer(&text, &[], &[], &Request::Check).unwrap_err().to_string();
    assert!(refused.contains("pipe") && refused.contains("USD where others are in EUR"), "{refused}");
}

/// Both lines with their ends and metres, the oil in them, and the remarks on it.
#[test]
fn parts_have_their_stated_cost_and_mass() {
    let columns = |index: usize| &judged().1["alternatives"][index]["columns"];
    let number = |index: usize, key: &str| columns(index)[key].as_f64().unwrap();
    let oil = |index: usize| number(index, "lines_volume_m3") * 870.0;
    // ORIGIN: analytic, 2 (25 + 40 1.5) EUR and 2 (12) EUR; 2 (0.3 1.5) kg and 2 (0.5 0.35) kg, and
    // the oil
    for (index, price, mass) in [(0, 170.0, 0.9), (1, 24.0, 0.35)] {
        assert!((number(index, "parts_price") - price).abs() < 1e-9);
        assert!((number(index, "parts_mass_kg") - (mass + oil(index))).abs() < 1e-12);
        assert_eq!(columns(index)["parts_currency"], "EUR");
    }
    let text = &judged().0.text();
    assert!(text.contains("170.0 EUR") && text.contains("price 24.00 EUR instead of 170.0 EUR"), "{text}");
}
