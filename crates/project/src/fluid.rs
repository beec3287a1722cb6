//! Tables `[fluid]` and `[supply]`.

use super::adjustment::{AdjustmentKind, DeclaredAdjustment};
use super::cost::PartCost;
use phea_quantity::{
    DENSITY, FLOW, KINEMATIC_VISCOSITY, LENGTH, PRESSURE, RATIO, TEMPERATURE, TIME, VOLUME, ZERO_CELSIUS,
};
use phea_table::{TableNumber, Variants, Visitor};
use phea_table::{key, plain};

/// Oil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredFluid<S = f64> {
    /// Bulk modulus of the liquid without air, Pa.
    pub bulk_modulus: S,
    /// Density, kg/m³.
    pub density: S,
    /// Kinematic viscosity, m²/s.
    pub kinematic_viscosity: Option<S>,
    /// Volume of free air over total volume at atmospheric pressure; `None` and zero mean none.
    pub entrained_air: Option<S>,
    /// Polytropic exponent of the entrained air.
    pub polytropic_exponent: S,
    /// Absolute pressure below which a chamber is reported to cavitate, Pa.
    pub vapour_pressure: S,
}

impl<S: TableNumber> DeclaredFluid<S> {
    pub(crate) fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("bulk_modulus", &PRESSURE, "Bulk modulus of the liquid without air.").positive();
        v.quantity(k, &mut self.bulk_modulus);
        let k = key("density", &DENSITY, "Density of the liquid.").positive();
        v.quantity(k, &mut self.density);
        let k = key("kinematic_viscosity", &KINEMATIC_VISCOSITY, "Kinematic viscosity.").positive();
        v.optional(k, &mut self.kinematic_viscosity);
        let k = key("entrained_air", &RATIO, "Share of free air in the volume at atmospheric pressure.");
        v.optional(k.not_negative().below(1.0), &mut self.entrained_air);
        let k = key("polytropic_exponent", &RATIO, "Of the entrained air: 1 is isothermal, 1.4 adiabatic.");
        v.quantity(k.at_least(1.0).at_most(1.7).or(1.4), &mut self.polytropic_exponent);
        let k = key("vapour_pressure", &PRESSURE, "Absolute; below it a chamber is reported to cavitate.");
        v.quantity(k.not_negative().or(0.0), &mut self.vapour_pressure);
    }
}

/// Pressure supply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeclaredSupply<S = f64> {
    /// Behaviour of the pressure under load.
    pub model: SupplyModel<S>,
    /// Supply pressure, Pa gauge.
    pub pressure: S,
    /// Tank pressure, Pa gauge.
    pub tank_pressure: S,
}

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
    pub(crate) fn visit_at_chamber<V: Visitor<S>>(&mut self, v: &mut V) {
        let doc = "Of the heat between gas and wall, in place of `polytropic_exponent`: slow isothermal, fast adiabatic.";
        v.optional(key("thermal_time_constant", &TIME, doc).positive(), &mut self.thermal_time_constant);
        self.visit(v);
        v.way(&["neck_diameter", "neck_length"], &mut self.neck, DeclaredNeck::visit);
        let k = plain("adjustment", "What of it is adjusted in operation, by a setting from 0 to 1.");
        v.table(k, &mut self.adjustment, DeclaredAdjustment::visit);
        self.cost.visit(v);
    }

    pub(crate) fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("gas_volume", &VOLUME, "Volume of the gas at its precharge.").positive();
        v.quantity(k, &mut self.gas_volume);
        let k = key("precharge_pressure", &PRESSURE, "Pressure of the gas without oil, gauge.").positive();
        v.quantity(k, &mut self.precharge_pressure);
        let k = key("polytropic_exponent", &RATIO, "Of the gas: 1 is slow, 1.4 fast.");
        let k = k.at_least(1.0).at_most(5.0 / 3.0);
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
        let k = key("maximum_pressure_ratio", &RATIO, "Maker's limit of p_2/p_0, both absolute.");
        v.optional(k.at_least(1.0), &mut self.maximum_pressure_ratio);
    }
}

/// Behaviour of the supply pressure under load.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a project has one supply")]
pub enum SupplyModel<S = f64> {
    /// Constant pressure as declared.
    Constant {
        /// Flow of the pump, which limits sizing and the operating region, m³/s.
        flow: Option<S>,
    },
    /// Pressure that falls when the demand exceeds the pump's flow.
    PumpLimited(Pump<S>),
}

/// Limited pump with the line to the valve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pump<S = f64> {
    /// Maximum flow, m³/s.
    pub flow: S,
    /// Rise of pressure over which the relief valve opens for the pump's whole flow, Pa.
    pub relief_override: S,
    /// Volume of the supply line, m³.
    pub volume: S,
    /// Effective bulk modulus of the supply line, Pa; if absent, that of the fluid.
    pub effective_bulk_modulus: Option<S>,
    /// Accumulator on the supply line.
    pub accumulator: Option<DeclaredAccumulator<S>>,
}

impl<S: Default> Default for SupplyModel<S> {
    fn default() -> Self {
        SupplyModel::Constant { flow: None }
    }
}

impl<S: TableNumber> Variants<S> for SupplyModel<S> {
    fn all(&self) -> Vec<SupplyModel<S>> {
        vec![SupplyModel::default(), SupplyModel::PumpLimited(Pump::default())]
    }

    fn word(&self) -> &'static str {
        match self {
            SupplyModel::Constant { .. } => "constant",
            SupplyModel::PumpLimited(_) => "pump_limited",
        }
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("flow", &FLOW, "Flow the pump can give.").positive();
        match self {
            SupplyModel::Constant { flow } => v.optional(k, flow),
            SupplyModel::PumpLimited(pump) => {
                v.quantity(k, &mut pump.flow);
                pump.visit_line(v);
            }
        }
    }
}

impl<S: TableNumber> Pump<S> {
    fn visit_line<V: Visitor<S>>(&mut self, v: &mut V) {
        let k =
            key("relief_override", &PRESSURE, "Rise over which the relief valve opens for all of `flow`.");
        v.quantity(k.positive().or(5e5), &mut self.relief_override);
        let k = key("volume", &VOLUME, "Volume of the line from a limited pump to the valve.").positive();
        v.quantity(k.or(1e-3), &mut self.volume);
        let k = key("effective_bulk_modulus", &PRESSURE, "Of that line; absent: the fluid's.").positive();
        v.optional(k, &mut self.effective_bulk_modulus);
        let k = plain("accumulator", "A gas-charged accumulator on that line.");
        v.table(k, &mut self.accumulator, DeclaredAccumulator::visit);
    }
}

impl DeclaredSupply {
    /// Flow of the pump, if stated, m³/s.
    pub fn flow(&self) -> Option<f64> {
        match &self.model {
            SupplyModel::Constant { flow } => *flow,
            SupplyModel::PumpLimited(pump) => Some(pump.flow),
        }
    }
}

impl<S: TableNumber> DeclaredSupply<S> {
    pub(crate) fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("model", "How the pressure behaves under load; `pump_limited` uses `flow`.");
        v.variant(k, &mut self.model, false);
        let k = key("pressure", &PRESSURE, "Supply pressure, gauge.").positive();
        v.quantity(k, &mut self.pressure);
        let k = key("tank_pressure", &PRESSURE, "Return pressure, gauge.").above(-101_325.0).or(0.0);
        v.quantity(k, &mut self.tank_pressure);
    }
}
