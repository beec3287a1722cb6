//! Alternatives as tasks: their results as bytes, joined in any order, are the answer of the
//! command.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may panic")]

use crate::alternatives::{LOOP, rig};
use crate::alternatives_front::front;
use crate::run_command::{answer, load, source};
use phea_workbench::answer::Answer;
use phea_workbench::command::{AlternativesRequest, AlternativesTasks, CommandError, Request};
use phea_workbench::engineering::alternatives::{AlternativeTask, AlternativesPlan, JudgedLoad};

const SLOW: &str = "\n[[load_case]]\nname = \"slow\"\nset = { \"plant.denominator\" = \"s + 0.5\" }\n";

/// The answer of a request whose tasks are judged one by one, joined in this order of their places.
fn joined(text: &str, request: &Request, order: impl Fn(&mut Vec<Vec<u8>>)) -> Answer {
    let Request::Alternatives(requested) = request else { panic!("{request:?}") };
    let (source, loaded) = (source(text), load(text, &[], &[]));
    let tasks = || AlternativesTasks::new(&source, &loaded, &[], requested, &mut |_| true).unwrap();
    let count = tasks().count().unwrap();
    let results = (0..count).map(|place| tasks().judged(place, &mut |_| true).unwrap());
    let mut results: Vec<Vec<u8>> = results.collect();
    order(&mut results);
    tasks().joined(&results).unwrap()
}

fn check_same(found: &Answer, expected: &Answer) {
    assert_eq!(found.json, expected.json);
    assert_eq!(found.text(), expected.text());
    assert_eq!(found.affirmative, expected.affirmative);
    let named = |answer: &Answer| answer.files.iter().map(|file| file.name.clone()).collect::<Vec<_>>();
    assert_eq!(named(found), named(expected));
    for (found, expected) in found.files.iter().zip(&expected.files) {
        assert!(found.bytes == expected.bytes, "{}", found.name);
    }
}

/// A load case and a front, with numbers that are infinite.
#[test]
fn tasks_joined_in_any_order_give_the_answer() {
    let text = format!("{LOOP}{SLOW}");
    let request = front("high_frequency_gain_db,swept:more", "plant.delay=1 ms..20 ms");
    let expected = answer(&text, &[], &[], &request);
    assert!(expected.json.contains("\"delay_margin_s\": \"inf\"") && expected.files.len() > 8);
    check_same(&joined(&text, &request, |_| {}), &expected);
    check_same(&joined(&text, &request, |results| results.reverse()), &expected);
    check_same(&joined(&text, &request, |results| results.rotate_left(5)), &expected);
}

/// A rig with runs and figures, a part without a price, and an alternative without a hose.
#[test]
fn tasks_of_a_rig_give_its_figures() {
    let text = rig()
        + "\n[[alternative]]\nname = \"sized\"\nsize = true\nset = { \"sizing.minimum_gain\" = \"1 V/N\" }\n";
    let request =
        Request::Alternatives(AlternativesRequest { files: true, ..AlternativesRequest::default() });
    let expected = answer(&text, &[], &[], &request);
    assert!(!expected.affirmative && expected.text().contains("sized: not judged: "));
    for name in ["alternatives.svg", "alternatives-event-1.svg", "alternatives-impedance.svg", "pipe.toml"] {
        assert!(expected.files.iter().any(|file| file.name == name), "{name}");
    }
    check_same(&joined(&text, &request, |results| results.reverse()), &expected);
}

/// A missing result, one of another project, and bytes without a result are refused.
#[test]
fn results_of_other_tasks_are_refused() {
    let requested = AlternativesRequest::default();
    let renamed = LOOP.replace("name = \"late\"", "name = \"later\"");
    let (held, loaded) = (source(LOOP), load(LOOP, &[], &[]));
    let tasks = AlternativesTasks::new(&held, &loaded, &[], &requested, &mut |_| true).unwrap();
    let late = tasks.judged(2, &mut |_| true).unwrap();
    let reason = |results: &[Vec<u8>]| tasks.joined(results).unwrap_err().to_string();
    assert_eq!(reason(std::slice::from_ref(&late)), "the result of task 0 is missing");
    assert!(reason(&[late[..late.len() / 2].to_vec()]).starts_with("no result of an alternative"));
    let absent = tasks.judged(3, &mut |_| true).unwrap_err().to_string();
    assert_eq!(absent, "the alternatives are 3 tasks, from 0: there is no task 3");
    let stopped = tasks.judged(0, &mut |_| false);
    assert!(matches!(stopped, Err(CommandError::Stopped(_))));
    let (held, loaded) = (source(&renamed), load(&renamed, &[], &[]));
    let others = AlternativesTasks::new(&held, &loaded, &[], &requested, &mut |_| true).unwrap();
    let error = others.joined(&[late]).unwrap_err().to_string();
    assert_eq!(error, "the result of task 2 is one of other alternatives");
}

/// Every alternative under each load, then at each value of the front.
#[test]
fn a_plan_lists_every_task_once() {
    let text = format!("{LOOP}{SLOW}");
    let options = phea_workbench::engineering::alternatives::AlternativesOptions::default();
    let plan = AlternativesPlan::new(&load(&text, &[], &[]), &options);
    let tasks = plan.unwrap().tasks();
    let loads = [JudgedLoad::Declared, JudgedLoad::Case(0)];
    let under = |load| (0..3).map(move |place| AlternativeTask::Alternative { load, place });
    assert_eq!(tasks, loads.into_iter().flat_map(under).collect::<Vec<_>>());
}
