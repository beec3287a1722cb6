//! Benchmark of designs for the rig of the examples on one core: `cargo bench -p phea-workbench
//! --bench design`.
//!
//! The rig has hoses, hoses with sampling at 1 kHz and 0.5 ms of delay, and steel pipes; the time
//! is that from the project file to the answer, audits included. Every design must be met and,
//! repeated with an equal seed, give identical bytes; otherwise the bench fails. Times are printed
//! and never asserted.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench talks to the person who started it")]
#![allow(missing_docs, reason = "a program of its own")]

use std::process::ExitCode;
use std::time::Instant;

use phea_workbench::answer::Answer;
use phea_workbench::command::{self, Request};
use phea_workbench::project;
use phea_workbench::source::Memory;
use serde_json::Value;

const HOSE: &str = include_str!("../../../examples/ybitu/hose.toml");
const PIPE: &str = include_str!("../../../examples/ybitu/pipe.toml");

/// A project with its settings.
struct Task {
    name: &'static str,
    project: &'static str,
    settings: &'static [&'static str],
}

const TASKS: [Task; 3] = [
    Task { name: "hoses", project: HOSE, settings: &[] },
    Task {
        name: "hoses, sampled",
        project: HOSE,
        settings: &["controller.sample_time=1 ms", "controller.delay=0.5 ms"],
    },
    Task { name: "pipes", project: PIPE, settings: &[] },
];

fn main() -> ExitCode {
    let mut all_well = true;
    for task in &TASKS {
        match design(task) {
            Ok(()) => {}
            Err(problem) => {
                eprintln!("{}: {problem}", task.name);
                all_well = false;
            }
        }
    }
    if all_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Designs twice, and prints the shorter time with the result.
fn design(task: &Task) -> Result<(), String> {
    let (first_seconds, first) = timed(task)?;
    let (second_seconds, second) = timed(task)?;
    let found: Value = serde_json::from_str(&first.json).map_err(|error| error.to_string())?;
    let at = |path: &str| found.pointer(path).cloned().unwrap_or_default();
    println!(
        "{:>8.2} s  {}: {}, order {} and {}, {} rounds, {} dB",
        first_seconds.min(second_seconds),
        task.name,
        at("/status"),
        at("/figures/order"),
        at("/figures/prefilter_order"),
        at("/rounds").as_array().map_or(0, Vec::len),
        at("/objective/value_db"),
    );
    if at("/status") != "met" {
        return Err("it is not met".to_string());
    }
    let orders = ["/figures/order", "/figures/prefilter_order"].map(|path| at(path).as_f64());
    if !matches!(orders, [Some(order), Some(prefilter)] if order <= 4.0 && prefilter <= 3.0) {
        return Err("it takes more poles than 4 and 3".to_string());
    }
    if first.json != second.json || first.text() != second.text() {
        return Err("the same seed gave two designs".to_string());
    }
    Ok(())
}

fn timed(task: &Task) -> Result<(f64, Answer), String> {
    let source = Memory::default().with("rig.toml", task.project);
    let settings: Vec<String> = task.settings.iter().map(ToString::to_string).collect();
    let begun = Instant::now();
    let loaded =
        project::read(&source, "rig.toml", &settings, &[]).map_err(|problems| problems.to_string())?;
    let request = Request::Design { seed: None, stages: false, repair: false };
    let answer = command::answer(&source, &loaded, &[], &request).map_err(|error| error.to_string())?;
    Ok((begun.elapsed().as_secs_f64(), answer))
}
