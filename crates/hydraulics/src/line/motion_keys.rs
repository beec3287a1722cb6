//! Dynamic model of a line: `model` of `[line]`, and its keys.

use super::LineWall;
use crate::line::LaminarFriction;
use phea_quantity::{RATIO, TIME};
use phea_table::{Key, Kinds, TableNumber, Variants, Visitor, key, plain};

/// Dynamic model of a line with its parameters.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LineMotion<S = f64> {
    /// Model chosen by the frequency range of loop and requirements; lumped until it is chosen.
    #[default]
    Automatic,
    /// Single pressure.
    Lumped,
    /// Single pressure, and a wall that creeps.
    Creeping {
        /// Time constant in which pressure relaxes at constant volume, s.
        relaxation_time: S,
    },
    /// Alternating capacities and inertances.
    Segments(LineSegments<S>),
    /// Fluid waves.
    TransmissionLine {
        /// Fraction of the line's compliance that is a plain volume at each end; if absent,
        /// `phea_hydraulics::line::END_SHARE`.
        end_share: Option<S>,
    },
    /// Fluid and wall waves, coupled.
    TwoWave {
        /// Fraction as for a transmission line.
        end_share: Option<S>,
        /// Data of a wall that moves along its axis.
        wall: Option<LineWall<S>>,
    },
}

/// Line divided into segments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineSegments<S = f64> {
    /// Number of segments; if absent, [`LineSegments::COUNT`].
    pub count: Option<u32>,
    /// Friction of the flow; frequency-dependent if absent.
    pub friction: Option<LaminarFriction>,
    /// Relaxation time of a wall that creeps, s; elastic if absent.
    pub relaxation_time: Option<S>,
}

static FRICTIONS: [(&str, Option<LaminarFriction>); 2] = [
    ("steady", Some(LaminarFriction::Steady)),
    ("frequency_dependent", Some(LaminarFriction::FrequencyDependent)),
];

pub(super) const END_SHARE_KEY: Key =
    key("end_share", &RATIO, "Share of the compliance at each end of a line with waves.")
        .positive()
        .below(0.5);

pub(super) const RELAXATION: Key = key(
    "relaxation_time",
    &TIME,
    "Time in which pressure relaxes while the volume is held; none is assumed.",
)
.positive();

impl<S: TableNumber> Variants<S> for LineMotion<S> {
    const STRICT: bool = true;

    fn all(&self) -> Vec<LineMotion<S>> {
        vec![
            LineMotion::Automatic,
            LineMotion::Lumped,
            LineMotion::Creeping { relaxation_time: S::default() },
            LineMotion::Segments(LineSegments::default()),
            LineMotion::TransmissionLine { end_share: None },
            LineMotion::TwoWave { end_share: None, wall: None },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            LineMotion::Automatic => "automatic",
            LineMotion::Lumped => "lumped",
            LineMotion::Creeping { .. } => "creeping",
            LineMotion::Segments(_) => "segments",
            LineMotion::TransmissionLine { .. } => "transmission_line",
            LineMotion::TwoWave { .. } => "two_wave",
        }
    }

    fn goes_without_saying(&self) -> bool {
        *self == LineMotion::Automatic
    }

    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        match self {
            LineMotion::Automatic | LineMotion::Lumped => {}
            LineMotion::Creeping { relaxation_time } => v.quantity(RELAXATION, relaxation_time),
            LineMotion::Segments(segments) => segments.visit(v),
            LineMotion::TransmissionLine { end_share } => v.optional(END_SHARE_KEY, end_share),
            LineMotion::TwoWave { end_share, wall } => {
                v.optional(END_SHARE_KEY, end_share);
                let k = plain("wall", "The wall of a hose with two waves; what is absent is assumed.");
                v.table(k, wall, LineWall::visit);
            }
        }
    }
}

impl LineMotion {
    /// Keys that belong to single models.
    pub const KEYS: [&'static str; 5] = ["segments", "friction", "relaxation_time", "end_share", "wall"];
    /// Models as kinds: a side that chooses its model also has that model's keys of its own.
    pub const MODELS: Kinds = Kinds { chosen_by: &["model"], keys: &LineMotion::KEYS };

    /// Word of its model in a project file.
    pub fn model(&self) -> &'static str {
        self.word()
    }

    /// True if waves travel in the line.
    pub fn has_waves(&self) -> bool {
        !self.is_lumped() && !matches!(self, LineMotion::Creeping { .. })
    }

    /// True if the line has one pressure and a wall that does not creep.
    pub fn is_lumped(&self) -> bool {
        matches!(self, LineMotion::Automatic | LineMotion::Lumped)
    }

    /// Relaxation time of a wall that creeps, s.
    pub fn relaxation_time(&self) -> Option<f64> {
        match self {
            LineMotion::Creeping { relaxation_time } => Some(*relaxation_time),
            LineMotion::Segments(segments) => segments.relaxation_time,
            LineMotion::Automatic
            | LineMotion::Lumped
            | LineMotion::TransmissionLine { .. }
            | LineMotion::TwoWave { .. } => None,
        }
    }
}

impl LineSegments {
    /// Default number of segments: the first resonance of a line closed at one end is 0.2 % low.
    pub const COUNT: u32 = 8;
    /// Largest number of states of the segments of one line, so that both lines and the parts
    /// around them fit into a simulation.
    const MOST_STATES: u32 = 112;

    /// Number of segments.
    pub fn count(&self) -> u32 {
        self.count.unwrap_or(Self::COUNT)
    }

    /// Largest number of segments with this friction and this wall.
    pub fn most(&self) -> u32 {
        let lags = if self.friction == Some(LaminarFriction::Steady) { 0 } else { 5 };
        let creeping = u32::from(self.relaxation_time.is_some());
        // a wall creeps at both ends of each segment
        (Self::MOST_STATES - creeping) / (2 + lags + creeping)
    }
}

impl<S: TableNumber> LineSegments<S> {
    fn visit<V: Visitor<S>>(&mut self, v: &mut V) {
        let k = key("segments", &RATIO, "How many segments; absent: 8.")
            .at_least(1.0)
            .at_most(f64::from(LineSegments::<f64>::MOST_STATES / 2));
        v.optional_count(k, &mut self.count);
        let k = plain("friction", "Laminar friction in segments; absent: \"frequency_dependent\".");
        v.choice(k, &FRICTIONS, &mut self.friction, false);
        v.optional(RELAXATION, &mut self.relaxation_time);
    }
}
