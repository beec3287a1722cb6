//! The test command: a build, then the tests, and what needs less of the processors in parallel
//! with them; the time that each was waited for in a table at the end.
//!
//! A stage that fails does not stop the later ones, so that one run shows everything that has to be
//! mended.

mod comparisons;
mod console;
mod linted;
mod tools;

use comparisons::Begun;
pub(crate) use comparisons::recomputed_by;
pub(crate) use linted::in_place_of_the_compiler;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use console::Console;

/// How a stage ended.
pub(crate) enum Outcome {
    /// All is well.
    Passed,
    /// Something is wrong: what, in a few words.
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
}

/// What the names of the tests that run the stories begin with, in `apps/cli/tests/stories.rs`.
const STORIES: &str = "stories::";

/// The test that the repository is tidy, in `xtask/src/tidy.rs`.
const REPOSITORY: &str = "tidy::tests::the_repository_is_tidy";

/// The repository, and the variables with which cargo builds it in every stage.
#[derive(Clone)]
pub(crate) struct Built {
    root: PathBuf,
    variables: Vec<(&'static str, String)>,
    /// Whether nothing is kept for a second build; keeping it makes this one slower.
    once: bool,
    console: Console,
}

impl Built {
    /// Runs one command of cargo in the root.
    fn cargo(&self, arguments: &[&str], variables: &[(&str, &str)]) -> Outcome {
        self.console.execute(&self.root, "cargo", arguments, variables)
    }

    /// The variable by which cargo keeps nothing for a second build, where nothing is kept.
    fn not_kept(&self) -> Option<(&'static str, &'static str)> {
        self.once.then_some(("CARGO_INCREMENTAL", "0"))
    }
}

type Stage = fn(&Built) -> Outcome;

/// Cheap and informative stages first; those that need a network last.
const STAGES: &[(&str, Stage)] = &[
    ("formatting", formatting),
    (BUILD, build),
    ("tests", tests),
    ("doctests", doctests),
    ("stories", stories),
    (TIDY, tidy),
    (WASM32, wasm32),
    ("peers", peers),
    (COMPARISONS, comparisons::run),
    (MUTATION, mutation),
    (SOAK, soak),
];

/// The stages that run one after the other, in parallel with the tests: neither line keeps two
/// processors busy all the time.
const ASIDE: [&str; 3] = ["doctests", "stories", "peers"];

/// The stage that runs from the beginning where the build leaves a processor idle, in a folder of
/// its own.
const WASM32: &str = "wasm32";

/// The stage that runs from the beginning in parallel with the others; its result is printed in its
/// own place.
const TIDY: &str = "tidy";

/// The stage whose scripts run in parallel with the others.
const COMPARISONS: &str = "comparisons";

/// The stage that builds the programs that the comparisons call.
const BUILD: &str = "build";

/// The stages that run only where they are named.
const MUTATION: &str = "mutation";
const SOAK: &str = "soak";

/// The names of all stages.
pub(crate) const STAGE_NAMES: [&str; STAGES.len()] = {
    let mut names = [""; STAGES.len()];
    let mut index = 0;
    while index < STAGES.len() {
        names[index] = STAGES[index].0;
        index += 1;
    }
    names
};

/// Runs the named stages or, if none is named, all except those that run only where they are named;
/// returns whether nothing failed.
///
/// Where the variable `CI` is set, a stage that had to be skipped fails the run.
pub(crate) fn run(root: &Path, wanted: &[&str]) -> bool {
    if let Some(unknown) = wanted.iter().find(|name| !STAGE_NAMES.contains(name)) {
        eprintln!("no stage is called `{unknown}`; the stages are {}", STAGE_NAMES.join(", "));
        return false;
    }
    let chosen = |name: &str| match wanted {
        [] => ![MUTATION, SOAK].contains(&name),
        _ => wanted.contains(&name),
    };
    let variables = match linted::variables(&target(root)) {
        Ok(variables) => variables,
        Err(missing) => {
            eprintln!("{missing}");
            return false;
        }
    };
    let once = is_strict() || is_fresh(&target(root));
    let built = Built { root: root.to_path_buf(), variables, once, console: Console::Shown };
    // A build often waits for one crate: the second processor tidies and compares meanwhile.
    let mut tidied = chosen(TIDY).then(|| tidying(root));
    let mut begun = chosen(COMPARISONS).then(|| comparisons::begin(root));
    let checked = chosen(WASM32).then(|| aside_of(&built, vec![wasm32]));
    let mut aside = None;
    let mut results = Vec::new();
    for (name, stage) in STAGES.iter().filter(|(name, _)| chosen(name)) {
        println!("\n==== {name}");
        let start = Instant::now();
        let outcome = match *name {
            TIDY => tidied.take().map_or_else(|| stage(&built), tidied_by),
            COMPARISONS => {
                begun.take().map_or_else(|| stage(&built), |begun| comparisons::end(&built, begun))
            }
            WASM32 => ended_aside(checked.as_ref()).unwrap_or_else(|| stage(&built)),
            _ if ASIDE.contains(name) => ended_aside(aside.as_ref()).unwrap_or_else(|| stage(&built)),
            _ => stage(&built),
        };
        if let (BUILD, Outcome::Passed) = (*name, &outcome) {
            begun.iter_mut().for_each(Begun::ask_phea);
            let stages = STAGES.iter().filter(|(name, _)| ASIDE.contains(name) && chosen(name));
            aside = Some(aside_of(&built, stages.map(|(_, stage)| *stage).collect()));
        }
        println!("==== {name}: {} {}", outcome.name(), outcome.remark());
        results.push((*name, outcome, start.elapsed()));
    }
    summary(&results, is_strict())
}

/// Runs these stages in parallel with what follows: their outcomes, each with what it printed.
fn aside_of(built: &Built, stages: Vec<Stage>) -> Receiver<(Outcome, String)> {
    let (ended, results) = channel();
    let built = Built { console: Console::kept(), ..built.clone() };
    std::thread::spawn(move || {
        for stage in stages {
            let outcome = stage(&built);
            // If nobody waits any more, nothing is lost.
            ended.send((outcome, built.console.taken())).ok();
        }
    });
    results
}

/// The outcome of the next stage that runs aside, what it printed shown; `None` where none does.
fn ended_aside(aside: Option<&Receiver<(Outcome, String)>>) -> Option<Outcome> {
    let (outcome, told) = aside?.recv().ok()?;
    print!("{told}");
    Some(outcome)
}

/// Where cargo builds.
fn target(root: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), |folder| root.join(folder))
}

