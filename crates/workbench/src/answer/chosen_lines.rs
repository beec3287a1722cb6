//! The model that was chosen for lines without a stated one, for programs.

use phea_engineering::line_choice::LUMPED_FROM;

use super::Object;
use crate::project::{ChosenLines, ReachedBy, WavesHindrance};
use crate::quantity::MotionKind;

/// The model, and what it follows from.
pub(crate) fn body_of_lines(lines: &ChosenLines, motion: MotionKind) -> Object {
    let by = |(_, by): &(f64, ReachedBy)| match by {
        ReachedBy::Crossover => "crossover",
        ReachedBy::RequiredTime(_) => "required_time",
        ReachedBy::DesignFrequency(_) => "design_frequency",
        ReachedBy::HighestBandwidth => "highest_bandwidth",
        ReachedBy::UnlimitedBandwidth => "unlimited_bandwidth",
    };
    let specification = |(_, by): &(f64, ReachedBy)| match by {
        ReachedBy::RequiredTime(number) | ReachedBy::DesignFrequency(number) => Some(*number),
        ReachedBy::Crossover | ReachedBy::HighestBandwidth | ReachedBy::UnlimitedBandwidth => None,
    };
    let nothing = "neither loop nor requirement reaches a frequency";
    Object::new()
        .with("model", if lines.with_waves { "transmission_line" } else { "lumped" })
        .with("quarter_wave_rad_per_s", lines.quarter_wave_rad_per_s)
        .known("reached_rad_per_s", lines.reach.as_ref().map(|(reached, _)| *reached), nothing)
        .maybe("reached_by", lines.reach.as_ref().map(by))
        .maybe("specification", lines.reach.as_ref().and_then(specification))
        .with("lumped_from", LUMPED_FROM)
        .maybe("hindrance", lines.hindrance.as_ref().map(|one| hindrance_words(one, motion)))
}

/// Reason why no model with waves is computed.
pub(crate) fn hindrance_words(hindrance: &WavesHindrance, motion: MotionKind) -> &str {
    match hindrance {
        WavesHindrance::FreeLoad => {
            motion.either("the load is a mass without stiffness", "the load is an inertia without stiffness")
        }
        WavesHindrance::Rig(error) => error,
    }
}
