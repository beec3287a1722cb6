//! A design that the watch stops in one of its stages: its results until then remain, and the
//! answer lists the missing parts.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

use crate::answer_schema::parsed;
use phea_workbench::answer::Answer;
use phea_workbench::command::{CommandError, Progress, Request, answer_into, stopped_text};
use serde_json::{Value, json};

use crate::command_of_steps::simple_rig;
use crate::run_command::{load, source};

const REQUEST: Request = Request::Design { seed: None, stages: true, repair: true };

/// The design of a simple rig under a watch that stops it from a stage on, and the stages that were
/// reported.
fn stopped_in(stage: &str) -> (Result<Answer, CommandError>, Vec<&'static str>) {
    let text = simple_rig();
    let (rig, _) = text.split_once("[controller]").unwrap();
    let text = format!("{rig}[design]\nstructure = \"pi\"\n");
    let mut seen: Vec<&'static str> = Vec::new();
    let mut watch = |progress: Progress| {
        if seen.last() != Some(&progress.stage) {
            seen.push(progress.stage);
        }
        !seen.contains(&stage)
    };
    let found = answer_into(&source(&text), &load(&text, &[], &[]), &[], &REQUEST, None, &mut watch);
    (found, seen)
}

fn names(answer: &Answer) -> Vec<&str> {
    answer.files.iter().map(|file| file.name.as_str()).collect()
}

/// A design stopped in the trial, in the later stages, and only in the files: each answer has the
/// controller and lists every missing part, and none is affirmative.
// ORIGIN: written by hand, the stages in their order
#[test]
fn a_stopped_design_lists_its_missing_stages() {
    let cases = [
        ("nonlinear simulation", json!(["machine", "relaxations", "templates_and_bounds"])),
        ("relaxing each limit", json!(["relaxations", "templates_and_bounds"])),
        ("templates and bounds", json!(["templates_and_bounds"])),
        ("no stage at all", json!([])),
    ];
    for (stage, expected) in cases {
        let (found, _) = stopped_in(stage);
        let answer = found.unwrap();
        let design: Value = parsed(&answer.json);
        assert_eq!(design["unfinished"], expected, "{stage}");
        let is_whole = expected == json!([]);
        assert!(is_whole || !answer.affirmative, "{stage}");
        assert_eq!(design["status"] == "stopped", !is_whole, "{stage}");
        let is_simulated = !expected.as_array().unwrap().contains(&json!("machine"));
        assert_eq!(design["machine"].is_object(), is_simulated, "{stage}");
        assert_eq!(
            answer.text().contains("no trial on the nonlinear rig was finished"),
            !is_simulated,
            "{stage}"
        );
        assert_eq!(answer.text().contains("templates and bounds are not among the files"), !is_whole);
        let files = names(&answer);
        assert!(files.contains(&"designed.toml") && files.contains(&"loop.csv"), "{files:?}");
        assert_eq!(files.contains(&"bounds.csv"), is_whole, "{files:?}");
    }
}

/// A design stopped in the first stage has no answer, unless the search already had a controller,
/// which is the best so far; the reason names the stage and the parts that were not begun.
#[test]
fn a_design_stopped_at_once_lists_the_stages_not_begun() {
    let (_, stages) = stopped_in("no stage at all");
    let first = stages[0];
    let (found, seen) = stopped_in(first);
    assert_eq!(seen, [first]);
    match found {
        Err(error) => assert!(matches!(error, CommandError::Stopped(_)), "{error}"),
        Ok(answer) => {
            let design: Value = parsed(&answer.json);
            assert_eq!((&design["status"], &design["unfinished"][0]), (&json!("stopped"), &json!("search")));
        }
    }
    let text = stopped_text(&REQUEST, Some(first));
    assert!(text.contains(first) && text.contains("no controller") && text.contains("not begun"), "{text}");
}
