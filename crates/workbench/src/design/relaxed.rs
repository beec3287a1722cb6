//! The gain from relaxing each limit that binds.

use phea_engineering::design::{DesignLimitKind, Gained, RELAXED_BY, RelaxedGain, RelaxedLimit};
use phea_qft::design::{DesignStatus, Objective};
use phea_qft::specification::Limit;

use super::ProjectDesign;
use crate::answer::significant;
use crate::document::Document;
use crate::limit_kind::limit_words;
use crate::quantity::DisplayUnit;
use crate::simulate::required_words;
use crate::specification::numbered;

/// A gain below this is within the accuracy of the search, dB.
const ACCURACY_DB: f64 = 0.01;

/// A sentence for each limit; empty if none binds.
pub(super) fn document(view: &ProjectDesign) -> Document {
    let mut out = Document::default();
    if view.relaxations.limits.is_empty() {
        return out;
    }
    out.heading("What relaxing a limit would buy");
    out.explanation(
        "The last search, continued from the controller that it found with nothing but this limit wider by a tenth: same structure, same plants and frequencies, without an audit. It finds a local optimum: another start or structure may gain more.",
    );
    out.sentences(view.relaxations.limits.iter().map(|one| sentence(view, one)));
    out
}

/// The name of a limit.
pub(super) fn name(view: &ProjectDesign, limit: RelaxedLimit) -> String {
    match limit {
        RelaxedLimit::Specification(index) => numbered(view.designed.view.named(index)),
        RelaxedLimit::Steps(_) => "required step".to_string(),
        RelaxedLimit::Design(kind) => limit_words(kind).to_string(),
    }
}

fn sentence(view: &ProjectDesign, one: &RelaxedGain) -> String {
    let name = match one.limit {
        RelaxedLimit::Specification(_) => name(view, one.limit),
        RelaxedLimit::Steps(_) | RelaxedLimit::Design(_) => format!("the {}", name(view, one.limit)),
    };
    let effect = match one.gained_db {
        gained_db if gained_db < ACCURACY_DB => {
            "gains nothing that a search from here finds: other limits bind too".to_string()
        }
        gained_db => bought(view, gained_db, one.noise_gained_db),
    };
    format!("relaxing {name} {} {effect}", relaxed(view, one.limit))
}

/// The present value of a limit and its relaxed one.
fn relaxed(view: &ProjectDesign, limit: RelaxedLimit) -> String {
    let by = format!("by {} %", significant(100.0 * RELAXED_BY, 2));
    let values = match limit {
        RelaxedLimit::Specification(index) => {
            let specification = view.designed.problem.specifications.get(index);
            specification.and_then(|one| match one.requirement.limits() {
                (None, Limit::Constant(limit)) => Some([*limit, (1.0 + RELAXED_BY) * limit]),
                _ => None,
            })
        }
        RelaxedLimit::Steps(index) => {
            let finding = view.designed.view.in_time.get(index);
            return finding.map_or(by, |found| {
                format!("to {}", required_words(&found.requirement.step_limits.wider(1.0 + RELAXED_BY)))
            });
        }
        RelaxedLimit::Design(kind) => {
            let known = view.limits.iter().find(|limit| limit.kind == kind);
            known.map(|limit| [limit.value, kind.relaxed(limit.value)])
        }
    };
    let words = |value: f64| match limit {
        RelaxedLimit::Design(kind) => value_words(kind, value),
        RelaxedLimit::Specification(_) | RelaxedLimit::Steps(_) => significant(value, 3).to_string(),
    };
    values.map_or(by, |[from, to]| format!("from {} to {}", words(from), words(to)))
}

fn value_words(kind: DesignLimitKind, value: f64) -> String {
    match kind {
        DesignLimitKind::NoiseToCommand | DesignLimitKind::CommandOfSteps => {
            format!("{} %", significant(100.0 * value, 3))
        }
        DesignLimitKind::HighestBandwidth | DesignLimitKind::FastestPole => {
            format!("{} rad/s", significant(value, 3))
        }
        DesignLimitKind::MinimumDelayMargin => DisplayUnit::MILLISECOND.text(value, 3),
        DesignLimitKind::ModulusMargin
        | DesignLimitKind::PoleDampingRatio
        | DesignLimitKind::PrefilterGain
        | DesignLimitKind::RequiredStep => significant(value, 3).to_string(),
    }
}

/// The gain, in words.
fn bought(view: &ProjectDesign, gained_db: f64, noise_gained_db: Option<f64>) -> String {
    let gained = format!("{} dB", significant(gained_db, 2));
    match (view.relaxations.of, view.options.objective, &view.design.status) {
        (Gained::Objective, Objective::LeastBandwidth, _) => format!("would lower the bandwidth by {gained}"),
        (Gained::Objective, ..) => {
            let noise = noise_gained_db.map(|gained_db| match gained_db {
                lower if lower >= 0.0 => format!(", and the noise gain by {} dB", significant(lower, 2)),
                higher => format!(", though the noise gain would rise by {} dB", significant(-higher, 2)),
            });
            format!("would lower the high-frequency gain by {gained}{}", noise.unwrap_or_default())
        }
        (Gained::WorstMargin, _, DesignStatus::Infeasible(missed)) if gained_db >= missed.relaxation_db => {
            let left = significant(gained_db - missed.relaxation_db, 2);
            format!("would satisfy every limit, with {left} dB to spare")
        }
        (Gained::WorstMargin, _, DesignStatus::Infeasible(missed)) => {
            let missing = significant(missed.relaxation_db, 3);
            format!("would return {gained} of the {missing} dB that every limit lacks")
        }
        (Gained::WorstMargin, Objective::BestWorstMargin, _) if view.is_met() => {
            format!("would raise the worst margin by {gained}")
        }
        (Gained::WorstMargin, ..) => format!("would return {gained} of what the worst margin lacks"),
    }
}
