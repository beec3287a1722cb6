//! Hydraulic stiffness over the stroke, in the thesis' model and by volume.
//!
//! ```text
//! K_H = A_A^2/C_A(x) + A_B^2/C_B(x)                                    thesis (6.1)
//! uniform:    C_A = (A_A x + V_A0 + V_line)/beta_e                     thesis (6.3): one modulus for line and chamber
//! by_volume:  C_A = (A_A x + V_A0)/beta_0 + C_line                     each volume with the modulus of its enclosure
//! C_line:     hose epsilon L/r_beta + (A_ho + E(p)) L/beta_0, else V_line/beta_e          from its data sheet
//! ```
//!
//! and likewise C_B with L - x. A chamber of steel does not become softer when a hose is connected,
//! so `by_volume` is right, and uses the hose's data sheet at the operating pressure p; `uniform`
//! is the model of the thesis' tables, and is too soft whenever the chamber contains a considerable
//! fraction of the fluid.

mod length;
mod range;

pub use crate::line::StiffnessModel;
pub use length::{
    LineLength, hose_length_by_volume, hose_length_uniform, line_fraction_for_stiffness,
    stiffness_from_hose_length,
};
pub use range::{ModelDifference, StrokeStiffness, model_difference};

use phea_dynamics::scalar::Scalar;

use crate::cylinder::Cylinder;
use crate::line::{Line, StiffeningMember};
use crate::stroke::ActuatorStroke;

/// Compliance dV/dp of both chambers with their lines, linear in the piston position. Units: m2, m,
/// m3/Pa, m2/Pa.
///
/// ```text
/// C_A(x) = constant_a + slope_a x        C_B(x) = constant_b + slope_b (L - x)
/// ```
///
/// For a telescopic piston x and L - x are equivalent travels of the first stage:
/// [`ActuatorStroke::travels`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberCompliance<S = f64> {
    /// Piston area A_A, m2; of a telescopic piston that of its first stage.
    pub area_a: S,
    /// Piston area A_B, m2; of a telescopic piston that of its first stage.
    pub area_b: S,
    /// Stroke L, m.
    pub stroke: ActuatorStroke<S>,
    /// Compliance C_A with the piston at the A end, m3/Pa.
    pub constant_a: S,
    /// Growth of C_A with x, m2/Pa.
    pub slope_a: S,
    /// Compliance C_B with the piston at the B end, m3/Pa.
    pub constant_b: S,
    /// Growth of C_B with L - x, m2/Pa.
    pub slope_b: S,
}

