//! The progress of long commands never falls, and each stage has its name.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{self, Progress, Request};

use crate::ask::{self, HOSE};

#[track_caller]
fn told(text: &str, settings: &[&str], request: &Request) -> Vec<Progress> {
    let loaded = ask::load(text, settings, &[]);
    let mut told = Vec::new();
    let mut watch = |progress: Progress| {
        told.push(progress);
        true
    };
    command::answer_into(&ask::source(text), &loaded, &[], request, None, &mut watch).unwrap();
    assert!(told.is_sorted_by(|one, other| one.share <= other.share), "{request:?}");
    assert!(told.iter().all(|one| !one.stage.is_empty() && (0.0..=1.0).contains(&one.share)));
    told
}

#[test]
fn the_audit_leaves_room_for_the_machine() {
    let told = told(HOSE, &[], &Request::Verify { proof: false, on_machine: true });
    let first = told.iter().find(|one| one.stage == "nonlinear simulation").unwrap();
    assert!((0.4..0.6).contains(&first.share), "{first:?}");
    assert_eq!(told.first().unwrap().stage, "auditing");
}
