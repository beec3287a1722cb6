//! Alternatives: `alternatives` reports for each the results of the single commands.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]
#![allow(clippy::disallowed_methods, reason = "expected numbers have a tolerance")]

use crate::answer_schema::parsed;
use std::sync::OnceLock;

use crate::json_contract::unexplained;
use crate::run_command::{HOSE, answer, load, retracted_length, source};
use phea_workbench::alternatives::{ColumnKey, LengthUnknown, prepared as prepared_alternatives};
use phea_workbench::answer::Answer;
use phea_workbench::command::{AlternativesRequest, Request, answer_into};
use phea_workbench::quantity::MotionKind;
use serde_json::Value;

fn alternatives_request(files: bool) -> Request {
    Request::Alternatives(AlternativesRequest { files, ..AlternativesRequest::default() })
}

pub(super) const LOOP: &str = r#"
schema = 1
title = "A lag"
[plant]
numerator = "k"
denominator = "s + 1"
[uncertainty]
k = { nominal = 1, minimum = 1, maximum = 2 }
[[specification]]
kind = "sensitivity"
limit = 2
frequencies = [1]
band = [0, inf]
[[alternative]]
name = "faster"
set = { "plant.denominator" = "s + 3" }
[[alternative]]
name = "late"
set = { "plant.delay" = "10 ms" }
"#;

/// A rig with one plant, driven for half a second.
pub(super) fn rig() -> String {
    let (head, _) = HOSE.split_once("[uncertainty]").unwrap();
    // equal edges: at rest without force the command is zero, as at the operating point
    let (before, rest) = head.split_once("[valve.flow_coefficients]").unwrap();
    let (_, after) = rest.split_once("[cylinder]").unwrap();
    format!(
        "{}flow_coefficients = [3e-7, 3e-7, 3e-7, 3e-7]\nleakage_coefficients = [2.2e-9, 2.2e-9, 2.2e-9, 2.2e-9]\n[cylinder]{}{}",
        before,
        after.replace(
            "[line]\n",
            "[line]\nprice = \"25 EUR\"\nprice_per_length = \"40 EUR/m\"\nmass_per_length = \"0.3 kg/m\"\n"
        ),
        r#"
[[specification]]
kind = "robust_stability"
limit = 1.5
frequencies = [1, 10, 100]
band = [0, inf]

[[specification]]
kind = "sensitivity"
limit = { numerator = "s", denominator = "s + 5" }
frequencies = [1, 5]

[[scenario]]
name = "step and motion"
duration = "0.5 s"
reference = [{ at = "0.1 s", force = "1 kN" }]
load_motion = { kind = "smooth_step", start = "0.3 s", duration = "0.1 s", distance = "1 mm" }

[[scenario]]
name = "rest"
duration = "0.2 s"

[[alternative]]
name = "pipe"
[alternative.set]
"line" = { pipe = { bore = "10.5 mm", price = "12 EUR", mass_per_length = "0.5 kg/m" }, length = "0.35 m", compliance = "uniform" }
"cylinder.dead_length" = "0.3 m"
"#
    )
}

pub(super) fn json_of(answer: &Answer) -> Value {
    parsed(&answer.json)
}

/// The answer for the rig, computed once for all tests.
pub(super) fn judged() -> &'static (Answer, Value) {
    static JUDGED: OnceLock<(Answer, Value)> = OnceLock::new();
    JUDGED.get_or_init(|| {
        let found = answer(&rig(), &[], &[], &alternatives_request(true));
        let json = json_of(&found);
        (found, json)
    })
}

/// Sizing, rig and scenario of each alternative, and no absence without a reason.
#[test]
fn every_alternative_has_its_columns_and_reasons() {
    for json in [&judged().1, &json_of(&answer(LOOP, &[], &[], &alternatives_request(false)))] {
        let mut found = Vec::new();
        unexplained("", json, &mut found);
        // the ends of a proof's interval have their reason next to the interval
        found.retain(|path| !path.contains(".enclosure_db."));
        assert!(found.is_empty(), "{}", found.join("\n"));
        for one in json["alternatives"].as_array().unwrap() {
            for key in ["name", "verdict", "design", "machine", "columns"] {
                assert!(one.get(key).is_some(), "{key}");
            }
        }
    }
    let columns = |index: usize| &judged().1["alternatives"][index]["columns"];
    let (hose, pipe) = (columns(0), columns(1));
    // ORIGIN: analytic, 2 pi/4 (10.5 mm)^2 0.35 m
    assert!((pipe["lines_volume_m3"].as_f64().unwrap() - 6.0613e-5).abs() < 1e-9);
    assert_eq!(pipe["lines_length_m"], 0.7);
    // the purpose of the hose
    let least = |columns: &Value| columns["stiffness_minimum_n_per_m"].as_f64().unwrap();
    assert!(least(pipe) > 5.0 * least(hose));
}

