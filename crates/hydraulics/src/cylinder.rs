//! Cylinder, or the motor in its place: areas, stroke, moving mass and chamber volumes, symmetric
//! or not.

mod checks;
mod component;
mod keys;
mod motor_keys;

pub use keys::{DeclaredCylinder, DeclaredStage};
pub(crate) use motor_keys::CASE_LEAKAGE_KEY;
pub use motor_keys::DeclaredMotor;

use phea_dynamics::scalar::{Parameters, Scalar};

use crate::contact::Contact;
use crate::parameter::{ParameterError, Problems};
use crate::servovalve::Supply;
use crate::stroke::{ActuatorStroke, STROKE_KEY};

/// Double-acting cylinder. Units: m2, m, kg, m3.
///
/// The piston position x runs from 0 at the A end to the stroke at the B end, so chamber A grows
/// with x.
///
/// A hydraulic motor has these equations too: both areas are its displacement in m3/rad, x is its
/// angle in rad, the mass its inertia in kg m2, every force a torque in N m and every stiffness one
/// in N m/rad. A vane actuator has a stroke in rad; a motor that rotates without limit has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<S = f64> {
    /// Piston area on the A side, A_A, m2; of the first stage of a telescopic piston.
    pub area_a: S,
    /// Piston area on the B side, A_B, m2; of the first stage of a telescopic piston.
    pub area_b: S,
    /// Stroke L in m, or none.
    pub stroke: ActuatorStroke<S>,
    /// Mass M of piston, rods and everything fixed to them up to the force sensor, kg.
    pub moving_mass: S,
    /// Volume of chamber A that the piston never sweeps, without the line, m3.
    pub dead_volume_a: S,
    /// Volume of chamber B that the piston never sweeps, without the line, m3.
    pub dead_volume_b: S,
    /// Laminar leakage across the piston per pressure difference, m3/(s Pa); if absent, the piston
    /// does not leak.
    pub internal_leakage: Option<S>,
    /// Contact at both ends of the stroke. If absent, the ends are only reported.
    pub end_stops: Option<Contact<S>>,
}

impl Cylinder {
    /// Areas A_A and A_B of every stage, the first one first, m2; one pair for a piston that is not
    /// telescopic.
    pub fn areas_of_stages(&self) -> impl Iterator<Item = [f64; 2]> {
        let further = self.stroke.telescope().into_iter().flat_map(|telescope| telescope.stages);
        let of = |[a, b]: [f64; 2]| [self.area_a * a, self.area_b * b];
        std::iter::once([1.0; 2]).chain(further.flatten().map(|stage| stage.ratios)).map(of)
    }

    /// Largest forces that the supply gives the piston as it retracts and as it extends, over all
    /// stages, N:
    ///
    /// ```text
    /// F_min = A_A p_T - A_B p_S          F_max = A_A p_S - A_B p_T
    /// ```
    pub fn stall_forces(&self, supply: &Supply) -> [f64; 2] {
        let Supply { pressure, tank_pressure } = *supply;
        self.areas_of_stages().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], [a, b]| {
            [least.min(a * tank_pressure - b * pressure), most.max(a * pressure - b * tank_pressure)]
        })
    }

    /// Largest A_A and largest A_B of all stages, m2.
    pub fn greatest_areas(&self) -> [f64; 2] {
        self.areas_of_stages().fold([0.0; 2], |[a, b], [own_a, own_b]| [own_a.max(a), own_b.max(b)])
    }

    /// Invalid parameters of this cylinder; empty if all are valid.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("area_a", self.area_a);
        problems.positive("area_b", self.area_b);
        match self.stroke {
            ActuatorStroke::Limited(stroke) => problems.key(STROKE_KEY, stroke),
            ActuatorStroke::Telescopic(telescope) => problems.all(telescope.problems()),
            ActuatorStroke::Unlimited => {}
        }
        problems.key(keys::MOVING_MASS_KEY, self.moving_mass);
        problems.key_as("dead_volume_a", keys::DEAD_VOLUME_KEY, self.dead_volume_a);
        problems.key_as("dead_volume_b", keys::DEAD_VOLUME_KEY, self.dead_volume_b);
        if let Some(leakage) = self.internal_leakage {
            problems.key(keys::INTERNAL_LEAKAGE_KEY, leakage);
        }
        if let Some(contact) = self.end_stops {
            problems.component("end_stops", contact.problems());
        }
        problems.into_vec()
    }
}

impl<S: Scalar> Cylinder<S> {
    /// Areas A_A and A_B at a position in m, m2.
    #[inline(always)]
    pub fn areas_at(&self, x: S) -> [S; 2] {
        self.stroke.areas([self.area_a, self.area_b], x)
    }

    /// Stiffness of a telescopic piston in N/m from the slopes of its areas at two pressures in Pa;
    /// negative if a growing area pushes it onward; `None` for any other piston.
    ///
    /// ```text
    /// k_A = p_B dA_B/dx - p_A dA_A/dx
    /// ```
    pub fn area_stiffness(&self, x: S, [pressure_a, pressure_b]: [S; 2]) -> Option<S> {
        let [slope_a, slope_b] = self.stroke.telescope()?.slopes(x);
        Some(self.area_b * slope_b * pressure_b - self.area_a * slope_a * pressure_a)
    }
}

phea_dynamics::parameters! {
    Cylinder {
        area_a, area_b, stroke, moving_mass, dead_volume_a, dead_volume_b, internal_leakage,
        end_stops,
    }
}

/// Area between piston and rod, from their diameters in m, m2.
///
/// ```text
/// A = pi/4 (D_p - D_r) (D_p + D_r)
/// ```
///
/// # Example
/// ```
/// use phea_hydraulics::cylinder::annulus_area;
/// assert!((annulus_area(0.05, 0.022) - 1.58336e-3_f64).abs() < 0.5e-8);
/// ```
pub fn annulus_area<S: Scalar>(piston: S, rod: S) -> S {
    S::from(std::f64::consts::FRAC_PI_4) * (piston - rod) * (piston + rod)
}

/// Swept and dead volumes of both chambers at piston position `x`, without lines, m3.
///
/// ```text
/// V_A = V_A0 + A_A x        V_B = V_B0 + A_B (L - x)                  thesis (4.27), (4.28)
/// ```
///
/// A telescopic piston sweeps the integral of its areas. Without a stroke both are only the dead
/// volumes.
///
/// # Example
/// ```
/// use phea_hydraulics::cylinder::{Cylinder, chamber_volumes};
/// use phea_hydraulics::stroke::ActuatorStroke;
/// let cylinder = Cylinder {
///     area_a: 2e-3, area_b: 1e-3, stroke: ActuatorStroke::Limited(0.5), moving_mass: 10.0, dead_volume_a: 1e-5,
///     dead_volume_b: 0.0, internal_leakage: None, end_stops: None,
/// };
/// assert_eq!(chamber_volumes(&cylinder, 0.25), [5.1e-4, 2.5e-4]);
/// ```
pub fn chamber_volumes<S: Scalar>(cylinder: &Cylinder, x: S) -> [S; 2] {
    let [from_a, to_b] = cylinder.stroke.convert(&mut S::from).travels(x);
    let volume_a = S::from(cylinder.dead_volume_a) + S::from(cylinder.area_a) * from_a;
    let volume_b = S::from(cylinder.dead_volume_b) + S::from(cylinder.area_b) * to_b;
    [volume_a, volume_b]
}
