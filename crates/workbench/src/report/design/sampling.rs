//! The effect of sampling and delay on a design that ignores them.

use phea_engineering::design::AuditedController;
use phea_qft::verification::{SpecificationFinding, Verdict};

use crate::document::margin_words;
use crate::specification::numbered;

/// Frequency at which the continuous design is worst compared with the one that takes sampling into
/// account.
pub(super) fn sentence(sampled: &AuditedController, continuous: &AuditedController) -> String {
    let margin = |finding: &SpecificationFinding| finding.worst.as_ref().map(|worst| worst.margin_db);
    let pairs = sampled.view.audit.specifications.iter().zip(&continuous.view.audit.specifications);
    let changes = pairs.enumerate().filter_map(|(index, (here, there))| {
        Some((numbered(sampled.view.named(index)), margin(here)?, margin(there)?))
    });
    let most = changes.min_by(|one, other| (one.2 - one.1).total_cmp(&(other.2 - other.1)));
    let all = "The last column is the design for the continuous loop without delay, sampled and delayed as this loop is.";
    match (continuous.view.audit.verdict, most) {
        (Verdict::Met, _) if continuous.view.misses_in_time() => {
            format!(
                "{all} It satisfies every specification over frequency here too, and misses what is required in time."
            )
        }
        (Verdict::Met, _) => {
            format!("{all} It satisfies every specification here too, without the limits of `[design]`.")
        }
        (_, Some((name, here, there))) => format!(
            "{all} It does not hold here: its margin of {name} is {}, where the design that takes samples and delay into account has {}.",
            margin_words(there),
            margin_words(here)
        ),
        (_, None) => format!("{all} It makes a plant unstable here."),
    }
}
