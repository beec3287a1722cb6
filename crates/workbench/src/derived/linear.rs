use super::list::List;
use crate::quantity::{DAMPING, MASS, STIFFNESS};
use crate::rig::{ParameterOrigin, Rig};
use crate::setup::Setup;

/// Equations of the flow gain and of the flow-pressure coefficient, for a cylinder and for a motor.
pub(super) const FLOW_GAIN: &str = "K_{qU} = A_u (A_A K_{qA}/C_A + A_B K_{qB}/C_B)/K_H";
const FLOW_GAIN_OF_A_MOTOR: &str = "K_{qU} = D^2 (K_{qA}/C_A + K_{qB}/C_B)/K_θ";
pub(super) const SLOPES: &str = "A_u^2/K_c = A_A^2/K_{cA} + A_B^2/K_{cB}";
const SLOPES_OF_A_MOTOR: &str = "1/K_c = 1/K_{cA} + 1/K_{cB}";

/// The parameters of the linear model, and those that are stated in their place.
pub(super) fn linear(_: &Setup<'_>, rig: &Rig, list: &mut List) {
    list.group("Linear model");
    let slopes = match rig.actuator.components().outward.external_leakage {
        None => list.motion.either(SLOPES, SLOPES_OF_A_MOTOR),
        Some(_) => "1/K_c = 1/(K_{cA} + G_e) + 1/(K_{cB} + G_e), with the leakage G_e through the case",
    };
    let (motion, symbols) = (list.motion, list.motion.symbols());
    let flow_gain = motion.either(FLOW_GAIN, FLOW_GAIN_OF_A_MOTOR);
    let stiffness = motion.either(
        "K_H = A_A^2/C_A + A_B^2/C_B at the operating point",
        "K_θ = D^2 (1/C_A + 1/C_B) at the operating point",
    );
    for parameter in &rig.parameters {
        let (symbol, unit, equation) = match parameter.name {
            "viscous_friction" => ("f_v", list.si(&DAMPING), "f_v = slope of the viscous part"),
            "flow_gain" => ("K_qU", "m3/(s.V)", flow_gain),
            "flow_pressure_coefficient" => ("K_c", "m3/(s.Pa)", slopes),
            "hydraulic_stiffness" => (symbols.stiffness, list.si(&STIFFNESS), stiffness),
            "valve_natural_frequency" => ("ω_nv", "rad/s", "declared for the valve"),
            "valve_damping_ratio" => ("ξ_v", "1", "declared for the valve"),
            "moving_mass" => (
                symbols.mass,
                list.si(&MASS),
                motion.either("declared for the cylinder", "declared for the motor"),
            ),
            "piston_area" if motion.is_rotary() => ("D", "m3/rad", "declared for the motor"),
            "piston_area" => ("A_u", "m2", "A_u = (A_A + A_B)/2"),
            _ => (
                "K_S",
                list.si(&STIFFNESS),
                motion.either("declared for the force sensor", "declared for the torque sensor"),
            ),
        };
        list.add(format!("linear.{}", parameter.name), symbol, parameter.derived, unit, equation);
        match parameter.origin {
            ParameterOrigin::Linear => list.stated(parameter.value, "[linear]", parameter.bounds),
            ParameterOrigin::Uncertainty => list.stated(parameter.value, "[uncertainty]", parameter.bounds),
            ParameterOrigin::Derived => {}
        }
    }
}
