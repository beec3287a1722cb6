//! Result of a design.

use phea_dynamics::controller::Controller;
use phea_dynamics::order::sort_numbers;

use super::binding::binding_limits;
use super::{DesignOptions, NamedStructure};
use crate::loop_shaping::{SearchProblem, SearchResult, Shaping, Structure};
use crate::verification::{Audit, SpecificationMargin, Verdict};

/// Final status of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignStatus {
    /// The audit finds that every specification is met.
    Met,
    /// The limits cannot be met by any controller found; this is the smallest relaxation under
    /// which one meets them.
    Infeasible(Relaxation),
    /// Search and audit did not agree within the rounds allowed.
    NotConverged {
        /// Number of rounds.
        rounds: usize,
    },
    /// The family is not stabilised by any controller found.
    NotStabilised,
}

/// The smallest common relaxation of all limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation {
    /// Amount by which every upper limit is raised and every lower one reduced, dB.
    pub relaxation_db: f64,
    /// The limits that conflict at this relaxation: the margins to the original limits.
    pub conflicts: Vec<SpecificationMargin>,
}

/// One search with the audit that followed it.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRound {
    /// Shaped structure.
    pub structure: Structure,
    /// Objective of the structure, dB.
    pub objective_db: f64,
    /// Number of plants that the search evaluated.
    pub plants: usize,
    /// Number of frequencies that the search evaluated.
    pub frequencies: usize,
    /// Worst margin on these plants and frequencies, dB.
    pub searched_margin_db: f64,
    /// Worst margin of the audit, dB; `None` if the audit finds the family unstable.
    pub audited_margin_db: Option<f64>,
}

/// Ends of the starts of the last search, which show how much the result depends on them.
#[derive(Clone, Debug, PartialEq)]
pub struct Starts {
    /// Points that the search evaluated before its descents.
    pub evaluated: usize,
    /// Number of these points that stabilise every evaluated plant.
    pub stabilised: usize,
    /// Number of completed descents.
    pub completed: usize,
    /// Worst margin over its rate at the ends of these descents, dB: best, median and worst; `None`
    /// if no descent was completed.
    pub margins_db: Option<[f64; 3]>,
    /// The objective at those ends that satisfy every limit to 0.01 dB, dB: least, median and
    /// greatest; `None` if none does.
    pub objectives_db: Option<[f64; 3]>,
}

/// Violation below which an end of a descent still counts as satisfying its limits, dB.
const KEPT_DB: f64 = 0.01;

impl Starts {
    pub(super) fn of(result: &SearchResult) -> Starts {
        let margins = result.ends.iter().map(|end| -end.judgement.worst_margin_db);
        let cache = result.ends.iter().filter(|end| end.judgement.worst_margin_db >= -KEPT_DB);
        Starts {
            evaluated: result.points,
            stabilised: result.stable_points,
            completed: result.ends.len(),
            margins_db: least_median_greatest(margins.collect()).map(|three| three.map(|one| -one)),
            objectives_db: least_median_greatest(cache.map(|end| end.judgement.objective_db).collect()),
        }
    }
}

/// The median of an even number of values is the lesser of the middle two.
fn least_median_greatest(mut values: Vec<f64>) -> Option<[f64; 3]> {
    sort_numbers(&mut values);
    let middle = *values.get(values.len().saturating_sub(1) / 2)?;
    Some([*values.first()?, middle, *values.last()?])
}

/// A controller, its prefilter, and the audit of both.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Final status of the design.
    pub status: DesignStatus,
    /// Controller, prefilter and timing as deployed and audited: in z with rounded coefficients, if
    /// coefficients are rounded.
    pub controller: Controller,
    /// Controller before sampling and rounding.
    pub law: Controller,
    /// Shaped structure.
    pub structure: Structure,
    /// The structure of its prefilter; `None` if it has none.
    pub prefilter: Option<Structure>,
    /// The free numbers of both structures, one after the other.
    pub free_numbers: Vec<f64>,
    /// Name of the structure; `None` for one of growing order or a given one.
    pub name: Option<NamedStructure>,
    /// Ends of the starts of its last search; `None` before a search has ended.
    pub starts: Option<Starts>,
    /// Objective of the design, dB.
    pub objective_db: f64,
    /// Audit against the original specifications.
    pub audit: Audit,
    /// Audit of each additional plant.
    pub additional_audits: Vec<Audit>,
    /// The active limits, which determine the cost of the specifications, by frequency.
    pub binding: Vec<SpecificationMargin>,
    /// Rounds of search and audit.
    pub rounds: Vec<DesignRound>,
}

impl Design {
    /// True if its audit is inconclusive, which is nearer than missing a limit.
    pub(super) fn is_open(&self) -> bool {
        self.audit.verdict == Verdict::NotProven
    }

    /// Replaces the free numbers and their audit, and updates the status; coefficients are not
    /// rounded.
    pub fn moved(
        self,
        shaping: &Shaping,
        free_numbers: Vec<f64>,
        audit: Audit,
        options: &DesignOptions,
    ) -> Design {
        let law = shaping.controller(&free_numbers);
        let objective_db = shaping.clone().judge(&free_numbers).objective_db;
        let status = match audit.verdict {
            Verdict::Met => DesignStatus::Met,
            Verdict::NotProven | Verdict::Violated => self.status,
        };
        Design {
            status,
            objective_db,
            controller: law.clone(),
            law,
            binding: binding_limits(&audit, options),
            audit,
            free_numbers,
            ..self
        }
    }
}
