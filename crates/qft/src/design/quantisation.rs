//! What a computer with finite converters and coefficients makes of a sampled loop.
//!
//! ```text
//! y = P (u + e_u) ...          command rounded by the DA converter:       |e_u| <= q_u/2,   to the force by   P/(1+L)
//! u = G (F r - y - e_y)        measurement rounded by the AD converter:   |e_y| <= q_y/2,   to the command by G/(1+L)
//! G, F                         coefficients rounded: another controller, which is audited as it is
//! ```

mod coefficients;
mod rounding_effect;

pub use coefficients::{CoefficientEffect, CoefficientFormat, RoundedController, rounded};
pub use rounding_effect::{LimitCycle, RoundingEffect, RoundingEffects, rounding_effects};

use phea_dynamics::linear::LinearError;

use crate::specification::{Limit, Requirement, Specification};

/// A converter that rounds to the nearest of 2^bits levels over its range.
///
/// ```text
/// q = (maximum - minimum)/2^bits
/// ```
///
/// # Example
/// 12 bits over a valve command of -10 V to 10 V: steps of 4.9 mV.
/// ```
/// use phea_qft::design::quantisation::Converter;
/// let converter = Converter::new(12, [-10.0, 10.0])?;
/// assert_eq!(converter.step(), 0.0048828125);
/// // ORIGIN: analytic, 2/q = 409.6, so that 2 lies between levels 409 and 410
/// assert_eq!(converter.rounded(2.0), 410.0 * converter.step());
/// # Ok::<(), phea_qft::design::quantisation::QuantisationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    step: f64,
    range: [f64; 2],
}

/// The converters and the coefficients of the computer that runs a controller; a converter that is absent does not round.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quantisation {
    /// DA converter of the command, in the command's unit.
    pub command: Option<Converter>,
    /// AD converter of the measured output, in the output's unit.
    pub measurement: Option<Converter>,
    /// How the coefficients of the controller are kept.
    pub coefficients: CoefficientFormat,
}

/// Why the effect of rounding cannot be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QuantisationError {
    /// Between 1 and 32 bits over a range that is finite and increases.
    #[error("{bits} bits from {minimum} to {maximum} are no converter")]
    Converter {
        /// Bits.
        bits: u32,
        /// Lower end.
        minimum: f64,
        /// Upper end.
        maximum: f64,
    },
    /// A continuous controller has no samples to round.
    #[error("rounding needs a sampled loop")]
    Continuous,
    /// A coefficient beyond what its format can hold.
    #[error("the coefficient {value} is beyond the largest of its format, {largest}")]
    TooLarge {
        /// The coefficient.
        value: f64,
        /// The largest that can be held.
        largest: f64,
    },
    /// All coefficients of a numerator are rounded to zero.
    #[error("the numerator {0:?} is rounded to zero")]
    Vanished([f64; 3]),
    /// The effect of one rounding has not died away within so many samples: a loop that is unstable or nearly so.
    #[error("the effect of a rounding on plant {plant} has not died away within {samples} samples")]
    NotSettled {
        /// Index of the plant.
        plant: usize,
        /// Samples.
        samples: usize,
    },
    /// A part is no transfer function that can be run.
    #[error("{0}")]
    Linear(#[from] LinearError),
}

impl Converter {
    /// A converter with so many bits over a range `[minimum, maximum]`.
    ///
    /// # Errors
    /// [`QuantisationError::Converter`].
    pub fn new(bits: u32, range: [f64; 2]) -> Result<Converter, QuantisationError> {
        let [minimum, maximum] = range;
        let levels =
            f64::from(bits.checked_sub(1).map_or(0, |rest| 1_u32.checked_shl(rest).unwrap_or(0))) * 2.0;
        let step = (maximum - minimum) / levels;
        if levels == 0.0 || !(step.is_finite() && step > 0.0) {
            return Err(QuantisationError::Converter { bits, minimum, maximum });
        }
        Ok(Converter { step, range })
    }

    /// q, in the unit of the signal.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The nearest level, the end of the range beyond it.
    pub fn rounded(&self, value: f64) -> f64 {
        let [minimum, maximum] = self.range;
        ((value / self.step).round() * self.step).clamp(minimum, maximum)
    }
}

impl Quantisation {
    /// The specification that keeps the force error of a rounded command below so much, rms: for a design that knows its converter
    /// from the start.
    ///
    /// ```text
    /// rms(y) <= sup |P/(1+L)| q_u/2         |P/(1+L)| <= allowed/(q_u/2)
    /// ```
    ///
    /// Holds whatever the rounding does, limit cycles included. `None` without a DA converter. `frequencies_rad_per_s` are those at which
    /// bounds are drawn; it must hold at every frequency.
    ///
    /// # Example
    /// 5 N allowed for 16 bits over 20 V
    /// ```
    /// use phea_qft::design::quantisation::{Converter, Quantisation};
    /// use phea_qft::specification::{Limit, Requirement};
    /// # fn main() -> Result<(), phea_qft::design::quantisation::QuantisationError> {
    /// let quantisation =
    ///     Quantisation { command: Some(Converter::new(16, [-10.0, 10.0])?), ..Quantisation::default() };
    /// let specification = quantisation.force_specification(5.0, vec![1.0, 10.0]).map(|found| found.requirement);
    /// // ORIGIN: analytic, 5 N over half of 20 V/65536
    /// assert_eq!(specification, Some(Requirement::PlantInputDisturbance(Limit::Constant(32768.0))));
    /// # Ok(())
    /// # }
    /// ```
    pub fn force_specification(
        &self,
        allowed_rms: f64,
        frequencies_rad_per_s: Vec<f64>,
    ) -> Option<Specification> {
        let limit = Limit::Constant(allowed_rms / (0.5 * self.command?.step));
        Some(everywhere(Requirement::PlantInputDisturbance(limit), frequencies_rad_per_s))
    }

    /// The specification that keeps what a rounded measurement makes of the command below so much, rms.
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
        let limit = Limit::Constant(allowed_rms / (0.5 * self.measurement?.step));
        Some(everywhere(Requirement::ControlEffort(limit), frequencies_rad_per_s))
    }
}

fn everywhere(requirement: Requirement, frequencies_rad_per_s: Vec<f64>) -> Specification {
    Specification { requirement, frequencies_rad_per_s, band_rad_per_s: [0.0, f64::INFINITY] }
}
