//! Table `[supply]`.

use phea_quantity::{FLOW, PRESSURE, VOLUME};
use phea_table::{Key, TableNumber, Variants, Visitor, key, plain};

use crate::accumulator::DeclaredAccumulator;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

pub(crate) const TANK_PRESSURE_KEY: Key =
    key("tank_pressure", &PRESSURE, "Return pressure, gauge.").above(-ATMOSPHERIC_PRESSURE_ABSOLUTE).or(0.0);
pub(super) const RELIEF_OVERRIDE_KEY: Key =
    key("relief_override", &PRESSURE, "Rise over which the relief valve opens for all of `flow`.")
        .positive()
        .or(5e5);
pub(super) const VOLUME_KEY: Key =
    key("volume", &VOLUME, "Volume of the line from a limited pump to the valve.").positive().or(1e-3);
pub(super) const EFFECTIVE_BULK_MODULUS_KEY: Key =
    key("effective_bulk_modulus", &PRESSURE, "Of that line; absent: the fluid's.").positive();

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
        let k = key("flow", &FLOW, "Flow the pump can give.").positive().usual(5e-6, 2e-2, "pumps");
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
        v.quantity(RELIEF_OVERRIDE_KEY, &mut self.relief_override);
        v.quantity(VOLUME_KEY, &mut self.volume);
        v.optional(EFFECTIVE_BULK_MODULUS_KEY, &mut self.effective_bulk_modulus);
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
    /// Visits the keys of the table.
    pub fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = plain("model", "How the pressure behaves under load; `pump_limited` uses `flow`.");
        v.variant(k, &mut self.model, false);
        let k = key("pressure", &PRESSURE, "Supply pressure, gauge.").positive().usual(1e6, 5e7, "supplies");
        v.quantity(k, &mut self.pressure);
        v.quantity(TANK_PRESSURE_KEY, &mut self.tank_pressure);
    }
}
