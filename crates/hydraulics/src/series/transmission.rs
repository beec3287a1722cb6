use phea_dynamics::scalar::Scalar;

use super::OilColumn;
use crate::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, Fluid};
use crate::line::{Conduit, Line, StiffeningMember};
use crate::parameter::{ParameterError, ParameterRequirement, Problems};

/// Largest number of segments of a transmission's line: each adds two states.
pub const MOST_SEGMENTS: usize = 8;

/// Hydraulic transmission between force sensor and load: a piston at the rod, a line, and an equal
/// piston at the load, filled once and closed. Units: m2, m3, Pa.
///
/// ```text
/// F = A (p - p_0)                                                at either piston, p the pressure there
/// (C_e + C/2N) dp_0/dt = A v_m - q_1                             at the rod's piston, of velocity v_m
/// (C/N) dp_j/dt = q_j - q_j+1                                    between two segments
/// (I/N) dq_j/dt = p_j-1 - p_j - (R_0/N) q_j                      segment j of N
/// (C_e + C/2N) dp_N/dt = q_N - A v_L                             at the load's piston, of velocity v_L
/// C_e = V_e/beta(p_0)                                            I = rho L/a,   R_0 = 8 nu/R^2 I,   C: Conduit
/// ```
///
/// The far sides of both pistons are kept at the filling pressure p_0, so that no force acts at
/// rest; a pull lowers the pressure in the oil, whose column separates when it reaches vapour
/// pressure. The pistons have no friction, like rolling diaphragms, and no mass of their own: add
/// the mass at the rod to the moving mass and that at the load to the load. Friction of the line is
/// that of steady laminar flow. Source: Buerger (2005), "Stable, high-force, low-impedance robotic
/// actuators for human-interactive machines", thesis, MIT, for the arrangement; Merritt (1967) for
/// the elements.
///
/// # Example
/// In slow motions it is a spring of stiffness A^2 over its total compliance:
/// ```
/// use phea_hydraulics::line::StiffeningMember;
/// use phea_hydraulics::reference_rig::{components, hose_line, pipe_line};
/// use phea_hydraulics::series::Transmission;
/// use phea_hydraulics::stiffness::StiffnessModel;
/// let fluid = components(hose_line(), StiffnessModel::ByVolume).fluid;
/// let transmission = Transmission {
///     piston_area: 1e-3, line: pipe_line(), end_volume: 2e-5, filling_pressure: 30e5, segments: 2,
/// };
/// let column = transmission.column(&fluid, StiffeningMember::Nominal);
/// let compliance = pipe_line().compliance(1.45e9, StiffeningMember::Nominal) + 2.0 * 2e-5 / 1.45e9;
/// assert!((column.stiffness() / (1e-6 / compliance) - 1.0_f64).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission<S = f64> {
    /// Area A of either piston.
    pub piston_area: S,
    /// Hose or pipe between them.
    pub line: Line<S>,
    /// Oil volume V_e at either end in addition to that of the line.
    pub end_volume: S,
    /// Gauge filling pressure p_0, at rest and without force.
    pub filling_pressure: S,
    /// Number N of segments of the line; from 1 to [`MOST_SEGMENTS`].
    pub segments: usize,
}

impl Transmission {
    /// Impossible parameters of this transmission; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.key(super::keys::PISTON_AREA_KEY, self.piston_area);
        problems.component("line", self.line.problems());
        let (is_conduit, length) = match self.line {
            Line::Hose { length, .. } | Line::Pipe { length, .. } => (true, length),
            Line::Volume { volume, .. } => (false, volume),
        };
        let conduit = ParameterRequirement::HoseOrPipe;
        problems.require("line.volume", length, is_conduit, conduit);
        problems.positive("line.length", length);
        problems.key(super::keys::END_VOLUME_KEY, self.end_volume);
        let absolute = self.filling_pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE;
        problems.require(
            "filling_pressure",
            self.filling_pressure,
            absolute > 0.0,
            ParameterRequirement::AboveVacuum,
        );
        problems.key(super::keys::SEGMENTS_KEY, self.segments as f64);
        problems.into_vec()
    }
}

impl<S: Scalar> Transmission<S> {
    /// Oil of the transmission in motion.
    pub fn column(&self, fluid: &Fluid<S>, member: StiffeningMember) -> OilColumn<S> {
        let modulus = fluid.modulus_at(self.filling_pressure);
        let conduit = Conduit::filled(&self.line, fluid, self.filling_pressure, member);
        let count = S::from(self.segments as f64);
        let square = self.piston_area.squared();
        let fraction = conduit.compliance() / count;
        let end = self.end_volume / modulus + fraction / S::from(2.0);
        OilColumn {
            end_stiffness: square / end,
            inner_stiffness: square / fraction,
            mass: conduit.inertance() * square / count,
            damping: conduit.steady_resistance() * square / count,
            piston_area: self.piston_area,
            filling_pressure: self.filling_pressure,
            segments: self.segments,
        }
    }

    /// Total oil volume at rest, m3.
    pub fn oil_volume(&self) -> S {
        self.line.filled().volume() + S::from(2.0) * self.end_volume
    }
}
