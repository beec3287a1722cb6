//! Commands that accept a rig with a motor.

use super::{CommandError, Request};
use crate::project::Loaded;

/// Rejects the requests that are not available for a motor.
///
/// # Errors
/// [`CommandError::OfCylinders`].
pub(super) fn refuse(loaded: &Loaded, request: &Request) -> Result<(), CommandError> {
    if !loaded.project.motion().is_rotary() {
        return Ok(());
    }
    match request {
        Request::Size { .. } | Request::Shape { .. } | Request::Bench => {
            Err(CommandError::OfCylinders { command: request.name() })
        }
        // each request by its name, so that a further command is not accepted by accident
        Request::Check
        | Request::Linearize { .. }
        | Request::Verify { .. }
        | Request::Design { .. }
        | Request::Simulate(_)
        | Request::Compare
        | Request::Alternatives(_)
        | Request::Campaign(_)
        | Request::Export { .. }
        | Request::Report { .. } => Ok(()),
    }
}

/// Rejects a comparison of projects of which some turn and others do not.
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
