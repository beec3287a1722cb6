//! The rounds of search and audit, and the starts of the last search, in JSON.

use phea_qft::design::{Design, DesignRound, Starts};

use super::law::{StructureAnswer, structure};
use crate::answer::Answer;

/// Search with the audit that followed it.
#[derive(Answer)]
pub(super) struct DesignRoundAnswer {
    /// Structure whose numbers were searched for.
    structure: StructureAnswer,
    /// Objective of the result.
    objective_db: f64,
    /// Number of plants that the search evaluated.
    plants: usize,
    /// Number of frequencies that the search evaluated.
    frequencies: usize,
    /// Worst margin on these plants and frequencies.
    searched_margin_db: f64,
    /// Worst margin of the audit; null if the audit finds an unstable plant.
    audited_margin_db: Option<f64>,
    /// Reason for which the audit has no margin.
    #[answer(optional)]
    reason: Option<&'static str>,
}

/// Starts of the last search, which show how much the result depends on them; of three numbers the
/// best, the median and the worst.
#[derive(Answer)]
pub(super) struct SearchStartsAnswer {
    /// Number of points that the search evaluated before its descents.
    evaluated: usize,
    /// Number of these points that make every evaluated plant stable.
    stabilised: usize,
    /// Number of completed descents.
    completed: usize,
    /// Worst margin at the ends of the descents; null if no descent was completed.
    worst_margin_db: Option<[f64; 3]>,
    /// Objective at the ends that satisfy every limit; null if none does.
    objective_db: Option<[f64; 3]>,
}

/// The rounds of a design.
pub(super) fn rounds(design: &Design) -> Vec<DesignRoundAnswer> {
    design.rounds.iter().map(round).collect()
}

fn round(round: &DesignRound) -> DesignRoundAnswer {
    DesignRoundAnswer {
        structure: structure(&round.structure, None),
        objective_db: round.objective_db,
        plants: round.plants,
        frequencies: round.frequencies,
        searched_margin_db: round.searched_margin_db,
        audited_margin_db: round.audited_margin_db,
        reason: round.audited_margin_db.is_none().then_some("the audit finds an unstable plant"),
    }
}

/// The starts of a search.
pub(super) fn starts(starts: &Starts) -> SearchStartsAnswer {
    SearchStartsAnswer {
        evaluated: starts.evaluated,
        stabilised: starts.stabilised,
        completed: starts.completed,
        worst_margin_db: starts.margins_db,
        objective_db: starts.objectives_db,
    }
}