/// Whether nobody works here: cargo has kept nothing of phea's packages for a second build.
fn is_fresh(target: &Path) -> bool {
    let kept = std::fs::read_dir(target.join("debug").join("incremental"));
    !kept.into_iter().flatten().flatten().any(|one| one.file_name().to_string_lossy().starts_with("phea_"))
}

fn is_strict() -> bool {
    std::env::var_os("CI").is_some_and(|value| !value.is_empty())
}

fn summary(results: &[(&str, Outcome, Duration)], strict: bool) -> bool {
    println!("\n{:<14}{:<9}{:>8}", "stage", "outcome", "seconds");
    for (name, outcome, time) in results {
        println!("{name:<14}{:<9}{:>8.1}  {}", outcome.name(), time.as_secs_f64(), outcome.remark());
    }
    let total: Duration = results.iter().map(|(_, _, time)| *time).sum();
    println!("{:<14}{:<9}{:>8.1}\n", "all", "", total.as_secs_f64());
    let count =
        |wanted: fn(&Outcome) -> bool| results.iter().filter(|(_, outcome, _)| wanted(outcome)).count();
    let failed = count(|outcome| matches!(outcome, Outcome::Failed(_)));
    let skipped = count(|outcome| matches!(outcome, Outcome::Skipped(_)));
    let passed = count(|outcome| matches!(outcome, Outcome::Passed));
    if strict && skipped > 0 {
        println!("`CI` is set: what is skipped counts as failed");
    }
    println!("{passed} passed, {failed} failed, {skipped} skipped");
    failed == 0 && !(strict && skipped > 0)
}

/// Builds all targets, with the lints of clippy and the documentation, and then the examples that
/// the comparisons ask, which `cargo test` builds as tests.
fn build(built: &Built) -> Outcome {
    let asked = ["--example", "reference_systems", "--example", "schema_cases"];
    match for_all(built, &["test", "--workspace", "--no-run", "--tests", "--benches", "--examples"], &[]) {
        Outcome::Passed => for_all(built, &[&["build", "--workspace"][..], &asked].concat(), &[]),
        other => other,
    }
}

