//! The function block that runs the test vectors.

use super::FunctionBlock;
use super::block::input;
use super::statements::{Statements, literal};
use crate::export::{DeployedSignal, ExportedController, TestVector, VectorOperation};

/// The block: after a call with `Run`, `Differing` is the number of wrong outputs. Vectors with a
/// signal that is not a finite number are left out, since some controllers stop where one is
/// computed.
pub(super) fn block(exported: &ExportedController) -> FunctionBlock {
    let name = format!("{}_Test", exported.name);
    let signals = exported.signals();
    let is_finite = |vector: &&TestVector| signals.iter().all(|one| one.value(&vector.signals).is_finite());
    let mut body = Statements::default();
    body.when("NOT Run", |body| body.line("RETURN;"));
    body.assign("Differing", "0");
    for (place, vector) in exported.vectors.iter().filter(is_finite).enumerate() {
        sample(&mut body, exported, vector, place == 0);
    }
    FunctionBlock { declaration: declaration(exported, &name), name, statements: body.into_text() }
}

/// One sample, and the comparison of its outputs.
fn sample(body: &mut Statements, exported: &ExportedController, vector: &TestVector, first: bool) {
    let word = |truth: bool| if truth { "TRUE" } else { "FALSE" };
    let reset = word(first || vector.operation == VectorOperation::ResetAndStep);
    let hold = word(vector.operation == VectorOperation::HoldAndStep);
    let value = |signal: &DeployedSignal| literal(signal.value(&vector.signals));
    let signals = exported.signals();
    let signals = signals.iter().map(|signal| format!(", {} := {}", input(*signal), value(signal)));
    let (signals, held): (String, _) = (signals.collect(), literal(vector.held_v));
    body.line(format_args!(
        "Tested(Enable := TRUE, Reset := {reset}, Hold := {hold}, HeldCommand := {held}{signals});"
    ));
    let (command, limited) = (literal(vector.executed.command_v), word(vector.executed.output.limited));
    let differs = format!("(Tested.Command <> {command}) OR (Tested.Limited <> {limited})");
    body.when(differs, |body| body.assign("Differing", "Differing + 1"));
}

fn declaration(exported: &ExportedController, name: &str) -> String {
    format!(
        "FUNCTION_BLOCK {name}
VAR_INPUT
    Run : BOOL; (* runs the test vectors *)
END_VAR
VAR_OUTPUT
    Differing : DINT := 0; (* number of outputs that differ *)
END_VAR
VAR
    Tested : {};
END_VAR
",
        exported.name
    )
}
