//! Table `[design]`.

use super::Check;
use super::linear_loop::{element_excess, one_element};
use crate::{DeclaredElement, Project, StructureChoice, StructurePart};

/// Largest number of factors of a structure.
const MAXIMUM_PARTS: usize = 40;

pub(super) fn design(project: &Project, check: &mut Check<'_, '_>) {
    let Some(design) = &project.design else { return };
    match design.gain {
        Some([low, high]) if low == 0.0 || high == 0.0 || low.signum() != high.signum() => {
            check.error(
                "design.gain",
                "`gain` must not reach or pass zero: its sign is that of the controller",
            );
        }
        gain => check.ascending("design.gain", gain),
    }
    if design.structure.is_empty() && design.gain.is_some() {
        check.warning("design.gain", "`gain` has no effect without factors in `structure`");
    }
    let is_one = !design.structure.is_empty() || matches!(design.structure_choice, StructureChoice::Named(_));
    if is_one && check.declared("design.maximum_order") {
        let message = "`maximum_order` has no effect: `structure` says which controllers are tried";
        check.warning("design.maximum_order", message);
    }
    let compares = design.structure.is_empty() && design.structure_choice != StructureChoice::Free;
    if !compares && check.declared("design.earned_per_pole") {
        let message = "`earned_per_pole` has no effect: it compares the structures that have a name";
        check.warning("design.earned_per_pole", message);
    }
    let law = project.controller.as_ref().is_some_and(|controller| controller.has_law());
    if project.prefilter.is_some() && !law && check.declared("design.prefilter_maximum_order") {
        let message = "`prefilter_maximum_order` has no effect: [prefilter] is given, and kept";
        check.warning("design.prefilter_maximum_order", message);
    }
    if design.structure.len() > MAXIMUM_PARTS {
        check.error("design.structure", format!("more than {MAXIMUM_PARTS} factors"));
    }
    for (index, one) in design.structure.iter().enumerate() {
        part(one, &format!("design.structure[{index}]"), check);
    }
    if design.structure.iter().map(excess).sum::<i64>() > 0 {
        check.error(
            "design.structure",
            "the structure has more zeros than poles: no controller can be built so",
        );
    }
}

fn part(part: &StructurePart, path: &str, check: &mut Check<'_, '_>) {
    match part {
        StructurePart::Integrator => {}
        StructurePart::Zero { frequency } | StructurePart::Pole { frequency } => {
            check.ascending(&format!("{path}.frequency"), *frequency);
        }
        StructurePart::ZeroPair { frequency, damping_ratio }
        | StructurePart::PolePair { frequency, damping_ratio } => {
            check.ascending(&format!("{path}.frequency"), *frequency);
            check.ascending(&format!("{path}.damping_ratio"), *damping_ratio);
        }
        StructurePart::Fixed { element } => {
            let path = format!("{path}.element");
            if check.declared(&path) {
                fixed(element, &path, check);
            }
        }
    }
}

/// Checks an element that is active, and in s like every factor.
fn fixed(element: &DeclaredElement, path: &str, check: &mut Check<'_, '_>) {
    if !element.enabled {
        check.error(&format!("{path}.enabled"), "a fixed factor always acts and cannot be disabled");
    }
    if element.is_sampled() {
        check.error(path, "this element is in `z`, but factors of a structure are in `s`");
    } else {
        one_element(element, path, None, check);
    }
}

/// Excess of zeros over poles of a factor, if known.
fn excess(part: &StructurePart) -> i64 {
    match part {
        StructurePart::Integrator | StructurePart::Pole { .. } => -1,
        StructurePart::Zero { .. } => 1,
        StructurePart::ZeroPair { .. } => 2,
        StructurePart::PolePair { .. } => -2,
        StructurePart::Fixed { element } => element_excess(element).unwrap_or(0),
    }
}