/// A number that is not stated is not zero; the flow that the valve takes at rest is that of a run
/// at rest.
#[test]
fn lengths_and_losses_are_those_of_the_rig() {
    let columns = |index: usize| &judged().1["alternatives"][index]["columns"];
    // ORIGIN: analytic, 0.5 m and 0.3 m
    assert!((columns(1)["actuator_length_m"].as_f64().unwrap() - 0.8).abs() < 1e-12);
    assert!(columns(0)["actuator_length_m"].is_null() && columns(0)["gas_volume_m3"].is_null());
    assert_eq!(columns(0)["actuator_length_m_reason"], "not stated: cylinder.dead_length");
    assert!(judged().0.text.contains("not stated"));
    for index in 0..2 {
        let power = columns(index)["power_at_rest_w"].as_f64().unwrap();
        let energy = columns(index)["scenarios"][1]["energy_from_supply_j"].as_f64().unwrap();
        // 0.2 s at rest, by the equations of the machine and by those of the operating point
        assert!((energy / (0.2 * power) - 1.0).abs() < 1e-5, "{energy} J, {power} W");
        let moved = columns(index)["scenarios"][0]["energy_from_supply_j"].as_f64().unwrap();
        assert!(moved > 0.5 * power);
    }
}

/// Length with a spring on the rod: that of the rig as declared and of the coils that `check`
/// computes; without coils, or with too few of them, there is a reason.
#[test]
fn a_spring_on_the_rod_has_a_length() {
    let length = |coil: &str| {
        let spring = format!("series={{ stiffness = \"2.24 MN/m\"{coil} }}");
        let settings = ["cylinder.dead_length=0.3 m", spring.as_str()];
        (
            retracted_length(&load(HOSE, &settings, &[]).project),
            json_of(&answer(HOSE, &settings, &[], &Request::Check)),
        )
    };
    let (found, check) = length(", coil = { index = 4, allowed_shear_stress = \"600 MPa\" }");
    let derived = check["derived"].as_array().unwrap();
    let coils = derived.iter().find(|one| one["name"] == "series.coil.installed_length").unwrap();
    let spring = coils["value"].as_f64().unwrap();
    // ORIGIN: analytic, 0.5 m of stroke and 0.3 m; thesis chapter 7 has the spring with it
    assert!(spring > 0.1 && (found.unwrap() - (0.8 + spring)).abs() < 1e-12);
    assert_eq!(length("").0.unwrap_err(), LengthUnknown::NoCoil);
    let few = length(", coil = { index = 12, allowed_shear_stress = \"600 MPa\" }").0.unwrap_err();
    assert_eq!(few, LengthUnknown::TooFewCoils);
    let plain = retracted_length(&load(HOSE, &["cylinder.dead_length=0.3 m"], &[]).project);
    // ORIGIN: analytic, 0.5 m and 0.3 m
    assert!((plain.unwrap() - 0.8).abs() < 1e-12);
    let unstated = retracted_length(&load(HOSE, &[], &[]).project).unwrap_err();
    assert_eq!(unstated, LengthUnknown::NoDeadLength);
}

