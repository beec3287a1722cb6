//! A valve between the chambers: conditions on its orifice.

use super::Check;
use crate::{Component, CrossPortKind, DeclaredActuator, DeclaredLine, DeclaredOrifice, OrificeSize};
use phea_quantity::{self as quantity, LENGTH};

/// Discharge coefficient by which a flow tells an opening.
const DISCHARGE_COEFFICIENT: f64 = 0.6;

pub(super) fn cross_port(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let Some(port) = &actuator.cross_port else { return };
    if let Some(orifice) = port.orifice() {
        orifice_within_port(orifice, actuator, check);
    }
    let mut pairs = vec![];
    if !matches!(port.kind, CrossPortKind::Laminar { .. }) {
        pairs.extend([("discharge_coefficient", "diameter"), ("pressure_drop", "flow")]);
    }
    if matches!(port.kind, CrossPortKind::DynamicPressureFeedback { .. }) {
        pairs.push(("spring_stiffness", "piston_diameter"));
        if port.orifice().is_none() {
            pairs.push(("transition_pressure", "diameter"));
        }
    }
    for (name, beside) in pairs {
        let written = |name: &str| check.declared(&format!("cross_port.{name}"));
        if written(name) && !written(beside) {
            check
                .warning(&format!("cross_port.{name}"), format!("`{name}` has no effect without `{beside}`"));
        }
    }
}

/// An orifice throttles only where it is narrower than the ports of the cylinder: the narrower line,
/// or the piston where the lines are plain volumes.
fn orifice_within_port(orifice: &DeclaredOrifice, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let (key, diameter) = match orifice.size {
        OrificeSize::Diameter { diameter, .. } => ("diameter", diameter),
        OrificeSize::Flow { flow, pressure_drop } => {
            let velocity = DISCHARGE_COEFFICIENT * (2.0 * pressure_drop / actuator.fluid.density).sqrt();
            ("flow", (4.0 * flow / (std::f64::consts::PI * velocity)).sqrt())
        }
    };
    let bores = [&actuator.line.a, &actuator.line.b].into_iter().filter_map(bore);
    let (port, what) = match bores.reduce(f64::min) {
        Some(bore) => (bore, "the bore of the line"),
        // nothing is known of the ports of a motor
        None if actuator.motor.is_some() => return,
        None => (actuator.cylinder.piston_diameter_m(), "the piston"),
    };
    if !(port > 0.0 && diameter >= port) {
        return;
    }
    let [own, port] = [diameter, port].map(|length| quantity::display(length, &LENGTH, 3));
    let message = match key {
        "diameter" => format!("the orifice is {own} wide and {what} {port}: it is no narrower than the port"),
        _ => format!(
            "an orifice of {own} passes this `flow`, and {what} is {port}: it is no narrower than the port"
        ),
    };
    let help = "an orifice throttles where it is narrower than what leads to it: state a smaller one";
    check.error_with_help(&format!("cross_port.{key}"), message, help);
}

/// m, of a hose or a pipe.
fn bore(line: &DeclaredLine) -> Option<f64> {
    match &line.component {
        Component::Hose { properties, .. } => Some(properties.bore),
        Component::Pipe { pipe, .. } => Some(pipe.bore),
        Component::Volume(_) => None,
    }
}
