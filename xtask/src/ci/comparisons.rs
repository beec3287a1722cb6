//! Comparisons with other tools and recomputed numbers, in Python, in a virtual environment of
//! their own.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use super::{Built, Outcome, build, target, tools};
use crate::repository::Repository;

/// What the scripts that ask phea begin with.
const COMPARE: &str = "comparisons/compare_";

/// Scripts that need nothing of phea, and take most of a minute to search anew what they found
/// before: run by [`soak`].
const SEARCHES: [&str; 1] = ["comparisons/recompute_design.py"];

/// Valves identified by phea and by SciPy: fifty of them before a release.
const RANDOM_VALVES: &str = "comparisons/compare_identify.py";

/// Valves whose recordings are made in Python: four hundred recordings of each before a release.
const RECORDED_VALVES: &str = "comparisons/compare_valves.py";

/// So much memory that was given back is kept by a script for its next array.
const KEPT_BYTES: &str = "1000000000";

/// Runs scripts; its last line names those that failed.
const TOGETHER: &str = "comparisons/together.py";
const FAILED: &str = "failed: ";

const REQUIREMENTS: &str = "comparisons/requirements.txt";

/// Each script that failed, or why none could be run.
type Compared = Result<Vec<String>, String>;

/// Scripts that run in parallel with the other stages.
pub(super) struct Begun {
    /// Their output, and their results.
    running: JoinHandle<(String, Compared)>,
    /// Hears that phea is built.
    waiting: Option<Sender<()>>,
}

impl Begun {
    /// phea is built: the scripts that ask it may run.
    pub(super) fn ask_phea(&mut self) {
        if let Some(waiting) = self.waiting.take() {
            // If the receiver is gone, the end of the stage shows why.
            waiting.send(()).ok();
        }
    }
}

/// Makes the environment, runs every comparison and every script that a golden number names as its
/// origin.
pub(super) fn run(built: &Built) -> Outcome {
    end(built, begin(&built.root))
}

/// Begins with the scripts that do not call phea, and continues with the others once
/// [`Begun::ask_phea`] is called; their output is kept until the end.
pub(super) fn begin(root: &Path) -> Begun {
    let root = root.to_path_buf();
    let (waiting, built) = channel();
    let running = std::thread::spawn(move || {
        let mut told = String::new();
        let compared = compare(&root, &mut told, &built);
        (told, compared)
    });
    Begun { running, waiting: Some(waiting) }
}

/// Waits for the running scripts; phea is built first if no other stage did so.
pub(super) fn end(repository: &Built, mut begun: Begun) -> Outcome {
    let built = if begun.waiting.is_some() { build(repository) } else { Outcome::Passed };
    if matches!(built, Outcome::Passed) {
        begun.ask_phea();
    }
    begun.waiting = None;
    let Ok((told, compared)) = begun.running.join() else {
        return Outcome::Failed("the comparisons ended early".to_string());
    };
    print!("{told}");
    match (built, compared) {
        (Outcome::Passed, Ok(failed)) if failed.is_empty() => Outcome::Passed,
        (Outcome::Passed, Ok(failed)) => Outcome::Failed(failed.join(", ")),
        (Outcome::Passed, Err(problem)) => Outcome::Failed(problem),
        (other, _) => other,
    }
}

/// Runs what is left out otherwise, by the phea of the release profile.
pub(super) fn soak(root: &Path) -> Outcome {
    let phea = target(root).join("release").join("phea").to_string_lossy().into_owned();
    let mut told = String::new();
    let ran = environment(root, &mut told).and_then(|python| {
        let python = python.to_string_lossy().into_owned();
        SEARCHES.iter().try_for_each(|script| quietly(root, &mut told, &python, &[script]))?;
        let random = quietly(root, &mut told, &python, &[RANDOM_VALVES, "--sets", "50", &phea]);
        let jobs = std::thread::available_parallelism().map_or(1, usize::from).to_string();
        let recorded = [RECORDED_VALVES, "--seeds", "400", "--verified", "20", "--jobs", &jobs, &phea];
        random.and(quietly(root, &mut told, &python, &recorded))
    });
    print!("{told}");
    ran.map_or_else(Outcome::Failed, |()| Outcome::Passed)
}

