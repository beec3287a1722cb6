//! Gas-charged accumulator at the supply, or at the line of a chamber.

mod adjustment;
mod adjustment_keys;
mod bladder;
mod branch;
mod chamber_gas;
mod checks;
mod component;
mod heat;
mod keys;
mod neck;

pub use adjustment::{AdjustedGas, GasValve, MovedGas};
pub use adjustment_keys::{AdjustmentKind, DeclaredAdjustment, DeclaredGasValve, GasAtOne};
pub use bladder::Bladder;
pub use branch::{GasBranch, NeckImpedance};
pub use chamber_gas::{ChamberGas, GasContent, GasPassage, SealedGas};
pub use heat::{GasRelaxation, HEAT_CAPACITY_RATIO, HeatedGas, RelaxingGas};
pub use keys::{DeclaredAccumulator, DeclaredNeck, GasTemperatures};
pub use neck::Neck;

use phea_dynamics::scalar::{LocalFunction, Parameters, Scalar};

use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::parameter::{ParameterError, Problems};

/// Gas-charged accumulator. Units: m3, Pa gauge, 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulator<S = f64> {
    /// Volume V_0 of the gas at its precharge, in m3.
    pub gas_volume: S,
    /// Precharge pressure p_0 in Pa gauge.
    pub precharge_pressure: S,
    /// Polytropic index n of the gas: 1 slow, 1.4 fast.
    pub polytropic_exponent: S,
}

impl Accumulator {
    /// Impossible parameters of this accumulator; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        let Accumulator { gas_volume, precharge_pressure, polytropic_exponent } = *self;
        problems.key(keys::GAS_VOLUME_KEY, gas_volume);
        problems.key(keys::PRECHARGE_PRESSURE_KEY, precharge_pressure);
        problems.key(keys::POLYTROPIC_EXPONENT_KEY, polytropic_exponent);
        problems.into_vec()
    }
}

phea_dynamics::parameters! { Accumulator { gas_volume, precharge_pressure, polytropic_exponent } }

/// Compliance as a function of the pressure.
impl<S: Scalar> LocalFunction<S, 1, 1> for Accumulator<S> {
    #[inline(always)]
    fn at<T: Scalar>(&self, [pressure]: [T; 1], constant: impl Fn(S) -> T + Copy) -> [T; 1] {
        [self.convert(&mut |parameter| constant(parameter)).compliance(pressure)]
    }
}

/// Fraction of the absolute precharge, to both sides of it, over which the bladder lifts.
const LIFTING: f64 = 0.01;

/// State of the bladder at a pressure.
struct Lifted<S> {
    /// Fraction w, from 0 on the shell to 1.
    fraction: S,
    /// Absolute precharge P_0, Pa.
    precharge: S,
    /// Absolute gas pressure P, Pa.
    absolute: S,
}

impl<S: Scalar> Accumulator<S> {
    /// Compliance of the gas in m3/Pa at a pressure in Pa gauge; zero below the precharge, where
    /// the bladder fills the shell.
    ///
    /// ```text
    /// C = V_0/(n P) (P_0/P)^(1/n) = V_0/(n P_0) (P_0/P)^(1 + 1/n)          from V = V_0 (P_0/P)^(1/n)
    /// ```
    ///
    /// P and P_0 are absolute. Source: the polytropic law P V^n = P_0 V_0^n, differentiated. The
    /// bladder lifts from the shell between 0.99 and 1.01 P_0:
    ///
    /// ```text
    /// P = P_0 + s,   s = d w^2,   C = V_0/(n P) (P_0/P)^(1/n) w,   w = (p - p_0 + d)/(2 d) from 0 to 1,   d = P_0/100
    /// ```
    ///
    /// Above 1.01 P_0 the bladder has no effect on C and V. A jump of C would be a jump of the
    /// rates, at which an implicit method may fail.
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::accumulator::Accumulator;
    /// let gas = Accumulator { gas_volume: 9.9e-6, precharge_pressure: 15e5, polytropic_exponent: 1.0 };
    /// let [precharge, pressure] = [16.01325e5, 36.01325e5];
    /// assert!((gas.compliance(35e5) / (9.9e-6 * precharge / (pressure * pressure)) - 1.0_f64).abs() < 1e-14);
    /// assert_eq!(gas.compliance(14.8e5), 0.0);
    /// ```
    pub fn compliance(&self, pressure: S) -> S {
        let Lifted { fraction, absolute, .. } = self.lifted(pressure);
        let gas = self.gas_volume * (-self.squeeze(pressure)).exp();
        fraction * gas / (self.polytropic_exponent * absolute)
    }

