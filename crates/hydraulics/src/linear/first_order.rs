use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::scalar::Scalar;

use super::LinearParameters;

/// Hydraulic factor as a model F_e/U_C, N/V.
///
/// ```text
/// F_e/U_C = (K_qU K_eq/A_u)/(s + K_c K_eq/A_u^2)                                                  thesis (6.13)
/// ```
///
/// # Errors
/// Parameters that are not finite.
pub fn first_order_model(parameters: &LinearParameters) -> Result<TransferFunction, LinearError> {
    let factors = super::decompose(parameters, super::MechanicalDamping::Corrected);
    TransferFunction::from_factors(factors.hydraulic_gain, Vec::new(), vec![factors.hydraulic_pole()])
}

/// Time constant tau_d of the first-order loop closed by a proportional controller of gain K_p in
/// V/N, s.
///
/// ```text
/// tau_d = A (K_H + K_S)/(K_H K_S (K_c/A + K_p K_qU))                  thesis (6.14), (6.15)
/// ```
pub fn closed_loop_time_constant<S: Scalar>(parameters: &LinearParameters<S>, proportional_gain: S) -> S {
    let area = parameters.useful_area;
    let rate = parameters.flow_pressure_coefficient / area + proportional_gain * parameters.flow_gain;
    area / (parameters.equivalent_stiffness() * rate)
}

/// Steady-state gain K_SS of the loop closed by a proportional controller of gain K_p in V/N: below
/// one, since leakage consumes flow at any pressure.
///
/// ```text
/// K_SS = A K_p K_qU/(K_c + A K_p K_qU)                                 thesis (6.14), (6.15)
/// ```
///
/// The thesis omits it in its sizing: 0.974 at the null valve of Table 6.3, 0.26 at its largest
/// K_c.
pub fn closed_loop_steady_state_gain<S: Scalar>(parameters: &LinearParameters<S>, proportional_gain: S) -> S {
    let driven = parameters.useful_area * proportional_gain * parameters.flow_gain;
    driven / (parameters.flow_pressure_coefficient + driven)
}

/// Hydraulic stiffness that gives a wanted time constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RequiredStiffness {
    /// Required stiffness, N/m.
    Stiffness(f64),
    /// Gain at which even a rigid transmission is slower than wanted: the gain must exceed
    /// `rigid_limit`.
    TooSlow {
        /// Gain at which the stiffness becomes infinite, V/N.
        rigid_limit: f64,
    },
}

/// Hydraulic stiffness K_H in N/m for a wanted closed-loop time constant tau_d in s at a
/// proportional gain K_p in V/N; the stiffness in the parameters is ignored.
///
/// ```text
/// K_H = K_S A^2/(K_S tau_d (K_c + A K_p K_qU) - A^2)                                              thesis (6.16)
/// ```
///
/// # Example
/// Example: a row of Table 6.2.
/// ```
/// use phea_hydraulics::linear::{LinearParameters, RequiredStiffness, required_stiffness};
/// let parameters = LinearParameters {
///     useful_area: 1.58336e-3, moving_mass: 13.1, viscous_friction: 100.0, flow_gain: 5.62e-5,
///     flow_pressure_coefficient: 6.42e-13, hydraulic_stiffness: 0.0, sensor_stiffness: 2e7,
///     valve_natural_frequency: 1099.0, valve_damping_ratio: 0.9,
/// };
/// let RequiredStiffness::Stiffness(stiffness) = required_stiffness(&parameters, 0.05, 0.001) else { panic!() };
/// assert!((stiffness - 5.76e5).abs() < 1e3);
/// assert!(matches!(required_stiffness(&parameters, 0.05, 2e-5), RequiredStiffness::TooSlow { .. }));
/// ```
pub fn required_stiffness(
    parameters: &LinearParameters,
    time_constant: f64,
    proportional_gain: f64,
) -> RequiredStiffness {
    let LinearParameters { useful_area: area, sensor_stiffness: sensor, .. } = *parameters;
    let square = area * area;
    let flow = parameters.flow_pressure_coefficient + area * proportional_gain * parameters.flow_gain;
    let surplus = sensor * time_constant * flow - square;
    if surplus > 0.0 {
        RequiredStiffness::Stiffness(sensor * square / surplus)
    } else {
        RequiredStiffness::TooSlow { rigid_limit: rigid_limit_gain(parameters, time_constant) }
    }
}

/// Proportional gain K_p that gives a wanted closed-loop time constant tau_d in s, V/N.
///
/// ```text
/// K_p = (A (K_H + K_S)/(tau_d K_H K_S) - K_c/A)/K_qU                                              thesis (6.27)
/// ```
///
/// Negative if leakage is already faster than wanted. The inverse of [`required_stiffness`].
pub fn proportional_gain<S: Scalar>(parameters: &LinearParameters<S>, time_constant: S) -> S {
    let area = parameters.useful_area;
    let needed = area / (time_constant * parameters.equivalent_stiffness());
    (needed - parameters.flow_pressure_coefficient / area) / parameters.flow_gain
}

/// Proportional gain at which (6.16) requires an infinite stiffness, V/N: (6.27) with the sensor as
/// the only spring.
///
/// ```text
/// K_p = (A/(tau_d K_S) - K_c/A)/K_qU
/// ```
pub fn rigid_limit_gain<S: Scalar>(parameters: &LinearParameters<S>, time_constant: S) -> S {
    let area = parameters.useful_area;
    let needed = area / (time_constant * parameters.sensor_stiffness);
    (needed - parameters.flow_pressure_coefficient / area) / parameters.flow_gain
}
