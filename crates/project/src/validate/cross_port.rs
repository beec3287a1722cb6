//! Valve between the chambers: conditions on its orifice.

use super::Check;
use crate::{Component, CrossPortKind, DeclaredActuator, DeclaredLine, DeclaredOrifice, OrificeSize};
use phea_quantity::{self as quantity, LENGTH};

/// Discharge coefficient for the opening that corresponds to a flow.
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

/// Checks the orifice, which throttles only if it is narrower than the ports of the cylinder: the
/// narrower line, or the piston if the lines are plain volumes.
fn orifice_within_port(orifice: &DeclaredOrifice, actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    let bores = [&actuator.line.a, &actuator.line.b].into_iter().filter_map(bore);
    let port = match bores.reduce(f64::min) {
        Some(bore) => (bore, OF_LINE),
        // the ports of a motor are unknown
        None if actuator.motor.is_some() => return,
        None => (actuator.cylinder.piston_diameter_m(), "the piston"),
    };
    narrower(orifice, actuator.fluid.density, port, "cross_port", check);
}

const OF_LINE: &str = "the bore of the line";

/// Checks the valve between a chamber and its gas, which throttles only if it is narrower than the
/// line there.
pub(super) fn gas_valves_within_lines(actuator: &DeclaredActuator, check: &mut Check<'_, '_>) {
    for (own, line) in [("line.a", &actuator.line.a), ("line.b", &actuator.line.b)] {
        let Some((bore, gas)) = bore(line).zip(line.accumulator.as_ref()) else { continue };
        let own = format!("{own}.accumulator");
        let path = if check.declared(&own) { own } else { "line.accumulator".to_string() };
        if let Some(valve) = gas.adjustment.as_ref().and_then(|of| of.valve()) {
            let path = format!("{path}.adjustment");
            narrower(&valve.orifice, actuator.fluid.density, (bore, OF_LINE), &path, check);
        }
        if let Some(neck) = gas.neck.filter(|neck| bore > 0.0 && neck.diameter > bore) {
            let [own, bore] = [neck.diameter, bore].map(|length| quantity::display(length, &LENGTH, 3));
            let message = format!(
                "the neck is {own} wide and {OF_LINE} {bore}: the oil passes the line first, which then is the neck"
            );
            let help = "state the narrowest passage between chamber and gas";
            check.warning_with_help(&format!("{path}.neck_diameter"), message, help);
        }
    }
}

/// Reports an orifice in the table at `path` that is no narrower than the part leading to it, given
/// by its diameter in m and its name.
fn narrower(
    orifice: &DeclaredOrifice,
    density: f64,
    (port, what): (f64, &str),
    path: &str,
    check: &mut Check<'_, '_>,
) {
    let (key, diameter) = match orifice.size {
        OrificeSize::Diameter { diameter, .. } => ("diameter", diameter),
        OrificeSize::Flow { flow, pressure_drop } => {
            let velocity = DISCHARGE_COEFFICIENT * (2.0 * pressure_drop / density).sqrt();
            ("flow", (4.0 * flow / (std::f64::consts::PI * velocity)).sqrt())
        }
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
    check.error_with_help(&format!("{path}.{key}"), message, help);
}

/// Bore of a hose or a pipe, m.
fn bore(line: &DeclaredLine) -> Option<f64> {
    match &line.component {
        Component::Hose { properties, .. } => Some(properties.bore),
        Component::Pipe { pipe, .. } => Some(pipe.bore),
        Component::Volume(_) => None,
    }
}
