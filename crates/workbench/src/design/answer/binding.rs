//! Limits that bind or conflict, in JSON.

use phea_qft::design::DesignStatus;
use phea_qft::verification::SpecificationMargin;

use crate::answer::{Answer, words};
use crate::design::ProjectDesign;
use crate::design::words::searched_limit_name;
use crate::plant_names::NamedPlant;
use crate::project::SpecificationKind;

/// Limit over frequency that binds or conflicts, at the frequency where it does.
#[derive(Answer)]
pub(super) struct BindingLimitAnswer {
    /// Index among the limits of the search, from 0: the specifications over frequency in the order
    /// of the file, then the limits of `[design]`.
    specification: usize,
    /// Name of the limit.
    name: String,
    /// Kind of the specification; empty for a limit of `[design]`.
    kind: BindingLimitKind,
    /// Frequency of the margin; zero or `inf` for a limit towards it.
    frequency_rad_per_s: f64,
    /// Margin; negative if the limit is exceeded.
    margin_db: f64,
    /// Plant with the margin.
    plant: NamedPlant,
}

/// Kind of a specification, or an empty text.
#[derive(Answer)]
enum BindingLimitKind {
    Specification(SpecificationKind),
    Design(KindOfDesignLimit),
}

/// Kind of a limit of `[design]`.
enum KindOfDesignLimit {
    None,
}

words! {
    /// Empty text, since a limit of `[design]` has no kind.
    KindOfDesignLimit { None => "" }
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
        specification,
        name: searched_limit_name(view, view.searched_limit(specification)),
        kind: known.map_or(BindingLimitKind::Design(KindOfDesignLimit::None), |known| {
            let closed_loop = known.requirement.closed_loop();
            BindingLimitKind::Specification(SpecificationKind::ClosedLoop(closed_loop))
        }),
        frequency_rad_per_s: margin.frequency_rad_per_s,
        margin_db: margin.margin_db,
        plant: side.view.names.named(&margin.plant),
    }
}
