//! Chores of the repository, written in Rust so that they run wherever the project does.
//!
//! `cargo xtask ci` is the test command; `cargo xtask tidy` checks the rules that neither the
//! compiler nor clippy knows.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a chore talks to the person who started it")]

mod bench;
mod ci;
mod repository;
mod rust_file;
mod tidy;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask CHORE

  ci [STAGE]...    the test command: every stage, or only those named
  bench [build]    how long the command takes on the examples; with `build`, and to build from scratch
  dist [--check]   the files of a release, in target/dist; with `--check`, built in another folder again and compared
  tidy [FOLDER]    the rules of the house that compiler and clippy do not know, here or in another checkout";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["ci", stages @ ..] => ci::run(&root(), stages),
        ["bench"] => bench::run(&root(), false),
        ["bench", "build"] => bench::run(&root(), true),
        ["dist"] => ci::run(&root(), &["dist"]),
        ["dist", "--check"] => ci::run(&root(), &["dist", "dist-again"]),
        ["tidy"] => tidy::is_tidy(&root()),
        ["tidy", elsewhere] => tidy::is_tidy(Path::new(elsewhere)),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    if done { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The repository's root: the folder above this package.
fn root() -> PathBuf {
    let package = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    package.parent().map_or(package.clone(), |folder| folder.to_path_buf())
}
