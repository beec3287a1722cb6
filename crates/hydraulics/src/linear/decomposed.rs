use num_complex::Complex64;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::portable;
use phea_dynamics::scalar::Scalar;

use super::LinearParameters;

/// Damping of the mechanical factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MechanicalDamping {
    /// Damping d_1 = f_v/M, as printed in the thesis.
    Printed,
    /// Damping d_1 = f_v/M + K_c K_H^2/(A_u^2 (K_H + K_S)): leakage damps the piston too.
    Corrected,
}

/// Factors of the decomposed model. Units: N/(V s), rad/s, rad2/s2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decomposition<S = f64> {
    /// Numerator K_qU K_eq/A_u of the hydraulic factor.
    pub hydraulic_gain: S,
    /// Rate K_c K_eq/A_u^2: the hydraulic pole is at minus this rate.
    pub hydraulic_rate: S,
    /// Coefficient d_0 = (K_H + K_S)/M.
    pub mechanical_square: S,
    /// Coefficient d_1, damping of the mechanical factor.
    pub mechanical_damping: S,
    /// Coefficient e_0 = w_nv^2.
    pub valve_square: S,
    /// Coefficient e_1 = 2 xi_v w_nv.
    pub valve_damping: S,
}

/// Fifth-order model decomposed into the contributions of fluid, piston and spool.
///
/// ```text
/// F_e/U_C = (K_qU K_eq/A_u)/(s + K_c K_eq/A_u^2)  d_0/(s^2 + d_1 s + d_0)  e_0/(s^2 + e_1 s + e_0)      thesis (6.12)
/// d_0 = (K_H + K_S)/M        d_1 = f_v/M + K_c K_H^2/(A_u^2 (K_H + K_S))  (corrected)
/// e_0 = w_nv^2               e_1 = 2 xi_v w_nv
/// ```
///
/// The spool's factor is exact. The other two are first-order perturbations of the lossless piston
/// between its springs: accurate while the hydraulic pole is slow compared with sqrt(d_0).
pub fn decompose<S: Scalar>(
    parameters: &LinearParameters<S>,
    damping: MechanicalDamping,
) -> Decomposition<S> {
    let area = parameters.useful_area;
    let equivalent = parameters.equivalent_stiffness();
    let springs = parameters.hydraulic_stiffness + parameters.sensor_stiffness;
    let leak = parameters.flow_pressure_coefficient / area.squared();
    let friction = parameters.viscous_friction / parameters.moving_mass;
    let frequency = parameters.valve_natural_frequency;
    Decomposition {
        hydraulic_gain: parameters.flow_gain * equivalent / area,
        hydraulic_rate: leak * equivalent,
        mechanical_square: springs / parameters.moving_mass,
        mechanical_damping: match damping {
            MechanicalDamping::Printed => friction,
            MechanicalDamping::Corrected => {
                friction + leak * parameters.hydraulic_stiffness.squared() / springs
            }
        },
        valve_square: frequency.squared(),
        valve_damping: S::from(2.0) * parameters.valve_damping_ratio * frequency,
    }
}

impl Decomposition {
    /// Pole of the fluid with valve leakage, rad/s.
    pub fn hydraulic_pole(&self) -> Complex64 {
        Complex64::new(-self.hydraulic_rate, 0.0)
    }

    /// Poles of the piston between its springs, rad/s.
    pub fn mechanical_poles(&self) -> [Complex64; 2] {
        quadratic_roots(self.mechanical_damping, self.mechanical_square)
    }

    /// Poles of the spool, rad/s.
    pub fn valve_poles(&self) -> [Complex64; 2] {
        quadratic_roots(self.valve_damping, self.valve_square)
    }

    /// All five poles: hydraulic, mechanical, valve.
    pub fn poles(&self) -> Vec<Complex64> {
        let mut poles = vec![self.hydraulic_pole()];
        poles.extend(self.mechanical_poles());
        poles.extend(self.valve_poles());
        poles
    }
}

/// Decomposed model as one transfer function F_e/U_C, N/V.
///
/// # Errors
/// Parameters whose factors are not finite.
///
/// # Example
/// Its static gain A_u K_qU/K_c is that of the fifth-order model.
/// ```
/// use phea_hydraulics::linear::{LinearParameters, MechanicalDamping, decomposed_model, linear_model};
/// let parameters = LinearParameters {
///     useful_area: 1.58336e-3, moving_mass: 13.1, viscous_friction: 100.0, flow_gain: 5.4e-5,
///     flow_pressure_coefficient: 6.42e-13, hydraulic_stiffness: 2.24e6, sensor_stiffness: 2e7,
///     valve_natural_frequency: 1099.0, valve_damping_ratio: 0.9,
/// };
/// let decomposed = decomposed_model(&parameters, MechanicalDamping::Corrected)?;
/// let full = linear_model(&parameters)?.command;
/// assert!((decomposed.dc_gain() / full.dc_gain() - 1.0).abs() < 1e-9);
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
pub fn decomposed_model(
    parameters: &LinearParameters,
    damping: MechanicalDamping,
) -> Result<TransferFunction, LinearError> {
    let factors = decompose(parameters, damping);
    let gain = factors.hydraulic_gain * factors.mechanical_square * factors.valve_square;
    TransferFunction::from_factors(gain, Vec::new(), factors.poles())
}

/// Roots of s^2 + d s + c, without cancellation when they are real and far apart.
fn quadratic_roots(d: f64, c: f64) -> [Complex64; 2] {
    let half = -0.5 * d;
    let root = portable::sqrt_complex(Complex64::new(half * half - c, 0.0));
    if root.im != 0.0 {
        return [Complex64::new(half, root.im.abs()), Complex64::new(half, -root.im.abs())];
    }
    let larger = half + root.re.copysign(half);
    let smaller = if larger == 0.0 { 0.0 } else { c / larger };
    [Complex64::new(larger, 0.0), Complex64::new(smaller, 0.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_roots_far_apart_keep_their_digits() {
        // ORIGIN: analytic, (s + 1e6)(s + 1e-6)
        let [fast, slow] = quadratic_roots(1e6 + 1e-6, 1.0);
        assert!((fast.re / -1e6 - 1.0).abs() < 1e-15 && (slow.re / -1e-6 - 1.0).abs() < 1e-15);
        // ORIGIN: analytic, (s + 3)^2 + 16
        assert_eq!(quadratic_roots(6.0, 25.0), [Complex64::new(-3.0, 4.0), Complex64::new(-3.0, -4.0)]);
    }
}
