//! The gas of accumulators at the chambers: at its chamber, behind necks and valves, and where it
//! exchanges heat.

use phea_dynamics::scalar::{Parameters, Scalar};

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

/// Gas at a pressure: while this changes, C dp/dt + q flows into it.
struct Content<T> {
    /// C in m3/Pa.
    compliance: T,
    /// q in m3/s at a pressure that is held.
    held: T,
}

impl<S: Scalar> Machine<S> {
    /// Pressures of the gas at either chamber, in Pa.
    #[inline(always)]
    pub(super) fn gas_pressures<T: Scalar>(&self, chambers: [T; 2], gas: &GasStates<T>) -> [T; 2] {
        let behind = self.layout.behind();
        [0, 1].map(|side| if behind[side] { gas.pressures[side] } else { chambers[side] })
    }

    /// Pressures in Pa gauge at which the gas at either chamber has its precharge, P_0 theta;
    /// `None` without gas.
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

    /// Pressures in Pa of the gas behind the necks, and theta of the gas that exchanges heat; zero
    /// at a chamber without.
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

    /// Rates of the pressures of both chambers in Pa/s with gas that has states of its own, with
    /// these flows into them in m3/s and these compliances in m3/Pa; writes the rates of those
    /// states. Apart, so that machines without such gas do not carry its code along.
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
        let setting = self.layout.setting(inputs);
        let (own, gas) = self.gas_rates((&gas, setting), &heated, [chambers, into, compliances]);
        self.layout.write_gas(gas, rates);
        own
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

    /// Rates in Pa/s of the pressures of both chambers, and of the states of the gas, with these
    /// flows in m3/s into chambers and gas, and compliances in m3/Pa without gas that has states of
    /// its own or is adjusted.
    ///
    /// ```text
    /// (C_oil + C) dp/dt = into - q                     gas at its chamber; q: at a pressure that is held
    /// C_oil dp/dt = into - q_n                         gas behind a neck or a valve
    /// (C + C_n) dp_g/dt = q_n - q
    /// I dq_n/dt = p - p_g - drop(q_n)                  of a neck
    /// ```
    fn gas_rates<T: Scalar + From<S>>(
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
