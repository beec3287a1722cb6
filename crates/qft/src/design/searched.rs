//! Result of each structure searched.

use std::collections::BTreeSet;

use phea_dynamics::controller::Controller;

use super::attempt::{Attempt, AttemptEnding};
use super::{BINDING_DB, NamedStructure};
use crate::loop_shaping::Structure;
use crate::verification::SpecificationMargin;

/// Outcome of the search of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StructureEnding {
    /// The audit finds that every specification is met.
    Met,
    /// Every controller of the structure violates a specification.
    Missed,
    /// The improvement over a shorter valid structure is not worth the additional poles.
    NotEarned,
    /// Search and audit did not agree.
    NotConverged,
    /// The search finds no controller of the structure that stabilises every plant.
    NotStabilised,
}

/// A structure that was searched.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchedStructure {
    /// Name of the structure; `None` for one of growing order or a given one.
    pub name: Option<NamedStructure>,
    /// Structure with its free numbers.
    pub structure: Structure,
    /// The structure of the prefilter fitted to it; `None` without one.
    pub prefilter: Option<Structure>,
    /// The final free numbers of both; empty if none were found.
    pub free_numbers: Vec<f64>,
    /// Outcome of the search.
    pub ending: StructureEnding,
    /// The final controller; `None` if none was found.
    pub law: Option<Controller>,
    /// The least margin of the plants and frequencies of its search: the binding limit.
    pub least: Option<SpecificationMargin>,
    /// The specifications whose least margins are within [`BINDING_DB`](super::BINDING_DB) of it.
    pub binding: Vec<usize>,
    /// Figure of merit for the comparison with a longer structure, dB, smaller is better: see
    /// [`ControllerChoice::Any`](super::ControllerChoice::Any).
    pub reached_db: Option<f64>,
}

impl SearchedStructure {
    pub(super) fn new(name: Option<NamedStructure>, attempt: &Attempt, ending: &AttemptEnding) -> Self {
        let ending = match ending {
            AttemptEnding::Met(_) => StructureEnding::Met,
            AttemptEnding::Missed { .. } => StructureEnding::Missed,
            AttemptEnding::NotEarned => StructureEnding::NotEarned,
            AttemptEnding::NotConverged(_) => StructureEnding::NotConverged,
            AttemptEnding::NotStabilised => StructureEnding::NotStabilised,
        };
        let has_margins = !attempt.x().is_empty() && ending != StructureEnding::NotStabilised;
        let margins = if has_margins { attempt.shaping().margins(attempt.x()) } else { vec![] };
        let least = margins.iter().min_by(|one, other| one.margin_db.total_cmp(&other.margin_db)).cloned();
        let most_db = least.as_ref().map_or(f64::NEG_INFINITY, |least| least.margin_db + BINDING_DB);
        let binding = margins.iter().filter(|one| one.margin_db <= most_db).map(|one| one.specification);
        SearchedStructure {
            binding: Vec::from_iter(BTreeSet::from_iter(binding)),
            least,
            name,
            structure: attempt.structure().clone(),
            prefilter: attempt.shaping().prefilter().cloned(),
            free_numbers: attempt.x().to_vec(),
            ending,
            law: (!attempt.x().is_empty()).then(|| attempt.shaping().controller(attempt.x())),
            reached_db: if has_margins { attempt.reached_db() } else { None },
        }
    }
}
