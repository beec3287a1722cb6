//! The steps of an integration.

use crate::answer::Answer;
use phea_dynamics::simulation::StepCounts;

/// Steps of an integration.
#[derive(Answer)]
pub(super) struct StepCountsAnswer {
    /// Number of accepted steps.
    steps: u64,
    /// Number of rejected steps, which were repeated with a shorter step.
    rejected: u64,
    /// Number of evaluations of the rates, without those for derivatives at the start of each step.
    evaluations: u64,
}

impl From<StepCounts> for StepCountsAnswer {
    fn from(counts: StepCounts) -> StepCountsAnswer {
        let StepCounts { steps, rejected, evaluations } = counts;
        StepCountsAnswer { steps, rejected, evaluations }
    }
}