/// Under a load case each alternative is designed with the settings of the case; the alternative's
/// own settings come last.
#[test]
fn a_load_case_equals_every_alternative_with_set() {
    let text =
        format!("{LOOP}\n[[load_case]]\nname = \"slow\"\nset = {{ \"plant.denominator\" = \"s + 0.5\" }}\n");
    let found = answer(&text, &[], &[], &alternatives_request(true));
    let json = json_of(&found);
    assert_eq!(
        json["alternatives"],
        json_of(&answer(LOOP, &[], &[], &alternatives_request(false)))["alternatives"]
    );
    let case = &json["load_cases"][0];
    assert_eq!(
        (&case["name"], &case["settings"][0]),
        (&"slow".into(), &"plant.denominator=\"s + 0.5\"".into())
    );
    let designed = Request::Design { seed: None, stages: false, repair: false };
    let (slow, faster) = ("plant.denominator=\"s + 0.5\"", "plant.denominator=\"s + 3\"");
    let settings: [&[&str]; 3] = [&[slow], &[faster], &[slow, "plant.delay=\"10 ms\""]];
    for (index, settings) in settings.into_iter().enumerate() {
        let separate = json_of(&answer(LOOP, settings, &[], &designed));
        for key in ["controller", "verification", "status"] {
            assert_eq!(case["alternatives"][index]["design"][key], separate[key], "{settings:?} {key}");
        }
    }
    let file = |name: &str| {
        let file = found.files.iter().find(|file| file.name == name).unwrap();
        String::from_utf8(file.bytes.clone()).unwrap()
    };
    let rows = file("load_cases.csv");
    assert_eq!(rows.lines().count(), 7);
    assert!(rows.starts_with("load_case,name,feasible,") && rows.contains("\n\"slow\",\"late\",true,"));
    assert!(file("late, slow.toml").contains("s + 0.5") && file("late.toml").contains("s + 1"));
    assert!(
        found.text.contains("declared load") && found.text.contains("slow: all satisfy every specification")
    );
}

/// The impedance is that which `linearize` computes for the written project, and tends to the
/// damper of the leakage at low frequencies.
#[test]
fn impedances_are_those_of_the_written_project() {
    let (found, json) = judged();
    for (index, name) in ["as declared", "pipe"].into_iter().enumerate() {
        let file = found.files.iter().find(|file| file.name == format!("{name}.toml")).unwrap();
        let loaded = load(std::str::from_utf8(&file.bytes).unwrap(), &[], &[]);
        let setup = phea_workbench::setup::Setup::new(&loaded.project).unwrap();
        let rig = setup.rig().unwrap();
        let models =
            phea_workbench::linearize::linearize(rig, setup.controller.as_ref(), &setup.sensor).unwrap();
        let columns = json["alternatives"][index]["columns"]["impedance"].as_array().unwrap();
        assert_eq!(columns.len(), 3);
        for at in columns {
            let frequency = at["frequency_rad_per_s"].as_f64().unwrap();
            let views = [
                ("impedance_open_n_s_per_m", &models.open_loop),
                ("impedance_closed_n_s_per_m", models.closed_loop.as_ref().unwrap()),
            ];
            for (key, view) in views {
                let expected = view.impedance.at_frequency(frequency).norm_sqr().sqrt();
                assert!(
                    (at[key].as_f64().unwrap() / expected - 1.0).abs() < 1e-6,
                    "{name} {key} {frequency}"
                );
            }
        }
    }
}

