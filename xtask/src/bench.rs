//! Measures, but does not assert, the run times that the documents promise: `report` and its
//! siblings on the example rigs, and with `build` the release build from scratch.
//!
//! A plain stopwatch around the command itself: the user's time is the sum of its start, reading,
//! arithmetic, drawing and writing, which a statistics harness inside one process would not see.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Number of runs of each command; the fastest and the median are shown.
const RUNS: usize = 15;

/// Commands; the files of `--out` go to a scratch folder.
const COMMANDS: [&str; 7] = [
    "check ybitu/hose.toml",
    "size ybitu/hose.toml",
    "linearize ybitu/hose.toml",
    "verify ybitu/hose.toml",
    "report ybitu/hose.toml",
    "report ybitu/hose.toml --out figures",
    "report ybitu/pipe.toml",
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
    let mut build = Command::new("cargo");
    build.args(["build", "--release", "-p", "phea-cli", "--target-dir"]).arg(&target).current_dir(root);
    if !build.status().is_ok_and(|status| status.success()) {
        return false;
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let kind = if from_scratch { "from scratch" } else { "up to date or incremental" };
    println!("\n{:>8.1} s  release build, {kind}, {cores} cores", start.elapsed().as_secs_f64());
    println!("\n{:>10} {:>10}  command ({RUNS} runs)", "fastest", "median");
    let scratch = target.join("written");
    COMMANDS.iter().all(|line| {
        let once = |_| milliseconds(&root.join("examples"), &target.join("release/phea"), &scratch, line);
        let times: Option<Vec<f64>> = (0..RUNS).map(once).collect();
        let Some(mut times) = times else {
            eprintln!("`phea {line}` failed");
            return false;
        };
        times.sort_by(f64::total_cmp);
        println!("{:>7.1} ms {:>7.1} ms  phea {line}", times[0], times[RUNS / 2]);
        true
    })
}

/// Time of one run in the scratch folder, in milliseconds. Status 1 counts as an answer too: no.
fn milliseconds(examples: &Path, binary: &Path, scratch: &Path, line: &str) -> Option<f64> {
    std::fs::create_dir_all(scratch).ok()?;
    let mut command = Command::new(binary);
    command.current_dir(scratch).stdout(Stdio::null()).stderr(Stdio::null());
    for word in line.split(' ') {
        let is_project = word.ends_with(".toml");
        command.arg(if is_project { examples.join(word) } else { word.into() });
    }
    let start = Instant::now();
    let status = command.status().ok()?;
    matches!(status.code(), Some(0 | 1)).then(|| start.elapsed().as_secs_f64() * 1e3)
}
