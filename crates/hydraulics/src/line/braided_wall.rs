use super::{Hose, StiffeningMember};
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Wall of a hose that moves along its axis: its mass and its compliances.
///
/// ```text
/// area strain  = C_pp p + C_pF F         axial strain = A C_pF p + C_FF F         F the tension in the wall
/// ```
///
/// Both effects have one C_pF, since the wall stores energy. A braided wall becomes thinner when it
/// is pulled: C_pF < 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BraidedWall {
    /// Mass of the wall per length m, kg/m.
    pub mass_per_length: f64,
    /// Area strain per pressure without tension C_pp, 1/Pa.
    pub pressure_compliance: f64,
    /// Area strain per tension C_pF, 1/N; times the area of the bore, the axial strain per
    /// pressure.
    pub coupling_compliance: f64,
    /// Axial strain per tension C_FF, 1/N.
    pub axial_compliance: f64,
}

/// Data of a hose's wall that moves along its axis; absent values are assumed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineWall<S = f64> {
    /// Mass per length, kg/m.
    pub mass_per_length: Option<S>,
    /// Area strain per pressure without tension, 1/Pa.
    pub pressure_compliance: Option<S>,
    /// Area strain per tension, 1/N.
    pub coupling_compliance: Option<S>,
    /// Axial strain per tension, 1/N.
    pub axial_compliance: Option<S>,
}

/// Assumed outer diameter of the wall of a half-inch thermoplastic hose, m.
const OUTER_DIAMETER: f64 = 20.3e-3;
/// Assumed density of its polyamide, polyester braid and polyurethane, kg/m3.
const WALL_DENSITY: f64 = 1150.0;
/// Assumed static Young's modulus of its tube and cover together, without the braid, Pa.
const TUBE_MODULUS: f64 = 50e6;

impl BraidedWall {
    /// Wall of a hose braided at the neutral angle around an incompressible tube.
    ///
    /// ```text
    /// C_FF = 1/K_axial        C_pF = -C_FF        C_pp = 1/beta_free + A C_FF
    /// ```
    ///
    /// Inextensible in the direction of its threads, such a wall does not change its length when
    /// closed and free ends stretch it with F = p A (tan^2 of the braid angle is 2). So a
    /// catalogue's volumetric expansion, which is measured with free ends, also applies to the hose
    /// between fixed ends: 1/beta_free = C_pp + 2 A C_pF + A C_FF = C_pp - A C_pF^2/C_FF. At
    /// constant pressure only the tube carries the tension: K_axial = E_tube A_wall. The stiffness
    /// of the threads follows from the catalogue.
    ///
    /// Axial stiffness K_axial in N per unit of strain, at the same rate of change as the member of
    /// the hose's stiffening.
    ///
    /// # Example
    /// With free ends it does not move, and takes up the volume stated in the catalogue:
    /// ```
    /// use phea_hydraulics::line::{BraidedWall, StiffeningMember};
    /// let hose = phea_hydraulics::reference_rig::hose().filled();
    /// let wall = BraidedWall::neutral(&hose, StiffeningMember::Nominal, 5e4, 0.2);
    /// let area = std::f64::consts::FRAC_PI_4 * hose.bore * hose.bore;
    /// assert_eq!(wall.coupling_compliance + wall.axial_compliance, 0.0);
    /// let taken = wall.pressure_compliance + area * wall.coupling_compliance;
    /// assert!((taken * hose.wall_modulus(StiffeningMember::Nominal) - 1.0).abs() < 1e-12);
    /// ```
    pub fn neutral(
        hose: &Hose,
        member: StiffeningMember,
        axial_stiffness: f64,
        mass_per_length: f64,
    ) -> BraidedWall {
        let axial_compliance = 1.0 / axial_stiffness;
        BraidedWall::of_hose(hose, member, axial_compliance, -axial_compliance, mass_per_length)
    }

