//! The model of lines whose project states none, as it was chosen.

use crate::{DeclaredLine, LineMotion, Load, Project};

/// The model that was chosen for the lines without a stated one.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenLines {
    /// True if they have waves; otherwise they are lumped.
    pub with_waves: bool,
    /// Where the slower of them is a quarter of a wave long, rad/s.
    pub quarter_wave_rad_per_s: f64,
    /// The highest frequency that loop and requirements reach, and what reaches it; `None` where
    /// there is neither.
    pub reach: Option<(f64, ReachedBy)>,
    /// Why they are lumped although waves are reached.
    pub hindrance: Option<WavesHindrance>,
}

/// Why no model with waves is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WavesHindrance {
    /// The load is a mass without stiffness.
    FreeLoad,
    /// The rig cannot be computed with them; the message of its error.
    Rig(String),
}

impl ChosenLines {
    /// The model.
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

/// What reaches a frequency.
#[derive(Clone, Debug, PartialEq)]
pub enum ReachedBy {
    /// The highest frequency at which |L| = 1 in the given loop, over the plants that were
    /// examined.
    Crossover,
    /// The bandwidth of a required settling or rise time, of the specification with this number.
    RequiredTime(usize),
    /// The highest design frequency of the specification with this number.
    DesignFrequency(usize),
    /// The highest bandwidth that a design may have.
    HighestBandwidth,
    /// The bandwidth that valve, lines and sampling leave to a design that limits none.
    UnlimitedBandwidth,
}

impl Project {
    /// True where waves travel in a hose or pipe.
    pub fn has_waves(&self) -> bool {
        let mut lines = self.actuator.iter().flat_map(|actuator| [&actuator.line.a, &actuator.line.b]);
        lines.any(|line| line.length().is_some() && line.motion.has_waves())
    }

    /// The hoses and pipes whose project states no model.
    pub fn lines_without_model(&self) -> impl Iterator<Item = &DeclaredLine> {
        let lines = self.actuator.iter().flat_map(|actuator| [&actuator.line.a, &actuator.line.b]);
        lines.filter(|line| line.leaves_model_open())
    }

    /// True if its load is a mass that nothing holds, whose plant is not computed behind lines with
    /// waves.
    pub fn has_free_load(&self) -> bool {
        let Some(actuator) = &self.actuator else { return false };
        let is_uncertain = self.uncertainty.iter().any(|one| one.name == "load.stiffness");
        let is_free = matches!(actuator.load, Load::SpringMassDamper { stiffness: 0.0, .. });
        is_free && !is_uncertain && actuator.linkage.is_none()
    }

    /// The same project with waves in these, or with these lumped.
    #[must_use]
    pub fn with_chosen_lines(mut self, with_waves: bool) -> Project {
        let lines = self.actuator.iter_mut().flat_map(|own| [&mut own.line.a, &mut own.line.b]);
        for line in lines.filter(|line| line.leaves_model_open()) {
            line.motion = motion(with_waves);
        }
        self
    }
}

impl DeclaredLine {
    fn leaves_model_open(&self) -> bool {
        self.motion == LineMotion::Automatic && self.length().is_some()
    }
}
