//! The rig itself as a fact, if the family does not contain it.

use crate::rig::OutsideParameter;
use crate::specification::SpecificationName;

/// The rig itself, which the family does not contain.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideFamily {
    /// The parameters that the family does not contain.
    pub parameters: Vec<OutsideParameter>,
    /// Verdict on the loop with the rig.
    pub with_rig: LoopWithRig,
}

/// Verdict on the loop with the rig itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LoopWithRig {
    /// The loop is stable, and every specification is satisfied.
    Satisfied,
    /// The loop is unstable.
    Unstable,
    /// Violated specifications, each with its number, from 1, and name.
    Violates(Vec<(usize, SpecificationName)>),
    /// Nothing is proven.
    NotProven,
}
