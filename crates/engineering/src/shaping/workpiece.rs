//! Elements in both forms: as in the project file, and as in the loop.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Element, Stage, Timing};
use phea_dynamics::linear::{TimeDomain, TransferFunction};

use super::Shaped;
use crate::project::{self, ElementKind, Project, RationalFunction, Transfer};
use crate::setup::{self, ControlError, LawPlace};

/// Elements of a project, and every element that was ever named, so that each retains the form in
/// which it was written.
pub(super) struct Workpiece<'a> {
    project: &'a Project,
    shaped: Shaped,
    timing: Timing,
    given: Compensator,
    known: Vec<(Element, project::DeclaredElement)>,
}

impl<'a> Workpiece<'a> {
    /// Elements that the project gives; empty if it gives none. `timing` is that of its controller.
    pub(super) fn new(
        project: &'a Project,
        timing: &Timing,
        shaped: Shaped,
    ) -> Result<Workpiece<'a>, ControlError> {
        let timing = match shaped {
            Shaped::Controller => *timing,
            Shaped::Prefilter => timing.of_prefilter(),
        };
        let mut workpiece =
            Workpiece { project, shaped, timing, given: Compensator::default(), known: vec![] };
        let declared = workpiece.transfer().map(Transfer::as_elements).unwrap_or_default();
        for declared in declared {
            let stage = workpiece.know(declared)?;
            workpiece.given.stages.push(stage);
        }
        Ok(workpiece)
    }

    pub(super) fn given(&self) -> &Compensator {
        &self.given
    }

    pub(super) fn shaped(&self) -> Shaped {
        self.shaped
    }

    /// Sample time, s; `None` for a continuous controller.
    pub(super) fn sample_time(&self) -> Option<f64> {
        let own = match self.shaped {
            Shaped::Controller => None,
            Shaped::Prefilter => self.project.prefilter.as_ref().and_then(|prefilter| prefilter.sample_time),
        };
        own.or(self.timing.sample_time_s)
    }

    /// Timing of the shaped object.
    pub(super) fn timing(&self) -> Timing {
        self.timing
    }

    /// Registers a declared element, and returns it in the form of the loop.
    pub(super) fn know(&mut self, declared: project::DeclaredElement) -> Result<Stage, ControlError> {
        let place = match self.shaped {
            Shaped::Controller => LawPlace::Controller,
            Shaped::Prefilter => LawPlace::Prefilter,
        };
        let element = setup::element(place, &declared, self.sample_time())?;
        let enabled = declared.enabled;
        self.known.push((element.clone(), declared));
        Ok(Stage { element, enabled })
    }

    /// Elements as in the project file: each in the form in which it was named, new ones in the
    /// form of their kind.
    pub(super) fn declared(&self, compensator: &Compensator) -> Vec<project::DeclaredElement> {
        let mut free: Vec<&(Element, project::DeclaredElement)> = self.known.iter().collect();
        let declared = |stage: &Stage| {
            let same = |known: &&(Element, project::DeclaredElement)| known.0 == stage.element;
            let found = match free.iter().position(same) {
                Some(index) => Some(free.remove(index)),
                None => self.known.iter().find(same),
            };
            let named = found.map_or_else(|| declared_of(&stage.element), |known| known.1.clone());
            project::DeclaredElement { enabled: stage.enabled, ..named }
        };
        compensator.stages.iter().map(declared).collect()
    }

    /// Response G(jw) or F(jw), sampled if the loop samples.
    pub(super) fn response(
        &self,
        compensator: &Compensator,
        frequency: f64,
    ) -> Result<Complex64, ControlError> {
        let place = LawPlace::Elements;
        let explain = |error| ControlError::Linear { place, error };
        let function: TransferFunction = compensator.transfer_function().map_err(explain)?;
        let function = match (self.sample_time(), function.domain()) {
            (Some(sample_time_s), TimeDomain::Continuous) => {
                function.discretized(sample_time_s, self.timing.discretization).map_err(explain)?
            }
            _ => function,
        };
        Ok(function.at_frequency(frequency))
    }

    fn transfer(&self) -> Option<&'a Transfer> {
        match self.shaped {
            Shaped::Controller => self.project.controller.as_ref().map(|controller| &controller.transfer),
            Shaped::Prefilter => self.project.prefilter.as_ref().map(|prefilter| &prefilter.transfer),
        }
    }
}

/// The project with these elements in place of those that it gives.
pub(super) fn with_elements(
    project: &Project,
    shaped: Shaped,
    elements: &[project::DeclaredElement],
) -> Project {
    let transfer = Transfer { elements: elements.to_vec(), ..Transfer::default() };
    let mut project = project.clone();
    match shaped {
        Shaped::Controller => project.controller.get_or_insert_default().transfer = transfer,
        Shaped::Prefilter => project.prefilter.get_or_insert_default().transfer = transfer,
    }
    project
}

/// Declaration of an element that was never declared: a gain that was scaled, or one that was
/// solved for.
fn declared_of(element: &Element) -> project::DeclaredElement {
    project::DeclaredElement::new(match *element {
        Element::Gain(value) => ElementKind::Gain { value },
        Element::Integrator => ElementKind::Integrator,
        Element::Differentiator => ElementKind::Differentiator,
        Element::RealPole { frequency } => ElementKind::Pole { frequency },
        Element::RealZero { frequency } => ElementKind::Zero { frequency },
        Element::ComplexPoles { natural_frequency: frequency, damping_ratio } => {
            ElementKind::ComplexPoles { frequency, damping_ratio }
        }
        Element::ComplexZeros { natural_frequency: frequency, damping_ratio } => {
            ElementKind::ComplexZeros { frequency, damping_ratio }
        }
        Element::LeadLag { zero_frequency, pole_frequency } if zero_frequency > pole_frequency => {
            ElementKind::Lag { zero_frequency, pole_frequency }
        }
        Element::LeadLag { zero_frequency, pole_frequency } => {
            ElementKind::Lead { zero_frequency, pole_frequency }
        }
        Element::Notch { natural_frequency, zero_damping_ratio, pole_damping_ratio } => ElementKind::Notch {
            frequency: natural_frequency,
            damping_ratio: pole_damping_ratio,
            numerator_damping_ratio: zero_damping_ratio,
        },
        Element::ProportionalIntegral { proportional_gain, integral_gain } => {
            ElementKind::ProportionalIntegral { proportional_gain, integral_gain }
        }
        Element::ProportionalIntegralDerivative {
            proportional_gain,
            integral_gain,
            derivative_gain,
            filter_time,
        } => ElementKind::ProportionalIntegralDerivative {
            proportional_gain,
            integral_gain,
            derivative_gain,
            filter_time,
        },
        Element::General(ref function) => {
            let pairs = |roots: &[Complex64]| roots.iter().map(|root| [root.re, root.im]).collect();
            ElementKind::General(RationalFunction {
                gain: Some(function.gain()),
                zeros: pairs(function.zeros()),
                poles: pairs(function.poles()),
                ..RationalFunction::default()
            })
        }
    })
}
