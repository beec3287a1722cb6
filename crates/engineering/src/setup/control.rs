//! The controller and prefilter of a project as values of `phea_dynamics`.

use std::fmt;

use num_complex::Complex64;
use phea_dynamics::controller::{
    Compensator, Controller, Element, RateFilter, RateSensor, Stage, Timing, VirtualImpedance,
};
use phea_dynamics::linear::{LinearError, Polynomial, TimeDomain, TransferFunction};
use phea_qft::design::quantization::{Converter, Quantization, QuantizationError};

use crate::project::{
    self, ElementKind, Formula, FormulaError, ImpedanceForm, Project, Rational, RationalFunction, Transfer,
};
use crate::rig::inner_feedback;

/// The place of a transfer function in a project.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawPlace {
    /// The controller.
    Controller,
    /// The virtual impedance of the controller.
    VirtualImpedance,
    /// The prefilter.
    Prefilter,
    /// The force sensor.
    Sensor,
    /// A fixed element of the structures of a design.
    Design,
    /// The elements of a controller or a prefilter that are not in the project yet.
    Elements,
}

impl LawPlace {
    /// The table of the project; `None` for elements that are not in it.
    pub fn table(self) -> Option<&'static str> {
        match self {
            LawPlace::Controller => Some("controller"),
            LawPlace::VirtualImpedance => Some("controller.impedance"),
            LawPlace::Prefilter => Some("prefilter"),
            LawPlace::Sensor => Some("sensor"),
            LawPlace::Design => Some("design"),
            LawPlace::Elements => None,
        }
    }
}

impl fmt::Display for LawPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.table() {
            Some(table) => write!(f, "[{table}]"),
            None => f.write_str("the elements"),
        }
    }
}

/// Reason why a declared controller or prefilter is not a transfer function.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ControlError {
    /// The text is not a ratio of polynomials.
    #[error("{place}: {error}", error = error.message)]
    Formula {
        /// The place of the transfer function.
        place: LawPlace,
        /// What is wrong with it.
        error: FormulaError,
    },
    /// The factors or polynomials do not form a transfer function.
    #[error("{place}: {error}")]
    Linear {
        /// The place of the transfer function.
        place: LawPlace,
        /// What is wrong with it.
        error: LinearError,
    },
    /// What is rounded cannot be.
    #[error("[controller.quantization]: {0}")]
    Quantization(#[from] QuantizationError),
    /// Zeros and poles without the factor before them.
    #[error("{place}: `zeros` and `poles` need `gain`, the leading coefficient")]
    Gain {
        /// The place of the transfer function.
        place: LawPlace,
    },
    /// A text in z without a sample time.
    #[error("{place}: a transfer function in z needs `sample_time`")]
    SampleTime {
        /// The place of the transfer function.
        place: LawPlace,
    },
}

/// The given controller, with this timing and without its prefilter; `None` where the project gives
/// no transfer function for one.
///
/// # Errors
/// [`ControlError`] if it is not a transfer function.
pub(super) fn controller(project: &Project, timing: Timing) -> Result<Option<Controller>, ControlError> {
    let Some(declared) = project.controller.as_ref().filter(|controller| controller.has_law()) else {
        return Ok(None);
    };
    let mut feedback = compensator(LawPlace::Controller, &declared.transfer, declared.sample_time)?;
    feedback.stages.extend(admittance(declared)?);
    Ok(Some(Controller {
        feedback,
        prefilter: Compensator::default(),
        timing,
        command_limit: declared.saturation,
        anti_windup: declared.anti_windup,
    }))
}

/// The given prefilter; `None` where the project gives none.
///
/// # Errors
/// [`ControlError`] if it is not a transfer function.
pub(super) fn prefilter(project: &Project, timing: &Timing) -> Result<Option<Compensator>, ControlError> {
    let Some(declared) = &project.prefilter else { return Ok(None) };
    let sample_time = declared.sample_time.or(timing.sample_time_s);
    compensator(LawPlace::Prefilter, &declared.transfer, sample_time).map(Some)
}

/// When the controller acts, whether it is given or to be designed; continuous and without delay
/// where the project does not say.
pub(super) fn timing(project: &Project) -> Timing {
    let Some(declared) = &project.controller else { return Timing::default() };
    Timing {
        sample_time_s: declared.sample_time,
        delay_s: declared.delay,
        discretization: declared.sampling_rule(),
        continuous_prefilter: project.prefilter.as_ref().is_some_and(|prefilter| prefilter.continuous),
        rate_feed_forward: 0.0,
        rate_sensor: RateSensor::default(),
        inner_feedback: declared.pressure_feedback.as_ref().map(inner_feedback).unwrap_or_default(),
    }
}

