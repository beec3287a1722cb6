//! The gas of accumulators at the chambers: behind necks, and where it exchanges heat.

use phea_dynamics::scalar::Scalar;

use super::equations::constant;
use super::{Machine, MachineState};
use crate::accumulator::{HeatedGas, RelaxingGas};

/// Gas of both chambers that exchanges heat; `None` of a chamber without such gas.
pub(super) type HeatedSides<T> = [Option<HeatedGas<T>>; 2];

impl<S: Scalar> Machine<S> {
    /// Pressures of the gas at either chamber, in Pa.
    #[inline(always)]
    pub(super) fn gas_pressures<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> [T; 2] {
        let [neck_a, neck_b] = &self.necks;
        [
            if neck_a.is_some() { state.gas_pressures[0] } else { state.pressure_a },
            if neck_b.is_some() { state.gas_pressures[1] } else { state.pressure_b },
        ]
    }

    /// Pressures in Pa gauge at which the gas at either chamber has its precharge, P_0 theta; `None`
    /// without gas.
    #[inline(always)]
    pub(super) fn precharges<T: Scalar + From<S>>(&self, state: &MachineState<T>) -> [Option<T>; 2] {
        [0, 1].map(|side| {
            let precharge: T = constant(self.accumulators[side]?.precharge_pressure);
            Some(match self.thermal_time_constants[side] {
                None => precharge,
                Some(_) => {
                    let atmosphere = T::from(crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE);
                    precharge + (precharge + atmosphere) * state.gas_warmings[side]
                }
            })
        })
    }

    /// The gas that exchanges heat, at its pressures in Pa and temperatures theta - 1. Apart, so that
    /// machines without it do not carry its code along.
    #[inline(never)]
    pub(super) fn heated<T: Scalar + From<S>>(&self, pressures: [T; 2], warmings: [T; 2]) -> HeatedSides<T> {
        [0, 1].map(|side| {
            let (gas, time_constant) = self.accumulators[side].zip(self.thermal_time_constants[side])?;
            let gas = gas.convert(&mut constant::<S, T>);
            let relaxing = RelaxingGas { gas, time_constant: constant(time_constant) };
            Some(relaxing.at(pressures[side], warmings[side]))
        })
    }

    /// Rates of the pressures of both chambers in Pa/s, with these flows into them in m3/s and these
    /// compliances in m3/Pa, each without the gas that exchanges heat.
    ///
    /// ```text
    /// (C_oil + C) dp/dt = into - C P (theta - 1)/(theta tau)
    /// ```
    #[inline(never)]
    pub(super) fn beside_heated<T: Scalar + From<S>>(
        &self,
        heated: &HeatedSides<T>,
        into: [T; 2],
        compliances: [T; 2],
    ) -> [T; 2] {
        [0, 1].map(|side| match &heated[side] {
            Some(gas) if self.necks[side].is_none() => {
                (into[side] - gas.compliance * gas.cooling) / (compliances[side] + gas.compliance)
            }
            _ => into[side] / compliances[side],
        })
    }

    /// Rates of theta in 1/s while the pressures of the gas rise at these rates in Pa/s.
    #[inline(never)]
    pub(super) fn warming_rates<T: Scalar + From<S>>(
        &self,
        heated: &HeatedSides<T>,
        pressure_rates: [T; 2],
    ) -> [T; 2] {
        [0, 1].map(|side| {
            heated[side].map_or(T::from(0.0), |gas| gas.warming_rate(gas.flow(pressure_rates[side])))
        })
    }

    /// Rates of the flows through the necks in m3/s2 and of the pressures behind them in Pa/s. Apart,
    /// so that machines without necks do not carry its code along.
    #[inline(never)]
    pub(super) fn through_necks<T: Scalar + From<S>>(
        &self,
        chambers: [T; 2],
        neck_flows: [T; 2],
        gas_pressures: [T; 2],
        heated: Option<&HeatedSides<T>>,
    ) -> [[T; 2]; 2] {
        let [side_a, side_b] = [0, 1].map(|side| {
            let parts = self.necks[side].zip(self.accumulators[side]);
            parts.map_or([T::from(0.0); 2], |(neck, gas)| {
                let (flow, pressure) = (neck_flows[side], gas_pressures[side]);
                let neck = neck.convert(&mut constant::<S, T>);
                let pushing = chambers[side] - pressure - neck.drop(flow);
                let rate = match heated.and_then(|sides| sides[side].as_ref()) {
                    None => {
                        let gas = gas.convert(&mut constant::<S, T>).compliance(pressure);
                        flow / (gas + neck.compliance)
                    }
                    Some(gas) => (flow - gas.compliance * gas.cooling) / (gas.compliance + neck.compliance),
                };
                [pushing / neck.inertance, rate]
            })
        });
        [[side_a[0], side_b[0]], [side_a[1], side_b[1]]]
    }
}
