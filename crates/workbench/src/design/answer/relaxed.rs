//! The gain from relaxing each limit that binds, in JSON.

use phea_engineering::design::{
    DesignLimitKind, Gained, ProjectDesign, RELAXED_BY, RelaxedGain, RelaxedLimit,
};

use crate::answer::{Answer, Keyed};
use crate::design::relaxed::name;
use crate::limit_kind::{LimitValueKeys, in_limit_unit};

/// Gain from relaxing one limit, as the last search finds it from its result, without an audit.
#[derive(Answer)]
pub(super) struct RelaxationAnswer {
    #[answer(flatten)]
    limit: RelaxedLimitAnswer,
    /// Name of the limit.
    name: String,
    /// Fraction by which the limit is wider.
    relaxed_by: f64,
    #[answer(flatten)]
    gain: RelaxationGainAnswer,
}

/// Limit that is relaxed.
#[derive(Answer)]
enum RelaxedLimitAnswer {
    Specification {
        /// Index of the specification over frequency, from 0 in the order of the file.
        specification: usize,
    },
    Step {
        /// Number of the specification of a required step, from 1 in the order of the file.
        #[answer(optional)]
        number: Option<usize>,
    },
    Design {
        /// Limit in `[design]`.
        key: DesignLimitKind,
    },
}

/// Limit of `[design]` with the relaxed value, and the gain from it.
#[derive(Answer)]
pub(super) struct RelaxedValueAnswer {
    #[answer(flatten)]
    value: Keyed<LimitValueKeys, f64>,
    #[answer(flatten)]
    gain: RelaxationGainAnswer,
}

/// Gain from a relaxed limit.
#[derive(Answer)]
struct RelaxationGainAnswer {
    #[answer(flatten)]
    gained: GainedAnswer,
    /// Reduction of the largest gain from sensor noise to the command of the nominal loop; negative
    /// if it rises, left out if it is unknown.
    #[answer(optional)]
    noise_gained_db: Option<f64>,
}

/// Gain in the quantity that a search optimises.
#[derive(Answer)]
enum GainedAnswer {
    Objective {
        /// Reduction of the objective, of a design that satisfies its limits.
        objective_gained_db: f64,
    },
    WorstMargin {
        /// Increase of the worst margin, of a design for the best one or one that violates a limit.
        worst_margin_gained_db: f64,
    },
}

/// Each limit that binds.
pub(super) fn rows(view: &ProjectDesign) -> Vec<RelaxationAnswer> {
    let row = |one: &RelaxedGain| RelaxationAnswer {
        limit: match one.limit {
            RelaxedLimit::Specification(specification) => RelaxedLimitAnswer::Specification { specification },
            RelaxedLimit::Steps(index) => {
                let finding = view.designed.view.in_time.get(index);
                RelaxedLimitAnswer::Step { number: finding.map(|finding| finding.requirement.number) }
            }
            RelaxedLimit::Design(key) => RelaxedLimitAnswer::Design { key },
        },
        name: name(view, one.limit),
        relaxed_by: RELAXED_BY,
        gain: gain(view, one),
    };
    view.relaxations.limits.iter().map(row).collect()
}

/// The relaxed value of a limit of `[design]`; `None` if the limit does not bind.
pub(super) fn of_limit(
    view: &ProjectDesign,
    kind: DesignLimitKind,
    value: f64,
) -> Option<RelaxedValueAnswer> {
    let found = view.relaxations.limits.iter().find(|one| one.limit == RelaxedLimit::Design(kind))?;
    Some(RelaxedValueAnswer { value: in_limit_unit(kind, kind.relaxed(value)), gain: gain(view, found) })
}

fn gain(view: &ProjectDesign, one: &RelaxedGain) -> RelaxationGainAnswer {
    let gained_db = one.gained_db;
    RelaxationGainAnswer {
        gained: match view.relaxations.of {
            Gained::Objective => GainedAnswer::Objective { objective_gained_db: gained_db },
            Gained::WorstMargin => GainedAnswer::WorstMargin { worst_margin_gained_db: gained_db },
        },
        noise_gained_db: one.noise_gained_db,
    }
}