fn asks_phea(script: &str) -> bool {
    script.starts_with(COMPARE)
}

fn compare(root: &Path, told: &mut String, built: &Receiver<()>) -> Compared {
    let repository =
        Repository::read(root).map_err(|error| format!("cannot read the repository: {error}"))?;
    let python = environment(root, told)?.to_string_lossy().into_owned();
    if let Err(missing) = tools::sundials() {
        told.push_str(&format!("{missing}: nothing is recomputed with CVODE\n"));
    }
    let (asking, alone): (Vec<String>, Vec<String>) =
        scripts(&repository).into_iter().partition(|script| asks_phea(script));
    if asking.is_empty() {
        return Err(format!("there is no {COMPARE}*.py"));
    }
    // The build waits for no script; where it leaves a processor idle, they run.
    let mut failed = together(root, told, &python, &alone, politely);
    built.recv().map_err(|_| "phea could not be built".to_string())?;
    failed.extend(together(root, told, &python, &asking, quietly));
    Ok(failed)
}

/// One command in the root, what it prints kept.
type Quiet = fn(&Path, &mut String, &str, &[&str]) -> Result<(), String>;

/// Runs these scripts, and tells which failed; where they could not be run, why.
fn together(root: &Path, told: &mut String, python: &str, scripts: &[String], quiet: Quiet) -> Vec<String> {
    let names: Vec<&str> = scripts.iter().map(String::as_str).collect();
    let begun = told.len();
    match quiet(root, told, python, &[&[TOGETHER][..], &names].concat()) {
        Ok(()) => Vec::new(),
        Err(ended) => failed_in(&told[begun..]).unwrap_or_else(|| vec![ended]),
    }
}

/// The scripts that [`TOGETHER`] names at its end, if it came that far.
fn failed_in(told: &str) -> Option<Vec<String>> {
    let failed = told.lines().rev().find_map(|line| line.strip_prefix(FAILED))?;
    Some(failed.split(", ").map(str::to_string).collect())
}

/// Runs one command in the root, what it prints kept, and leaves the processors to others that want
/// them, where the system can do that.
fn politely(root: &Path, told: &mut String, program: &str, arguments: &[&str]) -> Result<(), String> {
    let line = [tools::politely(), &[program], arguments].concat();
    line.split_first().map_or(Ok(()), |(program, arguments)| quietly(root, told, program, arguments))
}

/// Runs one command in the root, what it prints kept.
fn quietly(root: &Path, told: &mut String, program: &str, arguments: &[&str]) -> Result<(), String> {
    let line = format!("{program} {}", arguments.join(" "));
    let target = target(root);
    let programs = target.join("debug");
    // What each script imports is compiled for the first one alone, and not beside its source.
    // The libraries below NumPy would take every core for matrices of a few rows, and the system
    // would clear the memory of a large array anew for each.
    let ran = Command::new(program)
        .args(arguments)
        .current_dir(root)
        .env_remove("PYTHONDONTWRITEBYTECODE")
        .env("PYTHONPYCACHEPREFIX", target.join("pycache"))
        .env("OPENBLAS_NUM_THREADS", "1")
        .env("MALLOC_MMAP_THRESHOLD_", KEPT_BYTES)
        .env("MALLOC_TRIM_THRESHOLD_", KEPT_BYTES)
        .env("PHEA", programs.join("phea"))
        .env("REFERENCE_SYSTEMS", programs.join("examples").join("reference_systems"))
        .env("SCHEMA_CASES", programs.join("examples").join("schema_cases"))
        .stdin(Stdio::null())
        .output();
    let (output, ended) = match ran {
        Ok(output) => (
            String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned(),
            if output.status.success() { Ok(()) } else { Err(format!("`{line}`: {}", output.status)) },
        ),
        Err(error) => (String::new(), Err(format!("`{line}`: {error}"))),
    };
    told.push_str(&format!("$ {line}\n{output}"));
    ended
}

