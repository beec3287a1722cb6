//! The effect of finite converters and coefficients on a sampled loop.
//!
//! ```text
//! y = P (u + e_u) ...          command rounded by the DA converter:       |e_u| <= q_u/2,   to the force by   P/(1+L)
//! u = G (F r - y - e_y)        measurement rounded by the AD converter:   |e_y| <= q_y/2,   to the command by G/(1+L)
//! G, F                         coefficients rounded: another controller, which is itself audited
//! ```

mod coefficients;
mod rate_noise;
mod rounding_effect;

pub use coefficients::{RoundedController, rounded};
pub use rate_noise::{RateNoise, inner_noise, rate_noise};
pub use rounding_effect::{LimitCycle, RoundingEffect, RoundingEffects, rounding_effects};

pub use phea_dynamics::controller::{CoefficientFormat, CoefficientTooLarge, Converter, ConverterError};
use phea_dynamics::linear::LinearError;

use crate::specification::{ClosedLoop, Limit, Requirement, Specification};

/// The converters and the coefficients of the computer that runs a controller; an absent converter
/// does not round.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantization {
    /// DA converter of the command, in the command's unit.
    pub command: Option<Converter>,
    /// AD converter of the measured output, in the output's unit.
    pub measurement: Option<Converter>,
    /// The number format of the coefficients of the controller.
    pub coefficients: CoefficientFormat,
}

/// Reason why the effect of rounding cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuantizationError {
    /// An invalid converter.
    #[error(transparent)]
    Converter(#[from] ConverterError),
    /// A continuous controller has no samples to round, and travelling waves in lines have no
    /// recursion.
    #[error("the effect of rounding is computed for sampled loops whose lines are lumped")]
    Continuous,
    /// A coefficient beyond the range of its format.
    #[error(transparent)]
    TooLarge(#[from] CoefficientTooLarge),
    /// All coefficients of a numerator are rounded to zero.
    #[error("the numerator {0:?} is rounded to zero")]
    Vanished([f64; 3]),
    /// The effect of one rounding has not decayed within this number of samples: a loop that is
    /// unstable or nearly so.
    #[error("the effect of a rounding on plant {plant} has not died away within {samples} samples")]
    NotSettled {
        /// Index of the plant.
        plant: usize,
        /// Samples.
        samples: usize,
    },
    /// A part is not a transfer function that can be run.
    #[error("{0}")]
    Linear(#[from] LinearError),
}

impl Quantization {
    /// The specification that limits the rms force error due to a rounded command, for a design
    /// that takes its converter into account from the start.
    ///
    /// ```text
    /// rms(y) <= sup |P/(1+L)| q_u/2         |P/(1+L)| <= allowed/(q_u/2)
    /// ```
    ///
    /// Valid for any rounding behaviour, including limit cycles. `None` without a DA converter.
    /// `frequencies_rad_per_s` are those at which bounds are drawn; the limit must hold at every
    /// frequency.
    ///
    /// # Example
    /// Example of 5 N allowed for 16 bits over 20 V
    /// ```
    /// use phea_qft::design::quantization::{Converter, Quantization};
    /// use phea_qft::specification::{ClosedLoop, Limit, Requirement};
    /// # fn main() -> Result<(), phea_qft::design::quantization::QuantizationError> {
    /// let quantization =
    ///     Quantization { command: Some(Converter::new(16, [-10.0, 10.0])?), ..Quantization::default() };
    /// let specification = quantization.force_specification(5.0, vec![1.0, 10.0]).map(|found| found.requirement);
    /// // ORIGIN: analytic, 5 N over half of 20 V/65536
    /// assert_eq!(specification, Some(Requirement::at_most(ClosedLoop::PlantInputDisturbance, Limit::Constant(32768.0))));
    /// # Ok(())
    /// # }
    /// ```
    pub fn force_specification(
        &self,
        allowed_rms: f64,
        frequencies_rad_per_s: Vec<f64>,
    ) -> Option<Specification> {
        let limit = Limit::Constant(allowed_rms / (0.5 * self.command?.step()));
        Some(everywhere(
            Requirement::at_most(ClosedLoop::PlantInputDisturbance, limit),
            frequencies_rad_per_s,
        ))
    }

    /// The specification that limits the rms effect of a rounded measurement on the command.
    ///
    /// ```text
    /// rms(u) <= sup |G/(1+L)| q_y/2         |G/(1+L)| <= allowed/(q_y/2)
    /// ```
    ///
    /// `None` without an AD converter.
    pub fn command_specification(
        &self,
        allowed_rms: f64,
        frequencies_rad_per_s: Vec<f64>,
    ) -> Option<Specification> {
        let limit = Limit::Constant(allowed_rms / (0.5 * self.measurement?.step()));
        Some(everywhere(Requirement::at_most(ClosedLoop::ControlEffort, limit), frequencies_rad_per_s))
    }
}

fn everywhere(requirement: Requirement, frequencies_rad_per_s: Vec<f64>) -> Specification {
    Specification { requirement, frequencies_rad_per_s, band_rad_per_s: [0.0, f64::INFINITY] }
}
