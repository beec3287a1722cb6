//! The program `phea`: the command line of its process, and the exit status.

use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<_> = std::env::args_os().collect();
    ExitCode::from(phea_cli::run(&words))
}
