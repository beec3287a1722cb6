//! Frequency responses and their characteristics: unwrapped phase, margins, passivity.
//!
//! # Example
//! A loop that becomes unstable at twice its gain:
//! ```
//! use phea_dynamics::frequency::margins;
//! use phea_dynamics::linear::{Polynomial, TransferFunction};
//! # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
//! let open = TransferFunction::from_polynomials(
//!     &Polynomial::new(vec![4.0]),
//!     &Polynomial::new(vec![1.0, 3.0, 3.0, 1.0]), // (s + 1)^3
//! )?;
//! let critical = margins(&open).gain_increase_factor();
//! assert!((critical - 2.0).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

mod crossings;
mod grid;
mod margins;
mod passivity;
mod phase;

use num_complex::Complex64;

pub use grid::logarithmic_grid;
pub use margins::{GainMargin, Margins, ModulusMargin, PhaseMargin, margins};
pub use passivity::{Band, ImaginaryPole, PassivityReport, passivity};

use crate::linear::TransferFunction;
use crate::portable::log10;

/// Values of a system along the imaginary axis (or the unit circle), with their phase unwrapped.
///
/// # Example
/// ```
/// use phea_dynamics::frequency::FrequencyResponse;
/// use phea_dynamics::linear::{Polynomial, TransferFunction};
/// # fn main() -> Result<(), phea_dynamics::linear::LinearError> {
/// let triple = TransferFunction::from_polynomials(
///     &Polynomial::new(vec![1.0]),
///     &Polynomial::new(vec![1.0, 0.0, 0.0, 0.0]), // s^3
/// )?;
/// let response = FrequencyResponse::of(&triple, &[1.0, 10.0]);
/// assert_eq!(response.phases_deg(), [-270.0, -270.0]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyResponse {
    frequencies_rad_per_s: Vec<f64>,
    values: Vec<Complex64>,
    phases_deg: Vec<f64>,
}

impl FrequencyResponse {
    /// Response of a transfer function. Its phase is the sum of the phases of its factors, so it is
    /// continuous at any spacing of the frequencies ([`TransferFunction::phase_rad`]).
    pub fn of(system: &TransferFunction, frequencies_rad_per_s: &[f64]) -> Self {
        FrequencyResponse {
            frequencies_rad_per_s: frequencies_rad_per_s.to_vec(),
            values: frequencies_rad_per_s.iter().map(|&w| system.at_frequency(w)).collect(),
            phases_deg: frequencies_rad_per_s.iter().map(|&w| system.phase_rad(w).to_degrees()).collect(),
        }
    }

    /// Frequencies in rad/s.
    pub fn frequencies_rad_per_s(&self) -> &[f64] {
        &self.frequencies_rad_per_s
    }

    /// Complex values.
    pub fn values(&self) -> &[Complex64] {
        &self.values
    }

    /// Unwrapped phases in degrees.
    pub fn phases_deg(&self) -> &[f64] {
        &self.phases_deg
    }
}

/// 20 log10 of a magnitude.
///
/// # Example
/// ```
/// assert_eq!(phea_dynamics::frequency::decibels(100.0), 40.0);
/// ```
pub fn decibels(magnitude: f64) -> f64 {
    20.0 * log10(magnitude)
}
