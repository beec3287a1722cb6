//! The JSON objects that other programs read: their keys, their structure, and their treatment of
//! numbers that do not exist.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use std::sync::OnceLock;

use crate::run_command::{self, FICTITIOUS, HOSE, PIPE, json, load, number, size_request};
use phea_workbench::command::{Request, refusal_json};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;
use sha2::{Digest, Sha256};

const PLANT: &str = include_str!("truth/plant.toml");

/// Every request; the report, which draws a dozen pictures, is the last.
fn requests() -> [Request; 8] {
    [
        Request::Check,
        size_request(None, None),
        size_request(Some("4e-4"), None),
        size_request(None, Some("1.5 m")),
        Request::Linearize { sweep: None },
        Request::Verify { proof: false, on_machine: false },
        Request::Verify { proof: false, on_machine: true },
        Request::Report { files: true, alternatives: false },
    ]
}

/// Requests for a rig with these settings: machines are driven only if the settings concern them.
fn requests_of(settings: &[&str]) -> Vec<Request> {
    let linear_only = ["line.compliance", "linear.", "uncertainty."];
    let is_linear =
        settings.first().is_some_and(|first| linear_only.iter().any(|key| first.starts_with(key)));
    let requested = requests().into_iter().take(if is_linear { 6 } else { 7 });
    requested.collect()
}

/// Every answer about both rigs, odd ones included.
fn everything() -> &'static [(String, Value)] {
    static ANSWERS: OnceLock<Vec<(String, Value)>> = OnceLock::new();
    ANSWERS.get_or_init(answered)
}

fn answered() -> Vec<(String, Value)> {
    let odd: [&[&str]; 9] = [
        &[],
        &["controller.delay=\"1 ms\""],
        &["controller.numerator=\"1\""],
        &["cylinder.friction.viscous=\"0 N.s/m\""],
        &["line.compliance=by_volume", "fluid.entrained_air=0.01"],
        &["operating_point.position=\"0 m\""],
        &["uncertainty.valve_damping_ratio.nominal=1"],
        &[
            "linear.flow_pressure_coefficient=0",
            "uncertainty.flow_pressure_coefficient.minimum=0",
            "uncertainty.flow_pressure_coefficient.spacing=linear",
        ],
        &[
            "linear.viscous_friction=0",
            "cylinder.friction.viscous=\"0 N.s/m\"",
            "uncertainty.viscous_friction.minimum=0",
            "uncertainty.viscous_friction.spacing=linear",
        ],
    ];
    let mut answers = Vec::new();
    for (name, project) in [("hose", HOSE), ("pipe", PIPE)] {
        // an odd rig is odd for both
        let settings_of = if name == "hose" { &odd[..] } else { &odd[..1] };
        for settings in settings_of {
            for request in &requests_of(settings) {
                let label = format!("{} {name} {settings:?} {request:?}", request.name());
                answers.push((label, json(project, settings, &[FICTITIOUS], request)));
            }
        }
    }
    for gain in ["3e-5", "1e-5", "10"] {
        answers
            .push((format!("gain {gain}"), json(HOSE, &[], &[FICTITIOUS], &size_request(Some(gain), None))));
    }
    let bare = HOSE.split("[controller]").next().unwrap();
    answers.push(("no controller".to_string(), json(bare, &[], &[], &Request::Linearize { sweep: None })));
    answers.push(("plant".to_string(), json(PLANT, &[], &[], &Request::Check)));
    answers
}

#[test]
fn every_object_states_its_kind_and_file() {
    // the report need not design a controller or simulate for this
    let (project, _) = HOSE.split_once("[design]").unwrap();
    for request in requests() {
        let object = json(project, &[], &[], &request);
        assert_eq!(object["schema"], 1);
        assert_eq!(object["version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(object["command"], request.name());
        let digest: String = Sha256::digest(project).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(object["project_sha256"], digest.as_str());
    }
    // ORIGIN: other tool, sha256sum
    let expected = "017c8df60461855e2d13dc3026b26c0d4500025fddd3c020dda822f1dd3f3000";
    assert_eq!(json(PLANT, &[], &[], &Request::Check)["project_sha256"], expected);
}

#[test]
fn the_hash_is_of_the_bytes_and_settings_are_listed_next_to_it() {
    let (plain, set) = (json(HOSE, &[], &[], &Request::Check), {
        json(HOSE, &["line.length=\"2 m\""], &[FICTITIOUS], &Request::Check)
    });
    assert_eq!(plain["project_sha256"], set["project_sha256"]);
    assert_eq!(plain["settings"], serde_json::json!([]));
    assert_eq!(set["settings"], serde_json::json!(["line.length=\"2 m\""]));
    let windows = HOSE.replace('\n', "\r\n");
    assert_ne!(plain["project_sha256"], json(&windows, &[], &[], &Request::Check)["project_sha256"]);
    assert_eq!(plain["derived"], json(&windows, &[], &[], &Request::Check)["derived"]);
}

/// Paths of nulls without a reason next to them. A reason is under `reason` or under the key with
/// `_reason`.
pub(crate) fn unexplained(path: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let reasons = [key.clone() + "_reason", "reason".to_string()];
                let explained = reasons.iter().any(|name| fields.get(name).is_some_and(Value::is_string));
                if field.is_null() && !explained {
                    found.push(format!("{path}.{key}"));
                }
                unexplained(&format!("{path}.{key}"), field, found);
            }
        }
        Value::Array(entries) => {
            for (index, entry) in entries.iter().enumerate() {
                if entry.is_null() {
                    found.push(format!("{path}.{index}"));
                }
                unexplained(&format!("{path}.{index}"), entry, found);
            }
        }
        _ => {}
    }
}

