//! What a design begins with.

use phea_dynamics::controller::Timing;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::UncertainPlant;

use super::Objective;
use super::quantization::CoefficientFormat;
use crate::family::Family;
use crate::loop_shaping::Structure;
use crate::specification::Specification;

/// The design problem: which specifications which plants must satisfy, in which loop.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignProblem {
    /// The plants.
    pub family: Family,
    /// Additional plants that the loop must also control; only the nominal plant of each counts.
    pub beside: Vec<UncertainPlant>,
    /// H; 1 where the output itself is fed back.
    pub sensor: TransferFunction,
    /// Sample time, delay and discretization of the wanted controller.
    pub timing: Timing,
    /// What must be kept to.
    pub specifications: Vec<Specification>,
    /// Delay, in addition to that of the loop, that every plant must tolerate, s; 0 requires none.
    pub minimum_delay_margin_s: f64,
}

/// A required delay that is missed by less than this share counts as tolerated.
const DELAY_SHARE: f64 = 0.01;

impl DesignProblem {
    /// Whether a loop with this delay margin in s tolerates the required delay, to within a
    /// hundredth of it.
    pub fn bears_its_delay(&self, delay_margin_s: f64) -> bool {
        delay_margin_s >= (1.0 - DELAY_SHARE) * self.minimum_delay_margin_s
    }
}

/// Which controllers are tried.
#[derive(Clone, Debug, PartialEq)]
pub enum ControllerChoice {
    /// Those of one structure.
    Given(Structure),
    /// Structures of growing order, up to this one, until one meets every specification.
    Grow {
        /// Largest number of poles.
        maximum_order: usize,
    },
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
    /// The number format of the coefficients of a sampled controller, which is judged with rounded
    /// coefficients. A continuous controller is not rounded.
    pub coefficients: CoefficientFormat,
}
