//! The gas of accumulators that are adjusted in operation.

use phea_dynamics::scalar::Scalar;

use super::Machine;
use crate::accumulator::{Adjustment, MovedGas};

impl<S: Scalar> Machine<S> {
    /// The adjustment of the gas at a chamber.
    fn adjustment<T: Scalar + From<S>>(&self, side: usize) -> Option<Adjustment<T>> {
        self.adjustments[side].map(|of| of.convert(&mut T::from))
    }

    /// The gas at a chamber at its setting; `None` without an accumulator.
    pub(super) fn moved_gas<T: Scalar + From<S>>(
        &self,
        side: usize,
        [change, rate]: [T; 2],
    ) -> Option<MovedGas<T>> {
        let gas = self.accumulators[side]?.convert(&mut T::from);
        let zero = T::from(0.0);
        let still = MovedGas { gas, volume_rate: zero, precharge_rate: zero };
        Some(self.adjustment(side).map_or(still, |of: Adjustment<T>| of.moved(&gas, change, rate)))
    }

    /// Settings of the accumulators at both chambers; zero of those that are not adjusted.
    pub(super) fn settings<T: Scalar + From<S>>(&self, [change, _]: [T; 2]) -> [T; 2] {
        [0, 1].map(|side| {
            let of: Option<Adjustment<T>> = self.adjustment(side);
            of.map_or(T::from(0.0), |of| of.setting + change)
        })
    }

    /// Power in W of both adjustments, with the gas at these pressures in Pa.
    pub(super) fn adjustment_power<T: Scalar + From<S>>(&self, pressures: [T; 2], setting: [T; 2]) -> T {
        let of = |side: usize| {
            let power = self.moved_gas(side, setting).map(|gas| gas.power(pressures[side]));
            power.unwrap_or(T::from(0.0))
        };
        of(0) + of(1)
    }

    /// Flow in m3/s through the valve between a chamber and its gas along a drop in Pa; `None` where
    /// there is none.
    pub(super) fn through_gas_valve<T: Scalar + From<S>>(
        &self,
        side: usize,
        [change, _]: [T; 2],
        drop: T,
    ) -> Option<T> {
        let of = self.adjustment(side)?;
        Some(of.valve()?.flow(of.setting + change, drop))
    }

    /// What the oil between the chamber and its gas yields, in m3/Pa: in a neck, or behind a valve.
    pub(super) fn before_gas<T: Scalar + From<S>>(&self, side: usize) -> T {
        let neck = self.necks[side].map(|neck| neck.compliance);
        let valve = self.adjustments[side].and_then(|of| Some(of.valve()?.compliance));
        T::from(neck.or(valve).unwrap_or(S::from(0.0)))
    }
}
