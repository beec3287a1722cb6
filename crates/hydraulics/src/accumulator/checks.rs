//! Checks of an accumulator at a chamber or at a pump.

use phea_quantity::{self as quantity, LENGTH, PRESSURE};
use phea_table::TableCheck;

use super::adjustment_keys::{AdjustmentKind, GasAtOne};
use super::keys::DeclaredAccumulator;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE as ATMOSPHERE;

impl DeclaredAccumulator {
    /// Checks the gas at a pump that holds this pressure in Pa, in the table at `path`.
    pub(crate) fn check_at_pump(&self, pressure: f64, path: &str, check: &mut dyn TableCheck) {
        if self.is_reached(pressure, (path, "the pump never lets oil into it"), check) {
            self.check_pressure_ratio(pressure, &format!("{path}.maximum_pressure_ratio"), check);
        }
    }

    /// Checks the gas at a chamber, in the table at `path`: its precharge must be below the
    /// pressure of the supply in Pa.
    pub fn check_at_chamber(&self, supply: f64, path: &str, check: &mut dyn TableCheck) {
        if self.thermal_time_constant.is_some() && check.declared(&format!("{path}.polytropic_exponent")) {
            let message = "`polytropic_exponent` and `thermal_time_constant` both describe the heat between gas and wall: state one of them";
            check.error(&format!("{path}.polytropic_exponent"), message);
        }
        if !self.is_reached(supply, (path, "no chamber ever lets oil into this accumulator"), check) {
            return;
        }
        self.check_adjustment(supply, &format!("{path}.adjustment"), check);
        if check.refused(&format!("{path}.precharge_pressure")) {
            return;
        }
        // compressed most at its least precharge
        let [first, last] = self.ends();
        let most = if last.precharge_pressure < first.precharge_pressure { last } else { first };
        most.check_pressure_ratio(supply, &format!("{path}.maximum_pressure_ratio"), check);
    }

    /// Checks the passage between a chamber and its gas in a fluid of this density in kg/m3: a
    /// valve throttles only if it is narrower than the line there, which has this bore in m.
    pub fn check_passage(&self, density: f64, bore: f64, path: &str, check: &mut dyn TableCheck) {
        if let Some(valve) = self.adjustment.as_ref().and_then(|of| of.valve()) {
            let path = format!("{path}.adjustment");
            valve.orifice.check_narrower(density, (bore, BORE_OF_LINE), &path, check);
        }
        if let Some(neck) = self.neck.filter(|neck| bore > 0.0 && neck.diameter > bore) {
            let [own, bore] = [neck.diameter, bore].map(|length| quantity::display(length, &LENGTH, 3));
            let message = format!(
                "the neck is {own} wide and {BORE_OF_LINE} {bore}: the oil passes the line first, which then is the neck"
            );
            let help = "state the narrowest passage between chamber and gas";
            check.warning_with_help(&format!("{path}.neck_diameter"), message, help);
        }
    }

    /// Checks the maker's limit of the compression of the gas, at the highest pressure of the
    /// supply in Pa; `path` is the place of the error.
    pub fn check_pressure_ratio(&self, supply: f64, path: &str, check: &mut dyn TableCheck) {
        let Some(limit) = self.maximum_pressure_ratio else { return };
        let precharge = self.working_precharge(ATMOSPHERE) + ATMOSPHERE;
        let stated = (self.precharge_pressure + ATMOSPHERE) / precharge;
        let pressure = supply + ATMOSPHERE;
        let is_beyond = pressure > limit * precharge;
        if !is_beyond {
            return;
        }
        let ratio = quantity::significant(pressure / precharge, 3);
        let supplied = quantity::display(supply, &PRESSURE, 4);
        let needed = quantity::display(stated * pressure / limit - ATMOSPHERE, &PRESSURE, 4);
        let at = self.at_working_temperature();
        let message = format!(
            "at the supply pressure of {supplied} the gas has {ratio} times the absolute pressure of its precharge{at}, and \
             `maximum_pressure_ratio` permits {limit}"
        );
        let help = format!("raise `precharge_pressure` to {needed} or more, or lower the supply pressure");
        check.error_with_help(path, message, help);
    }

    /// True if the pressure of the supply in Pa is above the precharge of this gas; otherwise
    /// reports an error with its consequence.
    fn is_reached(&self, supply: f64, (path, consequence): (&str, &str), check: &mut dyn TableCheck) -> bool {
        let working = self.working_precharge(ATMOSPHERE);
        let beyond = supply > 0.0 && working >= supply;
        if !beyond {
            return true;
        }
        let [precharge, pressure] =
            [working, supply].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
        let at = self.at_working_temperature();
        let message =
            format!("`precharge_pressure` is {precharge}{at} and the supply has {pressure}: {consequence}");
        check.error_with_help(&format!("{path}.precharge_pressure"), message, LOWER_PRECHARGE);
        false
    }

    fn at_working_temperature(&self) -> &'static str {
        if self.temperatures.is_some() { " at `working_temperature`" } else { "" }
    }

    /// Checks the adjustment of the gas, in the table at `path`.
    fn check_adjustment(&self, supply: f64, path: &str, check: &mut dyn TableCheck) {
        let Some(declared) = &self.adjustment else { return };
        match &declared.kind {
            AdjustmentKind::Valve(_) => {
                if self.neck.is_some() {
                    let message = "a `valve` lies between chamber and gas, and the accumulator states a neck: one of them leads to the gas";
                    let help = "leave out `neck_diameter` and `neck_length`, or adjust the `gas`";
                    check.error_with_help(&format!("{path}.kind"), message, help);
                }
            }
            AdjustmentKind::Gas(last) => {
                if self.thermal_time_constant.is_some() {
                    let message = "which temperature gas has that is added is not modelled: `kind` \"gas\" goes with a `polytropic_exponent`";
                    let help = "leave out `thermal_time_constant`, or adjust by a `valve`";
                    check.error_with_help(&format!("{path}.kind"), message, help);
                }
                self.check_moved(last, supply, path, check);
            }
        }
    }

    fn check_moved(&self, last: &GasAtOne, supply: f64, path: &str, check: &mut dyn TableCheck) {
        let same = [
            ("gas_volume", last.gas_volume, self.gas_volume),
            ("precharge_pressure", last.precharge_pressure, self.precharge_pressure),
        ];
        for (name, _, _) in same.into_iter().filter(|(_, last, first)| *last == Some(*first)) {
            let message =
                format!("`{name}` at setting 1 is that of the accumulator: the setting moves nothing");
            let help = format!("state another `{name}`, or leave out the adjustment");
            check.error_with_help(&format!("{path}.{name}"), message, help);
        }
        let [_, at_one] = self.ends();
        let working = at_one.working_precharge(ATMOSPHERE);
        if last.precharge_pressure.is_some() && supply > 0.0 && working >= supply {
            let [precharge, pressure] =
                [working, supply].map(|pressure| quantity::display(pressure, &PRESSURE, 4));
            let message = format!(
                "`precharge_pressure` is {precharge} at setting 1 and the supply has {pressure}: no chamber ever lets oil into this accumulator there"
            );
            check.error_with_help(&format!("{path}.precharge_pressure"), message, LOWER_PRECHARGE);
        }
    }
}

/// Name of the width of a hose or pipe in a message.
const BORE_OF_LINE: &str = "the bore of the line";

/// Remedy of a precharge that no pressure reaches.
const LOWER_PRECHARGE: &str =
    "the gas is in use only above its precharge: state one below the lowest pressure at which it is to work";
