//! How a line moves: `model` of `[line]`, and the keys that go with it.

use super::key::{key, plain};
use super::visitor::{Kinds, Visitor};
use phea_quantity::{MASS_PER_LENGTH, RATIO, STRAIN_PER_FORCE, STRAIN_PER_PRESSURE, TIME};

/// How a line moves. Which of its numbers are used depends on the model; the others are absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineMotion {
    /// Which model.
    pub model: LineModel,
    /// How many segments; absent: [`LineMotion::SEGMENTS`].
    pub segments: Option<u32>,
    /// What resists the flow in segments; absent: it depends on frequency.
    pub friction: Option<LineFriction>,
    /// s, of a wall that creeps.
    pub relaxation_time: Option<f64>,
    /// Share of the line's compliance that is a plain volume at each end; absent: `phea_hydraulics::line::END_SHARE`.
    pub end_share: Option<f64>,
    /// What is known of a wall that moves along its axis.
    pub wall: Option<LineWall>,
}

/// What of a line moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineModel {
    /// One pressure.
    #[default]
    Lumped,
    /// One pressure, and a wall that creeps.
    Creeping,
    /// Capacities and inertances in turn.
    Segments,
    /// Fluid waves.
    TransmissionLine,
    /// Fluid and wall waves, coupled.
    TwoWave,
}

/// How laminar friction in segments is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineFriction {
    /// As in steady flow.
    Steady,
    /// With the boundary layer of changing flow.
    FrequencyDependent,
}

/// What is known of a hose's wall that moves along its axis; what is absent is assumed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineWall {
    /// kg/m.
    pub mass_per_length: Option<f64>,
    /// 1/Pa, area strain per pressure without tension.
    pub pressure_compliance: Option<f64>,
    /// 1/N, area strain per tension.
    pub coupling_compliance: Option<f64>,
    /// 1/N, axial strain per tension.
    pub axial_compliance: Option<f64>,
}

static FRICTIONS: [(&str, Option<LineFriction>); 2] =
    [("steady", Some(LineFriction::Steady)), ("frequency_dependent", Some(LineFriction::FrequencyDependent))];

impl LineModel {
    const WORDS: [(&'static str, LineModel); 5] = [
        ("lumped", LineModel::Lumped),
        ("creeping", LineModel::Creeping),
        ("segments", LineModel::Segments),
        ("transmission_line", LineModel::TransmissionLine),
        ("two_wave", LineModel::TwoWave),
    ];

    /// As in a project file.
    pub fn word(self) -> &'static str {
        LineModel::WORDS.iter().find(|(_, model)| *model == self).map_or("", |(word, _)| word)
    }

    /// The models that use a key, as in a project file.
    pub(crate) fn using(key: &str) -> Vec<&'static str> {
        LineModel::WORDS.iter().filter(|(_, model)| model.uses(key)).map(|(word, _)| *word).collect()
    }

    /// Whether a key beside `model` has a meaning.
    pub(crate) fn uses(self, key: &str) -> bool {
        let keys: &[&str] = match self {
            LineModel::Lumped => &[],
            LineModel::Creeping => &["relaxation_time"],
            LineModel::Segments => &["segments", "friction", "relaxation_time"],
            LineModel::TransmissionLine => &["end_share"],
            LineModel::TwoWave => &["end_share", "wall"],
        };
        keys.contains(&key)
    }
}

impl LineMotion {
    /// Segments of a line that does not say how many: the first resonance of a line closed at one end is 0.2 % low.
    pub const SEGMENTS: u32 = 8;
    /// States that segments of one line may have, so that both lines and what is around them fit into a simulation.
    const MOST_STATES: u32 = 112;
    /// Keys that go with one model or another.
    pub(crate) const KEYS: [&'static str; 5] =
        ["segments", "friction", "relaxation_time", "end_share", "wall"];
    /// A side that chooses its model has that model's keys of its own too.
    pub(crate) const MODELS: Kinds = Kinds { chosen_by: &["model"], keys: &LineMotion::KEYS };

    /// The most segments with this friction and this wall.
    pub(crate) fn most_segments(&self) -> u32 {
        let lags = if self.friction == Some(LineFriction::Steady) { 0 } else { 5 };
        let creeping = u32::from(self.relaxation_time.is_some());
        // a wall creeps at both ends of each segment
        (Self::MOST_STATES - creeping) / (2 + lags + creeping)
    }

    /// Whether a path of the project leads to one of these keys.
    pub(crate) fn owns(path: &str) -> bool {
        let within = path.strip_prefix("line.").unwrap_or_default();
        within
            .split('.')
            .find(|part| !["a", "b"].contains(part))
            .is_some_and(|key| LineMotion::KEYS.contains(&key))
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = plain("model", "What of the line moves.");
        v.choice(k, &LineModel::WORDS, &mut self.model, false);
        let k = key("segments", &RATIO, "How many segments; absent: 8.")
            .at_least(1.0)
            .at_most(f64::from(Self::MOST_STATES / 2));
        v.optional_count(k, &mut self.segments);
        let k = plain("friction", "Laminar friction in segments; absent: \"frequency_dependent\".");
        v.choice(k, &FRICTIONS, &mut self.friction, false);
        let k = key("relaxation_time", &TIME, "Time in which pressure relaxes while the volume is held.");
        v.optional(k.positive(), &mut self.relaxation_time);
        let k = key("end_share", &RATIO, "Share of the compliance at each end of a line with waves.");
        v.optional(k.positive().below(0.5), &mut self.end_share);
        let k = plain("wall", "The wall of a hose with two waves; what is absent is assumed.");
        v.table(k, &mut self.wall, LineWall::visit);
    }
}

impl LineWall {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("mass_per_length", &MASS_PER_LENGTH, "Mass of a metre of wall.").positive();
        v.optional(k, &mut self.mass_per_length);
        let k = key("pressure_compliance", &STRAIN_PER_PRESSURE, "Area strain per pressure, no tension.");
        v.optional(k.not_negative(), &mut self.pressure_compliance);
        let k = key("coupling_compliance", &STRAIN_PER_FORCE, "Area strain per tension; negative: a braid.");
        v.optional(k, &mut self.coupling_compliance);
        let k = key("axial_compliance", &STRAIN_PER_FORCE, "Axial strain per tension.").positive();
        v.optional(k, &mut self.axial_compliance);
    }
}
