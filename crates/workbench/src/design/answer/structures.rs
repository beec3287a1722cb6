//! The structures that a design evaluated, in JSON.

use phea_dynamics::controller::NamedStructure;
use phea_engineering::design::{LedBy, ProjectDesign, ReachedStructure};
use phea_qft::design::StructureEnding;

use super::side::{CrossoverAnswer, crossovers};
use crate::answer::{Answer, words};
use crate::design::structures::{binding, misses_in_time, reached_steps};
use crate::design::words::reached_words;

/// Structure that was designed, with the result.
#[derive(Answer)]
pub(super) struct ReachedStructureAnswer {
    /// Name of the structure, only if it has one.
    #[answer(optional)]
    name: Option<NamedStructure>,
    /// Structure in words, as it was found.
    words: String,
    /// Number of poles.
    order: usize,
    /// Outcome for the structure.
    status: StructureOutcome,
    /// True if the design has this structure.
    taken: bool,
    /// Lowest frequency at which a zero was searched for, only if a zero is at this frequency.
    #[answer(optional)]
    slowest_zero_rad_per_s: Option<f64>,
    /// Least margin over the plants and frequencies that the search evaluated; left out if no
    /// controller makes these plants stable.
    #[answer(optional)]
    worst_margin_db: Option<f64>,
    /// Limit with this margin, only if it leaves the loop no room.
    #[answer(optional)]
    binding: Option<String>,
    /// Frequency of this margin.
    #[answer(optional)]
    binding_rad_per_s: Option<f64>,
    #[answer(flatten)]
    crossovers: Option<CrossoverAnswer>,
    /// Least additional dead time that makes the nominal loop unstable; left out unless the loop is
    /// known to be stable.
    #[answer(optional)]
    delay_margin_s: Option<f64>,
    /// Limit of s^r G(s) for the relative degree r; left out without a controller.
    #[answer(optional)]
    high_frequency_gain_db: Option<f64>,
    /// Number of poles in excess of zeros.
    relative_degree: i32,
    /// Quantity by which structures are compared, the less the better: the largest gain from sensor
    /// noise to the command of the nominal loop, or the objective.
    #[answer(optional)]
    compared_db: Option<f64>,
    /// Greatest overshoot of the linear steps, of the step: of the structure that is taken over the
    /// whole family, of others over some of its members; only if one is required.
    #[answer(optional)]
    worst_overshoot_percent: Option<f64>,
    /// Longest settling time of the linear steps of the same plants, `inf` if a step does not
    /// settle; only if one is required.
    #[answer(optional)]
    worst_settling_time_s: Option<f64>,
    /// Longest rise from 10 to 90 percent of the linear steps of the same plants, `inf` if a step
    /// does not rise; only if one is required.
    #[answer(optional)]
    worst_rise_time_s: Option<f64>,
}

/// Outcome of the search with a structure.
enum StructureOutcome {
    Met,
    MissedInTime,
    Missed,
    NotEarned,
    NotConverged,
    NotStabilised,
}

words! {
    /// Outcome of the search with a structure: limits satisfied, steps missed in time, limits
    /// missed, given up since it is not worth its poles, no agreement of search and audit, or no
    /// controller that makes every plant stable.
    StructureOutcome {
        Met => "met",
        MissedInTime => "missed_in_time",
        Missed => "missed",
        NotEarned => "not_earned",
        NotConverged => "not_converged",
        NotStabilised => "not_stabilised",
    }
}

words! {
    /// Requirements that led the last search: limits over frequency, the steps of the linear loop,
    /// or these steps with what the runs of the nonlinear rig added.
    LedBy {
        Frequency => "frequency",
        LinearSteps => "linear_steps",
        NonlinearRuns => "nonlinear_runs",
    }
}

/// The structures.
pub(super) fn rows(view: &ProjectDesign) -> Vec<ReachedStructureAnswer> {
    view.structures.iter().map(|one| row(view, one)).collect()
}

fn row(view: &ProjectDesign, one: &ReachedStructure) -> ReachedStructureAnswer {
    let [worst_overshoot_percent, worst_settling_time_s, worst_rise_time_s] =
        reached_steps(view, one).unwrap_or_default();
    ReachedStructureAnswer {
        name: one.name,
        words: reached_words(one),
        order: one.order,
        status: outcome(view, one),
        taken: one.is_chosen,
        slowest_zero_rad_per_s: one.slowest_zero_rad_per_s,
        worst_margin_db: one.least.as_ref().map(|least| least.margin_db),
        binding: binding(view, one),
        binding_rad_per_s: one.least.as_ref().map(|least| least.frequency_rad_per_s),
        crossovers: one.nominal.as_ref().map(|own| crossovers(Some(own))),
        delay_margin_s: one.nominal.map(|margins| margins.delay_margin_s),
        high_frequency_gain_db: one.high_frequency_gain_db,
        relative_degree: one.relative_degree,
        compared_db: one.compared_db,
        worst_overshoot_percent,
        worst_settling_time_s,
        worst_rise_time_s,
    }
}

fn outcome(view: &ProjectDesign, one: &ReachedStructure) -> StructureOutcome {
    match one.ending {
        _ if misses_in_time(view, one) || one.misses_on_rig => StructureOutcome::MissedInTime,
        StructureEnding::Met if one.is_chosen && view.misses_on_rig() => StructureOutcome::MissedInTime,
        StructureEnding::Met => StructureOutcome::Met,
        StructureEnding::Missed => StructureOutcome::Missed,
        StructureEnding::NotEarned => StructureOutcome::NotEarned,
        StructureEnding::NotConverged => StructureOutcome::NotConverged,
        StructureEnding::NotStabilised => StructureOutcome::NotStabilised,
    }
}
