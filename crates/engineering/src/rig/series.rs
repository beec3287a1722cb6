use phea_hydraulics::line::{Conduit, StiffeningMember};
use phea_hydraulics::series::{CoilPair, CoilWire, SeriesElement, coil_pair};

use super::Rig;
use crate::project::{DeclaredActuator, SpringCoil};

/// The greatest force in N that the supply pressure gives the piston, in either direction.
pub fn stall_force(rig: &Rig) -> f64 {
    let components = rig.actuator.components();
    let (cylinder, supply) = (&components.cylinder, &components.supply);
    let [retracting, extending] = cylinder.stall_forces(supply);
    extending.max(-retracting)
}

/// The pair of coil springs that is the series spring and holds the stall force; `None` where none
/// is declared.
pub fn series_coil(declared: &DeclaredActuator, rig: &Rig) -> Option<CoilPair> {
    let SeriesElement::Spring(spring) = rig.actuator.components().series.as_ref()? else { return None };
    let coil = declared.series.as_ref()?.spring()?.coil?;
    let SpringCoil { index, allowed_shear_stress, shear_modulus, density } = coil;
    let wire = CoilWire { index, allowed_shear_stress, shear_modulus, density };
    Some(coil_pair(spring.stiffness, stall_force(rig), &wire))
}

/// Up to which frequency in rad/s the waves in the segments of a transmission are at most 3 % slow;
/// `None` without one.
///
/// ```text
/// (2 N/T) sin(w T/2N) = 0.97 w         w = 0.85 N/T
/// ```
pub fn waves_right_to(rig: &Rig) -> Option<f64> {
    let components = rig.actuator.components();
    let SeriesElement::Transmission(transmission) = components.series.as_ref()? else { return None };
    let line = (&transmission.line, &components.fluid);
    let conduit =
        Conduit::of_line(line.0, line.1, transmission.filling_pressure, StiffeningMember::Nominal).ok()?;
    Some(0.85 * transmission.segments as f64 / conduit.delay())
}