/// Compliance of both chambers with their lines (A first), for fluids of these moduli in Pa
/// (different in the chambers if air is entrained and the pressures differ).
///
/// # Example
/// The thesis' hose, both models, piston at mid stroke:
/// ```
/// # use phea_hydraulics::{cylinder::*, line::*, stiffness::*, stroke::ActuatorStroke};
/// # let areas = [annulus_area(0.05, 0.022); 2];
/// # let cylinder = Cylinder { area_a: areas[0], area_b: areas[1], stroke: ActuatorStroke::Limited(0.5), moving_mass: 13.1,
/// #     dead_volume_a: 0.0, dead_volume_b: 0.0, internal_leakage: None, end_stops: None };
/// # let dynamic_stiffening = Stiffening { nominal: 5.0, minimum: 4.0, maximum: 5.0 };
/// # let hose = Hose { bore: 12.7e-3, volumetric_expansion: 1.56e-5, operating_expansion: 7.774e-6,
/// #     expansion_slope: 2.236e-12, dynamic_stiffening };
/// # let line = Line::Hose { hose, length: 1.5 };
/// let of = |model| chamber_compliance(model, [1.45e9; 2], &cylinder, [&line, &line], StiffeningMember::Nominal);
/// let uniform = hydraulic_stiffness(&of(StiffnessModel::Uniform), 0.25);
/// let by_volume = hydraulic_stiffness(&of(StiffnessModel::ByVolume), 0.25);
/// assert!((uniform - 2.233e6).abs() < 0.5e3 && (by_volume - 4.630e6).abs() < 0.5e3);
/// ```
pub fn chamber_compliance<S: Scalar>(
    model: StiffnessModel,
    fluid_moduli: [S; 2],
    cylinder: &Cylinder<S>,
    lines: [&Line<S>; 2],
    member: StiffeningMember,
) -> ChamberCompliance<S> {
    let one_side = |area: S, dead_volume: S, line: &Line<S>, fluid_modulus: S| {
        let (chamber_modulus, line_compliance) = match model {
            StiffnessModel::Uniform => (
                line.effective_modulus(fluid_modulus, member),
                line.compliance_of_unexpanded(fluid_modulus, member),
            ),
            StiffnessModel::ByVolume => (fluid_modulus, line.compliance(fluid_modulus, member)),
        };
        (dead_volume / chamber_modulus + line_compliance, area / chamber_modulus)
    };
    let ([line_a, line_b], [modulus_a, modulus_b]) = (lines, fluid_moduli);
    let (constant_a, slope_a) = one_side(cylinder.area_a, cylinder.dead_volume_a, line_a, modulus_a);
    let (constant_b, slope_b) = one_side(cylinder.area_b, cylinder.dead_volume_b, line_b, modulus_b);
    ChamberCompliance {
        area_a: cylinder.area_a,
        area_b: cylinder.area_b,
        stroke: cylinder.stroke,
        constant_a,
        slope_a,
        constant_b,
        slope_b,
    }
}

/// Compliances C_A and C_B at piston position x, m3/Pa.
#[inline]
pub fn compliance_at<S: Scalar>(chambers: &ChamberCompliance<S>, x: S) -> [S; 2] {
    let [from_a, to_b] = chambers.stroke.travels(x);
    [chambers.constant_a + chambers.slope_a * from_a, chambers.constant_b + chambers.slope_b * to_b]
}

/// Stiffness of the two shut chambers at piston position x, N/m.
///
/// ```text
/// K_HA = A_A^2/C_A(x)        K_HB = A_B^2/C_B(x)                       thesis (6.1)
/// ```
///
/// The areas are those at x, which matters only for a telescopic piston.
pub fn chamber_stiffness<S: Scalar>(chambers: &ChamberCompliance<S>, x: S) -> [S; 2] {
    let [compliance_a, compliance_b] = compliance_at(chambers, x);
    let [area_a, area_b] = chambers.areas_at(x);
    [area_a.squared() / compliance_a, area_b.squared() / compliance_b]
}

/// Hydraulic stiffness at piston position x, N/m.
///
/// ```text
/// K_H = K_HA + K_HB                                                    thesis (6.1), (6.2), (6.3)
///     = 2 beta_e A^2/V        equal chambers of volume V               thesis (6.4)
/// ```
pub fn hydraulic_stiffness<S: Scalar>(chambers: &ChamberCompliance<S>, x: S) -> S {
    let [stiffness_a, stiffness_b] = chamber_stiffness(chambers, x);
    stiffness_a + stiffness_b
}

impl<S: Scalar> ChamberCompliance<S> {
    /// Areas A_A and A_B at piston position x, m2.
    #[inline(always)]
    pub fn areas_at(&self, x: S) -> [S; 2] {
        self.stroke.areas([self.area_a, self.area_b], x)
    }

    /// Compliance with the gas of an accumulator at either chamber, in m3/Pa, added.
    #[must_use]
    pub fn with_gas(self, [gas_a, gas_b]: [Option<S>; 2]) -> ChamberCompliance<S> {
        let with = |oil: S, gas: Option<S>| gas.map_or(oil, |gas| oil + gas);
        ChamberCompliance {
            constant_a: with(self.constant_a, gas_a),
            constant_b: with(self.constant_b, gas_b),
            ..self
        }
    }
}

phea_dynamics::parameters! {
    ChamberCompliance { area_a, area_b, stroke, constant_a, slope_a, constant_b, slope_b }
}
