//! The load on the force sensor at an operating point, over any scalar.

use phea_dynamics::scalar::Scalar;
use phea_hydraulics::actuator::Components;
use phea_hydraulics::linkage::{RodEnd, WeightAt};
use phea_hydraulics::operating_point::OperatingPoint;
use phea_hydraulics::plant::LinearLoad;

use super::declared::DeclaredRig;
use super::place::shortened;
use crate::project::Load;

/// The load's end of the rod at an operating point, and the weight of the load there; `None`
/// without a linkage. The force sensor, and what lies in series with it, is compressed by the force
/// there.
pub fn rod_end<S: Scalar>(
    components: &Components<S>,
    point: &OperatingPoint<S>,
) -> Option<(RodEnd<S>, Option<WeightAt<S>>)> {
    let linkage = components.linkage.as_ref()?;
    let [shortened, _] = shortened(components, point.hydraulic_force);
    let position = point.position - shortened;
    let angle = linkage.angle(position);
    Some((linkage.end(angle), linkage.weight_at(angle)))
}

/// The load at an operating point. It is in contact with a wall where the force, behind a linkage
/// the torque, presses on it, or where there is no gap. Hunt and Crossley's damping K c d of a wall
/// pressed by d = F/K is c F.
pub(crate) fn load_at<S: Scalar>(
    rig: &DeclaredRig<'_, S>,
    components: &Components<S>,
    point: &OperatingPoint<S>,
) -> LinearLoad<S> {
    let (none, force) = (S::from(0.0), point.hydraulic_force);
    let end = rod_end(components, point);
    let pressing = match &end {
        None => force,
        Some((end, weight)) => {
            let torque = force * end.lever_arm;
            weight.map_or(torque, |weight| torque + weight.torque)
        }
    };
    let [mass, stiffness, damping, contact_damping] = match components.load {
        Load::Prescribed | Load::Wall { mass: None, .. } => return LinearLoad::Prescribed,
        Load::SpringMassDamper { mass, stiffness, damping } => [mass, stiffness, damping, none],
        Load::Wall { mass: Some(mass), damping, stiffness: wall, relative_damping, .. } => {
            let touched = S::select(none.less_than(pressing), wall, none);
            let contact_damping = relative_damping * pressing.maximum(none);
            let stiffness = if rig.touches_wall() { wall } else { touched };
            [mass, stiffness, damping, contact_damping]
        }
    };
    let linked = end.map(|(end, weight)| (end.lever_arm, -(force * end.lever_slope), weight));
    let damping = damping + contact_damping;
    match linked {
        None if rig.has_free_mass() => LinearLoad::Free { mass, damping },
        None => LinearLoad::Yielding { mass, damping, stiffness },
        Some((lever_arm, geometric, weight)) => LinearLoad::Linked {
            inertia: mass,
            damping,
            stiffness,
            geometric_stiffness: weight.map_or(geometric, |weight| geometric + weight.stiffness),
            lever_arm,
        },
    }
}
