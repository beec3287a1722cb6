//! What a design ends with.

use phea_dynamics::controller::Controller;
use phea_dynamics::order::sort_numbers;

use super::binding::binding_limits;
use super::{DesignOptions, NamedStructure};
use crate::loop_shaping::{SearchProblem, SearchResult, Shaping, Structure};
use crate::verification::{Audit, SpecificationMargin, Verdict};

/// Why a design ended.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignStatus {
    /// The audit finds that every specification is met.
    Met,
    /// No controller that was tried meets every specification; this is the smallest relaxation
    /// under which one does.
    Infeasible(Relaxation),
    /// The audit could not be brought to agree within the rounds allowed.
    NotConverged {
        /// How many rounds were made.
        rounds: usize,
    },
    /// None of the controllers that were tried stabilises the family.
    NotStabilised,
}

/// The smallest common relaxation of all limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation {
    /// dB by which every upper limit is raised and every lower one lowered.
    pub relaxation_db: f64,
    /// The limits that conflict at this relaxation: the margins to the original limits.
    pub conflicts: Vec<SpecificationMargin>,
}

/// One search with the audit that followed it.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignRound {
    /// What was shaped.
    pub structure: Structure,
    /// Its objective, dB.
    pub objective_db: f64,
    /// Number of plants that the search evaluated.
    pub plants: usize,
    /// Number of frequencies that the search evaluated.
    pub frequencies: usize,
    /// Worst margin on them, dB.
    pub searched_margin_db: f64,
    /// Worst margin of the audit, dB; `None` where the audit finds the family unstable.
    pub audited_margin_db: Option<f64>,
}

/// Where the starts of the last search ended, which shows how much the result depends on them.
#[derive(Clone, Debug, PartialEq)]
pub struct Starts {
    /// Points that the search evaluated before its descents.
    pub tried: usize,
    /// How many of them stabilise every plant that was evaluated.
    pub stabilised: usize,
    /// Number of completed descents.
    pub ended: usize,
    /// Worst margin over its rate at the ends of these descents, dB: best, median and worst; `None`
    /// if no descent was completed.
    pub margins_db: Option<[f64; 3]>,
    /// The objective at those ends that satisfy every limit to 0.01 dB, dB: least, median and
    /// greatest; `None` if none does.
    pub objectives_db: Option<[f64; 3]>,
}

/// An end that misses its limits by less than this satisfies them, dB.
const KEPT_DB: f64 = 0.01;

impl Starts {
    pub(super) fn of(result: &SearchResult) -> Starts {
        let margins = result.ends.iter().map(|end| -end.judgement.worst_margin_db);
        let kept = result.ends.iter().filter(|end| end.judgement.worst_margin_db >= -KEPT_DB);
        Starts {
            tried: result.points,
            stabilised: result.stable_points,
            ended: result.ends.len(),
            margins_db: least_median_greatest(margins.collect()).map(|three| three.map(|one| -one)),
            objectives_db: least_median_greatest(kept.map(|end| end.judgement.objective_db).collect()),
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
    /// Why it ended.
    pub status: DesignStatus,
    /// Controller, prefilter and timing as they are deployed and were audited: in z with rounded
    /// coefficients, where coefficients are rounded.
    pub controller: Controller,
    /// The same before it was sampled and rounded.
    pub law: Controller,
    /// What was shaped.
    pub structure: Structure,
    /// The structure of its prefilter; `None` where it has none.
    pub prefilter: Option<Structure>,
    /// The free numbers of both structures, one after the other.
    pub free_numbers: Vec<f64>,
    /// Its name; `None` for one of growing order or a given one.
    pub name: Option<NamedStructure>,
    /// Where the starts of its last search ended; `None` before a search has ended.
    pub starts: Option<Starts>,
    /// Its objective, dB.
    pub objective_db: f64,
    /// Its audit against the original specifications.
    pub audit: Audit,
    /// The same for each additional plant.
    pub beside: Vec<Audit>,
    /// The limits that it touches, which is what the specifications cost, by frequency.
    pub binding: Vec<SpecificationMargin>,
    /// How it came about.
    pub rounds: Vec<DesignRound>,
}

impl Design {
    /// Whether its audit decides nothing, which is nearer than missing a limit.
    pub(super) fn is_open(&self) -> bool {
        self.audit.verdict == Verdict::NotProven
    }

    /// The same structures with other free numbers and their audit, as one that is met or not; its
    /// coefficients are not rounded.
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
