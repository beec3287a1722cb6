//! The progress of long commands never falls, and each stage has its name.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may panic")]

use phea_workbench::command::{self, Progress, Request};

use crate::run_command::{self, HOSE};

#[track_caller]
fn reports(text: &str, settings: &[&str], request: &Request) -> Vec<Progress> {
    let loaded = run_command::load(text, settings, &[]);
    let mut reports = Vec::new();
    let mut watch = |progress: Progress| {
        reports.push(progress);
        true
    };
    command::answer_into(&run_command::source(text), &loaded, &[], request, None, &mut watch).unwrap();
    assert!(reports.is_sorted_by(|one, other| one.fraction <= other.fraction), "{request:?}");
    assert!(reports.iter().all(|one| !one.stage.is_empty() && (0.0..=1.0).contains(&one.fraction)));
    reports
}

#[test]
fn the_audit_leaves_room_for_the_machine() {
    let reports = reports(HOSE, &[], &Request::Verify { proof: false, on_machine: true });
    let first = reports.iter().find(|one| one.stage == "nonlinear simulation").unwrap();
    assert!((0.4..0.6).contains(&first.fraction), "{first:?}");
    assert_eq!(reports.first().unwrap().stage, "auditing");
}
