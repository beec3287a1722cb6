//! Input of a design.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::pieces::Workers;

use super::quantization::CoefficientFormat;
use super::{NamedStructure, Objective};
use crate::loop_shaping::Structure;

/// Selection of controllers.
#[derive(Clone, Debug, PartialEq)]
pub enum ControllerChoice {
    /// One given structure.
    Given(Structure),
    /// One named structure.
    Named {
        /// The name.
        name: NamedStructure,
        /// Gain for the poles of a prefilter beyond the first, as for [`ControllerChoice::Any`],
        /// dB.
        earned_per_pole_db: f64,
    },
    /// Every suitable named structure, the shortest first; if none meets every specification,
    /// structures of growing order.
    Any {
        /// Largest number of poles.
        maximum_order: usize,
        /// The first name to be searched, if shorter ones are known to fail.
        from: Option<NamedStructure>,
        /// True if a pure gain is searched although the specifications require an integrator: they
        /// lead to a step within a band, which a pure gain may reach.
        with_pure_gain: bool,
        /// Gain that each further pole of a longer structure must bring to replace a shorter one
        /// that meets the limits, dB, likewise for prefilters with more than one pole; infinite:
        /// the shortest is taken.
        earned_per_pole_db: f64,
    },
    /// Structures of growing order, up to this one, until one meets every specification.
    Grow {
        /// Largest number of poles.
        maximum_order: usize,
    },
}

impl ControllerChoice {
    /// Gain that a further pole must bring, dB; `None` if only the objective decides.
    pub fn earned_per_pole_db(&self) -> Option<f64> {
        match *self {
            ControllerChoice::Named { earned_per_pole_db, .. }
            | ControllerChoice::Any { earned_per_pole_db, .. } => Some(earned_per_pole_db),
            ControllerChoice::Given(_) | ControllerChoice::Grow { .. } => None,
        }
    }
}

/// Selection of prefilters.
#[derive(Clone, Debug, PartialEq)]
pub enum PrefilterChoice {
    /// Tracking without a prefilter, assessed by its spread.
    None,
    /// A given prefilter.
    Given(TransferFunction),
    /// Prefilters of growing order, up to this one.
    Grow {
        /// Largest number of poles.
        maximum_order: usize,
    },
}

/// Range of the poles of a designed controller; integrators are exempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoleRange {
    /// Least damping ratio of a pair that is not the notch of a pair of zeros.
    pub least_damping_ratio: f64,
    /// Greatest natural frequency, rad/s.
    pub fastest_rad_per_s: f64,
}

impl Default for PoleRange {
    /// Any poles but lightly damped ones.
    fn default() -> Self {
        PoleRange { least_damping_ratio: 0.1, fastest_rad_per_s: f64::INFINITY }
    }
}

/// Options of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignOptions {
    /// The objective.
    pub objective: Objective,
    /// Selection of controllers.
    pub controller: ControllerChoice,
    /// Selection of prefilters.
    pub prefilter: PrefilterChoice,
    /// Seed of the random starting points: equal seeds give equal designs.
    pub seed: u64,
    /// Violation up to which a margin counts as met, dB.
    pub tolerance_db: f64,
    /// Margin of the design to every limit, also between its samples, dB; for two limits close
    /// together, [`Requirement::reserve_at_db`](crate::specification::Requirement::reserve_at_db).
    pub reserve_db: f64,
    /// Range of the poles of a controller of growing order.
    pub poles: PoleRange,
    /// The number format of the coefficients of a sampled controller, which is evaluated with
    /// rounded coefficients. A continuous controller is not rounded.
    pub coefficients: CoefficientFormat,
    /// The worker threads; the design does not depend on them.
    pub workers: Workers,
}
