//! Checks of the servovalve.

use phea_table::TableCheck;

use super::keys::{NullLeakage, Valve};
use super::{LeakageModel, OpeningShape, SpoolImperfection};
use crate::power_unit::DeclaredSupply;

impl Valve {
    /// Checks coefficients, leakage and imperfections of the spool at this supply.
    pub fn check(&self, supply: &DeclaredSupply, check: &mut dyn TableCheck) {
        self.check_imperfections(check);
        if self.leakage_shapes.is_some() && self.leakage_model == LeakageModel::OneCurve {
            check.error(
                "valve.leakage_shapes",
                "`leakage_model = \"one_curve\"` has one shape for the leakage of the whole valve: state `leakage_shape`, or the shapes of the edges \
                 with `leakage_model = \"each_edge\"`",
            );
        }
        let laps = self.lap.iter().flat_map(|lap| [("positive", lap.positive), ("negative", lap.negative)]);
        for (side, _) in laps.filter(|(_, lap)| OpeningShape::exceeds_travel(*lap)) {
            let message = "a lap is less than the full travel of the spool, 100 %";
            check.error(&format!("valve.lap.{side}"), message);
        }
        if self.flow.edges().is_some_and(|edges| edges.to_array().iter().all(|edge| *edge == 0.0)) {
            check.error("valve.flow_coefficients", "all flow coefficients are zero: the valve never opens");
        }
        let Some(NullLeakage { flow, maximum, pressure }) = self.leakage.rating() else { return };
        if *flow < self.tare_flow * (pressure / self.tare_drop(supply)).sqrt() {
            check.error(
                "valve.null_leakage",
                "`null_leakage` includes `tare_flow`, so it cannot be below it, each at its own pressure",
            );
        }
        if maximum.is_some_and(|maximum| maximum < *flow) {
            check.error("valve.null_leakage_maximum", "`null_leakage_maximum` is below `null_leakage`");
        }
    }

    fn check_imperfections(&self, check: &mut dyn TableCheck) {
        if let (Some(width), Some(threshold)) = (self.hysteresis, self.threshold)
            && SpoolImperfection::lacks_threshold(width, threshold)
        {
            check.error("valve.hysteresis", "`hysteresis` includes `threshold`, so it must be above it");
        }
        if self.null_bias.abs() >= self.nominal_voltage && self.nominal_voltage > 0.0 {
            check.error("valve.null_bias", "`null_bias` must be within the `nominal_voltage`");
        }
    }
}
