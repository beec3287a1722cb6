//! Controllers whose coefficients were rounded: what is verified is what is deployed.

use phea_dynamics::controller::{Compensator, Controller, Element, Section};
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::portable;

use super::QuantizationError;

/// How a coefficient is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CoefficientFormat {
    /// IEEE 754 with 53 bits: unchanged.
    #[default]
    Double,
    /// IEEE 754 with 24 bits.
    Single,
    /// A multiple of 2^-fraction_bits, below 2^integer_bits in magnitude.
    Fixed {
        /// Bits before the point, without the sign.
        integer_bits: u8,
        /// Bits behind the point.
        fraction_bits: u8,
    },
}

/// A controller as it is deployed.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedController {
    /// The controller of these sections, to be audited: feedback and prefilter are in z, a
    /// prefilter that acts before the samples as it was.
    pub controller: Controller,
    /// G with the coefficients with which it runs.
    pub feedback: Vec<Section>,
    /// F likewise; empty where it acts before the sampling.
    pub prefilter: Vec<Section>,
}

impl CoefficientFormat {
    /// The nearest number that can be represented; halves are rounded away from zero in fixed
    /// point, and to even in floating point.
    ///
    /// # Errors
    /// [`QuantizationError::TooLarge`].
    ///
    /// # Example
    /// ```
    /// use phea_qft::design::quantization::CoefficientFormat;
    /// let format = CoefficientFormat::Fixed { integer_bits: 1, fraction_bits: 3 };
    /// assert_eq!(format.rounded(-1.3), Ok(-1.25));
    /// assert!(format.rounded(1.95).is_err()); // 2 would be the nearest
    /// ```
    pub fn rounded(self, value: f64) -> Result<f64, QuantizationError> {
        let (kept, largest) = match self {
            CoefficientFormat::Double => (value, f64::MAX),
            CoefficientFormat::Single => (f64::from(value as f32), f64::from(f32::MAX)),
            CoefficientFormat::Fixed { integer_bits, fraction_bits } => {
                let unit = power_of_two(-f64::from(fraction_bits));
                ((value / unit).round() * unit, power_of_two(f64::from(integer_bits)) - unit)
            }
        };
        // also what is not a number
        if kept.abs() <= largest { Ok(kept) } else { Err(QuantizationError::TooLarge { value, largest }) }
    }
}

/// The controller with its coefficients rounded to this format, section by section.
///
/// A continuous compensator is sampled first, by the controller's own timing. A section with a pole
/// at z = 1 keeps it: a_1 + a_2 = -1 holds after rounding, too, since an integrator that leaks, or
/// grows, is another controller.
///
/// # Errors
/// [`QuantizationError::Continuous`] for a controller without sample time,
/// [`QuantizationError::TooLarge`], [`QuantizationError::Vanished`], and those of sampling.
///
/// # Example
/// A lag of 20 rad/s at 1 kHz: its gain at zero frequency is (b_0 + b_1)/(1 - p), where 1 - p =
/// 0.02 has lost two digits.
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Element, Timing};
/// use phea_qft::design::quantization::{CoefficientFormat, rounded};
/// # fn main() -> Result<(), phea_qft::design::quantization::QuantizationError> {
/// let timing = Timing { sample_time_s: Some(1e-3), ..Timing::default() };
/// let prefilter = Compensator::new(vec![Element::RealPole { frequency: 20.0 }]);
/// let controller = Controller { prefilter, timing, ..Controller::default() };
/// let single = rounded(&controller, CoefficientFormat::Single)?;
/// let off = (single.controller.prefilter.transfer_function()?.dc_gain() - 1.0).abs();
/// assert!(off > 1e-8 && off < 6e-6); // at most 2^-25 of p over 1 - p, and as much of the numerator
/// # Ok(())
/// # }
/// ```
pub fn rounded(
    controller: &Controller,
    format: CoefficientFormat,
) -> Result<RoundedController, QuantizationError> {
    let sample_time_s = controller.timing.sample_time_s.ok_or(QuantizationError::Continuous)?;
    let sections = |compensator: &Compensator| {
        let function = compensator.transfer_function()?;
        let sampled = match function.domain() {
            TimeDomain::Continuous => {
                function.discretized(sample_time_s, controller.timing.discretization)?
            }
            TimeDomain::Discrete { .. } => function,
        };
        let exact = Section::in_series(&sampled)?;
        let kept =
            exact.iter().map(|section| rounded_section(section, format)).collect::<Result<Vec<_>, _>>()?;
        let function = Compensator::new(vec![Element::General(in_series(&kept, sample_time_s)?)]);
        Ok::<_, QuantizationError>((function, kept))
    };
    let (feedback_function, feedback) = sections(&controller.feedback)?;
    let (prefilter_function, prefilter) = match controller.timing.continuous_prefilter {
        true => (controller.prefilter.clone(), vec![]),
        false => sections(&controller.prefilter)?,
    };
    let controller =
        Controller { feedback: feedback_function, prefilter: prefilter_function, ..controller.clone() };
    Ok(RoundedController { controller, feedback, prefilter })
}

fn rounded_section(section: &Section, format: CoefficientFormat) -> Result<Section, QuantizationError> {
    let [b0, b1, b2] = section.numerator;
    let numerator = [format.rounded(b0)?, format.rounded(b1)?, format.rounded(b2)?];
    if numerator == [0.0; 3] {
        return Err(QuantizationError::Vanished(section.numerator));
    }
    let [a1, a2] = section.denominator;
    let plain = [format.rounded(a1)?, format.rounded(a2)?];
    let integrates = (1.0 + a1 + a2).abs() <= 2.0 * f64::EPSILON;
    if !integrates || format == CoefficientFormat::Double {
        return Ok(Section { numerator, denominator: plain });
    }
    // one of the two differences is exact in every format that holds both ones
    let [first, second] = plain;
    let kept = [[first, -1.0 - first], [-1.0 - second, second]]
        .into_iter()
        .find(|candidate| candidate.iter().all(|&value| format.rounded(value) == Ok(value)));
    Ok(Section { numerator, denominator: kept.unwrap_or(plain) })
}

fn in_series(sections: &[Section], sample_time_s: f64) -> Result<TransferFunction, QuantizationError> {
    let unity = TransferFunction::gain_only(1.0).in_domain(TimeDomain::Discrete { sample_time_s })?;
    sections
        .iter()
        .try_fold(unity, |product, section| Ok(product.series(&section.transfer_function(sample_time_s)?)?))
}

fn power_of_two(exponent: f64) -> f64 {
    portable::pow(2.0, exponent)
}
