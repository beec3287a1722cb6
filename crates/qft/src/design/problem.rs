//! What a design begins with.

use phea_dynamics::linear::TransferFunction;
use phea_dynamics::pieces::Workers;

use super::quantization::CoefficientFormat;
use super::{NamedStructure, Objective};
use crate::loop_shaping::Structure;

/// Which controllers are tried.
#[derive(Clone, Debug, PartialEq)]
pub enum ControllerChoice {
    /// Those of one structure.
    Given(Structure),
    /// Those of one name.
    Named {
        /// The name.
        name: NamedStructure,
        /// As below, for the poles of a prefilter beyond the first one.
        earned_per_pole_db: f64,
    },
    /// Those of every name that suits the problem, the shortest first; where none meets every
    /// specification, structures of growing order.
    Any {
        /// Largest number of poles.
        maximum_order: usize,
        /// The first name that is tried, where shorter ones are known to fail.
        from: Option<NamedStructure>,
        /// True where a gain alone is tried although the specifications require an integrator: they
        /// lead to a step within a band, which a gain alone may reach.
        with_gain_alone: bool,
        /// How much a longer one must gain for each of its further poles to be taken in place of
        /// one that is met, dB, and a longer prefilter in place of one with one pole; infinite: the
        /// shortest is taken.
        earned_per_pole_db: f64,
    },
    /// Structures of growing order, up to this one, until one meets every specification.
    Grow {
        /// Largest number of poles.
        maximum_order: usize,
    },
}

impl ControllerChoice {
    /// How much a further pole must gain, dB; `None` where nothing but the objective decides.
    pub fn earned_per_pole_db(&self) -> Option<f64> {
        match *self {
            ControllerChoice::Named { earned_per_pole_db, .. }
            | ControllerChoice::Any { earned_per_pole_db, .. } => Some(earned_per_pole_db),
            ControllerChoice::Given(_) | ControllerChoice::Grow { .. } => None,
        }
    }
}

/// Which prefilters are tried.
#[derive(Clone, Debug, PartialEq)]
pub enum PrefilterChoice {
    /// No prefilter: tracking is judged by its spread.
    None,
    /// This one.
    Given(TransferFunction),
    /// Prefilters of growing order, up to this one.
    Grow {
        /// Largest number of poles.
        maximum_order: usize,
    },
}

/// Where the poles of a designed controller may lie; integrators are not concerned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoleRange {
    /// Least damping ratio of a pair that is not the notch of a pair of zeros.
    pub least_damping_ratio: f64,
    /// Greatest natural frequency, rad/s.
    pub fastest_rad_per_s: f64,
}

impl Default for PoleRange {
    /// Any but hardly damped ones.
    fn default() -> Self {
        PoleRange { least_damping_ratio: 0.1, fastest_rad_per_s: f64::INFINITY }
    }
}

/// How a design is made.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignOptions {
    /// What is minimised or maximised.
    pub objective: Objective,
    /// Which controllers are tried.
    pub controller: ControllerChoice,
    /// Which prefilters are tried.
    pub prefilter: PrefilterChoice,
    /// Seed of the random starting points: the same seed gives the same design.
    pub seed: u64,
    /// A margin of minus this much still counts as met, dB.
    pub tolerance_db: f64,
    /// Margin that the design keeps to every limit, between its samples too, dB; where two limits
    /// are near, [`Requirement::reserve_at_db`](crate::specification::Requirement::reserve_at_db).
    pub reserve_db: f64,
    /// Where poles of a controller of growing order may lie.
    pub poles: PoleRange,
    /// The number format of the coefficients of a sampled controller, which is judged with rounded
    /// coefficients. A continuous controller is not rounded.
    pub coefficients: CoefficientFormat,
    /// The owner of the threads; the design does not depend on it.
    pub workers: Workers,
}
