//! Table of an accumulator, at a chamber or at a pump.

use phea_quantity::{LENGTH, PRESSURE, RATIO, TEMPERATURE, TIME, VOLUME, ZERO_CELSIUS};
use phea_table::{Key, PartCost, TableNumber, Visitor, key, plain};

use super::adjustment_keys::{AdjustmentKind, DeclaredAdjustment};
use crate::fluid::MONATOMIC_EXPONENT;

pub(super) const GAS_VOLUME_KEY: Key =
    key("gas_volume", &VOLUME, "Volume of the gas at its precharge.").positive();
pub(super) const PRECHARGE_PRESSURE_KEY: Key =
    key("precharge_pressure", &PRESSURE, "Pressure of the gas without oil, gauge.").positive();
pub(super) const POLYTROPIC_EXPONENT_KEY: Key =
    key("polytropic_exponent", &RATIO, "Of the gas: 1 is slow, 1.4 fast.")
        .at_least(1.0)
        .at_most(MONATOMIC_EXPONENT);
pub(super) const THERMAL_TIME_CONSTANT_KEY: Key = key(
    "thermal_time_constant",
    &TIME,
    "Of the heat between gas and wall, in place of `polytropic_exponent`: slow isothermal, fast adiabatic.",
)
.positive();
pub(super) const MAXIMUM_PRESSURE_RATIO_KEY: Key =
    key("maximum_pressure_ratio", &RATIO, "Maker's limit of p_2/p_0, both absolute.").at_least(1.0);

/// Gas-charged accumulator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredAccumulator<S = f64> {
    /// Volume of the gas at its precharge, m³.
    pub gas_volume: S,
    /// Precharge pressure, Pa gauge.
    pub precharge_pressure: S,
    /// Polytropic exponent of the gas; without effect if it has a thermal time constant.
    pub polytropic_exponent: S,
    /// Time constant of the heat exchange between gas and wall at a chamber, s. `None` for
    /// polytropic gas.
    pub thermal_time_constant: Option<S>,
    /// Temperatures at which the precharge is stated and at which the gas works; `None` if they are
    /// equal.
    pub temperatures: Option<GasTemperatures<S>>,
    /// Highest permitted pressure over the precharge, both absolute, if stated.
    pub maximum_pressure_ratio: Option<S>,
    /// Neck between a chamber and the gas; if absent, the gas has the pressure of the chamber.
    pub neck: Option<DeclaredNeck<S>>,
    /// Adjustment in operation, at a chamber.
    pub adjustment: Option<DeclaredAdjustment<S>>,
    /// Cost and mass, at a chamber.
    pub cost: PartCost<S>,
}

/// Temperatures of the gas of an accumulator, in degC.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GasTemperatures<S = f64> {
    /// Temperature at which the precharge is stated.
    pub precharge: S,
    /// Temperature of the gas at its wall in operation.
    pub working: S,
}

impl GasTemperatures {
    /// Both temperatures, K.
    pub fn absolute(&self) -> [f64; 2] {
        [self.precharge, self.working].map(|celsius| celsius + ZERO_CELSIUS)
    }
}

impl<S: TableNumber> GasTemperatures<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let doc = "At which `precharge_pressure` was measured; absent: at that in operation.";
        v.quantity(key("precharge_temperature", &TEMPERATURE, doc).above(-ZERO_CELSIUS), &mut self.precharge);
        let doc = "Of the gas in operation, which changes its precharge in proportion, both absolute.";
        v.quantity(key("working_temperature", &TEMPERATURE, doc).above(-ZERO_CELSIUS), &mut self.working);
    }
}

/// Neck of an accumulator at a chamber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeclaredNeck<S = f64> {
    /// Diameter, m.
    pub diameter: S,
    /// Length, m.
    pub length: S,
    /// Loss at both its ends, over the velocity head.
    pub loss_coefficient: S,
}

impl<S: TableNumber> DeclaredNeck<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("neck_diameter", &LENGTH, "Diameter of the neck to the gas; absent: no neck.").positive();
        v.quantity(k, &mut self.diameter);
        v.quantity(key("neck_length", &LENGTH, "Length of that neck.").positive(), &mut self.length);
        let k = key(
            "neck_loss_coefficient",
            &RATIO,
            "Head lost at both ends of the neck over its velocity head.",
        );
        v.quantity(k.not_negative().or(1.5), &mut self.loss_coefficient);
    }
}

impl DeclaredAccumulator {
    /// Precharge at the working temperature for an atmosphere in Pa, Pa gauge.
    pub fn working_precharge(&self, atmosphere: f64) -> f64 {
        let ratio = self.temperatures.map_or(1.0, |temperatures| {
            let [stated, working] = temperatures.absolute();
            working / stated
        });
        (self.precharge_pressure + atmosphere) * ratio - atmosphere
    }

    /// Accumulator at setting 0 of its adjustment and at setting 1.
    pub fn ends(&self) -> [DeclaredAccumulator; 2] {
        let Some(DeclaredAdjustment { kind: AdjustmentKind::Gas(last), .. }) = self.adjustment else {
            return [*self; 2];
        };
        let gas_volume = last.gas_volume.unwrap_or(self.gas_volume);
        let precharge_pressure = last.precharge_pressure.unwrap_or(self.precharge_pressure);
        [*self, DeclaredAccumulator { gas_volume, precharge_pressure, ..*self }]
    }
}

impl<S: TableNumber> DeclaredAccumulator<S> {
    /// Visits an accumulator at a chamber, which may have a neck, exchange heat and be adjusted.
    pub fn visit_at_chamber<V: Visitor<S>>(&mut self, v: &mut V) {
        v.optional(THERMAL_TIME_CONSTANT_KEY, &mut self.thermal_time_constant);
        self.visit(v);
        v.way(&["neck_diameter", "neck_length"], &mut self.neck, DeclaredNeck::visit);
        let k = plain("adjustment", "What of it is adjusted in operation, by a setting from 0 to 1.");
        v.table(k, &mut self.adjustment, DeclaredAdjustment::visit);
        self.cost.visit(v);
    }

    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        v.quantity(GAS_VOLUME_KEY, &mut self.gas_volume);
        v.quantity(PRECHARGE_PRESSURE_KEY, &mut self.precharge_pressure);
        let k = POLYTROPIC_EXPONENT_KEY;
        match self.thermal_time_constant {
            None => v.quantity(k.or(1.4), &mut self.polytropic_exponent),
            // a value would be contradictory, and is rejected where it is written
            Some(_) => v.optional(k, &mut None),
        }
        v.way(
            &["precharge_temperature", "working_temperature"],
            &mut self.temperatures,
            GasTemperatures::visit,
        );
        v.optional(MAXIMUM_PRESSURE_RATIO_KEY, &mut self.maximum_pressure_ratio);
    }
}
