//! Checks of the pressure supply.

use phea_table::TableCheck;

use super::drives_nothing;
use super::keys::{DeclaredSupply, Pump, SupplyModel};

impl DeclaredSupply {
    /// Checks the pressures, and the accumulator of a pump.
    pub fn check(&self, check: &mut dyn TableCheck) {
        if self.pressure > 0.0 && drives_nothing(self.pressure, self.tank_pressure) {
            let at = check.written_path("supply.tank_pressure".to_string(), "supply.pressure");
            check.error(&at, "`tank_pressure` must be below `pressure`");
        }
        if let SupplyModel::PumpLimited(Pump { accumulator: Some(gas), .. }) = &self.model {
            gas.check_at_pump(self.pressure, "supply.accumulator", check);
        }
    }
}
