//! Linear models of the force: the fifth-order model, its decomposition and its first-order core.
//!
//! ```text
//! F_e = (c_0 U_C - K_S (b_4 s^4 + ... + b_0) s X_L) / (a_5 s^5 + ... + a_0)     thesis (6.7)
//! ```
//!
//! The model is exact for a symmetric cylinder at mid stroke with equal edges and viscous friction;
//! elsewhere it is a reduction of [`crate::two_pressure`] whose error
//! [`crate::two_pressure::reduction`] measures.

mod decomposed;
mod difference;
mod dominance;
mod first_order;
pub(crate) mod polynomial;

pub use decomposed::{Decomposition, MechanicalDamping, decompose, decomposed_model};
pub use difference::{ResponseDifference, response_difference};
pub use dominance::{ContributionAbsence, ModeContribution, dominance};
pub use first_order::{
    RequiredStiffness, closed_loop_steady_state_gain, closed_loop_time_constant, first_order_model,
    proportional_gain, required_stiffness, rigid_limit_gain,
};

use phea_dynamics::linear::{LinearError, Polynomial, TransferFunction};
use phea_dynamics::scalar::Scalar;
use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients};

use crate::force_sensor::in_series;
use crate::parameter::{ParameterError, Problems};
use polynomial::{scaled, shifted};

/// Parameters of the fifth-order model. Units: m2, kg, N s/m, m3/(s V), m3/(s Pa), N/m, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearParameters<S = f64> {
    /// Useful piston area A_u, m2.
    pub useful_area: S,
    /// Moving mass M, kg.
    pub moving_mass: S,
    /// Viscous friction f_v, N s/m.
    pub viscous_friction: S,
    /// Flow gain K_qU, m3/(s V).
    pub flow_gain: S,
    /// Flow-pressure coefficient K_c, m3/(s Pa).
    pub flow_pressure_coefficient: S,
    /// Hydraulic stiffness K_H, N/m.
    pub hydraulic_stiffness: S,
    /// Stiffness of force sensor and environment K_S, N/m.
    pub sensor_stiffness: S,
    /// Natural frequency of the spool w_nv, rad/s.
    pub valve_natural_frequency: S,
    /// Damping ratio of the spool xi_v.
    pub valve_damping_ratio: S,
}

impl<S: Scalar> LinearParameters<S> {
    /// Equivalent stiffness of both springs in series, N/m.
    ///
    /// ```text
    /// K_eq = K_H K_S/(K_H + K_S)                                           thesis (6.12)
    /// ```
    pub fn equivalent_stiffness(&self) -> S {
        in_series(self.hydraulic_stiffness, self.sensor_stiffness)
    }
}

impl LinearParameters {
    /// Impossible parameters; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.positive("useful_area", self.useful_area);
        problems.positive("moving_mass", self.moving_mass);
        problems.not_negative("viscous_friction", self.viscous_friction);
        problems.positive("flow_gain", self.flow_gain);
        problems.not_negative("flow_pressure_coefficient", self.flow_pressure_coefficient);
        problems.positive("hydraulic_stiffness", self.hydraulic_stiffness);
        problems.positive("sensor_stiffness", self.sensor_stiffness);
        problems.positive("valve_natural_frequency", self.valve_natural_frequency);
        problems.positive("valve_damping_ratio", self.valve_damping_ratio);
        problems.into_vec()
    }
}

/// Force per command and force per load position. Units: N/V, N/m.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearModel {
    /// Command path P = F_e/U_C.
    pub command: TransferFunction,
    /// Load path Pd = F_e/X_L; it has a zero at the origin.
    pub load_position: TransferFunction,
}

