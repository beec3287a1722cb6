//! The rig as it is derived, where the box of its own uncertainty does not contain it.

use super::{ParameterOrigin, ResolvedParameter, Rig};
use crate::project::Project;
use crate::quantity::Dimension;

/// Relative amount by which a derived value may lie outside bounds that are printed to three
/// digits.
const ROUNDED: f64 = 0.01;

/// A parameter of the rig that the box of its uncertainty does not contain.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideParameter {
    /// Path of the number in the project, or name of the linear parameter.
    pub name: String,
    /// Value of the rig, SI.
    pub value: f64,
    /// Least and greatest value of the box, SI.
    pub bounds: [f64; 2],
    /// Dimension; `None` where the project has no number of this name.
    pub dimension: Option<&'static Dimension>,
}

/// The project without its uncertainty, and the parameters that the box does not contain. `None`
/// where the box contains the rig.
pub(crate) fn outside(project: &Project, rig: &Rig) -> Option<(Project, Vec<OutsideParameter>)> {
    let beyond = |one: &&ResolvedParameter| {
        let slack = ROUNDED * one.derived.abs();
        one.origin == ParameterOrigin::Uncertainty
            && one
                .bounds
                .is_some_and(|[least, most]| one.derived < least - slack || one.derived > most + slack)
    };
    let dimensions = project.dimensions();
    let found = |name: &str, value: f64, bounds: [f64; 2]| OutsideParameter {
        name: name.to_string(),
        value,
        bounds,
        dimension: dimensions.get(name).copied(),
    };
    let derived = rig.parameters.iter().filter(beyond);
    let mut outside: Vec<OutsideParameter> =
        derived.map(|one| found(one.name, one.derived, one.bounds.unwrap_or_default())).collect();
    outside.extend(project.uncertainty.iter().filter_map(|one| {
        let declared =
            project.number(&one.name).filter(|value| *value < one.minimum || *value > one.maximum)?;
        Some(found(&one.name, declared, [one.minimum, one.maximum]))
    }));
    let operating_point = project.resolved_operating_point();
    let alone = || Project { operating_point, ..project.without_uncertainty() };
    (!outside.is_empty()).then(|| (alone(), outside))
}
