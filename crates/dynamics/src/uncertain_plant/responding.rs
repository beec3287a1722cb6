//! Plants without polynomials: known by their response at every frequency, and by what bounds it
//! between two.

use std::fmt::Debug;
use std::sync::Arc;

use num_complex::Complex64;

use crate::analytic::Disc;
use crate::uncertain_plant::PlantCoefficients;

/// A plant that is not a quotient of polynomials, for example one with wave propagation in its
/// lines. Its only pole on the imaginary axis, if any, is at zero.
pub trait RespondingPlant: Debug + Send + Sync {
    /// P(jw), and Pd(jw) from the disturbance, at a positive frequency in rad/s.
    fn response(&self, frequency_rad_per_s: f64) -> [Complex64; 2];

    /// The rate that a controller may feed forward, at a positive frequency in rad/s: from the
    /// command, and from the disturbance, whose own rate s it is where the command does not move
    /// it.
    fn rate(&self, frequency_rad_per_s: f64) -> [Complex64; 2] {
        [Complex64::new(0.0, 0.0), Complex64::new(0.0, frequency_rad_per_s)]
    }

    /// The inner signal that a sampled controller may feed back, at a positive frequency in rad/s:
    /// from the command, and from the disturbance.
    fn inner(&self, _frequency_rad_per_s: f64) -> [Complex64; 2] {
        [Complex64::new(0.0, 0.0); 2]
    }

    /// A disc that holds P(jw) at every frequency between two in rad/s, the first of which may be
    /// zero; the whole plane where nothing is known. It shrinks to the response as the two come
    /// together.
    fn enclosure(&self, frequencies_rad_per_s: [f64; 2]) -> Disc;

    /// A rational plant to which both paths tend towards zero frequency: their quotients tend to
    /// one.
    fn slow(&self) -> PlantCoefficients<f64>;

    /// A number b with |P(jv)| <= b (w/v)^3 at every v from w on; `None` where none is known.
    fn roll_off(&self, frequency_rad_per_s: f64) -> Option<f64>;

    /// Its own poles in the right half plane; `None` where they cannot be counted.
    fn unstable_poles(&self) -> Option<usize>;

    /// Between which frequencies in rad/s the response does something of its own.
    fn range_rad_per_s(&self) -> [f64; 2];

    /// The longest time in s after which a wave returns: the response repeats itself at the inverse
    /// of it.
    fn echo_s(&self) -> f64;
}

/// Plants without polynomials over a box of parameters.
pub trait RespondingPlants: Debug + Send + Sync {
    /// The plant at these parameter values; `None` where no plant exists.
    fn at(&self, values: &[f64]) -> Option<Arc<dyn RespondingPlant>>;
}
