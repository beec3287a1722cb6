//! The words of the kinds of specifications.

use phea_qft::specification::{ClosedLoop, Requirement};

use crate::project::{SPECIFICATION_KINDS, SpecificationKind, word_of};

/// The word of a kind, as the project file spells it.
pub fn kind_key(requirement: &Requirement) -> &'static str {
    closed_loop_key(requirement.closed_loop())
}

/// The word of the kind that limits a closed loop.
pub fn closed_loop_key(closed_loop: ClosedLoop) -> &'static str {
    word_of(&SPECIFICATION_KINDS, &SpecificationKind::ClosedLoop(closed_loop))
}

/// The kind that limits a closed loop, for people.
pub fn closed_loop_words(closed_loop: ClosedLoop) -> &'static str {
    match closed_loop {
        ClosedLoop::RobustStability => "robust stability",
        ClosedLoop::Sensitivity => "sensitivity",
        ClosedLoop::PlantInputDisturbance => "plant input disturbance",
        ClosedLoop::ControlEffort => "control effort",
        ClosedLoop::LoadMotion => "load motion",
        ClosedLoop::Tracking => "tracking",
    }
}
