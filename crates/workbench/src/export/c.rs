//! Controller as C99 that gives the bits of the simulation.
//!
//! The source has no heap, no library function, no recursion and no global variable; its state is
//! in a struct of the caller. Each product and sum passes through a volatile temporary, since a
//! compiler that fuses them rounds once instead of twice.

mod core;
mod number;
mod self_test;

use super::ExportedController;
use crate::answer::OutputFile;

/// Endings of the files that begin with the name of the controller.
pub(super) const ENDINGS: [&str; 3] = [".h", ".c", "_self_test.c"];
/// Name of the example.
pub(super) const EXAMPLE: &str = "example_main.c";

/// The header, the source, its self test and an example of its use.
pub fn files(exported: &ExportedController) -> Vec<OutputFile> {
    let ExportedController { name, deployed, vectors, .. } = exported;
    let head = comment(&exported.head());
    let [header, source, self_test] = ENDINGS.map(|ending| format!("{name}{ending}"));
    let file = |name: String, text: String| OutputFile::new(name, format!("{head}\n{text}"));
    vec![
        file(header, core::header(deployed, name)),
        file(source, core::source(deployed, name)),
        file(self_test, self_test::source(deployed, name, vectors)),
        file(EXAMPLE.to_string(), self_test::example(name)),
    ]
}

/// Lines as a comment, which they cannot end.
pub(super) fn comment(lines: &[String]) -> String {
    let lines = lines.iter().map(|line| format!(" * {}", line.replace("*/", "* /").replace('\\', "/")));
    format!("/*\n{}\n */", lines.map(|line| line.trim_end().to_string()).collect::<Vec<_>>().join("\n"))
}
