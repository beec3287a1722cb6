//! Words of the kinds of specifications.

use phea_qft::specification::{ClosedLoop, Requirement};

use crate::project::{SPECIFICATION_KINDS, SpecificationKind, word_of};

/// Word of a kind, as the project file spells it.
pub fn kind_key(requirement: &Requirement) -> &'static str {
    closed_loop_key(requirement.closed_loop())
}

/// Word of the kind that limits a closed loop.
pub fn closed_loop_key(closed_loop: ClosedLoop) -> &'static str {
    word_of(&SPECIFICATION_KINDS, &SpecificationKind::ClosedLoop(closed_loop))
}
