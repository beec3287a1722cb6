//! The `phea` command: a thin shell over `phea_workbench`. It opens paths and prints; it computes
//! nothing. The program `phea` runs it, and so does the command of the Python package.

mod arguments;
mod changes;
mod failure;
mod installation;
mod interruption;
mod messages;
mod run;

use std::ffi::OsString;

use clap::Parser;

/// Runs the command line, whose first word is the name of the program, and returns the exit status.
pub fn run(words: &[OsString]) -> u8 {
    interruption::survive_large_files();
    match arguments::Arguments::try_parse_from(words) {
        Ok(arguments) => run::run(arguments),
        Err(error) => run::usage_error(&error, words),
    }
}
