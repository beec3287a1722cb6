//! Controller as C99 that gives the bits of the simulation.
//!
//! The source has no heap, no library function, no recursion and no global variable; its state is in
//! a struct of the caller. Each product and sum passes through a volatile temporary, since a
//! compiler that fuses them rounds once instead of twice.

mod core;
mod number;
mod self_test;

use phea_machine::Deployed;

use super::contract::Contract;
use super::vectors::TestVector;
use crate::answer::OutputFile;

/// The header, the source, its self test and an example of its use.
pub fn files(deployed: &Deployed, contract: &Contract, vectors: &[TestVector]) -> Vec<OutputFile> {
    let name = &contract.name;
    let head = comment(&contract.lines(deployed));
    let file =
        |ending: &str, text: String| OutputFile::new(format!("{name}{ending}"), format!("{head}\n{text}"));
    vec![
        file(".h", core::header(deployed, name)),
        file(".c", core::source(deployed, name)),
        file("_self_test.c", self_test::source(deployed, name, vectors)),
        OutputFile::new("example_main.c", format!("{head}\n{}", self_test::example(name))),
    ]
}

/// Lines as a comment, which they cannot end.
fn comment(lines: &[String]) -> String {
    let lines = lines.iter().map(|line| format!(" * {}", line.replace("*/", "* /").replace('\\', "/")));
    format!("/*\n{}\n */", lines.map(|line| line.trim_end().to_string()).collect::<Vec<_>>().join("\n"))
}
