//! Plants without polynomials: known by their response at every frequency, and by its bounds
//! between two frequencies.

use std::fmt::Debug;
use std::sync::Arc;

use num_complex::Complex64;

use crate::analytic::Disc;
use crate::uncertain_plant::PlantCoefficients;

/// Plant that is not a quotient of polynomials, for example one with wave propagation in its lines.
/// Its only pole on the imaginary axis, if any, is at zero.
pub trait RespondingPlant: Debug + Send + Sync {
    /// Responses P(jw), and Pd(jw) from the disturbance, at a positive frequency in rad/s.
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2];

    /// Rate that a controller may feed forward, at a positive frequency in rad/s: from the command,
    /// and from the disturbance, which is s if the command does not move the rate.
    fn rate(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        [Complex64::new(0.0, 0.0), Complex64::new(0.0, frequency_rad_per_s)]
    }

    /// Inner signal that a sampled controller may feed back, at a positive frequency in rad/s: from
    /// the command, and from the disturbance.
    fn inner(&self, _frequency_rad_per_s: f64) -> [Complex64; 2] {
        [Complex64::new(0.0, 0.0); 2]
    }

    /// Disc that contains P(jw) at every frequency between two in rad/s, the first of which may be
    /// zero; the whole plane if no bound is known. It shrinks to the response as the two come
    /// together.
    fn enclosure(&self, frequencies_rad_per_s: [f64; 2]) -> Disc;

    /// Rational plant to which both paths tend towards zero frequency: their quotients tend to one.
    fn slow(&self) -> PlantCoefficients<f64>;

    /// Number b with |P(jv)| <= b (w/v)^3 at every v from w on; `None` if none is known.
    fn roll_off(&self, frequency_rad_per_s: f64) -> Option<f64>;

    /// Number of open-loop poles in the right half plane; `None` if they cannot be counted.
    fn unstable_poles(&self) -> Option<usize>;

    /// Frequency range in rad/s of the features of the response.
    fn range_rad_per_s(&self) -> [f64; 2];

    /// Longest time in s after which a wave returns: the response repeats itself at the inverse of
    /// it.
    fn echo_s(&self) -> f64;
}

/// Plants without polynomials over a box of parameters.
pub trait RespondingPlants: Debug + Send + Sync {
    /// Plant at these parameter values; `None` if no plant exists.
    fn at(&self, values: &[f64]) -> Option<Arc<dyn RespondingPlant>>;
}
