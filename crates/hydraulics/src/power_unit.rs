//! Source of the supply pressure: a constant pressure, or a pump with its relief valve.

mod checks;
mod component;
mod keys;

pub(crate) use keys::TANK_PRESSURE_KEY;
pub use keys::{DeclaredSupply, Pump, SupplyModel};

use phea_dynamics::scalar::Scalar;

use crate::accumulator::Accumulator;
use crate::parameter::{ParameterError, Problems};

/// Source of the supply pressure. Units: m3/s, Pa, m3.
///
/// ```text
/// constant        p_S as stated, for any flow of the valve
/// pump limited    C_S(p_S) dp_S/dt = q_pump - q_relief - q_supply
///                 q_relief = (q_pump/dp_o) (p_S - p_relief)+
///                 C_S = V/beta + C_acc,    C_acc = (V_0/(n P)) (P_0/P)^(1/n) above the precharge, 0 below
/// ```
///
/// P and P_0 are absolute. The relief valve opens at the stated supply pressure less the override
/// dp_o, so that an idle pump holds the stated pressure; its dynamics are faster than those of the
/// volume after it and neglected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PowerUnit<S = f64> {
    /// Constant pressure.
    #[default]
    Constant,
    /// Pump of fixed flow with its relief valve, on the volume of the supply line.
    PumpLimited(PumpLimited<S>),
}

/// Pump with fixed flow, a relief valve and the line to the servovalve. Units: m3/s, Pa, m3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpLimited<S = f64> {
    /// Flow of the pump, m3/s.
    pub pump_flow: S,
    /// Rise of pressure dp_o over which the relief valve opens from zero to the pump's whole flow,
    /// Pa.
    pub relief_override: S,
    /// Volume V of the supply line, m3.
    pub volume: S,
    /// Effective bulk modulus beta of the supply line, Pa.
    pub effective_bulk_modulus: S,
    /// Bladder accumulator on the supply line.
    pub accumulator: Option<Accumulator<S>>,
}

impl PowerUnit {
    /// Impossible parameters of this power unit; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        match self {
            PowerUnit::Constant => Vec::new(),
            PowerUnit::PumpLimited(unit) => unit.problems(),
        }
    }
}

impl PumpLimited {
    /// Impossible parameters of this pump; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.not_negative("pump_flow", self.pump_flow);
        problems.key(keys::RELIEF_OVERRIDE_KEY, self.relief_override);
        problems.key(keys::VOLUME_KEY, self.volume);
        problems.key(keys::EFFECTIVE_BULK_MODULUS_KEY, self.effective_bulk_modulus);
        if let Some(accumulator) = self.accumulator {
            problems.component("accumulator", accumulator.problems());
        }
        problems.into_vec()
    }
}

/// True if a supply drives no flow to its tank, with these pressures in Pa.
pub(crate) fn drives_nothing(pressure: f64, tank_pressure: f64) -> bool {
    tank_pressure >= pressure
}

phea_dynamics::parameters! { PowerUnit = PowerUnit::Constant | PowerUnit::PumpLimited(pump) }
phea_dynamics::parameters! {
    PumpLimited { pump_flow, relief_override, volume, effective_bulk_modulus, accumulator }
}

impl<S: Copy> PowerUnit<S> {
    /// True if the supply pressure is a state.
    pub fn yields(&self) -> bool {
        matches!(self, PowerUnit::PumpLimited(_))
    }
}

impl<S: Scalar> PumpLimited<S> {
    /// Flow of the relief valve at a supply pressure in Pa, with `stated` in Pa held by the idle
    /// pump, m3/s.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::machine::PumpLimited;
    /// let unit = PumpLimited {
    ///     pump_flow: 1.6e-4, relief_override: 5e5, volume: 1e-3, effective_bulk_modulus: 1e9, accumulator: None,
    /// };
    /// assert_eq!(unit.relief_flow(70e5, 70e5), 1.6e-4);
    /// assert_eq!(unit.relief_flow(64e5, 70e5), 0.0);
    /// ```
    #[inline(always)]
    pub fn relief_flow(&self, pressure: S, stated: S) -> S {
        let above = pressure - (stated - self.relief_override);
        self.pump_flow * above.maximum(S::from(0.0)) / self.relief_override
    }

    /// Compliance C_S at a supply pressure in Pa, m3/Pa.
    pub fn compliance(&self, pressure: S) -> S {
        let line = self.volume / self.effective_bulk_modulus;
        match self.accumulator {
            None => line,
            Some(accumulator) => line + accumulator.compliance(pressure),
        }
    }

    /// Rate of the supply pressure while `taken` in m3/s flows to the valve, Pa/s.
    #[inline(always)]
    pub(crate) fn pressure_rate(&self, pressure: S, stated: S, taken: S) -> S {
        (self.pump_flow - self.relief_flow(pressure, stated) - taken) / self.compliance(pressure)
    }
}
