//! The names of limits on closed loops.

use phea_qft::specification::ClosedLoop;
use phea_quantity::MotionKind;

use super::kind::closed_loop_words;

/// The subject of a limit on a closed loop, by which the limit is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpecificationName {
    /// The closed loop that a specification of the project limits.
    ClosedLoop(ClosedLoop),
    /// The effect of rounding the command on the force, or the torque of a rig that turns.
    RoundedCommand(MotionKind),
    /// The effect on the command of rounding the measurement.
    RoundedMeasurement,
}

impl SpecificationName {
    /// The name for people.
    pub fn words(self) -> &'static str {
        match self {
            SpecificationName::ClosedLoop(closed_loop) => closed_loop_words(closed_loop),
            SpecificationName::RoundedCommand(motion) => {
                motion.either("force error of the rounded command", "torque error of the rounded command")
            }
            SpecificationName::RoundedMeasurement => "command error of the rounded measurement",
        }
    }
}
