//! The schema of answers: faults of answers that it finds, and its descriptions.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::Path;

use crate::answer_schema::{conforms, schema, validated};
use crate::run_command::{HOSE, json};
use phea_workbench::command::{Request, answers_schema};
use phea_workbench::engineering::simulate::Metric;
use phea_workbench::quantity::MotionKind;
use serde_json::{Value, json as value};

fn verified() -> Value {
    json(HOSE, &[], &[], &Request::Verify { proof: false, on_machine: false })
}

#[track_caller]
fn refused(change: impl Fn(&mut Value), expected: &str) {
    let mut answer = verified();
    assert_eq!(validated(&answer), Ok(()));
    change(&mut answer);
    let fault = validated(&answer).unwrap_err();
    assert!(fault.contains(expected), "{fault}");
}

#[test]
fn a_key_that_is_not_described_is_refused() {
    refused(|answer| answer["stability"]["made_up"] = value!(1), "answer.stability.made_up is not described");
}

#[test]
fn an_answer_of_an_unknown_command_is_refused() {
    refused(|answer| answer["command"] = value!("guess"), "the command has no described answer");
}

#[test]
fn an_object_of_any_keys_is_refused() {
    assert_eq!(
        conforms(&value!({ "type": "object" }), &value!({}), "it"),
        Err("it may have any key".to_string())
    );
}

#[test]
fn a_missing_key_is_refused() {
    let remove = |answer: &mut Value| {
        answer["timing"].as_object_mut().unwrap().remove("delay_s").unwrap();
    };
    refused(remove, "answer.timing lacks delay_s");
}

#[test]
fn a_wrong_word_is_refused() {
    refused(|answer| answer["verdict"] = value!("perhaps"), "answer.verdict is \"perhaps\"");
}

#[test]
fn a_value_of_another_kind_is_refused() {
    refused(|answer| answer["specifications"][0]["violations"] = value!("none"), "violations is \"none\"");
    refused(|answer| answer["tolerance_db"] = value!(null), "tolerance_db is null");
    refused(|answer| answer["members"] = value!(-1), "members is -1");
}

#[test]
fn a_quantity_of_the_motion_is_required_under_one_of_its_names() {
    refused(|answer| answer["position"] = value!({ "position_m": 0.1 }), "answer.position lacks stroke_");
    for position in
        [value!({ "position_m": 0.1, "stroke_m": 1 }), value!({ "angle_rad": 0.1, "stroke_rad": 1 })]
    {
        let mut answer = verified();
        answer["position"] = position;
        assert_eq!(validated(&answer), Ok(()));
    }
}

/// Words with which no description begins.
const FORBIDDEN: [&str; 9] = ["What", "Whether", "How", "Where", "That", "Those", "Of", "It", "Who"];

fn visit(at: &str, schema: &Value, found: &mut Vec<String>) {
    if let Some(object) = schema.as_object() {
        if let Some(Value::String(text)) = object.get("description") {
            let first = text.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or_default();
            let begins = text.starts_with(|letter: char| letter.is_uppercase() || !letter.is_alphabetic());
            if !begins || !text.ends_with('.') || FORBIDDEN.contains(&first) {
                found.push(format!("{at}: {text}"));
            }
        }
        object.iter().for_each(|(key, value)| visit(&format!("{at}/{key}"), value, found));
    }
    if let Some(list) = schema.as_array() {
        list.iter().enumerate().for_each(|(index, value)| visit(&format!("{at}/{index}"), value, found));
    }
}

#[test]
fn every_description_is_a_sentence() {
    let mut found = Vec::new();
    visit("", schema(), &mut found);
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn every_key_is_described() {
    for (name, definition) in schema()["definitions"].as_object().unwrap() {
        assert!(definition["description"].is_string(), "{name}");
        let properties = definition.get("properties").and_then(Value::as_object);
        for (key, property) in properties.into_iter().flatten() {
            assert!(property["description"].is_string(), "{name}.{key}");
        }
    }
}

/// Two values may print one word, as the flows of two kinds of meters do.
#[test]
fn no_list_of_words_repeats_one() {
    for (name, definition) in schema()["definitions"].as_object().unwrap() {
        let words = definition.get("enum").and_then(Value::as_array);
        let words: Vec<&str> = words.into_iter().flatten().map(|word| word.as_str().unwrap()).collect();
        let distinct: std::collections::BTreeSet<&str> = words.iter().copied().collect();
        assert_eq!(distinct.len(), words.len(), "{name}: {words:?}");
    }
}

#[test]
fn every_interval_of_a_reading_by_hand_is_that_of_a_reading() {
    let keys = |name: &str| {
        let definition = &schema()["definitions"][name]["properties"];
        definition.as_object().unwrap().keys().cloned().collect::<std::collections::BTreeSet<String>>()
    };
    let (intervals, readings) = (keys("GraphIntervalsAnswer"), keys("GraphReadingsAnswer"));
    assert!(!intervals.is_empty() && intervals.is_subset(&readings), "{intervals:?}");
}

#[test]
fn every_metric_of_an_event_is_in_its_answer() {
    let properties = schema()["definitions"]["EventMetricsAnswer"]["properties"].as_object().unwrap();
    for motion in [MotionKind::Linear, MotionKind::Rotary] {
        for metric in Metric::ALL {
            let key = metric.quantity().text(motion);
            assert!(properties.contains_key(key.as_ref()), "{key}");
        }
    }
}

#[test]
fn the_schema_in_the_book_is_printed_by_the_command() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/phea.answers.schema.json");
    let committed = std::fs::read(path).unwrap();
    let same = committed == answers_schema().bytes;
    assert!(same, "write it anew: cargo run -p phea-cli -- schema --answers --out book/src");
}

/// Answers are parsed by `answer_schema::parsed` alone, so that none escapes the schema.
#[test]
fn every_test_validates_the_answers_that_it_reads() {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let text: String = std::fs::read_to_string(&path).unwrap().split_whitespace().collect();
                let calls = text.split("serde_json::from_").skip(1);
                let of_answer = |call: &str| {
                    let argument = call.split(".unwrap").next().unwrap_or_default();
                    argument.trim_end_matches([')', ',']).ends_with(".json")
                };
                assert!(!calls.into_iter().any(of_answer), "{}", path.display());
            }
        }
    }
}
