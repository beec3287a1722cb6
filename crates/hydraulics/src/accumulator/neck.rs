//! Neck between a chamber and the gas of its accumulator.

use std::f64::consts::{FRAC_PI_4, PI};

use phea_dynamics::scalar::Scalar;

use crate::parameter::{ParameterError, Problems};

/// Neck with the flow q into the gas, which requires a pressure drop.
///
/// ```text
/// p - p_g = I dq/dt + R q + Z q |q|
/// ```
///
/// Units: kg/m4, Pa s/m3, Pa s2/m6, m3/Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neck<S = f64> {
    /// Inertance I of the oil.
    pub inertance: S,
    /// Laminar resistance R.
    pub resistance: S,
    /// Coefficient Z of the end losses, over the square of the flow.
    pub loss: S,
    /// Compliance of the oil in the neck, m3/Pa: it remains when the gas is shut off.
    pub compliance: S,
}

impl Neck {
    /// Impossible parameters of this neck; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("neck_inertance", self.inertance);
        problems.not_negative("neck_resistance", self.resistance);
        problems.not_negative("neck_loss", self.loss);
        problems.positive("neck_compliance", self.compliance);
        problems.into_vec()
    }
}

phea_dynamics::parameters! { Neck { inertance, resistance, loss, compliance } }

impl<S: Scalar> Neck<S> {
    /// Round neck of a diameter and a length in m, filled with oil of a density in kg/m3, a
    /// kinematic viscosity in m2/s and a bulk modulus in Pa; `loss_coefficient` is that of its ends
    /// relative to the velocity head.
    ///
    /// ```text
    /// I = rho L/A,   R = 128 rho nu L/(pi d^4),   Z = zeta rho/(2 A^2),   C = A L/beta,   A = pi d^2/4
    /// ```
    ///
    /// Source: Merritt (1967), laminar flow in a pipe, and head loss at its ends.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::accumulator::Neck;
    /// let neck = Neck::round([6e-3, 40e-3], [870.0, 46e-6, 1.45e9], 1.5);
    /// assert!((neck.inertance / 1.2308e6 - 1.0_f64).abs() < 1e-4);
    /// assert!((neck.drop(1e-4) / (neck.resistance * 1e-4 + neck.loss * 1e-8) - 1.0).abs() < 1e-15);
    /// ```
    pub fn round(
        [diameter, length]: [S; 2],
        [density, viscosity, modulus]: [S; 3],
        loss_coefficient: S,
    ) -> Neck<S> {
        let area = S::from(FRAC_PI_4) * diameter.squared();
        let fourth = diameter.squared().squared();
        Neck {
            inertance: density * length / area,
            resistance: S::from(128.0 / PI) * density * viscosity * length / fourth,
            loss: S::from(0.5) * loss_coefficient * density / area.squared(),
            compliance: area * length / modulus,
        }
    }

    /// Pressure drop of a steady flow in m3/s, Pa.
    #[inline(always)]
    pub fn drop(&self, flow: S) -> S {
        (self.resistance + self.loss * flow.abs()) * flow
    }
}
