//! The test command: the files that a build needs first, then the tests, and in parallel with them
//! the stages that need fewer processors; a table at the end shows the time of each.
//!
//! A stage that fails does not stop the later ones, so that one run shows everything that must be
//! mended.

mod comparisons;
mod python;
mod tools;

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Outcome of a stage.
enum Outcome {
    Passed,
    /// Failure, with the reason in a few words.
    Failed(String),
    /// The stage could not be run here, for a reason outside the project.
    Skipped(String),
}

impl Outcome {
    fn name(&self) -> &'static str {
        match self {
            Outcome::Passed => "passed",
            Outcome::Failed(_) => "FAILED",
            Outcome::Skipped(_) => "SKIPPED",
        }
    }

    fn remark(&self) -> &str {
        match self {
            Outcome::Passed => "",
            Outcome::Failed(remark) | Outcome::Skipped(remark) => remark,
        }
    }

    /// The first of the two outcomes that is not a pass.
    fn and(self, other: impl FnOnce() -> Outcome) -> Outcome {
        if matches!(self, Outcome::Passed) { other() } else { self }
    }
}

/// A stage by its name.
type Stage = (&'static str, fn(&Runner) -> Outcome);

/// The stages that run one after the other before the tests: the cheap and informative ones first.
const FIRST: [Stage; 5] = [
    ("formatting", formatting),
    ("tidy", tidy),
    ("clippy", clippy),
    ("documentation", documentation),
    ("build", build),
];

const TESTS: [Stage; 1] = [("tests", tests)];
/// Stages that run one after the other in parallel with the tests, which do not occupy all
/// processors; their output is shown at the end.
const ASIDE: [Stage; 5] = [
    ("doctests", doctests),
    ("peers", peers),
    ("comparisons", comparisons::run),
    ("python", python::run),
    ("wasm32", wasm32),
];

/// The stages that run only if they are named.
const NAMED: [Stage; 3] = [("clusters", python::clusters), ("mutation", mutation), ("soak", soak)];

/// The names of all stages.
pub(crate) fn stage_names() -> impl Iterator<Item = &'static str> {
    [&FIRST[..], &TESTS, &ASIDE, &NAMED].into_iter().flatten().map(|(name, _)| *name)
}

/// Runs the named stages or, if none is named, all except those that run only if they are named;
/// returns true if nothing failed.
///
/// A stage that had to be skipped fails the run if the variable `CI` is set.
pub(crate) fn run(root: &Path, wanted: &[&str]) -> bool {
    if let Some(unknown) = wanted.iter().find(|name| stage_names().all(|stage| stage != **name)) {
        let names: Vec<&str> = stage_names().collect();
        eprintln!("no stage is called `{unknown}`; the stages are {}", names.join(", "));
        return false;
    }
    let target = target(root);
    let path = target.join("aside.log");
    let log = match std::fs::create_dir_all(&target).and_then(|()| File::create(&path)) {
        Ok(log) => log,
        Err(error) => {
            eprintln!("cannot write {}: {error}", path.display());
            return false;
        }
    };
    let chosen = |stages: &[Stage], unnamed: bool| -> Vec<Stage> {
        let is_chosen = |name: &str| if wanted.is_empty() { unnamed } else { wanted.contains(&name) };
        stages.iter().filter(|(name, _)| is_chosen(name)).copied().collect()
    };
    let shown = Runner { root, target: &target, settings: settings(&target), log: None };
    let runner = Runner { log: Some(&log), ..shown };
    let mut results = shown.all(&chosen(&FIRST, true));
    std::thread::scope(|scope| {
        let aside = scope.spawn(|| runner.all(&chosen(&ASIDE, true)));
        results.extend(shown.all(&chosen(&TESTS, true)));
        results.extend(aside.join().unwrap_or_default());
    });
    println!("\n{}", std::fs::read_to_string(&path).unwrap_or_default());
    results.extend(shown.all(&chosen(&NAMED, false)));
    let is_strict = std::env::var_os("CI").is_some_and(|value| !value.is_empty());
    summary(&results, is_strict)
}