/// Every number by which alternatives are compared can be requested in a front.
#[test]
fn every_column_has_a_sense() {
    fn keys(value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Object(entries) => {
                let is_number = |value: &Value| value.is_number();
                found
                    .extend(entries.iter().filter(|(_, value)| is_number(value)).map(|(key, _)| key.clone()));
                entries
                    .iter()
                    .filter(|(key, _)| *key != "passivity")
                    .for_each(|(_, value)| keys(value, found));
            }
            Value::Array(values) => values.iter().for_each(|value| keys(value, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    keys(&judged().1["alternatives"][1]["columns"], &mut found);
    let known =
        |key: &String| ColumnKey::ALL.iter().any(|known| known.quantity().text(MotionKind::Linear) == *key);
    let unknown: Vec<&String> =
        found.iter().filter(|key| *key != "frequency_rad_per_s" && !known(key)).collect();
    assert!(found.len() > 20 && unknown.is_empty(), "{unknown:?}");
}

/// The tables for people have the names of the columns, not their keys.
#[test]
fn every_column_has_a_name() {
    let text = &judged().0.text;
    let keys = ColumnKey::ALL.iter().map(|key| key.quantity().text(MotionKind::Linear));
    let printed: Vec<_> = keys.filter(|key| key.contains('_') && text.contains(&**key)).collect();
    assert!(text.contains("oil in both lines") && printed.is_empty(), "{printed:?}");
}

/// The ranges of the rig that an alternative changes, and only these; without the option the check
/// reports this.
#[test]
fn ranges_follow_the_rig_if_requested() {
    let pipe = "\n[[alternative]]\nname = \"pipe\"\nRECENTRE\n[alternative.set]\n\
                \"line\" = { pipe = { bore = \"10.5 mm\" }, length = \"0.35 m\", compliance = \"uniform\" }\n";
    let text = |recentre: &str| format!("{HOSE}{}", pipe.replace("RECENTRE", recentre));
    let declared = load(&text("recentre = true"), &[], &[]);
    let following = prepared_alternatives(&source(&text("recentre = true")), &declared, &[]).unwrap().0;
    let moved: Vec<&str> = following[1].moved.iter().map(|range| range.name.as_str()).collect();
    assert_eq!(moved, ["hydraulic_stiffness"]);
    let [nominal, least, greatest] = following[1].moved[0].moved;
    // ORIGIN: recomputed by book/recompute_theory.py, thesis (6.19) with the pipes: 17.1 to 124
    // MN/m
    assert!((nominal / 1.71e7 - 1.0).abs() < 5e-3 && nominal == least, "{nominal} {least}");
    assert!((greatest / 1.24e8 - 1.0).abs() < 5e-3, "{greatest}");
    assert!(following[1].outside(&following).is_none());
    let warning = "pipe: the ranges of [uncertainty] do not contain its rig";
    let check = |recentre: &str| answer(&text(recentre), &[], &[], &Request::Check).text;
    assert!(check("recentre = false").contains(warning) && !check("recentre = true").contains(warning));
}

/// A sized alternative has the hose and length that `size` accepts first; one without a hose is
/// refused.
#[test]
fn a_sized_alternative_has_the_hose_of_size() {
    let text = format!(
        "{HOSE}\n[[alternative]]\nname = \"sized\"\nsize = true\nset = {{ \"line.length\" = \"1 m\" }}\n"
    );
    let all = prepared_alternatives(&source(&text), &load(&text, &[], &[]), &[]).unwrap().0;
    let size = Request::Size { gain: None, length: None };
    let sized = json_of(&answer(&text, &["line.length=1 m"], &[], &size));
    let best = &sized["candidates"][0];
    assert_eq!(best["rejections"], Value::Array(vec![]));
    let line = &all[1].loaded.project.actuator.as_ref().unwrap().line;
    assert_eq!(line.a.hose_name(), best["hose"].as_str());
    assert!((line.a.length().unwrap() - best["length_m"].as_f64().unwrap()).abs() < 1e-12);
    assert!(line.a.length() != Some(1.0) && line.a == line.b);
    let pipe = format!(
        "{}\n[[alternative]]\nname = \"p\"\nsize = true\nset = {{ \"title\" = \"x\" }}\n",
        crate::run_command::PIPE
    );
    let refused = prepared_alternatives(&source(&pipe), &load(&pipe, &[], &[]), &[]).unwrap_err().to_string();
    assert_eq!(refused, "alternative `p`: `size` finds the hoses of both sides: its [line] must have them");
}

/// The design of an alternative is that of the project with identical settings.
#[test]
fn each_design_is_that_of_design_with_set() {
    let json = json_of(&answer(LOOP, &[], &[], &alternatives_request(false)));
    let designed = Request::Design { seed: None, stages: false, repair: false };
    let settings: [&[&str]; 3] = [&[], &["plant.denominator=\"s + 3\""], &["plant.delay=\"10 ms\""]];
    for (index, settings) in settings.into_iter().enumerate() {
        let separate = json_of(&answer(LOOP, settings, &[], &designed));
        let one = &json["alternatives"][index];
        for key in ["controller", "prefilter", "verification", "status", "figures"] {
            assert_eq!(one["design"][key], separate[key], "{settings:?} {key}");
        }
        assert_eq!(one["columns"]["order"], separate["figures"]["order"]);
        assert_eq!(one["columns"]["delay_margin_s"], separate["verification"]["delay_margin_s"]);
        assert_eq!(one["verdict"], separate["verification"]["verdict"]);
    }
}

/// The written project is the alternative with its controller: `simulate` gives identical numbers.
#[test]
fn each_written_project_is_the_one_that_was_driven() {
    let (found, json) = judged();
    for (index, name) in ["as declared", "pipe"].into_iter().enumerate() {
        let file = found.files.iter().find(|file| file.name == format!("{name}.toml")).unwrap();
        let text = std::str::from_utf8(&file.bytes).unwrap();
        let separate = json_of(&answer(text, &[], &[], &Request::Simulate(Default::default())));
        let columns = &json["alternatives"][index]["columns"]["scenarios"][0];
        let events = &separate["scenarios"][0]["events"];
        let peak = |event: usize, key: &str| events[event]["metrics"][key].as_f64().unwrap();
        let close = |one: f64, other: f64| (one - other).abs() <= 1e-9 * one.abs();
        assert!(close(columns["disturbance_peak_n"].as_f64().unwrap(), peak(1, "disturbance_peak_n")));
        assert!(close(columns["overshoot_percent"].as_f64().unwrap(), peak(0, "overshoot_percent")));
        let most = peak(0, "control_rms_v").max(peak(1, "control_rms_v"));
        assert!(close(columns["control_rms_v"].as_f64().unwrap(), most));
    }
    let names: Vec<&str> = found.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "alternatives.csv",
            "as declared.toml",
            "pipe.toml",
            "alternatives.svg",
            "alternatives-event-1.svg",
            "alternatives-event-2.svg",
            "alternatives-impedance.svg",
        ]
    );
}

/// Results that are finished when the watch stops are returned; the rest is named.
#[test]
fn a_stop_returns_the_finished_alternatives() {
    let mut watch = |progress: phea_workbench::command::Progress| progress.fraction < 0.34;
    let stopped = answer_into(
        &source(LOOP),
        &load(LOOP, &[], &[]),
        &[],
        &alternatives_request(false),
        None,
        &mut watch,
    )
    .unwrap();
    let json = json_of(&stopped);
    assert_eq!(json["alternatives"].as_array().unwrap().len(), 1);
    assert_eq!(json["not_reached"], serde_json::json!(["faster", "late"]));
    assert!(!stopped.affirmative && stopped.text.contains("late: not reached"));
}

/// The report judges the alternatives if requested, and otherwise states how to request it.
#[test]
fn the_report_names_or_judges_the_alternatives() {
    let page = |request: &Request| {
        let found = answer(LOOP, &[], &[], request);
        let file = found.files.into_iter().find(|file| file.name == "report.html").unwrap();
        String::from_utf8(file.bytes).unwrap()
    };
    let named = page(&Request::Report { files: false, alternatives: false });
    assert!(named.contains("<section id=\"alternatives\">") && named.contains("phea report --alternatives"));
    assert!(named.contains("faster, late") && !named.contains("delay tolerated</td>"));
    let judged = page(&Request::Report { files: false, alternatives: true });
    assert!(judged.contains("<section id=\"alternatives\">") && judged.contains("delay tolerated</td>"));
    assert!(!judged.contains("phea report --alternatives"));
}

pub(super) const BOOK: &str = include_str!("../../../book/src/theory/compliance_compared.md");

/// The rows of the book's tables with that many columns, each as its words in a line.
pub(super) fn rows_of_the_book(columns: usize) -> Vec<String> {
    let rows = BOOK.lines().filter(|line| line.starts_with("| ") && line.split(" | ").count() == columns);
    let rows = rows.map(|row| row.trim_matches(['|', ' ']).replace(" | ", " "));
    rows.filter(|row| !row.contains("specifications")).collect()
}

/// True if a row of the book is in a line of an output, its numbers and words in order.
pub(super) fn is_in_line(row: &str, output: &str) -> bool {
    let lines = output.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "));
    lines.map(|line| format!("{line} ")).any(|line| line.contains(&format!("{row} ")))
}

/// The commands that story and book have in common are in both, and the story's output is compared
/// with the command's.
#[test]
fn the_book_agrees_with_the_story() {
    let story = include_str!("../../../examples/13_alternatives.md");
    let shared = ["as declared", "pipe", "hose by volume", "accumulators"];
    let rows = rows_of_the_book(10);
    assert_eq!(rows.len(), 13);
    for name in shared {
        let row = rows.iter().find(|row| row.starts_with(&format!("{name} met"))).unwrap();
        assert!(is_in_line(row, story), "{row}");
    }
}

/// Every row of the book, under every load.
#[test]
#[ignore = "thirty-nine designs, nineteen of them infeasible"]
fn soak_the_book_agrees_with_the_comparison() {
    let project = include_str!("../../../examples/ybitu/compliance.toml");
    let found = answer(project, &[], &[], &alternatives_request(false));
    let rows = [rows_of_the_book(10), rows_of_the_book(8)].concat();
    assert_eq!(rows.len(), 39);
    let missing: Vec<&String> = rows.iter().filter(|row| !is_in_line(row, &found.text)).collect();
    assert!(missing.is_empty(), "{missing:#?}\n{}", found.text);
}
