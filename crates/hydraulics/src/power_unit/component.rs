//! Source of the supply pressure from its table.

use phea_dynamics::scalar::Scalar;

use super::keys::{DeclaredSupply, SupplyModel};
use super::{PowerUnit, PumpLimited};
use crate::accumulator::DeclaredAccumulator;

impl<S: Scalar> DeclaredSupply<S> {
    /// Source of the pressure; `bulk_modulus` of the fluid in Pa is that of a supply line for which
    /// none is stated.
    pub fn component(&self, bulk_modulus: S) -> PowerUnit<S> {
        let SupplyModel::PumpLimited(pump) = &self.model else { return PowerUnit::Constant };
        PowerUnit::PumpLimited(PumpLimited {
            pump_flow: pump.flow,
            relief_override: pump.relief_override,
            volume: pump.volume,
            effective_bulk_modulus: pump.effective_bulk_modulus.unwrap_or(bulk_modulus),
            accumulator: pump.accumulator.as_ref().map(DeclaredAccumulator::component),
        })
    }
}