    /// Gas at another temperature: its precharge is the pressure in the unchanged volume. Absolute
    /// temperatures at which the precharge is stated and at which the gas works, K.
    ///
    /// ```text
    /// P_0 = P_c T/T_c,     absolute
    /// ```
    ///
    /// # Example
    /// ```
    /// use phea_hydraulics::accumulator::Accumulator;
    /// let cold = Accumulator { gas_volume: 1e-5, precharge_pressure: 29e5, polytropic_exponent: 1.0 };
    /// let warm = cold.at_temperature([300.0, 330.0]);
    /// assert!((warm.precharge_pressure + 101_325.0 - 1.1 * (29e5 + 101_325.0_f64)).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn at_temperature(&self, [stated, working]: [S; 2]) -> Accumulator<S> {
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let absolute = (self.precharge_pressure + atmosphere) * working / stated;
        Accumulator { precharge_pressure: absolute - atmosphere, ..*self }
    }

    /// Lowest pressure at which the bladder is off the shell, 1.01 P_0, Pa gauge.
    pub fn least_pressure(&self) -> S {
        let [_, lifted] = self.lifting_pressures();
        lifted
    }

    /// Pressures between which the bladder lifts, 0.99 and 1.01 P_0, Pa gauge.
    pub fn lifting_pressures(&self) -> [S; 2] {
        let precharge = self.precharge_pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let band = precharge * S::from(LIFTING);
        [self.precharge_pressure - band, self.precharge_pressure + band]
    }

    fn lifted(&self, pressure: S) -> Lifted<S> {
        let precharge = self.precharge_pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let band = precharge * S::from(LIFTING);
        let above = pressure - self.precharge_pressure;
        let fraction = (above + band) / (S::from(2.0) * band);
        let fraction = fraction.maximum(S::from(0.0)).minimum(S::from(1.0));
        let compressed = S::select(above.less_than(band), band * fraction.squared(), above);
        Lifted { fraction, precharge, absolute: precharge + compressed }
    }

    /// Reduction ln(P/P_0)/n of the logarithm of the gas volume; zero below the precharge.
    fn squeeze(&self, pressure: S) -> S {
        let Lifted { precharge, absolute, .. } = self.lifted(pressure);
        (absolute / precharge).ln() / self.polytropic_exponent
    }

    /// Oil volume V_0 - V in the accumulator, m3.
    ///
    /// ```text
    /// V = V_0 (P_0/P)^(1/n)
    /// ```
    pub fn oil(&self, pressure: S) -> S {
        self.gas_volume * (S::from(1.0) - (-self.squeeze(pressure)).exp())
    }

    /// Energy supplied to the accumulator at gauge pressure since the bladder filled the shell, J.
    ///
    /// ```text
    /// integral of p dV = P_0 V_0 ((P/P_0)^((n-1)/n) - 1)/(n - 1) - p_atm (V_0 - V)
    /// ```
    ///
    /// For n = 1 the quotient is ln(P/P_0). While the bladder lifts, the pressure of the oil is
    /// less than that of the gas by d (1 - w)^2, which reduces the energy by
    ///
    /// ```text
    /// 2 d^2 V_0/(n P_0) integral from 0 to w of (1 - x)^2 x (1 + x^2 d/P_0)^-(1 + 1/n) dx
    /// ```
    pub(crate) fn energy(&self, pressure: S) -> S {
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let squeeze = self.squeeze(pressure);
        let above_one = self.polytropic_exponent - S::from(1.0);
        let quotient = squeeze * exponential_quotient(above_one * squeeze);
        (self.precharge_pressure + atmosphere) * self.gas_volume * quotient
            - atmosphere * self.oil(pressure)
            - self.lifting_energy(pressure)
    }

    /// Binomial series, whose terms decrease by a hundred each.
    fn lifting_energy(&self, pressure: S) -> S {
        const TERMS: u32 = 6;
        let Lifted { fraction, precharge, .. } = self.lifted(pressure);
        let exponent = S::from(1.0) + S::from(1.0) / self.polytropic_exponent;
        let (mut factor, mut power, mut sum) = (S::from(1.0), fraction.squared(), S::from(0.0));
        for term in 0..TERMS {
            let order = f64::from(2 * term);
            let integral = S::from(1.0 / (order + 2.0)) - S::from(2.0 / (order + 3.0)) * fraction
                + S::from(1.0 / (order + 4.0)) * fraction.squared();
            sum = sum + factor * power * integral;
            let next = S::from(f64::from(term)) + exponent;
            factor = -factor * next * S::from(LIFTING / f64::from(term + 1));
            power = power * fraction.squared();
        }
        let scale = S::from(2.0 * LIFTING * LIFTING) * precharge * self.gas_volume / self.polytropic_exponent;
        scale * sum
    }
}

/// Quotient (exp(z) - 1)/z, from its series if the difference would lose digits.
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

    /// Its oil grows by the compliance and its energy by pressure times the oil, below the
    /// precharge not at all; on either side of the transition from the quotient to its series.
    #[test]
    fn gas_takes_what_flows_in() {
        for index in [1.0, 1.0 + 1e-9, 1.02, 1.03, 1.4] {
            for pressure in [0.0, 39e5, 39.7e5, 40e5, 40.3e5, 41e5, 70e5, 350e5] {
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
                assert_eq!(gas.energy(pressure) > 0.0, pressure > 39.5e5);
            }
        }
    }

    /// Slow gas follows the logarithm once all of it is in use; from the shell on, the energy is
    /// less by the work of lifting the bladder.
    #[test]
    fn slow_gas_takes_the_logarithm() {
        let atmosphere = ATMOSPHERIC_PRESSURE_ABSOLUTE;
        let precharge = 40e5 + atmosphere;
        let gas = accumulator(1.0);
        let ideal = |pressure: f64| {
            let absolute = pressure + atmosphere;
            let oil = 1e-3 * (1.0 - precharge / absolute);
            (oil, precharge * 1e-3 * ln(absolute / precharge) - atmosphere * oil)
        };
        let ((low, from), (high, to)) = (ideal(41e5), ideal(70e5));
        assert!((gas.oil(41e5) / low - 1.0).abs() < 1e-13 && (gas.oil(70e5) / high - 1.0).abs() < 1e-13);
        let between = |gas: Accumulator| gas.energy(70e5) - gas.energy(41e5);
        assert!((between(gas) / (to - from) - 1.0).abs() < 1e-12);
        assert!((between(accumulator(1.0 + 1e-7)) / (to - from) - 1.0).abs() < 1e-6);
        // 2 d^2 V_0/P_0 (1/12 - 2/60 d/P_0 + ...)
        let lifting = 2e-4 * precharge * 1e-3 * (1.0 / 12.0 - 0.01 / 30.0);
        assert!(((to - gas.energy(70e5)) / lifting - 1.0).abs() < 1e-4);
    }
}
