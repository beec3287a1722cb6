//! A limit that cannot be used, at its place in the project.

use phea_engineering::specification::{SpecificationError, SpecificationProblem};

use crate::project::LateError;

/// The error at the place of its limit, with the change that would satisfy it.
pub(crate) fn late(error: &SpecificationError) -> LateError {
    let help = match error.reason {
        SpecificationProblem::Crossed { .. } => {
            "no loop is between them: raise `upper`, lower `lower`, or leave these frequencies out of `frequencies` and `band`"
        }
        _ => "",
    };
    let path = format!("specification[{}].{}", error.number - 1, error.key);
    LateError { path, message: error.to_string(), help: help.to_string() }
}
