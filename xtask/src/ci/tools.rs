//! Parts of the Rust toolchain that may have to be added first.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// Ensures that `cargo SUBCOMMAND` works; states what is missing if it cannot.
pub(super) fn component(name: &str, subcommand: &str) -> Result<(), String> {
    let works = || quietly("cargo", &[subcommand, "--version"]);
    if works() || (quietly("rustup", &["component", "add", name]) && works()) {
        return Ok(());
    }
    Err(format!("`cargo {subcommand}` is missing and `rustup component add {name}` did not bring it"))
}

/// The compiler of clippy, which lies beside the other.
pub(super) fn clippy_driver() -> Result<PathBuf, String> {
    component("clippy", "clippy")?;
    let printed = Command::new("rustc").args(["--print", "sysroot"]).output();
    let printed = printed.map_err(|error| format!("`rustc` is missing: {error}"))?;
    let driver = Path::new(String::from_utf8_lossy(&printed.stdout).trim()).join("bin").join("clippy-driver");
    if driver.is_file() { Ok(driver) } else { Err(format!("there is no {}", driver.display())) }
}

/// Ensures that the standard library for this target is installed; states what is missing if it
/// cannot.
pub(super) fn target(name: &str) -> Result<(), String> {
    if is_target_there(name) || (quietly("rustup", &["target", "add", name]) && is_target_there(name)) {
        return Ok(());
    }
    Err(format!("the target {name} is missing and `rustup target add {name}` did not bring it"))
}

/// Ensures that SUNDIALS can be linked; states what is missing if it cannot. It is installed if the
/// user is root on Debian.
pub(super) fn sundials() -> Result<(), String> {
    // Asked for by two stages at once, it is installed once.
    static ASKED: Mutex<()> = Mutex::new(());
    let _asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
    let header = ["-fsyntax-only", "-include", "cvode/cvode.h", "-x", "c", "/dev/null"];
    let install = || {
        quietly("apt-get", &["update", "-qq"])
            && quietly("apt-get", &["install", "-y", "-qq", "libsundials-dev"])
    };
    if quietly("cc", &header) || (install() && quietly("cc", &header)) {
        return Ok(());
    }
    Err("SUNDIALS is missing and `apt-get install libsundials-dev` did not bring it".to_string())
}

/// So little of the weight of others that a program runs where they leave a processor idle, and
/// still ends if they leave none.
const NICENESS: &str = "15";

/// The beginning of a command line that leaves the processors to others that want them; empty where
/// the system cannot do that.
pub(super) fn politely() -> &'static [&'static str] {
    if quietly("nice", &["true"]) { &["nice", "-n", NICENESS] } else { &[] }
}

fn is_target_there(name: &str) -> bool {
    let printed = Command::new("rustc").args(["--print", "target-libdir", "--target", name]).output();
    printed.is_ok_and(|output| {
        let folder = String::from_utf8_lossy(&output.stdout).trim().to_string();
        output.status.success() && Path::new(&folder).is_dir()
    })
}

fn quietly(program: &str, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}
