//! The quantities that the searches of a box maximise.

use super::MemberStability;
use super::characteristic::Characteristic;
use super::measured::OpenLoop;

/// The quantity that the search maximises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Badness {
    RealPart,
    Closeness,
    DelaySensitivity,
    /// The largest |L| of a resonance: if it reaches one there is another crossover, which may
    /// tolerate much less delay.
    Peak,
}

impl Badness {
    pub(super) fn of(self, characteristic: &Characteristic) -> Option<f64> {
        match self {
            Badness::RealPart => characteristic.largest_real_part().ok()?,
            Badness::Closeness => {
                let found = characteristic.encirclement().ok()?;
                Some(if found.unstable_poles > 0 { f64::INFINITY } else { -found.closest.0 })
            }
            Badness::DelaySensitivity => Some(-characteristic.critical_delay().ok()?.delay_s),
            Badness::Peak => characteristic.largest_peak(),
        }
    }

    /// Value for a plant without polynomials, whose poles are unknown.
    pub(super) fn of_response(self, open_loop: &OpenLoop) -> Option<f64> {
        match self {
            Badness::Closeness => Some(-open_loop.closest_approach().distance),
            Badness::DelaySensitivity => Some(-open_loop.critical_delay().delay_s),
            Badness::RealPart | Badness::Peak => None,
        }
    }

    /// Stored value for a plant.
    pub(super) fn among(self, plant: &[f64; 3]) -> f64 {
        let &[real_part, closeness, delay_sensitivity] = plant;
        match self {
            Badness::RealPart => real_part,
            Badness::Closeness => closeness,
            Badness::DelaySensitivity => delay_sensitivity,
            Badness::Peak => f64::NAN,
        }
    }
}

/// Real part, closeness and delay sensitivity of a plant.
pub(super) fn badness_of(found: &MemberStability) -> [f64; 3] {
    [
        found.largest_real_part.unwrap_or(f64::NAN),
        found.closest_approach.map_or(f64::NAN, |closest| -closest.distance),
        found.critical_delay.map_or(f64::NAN, |critical| -critical.delay_s),
    ]
}
