//! The rig as it is derived, where the box of its own uncertainty does not contain it.

use super::{ParameterOrigin, ResolvedParameter, Rig};
use crate::project::Project;

/// Relative amount by which a derived value may lie outside bounds that are printed to three
/// digits.
const ROUNDED: f64 = 0.01;

/// The project without its uncertainty, and the parameters that the box does not contain. `None`
/// where the box contains the rig.
pub(crate) fn outside(project: &Project, rig: &Rig) -> Option<(Project, String)> {
    let beyond = |one: &&ResolvedParameter| {
        let slack = ROUNDED * one.derived.abs();
        one.origin == ParameterOrigin::Uncertainty
            && one
                .bounds
                .is_some_and(|[least, most]| one.derived < least - slack || one.derived > most + slack)
    };
    let words = |name: &str, value: f64, bounds: [f64; 2]| {
        let [least, most] = bounds.map(|bound| project.in_words(name, bound));
        format!("{name} is {}, the box has {least} to {most}", project.in_words(name, value))
    };
    let derived = rig.parameters.iter().filter(beyond);
    let mut outside: Vec<String> =
        derived.map(|one| words(one.name, one.derived, one.bounds.unwrap_or_default())).collect();
    outside.extend(project.uncertainty.iter().filter_map(|one| {
        let declared =
            project.number(&one.name).filter(|value| *value < one.minimum || *value > one.maximum)?;
        Some(words(&one.name, declared, [one.minimum, one.maximum]))
    }));
    let operating_point = project.resolved_operating_point();
    let alone = || Project { operating_point, ..project.without_uncertainty() };
    (!outside.is_empty()).then(|| (alone(), outside.join("; ")))
}