    /// Wall of these compliances in 1/N that expands as stated in the catalogue with closed, free
    /// ends, around the bore of the hose at the operating pressure.
    ///
    /// ```text
    /// C_pp = 1/beta_free - 2 A C_pF - A C_FF
    /// ```
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::line::{BraidedWall, StiffeningMember};
    /// let hose = phea_hydraulics::reference_rig::hose().filled();
    /// let stiff_braid = BraidedWall::of_hose(&hose, StiffeningMember::Nominal, 2e-5, -1e-5, 0.2);
    /// assert_eq!(stiff_braid.pressure_compliance, 1.0 / hose.wall_modulus(StiffeningMember::Nominal));
    /// ```
    pub fn of_hose(
        hose: &Hose,
        member: StiffeningMember,
        axial_compliance: f64,
        coupling_compliance: f64,
        mass_per_length: f64,
    ) -> BraidedWall {
        let hose = hose.filled();
        let area = std::f64::consts::FRAC_PI_4 * hose.bore * hose.bore;
        let pulled = area * (2.0 * coupling_compliance + axial_compliance);
        let pressure_compliance = 1.0 / hose.wall_modulus(member) - pulled;
        BraidedWall { mass_per_length, pressure_compliance, coupling_compliance, axial_compliance }
    }

    /// Assumed wall for a half-inch thermoplastic hose, none of it from a data sheet: outer
    /// diameter 20.3 mm, 1150 kg/m3, tube and cover of 50 MPa at rest, stiffening like the whole
    /// hose, neutral braid.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::line::{BraidedWall, StiffeningMember};
    /// let wall = BraidedWall::assumed(&phea_hydraulics::reference_rig::hose(), StiffeningMember::Nominal);
    /// assert!((wall.mass_per_length - 0.2265).abs() < 5e-5); // ORIGIN: analytic
    /// ```
    pub fn assumed(hose: &Hose, member: StiffeningMember) -> BraidedWall {
        let bore = hose.bore;
        let area = std::f64::consts::FRAC_PI_4 * (OUTER_DIAMETER * OUTER_DIAMETER - bore * bore);
        let stiffness = hose.dynamic_stiffening.member(member) * TUBE_MODULUS * area;
        BraidedWall::neutral(hose, member, stiffness, WALL_DENSITY * area)
    }

    /// Wall of these data. Absent ones are assumed, except those that follow from others: a braid
    /// at its neutral angle, and the catalogue's expansion.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::line::{BraidedWall, LineWall, StiffeningMember};
    /// let (hose, member) = (phea_hydraulics::reference_rig::hose(), StiffeningMember::Nominal);
    /// let assumed = BraidedWall::assumed(&hose, member);
    /// assert_eq!(BraidedWall::stated(&hose, member, &LineWall::default()), assumed);
    /// let heavy = BraidedWall::stated(&hose, member, &LineWall { mass_per_length: Some(0.5), ..LineWall::default() });
    /// assert_eq!(heavy, BraidedWall { mass_per_length: 0.5, ..assumed });
    /// ```
    pub fn stated(hose: &Hose, member: StiffeningMember, wall: &LineWall) -> BraidedWall {
        let assumed = BraidedWall::assumed(hose, member);
        let axial_compliance = wall.axial_compliance.unwrap_or(assumed.axial_compliance);
        let coupling_compliance = wall.coupling_compliance.unwrap_or(-axial_compliance);
        let mass_per_length = wall.mass_per_length.unwrap_or(assumed.mass_per_length);
        let found =
            BraidedWall::of_hose(hose, member, axial_compliance, coupling_compliance, mass_per_length);
        BraidedWall {
            pressure_compliance: wall.pressure_compliance.unwrap_or(found.pressure_compliance),
            ..found
        }
    }

    /// Impossible parameters of this wall; empty if there are none. The sign of its stored energy
    /// depends on the fluid.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("mass_per_length", self.mass_per_length);
        problems.not_negative("pressure_compliance", self.pressure_compliance);
        problems.require(
            "coupling_compliance",
            self.coupling_compliance,
            true,
            ParameterRequirement::FiniteNumber,
        );
        problems.positive("axial_compliance", self.axial_compliance);
        problems.into_vec()
    }
}
