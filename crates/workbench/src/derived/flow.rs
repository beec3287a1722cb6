use phea_engineering::rig::{FlowLimit, Rig, largest_flow};
use phea_engineering::setup::Setup;
use phea_hydraulics::line::Line;

use super::list::List;
use crate::quantity::VELOCITY;

/// The speed at which the flow of the pump drives the piston, for each direction if they differ.
fn piston_speed(flow: f64, [area_a, area_b]: [f64; 2], list: &mut List) {
    let unit = list.si(&VELOCITY);
    let differs = area_a.total_cmp(&area_b).is_ne();
    let equation = match (list.motion.is_rotary(), differs) {
        (true, _) => "ω_{max} = q_{pump}/D",
        (false, false) => "v_{max} = q_{pump}/A, in both directions",
        (false, true) => "v_{max} = q_{pump}/A_A, extending",
    };
    let (name, symbol) =
        list.motion.either(("supply.piston_speed", "v_max"), ("supply.shaft_speed", "ω_max"));
    list.add(name, symbol, flow / area_a, unit, equation);
    if differs {
        let equation = "v_{max} = q_{pump}/A_B, retracting";
        list.add("supply.piston_speed_retracting", "v_max", flow / area_b, unit, equation);
    }
}

/// The flow of the pump: speed of the actuator and velocity of the oil in the lines.
pub(super) fn flow(setup: &Setup<'_>, rig: &Rig, list: &mut List) {
    let Some(declared) = &setup.project.actuator else { return };
    let components = rig.actuator.components();
    list.group("Flow");
    if let Some(flow) = declared.supply.flow() {
        piston_speed(flow, components.cylinder.greatest_areas(), list);
    }
    let largest = largest_flow(components, &declared.supply);
    let equation = match largest.limit {
        FlowLimit::Pump => "v_{oil} = 4 q/(π D_{ho}^2), unloaded, q_{pump} into the valve",
        FlowLimit::Valve => "v_{oil} = 4 q/(π D_{ho}^2), unloaded, the valve fully open",
    };
    let (a, b) = (components.line_a, components.line_b);
    let [flow_a, flow_b] = largest.lines;
    let lines = match a == b {
        true => vec![("line", a, largest.line())],
        false => vec![("line.a", a, flow_a), ("line.b", b, flow_b)],
    };
    for (name, line, flow) in lines {
        let bore = match line {
            Line::Hose { hose, .. } => hose.bore,
            Line::Pipe { pipe, .. } => pipe.bore,
            Line::Volume { .. } => continue,
        };
        let velocity = 4.0 * flow / (std::f64::consts::PI * bore * bore);
        list.add(format!("{name}.oil_velocity"), "v_oil", velocity, "m/s", equation);
    }
}
