//! The names of specifications, for people.

use phea_engineering::specification::{NamedSpecification, SpecificationName};
use phea_qft::specification::ClosedLoop;

use crate::document::Cell;

/// The name of a limit on a closed loop.
pub(crate) fn subject_words(name: SpecificationName) -> &'static str {
    match name {
        SpecificationName::ClosedLoop(closed_loop) => closed_loop_words(closed_loop),
        SpecificationName::RoundedCommand(motion) => {
            motion.either("force error of the rounded command", "torque error of the rounded command")
        }
        SpecificationName::RoundedMeasurement => "command error of the rounded measurement",
    }
}

/// The name of a limited closed loop, for people.
fn closed_loop_words(closed_loop: ClosedLoop) -> &'static str {
    match closed_loop {
        ClosedLoop::RobustStability => "robust stability",
        ClosedLoop::Sensitivity => "sensitivity",
        ClosedLoop::PlantInputDisturbance => "plant input disturbance",
        ClosedLoop::ControlEffort => "control effort",
        ClosedLoop::LoadMotion => "load motion",
        ClosedLoop::Tracking => "tracking",
    }
}

/// `tracking`; empty if there is no specification.
pub(crate) fn name_words(named: Option<NamedSpecification>) -> &'static str {
    named.map_or("", |named| subject_words(named.name))
}

/// `2 tracking`; only the name for a specification that is not declared.
pub(crate) fn numbered(named: Option<NamedSpecification>) -> String {
    numbered_cell(named).text()
}

/// The name of a specification after its number, as in [`numbered`].
pub(crate) fn numbered_cell(named: Option<NamedSpecification>) -> Cell {
    let name = Cell::from(name_words(named));
    match number(named) {
        Some(number) => Cell::count(number).then(" ").then(name),
        None => name,
    }
}

/// A specification as a sentence names it: by table and number if it is in the file.
pub(crate) fn stated(named: Option<NamedSpecification>) -> String {
    let name = name_words(named);
    match number(named) {
        Some(number) => format!("[[specification]] {number} ({name})"),
        None => format!("the limit on the {name}"),
    }
}

/// Cell of a table for other programs with the number of a specification in the file; empty for a
/// limit that is not declared there.
pub(crate) fn number_cell(number: Option<usize>) -> String {
    number.map_or(String::new(), |number| number.to_string())
}

fn number(named: Option<NamedSpecification>) -> Option<usize> {
    named.and_then(|named| named.number)
}
