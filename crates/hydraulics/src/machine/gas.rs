//! Gas of accumulators at the chambers: directly at its chamber, behind necks and valves, and with
//! heat exchange.

use phea_dynamics::scalar::{Parameters, Scalar};

use super::Machine;
use super::equations::constant;
use crate::accumulator::{Bladder, HeatedGas, Neck};
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

/// States of the gas at both chambers, or their rates; states that a machine lacks are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GasStates<T> {
    /// Flow q_n through the neck of the accumulator at each chamber, into its gas, m3/s.
    pub(super) neck_flows: [T; 2],
    /// Pressure s of the gas behind each neck or valve, within its bladder, Pa: [`Bladder`].
    pub(super) pressures: [T; 2],
    /// Relative rise theta - 1 of the absolute temperature of the gas at each chamber above that of
    /// its wall, if it exchanges heat.
    pub(super) warmings: [T; 2],
}

impl<T: Scalar> GasStates<T> {
    /// State of zeros.
    pub(super) fn zero() -> GasStates<T> {
        let zero = [T::from(0.0); 2];
        GasStates { neck_flows: zero, pressures: zero, warmings: zero }
    }
}

/// Gas of both chambers that exchanges heat; `None` for a chamber without such gas.
pub(super) type HeatedSides<T> = [Option<HeatedGas<T>>; 2];

/// Gas at a pressure: with a changing pressure, C dp/dt + q flows into it.
struct Content<T> {
    /// Compliance C, m3/Pa.
    compliance: T,
    /// Flow q at constant pressure, m3/s.
    held: T,
}

impl<S: Scalar> Machine<S> {
    /// Pressures p_g of the oil at the gas of either chamber, Pa.
    #[inline(always)]
    pub(super) fn gas_pressures<T: Scalar + From<S>>(
        &self,
        chambers: [T; 2],
        gas: &GasStates<T>,
        setting: [T; 2],
    ) -> [T; 2] {
        let bladders = self.bladders(gas, setting);
        [0, 1].map(|side| bladders[side].map_or(chambers[side], |of| of.pressure(gas.pressures[side])))
    }

    /// States of the gas for these pressures of the oil at it in Pa, with the gas at the
    /// temperature of its wall and its setting at rest.
    pub(super) fn resting_gas<T: Scalar + From<S>>(&self, chambers: [T; 2]) -> GasStates<T> {
        let zero = GasStates::zero();
        let bladders = self.bladders(&zero, [T::from(0.0); 2]);
        let pressures =
            [0, 1].map(|side| bladders[side].map_or(zero.pressures[side], |of| of.within(chambers[side])));
        GasStates { pressures, ..zero }
    }

