use phea_dynamics::linear::LinearError;
use phea_dynamics::scalar::Scalar;

use super::{TwoPressureLinearParameters, two_pressure_coefficients};
use crate::linear::{
    LinearParameters, ResponseDifference, linear_model, response_difference, transfer_functions,
};
use crate::servovalve::ChamberCoefficients;

/// Effective parameters of the fifth-order model (6.7) that represent a two-pressure model.
///
/// ```text
/// A_u = (A_A + A_B)/2        K_H = A_A^2/C_A + A_B^2/C_B
/// A_u^2/K_c = A_A^2/K_cA + A_B^2/K_cB        K_qU = (A_u/K_H) (A_A K_qA/C_A + A_B K_qB/C_B)
/// ```
///
/// With K_H and K_qU the force for fast commands and motions is right, with K_c the force for slow
/// motions (the damper A_u^2/K_c). Three numbers cannot also preserve the static gain from command
/// to force; it is right if both chambers have the same corner frequency K_c/C. At mid stroke of a
/// symmetric cylinder with equal edges the reduction is exact.
pub fn reduce<S: Scalar>(parameters: &TwoPressureLinearParameters<S>) -> LinearParameters<S> {
    let [area_a, area_b] = parameters.areas;
    let [compliance_a, compliance_b] = parameters.compliances;
    let ChamberCoefficients { flow_gain_a, flow_pressure_a, flow_gain_b, flow_pressure_b } =
        parameters.chambers;
    let useful_area = (area_a + area_b) / S::from(2.0);
    let hydraulic_stiffness = area_a.squared() / compliance_a + area_b.squared() / compliance_b;
    let gain = area_a * flow_gain_a / compliance_a + area_b * flow_gain_b / compliance_b;
    let product = flow_pressure_a * flow_pressure_b;
    let damper = area_a.squared() * flow_pressure_b + area_b.squared() * flow_pressure_a;
    LinearParameters {
        useful_area,
        moving_mass: parameters.moving_mass,
        viscous_friction: parameters.viscous_friction,
        flow_gain: useful_area / hydraulic_stiffness * gain,
        flow_pressure_coefficient: useful_area.squared() * product / damper,
        hydraulic_stiffness,
        sensor_stiffness: parameters.sensor_stiffness,
        valve_natural_frequency: parameters.valve_natural_frequency,
        valve_damping_ratio: parameters.valve_damping_ratio,
    }
}

/// Reduction and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// Effective parameters.
    pub parameters: LinearParameters,
    /// Ratio of the static force per volt of the reduction to that of the two-pressure model; 1 if
    /// exact.
    pub static_gain_ratio: f64,
    /// Largest differences of the force's response to the command.
    pub command: ResponseDifference,
    /// Largest differences of the force's response to load motion.
    pub load_motion: ResponseDifference,
}

/// Reduces a two-pressure model to (6.7) and measures the difference at these frequencies in rad/s.
///
/// # Errors
/// Coefficients that are not finite, or no frequencies.
///
/// # Example
/// Exact at mid stroke of the symmetric cylinder if the edges of the valve are equal:
/// ```
/// use phea_hydraulics::actuator::{Actuator, Components};
/// use phea_hydraulics::line::StiffeningMember;
/// use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// use phea_hydraulics::reference_rig::{components, hose_line, valve_with_equal_edges};
/// use phea_hydraulics::servovalve::SpoolDirection;
/// use phea_hydraulics::stiffness::StiffnessModel;
/// use phea_hydraulics::two_pressure::{TwoPressureModel, reduction, two_pressure_linear_parameters};
/// let rig = components(hose_line(), StiffnessModel::ByVolume);
/// let actuator = Actuator::new(Components { valve: valve_with_equal_edges(), ..rig })?;
/// let point = operating_point(&actuator, 0.25, Condition::Load(SteadyLoad::Force(0.0)))?;
/// let pressures = [point.pressure_a, point.pressure_b];
/// let model = TwoPressureModel::new(&actuator, pressures, StiffeningMember::Nominal, 100.0);
/// let parameters = two_pressure_linear_parameters(&model, &point, SpoolDirection::Mean);
/// let reduced = reduction(&parameters, &[1.0, 10.0, 100.0, 1000.0])?;
/// assert!((reduced.static_gain_ratio - 1.0).abs() < 1e-6);
/// assert!(reduced.command.magnitude_db < 1e-5 && reduced.load_motion.magnitude_db < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reduction(
    parameters: &TwoPressureLinearParameters,
    frequencies: &[f64],
) -> Result<Reduction, LinearError> {
    let full = transfer_functions(&two_pressure_coefficients(parameters))?;
    let reduced_parameters = reduce(parameters);
    let reduced = linear_model(&reduced_parameters)?;
    let compare = |full: &phea_dynamics::linear::TransferFunction,
                   reduced: &phea_dynamics::linear::TransferFunction| {
        response_difference(frequencies, |w| full.at_frequency(w), |w| reduced.at_frequency(w))
    };
    Ok(Reduction {
        parameters: reduced_parameters,
        static_gain_ratio: reduced.command.dc_gain() / full.command.dc_gain(),
        command: compare(&full.command, &reduced.command),
        load_motion: compare(&full.load_position, &reduced.load_position),
    })
}