/// `comparisons/compare_*.py`, `book/recompute_*.py` and the scripts named in
/// `ORIGIN: recomputed by PATH`.
fn scripts(repository: &Repository) -> Vec<String> {
    let comparison = |path: &str| {
        (path.starts_with(COMPARE) || path.starts_with("book/recompute_")) && path.ends_with(".py")
    };
    let mut scripts: Vec<String> = repository.texts(comparison).map(|(path, _)| path.to_string()).collect();
    for (_, text) in repository.texts(|path| path.ends_with(".rs")) {
        scripts.extend(text.lines().filter_map(recomputed_by).map(str::to_string));
    }
    scripts.retain(|script| script.ends_with(".py") && repository.exists(script));
    scripts.retain(|script| !SEARCHES.contains(&script.as_str()));
    scripts.sort();
    scripts.dedup();
    scripts
}

/// The script that a comment names as a golden number's origin.
pub(crate) fn recomputed_by(line: &str) -> Option<&str> {
    let (_, origin) = line.split_once("ORIGIN:")?;
    let (_, script) = origin.split_once("recomputed by ")?;
    let end = script.find(|c: char| !(c.is_alphanumeric() || "_./-".contains(c))).unwrap_or(script.len());
    Some(script[..end].trim_end_matches('.'))
}

/// The Python of the virtual environment, made and filled where needed.
fn environment(root: &Path, told: &mut String) -> Result<PathBuf, String> {
    let folder = root.join("target").join("venv");
    let python = folder.join("bin").join("python");
    if !has_pip(&python) {
        make_environment(root, told, &folder)?;
    }
    let program = python.to_string_lossy().into_owned();
    if root.join(REQUIREMENTS).exists() {
        // what is imported is compiled then, the rest of the packages never
        let install = ["-m", "pip", "install", "--quiet", "--no-compile", "-r", REQUIREMENTS];
        politely(root, told, &program, &install)?;
    }
    Ok(python)
}

fn has_pip(python: &Path) -> bool {
    let mut command = Command::new(python);
    command.args(["-m", "pip", "--version"]).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Debian splits the module off into a package of its own; root may install it.
fn make_environment(root: &Path, told: &mut String, folder: &Path) -> Result<(), String> {
    let place = folder.to_string_lossy().into_owned();
    let make = ["-m", "venv", "--clear", &place];
    if quietly(root, told, "python3", &make).is_ok() {
        return Ok(());
    }
    told.push_str("`python3 -m venv` failed; trying Debian's package python3-venv\n");
    quietly(root, told, "apt-get", &["update", "-qq"])?;
    quietly(root, told, "apt-get", &["install", "-y", "-qq", "python3", "python3-venv"])?;
    quietly(root, told, "python3", &make)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_name_their_script() {
        assert_eq!(
            recomputed_by("// ORIGIN: recomputed by comparisons/recompute_poles.py (mpmath)"),
            Some("comparisons/recompute_poles.py")
        );
        assert_eq!(recomputed_by("// ORIGIN: recomputed by comparisons/a.py."), Some("comparisons/a.py"));
        assert_eq!(recomputed_by("// ORIGIN: analytic"), None);
    }

    #[test]
    fn failed_scripts_are_named_by_the_last_line() {
        let told = "failed: none\n$ python a.py\nTraceback\nfailed: a.py, b.py\n";
        assert_eq!(failed_in(told), Some(vec!["a.py".to_string(), "b.py".to_string()]));
        assert_eq!(failed_in("No module named scipy\n"), None);
    }

    #[test]
    fn comparisons_and_origins_are_both_run_once() {
        let repository = Repository::from_texts(&[
            ("comparisons/compare_margins.py", ""),
            ("comparisons/systems.py", ""),
            ("book/recompute_theory.py", ""),
            ("comparisons/recompute_poles.py", ""),
            ("crates/a/tests/golden.rs", "// ORIGIN: recomputed by comparisons/recompute_poles.py\n"),
            ("crates/b/tests/golden.rs", "// ORIGIN: recomputed by comparisons/recompute_poles.py\n"),
        ]);
        let expected =
            ["book/recompute_theory.py", "comparisons/compare_margins.py", "comparisons/recompute_poles.py"];
        assert_eq!(scripts(&repository), expected);
    }
}
