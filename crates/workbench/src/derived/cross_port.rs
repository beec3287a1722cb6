use phea_engineering::rig::{CrossPortAtPoint, Rig, cross_port_at_point};
use phea_engineering::setup::Setup;
use phea_hydraulics::cross_port::{DynamicFeedback, Restrictor};

use super::list::List;

/// A valve between the chambers: its flow and its cost at rest, and the origin of its feedback.
pub(super) fn cross_port(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let Some(found) = cross_port_at_point(rig) else { return };
    list.group("Valve between the chambers");
    if let Restrictor::Orifice { flow_coefficient, .. } = found.valve.restrictor {
        let equation = "K_{cp} = C_d π/4 d^2 sqrt(2/ρ), or q/sqrt(Δp) as stated";
        list.add("cross_port.flow_coefficient", "K_cp", flow_coefficient, "m3/(s.Pa^0.5)", equation);
    }
    let slope = match found.valve.capacity {
        None => "G_{cp} = dq_{cp}/d(p_A - p_B) at the operating point",
        Some(_) => "g = dq_{cp}/dΔp without a drop",
    };
    list.add("cross_port.conductance", "G_cp", found.conductance, "m3/(s.Pa)", slope);
    let equation = match found.valve.capacity {
        None => "q_{cp} at p_A - p_B of the operating point, from A to B",
        Some(_) => "0 at rest: the capacity holds p_A - p_B",
    };
    list.add("cross_port.flow", "q_cp", found.flow, "m3/s", equation);
    list.add("cross_port.loss", "P_cp", found.loss(), "W", "P_{cp} = q_{cp} (p_A - p_B)");
    match DynamicFeedback::of(&found.valve) {
        Some(feedback) => {
            list.add(
                "cross_port.capacity",
                "C_cp",
                feedback.capacity,
                "m3/Pa",
                "C_{cp} = A_{cp}^2/k_{cp}, or as stated",
            );
            list.add("cross_port.corner_frequency", "ω_cp", feedback.corner(), "rad/s", "ω_{cp} = g/C_{cp}");
            let supply = &rig.actuator.components().supply;
            let greatest = feedback.capacity * (supply.pressure - supply.tank_pressure);
            let equation = "V_{cp} = C_{cp} (p_S - p_T), to either side";
            list.add("cross_port.displaced_volume", "V_cp", greatest, "m3", equation);
        }
        None => static_error(setup, &found, list),
    }
}

/// Effect of a leak on the force at rest: the gain of the plant at rest, and the static error of
/// the given controller if it does not integrate.
fn static_error(setup: &Setup<'_>, found: &CrossPortAtPoint, list: &mut List) {
    let [with, without] = found.static_gains;
    let (equation, unit) =
        list.motion.either(("P(0) = F_e/U_C at rest", "N/V"), ("P(0) = T_e/U_C at rest", "N.m/V"));
    list.add("cross_port.static_gain", "P(0)", with, unit, equation);
    list.add("cross_port.static_gain_without", "P(0)", without, unit, "P(0) with q_{cp} = 0");
    let given = setup.controller.as_ref();
    let Some(feedback) = given.and_then(|given| given.feedback.transfer_function().ok()) else { return };
    let origin = if feedback.domain() == phea_dynamics::linear::TimeDomain::Continuous { 0.0 } else { 1.0 };
    let integrates = feedback.poles().iter().any(|pole| (pole.re - origin).abs() < 1e-12 && pole.im == 0.0);
    let gain = feedback.dc_gain() * setup.sensor.dc_gain();
    let name = "cross_port.static_error";
    let equation = "e = 1/(1 + G(0) P(0) H(0)), of the reference";
    list.add(name, "e", if integrates { 0.0 } else { 1.0 / (1.0 + gain * with) }, "1", equation);
}
