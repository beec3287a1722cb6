//! The test command: the files that a build needs first, then the tests, and in parallel with them
//! the stages that need fewer processors; a table at the end shows the time of each.
//!
//! A stage that fails does not stop the later ones, so that one run shows everything that must be
//! mended.

mod comparisons;
mod dist;
mod python;
mod tools;

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Outcome of a stage or of one of its commands.
type Outcome = Result<(), Problem>;

/// Reason why a stage did not pass, in a few words.
enum Problem {
    Failed(String),
    /// The stage could not be run here, for a reason outside the project.
    Skipped(String),
}

/// The word for an outcome, and its reason.
fn described(outcome: &Outcome) -> (&'static str, &str) {
    match outcome {
        Ok(()) => ("passed", ""),
        Err(Problem::Failed(reason)) => ("FAILED", reason),
        Err(Problem::Skipped(reason)) => ("SKIPPED", reason),
    }
}

/// Time at which a stage runs.
#[derive(Clone, Copy, PartialEq)]
enum When {
    /// One after the other before the tests, the cheap and informative ones first.
    First,
    Tests,
    /// One after the other in parallel with the tests, which do not occupy all processors; the
    /// output is shown at the end.
    Aside,
    /// Last, only if the stage is named.
    Named,
}

type Stage = (When, &'static str, fn(&Runner) -> Outcome);

const STAGES: [Stage; 16] = [
    (When::First, "formatting", formatting),
    (When::First, "tidy", tidy),
    (When::First, "clippy", clippy),
    (When::First, "documentation", documentation),
    (When::First, "build", build),
    (When::Tests, "tests", tests),
    (When::Aside, "doctests", doctests),
    (When::Aside, "peers", peers),
    (When::Aside, "comparisons", comparisons::run),
    (When::Aside, "python", python::run),
    (When::Aside, "wasm32", wasm32),
    (When::Named, "clusters", python::clusters),
    (When::Named, "dist", dist::run),
    (When::Named, "dist-again", dist::again),
    (When::Named, "mutation", mutation),
    (When::Named, "soak", soak),
];

/// The names of all stages.
pub(crate) fn stage_names() -> impl Iterator<Item = &'static str> {
    STAGES.iter().map(|(_, name, _)| *name)
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
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), |folder| root.join(folder));
    let path = target.join("aside.log");
    let log = match std::fs::create_dir_all(&target).and_then(|()| File::create(&path)) {
        Ok(log) => log,
        Err(error) => {
            eprintln!("cannot write {}: {error}", path.display());
            return false;
        }
    };
    let shown = Runner { root, target: &target, settings: settings(&target), log: None };
    let runner = Runner { log: Some(&log), ..shown };
    let mut results = shown.all(When::First, wanted);
    std::thread::scope(|scope| {
        let aside = scope.spawn(|| runner.all(When::Aside, wanted));
        results.extend(shown.all(When::Tests, wanted));
        results.extend(aside.join().unwrap_or_default());
    });
    println!("\n{}", std::fs::read_to_string(&path).unwrap_or_default());
    results.extend(shown.all(When::Named, wanted));
    let is_strict = std::env::var_os("CI").is_some_and(|value| !value.is_empty());
    summary(&results, is_strict)
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
        let (word, reason) = described(outcome);
        println!("{name:<14}{word:<9}{:>8.1}  {reason}", time.as_secs_f64());
    }
    let count =
        |wanted: &str| results.iter().filter(|(_, outcome, _)| described(outcome).0 == wanted).count();
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
    /// The outcomes of the stages of this time that are named or need no name, each with its
    /// duration.
    fn all(&self, time: When, wanted: &[&str]) -> Vec<(&'static str, Outcome, Duration)> {
        let is_wanted = |name| wanted.contains(name) || (wanted.is_empty() && time != When::Named);
        let mut results = Vec::new();
        for (_, name, stage) in STAGES.iter().filter(|(when, name, _)| *when == time && is_wanted(name)) {
            self.print(&format!("\n==== {name}"));
            let start = Instant::now();
            let outcome = stage(self);
            let (word, reason) = described(&outcome);
            self.print(&format!("==== {name}: {word} {reason}"));
            results.push((*name, outcome, start.elapsed()));
        }
        results
    }

    /// Path of something in the folder in which cargo builds.
    fn path(&self, name: &str) -> String {
        self.target.join(name).to_string_lossy().into_owned()
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
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(Problem::Failed(format!("`{line}`: {status}"))),
            Err(error) => Err(Problem::Failed(format!("`{line}`: {error}"))),
        }
    }

    /// Runs the lines, whose words have a space between them, until one fails.
    fn steps(&self, lines: &[String], variables: &[(&str, &str)]) -> Outcome {
        lines.iter().try_for_each(|line| self.execute(&line.split(' ').collect::<Vec<_>>(), variables))
    }

    /// Runs cargo with these words.
    fn cargo(&self, line: &str) -> Outcome {
        self.cargo_with(line, &[])
    }

    fn cargo_with(&self, line: &str, variables: &[(&str, &str)]) -> Outcome {
        self.steps(&[format!("cargo {line}")], variables)
    }

    /// Runs a command of cargo for all packages, except the one that links CVODE if CVODE is
    /// missing.
    fn workspace(&self, command: &str, arguments: &str) -> Outcome {
        let peers = if tools::sundials().is_ok() { "" } else { " --exclude sundials" };
        self.cargo(&format!("{command} --workspace{peers} {arguments}"))
    }
}

