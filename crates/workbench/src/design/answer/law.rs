//! Transfer functions and structures of controllers in JSON.

use num_complex::Complex64;
use phea_dynamics::controller::{Controller, Element, NamedStructure};
use phea_dynamics::linear::{LinearError, TimeDomain, TransferFunction};
use phea_engineering::design::{AuditedController, structure_key};
use phea_qft::loop_shaping::{Structure, StructureFactor};

use crate::answer::{Answer, OrReason, words};

/// Transfer function k Π(s - z)/Π(s - p), or the same in z.
#[derive(Answer)]
pub(crate) struct FactoredLawAnswer {
    /// Leading coefficient k.
    gain: f64,
    /// Zeros, each by its real and imaginary part.
    zeros: Vec<Complex64>,
    /// Poles, each by its real and imaginary part.
    poles: Vec<Complex64>,
    /// Variable of the transfer function.
    domain: TimeDomain,
    /// Sample time of a transfer function in z.
    sample_time_s: OrReason<f64>,
}

words! {
    /// Variable of a transfer function: `s` of a continuous one, `z` of a sampled one.
    TimeDomain { Continuous => "s", Discrete { .. } => "z" }
}

/// Continuous laws that are sampled for the loop.
#[derive(Answer)]
pub(super) struct ContinuousLawAnswer {
    /// Controller G(s) before it is sampled.
    controller: FactoredLawAnswer,
    /// Prefilter F(s) before it is sampled.
    prefilter: FactoredLawAnswer,
}

/// Structure of a controller, whose numbers a search chooses from their ranges.
#[derive(Answer)]
pub(super) struct StructureAnswer {
    /// Sign of the gain, 1 or -1.
    sign: f64,
    /// Least and greatest magnitude of the gain.
    #[answer(interval)]
    gain: [f64; 2],
    /// Factors in series.
    parts: Vec<StructurePartAnswer>,
    /// Name of the structure of the designed controller, only if it has one.
    #[answer(optional)]
    name: Option<NamedStructure>,
}

words! {
    /// Structure of a controller, as `design.structure` names it.
    NamedStructure by named_key [
        Proportional, Integral, ProportionalIntegral, PiLowPass, Pid, PiNotch, PiNotchLowPass,
        PiNotchLead, PiTwoNotches,
    ]
}

/// Factor of a structure, each number by its least and greatest value.
#[derive(Answer)]
struct StructurePartAnswer {
    /// Kind of the factor.
    kind: StructureFactor,
    /// Corner frequency, of a pair or notch the natural one; left out if the factor has none.
    #[answer(optional, interval)]
    frequency_rad_per_s: Option<[f64; 2]>,
    /// Damping ratio of a pair, or of the poles of a notch.
    #[answer(optional, interval)]
    damping_ratio: Option<[f64; 2]>,
    /// Magnitude of a notch at its frequency.
    #[answer(optional, interval)]
    depth: Option<[f64; 2]>,
}

words! {
    /// Factor of a structure.
    StructureFactor {
        Fixed(Element::Integrator) => "integrator",
        Fixed(_) => "fixed",
        RealZero { .. } => "zero",
        RealPole { .. } => "pole",
        ZeroPair { .. } => "zero_pair",
        PolePair { .. } => "pole_pair",
        Notch { .. } => "notch",
    }
}

fn named_key(name: NamedStructure) -> &'static str {
    structure_key(Some(name))
}

/// Gain, zeros and poles.
pub(crate) fn factors(function: &TransferFunction) -> FactoredLawAnswer {
    let domain = function.domain();
    let sample_time_s = match domain {
        TimeDomain::Continuous => None,
        TimeDomain::Discrete { sample_time_s } => Some(sample_time_s),
    };
    // a negative zero is one that nobody wrote
    let positive_zeros = |root: &Complex64| Complex64::new(root.re + 0.0, root.im + 0.0);
    FactoredLawAnswer {
        gain: function.gain(),
        zeros: function.zeros().iter().map(positive_zeros).collect(),
        poles: function.poles().iter().map(positive_zeros).collect(),
        domain,
        sample_time_s: OrReason::new(sample_time_s, "it is continuous"),
    }
}

/// The continuous-time form of the controller of a sampled loop, if it was given in this form.
pub(super) fn continuous_law(side: &AuditedController) -> Result<Option<ContinuousLawAnswer>, LinearError> {
    let Controller { feedback, prefilter, .. } = &side.controller;
    let law = feedback.transfer_function()?;
    let is_sampled = side.problem.compensation.sample_time_s().is_some();
    if !is_sampled || law.domain() != TimeDomain::Continuous {
        return Ok(None);
    }
    let prefilter = factors(&prefilter.transfer_function()?);
    Ok(Some(ContinuousLawAnswer { controller: factors(&law), prefilter }))
}

/// A structure, with its name where it is that of the designed controller.
pub(super) fn structure(structure: &Structure, name: Option<NamedStructure>) -> StructureAnswer {
    StructureAnswer {
        sign: structure.sign,
        gain: structure.gain,
        parts: structure.parts.iter().map(part).collect(),
        name,
    }
}

fn part(part: &StructureFactor) -> StructurePartAnswer {
    let (frequency, damping_ratio, depth) = match *part {
        StructureFactor::Fixed(_) => (None, None, None),
        StructureFactor::RealZero { frequency } | StructureFactor::RealPole { frequency } => {
            (Some(frequency), None, None)
        }
        StructureFactor::ZeroPair { natural_frequency, damping_ratio }
        | StructureFactor::PolePair { natural_frequency, damping_ratio } => {
            (Some(natural_frequency), Some(damping_ratio), None)
        }
        StructureFactor::Notch { natural_frequency, damping_ratio, depth } => {
            (Some(natural_frequency), Some(damping_ratio), Some(depth))
        }
    };
    StructurePartAnswer { kind: part.clone(), frequency_rad_per_s: frequency, damping_ratio, depth }
}
