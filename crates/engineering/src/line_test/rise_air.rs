//! Free air in the oil of a line, as a pressure rise shows it.

use phea_dynamics::portable::{exp, ln};
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid, bulk_modulus_with_air};

/// Oil in a line that may carry bubbles. Units: m3, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AeratedOil {
    /// Volume of the oil.
    pub(super) volume: f64,
    /// The oil; its air is what is sought.
    pub(super) fluid: Fluid,
    /// Polytropic index of the compression.
    pub(super) exponent: f64,
}

/// Greatest fraction that is sought.
const MOST: f64 = 0.5;

/// Gauge pressure in Pa below which the oil is taken as at this pressure: near a vacuum the bubbles
/// have no end.
const LEAST_ABSOLUTE: f64 = 1e4;

/// Step of the derivatives over the fraction and, relative, over the pressure.
const STEP: f64 = 1e-6;

impl AeratedOil {
    /// Liquid and gas, each over its volume at atmospheric pressure.
    fn volumes(&self, pressure: f64) -> [f64; 2] {
        let absolute = (pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE).max(LEAST_ABSOLUTE);
        let ratio = ATMOSPHERIC_PRESSURE_ABSOLUTE / absolute;
        let liquid = exp((ATMOSPHERIC_PRESSURE_ABSOLUTE - absolute) / self.fluid.bulk_modulus);
        [liquid, exp(ln(ratio) / self.exponent)]
    }

    /// Volume in m3 that the line takes up from atmospheric pressure to a gauge pressure in Pa
    /// because of the air.
    ///
    /// ```text
    /// V (-ln((1 - a) V_liquid + a V_gas) - (p - p_0)/beta_0)            d/dp of it: V (1/beta(a, p) - 1/beta_0)
    /// ```
    pub(super) fn taken_up(&self, fraction: f64, pressure: f64) -> f64 {
        let [liquid, gas] = self.volumes(pressure);
        -self.volume * ln(1.0 + fraction * (gas / liquid - 1.0))
    }

    /// Derivative of the same over the fraction.
    pub(super) fn taken_up_slope(&self, fraction: f64, pressure: f64) -> f64 {
        let [liquid, gas] = self.volumes(pressure);
        let more = gas / liquid - 1.0;
        -self.volume * more / (1.0 + fraction * more)
    }

    /// Compliance in m3/Pa of the air at a gauge pressure in Pa, with the derivatives over the
    /// fraction and over the pressure.
    pub(super) fn compliance(&self, fraction: f64, pressure: f64) -> [f64; 3] {
        let of = |fraction: f64, pressure: f64| {
            let absolute = (pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE).max(LEAST_ABSOLUTE);
            let modulus = bulk_modulus_with_air(self.fluid.bulk_modulus, fraction, self.exponent, absolute);
            self.volume * (1.0 / modulus - 1.0 / self.fluid.bulk_modulus)
        };
        let by = STEP * (pressure.abs() + ATMOSPHERIC_PRESSURE_ABSOLUTE);
        [
            of(fraction, pressure),
            (of(fraction + STEP, pressure) - of(fraction - STEP, pressure)) / (2.0 * STEP),
            (of(fraction, pressure + by) - of(fraction, pressure - by)) / (2.0 * by),
        ]
    }

    /// Within what is sought.
    pub(super) fn possible(fraction: f64) -> f64 {
        fraction.clamp(0.0, MOST)
    }

    /// The air of this fraction.
    pub(super) fn air(&self, fraction: f64) -> EntrainedAir {
        EntrainedAir { volume_fraction: fraction, polytropic_exponent: self.exponent }
    }
}