/// The folder in which cargo builds.
fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), |folder| root.join(folder))
}

/// Settings of cargo for a build from scratch, which is faster if nothing is stored for a second
/// one and each package is compiled in one piece; empty if cargo has already stored something of
/// phea.
fn settings(target: &Path) -> &'static [(&'static str, &'static str)] {
    let runner = std::fs::read_dir(target.join("debug").join("incremental"));
    let mut names = runner.into_iter().flatten().flatten().map(|entry| entry.file_name());
    let is_incremental = names.any(|name| name.to_string_lossy().starts_with("phea_"));
    if is_incremental { &[] } else { &[("CARGO_INCREMENTAL", "0"), ("CARGO_PROFILE_DEV_CODEGEN_UNITS", "1")] }
}

fn summary(results: &[(&str, Outcome, Duration)], strict: bool) -> bool {
    println!("{:<14}{:<9}{:>8}", "stage", "outcome", "seconds");
    for (name, outcome, time) in results {
        println!("{name:<14}{:<9}{:>8.1}  {}", outcome.name(), time.as_secs_f64(), outcome.remark());
    }
    let count = |wanted: &str| results.iter().filter(|(_, outcome, _)| outcome.name() == wanted).count();
    let [passed, failed, skipped] = ["passed", "FAILED", "SKIPPED"].map(count);
    if strict && skipped > 0 {
        println!("`CI` is set: what is skipped counts as failed");
    }
    println!("{passed} passed, {failed} failed, {skipped} skipped");
    failed == 0 && !(strict && skipped > 0)
}

/// Runs the commands of a stage in the root; they print to the terminal, or to a file.
#[derive(Clone, Copy)]
struct Runner<'a> {
    root: &'a Path,
    target: &'a Path,
    settings: &'a [(&'a str, &'a str)],
    log: Option<&'a File>,
}

impl Runner<'_> {
    /// The outcomes of these stages, each with its duration.
    fn all(&self, stages: &[Stage]) -> Vec<(&'static str, Outcome, Duration)> {
        let mut results = Vec::new();
        for (name, stage) in stages {
            self.print(&format!("\n==== {name}"));
            let start = Instant::now();
            let outcome = stage(self);
            self.print(&format!("==== {name}: {} {}", outcome.name(), outcome.remark()));
            results.push((*name, outcome, start.elapsed()));
        }
        results
    }

    fn print(&self, line: &str) {
        match self.log {
            None => println!("{line}"),
            // A line that cannot be written is only missing in the log.
            Some(mut log) => drop(writeln!(log, "{line}")),
        }
    }

    /// Runs one command in the root.
    fn execute(&self, words: &[&str], variables: &[(&str, &str)]) -> Outcome {
        let line = words.join(" ");
        self.print(&format!("$ {line}"));
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).envs(self.settings.iter().chain(variables).copied()).current_dir(self.root);
        if let Some((out, errors)) = self.log.and_then(|log| log.try_clone().ok().zip(log.try_clone().ok())) {
            command.stdin(Stdio::null()).stdout(out).stderr(errors);
        }
        match command.status() {
            Ok(status) if status.success() => Outcome::Passed,
            Ok(status) => Outcome::Failed(format!("`{line}`: {status}")),
            Err(error) => Outcome::Failed(format!("`{line}`: {error}")),
        }
    }

    /// Runs cargo with these words.
    fn cargo(&self, line: &str) -> Outcome {
        self.cargo_with(line, &[])
    }

    fn cargo_with(&self, line: &str, variables: &[(&str, &str)]) -> Outcome {
        self.execute(&format!("cargo {line}").split(' ').collect::<Vec<_>>(), variables)
    }

    /// Runs a command of cargo for all packages, except the one that links CVODE if CVODE is
    /// missing.
    fn workspace(&self, command: &str, arguments: &str) -> Outcome {
        let peers = if tools::sundials().is_ok() { "" } else { " --exclude sundials" };
        self.cargo(&format!("{command} --workspace{peers} {arguments}"))
    }
}

