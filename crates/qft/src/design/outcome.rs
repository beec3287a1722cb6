//! What a design ended with, and what it is continued from.

use phea_dynamics::watch::{Watch, unwatched};

use super::attempt::{Attempt, LoopDesignError};
use super::diagnosis::Finding;
use super::problem::DesignOptions;
use super::result::{Design, DesignRound, DesignStatus};
use super::run::{design_knowing, design_of};
use super::tried::TriedStructure;
use crate::kept_plants::KeptPlants;
use crate::loop_shaping::{DesignProblem, Samples};

/// What a design ended with.
#[derive(Clone, Debug)]
pub struct DesignOutcome {
    /// The best design; `None` where no controller was found.
    pub design: Option<Design>,
    /// What no controller can achieve, and what will be hard; see [`diagnose`](super::diagnose).
    pub findings: Vec<Finding>,
    /// Whether the watch stopped it: then the design is the best so far.
    pub stopped: bool,
    /// What was tried when it was stopped.
    pub(super) at_hand: Option<Box<Attempt>>,
    pub(super) known: LearntPlants,
}

impl DesignOutcome {
    /// Every structure that was tried, in turn, with what it reached.
    pub fn tried(&self) -> &[TriedStructure] {
        &self.known.tried
    }

    /// If it was stopped before any design existed, audits the present controller, which becomes a
    /// design that has not converged.
    ///
    /// # Errors
    /// Those of [`design`](super::design).
    pub fn conclude(&mut self) -> Result<(), LoopDesignError> {
        let at_hand = self.at_hand.take().filter(|attempt| !attempt.x().is_empty());
        if let (None, Some(mut attempt)) = (&self.design, at_hand) {
            let audit = attempt.audited_as_it_is(&self.known.plants, &mut unwatched)?;
            let status = DesignStatus::NotConverged { rounds: attempt.rounds().len() };
            self.known.rounds.extend_from_slice(attempt.rounds());
            self.design = Some(design_of(&attempt, status, audit, &self.known.rounds)?);
        }
        Ok(())
    }
}

/// A design for other specifications of the same plants in the same loop as those of a design
/// before: what that sampled is not sampled again. But for rounding the result is that of
/// [`design`](super::design).
///
/// # Errors
/// Those of [`design`](super::design).
pub fn design_after(
    problem: &DesignProblem,
    options: &DesignOptions,
    before: &DesignOutcome,
    watch: Watch<'_>,
) -> Result<DesignOutcome, LoopDesignError> {
    let known = LearntPlants { plants: before.known.plants.clone(), ..LearntPlants::default() };
    design_knowing(problem, options, None, known, watch)
}

/// What was learnt about the plants.
#[derive(Clone, Debug, Default)]
pub(super) struct LearntPlants {
    /// The samples that searches evaluate; `None` before the first search.
    pub(super) samples: Option<Samples>,
    /// The plants that audits sampled.
    pub(super) plants: KeptPlants,
    pub(super) rounds: Vec<DesignRound>,
    pub(super) tried: Vec<TriedStructure>,
}
