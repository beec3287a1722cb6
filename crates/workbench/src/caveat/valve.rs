//! Effects of the servovalve and of valves at the chambers.

use crate::quantity::{FLOW, MotionKind, PRESSURE, Units, VOLTAGE, display, significant};
use phea_hydraulics::port_valves::{PortValveKind, ValveAtPoint, ValveOpening};

pub(super) const DYNAMIC_PRESSURE_FEEDBACK: &str = "cross_port.kind = \"dynamic_pressure_feedback\" is counted in the plant and the impedance at the load: the other models and the \
     asymptotes of the impedance are without it";

pub(super) fn leakage_humps(command: f64, greatest: f64, least: f64) -> String {
    let [most, least] = [greatest, least].map(|flow| display(flow, &FLOW, 3));
    format!(
        "the valve leaks most near null, {most} at {}, and {least} at null, where measured valves leak most: valve.leakage_shape, which \
         sets over what command the leakage falls, is too small for these flow coefficients",
        display(command, &VOLTAGE, 3)
    )
}

pub(super) fn overlap(dead_band: [f64; 2], gain_ratio: f64) -> String {
    let [from, to] = dead_band.map(|spool| display(spool, &VOLTAGE, 3));
    format!(
        "the edges of the valve overlap from {from} to {to}: between them its flow gain without load is {} % of that beyond (valve.lap). Each plant is that \
         of small motions about its operating point; only a simulation shows a loop that crosses the lap, and hunts there where it has an \
         integrator",
        significant(100.0 * gain_ratio, 2)
    )
}

pub(super) fn null_sides(flow_gains: [f64; 2], mean: f64, motion: MotionKind) -> String {
    let piston = motion.words().piston;
    let [below, above] = flow_gains.map(|gain| significant(gain, 3));
    let mean = significant(mean, 3);
    format!(
        "at null K_qU is {below} m3/(s.V) where the {piston} retracts and {above} where it extends: these models have the mean, {mean}, \
         unless it is stated; verify and design have both sides, and operating_point.spool_side = -1 or 1 takes one"
    )
}

pub(super) fn cross_port_orifice(
    drop: Option<f64>,
    transition_pressure: f64,
    conductance: f64,
    has_range: bool,
) -> String {
    let conductance = significant(conductance, 3);
    let transition = display(transition_pressure, &PRESSURE, 3);
    let at = match drop {
        None => "no drop at rest".to_string(),
        Some(drop) => format!("a drop of {} at rest", display(drop, &PRESSURE, 3)),
    };
    let path = "cross_port.transition_pressure";
    let remedy = match has_range {
        true => format!("the range of {path} says up to which oscillation"),
        false => format!(
            "state a range of {path} in [uncertainty], up to 0.81 times the amplitude of the drop, or judge by a simulation"
        ),
    };
    format!(
        "cross_port is counted for small motions: its orifice has {at}, and there the slope of its transition_pressure of {transition}, \
         {conductance} m3/(s.Pa); an oscillation beyond that is damped less: {remedy}"
    )
}

/// A valve that the sizing procedure, in which the chambers hold their oil, does not include.
pub(crate) fn port_valve_in_sizing(side: char, valve: &ValveAtPoint, units: &Units) -> String {
    let (name, beyond) = name_and_direction(valve.kind);
    let [pressure, opens_at] = [valve.pressure, valve.opens_at].map(|one| units.pressure.short(one, 4));
    let whole = format!("port_valves: the {name} of chamber {side} opens {beyond} {opens_at}");
    match valve.opening {
        ValveOpening::Shut => format!(
            "{whole}, which the supply reaches: stiffness, gain and time constant are those of a shut valve, and the largest flow is that without it"
        ),
        ValveOpening::InTransition | ValveOpening::Open => format!(
            "{whole} and passes oil at the operating point, at {pressure}: sizing has every such valve shut, so move the operating point away from {opens_at}, or \
             judge the sized hose by `verify` and a simulation"
        ),
    }
}

/// The name of a valve, and the direction of the pressure in which it opens.
fn name_and_direction(kind: PortValveKind) -> (&'static str, &'static str) {
    match kind {
        PortValveKind::Relief => ("relief valve", "above"),
        PortValveKind::Check => ("check valve", "below"),
    }
}

pub(super) fn port_valve(side: char, valve: &ValveAtPoint, units: &Units) -> String {
    let ValveAtPoint { kind, opening, pressure, opens_at, conductance, open_conductance } = *valve;
    let (name, beyond) = name_and_direction(kind);
    let [pressure, opens_at] = [pressure, opens_at].map(|pressure| units.pressure.short(pressure, 4));
    let [conductance, open_conductance] = [conductance, open_conductance].map(|one| significant(one, 3));
    let whole = format!("port_valves: the {name} of chamber {side}");
    match opening {
        ValveOpening::Shut => format!(
            "{whole} opens {beyond} {opens_at}, which the supply reaches: each plant has the valve as it is at its operating point, here shut at \
             {pressure}, and only a simulation shows a motion that opens it"
        ),
        ValveOpening::InTransition => format!(
            "{whole} is within its transition at the operating point, at {pressure}: each plant has its slope there, {conductance} m3/(s.Pa), and a motion \
             beyond port_valves.transition_pressure another one, up to {open_conductance}; move the operating point away from {opens_at}, or judge by a \
             simulation"
        ),
        ValveOpening::Open => format!(
            "{whole} is open at the operating point, at {pressure}: it opens {beyond} {opens_at}, passes oil at rest and damps with {conductance} m3/(s.Pa), \
             which a motion that shuts it does not have"
        ),
    }
}