#[test]
fn a_number_that_does_not_exist_has_a_reason() {
    let mut found = Vec::new();
    for (label, object) in everything() {
        unexplained(label, object, &mut found);
    }
    found.dedup();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn no_string_is_a_number_in_disguise_but_infinity() {
    fn walk(value: &Value, found: &mut Vec<String>) {
        match value {
            Value::String(text)
                if text.parse::<f64>().is_ok() && !["inf", "-inf"].contains(&text.as_str()) =>
            {
                found.push(text.clone());
            }
            Value::Object(fields) => fields.values().for_each(|field| walk(field, found)),
            Value::Array(entries) => entries.iter().for_each(|entry| walk(entry, found)),
            _ => {}
        }
    }
    for (label, object) in everything() {
        let mut object = object.clone();
        // A dash size and a unit of one are strings.
        let mut found = Vec::new();
        object.as_object_mut().unwrap().retain(|key, _| key != "bores");
        walk(&object, &mut found);
        found.retain(|text| text != "1");
        assert!(found.is_empty(), "{label}: {found:?}");
    }
}

#[test]
fn check_lists_derived_quantities() {
    let object = json(HOSE, &[], &[], &Request::Check);
    let rows = object["derived"].as_array().unwrap();
    assert!(rows.len() > 40);
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        for key in ["name", "unit", "equation", "symbol", "group"] {
            assert!(row[key].as_str().is_some_and(|text| !text.is_empty()), "{row}");
        }
        assert!(row["value"].is_number(), "{row}");
        names.push(row["name"].as_str().unwrap());
    }
    names.sort_unstable();
    let all = names.len();
    names.dedup();
    assert_eq!(names.len(), all, "a name is used twice");
    // A plant given as a transfer function is valid, and nothing follows from it.
    let object = json(PLANT, &[], &[], &Request::Check);
    assert_eq!(object["derived"], serde_json::json!([]));
}

#[test]
fn check_reports_a_stated_value_that_contradicts_the_derived_one() {
    let object = json(HOSE, &["linear.hydraulic_stiffness=4.4e6"], &[], &Request::Check);
    let rows = object["derived"].as_array().unwrap();
    let row = rows.iter().find(|row| row["name"] == "linear.hydraulic_stiffness").unwrap();
    assert_eq!(number(row, "declared.value"), 4.4e6);
    assert_eq!(row["declared"]["place"], "[linear]");
    // ORIGIN: recomputed by comparisons/recompute_rig.py: 2232961.6 N/m at mid stroke
    let expected = 100.0 * (4.4e6 / 2_232_961.6 - 1.0);
    run_command::within(number(row, "declared.difference_percent"), expected, 1e-5);
}

/// Limit (6.28) overshoots by 2.2 % while 1 % is required; nine tenths of it never settle within 1
/// % of the reference.
#[test]
fn check_compares_tracking_limits_with_their_requirements() {
    let requirements =
        |settings: &[&str]| json(HOSE, settings, &[], &Request::Check)["requirements_in_time"].clone();
    let stated = requirements(&[]);
    let [upper, lower] = [&stated[0], &stated[1]];
    for (row, key, overshoot, time, reached) in
        [(upper, "upper", 1.0, 0.1, [2.19, 0.126]), (lower, "lower", 0.0, 0.3, [0.0, 0.356])]
    {
        assert_eq!((number(row, "specification"), row["limit"].as_str()), (3.0, Some(key)));
        assert_eq!(row["met"], false);
        for side in ["required", "reached"] {
            assert_eq!(number(row, &format!("{side}.settling_band_percent")), 1.0);
        }
        assert_eq!(number(row, "required.overshoot_percent"), overshoot);
        assert_eq!(number(row, "required.settling_time_s"), time);
        assert!((number(row, "reached.overshoot_percent") - reached[0]).abs() < 0.005);
        assert!((number(row, "reached.settling_time_s") - reached[1]).abs() < 5e-4);
    }
    let met = ["specification.2.lower.settling_time=\"0.36 s\""];
    assert_eq!(requirements(&met)[1]["met"], true);
    let low = &requirements(&["specification.2.upper.numerator=\"0.9*2116*(s + 75)/75\""])[0]["reached"];
    assert!(low["settling_time_s"].is_null());
    assert_eq!(low["reason"], "does not settle: it stays 10.0 % off");
    assert_eq!(json(PLANT, &[], &[], &Request::Check)["requirements_in_time"], serde_json::json!([]));
}

