//! Table `[[scenario]]`: a simulation.

use super::input_signal::{InputSignal, InputUnit};
use super::measured::MeasuredFile;
use phea_quantity::{ANGULAR_FREQUENCY, FORCE, LENGTH, PERCENT, PRESSURE, TIME, VELOCITY, VOLTAGE};
use phea_table::{Key, key, plain};
use phea_table::{Variants, Visitor};

/// Simulation of the rig.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scenario {
    /// Name of its results.
    pub name: String,
    /// Duration, s.
    pub duration: f64,
    /// Time between rows of the result, s.
    pub output_step: f64,
    /// State at the start; if absent, the closed loop at rest at the position of the operating
    /// point, mid stroke by default.
    pub start: Option<Start>,
    /// Reference force, the sum of these.
    pub reference: Vec<InputSignal>,
    /// Open-loop command of the valve, the sum of these; if empty, the controller commands.
    pub command: Vec<InputSignal>,
    /// Motion of the load.
    pub load_motion: Option<LoadMotion>,
    /// External force on the load, the sum of these; positive in the direction of positive
    /// position.
    pub external_force: Vec<InputSignal>,
    /// Change of the accumulators' setting from rest, the sum of these.
    pub setting_change: Vec<InputSignal>,
    /// Band of every settling time, percent.
    pub settling_band_percent: f64,
    /// Measurements on the rig.
    pub measured: Vec<MeasuredFile>,
}

/// State at the start; states not named are zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Position, m.
    pub position: Option<f64>,
    /// Velocity, m/s.
    pub velocity: Option<f64>,
    /// Pressure of chamber A, Pa.
    pub pressure_a: Option<f64>,
    /// Pressure of chamber B, Pa.
    pub pressure_b: Option<f64>,
    /// Spool position as equivalent command, V.
    pub spool: Option<f64>,
    /// Deflection of the load cell as a force, N.
    pub force: Option<f64>,
    /// File with the state at the end of another run, instead of all these.
    pub file: Option<String>,
}

/// Motion of the load.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadMotion {
    /// Shape in time.
    pub shape: MotionShape,
    /// Start, s.
    pub start: f64,
}

/// Shape of the load motion in time. Distances and amplitudes in m, times in s, frequencies in
/// rad/s.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionShape {
    /// Quintic step: velocity and acceleration are zero at both ends.
    SmoothStep {
        /// Duration.
        duration: f64,
        /// Distance.
        distance: f64,
    },
    /// First-order motion 1 - exp(-t/τ).
    FirstOrder {
        /// Distance.
        distance: f64,
        /// Time constant τ.
        time_constant: f64,
    },
    /// Sine.
    Sine {
        /// Amplitude of the sine.
        amplitude: f64,
        /// Frequency of the sine.
        frequency: f64,
    },
    /// Sine whose frequency changes linearly.
    Chirp {
        /// Duration.
        duration: f64,
        /// Amplitude of the sine.
        amplitude: f64,
        /// Initial frequency.
        frequency: f64,
        /// Final frequency.
        final_frequency: f64,
    },
    /// Motion from a CSV file with time and position.
    File {
        /// Name of the file.
        file: String,
    },
}

impl Default for MotionShape {
    fn default() -> Self {
        MotionShape::SmoothStep { duration: 0.0, distance: 0.0 }
    }
}

impl Variants for MotionShape {
    const STRICT: bool = true;

    fn all(&self) -> Vec<MotionShape> {
        vec![
            MotionShape::default(),
            MotionShape::FirstOrder { distance: 0.0, time_constant: 0.0 },
            MotionShape::Sine { amplitude: 0.0, frequency: 0.0 },
            MotionShape::Chirp { duration: 0.0, amplitude: 0.0, frequency: 0.0, final_frequency: 0.0 },
            MotionShape::File { file: String::new() },
        ]
    }

    fn word(&self) -> &'static str {
        match self {
            MotionShape::SmoothStep { .. } => "smooth_step",
            MotionShape::FirstOrder { .. } => "first_order",
            MotionShape::Sine { .. } => "sine",
            MotionShape::Chirp { .. } => "chirp",
            MotionShape::File { .. } => "file",
        }
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let how_long = key("duration", &TIME, "Of a smooth step or a chirp.").positive();
        let how_far = key("distance", &LENGTH, "Of a smooth or first-order step.").of_load();
        let size = key("amplitude", &LENGTH, "Of a sine or chirp.").of_load().positive();
        let first = key("frequency", &ANGULAR_FREQUENCY, "Of a sine, or where a chirp begins.").positive();
        match self {
            MotionShape::SmoothStep { duration, distance } => {
                v.quantity(how_long, duration);
                v.quantity(how_far, distance);
            }
            MotionShape::FirstOrder { distance, time_constant } => {
                v.quantity(how_far, distance);
                let k = key("time_constant", &TIME, "Of a first-order step.").positive();
                v.quantity(k, time_constant);
            }
            MotionShape::Sine { amplitude, frequency } => {
                v.quantity(size, amplitude);
                v.quantity(first, frequency);
            }
            MotionShape::Chirp { duration, amplitude, frequency, final_frequency } => {
                v.quantity(how_long, duration);
                v.quantity(size, amplitude);
                v.quantity(first, frequency);
                let k = key("final_frequency", &ANGULAR_FREQUENCY, "Where a chirp ends.").positive();
                v.quantity(k, final_frequency);
            }
            MotionShape::File { file } => {
                let mut name = Some(std::mem::take(file));
                v.text(plain("file", "A CSV file with time and position."), &mut name, true);
                *file = name.unwrap_or_default();
            }
        }
    }
}

