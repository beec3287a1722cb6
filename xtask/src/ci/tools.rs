//! Tools that a stage needs and a machine may lack, installed if possible.

use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

use super::Outcome;
use super::Problem::{self, Failed, Skipped};

/// Ensures that a tool works, by these commands if necessary; reports the missing tool otherwise.
fn ensure(what: &str, works: impl Fn() -> bool, install: &[&str], problem: fn(String) -> Problem) -> Outcome {
    // If two stages need the tool at once, it is installed once.
    static INSTALLING: Mutex<()> = Mutex::new(());
    let _installing = INSTALLING.lock().unwrap_or_else(PoisonError::into_inner);
    if works() || (install.iter().all(|line| succeeds(line)) && works()) {
        return Ok(());
    }
    Err(problem(format!("{what} is missing and could not be installed by `{}`", install.join(" && "))))
}

/// `cargo SUBCOMMAND` of this component of the toolchain.
pub(super) fn component(name: &str, subcommand: &str) -> Outcome {
    let works = || succeeds(&format!("cargo {subcommand} --version"));
    ensure(name, works, &[&format!("rustup component add {name}")], Failed)
}

/// The standard library for this target.
pub(super) fn target(name: &str) -> Outcome {
    let query = format!("rustc --print target-libdir --target {name}");
    let works = || output(&query).is_some_and(|folder| std::path::Path::new(folder.trim()).is_dir());
    ensure(name, works, &[&format!("rustup target add {name}")], Skipped)
}

/// SUNDIALS, if it can be linked; root installs it on Debian.
pub(super) fn sundials() -> Outcome {
    let works = || succeeds("cc -fsyntax-only -include cvode/cvode.h -x c /dev/null");
    ensure("SUNDIALS", works, &["apt-get update -qq", "apt-get install -y -qq libsundials-dev"], Skipped)
}

/// Python's module for virtual environments, which is in a separate package on Debian.
pub(super) fn python() -> Outcome {
    let works = || succeeds("python3 -m ensurepip --version");
    ensure("python3-venv", works, &["apt-get update -qq", "apt-get install -y -qq python3-venv"], Failed)
}

fn succeeds(line: &str) -> bool {
    output(line).is_some()
}

/// Output of a command that succeeds.
pub(super) fn output(line: &str) -> Option<String> {
    let mut words = line.split(' ');
    let ran = Command::new(words.next()?).args(words).stdin(Stdio::null()).output().ok()?;
    ran.status.success().then(|| String::from_utf8_lossy(&ran.stdout).into_owned())
}
