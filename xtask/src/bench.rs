//! Measures, but does not assert, the run times that the documents promise: `report` and its
//! siblings on the example rigs, and with `build` the release build from scratch.
//!
//! A plain stopwatch around the command itself: the user's time is the sum of its start, reading,
//! arithmetic, drawing and writing, which a statistics harness inside one process would not see.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Number of runs of each command; the fastest and the median are shown.
const RUNS: usize = 15;

const COMMANDS: [&[&str]; 7] = [
    &["check", "examples/ybitu/hose.toml"],
    &["size", "examples/ybitu/hose.toml"],
    &["linearize", "examples/ybitu/hose.toml"],
    &["verify", "examples/ybitu/hose.toml"],
    &["report", "examples/ybitu/hose.toml"],
    &["report", "examples/ybitu/hose.toml", "--out"],
    &["report", "examples/ybitu/pipe.toml"],
];

/// Runs the benches in a separate target folder; `from_scratch` empties it first and times the
/// build. Returns true if everything succeeded.
pub(crate) fn run(root: &Path, from_scratch: bool) -> bool {
    let target = root.join("target").join("bench");
    if from_scratch && target.exists() && std::fs::remove_dir_all(&target).is_err() {
        eprintln!("cannot empty {}", target.display());
        return false;
    }
    let start = Instant::now();
    let built = Command::new("cargo")
        .args(["build", "--release", "-p", "phea-cli", "--target-dir"])
        .arg(&target)
        .current_dir(root)
        .status();
    if !built.is_ok_and(|status| status.success()) {
        return false;
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let kind = if from_scratch { "from scratch" } else { "up to date or incremental" };
    println!("\n{:>8.1} s  release build, {kind}, {cores} cores", start.elapsed().as_secs_f64());
    println!("\n{:>10} {:>10}  command ({RUNS} runs)", "fastest", "median");
    let binary = target.join("release").join("phea");
    let scratch = target.join("written");
    COMMANDS.iter().all(|arguments| bench(root, &binary, &scratch, arguments))
}

/// Times one command; its files go to a scratch folder.
fn bench(root: &Path, binary: &Path, scratch: &Path, arguments: &[&str]) -> bool {
    let name = arguments.join(" ");
    let mut times = Vec::new();
    for _ in 0..RUNS {
        match once(root, binary, scratch, arguments) {
            Some(time) => times.push(time),
            None => {
                eprintln!("`phea {name}` failed");
                return false;
            }
        }
    }
    times.sort();
    let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
    println!("{:>7.1} ms {:>7.1} ms  phea {name}", milliseconds(times[0]), milliseconds(times[RUNS / 2]));
    true
}

/// Runs the command once. Status 1 counts as an answer too: no.
fn once(root: &Path, binary: &Path, scratch: &Path, arguments: &[&str]) -> Option<Duration> {
    std::fs::create_dir_all(scratch).ok()?;
    let arguments: Vec<std::path::PathBuf> = arguments
        .iter()
        .map(|argument| if argument.ends_with(".toml") { root.join(argument) } else { argument.into() })
        .collect();
    let mut command = Command::new(binary);
    command.args(&arguments).current_dir(scratch).stdout(Stdio::null()).stderr(Stdio::null());
    if arguments.last().is_some_and(|last| last.as_os_str() == "--out") {
        command.arg("figures");
    }
    let start = Instant::now();
    let status = command.status().ok()?;
    matches!(status.code(), Some(0 | 1)).then(|| start.elapsed())
}
