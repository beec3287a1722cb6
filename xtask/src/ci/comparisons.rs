//! Comparisons with other tools and recomputed numbers, in Python, in a virtual environment of their own.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::{Outcome, execute};
use crate::repository::Repository;

const REQUIREMENTS: &str = "comparisons/requirements.txt";

/// Makes the environment, then runs every comparison and every script that a golden number names as its origin.
pub(super) fn run(root: &Path) -> Outcome {
    let scripts = match Repository::read(root) {
        Ok(repository) => scripts(&repository),
        Err(error) => return Outcome::Failed(format!("cannot read the repository: {error}")),
    };
    let python = match environment(root) {
        Ok(python) => python.to_string_lossy().into_owned(),
        Err(problem) => return Outcome::Failed(problem),
    };
    if !scripts.iter().any(|script| script.starts_with("comparisons/compare_")) {
        return Outcome::Failed("there is no comparisons/compare_*.py".to_string());
    }
    let failed: Vec<String> = scripts
        .into_iter()
        .filter(|script| !matches!(execute(root, &python, &[script]), Outcome::Passed))
        .collect();
    if failed.is_empty() { Outcome::Passed } else { Outcome::Failed(failed.join(", ")) }
}

/// `comparisons/compare_*.py`, `book/recompute_*.py` and the scripts named in `ORIGIN: recomputed by PATH`.
fn scripts(repository: &Repository) -> Vec<String> {
    let comparison = |path: &str| {
        (path.starts_with("comparisons/compare_") || path.starts_with("book/recompute_"))
            && path.ends_with(".py")
    };
    let mut scripts: Vec<String> = repository.texts(comparison).map(|(path, _)| path.to_string()).collect();
    for (_, text) in repository.texts(|path| path.ends_with(".rs")) {
        scripts.extend(text.lines().filter_map(recomputed_by).map(str::to_string));
    }
    scripts.retain(|script| script.ends_with(".py") && repository.exists(script));
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
fn environment(root: &Path) -> Result<PathBuf, String> {
    let folder = root.join("target").join("venv");
    let python = folder.join("bin").join("python");
    if !has_pip(&python) {
        make_environment(root, &folder)?;
    }
    let program = python.to_string_lossy().into_owned();
    if root.join(REQUIREMENTS).exists() {
        required(execute(root, &program, &["-m", "pip", "install", "--quiet", "-r", REQUIREMENTS]))?;
    }
    Ok(python)
}

fn has_pip(python: &Path) -> bool {
    let mut command = Command::new(python);
    command.args(["-m", "pip", "--version"]).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Debian splits the module off into a package of its own; root may install it.
fn make_environment(root: &Path, folder: &Path) -> Result<(), String> {
    let place = folder.to_string_lossy().into_owned();
    let make = || execute(root, "python3", &["-m", "venv", "--clear", &place]);
    if matches!(make(), Outcome::Passed) {
        return Ok(());
    }
    println!("`python3 -m venv` failed; trying Debian's package python3-venv");
    required(execute(root, "apt-get", &["update", "-qq"]))?;
    required(execute(root, "apt-get", &["install", "-y", "-qq", "python3", "python3-venv"]))?;
    required(make())
}

fn required(outcome: Outcome) -> Result<(), String> {
    match outcome {
        Outcome::Passed => Ok(()),
        Outcome::Failed(problem) | Outcome::Skipped(problem) => Err(problem),
    }
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
