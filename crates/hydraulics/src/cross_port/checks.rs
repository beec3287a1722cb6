//! Checks of the valve between the chambers, and of an orifice in general.

use phea_quantity::{self as quantity, LENGTH};
use phea_table::TableCheck;

use super::keys::{CrossPortKind, DeclaredCrossPort, DeclaredOrifice, OrificeSize};

/// Discharge coefficient for the opening that corresponds to a flow.
const DISCHARGE_COEFFICIENT: f64 = 0.6;

impl DeclaredCrossPort {
    /// Checks the orifice in a fluid of this density in kg/m3, and keys without effect. It
    /// throttles only if it is narrower than the ports of the actuator, given by their diameter in
    /// m and name; `None` if they are unknown.
    pub fn check(&self, density: f64, port: Option<(f64, &str)>, check: &mut dyn TableCheck) {
        if let Some((orifice, port)) = self.orifice().zip(port) {
            orifice.check_narrower(density, port, "cross_port", check);
        }
        let mut pairs = vec![];
        if !matches!(self.kind, CrossPortKind::Laminar { .. }) {
            pairs.extend([("discharge_coefficient", "diameter"), ("pressure_drop", "flow")]);
        }
        if matches!(self.kind, CrossPortKind::DynamicPressureFeedback { .. }) {
            pairs.push(("spring_stiffness", "piston_diameter"));
            if self.orifice().is_none() {
                pairs.push(("transition_pressure", "diameter"));
            }
        }
        for (name, needed) in pairs {
            let written = |name: &str| check.declared(&format!("cross_port.{name}"));
            if written(name) && !written(needed) {
                let message = format!("`{name}` has no effect without `{needed}`");
                check.warning(&format!("cross_port.{name}"), message);
            }
        }
    }
}

impl DeclaredOrifice {
    /// Reports an orifice in the table at `path` that is no narrower than the part leading to it,
    /// given by its diameter in m and its name.
    pub(crate) fn check_narrower(
        &self,
        density: f64,
        (port, what): (f64, &str),
        path: &str,
        check: &mut dyn TableCheck,
    ) {
        let (key, diameter) = match self.size {
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
            "diameter" => {
                format!("the orifice is {own} wide and {what} {port}: it is no narrower than the port")
            }
            _ => format!(
                "an orifice of {own} passes this `flow`, and {what} is {port}: it is no narrower than the port"
            ),
        };
        let help = "an orifice throttles where it is narrower than what leads to it: state a smaller one";
        check.error_with_help(&format!("{path}.{key}"), message, help);
    }
}