/// The arguments that leave out the package that links CVODE.
const WITHOUT_PEERS: [&str; 2] = ["--exclude", "sundials"];

/// The rigs that phea and CVODE solve both: a test of that package.
const RIGS: &str = "random_rigs";

/// cargo's setting by which a package is compiled in one piece: what is inlined into several pieces
/// is compiled in each, and cargo compiles several packages at a time.
const IN_ONE_UNIT: [&str; 2] = ["--config", "profile.dev.codegen-units=1"];

/// One command of cargo for all packages; without the one that links CVODE where CVODE is missing.
fn for_all(built: &Built, arguments: &[&str], of_tests: &[&str]) -> Outcome {
    let peers: &[&str] = if tools::sundials().is_ok() { &[] } else { &WITHOUT_PEERS };
    let variables = built.variables.iter().map(|(name, value)| (*name, value.as_str()));
    let variables: Vec<(&str, &str)> = variables.chain(built.not_kept()).collect();
    let units: &[&str] = if built.once { &IN_ONE_UNIT } else { &[] };
    let (command, arguments) = arguments.split_at(1);
    built.cargo(&[command, units, arguments, peers, of_tests].concat(), &variables)
}

fn formatting(built: &Built) -> Outcome {
    match tools::component("rustfmt", "fmt") {
        Ok(()) => built.cargo(&["fmt", "--all", "--check"], &[]),
        Err(missing) => Outcome::Failed(missing),
    }
}

/// Unit and integration tests but for the stories and for the check of the repository, which are
/// stages of their own.
fn tests(built: &Built) -> Outcome {
    let skipped = ["--", "--skip", STORIES, "--skip", REPOSITORY];
    for_all(built, &["test", "--workspace", "--tests", "--no-fail-fast"], &skipped)
}

/// The example stories, by the whole workspace, so that what was built for the other tests serves
/// again.
fn stories(built: &Built) -> Outcome {
    for_all(built, &["test", "--workspace", "--test", "all"], &["--", STORIES])
}

/// Twenty times as many mutated projects as the tests read: of [`soak`] too.
fn mutation(built: &Built) -> Outcome {
    for_all(built, &["test", "--workspace", "--test", "all"], &["--", "--ignored", "mutation::"])
}

/// Certificates of random problems against eleven million plants, and designs from other seeds.
const LONG_ROBUST_TESTS: [&str; 8] =
    ["test", "--release", "-p", "phea-qft", "--test", "all", "--", "--ignored"];

/// Four hundred valves, lines and frictions, identified from recordings of one each: how often the
/// intervals cover the truth; three hundred operating regions; and the alternatives of the book
/// under each of its loads, and over the length of its hose.
const IDENTIFIED_VALVES: [&str; 13] = [
    "test",
    "--release",
    "-p",
    "phea-workbench",
    "--test",
    "all",
    "--",
    "--ignored",
    "--nocapture",
    "--test-threads=1",
    "coverage::soak",
    "alternatives::soak",
    "alternatives_front::soak",
];

/// A thousand rigs of each family that phea and CVODE solve both.
const MANY_RIGS: [&str; 8] =
    ["test", "--release", "--workspace", "--test", RIGS, "--", "1000", "--test-threads=1"];

/// A hundred kills of campaigns on one, two and four threads, and two gigabytes of rows, in the
/// release profile: what was lost, and how fast it was, is printed.
fn killed_campaigns(built: &Built) -> Outcome {
    let tests =
        ["campaign_killed::", "streamed_rows::", "--include-ignored", "--nocapture", "--test-threads=1"];
    let arguments = [&["test", "--release", "-p", "phea-cli", "--test", "all", "--"][..], &tests].concat();
    built.cargo(&arguments, &[("PHEA_KILLS", "100")])
}

