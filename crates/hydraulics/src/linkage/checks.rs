//! Checks of a linkage: its closure over the stroke.

use phea_quantity::{self as quantity, LENGTH};
use phea_table::TableCheck;

use super::LinkageError;
use super::keys::{DeclaredLinkage, LinkageKind};

impl DeclaredLinkage {
    /// Reports a linkage that cannot exist over a stroke in m.
    pub fn check(&self, stroke: f64, check: &mut dyn TableCheck) {
        let keys = ["cylinder_pivot", "rod_pivot", "retracted_length", "fixed_link", "input_link", "coupler"];
        let more =
            ["output_link", "extensions", "angles", "tolerance", "angle_offset", "input_angle", "kind"];
        let lacks = |key: &&str| check.refused(&format!("linkage.{key}"));
        if stroke <= 0.0 || check.refused("cylinder.stroke") || keys.iter().chain(&more).any(lacks) {
            return;
        }
        if let LinkageKind::Table { extensions, angles, .. } = &self.kind {
            if extensions.is_empty() || angles.is_empty() {
                return;
            }
            if extensions.len() != angles.len() {
                let message = format!(
                    "`angles` has {} values and `extensions` {}: each angle belongs to one extension",
                    angles.len(),
                    extensions.len()
                );
                return check.error_with_help("linkage.angles", message, "state the same number of both");
            }
        } else if !check.declared("linkage.retracted_length") {
            return;
        }
        if let Err(error) = self.reduced(stroke) {
            let (key, message, help) = refusal(&error);
            check.error_with_help(&format!("linkage.{key}"), message, help);
        }
    }
}

/// Key, reason and remedy of an error.
fn refusal(error: &LinkageError) -> (&'static str, String, String) {
    let mm = |length: f64| quantity::display(length, &LENGTH, 4);
    match *error {
        LinkageError::NoTriangle { position, length, possible: [least, most] } => (
            "retracted_length",
            format!(
                "the linkage cannot close: at a position of {} its pivots are {} apart, and about the joint only {} to {} are possible",
                mm(position),
                mm(length),
                mm(least),
                mm(most)
            ),
            "change `retracted_length`, `cylinder_pivot` or `rod_pivot`, or shorten the `stroke` (1 % beyond either end counts)"
                .to_string(),
        ),
        LinkageError::NoFourBar { position } => (
            "coupler",
            format!(
                "the linkage cannot close: at a position of {} `coupler` and `output_link` do not reach each other",
                mm(position)
            ),
            "change the lengths of the links or `input_angle`, or shorten the `stroke` (1 % beyond either end counts)".to_string(),
        ),
        LinkageError::DeadPoint { position } => (
            "kind",
            format!(
                "the linkage comes to a dead point at a position of {}: there the force has no lever arm about the joint, or the joint does not turn",
                mm(position)
            ),
            "change its lengths, or shorten the `stroke`, so that the least lever arm is more than 2 % of the greatest".to_string(),
        ),
        LinkageError::NotSmooth { error } => (
            "kind",
            format!("near a dead point the lever arm changes too fast: one polynomial leaves an error of {}", mm(error)),
            "change its lengths, or shorten the `stroke`, to stay away from the dead point".to_string(),
        ),
        _ => refusal_of_table(error),
    }
}

fn refusal_of_table(error: &LinkageError) -> (&'static str, String, String) {
    let mm = |length: f64| quantity::display(length, &LENGTH, 4);
    match *error {
        LinkageError::FewRows { rows } => (
            "extensions",
            format!("a table of {rows} rows says nothing between them"),
            "state two rows or more".to_string(),
        ),
        LinkageError::TableOrder { row } => (
            "angles",
            format!("row {row} of the table does not increase: the angle grows with the extension"),
            "order the rows by extension, and count the angle in the other sense if it falls".to_string(),
        ),
        LinkageError::TableRough { residual, tolerance, degree } => (
            "tolerance",
            format!(
                "the table is not smooth: a polynomial of degree {degree} passes a row at {}, and `tolerance` permits {}",
                mm(residual),
                mm(tolerance)
            ),
            "correct the row, measure more rows, or permit more".to_string(),
        ),
        LinkageError::TableShort { from, to } => (
            "extensions",
            format!("the table extends from {} to {}, and not over the stroke", mm(from), mm(to)),
            "state the angles from position 0 to the `stroke`".to_string(),
        ),
        _ => ("kind", error.to_string(), "change its lengths, or shorten the `stroke`".to_string()),
    }
}
