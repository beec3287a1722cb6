//! Checks of the relief and check valves.

use phea_quantity::{self as quantity, PRESSURE};
use phea_table::TableCheck;

use super::component::TRANSITION_PRESSURE;
use super::{DeclaredPortValve, DeclaredPortValves};

impl DeclaredPortValves {
    /// Reports a relief valve that is not shut at the pressure of the tank.
    pub fn check(&self, check: &mut dyn TableCheck) {
        for (side, valves) in [("a", &self.a), ("b", &self.b)] {
            valves.check_transition(side, check);
        }
    }
}

impl DeclaredPortValve {
    fn check_transition(&self, side: &str, check: &mut dyn TableCheck) {
        let width = self.transition_pressure.unwrap_or(TRANSITION_PRESSURE);
        let Some([cracking, _]) = self.relief().filter(|[cracking, _]| *cracking < width) else { return };
        let keys = ["transition_pressure", "cracking_pressure"];
        let paths = keys
            .into_iter()
            .flat_map(|key| [format!("port_valves.{side}.{key}"), format!("port_valves.{key}")]);
        let path = paths.into_iter().find(|path| check.declared(path));
        let [width, cracking] = [width, cracking].map(|pressure| quantity::display(pressure, &PRESSURE, 3));
        let message = format!(
            "the relief valve cracks {cracking} above the tank, and its transition extends {width} to either side: it would be open at the pressure of the tank"
        );
        let help = format!("state a `transition_pressure` of at most {cracking}");
        check.error_with_help(&path.unwrap_or_else(|| "port_valves".to_string()), message, help);
    }
}
