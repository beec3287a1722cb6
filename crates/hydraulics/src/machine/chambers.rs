use phea_dynamics::scalar::{LocalFunction, Parameters, Scalar};

use crate::actuator::{Actuator, Components};
use crate::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, bulk_modulus_with_air};
use crate::line::{Line, StiffeningMember};
use crate::stiffness::{ChamberCompliance, StiffnessModel, chamber_compliance, compliance_at};
use crate::stroke::ActuatorStroke;

/// Absolute pressure in Pa below which the modulus of fluid with air is evaluated at this pressure.
/// Far below any vapour pressure that is reported, it only keeps a trial step of an integrator
/// finite.
const LEAST_ABSOLUTE_PRESSURE: f64 = 1.0;

/// Compliance of both chambers with their lines as the machine moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Chambers<S = f64> {
    /// Fluid without air: compliance depends only on the position.
    Clean(ChamberCompliance<S>),
    /// Fluid with entrained air: compliance depends on each chamber's pressure too.
    Aerated(AeratedChambers<S>),
}

/// Chambers whose fluid contains air.
///
/// ```text
/// C_A(x, p) = (V_A + A_A x)/beta(p) + W_A + w_A x              and likewise C_B with L - x
/// ```
///
/// Volume V contains fluid with the modulus of the mixture, W is the compliance of walls and stated
/// moduli. Units: Pa, 1, m, m3, m2, m3/Pa, m2/Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AeratedChambers<S = f64> {
    pub(super) bulk_modulus: S,
    pub(super) volume_fraction: S,
    pub(super) polytropic_exponent: S,
    pub(super) stroke: ActuatorStroke<S>,
    pub(super) side_a: AeratedSide<S>,
    pub(super) side_b: AeratedSide<S>,
}

/// Chamber with its line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AeratedSide<S> {
    pub(super) fluid_constant: S,
    pub(super) fluid_slope: S,
    pub(super) wall_constant: S,
    pub(super) wall_slope: S,
}

impl Chambers {
    /// Chambers of an actuator with lumped lines; `member` selects the hose's stiffening.
    pub fn new(actuator: &Actuator, member: StiffeningMember) -> Chambers {
        Chambers::of(actuator.components(), member)
    }

    /// Chambers with the compliance in m3/Pa that lines with dynamics of their own add to each; in
    /// the model `uniform` they retain the modulus of their line.
    pub fn with_line_compliance(
        actuator: &Actuator,
        member: StiffeningMember,
        [added_a, added_b]: [f64; 2],
    ) -> Chambers {
        let components = *actuator.components();
        let [line_a, line_b] = [components.line_a, components.line_b].map(without_volume);
        let mut chambers = Chambers::of(&Components { line_a, line_b, ..components }, member);
        match &mut chambers {
            Chambers::Clean(compliance) => {
                compliance.constant_a += added_a;
                compliance.constant_b += added_b;
            }
            Chambers::Aerated(aerated) => {
                aerated.side_a.wall_constant += added_a;
                aerated.side_b.wall_constant += added_b;
            }
        }
        chambers
    }

    fn of(components: &Components, member: StiffeningMember) -> Chambers {
        let Components { fluid, cylinder, line_a, line_b, .. } = components;
        let model = components.stiffness_model;
        match fluid.entrained_air {
            None => {
                let moduli = [fluid.bulk_modulus; 2];
                Chambers::Clean(chamber_compliance(model, moduli, cylinder, [line_a, line_b], member))
            }
            Some(air) => Chambers::Aerated(AeratedChambers {
                bulk_modulus: fluid.bulk_modulus,
                volume_fraction: air.volume_fraction,
                polytropic_exponent: air.polytropic_exponent,
                stroke: cylinder.stroke,
                side_a: aerated_side(model, cylinder.area_a, cylinder.dead_volume_a, line_a, member),
                side_b: aerated_side(model, cylinder.area_b, cylinder.dead_volume_b, line_b, member),
            }),
        }
    }
}

