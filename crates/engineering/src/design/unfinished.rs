//! Parts that a design lacks if `watch` cancelled it.

use super::{DesignError, ProjectDesign};

/// A part of a design, in the order of importance to a reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DesignPart {
    /// The search for a controller.
    Search,
    /// The search for the largest command in the steps of the scenarios.
    CommandOfSteps,
    /// The trial of the designed controller on the nonlinear rig.
    Trial,
    /// The design with the plant of a rig that contradicts the first one.
    Repair,
    /// The proof of the designed controller.
    Proof,
    /// The gain from relaxing each limit that binds.
    Relaxations,
    /// The design without sampling, for comparison.
    WithoutSamples,
    /// The audit of the controller that the project gives.
    GivenController,
    /// Templates and bounds, as files.
    TemplatesAndBounds,
}

impl DesignPart {
    /// The word of a part in JSON.
    pub fn key(self) -> &'static str {
        match self {
            DesignPart::Search => "search",
            DesignPart::CommandOfSteps => "command_of_steps",
            DesignPart::Trial => "machine",
            DesignPart::Proof => "proof",
            DesignPart::Relaxations => "relaxations",
            DesignPart::WithoutSamples => "without_samples",
            DesignPart::GivenController => "published",
            DesignPart::Repair => "repair",
            DesignPart::TemplatesAndBounds => "templates_and_bounds",
        }
    }
}

impl ProjectDesign {
    /// True if `watch` cancelled the design: then it is the best so far. A cancelled repair leaves
    /// the first design unchanged.
    pub fn is_stopped(&self) -> bool {
        self.unfinished.iter().any(|part| *part != DesignPart::Repair)
    }

    /// Records a part that was left unfinished at cancellation.
    pub fn leave(&mut self, part: DesignPart) {
        leave(&mut self.unfinished, part);
    }
}

/// Adds a part that is not listed yet, in its order.
fn leave(unfinished: &mut Vec<DesignPart>, part: DesignPart) {
    unfinished.push(part);
    unfinished.sort_unstable();
    unfinished.dedup();
}

/// A result that follows a design; absent, and recorded as unfinished, once `watch` has cancelled,
/// since the design remains.
pub(super) fn unless_stopped<Found>(
    unfinished: &mut Vec<DesignPart>,
    part: DesignPart,
    find: impl FnOnce() -> Result<Option<Found>, DesignError>,
) -> Result<Option<Found>, DesignError> {
    if !unfinished.is_empty() {
        leave(unfinished, part);
        return Ok(None);
    }
    match find() {
        Err(DesignError::Stopped(_)) => {
            leave(unfinished, part);
            Ok(None)
        }
        found => found,
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::watch::Stopped;

    use super::*;

    /// A cancelled part is recorded, and so is every later part, without being begun; the first
    /// result remains.
    #[test]
    fn what_follows_a_stop_is_not_begun_and_noted() {
        let mut unfinished = vec![];
        let first = unless_stopped(&mut unfinished, DesignPart::Search, || Ok(Some(1)));
        let second =
            unless_stopped(&mut unfinished, DesignPart::Proof, || Err::<Option<i32>, _>(Stopped.into()));
        let mut begun = false;
        let third = unless_stopped(&mut unfinished, DesignPart::Trial, || {
            begun = true;
            Ok(Some(3))
        });
        assert_eq!([first, second, third], [Ok(Some(1)), Ok(None), Ok(None)]);
        assert!(!begun);
        assert_eq!(unfinished, [DesignPart::Trial, DesignPart::Proof]);
        assert_eq!(
            unless_stopped(&mut vec![], DesignPart::Proof, || Err::<Option<i32>, _>(
                DesignError::NoSpecification
            )),
            Err(DesignError::NoSpecification)
        );
    }
}
