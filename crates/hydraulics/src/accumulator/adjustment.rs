//! Accumulator at a chamber that is adjusted in operation: gas is added and removed, or a valve
//! opens between chamber and gas.
//!
//! ```text
//! V_0(u) = V_0 + V_1 u,   p_0(u) = p_0 + p_1 u             u: change of the setting from rest
//! q = dV_oil/dt = C dp/dt + (dV_oil/du) du/dt               V_oil changes with the setting at constant pressure
//! q = (s + u) K root(p - p_g)                               the valve, s: its opening at rest, from 0 to 1
//! ```

use phea_dynamics::scalar::Scalar;

use super::{Accumulator, Neck};
use crate::cross_port::TRANSITION_PRESSURE_KEY;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::orifice::{flow, regular_root_slope};
use crate::parameter::{ParameterError, Problems};

/// Gas that is added and removed in operation. Units: 1, m3, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdjustedGas<S = f64> {
    /// Gas at the setting at rest.
    pub at_rest: Accumulator<S>,
    /// Setting at rest, from 0 to 1.
    pub setting: S,
    /// Increase V_1 of its volume from setting 0 to 1.
    pub volume_rise: S,
    /// Increase p_1 of its precharge from setting 0 to 1.
    pub precharge_rise: S,
    /// Neck between chamber and gas; `None` without one.
    pub neck: Option<Neck<S>>,
    /// Highest permitted pressure over the precharge, both absolute, if stated.
    pub maximum_pressure_ratio: Option<S>,
}

/// Valve between a chamber and the gas of its accumulator. Units: 1, m3/(s Pa^0.5), Pa, m3/Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasValve<S = f64> {
    /// Setting at rest: shut at 0, fully open at 1.
    pub setting: S,
    /// Flow coefficient K, fully open.
    pub flow_coefficient: S,
    /// Pressure drop below which the square root is regularised.
    pub transition_pressure: S,
    /// Compliance of the oil between valve and gas: it remains when the gas fills its shell.
    pub compliance: S,
    /// True if the valve is shut at rest, so that the gas has no effect on small motions.
    pub shut: bool,
}

/// Gas of an accumulator during adjustment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovedGas<S = f64> {
    /// Gas at this setting.
    pub gas: Accumulator<S>,
    /// Rate of V_0, m3/s.
    pub volume_rate: S,
    /// Rate of p_0, Pa/s.
    pub precharge_rate: S,
}

impl AdjustedGas {
    /// Impossible parameters of this gas; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.all(self.at_rest.problems());
        problems.all(self.neck.map_or(Vec::new(), |neck| neck.problems()));
        problems.all(setting_problems(self.setting));
        let ends = [-self.setting, 1.0 - self.setting];
        for moved in ends.map(|change| self.moved(change, 0.0).gas) {
            problems.component("adjustment", moved.problems());
        }
        problems.into_vec()
    }
}

impl GasValve {
    /// Impossible parameters of this valve; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.all(setting_problems(self.setting));
        problems.positive("adjustment.flow_coefficient", self.flow_coefficient);
        problems.key_as("adjustment.transition_pressure", TRANSITION_PRESSURE_KEY, self.transition_pressure);
        problems.positive("adjustment.compliance", self.compliance);
        problems.into_vec()
    }
}

fn setting_problems(setting: f64) -> Vec<ParameterError> {
    let mut problems = Problems::default();
    problems.key_as("adjustment.setting", super::adjustment_keys::SETTING_KEY, setting);
    problems.into_vec()
}

phea_dynamics::parameters! { AdjustedGas { at_rest, setting, volume_rise, precharge_rise, neck, maximum_pressure_ratio } }
phea_dynamics::parameters! {
    GasValve { setting, flow_coefficient, transition_pressure, compliance, shut: kept }
}

impl<S: Scalar> AdjustedGas<S> {
    /// Gas after the setting has moved by `change`, at a rate of the setting of `rate` in 1/s.
    pub fn moved(&self, change: S, rate: S) -> MovedGas<S> {
        MovedGas {
            gas: Accumulator {
                gas_volume: self.at_rest.gas_volume + self.volume_rise * change,
                precharge_pressure: self.at_rest.precharge_pressure + self.precharge_rise * change,
                ..self.at_rest
            },
            volume_rate: self.volume_rise * rate,
            precharge_rate: self.precharge_rise * rate,
        }
    }
}

