//! Automatically chosen model of lines for which the project states none.

use crate::{DeclaredLine, LineMotion, Load, Project};

/// Model chosen for the lines without a stated one.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenLines {
    /// True if they have waves; otherwise they are lumped.
    pub with_waves: bool,
    /// Quarter-wave frequency of the slower line, rad/s.
    pub quarter_wave_rad_per_s: f64,
    /// Highest frequency of loop and requirements, and its origin; `None` if there is neither.
    pub reach: Option<(f64, ReachedBy)>,
    /// Reason why they are lumped although their waves are within the frequency range.
    pub obstacle: Option<WavesHindrance>,
}

/// Reason why no model with waves is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WavesHindrance {
    /// The load is a mass without stiffness.
    FreeLoad,
    /// A rig that cannot be computed with them; the message of its error.
    Rig(String),
}

impl ChosenLines {
    /// Chosen model.
    pub fn motion(&self) -> LineMotion {
        motion(self.with_waves)
    }
}

fn motion(with_waves: bool) -> LineMotion {
    match with_waves {
        true => LineMotion::TransmissionLine { end_share: None },
        false => LineMotion::Lumped,
    }
}

/// Origin of the highest frequency.
#[derive(Clone, Debug, PartialEq)]
pub enum ReachedBy {
    /// Highest frequency at which |L| = 1 in the given loop, over the examined plants.
    Crossover,
    /// Bandwidth of a required settling or rise time, of the specification with this number.
    RequiredTime(usize),
    /// Highest design frequency of the specification with this number.
    DesignFrequency(usize),
    /// Highest bandwidth that a design may have.
    HighestBandwidth,
    /// Bandwidth that valve, lines and sampling allow a design without a limit.
    UnlimitedBandwidth,
}

impl Project {
    /// True if waves travel in a hose or pipe.
    pub fn has_waves(&self) -> bool {
        let mut lines = self.actuator.iter().flat_map(|actuator| [&actuator.line.a, &actuator.line.b]);
        lines.any(|line| line.length().is_some() && line.motion.has_waves())
    }

    /// Hoses and pipes for which the project states no model.
    pub fn lines_without_model(&self) -> impl Iterator<Item = &DeclaredLine> {
        let lines = self.actuator.iter().flat_map(|actuator| [&actuator.line.a, &actuator.line.b]);
        lines.filter(|line| leaves_model_open(line))
    }

    /// True if the load is a mass without stiffness, whose plant is not computed behind lines with
    /// waves.
    pub fn has_free_load(&self) -> bool {
        let Some(actuator) = &self.actuator else { return false };
        let is_uncertain = self.uncertainty.iter().any(|one| one.name == "load.stiffness");
        let is_free = matches!(actuator.load, Load::SpringMassDamper { stiffness: 0.0, .. });
        is_free && !is_uncertain && actuator.linkage.is_none()
    }

    /// Project with waves in these lines, or with these lines lumped.
    #[must_use]
    pub fn with_chosen_lines(mut self, with_waves: bool) -> Project {
        let lines = self.actuator.iter_mut().flat_map(|own| [&mut own.line.a, &mut own.line.b]);
        for line in lines.filter(|line| leaves_model_open(line)) {
            line.motion = motion(with_waves);
        }
        self
    }
}

fn leaves_model_open(line: &DeclaredLine) -> bool {
    line.motion == LineMotion::Automatic && line.length().is_some()
}