    /// Bladders of gas behind a neck or a valve; `None` at a chamber without either.
    #[inline(always)]
    fn bladders<T: Scalar + From<S>>(&self, gas: &GasStates<T>, setting: [T; 2]) -> [Option<Bladder<T>>; 2] {
        let (behind, precharges) = (self.layout.behind(), self.precharges(gas, setting));
        [0, 1].map(|side| {
            let precharge_pressure = precharges[side].filter(|_| behind[side])?;
            let stated = self.gas[side].as_ref()?.at_rest();
            let absolute = stated.precharge_pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
            let of_gas = stated.gas_volume / (stated.polytropic_exponent * absolute);
            Some(Bladder {
                precharge_pressure,
                softness: self.before_gas::<T>(side) / constant::<S, T>(of_gas),
            })
        })
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
            let chamber_gas = self.gas[side].as_ref()?;
            let stated: T = constant(chamber_gas.at_rest().precharge_pressure);
            let rise = chamber_gas.adjusted().map(|of| T::from(of.precharge_rise));
            let precharge = rise.map_or(stated, |rise| stated + rise * change);
            Some(match chamber_gas.relaxing() {
                None => precharge,
                Some(_) => {
                    precharge + (precharge + T::from(ATMOSPHERIC_PRESSURE_ABSOLUTE)) * gas.warmings[side]
                }
            })
        })
    }

    /// Pressures of the oil at the gas behind the necks in Pa, and theta of the gas that exchanges
    /// heat; zero at a chamber without.
    pub(super) fn told_of_gas<T: Scalar + From<S>>(&self, vector: &[T], setting: [T; 2]) -> [[T; 2]; 2] {
        let gas = self.layout.read_gas(vector);
        let zero = T::from(0.0);
        let heated = self.layout.heated();
        let ratios = [0, 1].map(|side| if heated[side] { T::from(1.0) + gas.warmings[side] } else { zero });
        [self.gas_pressures([zero; 2], &gas, setting), ratios]
    }

    /// Neck between a chamber and its gas.
    pub(super) fn neck<T: Scalar + From<S>>(&self, side: usize) -> Option<Neck<T>> {
        Some(self.gas[side].as_ref()?.neck()?.convert(&mut constant::<S, T>))
    }

    /// Gas that exchanges heat, at these pressures of the oil at it in Pa.
    pub(super) fn heated<T: Scalar + From<S>>(
        &self,
        pressures: [T; 2],
        states: &GasStates<T>,
    ) -> HeatedSides<T> {
        let warmings = states.warmings;
        [0, 1].map(|side| {
            let gas = self.gas[side].as_ref()?.relaxing()?.convert(&mut constant::<S, T>);
            Some(gas.at(pressures[side], warmings[side]))
        })
    }

    /// Rates of the pressures of both chambers in Pa/s with gas that has states of its own, with
    /// these flows into them in m3/s and these compliances in m3/Pa; writes the rates of those
    /// states. Separate function, so that machines without such gas do not contain its code.
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
        let setting = self.layout.setting(inputs);
        let (own, gas) = self.gas_rates((&gas, setting), [chambers, into, compliances]);
        self.layout.write_gas(gas, rates);
        own
    }

    /// Gas at a chamber at its pressure in Pa.
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
    /// (C_oil + C) dp/dt = into - q                     gas at its chamber; q: at constant pressure
    /// C_oil dp/dt = into - q_n                         gas behind a neck or a valve
    /// (C + C_n) dp_g/dt = q_n - q                      which gives the rate of its state s: Bladder
    /// I dq_n/dt = p - p_g - drop(q_n)                  for a neck
    /// ```
    fn gas_rates<T: Scalar + From<S>>(
        &self,
        (gas, setting): (&GasStates<T>, [T; 2]),
        [chambers, into, compliances]: [[T; 2]; 3],
    ) -> ([T; 2], GasStates<T>) {
        let mut own = [T::from(0.0); 2];
        let mut rates = GasStates::zero();
        let (apart, pressures) = (self.layout.gas_at(), self.gas_pressures(chambers, gas, setting));
        let (heated, bladders) = (self.heated(pressures, gas), self.bladders(gas, setting));
        for side in [0, 1] {
            let (pressure, oil) = (pressures[side], compliances[side]);
            let content = self.content(side, (pressure, setting), &heated).filter(|_| apart[side]);
            let Some(Content { compliance, held }) = content else {
                own[side] = into[side] / oil;
                continue;
            };
            let neck = self.neck(side);
            let drop = chambers[side] - pressure;
            let through = neck.map(|_| gas.neck_flows[side]).or(self.through_gas_valve(side, setting, drop));
            let of_gas = match through {
                None => {
                    own[side] = (into[side] - held) / (oil + compliance);
                    own[side]
                }
                Some(flow) => {
                    own[side] = (into[side] - flow) / oil;
                    (flow - held) / (compliance + self.before_gas(side))
                }
            };
            if let Some(neck) = neck {
                rates.neck_flows[side] = (drop - neck.drop(gas.neck_flows[side])) / neck.inertance;
            }
            if let Some(gas) = &heated[side] {
                rates.warmings[side] = gas.warming_rate(gas.flow(of_gas));
            }
            if let Some(bladder) = &bladders[side] {
                let precharge_rate = self.precharge_rate(side, setting, rates.warmings[side]);
                rates.pressures[side] = bladder.rate(pressure, [of_gas, precharge_rate]);
            }
        }
        (own, rates)
    }
    /// Rate of the pressure at which the gas at a chamber has its precharge, P_0 theta, with this
    /// rate of theta in 1/s, Pa/s.
    fn precharge_rate<T: Scalar + From<S>>(&self, side: usize, setting: [T; 2], warming_rate: T) -> T {
        let Some(moved) = self.moved_gas(side, setting) else { return T::from(0.0) };
        let absolute = moved.gas.precharge_pressure + T::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        moved.precharge_rate + absolute * warming_rate
    }
}
