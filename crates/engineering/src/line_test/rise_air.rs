//! Free air in the oil of a line, from a pressure rise.

use phea_dynamics::portable::{exp, ln};
use phea_hydraulics::fluid::{ATMOSPHERIC_PRESSURE_ABSOLUTE, EntrainedAir, Fluid, bulk_modulus_with_air};

/// Oil in a line that may contain bubbles. Units: m3, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AeratedOil {
    /// Volume of the oil.
    pub(super) volume: f64,
    /// Oil; its air is estimated.
    pub(super) fluid: Fluid,
    /// Polytropic index of the compression.
    pub(super) exponent: f64,
}

/// Greatest fraction in the search.
const MOST: f64 = 0.5;

/// Absolute pressure, Pa, that replaces lower ones: near a vacuum the bubbles grow without bound.
const LEAST_ABSOLUTE: f64 = 1e4;

/// Step of the derivatives with respect to the fraction and, relative, to the pressure.
const STEP: f64 = 1e-6;

impl AeratedOil {
    /// Volumes of liquid and gas, each divided by its volume at atmospheric pressure.
    fn volumes(&self, pressure: f64) -> [f64; 2] {
        let absolute = (pressure + ATMOSPHERIC_PRESSURE_ABSOLUTE).max(LEAST_ABSOLUTE);
        let ratio = ATMOSPHERIC_PRESSURE_ABSOLUTE / absolute;
        let liquid = exp((ATMOSPHERIC_PRESSURE_ABSOLUTE - absolute) / self.fluid.bulk_modulus);
        [liquid, exp(ln(ratio) / self.exponent)]
    }

    /// Volume that the line takes up from atmospheric pressure to a gauge pressure, Pa, because of
    /// the air, m3.
    ///
    /// ```text
    /// V (-ln((1 - a) V_liquid + a V_gas) - (p - p_0)/beta_0)            d/dp of it: V (1/beta(a, p) - 1/beta_0)
    /// ```
    pub(super) fn taken_up(&self, fraction: f64, pressure: f64) -> f64 {
        let [liquid, gas] = self.volumes(pressure);
        -self.volume * ln(1.0 + fraction * (gas / liquid - 1.0))
    }

    /// Derivative of this volume with respect to the fraction.
    pub(super) fn taken_up_slope(&self, fraction: f64, pressure: f64) -> f64 {
        let [liquid, gas] = self.volumes(pressure);
        let more = gas / liquid - 1.0;
        -self.volume * more / (1.0 + fraction * more)
    }

    /// Compliance of the air at a gauge pressure, Pa, in m3/Pa, with the derivatives with respect
    /// to the fraction and to the pressure.
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

    /// Fraction limited to the range of the search.
    pub(super) fn possible(fraction: f64) -> f64 {
        fraction.clamp(0.0, MOST)
    }

    /// Air of this fraction.
    pub(super) fn air(&self, fraction: f64) -> EntrainedAir {
        EntrainedAir { volume_fraction: fraction, polytropic_exponent: self.exponent }
    }
}
