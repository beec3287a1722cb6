//! The names of limits on closed loops.

use phea_qft::specification::ClosedLoop;
use phea_quantity::MotionKind;

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

/// A specification by its number and its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedSpecification {
    /// The number in the file, from 1; `None` for one that is not declared there.
    pub number: Option<usize>,
    /// The subject of its limit.
    pub name: SpecificationName,
}