/// What takes too long for every commit, before a release: all of it, so that one run shows
/// everything that has to be mended.
fn soak(built: &Built) -> Outcome {
    let cargo = |arguments: &[&str]| built.cargo(arguments, &[]);
    let ended = [
        mutation(built),
        killed_campaigns(built),
        cargo(&IDENTIFIED_VALVES),
        cargo(&LONG_ROBUST_TESTS),
        cargo(&MANY_RIGS),
        comparisons::soak(&built.root),
    ];
    let failed: Vec<&str> =
        ended.iter().filter(|one| !matches!(one, Outcome::Passed)).map(Outcome::remark).collect();
    if failed.is_empty() { Outcome::Passed } else { Outcome::Failed(failed.join("; ")) }
}

fn doctests(built: &Built) -> Outcome {
    for_all(built, &["test", "--workspace", "--doc", "--no-fail-fast"], &[])
}

fn tidy(built: &Built) -> Outcome {
    tidied_by(tidying(&built.root))
}

/// The check of the repository, in parallel with what follows.
fn tidying(root: &Path) -> JoinHandle<(bool, String)> {
    let root = root.to_path_buf();
    std::thread::spawn(move || match tidied_politely(&root) {
        Ok(output) => {
            let told = [output.stdout, output.stderr].concat();
            (output.status.success(), String::from_utf8_lossy(&told).into_owned())
        }
        Err(error) => (false, format!("cannot check the repository: {error}\n")),
    })
}

/// Runs this program once more, in a process that leaves the processors to the build.
fn tidied_politely(root: &Path) -> std::io::Result<Output> {
    let own = std::env::current_exe()?;
    let line: Vec<&OsStr> = tools::politely().iter().map(OsStr::new).chain([own.as_os_str()]).collect();
    let (program, others) = line.split_first().ok_or(std::io::ErrorKind::NotFound)?;
    Command::new(program).args(others).arg("tidy").arg(root).stdin(Stdio::null()).output()
}

/// Its outcome, once it has one.
fn tidied_by(tidying: JoinHandle<(bool, String)>) -> Outcome {
    let Ok((is_tidy, told)) = tidying.join() else {
        return Outcome::Failed("the check ended early".to_string());
    };
    print!("{told}");
    if is_tidy { Outcome::Passed } else { Outcome::Failed("see above".to_string()) }
}

/// The crates that only compute build for the browser.
fn wasm32(built: &Built) -> Outcome {
    const TARGET: &str = "wasm32-unknown-unknown";
    if let Err(missing) = tools::target(TARGET) {
        built.console.print(&format!(
            "\n**** SKIPPED: {missing}\n**** nothing is known about {TARGET} from this run\n"
        ));
        return Outcome::Skipped(missing);
    }
    let packages = ["-p", "phea-machine", "-p", "phea-qft", "-p", "phea-quantity"];
    let cargo = [tools::politely(), &["cargo", "check", "--target", TARGET], &packages].concat();
    // the build keeps others out of its folder
    let folder = target(&built.root).join("wasm32").to_string_lossy().into_owned();
    let variables: Vec<_> = built.not_kept().into_iter().chain([("CARGO_TARGET_DIR", &*folder)]).collect();
    match cargo.split_first() {
        Some((program, arguments)) => built.console.execute(&built.root, program, arguments, &variables),
        None => Outcome::Passed,
    }
}

/// Rigs that phea and CVODE solve both. The other tests of the package that links CVODE run with
/// those of all packages.
fn peers(built: &Built) -> Outcome {
    if let Err(missing) = tools::sundials() {
        built
            .console
            .print(&format!("\n**** SKIPPED: {missing}\n**** nothing was compared with CVODE in this run\n"));
        return Outcome::Skipped(missing);
    }
    for_all(built, &["test", "--workspace", "--test", RIGS], &["--", "50"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_skipped_fails_only_the_strict_run() {
        let ran =
            |outcome| [("formatting", Outcome::Passed, Duration::ZERO), ("peers", outcome, Duration::ZERO)];
        let skipped = ran(Outcome::Skipped("missing".to_string()));
        assert_eq!([false, true].map(|strict| summary(&skipped, strict)), [true, false]);
        assert!(summary(&ran(Outcome::Passed), true));
        assert!(!summary(&ran(Outcome::Failed("wrong".to_string())), false));
    }

    #[test]
    fn every_stage_that_is_special_is_one() {
        let special = [TIDY, WASM32, COMPARISONS, BUILD, MUTATION, SOAK].into_iter().chain(ASIDE);
        assert!(special.into_iter().all(|name| STAGE_NAMES.contains(&name)));
    }
}