#[test]
fn size_has_its_candidates() {
    for request in &requests()[1..4] {
        let object = json(HOSE, &[], &[FICTITIOUS], request);
        let rows = object["candidates"].as_array().unwrap();
        assert!(!rows.is_empty());
        for row in rows {
            assert!(row["hose"].is_string());
            assert!(row["compliance"] == "uniform" || row["compliance"] == "by_volume");
            for key in ["bore_m", "length_m", "stiffness_n_per_m", "proportional_gain_v_per_n"] {
                assert!(number(row, key) >= 0.0, "{key}: {row}");
            }
            let reasons = row["reasons"].as_array().unwrap();
            assert!(reasons.iter().all(Value::is_string));
            assert!(row["accepted"].is_boolean());
            assert!(row["accepted"] == true || !reasons.is_empty(), "{row}");
        }
    }
}

#[test]
fn linearize_has_its_keys() {
    for project in [HOSE, PIPE] {
        let object = json(project, &[], &[], &Request::Linearize { sweep: None });
        let minimum = number(&object, "stiffness.minimum_n_per_m");
        assert!(minimum > 0.0 && minimum < number(&object, "stiffness.maximum_n_per_m"));
        for (model, count) in [("full", 5), ("decomposed", 5), ("first_order", 1)] {
            let poles: Vec<[f64; 2]> = serde_json::from_value(object["poles"][model].clone()).unwrap();
            assert_eq!(poles.len(), count, "{model}");
            // Roots of a real polynomial: every one has its conjugate.
            assert!(poles.iter().all(|[re, im]| poles.contains(&[*re, -*im])), "{poles:?}");
            assert!(poles.iter().all(|[re, _]| *re < 0.0), "{poles:?}");
        }
        assert!(number(&object, "decomposition_error.magnitude_db") >= 0.0);
        assert!(number(&object, "decomposition_error.phase_deg") >= 0.0);
        for view in ["open_loop", "closed_loop"] {
            let passivity = &object["passivity"][view];
            let bands: Vec<[f64; 2]> = serde_json::from_value(passivity["bands"].clone()).unwrap();
            assert_eq!(passivity["passive"], bands.is_empty());
            assert!(bands.is_sorted_by(|one, other| one[1] <= other[0]));
            assert!(bands.iter().all(|[from, to]| from < to));
        }
    }
}

#[test]
fn without_a_rational_loop_there_is_a_reason_instead_of_a_view() {
    let bare = HOSE.split("[controller]").next().unwrap();
    for (project, settings) in [(bare, &[][..]), (HOSE, &["controller.delay=\"1 ms\""])] {
        let object = json(project, settings, &[], &Request::Linearize { sweep: None });
        assert!(object["passivity"]["closed_loop"].is_null());
        assert!(object["passivity"]["closed_loop_reason"].is_string());
        assert!(object["passivity"]["open_loop"]["passive"].is_boolean());
    }
}

#[test]
fn the_same_project_gives_the_same_bytes() {
    for request in &requests()[..7] {
        let answer = || run_command::answer(HOSE, &[], &[FICTITIOUS], request);
        assert_eq!(answer(), answer());
    }
}

#[test]
fn a_refusal_is_an_object_too() {
    let broken = HOSE.replace("stroke = \"500 mm\"", "stroke = \"-500 mm\"\nstrok = 1");
    let source = Memory::default().with("rig.toml", broken.as_str());
    let report = project::read(&source, "rig.toml", &[], &[]).unwrap_err();
    for request in requests() {
        let object: Value = parsed(&refusal_json(&source, "rig.toml", request.name(), &report));
        assert_eq!(object["schema"], 1);
        assert_eq!(object["command"], request.name());
        let rows = object["errors"].as_array().unwrap();
        assert!(rows.len() >= 2, "all errors of a file in one run: {rows:?}");
        for row in rows {
            assert!(row["message"].is_string() && number(row, "line") >= 1.0 && number(row, "column") >= 1.0);
        }
        let line = broken.lines().position(|line| line.starts_with("strok =")).unwrap() + 1;
        assert!(rows.iter().any(|row| number(row, "line") == line as f64), "{rows:?}");
    }
}

#[test]
fn warnings_of_the_reading_are_repeated() {
    let loaded = load(HOSE, &[], &[]);
    let object = json(HOSE, &[], &[], &Request::Check);
    let warnings: Vec<&str> =
        object["warnings"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
    assert!(
        loaded.warnings.iter().all(|warning| warnings.contains(&warning.message.as_str())),
        "{warnings:?}"
    );
    // and before them the effects that no verdict includes
    assert!(
        warnings.len() == loaded.warnings.len() + 1
            && warnings[0].starts_with("the family does not contain the rig")
    );
}
