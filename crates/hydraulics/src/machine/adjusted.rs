//! The gas of accumulators that are adjusted in operation.

use phea_dynamics::scalar::Scalar;

use super::Machine;
use super::gas::{GasStates, HeatedSides};
use crate::accumulator::{Adjustment, MovedGas};

/// Gas at a pressure: while this changes, C dp/dt + q flows into it.
struct Content<T> {
    /// C in m3/Pa.
    compliance: T,
    /// q in m3/s at a pressure that is held.
    held: T,
}

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

    /// The gas at a chamber at its pressure in Pa.
    fn content<T: Scalar + From<S>>(
        &self,
        side: usize,
        (pressure, setting): (T, [T; 2]),
        heated: &HeatedSides<T>,
    ) -> Option<Content<T>> {
        let moved = self.moved_gas(side, setting)?;
        Some(match &heated[side] {
            Some(gas) => Content { compliance: gas.compliance, held: gas.compliance * gas.cooling },
            None => Content { compliance: moved.gas.compliance(pressure), held: moved.oil_rate(pressure) },
        })
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

    /// Rates in Pa/s of the pressures of both chambers where an accumulator is adjusted, and of the states
    /// of the gas, with these flows in m3/s into chambers and gas, and compliances in m3/Pa without gas that
    /// has states of its own or is adjusted.
    pub(super) fn adjusted_rates<T: Scalar + From<S>>(
        &self,
        (gas, setting): (&GasStates<T>, [T; 2]),
        heated: &HeatedSides<T>,
        [chambers, into, compliances]: [[T; 2]; 3],
    ) -> ([T; 2], GasStates<T>) {
        let mut own = [T::from(0.0); 2];
        let mut rates = GasStates::zero();
        let (apart, pressures) = (self.layout.gas_at(), self.gas_pressures(chambers, gas));
        for side in [0, 1] {
            let (pressure, oil) = (pressures[side], compliances[side]);
            let content = self.content(side, (pressure, setting), heated).filter(|_| apart[side]);
            let Some(Content { compliance, held }) = content else {
                own[side] = into[side] / oil;
                continue;
            };
            let neck = self.necks[side].map(|neck| neck.convert(&mut T::from));
            let drop = chambers[side] - pressure;
            let through = neck.map(|_| gas.neck_flows[side]).or(self.through_gas_valve(side, setting, drop));
            let of_gas = match through {
                None => {
                    own[side] = (into[side] - held) / (oil + compliance);
                    own[side]
                }
                Some(flow) => {
                    own[side] = (into[side] - flow) / oil;
                    rates.pressures[side] = (flow - held) / (compliance + self.before_gas(side));
                    rates.pressures[side]
                }
            };
            if let Some(neck) = neck {
                rates.neck_flows[side] = (drop - neck.drop(gas.neck_flows[side])) / neck.inertance;
            }
            if let Some(gas) = &heated[side] {
                rates.warmings[side] = gas.warming_rate(gas.flow(of_gas));
            }
        }
        (own, rates)
    }
}
