//! Gas of accumulators that are adjusted in operation.

use phea_dynamics::scalar::{Parameters, Scalar};

use super::Machine;
use crate::accumulator::{ChamberGas, MovedGas};
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

impl<S: Scalar> Machine<S> {
    /// Gas at a chamber at its setting; `None` without an accumulator.
    pub(super) fn moved_gas<T: Scalar + From<S>>(
        &self,
        side: usize,
        [change, rate]: [T; 2],
    ) -> Option<MovedGas<T>> {
        let gas = self.gas[side].as_ref()?;
        let zero = T::from(0.0);
        Some(match gas.adjusted() {
            Some(of) => of.convert(&mut T::from).moved(change, rate),
            None => {
                let gas = gas.at_rest().convert(&mut T::from);
                MovedGas { gas, volume_rate: zero, precharge_rate: zero }
            }
        })
    }

    /// Settings of the accumulators at both chambers; zero for one that is not adjusted.
    pub(super) fn settings<T: Scalar + From<S>>(&self, [change, _]: [T; 2]) -> [T; 2] {
        [0, 1].map(|side| {
            let at_rest = self.gas[side].as_ref().and_then(ChamberGas::setting);
            at_rest.map_or(T::from(0.0), |setting| T::from(setting) + change)
        })
    }

    /// Power of both adjustments with the gas at these pressures in Pa, W.
    pub(super) fn adjustment_power<T: Scalar + From<S>>(&self, pressures: [T; 2], setting: [T; 2]) -> T {
        let of = |side: usize| {
            let power = self.moved_gas(side, setting).map(|gas| gas.power(pressures[side]));
            power.unwrap_or(T::from(0.0))
        };
        of(0) + of(1)
    }

    /// Flow through the valve between a chamber and its gas for a drop in Pa, m3/s; `None` without
    /// a valve.
    pub(super) fn through_gas_valve<T: Scalar + From<S>>(
        &self,
        side: usize,
        [change, _]: [T; 2],
        drop: T,
    ) -> Option<T> {
        let valve = self.gas[side].as_ref()?.valve()?;
        Some(valve.convert(&mut T::from).flow(change, drop))
    }

    /// Largest permitted pressures of the gas at either chamber, Pa: the limit at rest is a
    /// multiple of the precharge, which the setting moves.
    ///
    /// ```text
    /// P_2(u) = (P_2/P_0) P_0(u),     absolute
    /// ```
    pub(super) fn gas_limits<T: Scalar + From<S>>(&self, [change, _]: [T; 2]) -> [Option<T>; 2] {
        [0, 1].map(|side| {
            let limit = T::from(self.gas_pressure_limits[side]?);
            let Some(of) = self.gas[side].as_ref().and_then(ChamberGas::adjusted) else {
                return Some(limit);
            };
            let atmosphere = T::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
            let ratio = (limit + atmosphere) / (T::from(of.at_rest.precharge_pressure) + atmosphere);
            Some(limit + ratio * (T::from(of.precharge_rise) * change))
        })
    }

    /// Throttling loss of the valves between the chambers and their gas, W: `lost` of the necks in
    /// the [`Ledger`](super::Ledger) of a machine that has valves in their place.
    ///
    /// ```text
    /// (p_A - p_gA) q_A + (p_B - p_gB) q_B
    /// ```
    pub fn throttled_at_gas(&self, state: &[S], inputs: &[S]) -> S {
        let setting = self.layout.setting(inputs);
        let own = self.layout.read(state);
        let chambers = [own.pressure_a, own.pressure_b];
        let behind = self.gas_pressures(chambers, &self.layout.read_gas(state), setting);
        let of = |side: usize| {
            let drop = chambers[side] - behind[side];
            let flow: Option<S> = self.through_gas_valve(side, setting, drop);
            flow.map_or(S::from(0.0), |flow| drop * flow)
        };
        of(0) + of(1)
    }

    /// Compliance of the oil between the chamber and its gas: in a neck, or behind a valve, m3/Pa.
    pub(super) fn before_gas<T: Scalar + From<S>>(&self, side: usize) -> T {
        T::from(self.gas[side].as_ref().map_or(S::from(0.0), ChamberGas::oil_before))
    }
}
