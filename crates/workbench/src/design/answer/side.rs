//! A controller with its audit and the figures of its loop, in JSON.

use phea_engineering::design::{AuditedController, NominalMargins};

use super::law::{FactoredLawAnswer, factors};
use crate::answer::{Answer, OrReason, words};
use crate::audit::{self, AuditAnswer};

/// Controller and prefilter with their audit.
#[derive(Answer)]
pub(super) struct AuditedControllerAnswer {
    /// Controller G.
    controller: FactoredLawAnswer,
    /// Prefilter F; 1 if the loop has none.
    prefilter: FactoredLawAnswer,
    /// Figures by which controllers are compared.
    figures: LoopFiguresAnswer,
    /// Audit over the family and the frequency band.
    verification: AuditAnswer,
}

/// Figures by which controllers are compared, in addition to their verdicts.
#[derive(Answer)]
pub(super) struct LoopFiguresAnswer {
    /// Number of poles of the controller, of the continuous law if it is sampled.
    order: usize,
    /// Number of poles of the same controller in excess of its zeros.
    relative_degree: i64,
    /// Number of poles of the prefilter, of the continuous one if it is sampled.
    prefilter_order: usize,
    /// Limit of s^r G(s) for the relative degree r; for a law in z |G| at half the sample rate.
    high_frequency_gain_db: f64,
    /// Law to which `high_frequency_gain_db` belongs.
    high_frequency_gain_of: HighFrequencyLaw,
    /// Least |1 + L| of the family; null unless every plant is known to be stable.
    modulus_margin: Option<f64>,
    /// Factor by which the gain of the nominal loop may grow; null unless it is known to be stable.
    gain_margin_db: Option<f64>,
    /// Factor to which the gain of the nominal loop may fall, negative; `-inf` if it may vanish,
    /// null unless the loop is known to be stable.
    gain_reduction_db: Option<f64>,
    /// Phase margin of the nominal loop; null unless it is known to be stable.
    phase_margin_deg: Option<f64>,
    #[answer(flatten)]
    crossovers: CrossoverAnswer,
    /// Reason for which margins are absent.
    #[answer(optional)]
    reason: Option<&'static str>,
}

/// Form of a law whose gain at high frequency is given.
enum HighFrequencyLaw {
    InZ,
    Continuous,
}

words! {
    /// Form of a law whose gain at high frequency is given.
    HighFrequencyLaw { InZ => "law_in_z", Continuous => "continuous_law" }
}

/// Frequencies at which |L| of the nominal loop is 1.
#[derive(Answer)]
pub(super) struct CrossoverAnswer {
    /// Highest frequency at which |L| is 1, zero if |L| is never 1; null unless the loop is known
    /// to be stable.
    crossover_rad_per_s: Option<f64>,
    /// First frequency at which |L| falls through 1.
    first_crossover_rad_per_s: OrReason<f64>,
    /// Lowest and highest frequency above the first crossover at which |L| is 1 again, the highest
    /// `inf` if |L| remains above 1; left out if |L| remains below 1.
    #[answer(optional, interval)]
    above_again_rad_per_s: Option<[f64; 2]>,
}

/// A controller with its audit.
pub(super) fn audited(side: &AuditedController) -> AuditedControllerAnswer {
    AuditedControllerAnswer {
        controller: factors(side.problem.compensation.feedback()),
        prefilter: factors(side.problem.compensation.prefilter()),
        figures: figures(side),
        verification: audit::body(&side.view),
    }
}

/// The figures of a loop.
pub(super) fn figures(side: &AuditedController) -> LoopFiguresAnswer {
    let figures = &side.figures;
    let nominal = figures.nominal.as_ref();
    let is_missing = figures.modulus_margin.is_none() || nominal.is_none();
    LoopFiguresAnswer {
        order: figures.order,
        relative_degree: figures.relative_degree,
        prefilter_order: figures.prefilter_order,
        high_frequency_gain_db: figures.high_frequency_gain_db,
        high_frequency_gain_of: match side.is_in_z() {
            true => HighFrequencyLaw::InZ,
            false => HighFrequencyLaw::Continuous,
        },
        modulus_margin: figures.modulus_margin,
        gain_margin_db: nominal.map(|margins| margins.gain_margin_db),
        gain_reduction_db: nominal.map(|margins| margins.gain_reduction_db),
        phase_margin_deg: nominal.map(|margins| margins.phase_margin_deg),
        crossovers: crossovers(nominal),
        reason: is_missing.then_some("the loop is not known to be stable"),
    }
}

/// The frequencies at which |L| of the nominal loop is 1.
pub(super) fn crossovers(nominal: Option<&NominalMargins>) -> CrossoverAnswer {
    let crossovers = nominal.map(|margins| margins.crossovers).unwrap_or_default();
    let none = match nominal {
        Some(_) => "|L| does not fall through 1",
        None => "the loop is not known to be stable",
    };
    CrossoverAnswer {
        crossover_rad_per_s: nominal.map(|margins| margins.crossover_rad_per_s),
        first_crossover_rad_per_s: OrReason::new(crossovers.first_rad_per_s, none),
        above_again_rad_per_s: crossovers.again_rad_per_s,
    }
}
