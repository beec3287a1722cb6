//! Design problem: plants, loop and requirements.

use phea_dynamics::controller::Timing;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::UncertainPlant;

use crate::family::Family;
use crate::specification::Specification;

/// Specifications that plants must satisfy, and the loop.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignProblem {
    /// The plants.
    pub family: Family,
    /// Additional plants that the loop must also control; only the nominal plant of each counts.
    pub additional_plants: Vec<UncertainPlant>,
    /// Sensor H; 1 if the output itself is fed back.
    pub sensor: TransferFunction,
    /// Sample time, delay and discretization of the controller to be designed.
    pub timing: Timing,
    /// Specifications that every plant must satisfy.
    pub specifications: Vec<Specification>,
    /// Delay, in addition to that of the loop, that every plant must tolerate, s; 0 requires none.
    pub minimum_delay_margin_s: f64,
}

/// Fraction of the required delay that may be missed.
const DELAY_FRACTION: f64 = 0.01;

impl DesignProblem {
    /// True if a loop with this delay margin, s, tolerates the required delay, to within one
    /// hundredth.
    pub fn tolerates_its_delay(&self, delay_margin_s: f64) -> bool {
        delay_margin_s >= (1.0 - DELAY_FRACTION) * self.minimum_delay_margin_s
    }
}