fn formatting(runner: &Runner) -> Outcome {
    match tools::component("rustfmt", "fmt") {
        Ok(()) => runner.cargo("fmt --all --check"),
        Err(missing) => Outcome::Failed(missing),
    }
}

fn tidy(runner: &Runner) -> Outcome {
    if crate::tidy::is_tidy(runner.root) { Outcome::Passed } else { Outcome::Failed("see above".to_string()) }
}

/// Lints all targets with clippy.
fn clippy(runner: &Runner) -> Outcome {
    match tools::component("clippy", "clippy") {
        Ok(()) => runner.workspace("clippy", "--all-targets -- -D warnings"),
        Err(missing) => Outcome::Failed(missing),
    }
}

fn documentation(runner: &Runner) -> Outcome {
    runner.cargo_with("doc --workspace --exclude sundials --no-deps", &[("RUSTDOCFLAGS", "-D warnings")])
}

/// Builds the tests, and the programs that the comparisons call.
fn build(runner: &Runner) -> Outcome {
    let programs = "--bin phea --example reference_systems --example schema_cases";
    runner.workspace("test", "--tests --no-run").and(|| runner.workspace("build", programs))
}

fn tests(runner: &Runner) -> Outcome {
    runner.workspace("test", "--tests --no-fail-fast")
}

fn doctests(runner: &Runner) -> Outcome {
    runner.workspace("test", "--doc --no-fail-fast")
}

/// Builds for the browser the crates that only compute.
fn wasm32(runner: &Runner) -> Outcome {
    const TARGET: &str = "wasm32-unknown-unknown";
    match tools::target(TARGET) {
        Ok(()) => {
            runner.cargo(&format!("check --target {TARGET} -p phea-machine -p phea-qft -p phea-quantity"))
        }
        Err(missing) => Outcome::Skipped(missing),
    }
}

/// Solves fifty rigs of each family with both phea and CVODE.
fn peers(runner: &Runner) -> Outcome {
    match tools::sundials() {
        Ok(()) => runner.cargo("test --workspace --test random_rigs -- 50"),
        Err(missing) => Outcome::Skipped(missing),
    }
}

/// Reads twenty times as many mutated projects as the tests do; part of [`soak`] too.
fn mutation(runner: &Runner) -> Outcome {
    runner.cargo("test --workspace --test all -- --ignored mutation::")
}

/// Tests, before a release, that take too long for every commit.
fn soak(runner: &Runner) -> Outcome {
    // A hundred kills of campaigns on one, two and four threads, and two gigabytes of rows: the
    // losses and the speed are printed.
    let killed = "test --release -p phea-cli --test all -- campaign_killed:: streamed_rows:: \
                  --include-ignored --nocapture --test-threads=1";
    // Four hundred valves, lines and frictions, each identified from its own recordings: the
    // coverage of the truth by the intervals; three hundred operating regions; and the alternatives
    // of the book under each of its loads, and over the length of its hose.
    let identified = "test --release -p phea-workbench --test all -- --ignored --nocapture \
                      --test-threads=1 coverage::soak alternatives::soak alternatives_front::soak";
    // Certificates of random problems against eleven million plants, and designs from other seeds.
    let robust = "test --release -p phea-qft --test all -- --ignored";
    // A thousand rigs of each family, solved with both phea and CVODE.
    let rigs = "test --release --workspace --test random_rigs -- 1000 --test-threads=1";
    let outcomes = [
        mutation(runner),
        runner.cargo_with(killed, &[("PHEA_KILLS", "100")]),
        runner.cargo(identified),
        runner.cargo(robust),
        runner.cargo(rigs),
        comparisons::soak(runner),
    ];
    let failed: Vec<&str> =
        outcomes.iter().map(Outcome::remark).filter(|remark| !remark.is_empty()).collect();
    if failed.is_empty() { Outcome::Passed } else { Outcome::Failed(failed.join("; ")) }
}
