//! Controller as function blocks in Structured Text (IEC 61131-3) that give the bits of the
//! simulation.
//!
//! Each statement rounds once and calls no function, so that a compiler has nothing to rearrange;
//! the sections are written out, with their coefficients in place.

mod block;
mod statements;
mod test_block;
mod twincat;

use super::ExportedController;
use crate::answer::OutputFile;

/// Ending of the portable file.
pub(super) const PORTABLE: &str = ".st";
/// Endings of the files of TwinCAT.
pub(super) const OF_TWINCAT: [&str; 2] = [".TcPOU", "_Test.TcPOU"];

/// A function block: its declaration and its statements.
struct FunctionBlock {
    name: String,
    declaration: String,
    statements: String,
}

/// The controller and its test as text, and each as a file of TwinCAT.
pub fn files(exported: &ExportedController) -> Vec<OutputFile> {
    let head = comment(&exported.head());
    let blocks = [block::block(exported), test_block::block(exported)];
    let portable =
        |one: &FunctionBlock| format!("{}\n{}END_FUNCTION_BLOCK\n", one.declaration, one.statements);
    let text = format!("{head}\n{}", blocks.each_ref().map(portable).join("\n"));
    let portable = OutputFile::new(format!("{}{PORTABLE}", exported.name), text);
    let of_twincat = blocks.iter().zip(OF_TWINCAT).map(|(block, ending)| {
        let file = twincat::file(block, &head, &exported.contract.project_sha256);
        OutputFile::new(format!("{}{ending}", exported.name), file)
    });
    std::iter::once(portable).chain(of_twincat).collect()
}

/// Lines as a comment, which they cannot end; nor can they end the section of XML around it.
fn comment(lines: &[String]) -> String {
    let plain = |line: &String| line.replace("(*", "( *").replace("*)", "* )").replace("]]>", "]] >");
    format!("(*\n{}\n*)", lines.iter().map(plain).collect::<Vec<_>>().join("\n"))
}
