//! The `phea` command: a thin shell over `phea_workbench`. It opens paths and prints; it computes nothing.

mod arguments;
mod file_system;
mod run;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    run::run(arguments::Arguments::parse())
}
