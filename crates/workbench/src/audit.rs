//! The audit of a given controller: family, loop and specifications from the project, findings from `phea_qft`, and how
//! they are told.

mod answer;
mod plant;
mod text;
mod words;

pub use answer::{files, json};
pub use plant::{NamedPlant, PlantNames};
pub use text::text;

use phea_qft::verification::Audit;

use crate::quantity::DisplayUnit;

/// An audit with the names of its project.
#[derive(Clone, Debug)]
pub struct ProjectAudit {
    /// What was found.
    pub audit: Audit,
    /// What the numbers of a plant are called.
    pub names: PlantNames,
    /// Number of plants looked at one by one.
    pub members: usize,
    /// s; `None` for a continuous controller.
    pub sample_time_s: Option<f64>,
    /// Delay of the loop, s.
    pub delay_s: f64,
}

impl ProjectAudit {
    fn family_sentence(&self) -> String {
        match &self.names {
            PlantNames::Measured(names) => format!("Family: {} measured responses.", names.len()),
            PlantNames::Parameters(names) => format!(
                "Family: {} plants over {} uncertain parameters.",
                self.members,
                names.len()
            ),
        }
    }

    fn loop_sentence(&self) -> String {
        let delay = match self.delay_s {
            0.0 => "without delay".to_string(),
            delay => format!("with a delay of {}", DisplayUnit::MILLISECOND.text(delay, 3)),
        };
        match self.sample_time_s {
            None => format!("Loop: continuous, {delay}."),
            Some(sample_time) => format!(
                "Loop: sampled every {} with a zero-order hold, {delay}.",
                DisplayUnit::MILLISECOND.text(sample_time, 3)
            ),
        }
    }
}
