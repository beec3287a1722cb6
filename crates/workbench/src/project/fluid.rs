//! `[fluid]` and `[supply]`.

use super::key::{key, plain};
use super::visitor::Visitor;
use crate::quantity::{DENSITY, FLOW, KINEMATIC_VISCOSITY, PRESSURE, RATIO};

/// The oil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fluid {
    /// Pa, of the liquid without air.
    pub bulk_modulus: f64,
    /// kg/m³.
    pub density: f64,
    /// m²/s.
    pub kinematic_viscosity: Option<f64>,
    /// Volume of free air over total volume at atmospheric pressure; `None` and zero mean none.
    pub entrained_air: Option<f64>,
    /// Polytropic exponent of the entrained air.
    pub polytropic_exponent: f64,
}

impl Fluid {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
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
    }
}

/// The pressure supply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Supply {
    /// How the pressure behaves under load.
    pub model: SupplyModel,
    /// Pa, gauge.
    pub pressure: f64,
    /// Pa, gauge.
    pub tank_pressure: f64,
    /// m³/s, what the pump can give.
    pub flow: Option<f64>,
}

/// How the supply pressure behaves under load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SupplyModel {
    /// It stays as declared.
    #[default]
    Constant,
    /// It falls when the demand exceeds the pump's flow.
    PumpLimited,
}

impl Supply {
    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("model", "How the pressure behaves under load; `pump_limited` uses `flow`.");
        let words = &[("constant", SupplyModel::Constant), ("pump_limited", SupplyModel::PumpLimited)];
        v.choice(k, words, &mut self.model, false);
        let k = key("pressure", &PRESSURE, "Supply pressure, gauge.").positive();
        v.quantity(k, &mut self.pressure);
        let k = key("tank_pressure", &PRESSURE, "Return pressure, gauge.").above(-101_325.0).or(0.0);
        v.quantity(k, &mut self.tank_pressure);
        let k = key("flow", &FLOW, "Flow the pump can give.").positive();
        v.optional(k, &mut self.flow);
    }
}
