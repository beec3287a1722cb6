//! The point about which the linear model is taken: the operating point of the project, over any
//! scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::operating_point::{Steady, SteadyLoad};
use phea_hydraulics::servovalve::SpoolDirection;

use super::declared::DeclaredRig;
use crate::project::{self, Project};

/// The position in m (in rad, of a motor) and the condition for the pressures. At null the piston
/// is blocked; with a command it moves, without load pressure unless one is declared,
/// thesis (4.18); with a velocity there is no load unless one is declared. A load that yields and
/// has a weight is held, unless a load or a command is declared; a free mass takes no force.
pub fn place<S: Scalar>(rig: &DeclaredRig<'_, S>, components: &Components<S>) -> (S, Steady<S>) {
    let project::DeclaredOperatingPoint { position, load_pressure, load_force, velocity, .. } =
        rig.operating_point;
    // a command is never open
    let command = rig.project.operating_point.command;
    let position = position.unwrap_or(components.cylinder.stroke.middle());
    let none = S::from(0.0);
    let at_rest =
        || weight_held(rig.project, components, position).or_else(|| is_free(rig.project).then_some(none));
    let force = load_force.or_else(|| at_rest().filter(|_| command.is_none()));
    let load = load_pressure.map(SteadyLoad::Pressure).or(force.map(SteadyLoad::Force));
    let steady = match (command, load_pressure) {
        (Some(command), Some(pressure)) => Steady::Matched(S::from(command), pressure),
        (Some(command), None) if command != 0.0 => Steady::Matched(S::from(command), none),
        _ if load.is_none() && velocity.is_none() => Steady::Command(none),
        _ => Steady::Moving {
            velocity: velocity.unwrap_or(none),
            load: load.unwrap_or(SteadyLoad::Force(none)),
        },
    };
    (position, steady)
}

/// Whether the load is a mass that no stiffness holds.
fn is_free(project: &Project) -> bool {
    let declared = project.actuator.as_ref().filter(|declared| declared.linkage.is_none());
    declared.is_some_and(|declared| {
        matches!(declared.load, project::Load::SpringMassDamper { stiffness: 0.0, .. })
    })
}

/// The side of null from which the slopes of a spool at null are taken; without a stated one their
/// mean is the nominal plant.
pub(crate) fn spool_side<S: Scalar>(rig: &DeclaredRig<'_, S>) -> SpoolDirection<S> {
    SpoolDirection::Between(rig.operating_point.spool_side.unwrap_or_default())
}

/// The force that holds the weight of a load that yields; `None` where there is none.
fn weight_held<S: Scalar>(project: &Project, components: &Components<S>, position: S) -> Option<S> {
    let declared = project.actuator.as_ref().filter(|declared| declared.load != project::Load::Prescribed);
    let linkage = declared.and(components.linkage.as_ref())?;
    linkage.holding_force(position, |force| shortened(components, force))
}

/// How far force sensor and what lies in series with it are compressed by a force in N, in m, and
/// the slope in m/N.
pub(super) fn shortened<S: Scalar>(components: &Components<S>, force: S) -> [S; 2] {
    let compliance = S::from(1.0) / components.force_sensor.stiffness;
    let [own, slope] = components
        .series
        .as_ref()
        .map_or([S::from(0.0); 2], |series| series.held_deflection(force, &components.fluid));
    [force * compliance + own, compliance + slope]
}