fn formatting(runner: &Runner) -> Outcome {
    tools::component("rustfmt", "fmt")?;
    runner.cargo("fmt --all --check")
}

fn tidy(runner: &Runner) -> Outcome {
    let is_tidy = crate::tidy::is_tidy(runner.root);
    is_tidy.then_some(()).ok_or_else(|| Problem::Failed("see above".to_string()))
}

/// Lints all targets with clippy.
fn clippy(runner: &Runner) -> Outcome {
    tools::component("clippy", "clippy")?;
    runner.workspace("clippy", "--all-targets -- -D warnings")
}

fn documentation(runner: &Runner) -> Outcome {
    runner.cargo_with("doc --workspace --exclude sundials --no-deps", &[("RUSTDOCFLAGS", "-D warnings")])
}

/// Builds the tests, and the programs that the comparisons call.
fn build(runner: &Runner) -> Outcome {
    let programs = "--bin phea --example reference_systems --example schema_cases";
    runner.workspace("test", "--tests --no-run")?;
    runner.workspace("build", programs)
}

fn tests(runner: &Runner) -> Outcome {
    runner.workspace("test", "--tests --no-fail-fast")
}

fn doctests(runner: &Runner) -> Outcome {
    runner.workspace("test", "--doc --no-fail-fast")
}

/// Builds for the browser the crates that only compute.
fn wasm32(runner: &Runner) -> Outcome {
    tools::target("wasm32-unknown-unknown")?;
    runner.cargo("check --target wasm32-unknown-unknown -p phea-machine -p phea-qft -p phea-quantity")
}

/// Solves fifty rigs of each family with both phea and CVODE.
fn peers(runner: &Runner) -> Outcome {
    tools::sundials()?;
    runner.cargo("test --workspace --test random_rigs -- 50")
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
    // of the book under each of its loads, and over the length of its hose. Three hundred exported
    // controllers by every compiler.
    let identified = "test --release -p phea-workbench --test all -- --ignored --nocapture \
                      --test-threads=1 coverage::soak alternatives::soak alternatives_front::soak \
                      export_c::soak export_st::soak friction_siblings::";
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
    let reasons: Vec<&str> = outcomes.iter().map(|outcome| described(outcome).1).collect();
    let failed = reasons.into_iter().filter(|reason| !reason.is_empty()).collect::<Vec<_>>().join("; ");
    if failed.is_empty() { Ok(()) } else { Err(Problem::Failed(failed)) }
}
