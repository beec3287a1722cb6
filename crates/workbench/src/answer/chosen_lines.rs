//! The model that was chosen for lines without a stated one, for programs.

use phea_engineering::line_choice::LUMPED_FROM;

use super::words::words;
use super::{Answer, OrReason};
use crate::project::{ChosenLines, ReachedBy, WavesHindrance};
use crate::quantity::MotionKind;

/// Model chosen for the lines, and the frequencies that it follows from.
#[derive(Answer)]
pub(crate) struct ChosenLinesAnswer {
    /// Chosen model.
    model: ChosenLineModel,
    /// Lowest frequency at which a line is a quarter of a wave long.
    quarter_wave_rad_per_s: f64,
    /// Highest frequency that the loop or a requirement reaches.
    reached_rad_per_s: OrReason<f64>,
    /// Origin of `reached_rad_per_s`.
    #[answer(optional)]
    reached_by: Option<ReachedBy>,
    /// Number of the specification that reaches it, from 1 in the order of the file.
    #[answer(optional)]
    specification: Option<usize>,
    /// Least ratio of `quarter_wave_rad_per_s` to `reached_rad_per_s` for a lumped model.
    lumped_from: f64,
    /// Reason why no model with waves is computed, where one would be needed.
    #[answer(optional)]
    obstacle: Option<String>,
}

enum ChosenLineModel {
    Waves,
    Lumped,
}

words! {
    /// Model of the lines.
    ChosenLineModel { Waves => "transmission_line", Lumped => "lumped" }
}

words! {
    /// Origin of the highest frequency that a model of the lines must contain.
    ReachedBy {
        Crossover => "crossover",
        RequiredTime(_) => "required_time",
        DesignFrequency(_) => "design_frequency",
        HighestBandwidth => "highest_bandwidth",
        UnlimitedBandwidth => "unlimited_bandwidth",
    }
}

/// The model, and what it follows from.
pub(crate) fn body_of_lines(lines: &ChosenLines, motion: MotionKind) -> ChosenLinesAnswer {
    let (reached, by) = lines.reach.clone().unzip();
    let specification = match by {
        Some(ReachedBy::RequiredTime(number) | ReachedBy::DesignFrequency(number)) => Some(number),
        _ => None,
    };
    ChosenLinesAnswer {
        model: if lines.with_waves { ChosenLineModel::Waves } else { ChosenLineModel::Lumped },
        quarter_wave_rad_per_s: lines.quarter_wave_rad_per_s,
        reached_rad_per_s: OrReason::new(reached, "neither loop nor requirement reaches a frequency"),
        reached_by: by,
        specification,
        lumped_from: LUMPED_FROM,
        obstacle: lines.obstacle.as_ref().map(|one| hindrance_words(one, motion).to_string()),
    }
}

/// Reason why no model with waves is computed.
pub(crate) fn hindrance_words(obstacle: &WavesHindrance, motion: MotionKind) -> &str {
    match obstacle {
        WavesHindrance::FreeLoad => {
            motion.either("the load is a mass without stiffness", "the load is an inertia without stiffness")
        }
        WavesHindrance::Rig(error) => error,
    }
}
