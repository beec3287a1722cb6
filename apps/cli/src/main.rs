//! The `phea` command: a thin shell over `phea_workbench`. It opens paths and prints; it computes
//! nothing.

mod arguments;
mod changes;
mod failure;
mod interruption;
mod messages;
mod run;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    interruption::survive_large_files();
    match arguments::Arguments::try_parse() {
        Ok(arguments) => run::run(arguments),
        Err(error) => run::usage_error(&error),
    }
}
