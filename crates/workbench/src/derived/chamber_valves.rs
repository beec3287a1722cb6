use phea_hydraulics::cross_port::{DynamicFeedback, Restrictor};
use phea_hydraulics::port_valves::PortValveKind;

use super::list::List;
use crate::rig::{CrossPortAtPoint, Rig, cross_port_at_point};
use crate::setup::Setup;

/// Valves at the chambers.
pub(super) fn chamber_valves(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    cross_port(setup, rig, list);
    port_valves(rig, list);
}

/// Relief and check valves: their conductances, the pressures at which they open, and their flow
/// and loss at rest.
fn port_valves(rig: &Rig, list: &mut List) {
    let components = rig.actuator.components();
    let tank = components.supply.tank_pressure;
    let sides = components.outward.port_valves.iter().zip([rig.point.pressure_a, rig.point.pressure_b]);
    for ((valves, pressure), side) in sides.zip(["a", "b"]) {
        let Some(valves) = valves else { continue };
        list.group("Valves to the tank");
        for valve in valves.at_point(pressure, tank) {
            let (name, symbols, equations) = match valve.kind {
                PortValveKind::Relief => ("relief", ["p_r", "G_r"], ["p_T + p_r", "G_r = q/override"]),
                PortValveKind::Check => ("check_valve", ["p_c", "G_c"], ["p_T - p_c", "G_c = q/override"]),
            };
            let name = |quantity: &str| format!("port_valves.{side}.{name}_{quantity}");
            list.add(name("pressure"), symbols[0], valve.opens_at, "Pa", equations[0]);
            list.add(name("conductance"), symbols[1], valve.open_conductance, "m3/(s.Pa)", equations[1]);
        }
        let flow = valves.flow(pressure - tank);
        let equation = "q_r + q_c at the operating point, out of the chamber";
        list.add(format!("port_valves.{side}.flow"), "q_e", flow, "m3/s", equation);
        let slope = format!("port_valves.{side}.conductance");
        list.add(slope, "G_e", valves.slope(pressure - tank), "m3/(s.Pa)", "dq_e/dp at the operating point");
        let loss = flow * (pressure - tank);
        list.add(format!("port_valves.{side}.loss"), "P_e", loss, "W", "P_e = q_e (p - p_T)");
    }
}

/// A valve between the chambers: its flow and its cost at rest, and the origin of its feedback.
fn cross_port(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
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