impl<S: Scalar> GasValve<S> {
    /// Flow into the gas for a drop p - p_g in Pa, after the setting has moved by `change`, m3/s.
    pub fn flow(&self, change: S, drop: S) -> S {
        flow((self.setting + change) * self.flow_coefficient, drop, self.transition_pressure)
    }

    /// Conductance at rest and zero drop, which is that of the transition, m3/(s Pa).
    pub fn conductance(&self) -> S {
        self.setting * self.flow_coefficient * regular_root_slope(S::from(0.0), self.transition_pressure)
    }
}

impl<S: Scalar> MovedGas<S> {
    /// Rate at which the volume of its oil grows at a constant pressure in Pa, m3/s.
    ///
    /// ```text
    /// dV_oil/dt = V_oil/V_0 dV_0/dt - P/P_0 C dp_0/dt         V_oil is V_0 times a function of P/P_0
    /// ```
    ///
    /// # Example
    /// Twice the gas at a pressure contains twice the oil:
    /// ```
    /// use phea_hydraulics::accumulator::{Accumulator, MovedGas};
    /// let gas = Accumulator { gas_volume: 1e-5, precharge_pressure: 15e5, polytropic_exponent: 1.2 };
    /// let moved = MovedGas { gas, volume_rate: 1e-5, precharge_rate: 0.0 };
    /// assert!((moved.oil_rate(35e5) / gas.oil(35e5) - 1.0_f64).abs() < 1e-14);
    /// ```
    pub fn oil_rate(&self, pressure: S) -> S {
        let gas = &self.gas;
        let ratio = absolute(pressure) / absolute(gas.precharge_pressure);
        gas.oil(pressure) / gas.gas_volume * self.volume_rate
            - ratio * gas.compliance(pressure) * self.precharge_rate
    }

    /// Power of the adjustment: rate of the energy that the oil can recover from the gas while no
    /// oil moves, W.
    ///
    /// ```text
    /// W(V_oil, V_0, p_0): integral of p dV_oil, from the bladder on its shell
    /// dW/dt = p q + (W - p V_oil)/V_0 dV_0/dt + (W + p_atm V_oil)/P_0 dp_0/dt
    /// ```
    ///
    /// Analogous to the gain 1/2 dK/dt x^2 of a spring of stiffness K. The cost of compressing gas
    /// to its precharge outside is not included.
    pub fn power(&self, pressure: S) -> S {
        let gas = &self.gas;
        let (held, oil) = (gas.energy(pressure), gas.oil(pressure));
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        (held - pressure * oil) / gas.gas_volume * self.volume_rate
            + (held + atmosphere * oil) / absolute(gas.precharge_pressure) * self.precharge_rate
    }
}

fn absolute<S: Scalar>(pressure: S) -> S {
    pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE)
}

#[cfg(test)]
mod tests {
    use phea_dynamics::scalar::Dual;

    use super::*;

    /// Rates of oil and energy agree with V_oil(p, V_0, p_0) and W(p, V_0, p_0), also while the
    /// bladder lifts.
    #[test]
    fn oil_and_energy_follow_the_setting() {
        for exponent in [1.0, 1.02, 1.4] {
            for pressure in [38e5, 39.8e5, 40.2e5, 45e5, 120e5] {
                let gas = Accumulator {
                    gas_volume: Dual::<3>::variable(1e-3, 0),
                    precharge_pressure: Dual::variable(40e5, 1),
                    polytropic_exponent: Dual::constant(exponent),
                };
                let varied = Dual::variable(pressure, 2);
                let (oil, energy) = (*gas.oil(varied).gradient(), *gas.energy(varied).gradient());
                let own =
                    Accumulator { gas_volume: 1e-3, precharge_pressure: 40e5, polytropic_exponent: exponent };
                for (place, rates) in [[2e-4, 0.0], [0.0, 3e5]].into_iter().enumerate() {
                    let moved = MovedGas { gas: own, volume_rate: rates[0], precharge_rate: rates[1] };
                    let rate = rates[place];
                    let expected = oil[place] * rate;
                    assert!((moved.oil_rate(pressure) - expected).abs() <= 1e-11 * expected.abs().max(1e-9));
                    let expected = (energy[place] - pressure * oil[place]) * rate;
                    let size = own.energy(pressure).max(1e-3);
                    assert!(
                        (moved.power(pressure) - expected).abs() <= 1e-10 * size,
                        "{exponent} {pressure}"
                    );
                }
            }
        }
    }
}