impl Scenario {
    /// True if it runs open loop.
    pub fn is_open_loop(&self) -> bool {
        !self.command.is_empty()
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let mut name = Some(std::mem::take(&mut self.name));
        v.text(plain("name", "Names its results."), &mut name, true);
        self.name = name.unwrap_or_default();
        let k = key("duration", &TIME, "How long is simulated.").positive();
        v.quantity(k, &mut self.duration);
        let k = key("output_step", &TIME, "Time between rows of the result.").positive().or(1e-3);
        v.quantity(k, &mut self.output_step);
        let k =
            plain("start", "State at the start; states not named are zero. Absent: the closed loop at rest.");
        v.table(k, &mut self.start, Start::visit);
        let k =
            plain("reference", "The reference force: steps, each until the next, and what is added to them.");
        v.one_or_more(k, &mut self.reference, InputSignal::visitor(InputUnit::REFERENCE));
        let k = plain("command", "The command of the valve, open loop: no controller acts.");
        v.one_or_more(k, &mut self.command, InputSignal::visitor(InputUnit::COMMAND));
        v.table(plain("load_motion", "What the load does."), &mut self.load_motion, LoadMotion::visit);
        let k = plain("external_force", "A force on the load from outside, towards positive positions.");
        v.one_or_more(k, &mut self.external_force, InputSignal::visitor(InputUnit::EXTERNAL_FORCE));
        let k = plain("setting_change", "By how much the setting of accumulators moves from rest.");
        v.one_or_more(k, &mut self.setting_change, InputSignal::visitor(InputUnit::SETTING_CHANGE));
        let k =
            key("settling_band_percent", &PERCENT, "Band of every settling time, in percent of the step.");
        v.quantity(k.positive().below(100.0).or(1.0), &mut self.settling_band_percent);
        let k = plain("measured", "What was measured on the rig, laid over the simulation.");
        v.tables(k, &mut self.measured, MeasuredFile::visit);
    }
}

impl Start {
    /// Number at a key.
    pub fn number(&self, key: &str) -> Option<f64> {
        *self.clone().place(key)?
    }

    /// Replaces the number at a key; has no effect for a key that it does not have.
    pub fn set_number(&mut self, key: &str, value: f64) {
        if let Some(place) = self.place(key) {
            *place = Some(value);
        }
    }

    fn place(&mut self, key: &str) -> Option<&mut Option<f64>> {
        match key {
            "position" => Some(&mut self.position),
            "velocity" => Some(&mut self.velocity),
            "pressure_a" => Some(&mut self.pressure_a),
            "pressure_b" => Some(&mut self.pressure_b),
            _ => None,
        }
    }

    pub(crate) fn visit<V: Visitor>(&mut self, v: &mut V) {
        let k = key("position", &LENGTH, "Position of the piston.").of_motion().not_negative();
        v.optional(k, &mut self.position);
        v.optional(key("velocity", &VELOCITY, "Velocity of the piston.").of_motion(), &mut self.velocity);
        let k = key("pressure_a", &PRESSURE, "Pressure in chamber A, gauge.").above(-101_325.0);
        v.optional(k, &mut self.pressure_a);
        let k = key("pressure_b", &PRESSURE, "Pressure in chamber B, gauge.").above(-101_325.0);
        v.optional(k, &mut self.pressure_b);
        v.optional(key("spool", &VOLTAGE, "Spool position as equivalent command."), &mut self.spool);
        v.optional(key("force", &FORCE, "Force in the load cell.").of_motion(), &mut self.force);
        v.text(plain("file", "A saved state to go on from, instead of all these."), &mut self.file, false);
    }
}

impl LoadMotion {
    fn visit<V: Visitor>(&mut self, v: &mut V) {
        v.variant(plain("kind", "Its shape in time."), &mut self.shape, true);
        v.quantity(key("start", &TIME, "When it begins.").not_negative().or(0.0), &mut self.start);
    }
}

/// Numbers of the start by their names in a campaign: `start.position` and so on.
pub(crate) fn start_numbers() -> Vec<(String, Key)> {
    let keys = [
        key("start.position", &LENGTH, "Position of the piston at the start.").of_motion().not_negative(),
        key("start.velocity", &VELOCITY, "Velocity of the piston at the start.").of_motion(),
        key("start.pressure_a", &PRESSURE, "Pressure in chamber A at the start.").above(-101_325.0),
        key("start.pressure_b", &PRESSURE, "Pressure in chamber B at the start.").above(-101_325.0),
    ];
    keys.into_iter().map(|key| (key.name.to_string(), key)).collect()
}
