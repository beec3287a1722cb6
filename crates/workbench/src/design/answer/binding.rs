//! Limits that bind or conflict, in JSON.

use phea_qft::design::DesignStatus;
use phea_qft::verification::SpecificationMargin;

use crate::answer::{Answer, OrReason};
use crate::design::ProjectDesign;
use crate::design::words::searched_limit_name;
use crate::plant_names::NamedPlant;
use crate::project::SpecificationKind;

/// Limit over frequency that binds or conflicts, at the frequency where it does.
#[derive(Answer)]
pub(super) struct BindingLimitAnswer {
    /// Number of the limit of the search, from 1: the specifications over frequency in the order of
    /// the file, then the limits of `[design]`.
    specification: usize,
    /// Name of the limit.
    name: String,
    /// Kind of the specification.
    kind: OrReason<SpecificationKind>,
    /// Frequency of the margin; zero or `inf` for a limit towards it.
    frequency_rad_per_s: f64,
    /// Margin; negative if the limit is exceeded.
    margin_db: f64,
    /// Plant with the margin.
    plant: NamedPlant,
}

/// The limits that bind.
pub(super) fn binding(view: &ProjectDesign) -> Vec<BindingLimitAnswer> {
    view.design.binding.iter().map(|limit| row(view, limit)).collect()
}

/// The limits that conflict where the search finds nothing better; empty unless the design is
/// infeasible.
pub(super) fn conflicts(view: &ProjectDesign) -> Vec<BindingLimitAnswer> {
    let DesignStatus::Infeasible(relaxation) = &view.design.status else { return vec![] };
    relaxation.conflicts.iter().map(|conflict| row(view, conflict)).collect()
}

fn row(view: &ProjectDesign, margin: &SpecificationMargin) -> BindingLimitAnswer {
    let (side, specification) = (&view.designed, margin.specification);
    let known = side.problem.specifications.get(specification);
    BindingLimitAnswer {
        specification: specification + 1,
        name: searched_limit_name(view, view.searched_limit(specification)),
        kind: OrReason::new(
            known.map(|known| SpecificationKind::ClosedLoop(known.requirement.closed_loop())),
            "a limit of [design] is not a specification",
        ),
        frequency_rad_per_s: margin.frequency_rad_per_s,
        margin_db: margin.margin_db,
        plant: side.view.names.named(&margin.plant),
    }
}
