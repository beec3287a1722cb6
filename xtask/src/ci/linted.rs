//! A build that lints and documents while it compiles, so that every crate is read once.
//!
//! `cargo clippy` and `cargo doc` would check all packages, and all that they depend on, for
//! themselves: a fifth of the test command. Instead cargo starts this program in place of the
//! compiler (its variable `RUSTC_WORKSPACE_WRAPPER`), and it hands the crate to clippy's compiler,
//! which compiles it too, and then to rustdoc.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use super::tools;

/// Tells this program that cargo started it; the value is clippy's compiler.
const IN_PLACE_OF_THE_COMPILER: &str = "XTASK_CLIPPY_DRIVER";

/// Where clippy's compiler reads its arguments, and what is between them.
const CLIPPY_ARGUMENTS: (&str, &str) = ("CLIPPY_ARGS", "__CLIPPY_HACKERY__");

/// The packages whose tests are compiled without optimisation: most of their time passes in the
/// library, which is optimised, and this saves most of a minute of one processor. A profile of
/// cargo would take the optimisation from the library too.
const PLAIN_TESTS: [&str; 4] = ["phea-dynamics", "phea-figure", "phea-project", "phea-qft"];

/// The libraries that are compiled once more for the unit tests of their kernels, without
/// optimisation: these tests take no time.
const PLAIN_UNIT_TESTS: [&str; 4] = ["phea_dynamics", "phea_engineering", "phea_hydraulics", "phea_project"];

/// The variables with which commands of cargo build so. All commands of a run need the same, or
/// cargo would build everything once more.
pub(super) fn variables(target: &Path) -> Result<Vec<(&'static str, String)>, String> {
    let driver = tools::clippy_driver()?;
    let wrapper = copied(target).map_err(|error| format!("this program cannot be copied: {error}"))?;
    let (name, between) = CLIPPY_ARGUMENTS;
    Ok(vec![
        ("RUSTC_WORKSPACE_WRAPPER", wrapper.to_string_lossy().into_owned()),
        (IN_PLACE_OF_THE_COMPILER, driver.to_string_lossy().into_owned()),
        (name, ["-D", "warnings", ""].join(between)),
    ])
}

/// A copy of this program: the build replaces the original.
fn copied(target: &Path) -> std::io::Result<PathBuf> {
    let folder = target.join("tmp");
    std::fs::create_dir_all(&folder)?;
    let copy = folder.join("xtask_in_place_of_the_compiler");
    std::fs::copy(std::env::current_exe()?, &copy)?;
    Ok(copy)
}

/// Compiles, lints and documents one crate if cargo started this program for that; otherwise
/// nothing.
pub(crate) fn in_place_of_the_compiler() -> Option<ExitCode> {
    let driver = std::env::var_os(IN_PLACE_OF_THE_COMPILER)?;
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    let is_compiler = arguments.first().is_some_and(|first| Path::new(first).ends_with("rustc"));
    is_compiler.then(|| {
        let plain = is_plain_test(&arguments).then_some("-Copt-level=0");
        let compiled = succeeds(Command::new(driver).args(&arguments).args(plain));
        let documented =
            compiled && documentation(&arguments).is_none_or(|mut rustdoc| succeeds(&mut rustdoc));
        if documented { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    })
}

fn is_plain_test(arguments: &[OsString]) -> bool {
    let is_package = std::env::var_os("CARGO_PKG_NAME")
        .is_some_and(|package| PLAIN_TESTS.iter().any(|name| package == *name));
    let is_library = arguments.windows(2).any(|pair| {
        let [option, name] = pair else { return false };
        option == "--crate-name" && PLAIN_UNIT_TESTS.iter().any(|library| name == library)
    });
    (is_package || is_library) && arguments.iter().any(|one| one == "--test")
}

fn succeeds(command: &mut Command) -> bool {
    match command.status() {
        Ok(status) => status.success(),
        Err(error) => {
            eprintln!("{command:?}: {error}");
            false
        }
    }
}

/// rustdoc's command for the library or program that the compiler is given; `None` for tests, build
/// scripts, and questions about the compiler.
fn documentation(arguments: &[OsString]) -> Option<Command> {
    let words: Vec<&str> = arguments.iter().map(|one| one.to_str()).collect::<Option<_>>()?;
    let is_of_package = std::env::var_os("CARGO_PRIMARY_PACKAGE").is_some();
    // what has no harness is a test by `--cfg test`
    let is_test = words.contains(&"--test") || words.windows(2).any(|pair| pair == ["--cfg", "test"]);
    let is_documented = words.contains(&"--crate-name") && !is_test && !words.contains(&"build_script_build");
    let (compiler, words) = words.split_first()?;
    (is_of_package && is_documented).then(|| {
        let mut rustdoc = Command::new(Path::new(compiler).with_file_name("rustdoc"));
        rustdoc.args(of_rustdoc(words)).args(["-D", "warnings"]);
        // as `cargo doc` does: nothing of a program is public
        if words.windows(2).any(|pair| pair == ["--crate-type", "bin"]) {
            rustdoc.arg("--document-private-items");
        }
        rustdoc
    })
}

/// The compiler's arguments without those that only the compiler knows, and another folder.
fn of_rustdoc(words: &[&str]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut rest = words.iter().copied();
    while let Some(word) = rest.next() {
        match word {
            "--out-dir" => {
                let of_compiler = rest.next().unwrap_or_default();
                let target = Path::new(of_compiler).ancestors().nth(2).unwrap_or(Path::new("target"));
                kept.extend(["-o".to_string(), target.join("doc").to_string_lossy().into_owned()]);
            }
            "-C" => {
                // optimisation, names of files, the linker
                rest.next();
            }
            _ if word.starts_with("--emit") || word.starts_with("-C") => {}
            _ => kept.push(word.to_string()),
        }
    }
    kept
}
