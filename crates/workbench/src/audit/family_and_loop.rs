//! The plants of an audit, their position and the loop around them, in sentences.

use super::{CommonPosition, LoopDeadTime, ProjectAudit};
use crate::document::capital;
use crate::plant_names::PlantNames;
use crate::quantity::DisplayUnit;
use crate::robust::NoPolynomials;

/// `lines in motion`
pub(super) fn no_polynomials_words(why: NoPolynomials) -> &'static str {
    match why {
        NoPolynomials::LinesInMotion => "lines in motion",
        NoPolynomials::PressuresFedBackLate => "pressures fed back late",
        NoPolynomials::LoadVelocityFedForwardLate => "the load's velocity fed forward late",
    }
}

/// The plants that were audited.
pub(super) fn family_sentence(view: &ProjectAudit) -> String {
    let why = view.without_polynomials.map(no_polynomials_words);
    let moving = why.map_or(String::new(), |why| format!(", every plant by its response with {why}"));
    match &view.names {
        PlantNames::Measured(names) => format!("Family: {}.", counted(names.len(), "measured response")),
        PlantNames::Parameters(names) if names.is_empty() => format!("Family: one plant{moving}."),
        PlantNames::Parameters(names) if view.whole_box => {
            // the members of a family with lines in motion are without the corners
            let without_corners = if view.has_lines_in_motion() { " in addition to the corners" } else { "" };
            format!(
                "Family: {}{without_corners} of a box over {}, and everything between them{moving}.",
                counted(view.members, "plant"),
                counted(names.len(), "uncertain parameter")
            )
        }
        PlantNames::Parameters(names) => {
            format!(
                "Family: {} with {}{moving}.",
                counted(view.members, "given plant"),
                counted(names.len(), "uncertain parameter")
            )
        }
    }
}

/// Delay and samples of the loop.
pub(super) fn loop_sentence(view: &ProjectAudit) -> String {
    let of_parts = dead_time_words(&view.dead_time);
    let in_lines = view.has_lines_in_motion();
    let delay = match view.delay_s {
        0.0 if of_parts.is_empty() && in_lines => "without delay but that of its lines in motion".to_string(),
        0.0 if of_parts.is_empty() => "without delay".to_string(),
        0.0 => format!("without delay of its own, {of_parts}"),
        delay => {
            let parts = [format!("with a delay of {}", DisplayUnit::MILLISECOND.text(delay, 3)), of_parts];
            parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
        }
    };
    match view.sample_time_s {
        None => format!("Loop: continuous, {delay}."),
        Some(sample_time) => {
            let images = match view.names {
                PlantNames::Measured(_) => {
                    " Beyond the measurements the response is assumed to be no larger than at their ends."
                }
                PlantNames::Parameters(_) => "",
            };
            format!(
                "Loop: sampled every {} with a zero-order hold, {delay}.{images}",
                DisplayUnit::MILLISECOND.text(sample_time, 3)
            )
        }
    }
}

/// `1 plant`, `2 plants`.
fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// The dead times that are not zero; empty if all are zero.
fn dead_time_words(dead_time: &LoopDeadTime) -> String {
    let text = |time_s: f64| DisplayUnit::MILLISECOND.text(time_s, 3);
    let [least, most] = dead_time.plant_s;
    let plant = match least == most {
        true => text(most),
        false => format!("{} to {}", text(least), text(most)),
    };
    let parts = [
        (most, format!("{plant} in the plant")),
        (dead_time.sensor_s, format!("{} in the sensor", text(dead_time.sensor_s))),
        (dead_time.controller_s, format!("{} in the controller", text(dead_time.controller_s))),
    ];
    let parts: Vec<String> =
        parts.into_iter().filter(|(time_s, _)| *time_s != 0.0).map(|(_, words)| words).collect();
    if parts.is_empty() { String::new() } else { format!("with a dead time of {}", parts.join(" and ")) }
}

/// `100 mm of 200 mm of stroke`
pub(crate) fn position_words(taken: &CommonPosition) -> String {
    let [position, stroke] = [taken.position, taken.stroke].map(|x| taken.units.position.short(x, 4));
    format!("{position} of {stroke} of stroke")
}

/// Position of the plants, and the key that includes other positions.
pub(super) fn position_sentence(taken: &CommonPosition) -> String {
    format!(
        "{}: every plant is taken at {}. Elsewhere the oil is stiffer or softer: nothing is said of a loop there, unless `position` in [family.operating_region] includes it.",
        capital(taken.units.motion.words().position),
        position_words(taken)
    )
}
