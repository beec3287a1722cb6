//! What supplies the pressure: a pressure that nothing moves, or a pump with its relief valve.

use phea_dynamics::scalar::Scalar;

use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::parameter::{ParameterError, Problems};

/// Where the supply pressure comes from. Units: m3/s, Pa, m3.
///
/// ```text
/// constant        p_S as stated, whatever the valve takes
/// pump limited    C_S(p_S) dp_S/dt = q_pump - q_relief - q_supply
///                 q_relief = (q_pump/dp_o) (p_S - p_relief)+
///                 C_S = V/beta + C_acc,    C_acc = (V_0/(n P)) (P_0/P)^(1/n) above the precharge, 0 below
/// ```
///
/// P and P_0 are absolute. The relief valve opens at the stated supply pressure less the override
/// dp_o, so that an idle pump holds the stated pressure; its own motion is faster than that of the
/// volume after it and neglected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PowerUnit<S = f64> {
    /// A pressure that nothing moves.
    #[default]
    Constant,
    /// A pump of fixed flow with its relief valve, on the volume of the supply line.
    PumpLimited(PumpLimited<S>),
}

/// A pump with fixed flow, a relief valve and the line to the servovalve. Units: m3/s, Pa, m3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PumpLimited<S = f64> {
    /// Flow of the pump in m3/s.
    pub pump_flow: S,
    /// Rise of pressure dp_o in Pa over which the relief valve opens from nothing to the pump's
    /// whole flow.
    pub relief_override: S,
    /// Volume V of the supply line in m3.
    pub volume: S,
    /// Effective bulk modulus beta of the supply line in Pa.
    pub effective_bulk_modulus: S,
    /// A bladder accumulator on it.
    pub accumulator: Option<Accumulator<S>>,
}

/// A gas-charged accumulator. Units: m3, Pa gauge, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulator<S = f64> {
    /// Volume V_0 of the gas at its precharge, in m3.
    pub gas_volume: S,
    /// Precharge pressure p_0 in Pa gauge.
    pub precharge_pressure: S,
    /// Polytropic index n of the gas: 1 slow, 1.4 fast.
    pub polytropic_exponent: S,
}

impl PumpLimited {
    /// Impossible parameters of this power unit; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.not_negative("pump_flow", self.pump_flow);
        problems.positive("relief_override", self.relief_override);
        problems.positive("volume", self.volume);
        problems.positive("effective_bulk_modulus", self.effective_bulk_modulus);
        if let Some(Accumulator { gas_volume, precharge_pressure, polytropic_exponent }) = self.accumulator {
            problems.positive("accumulator.gas_volume", gas_volume);
            problems.positive("accumulator.precharge_pressure", precharge_pressure);
            let is_index = (1.0..=5.0 / 3.0).contains(&polytropic_exponent);
            problems.require(
                "accumulator.polytropic_exponent",
                polytropic_exponent,
                is_index,
                "from 1 to 5/3",
            );
        }
        problems.into_vec()
    }
}

impl<S: Copy> PowerUnit<S> {
    /// Whether the supply pressure is a state.
    pub fn yields(&self) -> bool {
        matches!(self, PowerUnit::PumpLimited(_))
    }

    /// Every parameter replaced, in a fixed order.
    #[inline(always)]
    pub fn convert<T>(&self, of: &mut impl FnMut(S) -> T) -> PowerUnit<T> {
        match self {
            PowerUnit::Constant => PowerUnit::Constant,
            PowerUnit::PumpLimited(pump) => PowerUnit::PumpLimited(PumpLimited {
                pump_flow: of(pump.pump_flow),
                relief_override: of(pump.relief_override),
                volume: of(pump.volume),
                effective_bulk_modulus: of(pump.effective_bulk_modulus),
                accumulator: pump.accumulator.map(|accumulator| Accumulator {
                    gas_volume: of(accumulator.gas_volume),
                    precharge_pressure: of(accumulator.precharge_pressure),
                    polytropic_exponent: of(accumulator.polytropic_exponent),
                }),
            }),
        }
    }
}

impl<S: Scalar> PumpLimited<S> {
    /// Flow of the relief valve in m3/s at a supply pressure in Pa, where `stated` in Pa is held by
    /// the idle pump.
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

    /// Compliance C_S in m3/Pa at a supply pressure in Pa.
    pub fn compliance(&self, pressure: S) -> S {
        let line = self.volume / self.effective_bulk_modulus;
        match self.accumulator {
            None => line,
            Some(accumulator) => line + accumulator.compliance(pressure),
        }
    }

    /// Rate of the supply pressure in Pa/s while `taken` in m3/s goes to the valve.
    #[inline(always)]
    pub(crate) fn pressure_rate(&self, pressure: S, stated: S, taken: S) -> S {
        (self.pump_flow - self.relief_flow(pressure, stated) - taken) / self.compliance(pressure)
    }
}

