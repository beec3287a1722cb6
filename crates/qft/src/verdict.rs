//! Verdict, its evidence, and the plant that it names.

use crate::family::{Extent, Family};

/// A verdict. `Met` means that the margin is not below the negative of the tolerance, wherever it
/// was evaluated.
///
/// Ordered from the best to the worst, so that the verdict on several requirements together is the
/// greatest: a violation outweighs an unproven result, which outweighs a requirement that is met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Every plant satisfies the requirement.
    Met,
    /// The requirement could not be resolved.
    NotProven,
    /// The requirement is violated by at least one plant, named with its frequency.
    Violated,
}

/// Evidence for a verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Evidence {
    /// The members, at the frequencies of a grid: no claim is made between them.
    Grid,
    /// The worst case was searched for continuously over the box and the band, without finding a
    /// worse one; this is not a proof.
    Search,
    /// Proven for every plant and every frequency.
    Proof,
}

impl Evidence {
    /// The evidence for an audit of a family.
    pub(crate) fn of(family: &Family) -> Evidence {
        match family {
            Family::Uncertain(family) if family.extent() == Extent::Box => Evidence::Search,
            // given plants and measurements are examined individually
            Family::Uncertain(_) | Family::Measured(_) => Evidence::Grid,
        }
    }
}

/// One plant of a family.
#[derive(Clone, Debug, PartialEq)]
pub enum PlantPoint {
    /// Parameter values, in the order of the uncertain plant.
    Parameters(Vec<f64>),
    /// Index of a measured plant.
    Measured(usize),
    /// Index of an additional plant of a design.
    Additional(usize),
}