/// The project with this pressure feedback in place of its own.
pub(crate) fn with_pressure_feedback(
    project: &Project,
    pressure_feedback: Option<project::DeclaredPressureFeedback>,
) -> Project {
    let controller = project.controller.clone().unwrap_or_default();
    Project {
        controller: Some(project::DeclaredController { pressure_feedback, ..controller }),
        ..project.clone()
    }
}

/// What makes the controller of a position one of the force: 1/(M_v s^2 + B_v s + K_v); none where
/// the declared controller is that of the force.
fn admittance(declared: &project::DeclaredController) -> Result<Option<Stage>, ControlError> {
    let place = LawPlace::VirtualImpedance;
    let inner = declared.impedance.filter(|impedance| impedance.form == ImpedanceForm::Admittance);
    let Some(impedance) = inner else { return Ok(None) };
    let function = lowered(&impedance).admittance();
    let function = function.map_err(|error| ControlError::Linear { place, error })?;
    Ok(Some(Stage { element: Element::General(function), enabled: true }))
}

/// Whether the declared controller is that of the position in an inner loop.
pub(crate) fn is_of_position(project: &Project) -> bool {
    let impedance = project.controller.as_ref().and_then(|controller| controller.impedance);
    impedance.is_some_and(|impedance| impedance.form == ImpedanceForm::Admittance)
}

/// The virtual impedance of the loop; `None` where there is none, or one of zero.
pub(super) fn virtual_impedance(project: &Project) -> Option<VirtualImpedance> {
    let declared = project.controller.as_ref()?.impedance?;
    Some(lowered(&declared)).filter(|impedance| !impedance.is_zero())
}

fn lowered(declared: &project::DeclaredImpedance) -> VirtualImpedance {
    VirtualImpedance {
        mass: declared.mass,
        damping: declared.damping,
        stiffness: declared.stiffness,
        filter_time_s: declared.filter_time.unwrap_or(0.0),
    }
}

/// Filter and dead time of the sensor of the load's velocity; none where the project declares no
/// sensor.
pub(super) fn velocity_sensor(project: &Project) -> RateSensor {
    let declared = project.actuator.as_ref().and_then(|actuator| actuator.velocity_sensor.as_ref());
    let Some(declared) = declared else { return RateSensor::default() };
    let filter = match (declared.filter_frequency, declared.filter_damping_ratio) {
        (None, _) => RateFilter::None,
        (Some(frequency_rad_per_s), None) => RateFilter::FirstOrder { frequency_rad_per_s },
        (Some(frequency_rad_per_s), Some(damping_ratio)) => {
            RateFilter::SecondOrder { frequency_rad_per_s, damping_ratio }
        }
    };
    RateSensor { filter, delay_s: declared.delay }
}

/// The rounding in the controller's computer: none where the project does not say.
///
/// # Errors
/// [`ControlError::Quantization`] for an invalid converter.
pub(super) fn quantization(project: &Project) -> Result<Quantization, ControlError> {
    let declared = project.controller.as_ref().and_then(|controller| controller.quantization.clone());
    let Some(declared) = declared else { return Ok(Quantization::default()) };
    let converter = |bits: u32, range: Option<[f64; 2]>| -> Result<_, QuantizationError> {
        Ok(range.filter(|_| bits > 0).map(|range| Converter::new(bits, range)).transpose()?)
    };
    Ok(Quantization {
        command: converter(declared.command_bits, declared.command_range)?,
        measurement: converter(declared.measurement_bits, declared.measurement_range)?,
        coefficients: declared.coefficients,
    })
}

/// H; 1 where the project declares no sensor.
///
/// # Errors
/// [`ControlError`] if it is not a transfer function.
pub(super) fn sensor(project: &Project) -> Result<TransferFunction, ControlError> {
    let Some(declared) = &project.sensor else { return Ok(TransferFunction::gain_only(1.0)) };
    let place = LawPlace::Sensor;
    let Rational { numerator, denominator, .. } = &declared.transfer;
    let function =
        from_formulas(numerator, denominator).map_err(|error| ControlError::Formula { place, error })?;
    let delayed = function.and_then(|function| function.with_dead_time(declared.delay));
    delayed.map_err(|error| ControlError::Linear { place, error })
}

/// The elements in series, including disabled ones.
fn compensator(
    place: LawPlace,
    transfer: &Transfer,
    sample_time: Option<f64>,
) -> Result<Compensator, ControlError> {
    let stage = |declared: &project::DeclaredElement| {
        Ok(Stage { element: element(place, declared, sample_time)?, enabled: declared.enabled })
    };
    Ok(Compensator { stages: transfer.as_elements().iter().map(stage).collect::<Result<_, ControlError>>()? })
}

