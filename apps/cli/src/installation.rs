//! Files that an installation adds to the command: completions of the shells and manual pages, from
//! the description of the arguments.

use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;
use phea_workbench::answer::OutputFile;

use crate::arguments::Arguments;

/// Name of the program in a shell.
const PROGRAM: &str = "phea";

/// Beginning of the line by which a manual page of this command is recognised.
pub(crate) const TITLE_LINE: &str = ".TH phea";

/// The script by which a shell completes the command.
pub(crate) fn completions(shell: Shell) -> Vec<u8> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), PROGRAM, &mut script);
    script
}

/// The manual pages: the one of the program first, then one for each command.
pub(crate) fn manual_pages() -> Vec<OutputFile> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let commands: Vec<_> = program.get_subcommands().cloned().collect();
    std::iter::once(program).chain(commands).map(manual_page).collect()
}

fn manual_page(command: clap::Command) -> OutputFile {
    let source = format!("{PROGRAM} {}", env!("CARGO_PKG_VERSION"));
    let page = Man::new(command).source(source).manual("Hydraulic force control");
    let mut text = Vec::new();
    // a vector accepts every byte
    let _ = page.render(&mut text);
    OutputFile::new(page.get_filename(), text)
}
