//! The end of the band of a sampled loop, pi/T, where bilinear functions have their zeros.

use num_complex::Complex64;
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;

use super::Compensation;

/// Relative distance from pi/T, and distance of a zero from z = -1, below which they coincide.
const AT_THE_END: f64 = 1e-9;

impl Compensation {
    /// True if this function of the loop vanishes at this frequency because of a zero at z = -1: at
    /// pi/T, where only rounding error would remain.
    pub(crate) fn vanishes(&self, function: &TransferFunction, frequency_rad_per_s: f64) -> bool {
        let at_end = frequency_rad_per_s >= self.highest_frequency_rad_per_s() * (1.0 - AT_THE_END);
        let is_zero = |zero: &Complex64| portable::magnitude(zero + 1.0) < AT_THE_END;
        at_end && function.domain() != TimeDomain::Continuous && function.zeros().iter().any(is_zero)
    }

    /// True if the closed loop from the reference vanishes at pi/T because prefilter or controller
    /// have a zero there.
    pub(crate) fn ends_at_zero(&self) -> bool {
        let highest = self.highest_frequency_rad_per_s();
        self.vanishes(&self.prefilter, highest) || self.vanishes(&self.feedback, highest)
    }
}
