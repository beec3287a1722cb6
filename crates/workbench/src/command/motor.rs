//! Which commands treat a rig that turns.

use super::{CommandError, Request};
use crate::project::Loaded;

/// Refuses what phea does not do with a motor.
///
/// # Errors
/// [`CommandError::OfCylinders`].
pub(super) fn refuse(loaded: &Loaded, request: &Request) -> Result<(), CommandError> {
    if !loaded.project.motion().is_rotary() {
        return Ok(());
    }
    let command = match request {
        Request::Check
        | Request::Linearize
        | Request::Verify
        | Request::VerifyOnMachine
        | Request::VerifyProven { .. }
        | Request::Design { .. }
        | Request::Simulate
        | Request::SimulateAs(_)
        | Request::LinearizeSwept(_)
        | Request::Alternatives(_)
        | Request::ReportOfAlternatives { .. }
        | Request::Campaign(_)
        | Request::Compare
        | Request::Report
        | Request::Page => return Ok(()),
        other => other.name(),
    };
    Err(CommandError::OfCylinders { command })
}

/// Refuses projects side by side of which some turn and others do not.
///
/// # Errors
/// [`CommandError::MixedMotion`].
pub(super) fn refuse_mixture(projects: &[Loaded]) -> Result<(), CommandError> {
    let find = |rotary: bool| projects.iter().find(|loaded| loaded.project.motion().is_rotary() == rotary);
    match (find(true), find(false)) {
        (Some(turning), Some(other)) => {
            Err(CommandError::MixedMotion { path: turning.path.clone(), other: other.path.clone() })
        }
        _ => Ok(()),
    }
}
