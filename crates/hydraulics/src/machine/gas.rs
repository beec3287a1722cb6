//! The gas of accumulators at the chambers: behind necks, and where it exchanges heat.

use phea_dynamics::scalar::Scalar;

use super::Machine;
use super::equations::constant;
use crate::accumulator::{HeatedGas, RelaxingGas};

/// States of the gas at both chambers, or their rates; those that a machine lacks are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GasStates<T> {
    /// Flow q_n in m3/s through the neck of the accumulator at each chamber, into its gas.
    pub(super) neck_flows: [T; 2],
    /// Pressure p_g in Pa of the gas behind each neck or valve.
    pub(super) pressures: [T; 2],
    /// theta - 1 of the gas at each chamber, by which its absolute temperature is above that of its
    /// wall, where it exchanges heat.
    pub(super) warmings: [T; 2],
}

impl<T: Scalar> GasStates<T> {
    /// Everything zero.
    pub(super) fn zero() -> GasStates<T> {
        let zero = [T::from(0.0); 2];
        GasStates { neck_flows: zero, pressures: zero, warmings: zero }
    }
}

/// Gas of both chambers that exchanges heat; `None` of a chamber without such gas.
pub(super) type HeatedSides<T> = [Option<HeatedGas<T>>; 2];

impl<S: Scalar> Machine<S> {
    /// Pressures of the gas at either chamber, in Pa.
    #[inline(always)]
    pub(super) fn gas_pressures<T: Scalar>(&self, chambers: [T; 2], gas: &GasStates<T>) -> [T; 2] {
        let behind = self.layout.behind();
        [0, 1].map(|side| if behind[side] { gas.pressures[side] } else { chambers[side] })
    }

    /// Pressures in Pa gauge at which the gas at either chamber has its precharge, P_0 theta; `None`
    /// without gas.
    #[inline(always)]
    pub(super) fn precharges<T: Scalar + From<S>>(
        &self,
        gas: &GasStates<T>,
        [change, _]: [T; 2],
    ) -> [Option<T>; 2] {
        [0, 1].map(|side| {
            let stated: T = constant(self.accumulators[side]?.precharge_pressure);
            let precharge = self.adjustments[side].map_or(stated, |of| stated + of.precharge_rise(change));
            Some(match self.thermal_time_constants[side] {
                None => precharge,
                Some(_) => {
                    let atmosphere = T::from(crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE);
                    precharge + (precharge + atmosphere) * gas.warmings[side]
                }
            })
        })
    }

    /// Pressures in Pa of the gas behind the necks, and theta of the gas that exchanges heat; zero at
    /// a chamber without.
    pub(super) fn told_of_gas<T: Scalar>(&self, vector: &[T]) -> [[T; 2]; 2] {
        let gas = self.layout.read_gas(vector);
        let zero = T::from(0.0);
        let ratios = [0, 1].map(|side| match self.thermal_time_constants[side] {
            Some(_) => T::from(1.0) + gas.warmings[side],
            None => zero,
        });
        [gas.pressures, ratios]
    }

    /// The gas that exchanges heat, at these pressures of the chambers in Pa.
    pub(super) fn heated<T: Scalar + From<S>>(
        &self,
        chambers: [T; 2],
        states: &GasStates<T>,
    ) -> HeatedSides<T> {
        let (pressures, warmings) = (self.gas_pressures(chambers, states), states.warmings);
        [0, 1].map(|side| {
            let (gas, time_constant) = self.accumulators[side].zip(self.thermal_time_constants[side])?;
            let gas = gas.convert(&mut constant::<S, T>);
            let relaxing = RelaxingGas { gas, time_constant: constant(time_constant) };
            Some(relaxing.at(pressures[side], warmings[side]))
        })
    }

    /// Rates of the pressures of both chambers in Pa/s beside gas that has states of its own, with
    /// these flows into them in m3/s and these compliances in m3/Pa; writes the rates of those states.
    /// Apart, so that machines without such gas do not carry its code along.
    #[inline(never)]
    pub(super) fn beside_gas<T: Scalar + From<S>>(
        &self,
        (vector, inputs): (&[T], &[T]),
        chambers: [T; 2],
        into: [T; 2],
        compliances: [T; 2],
        rates: &mut [T],
    ) -> [T; 2] {
        let gas = self.layout.read_gas(vector);
        let heated = self.heated(chambers, &gas);
        if self.layout.is_adjusted() {
            let setting = self.layout.setting(inputs);
            let (own, gas) = self.adjusted_rates((&gas, setting), &heated, [chambers, into, compliances]);
            self.layout.write_gas(gas, rates);
            return own;
        }
        let into = [0, 1].map(|side| into[side] - gas.neck_flows[side]);
        let own = self.beside_heated(&heated, into, compliances);
        let [neck_flows, pressures] = self.through_necks(chambers, &gas, &heated);
        let behind = GasStates { pressures, ..gas };
        let warmings = self.warming_rates(&heated, self.gas_pressures(own, &behind));
        self.layout.write_gas(GasStates { neck_flows, pressures, warmings }, rates);
        own
    }

    /// Rates of the pressures of both chambers in Pa/s, with these flows into them in m3/s and these
    /// compliances in m3/Pa, each without the gas that exchanges heat.
    ///
    /// ```text
    /// (C_oil + C) dp/dt = into - C P (theta - 1)/(theta tau)
    /// ```
    fn beside_heated<T: Scalar + From<S>>(
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
    fn warming_rates<T: Scalar + From<S>>(&self, heated: &HeatedSides<T>, pressure_rates: [T; 2]) -> [T; 2] {
        [0, 1].map(|side| {
            heated[side].map_or(T::from(0.0), |gas| gas.warming_rate(gas.flow(pressure_rates[side])))
        })
    }

    /// Rates of the flows through the necks in m3/s2 and of the pressures behind them in Pa/s.
    fn through_necks<T: Scalar + From<S>>(
        &self,
        chambers: [T; 2],
        states: &GasStates<T>,
        heated: &HeatedSides<T>,
    ) -> [[T; 2]; 2] {
        let [side_a, side_b] = [0, 1].map(|side| {
            let parts = self.necks[side].zip(self.accumulators[side]);
            parts.map_or([T::from(0.0); 2], |(neck, gas)| {
                let (flow, pressure) = (states.neck_flows[side], states.pressures[side]);
                let neck = neck.convert(&mut constant::<S, T>);
                let pushing = chambers[side] - pressure - neck.drop(flow);
                let rate = match &heated[side] {
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
