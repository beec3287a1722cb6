//! Controllers with rounded coefficients: the deployed controller is the one that is verified.

use phea_dynamics::controller::{CoefficientFormat, Compensator, Controller, Element, Section};
use phea_dynamics::linear::{TimeDomain, TransferFunction};

use super::QuantizationError;

/// A deployed controller.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedController {
    /// The controller of these sections, to be audited: feedback and prefilter are in z, a
    /// prefilter that acts before the sampling is unchanged.
    pub controller: Controller,
    /// Sections of G with the deployed coefficients.
    pub feedback: Vec<Section>,
    /// Sections of F likewise; empty if it acts before the sampling.
    pub prefilter: Vec<Section>,
}

/// The controller with its coefficients rounded to this format, section by section.
///
/// A continuous compensator is first sampled with the controller's timing. A section with a pole at
/// z = 1 retains it: a_1 + a_2 = -1 also holds after rounding, since a leaking or growing
/// integrator would be another controller.
///
/// # Errors
/// [`QuantizationError::Continuous`] for a controller without sample time,
/// [`QuantizationError::TooLarge`], [`QuantizationError::Vanished`], and errors of sampling.
///
/// # Example
/// Lag of 20 rad/s at 1 kHz, whose static gain is (b_0 + b_1)/(1 - p), where 1 - p = 0.02 has lost
/// two digits.
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
        let cache =
            exact.iter().map(|section| rounded_section(section, format)).collect::<Result<Vec<_>, _>>()?;
        let function = Compensator::new(vec![Element::General(in_series(&cache, sample_time_s)?)]);
        Ok::<_, QuantizationError>((function, cache))
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
    // one of the two differences is exact in every format that represents both ones
    let [first, second] = plain;
    let cache = [[first, -1.0 - first], [-1.0 - second, second]]
        .into_iter()
        .find(|candidate| candidate.iter().all(|&value| format.rounded(value) == Ok(value)));
    Ok(Section { numerator, denominator: cache.unwrap_or(plain) })
}

fn in_series(sections: &[Section], sample_time_s: f64) -> Result<TransferFunction, QuantizationError> {
    let unity = TransferFunction::gain_only(1.0).in_domain(TimeDomain::Discrete { sample_time_s })?;
    sections
        .iter()
        .try_fold(unity, |product, section| Ok(product.series(&section.transfer_function(sample_time_s)?)?))
}