/// Both paths of the fifth-order model, thesis (6.7), with coefficients over any scalar: numbers,
/// or recorded expressions for an uncertain plant. The disturbance path is F_e/X_L.
///
/// ```text
/// a_0 = w^2 K_c K_H K_S
/// a_1 = w^2 A^2 (K_H + K_S) + K_c K_H (2 xi w K_S + w^2 f_v)
/// a_2 = 2 xi w A^2 (K_H + K_S) + w^2 A^2 f_v + K_c K_H (2 xi w f_v + w^2 M + K_S)
/// a_3 = 2 xi w A^2 f_v + w^2 A^2 M + K_c K_H (2 xi w M + f_v) + A^2 (K_H + K_S)
/// a_4 = 2 xi w A^2 M + A^2 f_v + K_c K_H M
/// a_5 = A^2 M        c_0 = A K_H K_qU K_S w^2
///
/// b_0 = w^2 A^2 K_H + w^2 f_v K_c K_H
/// b_1 = 2 xi w A^2 K_H + w^2 A^2 f_v + K_c K_H (2 xi w f_v + w^2 M)
/// b_2 = 2 xi w A^2 f_v + w^2 A^2 M + A^2 K_H + K_c K_H (2 xi w M + f_v)
/// b_3 = a_4        b_4 = a_5
/// ```
///
/// # Example
/// Record the plant with an uncertain stiffness:
/// ```
/// use phea_dynamics::uncertain_plant::{UncertainParameter, UncertainPlant};
/// use phea_hydraulics::linear::{LinearParameters, linear_model_coefficients};
/// let stiffness = UncertainParameter {
///     name: "hydraulic_stiffness".into(), nominal: 2.24e6, minimum: 2.24e6, maximum: 4.11e6,
/// };
/// let plant = UncertainPlant::record(vec![stiffness], |p| {
///     linear_model_coefficients(&LinearParameters {
///         useful_area: 1.58336e-3.into(), moving_mass: 13.1.into(), viscous_friction: 100.0.into(),
///         flow_gain: 5.4e-5.into(), flow_pressure_coefficient: 6.42e-13.into(),
///         hydraulic_stiffness: p[0], sensor_stiffness: 2e7.into(),
///         valve_natural_frequency: 1099.0.into(), valve_damping_ratio: 0.9.into(),
///     })
/// })?;
/// // static force per volt A K_qU/K_c, whatever the stiffness
/// let member = plant.coefficients(&[3e6]).ok_or("a rational plant")?.command;
/// let static_gain: f64 = member.numerator[0] / member.denominator[5];
/// assert!((static_gain / (1.58336e-3 * 5.4e-5 / 6.42e-13) - 1.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn linear_model_coefficients<S: Scalar>(parameters: &LinearParameters<S>) -> PlantCoefficients<S> {
    let LinearParameters {
        useful_area: area,
        moving_mass: mass,
        viscous_friction: friction,
        flow_gain,
        flow_pressure_coefficient,
        hydraulic_stiffness: stiffness,
        sensor_stiffness: sensor,
        valve_natural_frequency: w,
        valve_damping_ratio: damping,
    } = *parameters;
    let area_squared = area.squared();
    let w_squared = w.squared();
    let spool = S::from(2.0) * damping * w;
    let leak = flow_pressure_coefficient * stiffness;
    let springs = stiffness + sensor;

    let a0 = w_squared * leak * sensor;
    let a1 = w_squared * area_squared * springs + leak * (spool * sensor + w_squared * friction);
    let a2 = spool * area_squared * springs
        + w_squared * area_squared * friction
        + leak * (spool * friction + w_squared * mass + sensor);
    let a3 = spool * area_squared * friction
        + w_squared * area_squared * mass
        + leak * (spool * mass + friction)
        + area_squared * springs;
    let a4 = spool * area_squared * mass + area_squared * friction + leak * mass;
    let a5 = area_squared * mass;

    let b0 = w_squared * area_squared * stiffness + w_squared * friction * leak;
    let b1 = spool * area_squared * stiffness
        + w_squared * area_squared * friction
        + leak * (spool * friction + w_squared * mass);
    let b2 = spool * area_squared * friction
        + w_squared * area_squared * mass
        + area_squared * stiffness
        + leak * (spool * mass + friction);

    let c0 = area * stiffness * flow_gain * sensor * w_squared;
    let denominator = vec![a5, a4, a3, a2, a1, a0];
    let load = shifted(&scaled(-sensor, &[a5, a4, b2, b1, b0]));
    PlantCoefficients {
        command: RationalCoefficients { numerator: vec![c0], denominator: denominator.clone() },
        disturbance: Some(RationalCoefficients { numerator: load, denominator }),
        dead_time_s: S::from(0.0),
        rate: None,
    }
}

/// Fifth-order model, thesis (6.7), as factored transfer functions.
///
/// # Errors
/// Parameters whose coefficients are not finite or whose denominator vanishes.
pub fn linear_model(parameters: &LinearParameters) -> Result<LinearModel, LinearError> {
    transfer_functions(&linear_model_coefficients(parameters))
}

/// Factored transfer functions of a plant with both paths; without a load path that path is zero.
///
/// # Errors
/// Coefficients that are not finite, or a denominator that vanishes.
pub fn transfer_functions(plant: &PlantCoefficients<f64>) -> Result<LinearModel, LinearError> {
    let factored = |rational: &RationalCoefficients<f64>| {
        let numerator = Polynomial::new(rational.numerator.clone());
        let denominator = Polynomial::new(rational.denominator.clone());
        TransferFunction::from_polynomials(&numerator, &denominator)
    };
    let load_position = match &plant.disturbance {
        Some(disturbance) => factored(disturbance)?,
        None => TransferFunction::gain_only(0.0),
    };
    Ok(LinearModel { command: factored(&plant.command)?, load_position })
}
