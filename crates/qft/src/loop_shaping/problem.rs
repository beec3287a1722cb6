//! What a loop is shaped for.

use phea_dynamics::controller::Timing;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::uncertain_plant::UncertainPlant;

use crate::family::Family;
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
    /// What every plant must satisfy.
    pub specifications: Vec<Specification>,
    /// Delay, in addition to that of the loop, that every plant must tolerate, s; 0 requires none.
    pub minimum_delay_margin_s: f64,
}

/// A required delay that is missed by less than this share counts as tolerated.
const DELAY_SHARE: f64 = 0.01;

impl DesignProblem {
    /// Whether a loop with this delay margin in s tolerates the required delay, to within a
    /// hundredth of it.
    pub fn tolerates_its_delay(&self, delay_margin_s: f64) -> bool {
        delay_margin_s >= (1.0 - DELAY_SHARE) * self.minimum_delay_margin_s
    }
}
