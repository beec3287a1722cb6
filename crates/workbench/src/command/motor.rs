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
        | Request::Report
        | Request::Page => return Ok(()),
        Request::SimulateAs(asked) if asked.frequency_response.is_none() => return Ok(()),
        Request::SimulateAs(_) => "simulate --frequency-response",
        Request::LinearizeSwept(_) => "linearize --sweep",
        Request::ReportOfAlternatives { .. } => "report --alternatives",
        other => other.name(),
    };
    Err(CommandError::OfCylinders { command })
}