/// A ratio of two formulas without parameters.
pub(crate) fn from_formulas(
    numerator: &Formula,
    denominator: &Formula,
) -> Result<Result<TransferFunction, LinearError>, FormulaError> {
    let (upper, lower) = (numerator.numbers()?, denominator.numbers()?);
    let polynomial = |one: Vec<f64>, other: Vec<f64>| Polynomial::new(one).product(&Polynomial::new(other));
    let top = polynomial(upper.numerator, lower.denominator);
    let bottom = polynomial(lower.numerator, upper.denominator);
    Ok(TransferFunction::from_polynomials(&top, &bottom))
}

/// An element as it acts in the loop.
pub(crate) fn element(
    place: LawPlace,
    declared: &project::DeclaredElement,
    sample_time: Option<f64>,
) -> Result<Element, ControlError> {
    Ok(match declared.kind {
        ElementKind::Gain { value } => Element::Gain(value),
        ElementKind::Integrator => Element::Integrator,
        ElementKind::Differentiator => Element::Differentiator,
        ElementKind::Zero { frequency } => Element::RealZero { frequency },
        ElementKind::Pole { frequency } => Element::RealPole { frequency },
        ElementKind::ComplexZeros { frequency, damping_ratio } => {
            Element::ComplexZeros { natural_frequency: frequency, damping_ratio }
        }
        ElementKind::ComplexPoles { frequency, damping_ratio } => {
            Element::ComplexPoles { natural_frequency: frequency, damping_ratio }
        }
        ElementKind::Lead { zero_frequency, pole_frequency }
        | ElementKind::Lag { zero_frequency, pole_frequency } => {
            Element::LeadLag { zero_frequency, pole_frequency }
        }
        ElementKind::Notch { frequency, damping_ratio, numerator_damping_ratio } => Element::Notch {
            natural_frequency: frequency,
            zero_damping_ratio: numerator_damping_ratio,
            pole_damping_ratio: damping_ratio,
        },
        ElementKind::RollOff { frequency, damping_ratio } => Element::ComplexPoles {
            natural_frequency: frequency,
            damping_ratio: damping_ratio.unwrap_or(std::f64::consts::FRAC_1_SQRT_2),
        },
        ElementKind::ProportionalIntegral { proportional_gain, integral_gain } => {
            Element::ProportionalIntegral { proportional_gain, integral_gain }
        }
        ElementKind::ProportionalIntegralDerivative {
            proportional_gain,
            integral_gain,
            derivative_gain,
            filter_time,
        } => Element::ProportionalIntegralDerivative {
            proportional_gain,
            integral_gain,
            derivative_gain,
            filter_time,
        },
        ElementKind::General(ref ratio) => Element::General(general(place, ratio, sample_time)?),
    })
}

/// A ratio of polynomials, or factors.
fn general(
    place: LawPlace,
    declared: &RationalFunction,
    sample_time: Option<f64>,
) -> Result<TransferFunction, ControlError> {
    let linear = |error| ControlError::Linear { place, error };
    let function = match (&declared.numerator, &declared.denominator) {
        (Some(numerator), Some(denominator)) => from_formulas(numerator, denominator)
            .map_err(|error| ControlError::Formula { place, error })?
            .map_err(linear)?,
        _ => {
            let roots = |pairs: &[[f64; 2]]| pairs.iter().map(|[re, im]| Complex64::new(*re, *im)).collect();
            let gain = declared.gain.ok_or(ControlError::Gain { place })?;
            TransferFunction::from_factors(gain, roots(&declared.zeros), roots(&declared.poles))
                .map_err(linear)?
        }
    };
    match (declared.is_sampled(), sample_time) {
        (false, _) => Ok(function),
        (true, None) => Err(ControlError::SampleTime { place }),
        (true, Some(sample_time_s)) => {
            function.in_domain(TimeDomain::Discrete { sample_time_s }).map_err(linear)
        }
    }
}

/// Noise of the velocity sensor at the samples in m/s rms, where it is fed forward; zero without.
///
/// ```text
/// rms^2 = noise^2 + resolution^2/12            the rounding as noise that is independent from sample to sample
/// ```
pub(crate) fn velocity_noise(project: &Project) -> f64 {
    let sensor = project.actuator.as_ref().and_then(|actuator| actuator.velocity_sensor.as_ref());
    let controller = project.controller.as_ref();
    let samples = controller.is_some_and(|controller| {
        controller.sample_time.is_some() && controller.load_velocity_feed_forward.is_some()
    });
    let rms = |noise: f64, resolution: f64| (noise * noise + resolution * resolution / 12.0).sqrt();
    sensor.filter(|_| samples).map_or(0.0, |sensor| rms(sensor.noise, sensor.resolution))
}

/// Noise of the pressure signal at the samples in Pa rms, where it is fed back; zero without.
pub(crate) fn pressure_noise(project: &Project) -> f64 {
    let controller = project.controller.as_ref().filter(|controller| controller.sample_time.is_some());
    let declared = controller.and_then(|controller| controller.pressure_feedback);
    declared.map_or(0.0, |declared| declared.noise)
}
