//! Gas of an accumulator that exchanges heat with its wall.

use phea_dynamics::scalar::Scalar;

use super::{Accumulator, LIFTING};
use crate::fluid::ATMOSPHERIC_PRESSURE_ABSOLUTE;
use crate::parameter::{ParameterError, Problems};

/// Ratio gamma of the specific heats of a diatomic ideal gas, a good approximation for nitrogen up
/// to 200 bar.
pub const HEAT_CAPACITY_RATIO: f64 = 1.4;

/// Ideal gas whose temperature T approaches that of its wall, T_w, with a time constant.
///
/// ```text
/// P V = P_0 V_0 theta,    theta = T/T_w
/// P_0 V_0/(gamma - 1) dtheta/dt = P q - P_0 V_0/(gamma - 1) (theta - 1)/tau,     q = -dV/dt
/// ```
///
/// Source: Otis and Pourmovahed (1985), with an ideal gas and a wall of constant temperature. Slow
/// changes are isothermal, fast ones adiabatic. The bladder lifts from its shell like that of an
/// [`Accumulator`], around P_0 theta.
///
/// # Example
/// At the temperature of the wall nothing changes, and fast compression finds the gas gamma times
/// as stiff:
/// ```
/// use phea_hydraulics::accumulator::{Accumulator, RelaxingGas};
/// let gas = Accumulator { gas_volume: 1e-5, precharge_pressure: 15e5, polytropic_exponent: 1.0 };
/// let relaxing = RelaxingGas { gas_volume: 1e-5, precharge_pressure: 15e5, time_constant: 2.0 };
/// assert_eq!(relaxing.isothermal(), gas);
/// let heated = relaxing.at(35e5, 0.0);
/// assert!((1.4 * heated.compliance / gas.compliance(35e5) - 1.0_f64).abs() < 1e-14);
/// assert_eq!(heated.heat, 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxingGas<S = f64> {
    /// Volume V_0 of the gas at its precharge and the temperature of its wall, m3.
    pub gas_volume: S,
    /// Precharge pressure p_0 at the temperature of its wall, Pa gauge.
    pub precharge_pressure: S,
    /// Thermal time constant tau, s.
    pub time_constant: S,
}

/// Heat-exchanging gas at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatedGas<S = f64> {
    /// Compliance for changes faster than the heat exchange, m3/Pa.
    pub compliance: S,
    /// Rate at which its pressure falls while it cools at constant volume, Pa/s.
    pub cooling: S,
    /// Volume of the oil, m3.
    pub oil: S,
    /// Internal energy of the gas less the work done by the atmosphere, J; zero at absolute zero
    /// without oil.
    pub energy: S,
    /// Heat flow to the wall, W.
    pub heat: S,
    /// Rise of theta per volume of oil that enters, 1/m3.
    warming: S,
    /// Rate of theta from heat exchange only, 1/s.
    relaxing: S,
}

impl RelaxingGas {
    /// Impossible parameters of this gas; empty if there are none.
    pub fn problems(&self) -> Vec<ParameterError> {
        let mut problems = Problems::default();
        problems.all(self.isothermal().problems());
        problems.key(super::keys::THERMAL_TIME_CONSTANT_KEY, self.time_constant);
        problems.into_vec()
    }
}

phea_dynamics::parameters! { RelaxingGas { gas_volume, precharge_pressure, time_constant } }

impl<S: Scalar> RelaxingGas<S> {
    /// Gas in slow motion, which remains at the temperature of its wall.
    pub fn isothermal(&self) -> Accumulator<S> {
        let RelaxingGas { gas_volume, precharge_pressure, .. } = *self;
        Accumulator { gas_volume, precharge_pressure, polytropic_exponent: S::from(1.0) }
    }

    /// Gas at a pressure in Pa gauge and theta - 1.
    ///
    /// ```text
    /// V = V_0/g(r),   r = P/(P_0 theta);   g(r) = r,   or 1 + d w^2 while the bladder lifts,   d = 1/100
    /// C = C_T/(1 + (gamma - 1) k),   C_T = V_0 w/(P_0 theta g^2),   k = w r^2/g^2;   w and k are 1 after it has lifted
    /// q = C (dp/dt + P (theta - 1)/(theta tau))
    /// ```
    pub fn at(&self, pressure: S, warming: S) -> HeatedGas<S> {
        let (one, zero, band) = (S::from(1.0), S::from(0.0), S::from(LIFTING));
        let above_one = S::from(HEAT_CAPACITY_RATIO - 1.0);
        let atmosphere = S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let precharge = self.precharge_pressure + atmosphere;
        let (temperature, absolute) = (one + warming, pressure + atmosphere);
        let lifting = precharge * temperature;
        let ratio = absolute / lifting;
        let above = ratio - one;
        let fraction = ((above + band) / (band + band)).maximum(zero).minimum(one);
        let squeezed = one + S::select(above.less_than(band), band * fraction.squared(), above);
        let isothermal = self.gas_volume * fraction / (lifting * squeezed.squared());
        let steeper = one + above_one * fraction * (ratio / squeezed).squared();
        let capacity = precharge * self.gas_volume / above_one;
        let oil = self.gas_volume * (one - one / squeezed);
        let relaxing = warming / self.time_constant;
        HeatedGas {
            compliance: isothermal / steeper,
            cooling: absolute * relaxing / temperature,
            oil,
            energy: capacity * temperature - atmosphere * oil,
            heat: capacity * relaxing,
            warming: absolute / capacity,
            relaxing: -relaxing,
        }
    }

    /// Relaxation for small motions at a pressure in Pa gauge, at the temperature of the wall.
    ///
    /// ```text
    /// q/p = s C_T (1 + tau s)/(1 + G tau s),    G = 1 + (gamma - 1) k: gamma after the bladder has lifted
    /// ```
    pub fn relaxation(&self, pressure: S) -> GasRelaxation<S> {
        let at_rest = self.isothermal().compliance(pressure);
        let HeatedGas { compliance, .. } = self.at(pressure, S::from(0.0));
        let above_one = S::from(HEAT_CAPACITY_RATIO - 1.0);
        let precharge = self.precharge_pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        // k = C_T P^2/(P_0 V_0)
        let absolute = pressure + S::from(ATMOSPHERIC_PRESSURE_ABSOLUTE);
        let steeper = S::from(1.0) + above_one * at_rest * absolute.squared() / (precharge * self.gas_volume);
        GasRelaxation { compliance: at_rest - compliance, time: steeper * self.time_constant }
    }
}

impl<S: Scalar> HeatedGas<S> {
    /// Flow into the gas while its pressure rises at this rate in Pa/s, m3/s.
    pub fn flow(&self, pressure_rate: S) -> S {
        self.compliance * (pressure_rate + self.cooling)
    }

    /// Rate of theta at this flow in m3/s, 1/s.
    pub fn warming_rate(&self, flow: S) -> S {
        self.warming * flow + self.relaxing
    }
}

/// Delayed compliance of gas for small motions: C_r/(1 + T s). Units: m3/Pa, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasRelaxation<S = f64> {
    /// Excess C_r of the compliance at rest over the immediate one.
    pub compliance: S,
    /// Time constant T of the delayed compliance at constant pressure: gamma tau.
    pub time: S,
}