/// Line of this type, without volume.
fn without_volume(line: Line) -> Line {
    match line {
        Line::Hose { hose, .. } => Line::Hose { hose, length: 0.0 },
        Line::Pipe { pipe, .. } => Line::Pipe { pipe, length: 0.0 },
        Line::Volume { effective_bulk_modulus, .. } => Line::Volume { volume: 0.0, effective_bulk_modulus },
    }
}

/// Part of a side that is fluid with air, and the compliance without it.
fn aerated_side(
    model: StiffnessModel,
    area: f64,
    dead_volume: f64,
    line: &Line,
    member: StiffeningMember,
) -> AeratedSide<f64> {
    let filled = line.filled();
    let line = match model {
        StiffnessModel::Uniform => line,
        StiffnessModel::ByVolume => &filled,
    };
    let (fluid, wall) = match line {
        Line::Hose { hose, .. } => (1.0, 1.0 / hose.wall_modulus(member)),
        Line::Pipe { pipe, .. } => (1.0, pipe.wall_compliance()),
        Line::Volume { effective_bulk_modulus, .. } => (0.0, 1.0 / effective_bulk_modulus),
    };
    let (chamber_fluid, chamber_wall) = match model {
        StiffnessModel::Uniform => (fluid, wall),
        StiffnessModel::ByVolume => (1.0, 0.0),
    };
    let volume = line.volume();
    AeratedSide {
        fluid_constant: fluid * volume + chamber_fluid * dead_volume,
        fluid_slope: chamber_fluid * area,
        wall_constant: wall * volume + chamber_wall * dead_volume,
        wall_slope: chamber_wall * area,
    }
}

phea_dynamics::parameters! { Chambers = Chambers::Clean(compliance) | Chambers::Aerated(aerated) }

phea_dynamics::parameters! {
    AeratedChambers { bulk_modulus, volume_fraction, polytropic_exponent, stroke, side_a, side_b }
}

phea_dynamics::parameters! {
    AeratedSide { fluid_constant, fluid_slope, wall_constant, wall_slope }
}

impl<S: Scalar> Chambers<S> {
    /// Compliances C_A and C_B at piston position `x` in m and chamber pressures in Pa gauge,
    /// m3/Pa.
    #[inline(always)]
    pub fn compliance<T: Scalar + From<S>>(&self, x: T, [pressure_a, pressure_b]: [T; 2]) -> [T; 2] {
        match self {
            Chambers::Clean(compliance) => T::local(compliance, [x]),
            Chambers::Aerated(aerated) => T::local(aerated, [x, pressure_a, pressure_b]),
        }
    }
}

impl<S: Scalar> LocalFunction<S, 1, 2> for ChamberCompliance<S> {
    #[inline(always)]
    fn at<T: Scalar>(&self, [x]: [T; 1], constant: impl Fn(S) -> T + Copy) -> [T; 2] {
        compliance_at(&self.convert(&mut |parameter| constant(parameter)), x)
    }
}

impl<S: Scalar> LocalFunction<S, 3, 2> for AeratedChambers<S> {
    fn at<T: Scalar>(&self, [x, p_a, p_b]: [T; 3], constant: impl Fn(S) -> T + Copy) -> [T; 2] {
        self.convert(&mut |parameter| constant(parameter)).compliance(x, [p_a, p_b])
    }
}

impl<S: Scalar> AeratedChambers<S> {
    fn compliance(&self, x: S, [pressure_a, pressure_b]: [S; 2]) -> [S; 2] {
        let side = |side: &AeratedSide<S>, travel: S, pressure: S| {
            let fluid = side.fluid_constant + side.fluid_slope * travel;
            fluid / self.modulus(pressure) + side.wall_constant + side.wall_slope * travel
        };
        let [from_a, to_b] = self.stroke.travels(x);
        [side(&self.side_a, from_a, pressure_a), side(&self.side_b, to_b, pressure_b)]
    }

    fn modulus(&self, pressure: S) -> S {
        let absolute = pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        bulk_modulus_with_air(
            self.bulk_modulus,
            self.volume_fraction,
            self.polytropic_exponent,
            absolute.maximum(S::from(LEAST_ABSOLUTE_PRESSURE)),
        )
    }
}
