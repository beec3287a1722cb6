//! Bladder between the gas and the oil behind a neck or a valve: the state variable of such gas.

use phea_dynamics::scalar::Scalar;

use super::LIFTING;
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;

/// Bladder of gas with its own state, at one temperature and setting of this gas.
///
/// ```text
/// s = p_0 - d + (d + v)/(1 + k)                              k = C_n/C_0,   d = P_0/100
/// v = k x                         x < 0, the bladder on the shell            x = p - p_0 + d
/// v = k x + x^2/(4 d)             0 <= x <= 2 d, the bladder lifts
/// v = (1 + k) x - d               x > 2 d, s = p
/// ```
///
/// p is the pressure of the oil behind the neck, s the pressure of the gas within the bladder,
/// apart from the contribution of the oil: C_0 (1 + k) s equals the oil volume that has entered, to
/// a few percent, taken by the gas or only by the oil. So ds/dt hardly changes when the compliance
/// falls from that of the gas to that of the oil, by a factor 1/k of 1e4 and more, and dp/dt rises
/// by this factor.
///
/// # Example
/// In use the gas has the pressure of its oil; shut off, it keeps its precharge at any oil
/// pressure.
/// ```
/// use phea_hydraulics::accumulator::Bladder;
/// let bladder = Bladder { precharge_pressure: 15e5, softness: 1e-5 };
/// assert_eq!(bladder.within(40e5), 40e5_f64);
/// assert!((bladder.within(2e5) - 15e5).abs() < 50.0);
/// assert!((bladder.pressure(bladder.within(2e5)) - 2e5).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bladder<S = f64> {
    /// Precharge pressure p_0 of the gas at this setting and temperature, Pa gauge.
    pub precharge_pressure: S,
    /// Ratio k of the compliance of the oil to that of the gas at its precharge.
    pub softness: S,
}

phea_dynamics::parameters! { Bladder { precharge_pressure, softness } }

impl<S: Scalar> Bladder<S> {
    /// Half width d in Pa, and lower edge p_0 - d in Pa gauge.
    fn edge(&self) -> [S; 2] {
        let precharge = self.precharge_pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let band = precharge * S::from(LIFTING);
        [band, self.precharge_pressure - band]
    }

    /// Oil pressure p at s, both Pa gauge.
    pub fn pressure(&self, within: S) -> S {
        let ([band, edge], k) = (self.edge(), self.softness);
        let (zero, one, two) = (S::from(0.0), S::from(1.0), S::from(2.0));
        let v = (one + k) * (within - edge) - band;
        let lifting = v.maximum(zero);
        let lifting = two * lifting / (k + (k.squared() + lifting / band).sqrt());
        let above = S::select(v.less_than(band * (one + two * k)), edge + lifting, within);
        S::select(v.less_than(zero), edge + v / k, above)
    }

    /// Gas pressure s at the oil pressure p, both Pa gauge.
    pub fn within(&self, pressure: S) -> S {
        let ([band, edge], k) = (self.edge(), self.softness);
        let x = pressure - edge;
        let lifting = x.maximum(S::from(0.0)).squared() / (S::from(4.0) * band);
        let below = edge + (band + k * x + lifting) / (S::from(1.0) + k);
        S::select(x.less_than(S::from(2.0) * band), below, pressure)
    }

    /// Rate ds/dt while p and the precharge change at these rates, Pa/s.
    ///
    /// ```text
    /// ds/dt = r dp/dt + (1 - r) d(p_0 - d)/dt + (1 - w^2)/(1 + k) dd/dt,   r = (k + w)/(1 + k)
    /// w = x/(2 d) from 0 to 1
    /// ```
    pub fn rate(&self, pressure: S, [rate, precharge_rate]: [S; 2]) -> S {
        let ([band, edge], k, one) = (self.edge(), self.softness, S::from(1.0));
        let lifted = (pressure - edge) / (S::from(2.0) * band);
        let lifted = lifted.maximum(S::from(0.0)).minimum(one);
        let follows = (k + lifted) / (one + k);
        let of_band = precharge_rate * S::from(LIFTING);
        follows * rate
            + (one - follows) * (precharge_rate - of_band)
            + (one - lifted.squared()) / (one + k) * of_band
    }
}

#[cfg(test)]
mod tests {
    use phea_dynamics::scalar::Dual;

    use super::*;

    /// Both functions are inverse from vacuum to ten times the precharge, and the rate is the
    /// derivative of s with respect to p and to the precharge.
    #[test]
    fn state_and_pressure_are_one() {
        for softness in [1e-7, 1e-4, 0.3] {
            let bladder = Bladder { precharge_pressure: 20e5, softness };
            for number in 0..=4000 {
                // fine steps through the band
                let near = 19.7e5 + 0.6e5 * f64::from(number) / 4000.0;
                for pressure in [near, 5e4 * f64::from(number)] {
                    let within = bladder.within(pressure);
                    // rounding of s equals rounding of p over k
                    let rounding = 1e-15 * 20e5 / softness + 1e-9;
                    assert!((bladder.pressure(within) - pressure).abs() < rounding, "{softness} {pressure}");
                    let varied: Bladder<Dual<2>> = Bladder {
                        precharge_pressure: Dual::variable(20e5, 1),
                        softness: Dual::constant(softness),
                    };
                    let [by_pressure, by_precharge] = *varied.within(Dual::variable(pressure, 0)).gradient();
                    let rate = bladder.rate(pressure, [3e5, -2e4]);
                    let expected = 3e5 * by_pressure - 2e4 * by_precharge;
                    assert!((rate - expected).abs() < 1e-9 * 3e5, "{pressure}: {rate} {expected}");
                    let [slope, _] = *varied.pressure(Dual::variable(within, 0)).gradient();
                    assert!((slope * by_pressure - 1.0).abs() < 1e-5, "{softness} {pressure}: {slope}");
                }
            }
        }
    }

    /// s is the pressure P_0 + d w^2 of the gas while the bladder lifts, and the oil pressure shows
    /// the gas compliance.
    #[test]
    fn it_is_the_pressure_of_the_gas() {
        let gas = crate::accumulator::Accumulator {
            gas_volume: 1e-5,
            precharge_pressure: 20e5,
            polytropic_exponent: 1.3,
        };
        let bladder = Bladder { precharge_pressure: 20e5, softness: 1e-9 };
        let atmosphere = ATMOSPHERIC_PRESSURE_ABSOLUTE;
        for pressure in [19.85e5, 20e5, 20.2e5, 20.5e5, 60e5] {
            let within = bladder.within(pressure) + atmosphere;
            // ORIGIN: analytic, P V^n = P_0 V_0^n of the gas within
            let volume = 1e-5 * phea_dynamics::portable::pow((20e5 + atmosphere) / within, 1.0 / 1.3);
            let oil = gas.oil(pressure);
            assert!((1e-5 - volume - oil).abs() < 1e-6 * oil + 1e-14, "{pressure}");
        }
    }
}