impl<S: Scalar> Accumulator<S> {
    /// Compliance of the gas in m3/Pa at a pressure in Pa gauge; zero below the precharge, where
    /// the bladder fills the shell.
    fn compliance(&self, pressure: S) -> S {
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let precharge = self.precharge_pressure + atmosphere;
        let absolute = (pressure + atmosphere).maximum(precharge);
        let gas = self.gas_volume * ((precharge / absolute).ln() / self.polytropic_exponent).exp();
        let charged = gas / (self.polytropic_exponent * absolute);
        S::select(pressure.less_than(self.precharge_pressure), S::from(0.0), charged)
    }

    /// ln(P/P_0)/n, by which the logarithm of the gas volume has fallen; zero below the precharge.
    fn squeeze(&self, pressure: S) -> S {
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let precharge = self.precharge_pressure + atmosphere;
        ((pressure + atmosphere).maximum(precharge) / precharge).ln() / self.polytropic_exponent
    }

    /// Volume V_0 - V of the oil it holds, in m3.
    ///
    /// ```text
    /// V = V_0 (P_0/P)^(1/n)
    /// ```
    pub(super) fn oil(&self, pressure: S) -> S {
        self.gas_volume * (S::from(1.0) - (-self.squeeze(pressure)).exp())
    }

    /// Energy supplied to it at gauge pressure since the bladder filled the shell, in J.
    ///
    /// ```text
    /// integral of p dV = P_0 V_0 ((P/P_0)^((n-1)/n) - 1)/(n - 1) - p_atm (V_0 - V)
    /// ```
    ///
    /// For n = 1 the quotient is ln(P/P_0).
    pub(super) fn energy(&self, pressure: S) -> S {
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let squeeze = self.squeeze(pressure);
        let above_one = self.polytropic_exponent - S::from(1.0);
        let quotient = squeeze * exponential_quotient(above_one * squeeze);
        (self.precharge_pressure + atmosphere) * self.gas_volume * quotient - atmosphere * self.oil(pressure)
    }
}

/// (exp(z) - 1)/z, from its series where the difference would lose digits.
fn exponential_quotient<S: Scalar>(z: S) -> S {
    let one = S::from(1.0);
    let series = one
        + z / S::from(2.0) * (one + z / S::from(3.0) * (one + z / S::from(4.0) * (one + z / S::from(5.0))));
    S::select(z.abs().less_than(S::from(1e-2)), series, (z.exp() - one) / z)
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable::ln;
    use phea_dynamics::scalar::Dual;

    use super::*;

    fn accumulator(polytropic_exponent: f64) -> Accumulator {
        Accumulator { gas_volume: 1e-3, precharge_pressure: 40e5, polytropic_exponent }
    }

    /// Its oil grows by its compliance and its energy by the pressure times that, below the
    /// precharge not at all; either side of where the quotient turns into its series.
    #[test]
    fn gas_takes_what_flows_in() {
        for index in [1.0, 1.0 + 1e-9, 1.02, 1.03, 1.4] {
            for pressure in [0.0, 39e5, 41e5, 70e5, 350e5] {
                let gas = accumulator(index);
                let constant = Accumulator {
                    gas_volume: Dual::<1>::constant(gas.gas_volume),
                    precharge_pressure: Dual::constant(gas.precharge_pressure),
                    polytropic_exponent: Dual::constant(gas.polytropic_exponent),
                };
                let varied = Dual::variable(pressure, 0);
                let compliance = gas.compliance(pressure);
                let ([oil], [energy]) =
                    (*constant.oil(varied).gradient(), *constant.energy(varied).gradient());
                assert!((oil - compliance).abs() <= 1e-12 * compliance);
                assert!(
                    (energy - pressure * compliance).abs() <= 1e-10 * pressure * compliance,
                    "{index} {pressure}"
                );
                assert_eq!(gas.energy(pressure) > 0.0, pressure > 40e5);
            }
        }
    }

    #[test]
    fn slow_gas_takes_the_logarithm() {
        let atmosphere = ATMOSPHERIC_PRESSURE_ABSOLUTE;
        let (precharge, pressure) = (40e5 + atmosphere, 70e5 + atmosphere);
        let oil = 1e-3 * (1.0 - precharge / pressure);
        let energy = precharge * 1e-3 * ln(pressure / precharge) - atmosphere * oil;
        let gas = accumulator(1.0);
        assert!((gas.oil(70e5) / oil - 1.0).abs() < 1e-13 && (gas.energy(70e5) / energy - 1.0).abs() < 1e-13);
        assert!((accumulator(1.0 + 1e-7).energy(70e5) / energy - 1.0).abs() < 1e-6);
    }
}
