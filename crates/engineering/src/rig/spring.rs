use phea_hydraulics::series::{CoilPair, CoilWire, SeriesElement, coil_pair};

use super::Rig;
use crate::project::{DeclaredActuator, SpringCoil};

/// The greatest force in N that the supply pressure gives the piston, in either direction.
pub(crate) fn stall_force(rig: &Rig) -> f64 {
    let components = rig.actuator.components();
    let (cylinder, supply) = (&components.cylinder, &components.supply);
    let [retracting, extending] = cylinder.stall_forces(supply);
    extending.max(-retracting)
}

/// The pair of coil springs that is the series spring and holds the stall force; `None` where none
/// is declared.
pub(crate) fn series_coil(declared: &DeclaredActuator, rig: &Rig) -> Option<CoilPair> {
    let SeriesElement::Spring(spring) = rig.actuator.components().series.as_ref()? else { return None };
    let coil = declared.series.as_ref()?.spring()?.coil?;
    let SpringCoil { index, allowed_shear_stress, shear_modulus, density } = coil;
    let wire = CoilWire { index, allowed_shear_stress, shear_modulus, density };
    Some(coil_pair(spring.stiffness, stall_force(rig), &wire))
}
