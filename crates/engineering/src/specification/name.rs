//! Names of limits on closed loops.

use phea_qft::specification::ClosedLoop;
use phea_quantity::MotionKind;

/// Subject of a limit on a closed loop, by which the limit is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpecificationName {
    /// Closed loop that a specification of the project limits.
    ClosedLoop(ClosedLoop),
    /// Effect of rounding the command on the force, or on the torque of a rig that turns.
    RoundedCommand(MotionKind),
    /// Effect of rounding the measurement on the command.
    RoundedMeasurement,
}

/// A specification by its number and its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedSpecification {
    /// Number in the file, from 1; `None` for one that is not declared there.
    pub number: Option<usize>,
    /// Subject of its limit.
    pub name: SpecificationName,
}
