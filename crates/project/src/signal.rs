//! Known functions of time that a scenario asks for: a reference force, an open-loop command, a force from outside.

use super::key::{key, plain};
use super::scenario::Published;
use super::visitor::Visitor;
use phea_quantity::{ANGLE, ANGULAR_FREQUENCY, Dimension, FORCE, TIME, VOLTAGE};

/// One part of a function of time; the parts add up, each zero before it begins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signal {
    /// Its shape in time.
    pub kind: SignalKind,
    /// s, of a step.
    pub at: Option<f64>,
    /// Of a step, which holds until the next; how far a ramp goes.
    pub value: Option<f64>,
    /// s, of several steps.
    pub times: Vec<f64>,
    /// Of several steps: each holds from its time until the next.
    pub values: Vec<f64>,
    /// s, when anything but a step begins; absent: at once.
    pub start: Option<f64>,
    /// s; a part that is over holds the value it ends with.
    pub duration: Option<f64>,
    /// Of a sine, a chirp, or each sine of a multisine.
    pub amplitude: Option<f64>,
    /// Of each sine of a multisine.
    pub amplitudes: Vec<f64>,
    /// rad/s, of a sine, or where a chirp begins.
    pub frequency: Option<f64>,
    /// rad/s, where a chirp ends.
    pub final_frequency: Option<f64>,
    /// rad/s, of a multisine.
    pub frequencies: Vec<f64>,
    /// rad, of a multisine; absent: Schroeder's, which keep its peak low.
    pub phases: Vec<f64>,
    /// A CSV file with time and value.
    pub file: Option<String>,
    /// What somebody published of a step of the reference, to stand beside the simulation's own.
    pub published: Option<Published>,
}

/// Shape of a signal in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SignalKind {
    /// A value that holds until the next step.
    #[default]
    Step,
    /// Several steps.
    Steps,
    /// At one rate from zero to a value.
    Ramp,
    /// Sine.
    Sine,
    /// Sine whose frequency moves evenly.
    Chirp,
    /// Several sines at once.
    Multisine,
    /// From a file.
    File,
}

/// As they are written.
const KINDS: &[(&str, Option<SignalKind>)] = &[
    ("step", Some(SignalKind::Step)),
    ("steps", Some(SignalKind::Steps)),
    ("ramp", Some(SignalKind::Ramp)),
    ("sine", Some(SignalKind::Sine)),
    ("chirp", Some(SignalKind::Chirp)),
    ("multisine", Some(SignalKind::Multisine)),
    ("file", Some(SignalKind::File)),
];

impl SignalKind {
    /// As it is written in the project file.
    pub fn name(self) -> &'static str {
        KINDS.iter().find(|(_, kind)| *kind == Some(self)).map_or("", |(name, _)| name)
    }
}

/// What a signal is of, and how its values are called.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SignalUnit {
    /// Key of one value.
    pub(crate) value: &'static str,
    /// Key of several.
    pub(crate) values: &'static str,
    pub(crate) dimension: &'static Dimension,
    /// Whether a step has room for what somebody published of it.
    published: bool,
}

impl SignalUnit {
    /// Of a reference.
    pub(crate) const REFERENCE: SignalUnit =
        SignalUnit { value: "force", values: "forces", dimension: &FORCE, published: true };
    /// Of a force on the load from outside.
    pub(crate) const EXTERNAL_FORCE: SignalUnit =
        SignalUnit { value: "force", values: "forces", dimension: &FORCE, published: false };
    /// Of an open-loop command.
    pub(crate) const COMMAND: SignalUnit =
        SignalUnit { value: "voltage", values: "voltages", dimension: &VOLTAGE, published: false };
}

impl Signal {
    /// When it begins, s; of several steps, the first.
    pub fn begins_s(&self) -> f64 {
        match self.kind {
            SignalKind::Step => self.at.unwrap_or(0.0),
            SignalKind::Steps => self.times.first().copied().unwrap_or(0.0),
            _ => self.start.unwrap_or(0.0),
        }
    }

    /// The times and values of its steps.
    pub fn steps(&self) -> Vec<(f64, f64)> {
        match self.kind {
            SignalKind::Step => self.at.zip(self.value).into_iter().collect(),
            SignalKind::Steps => self.times.iter().copied().zip(self.values.iter().copied()).collect(),
            _ => Vec::new(),
        }
    }

    /// Keys that its kind needs and those it may have besides; `amplitude` stands for `amplitudes` too.
    pub(crate) fn keys(&self, unit: SignalUnit) -> [Vec<&'static str>; 2] {
        let [needed, allowed]: [&[&'static str]; 2] = match self.kind {
            SignalKind::Step => [&["at", unit.value], &["published"]],
            SignalKind::Steps => [&["times", unit.values], &[]],
            SignalKind::Ramp => [&["duration", unit.value], &["start"]],
            SignalKind::Sine => [&["amplitude", "frequency"], &["start", "duration"]],
            SignalKind::Chirp => [&["amplitude", "frequency", "final_frequency", "duration"], &["start"]],
            SignalKind::Multisine => {
                [&["frequencies"], &["amplitude", "amplitudes", "phases", "start", "duration"]]
            }
            SignalKind::File => [&["file"], &["start"]],
        };
        [needed.to_vec(), allowed.to_vec()]
    }

    /// Every key that one kind or another has, and whether it is there.
    pub(crate) fn present(&self, unit: SignalUnit) -> [(&'static str, bool); 14] {
        [
            ("at", self.at.is_some()),
            (unit.value, self.value.is_some()),
            ("times", !self.times.is_empty()),
            (unit.values, !self.values.is_empty()),
            ("start", self.start.is_some()),
            ("duration", self.duration.is_some()),
            ("amplitude", self.amplitude.is_some()),
            ("amplitudes", !self.amplitudes.is_empty()),
            ("frequency", self.frequency.is_some()),
            ("final_frequency", self.final_frequency.is_some()),
            ("frequencies", !self.frequencies.is_empty()),
            ("phases", !self.phases.is_empty()),
            ("file", self.file.is_some()),
            ("published", self.published.is_some()),
        ]
    }

    /// Reads or prints it as what it is of.
    pub(crate) fn visitor<V: Visitor>(unit: SignalUnit) -> impl Fn(&mut Signal, &mut V) {
        move |signal, v| signal.visit(unit, v)
    }

    fn visit<V: Visitor>(&mut self, unit: SignalUnit, v: &mut V) {
        let of = unit.dimension;
        // a step is written without its kind
        let mut kind = Some(self.kind).filter(|kind| *kind != SignalKind::Step);
        v.choice(plain("kind", "Its shape in time; absent: a step."), KINDS, &mut kind, false);
        self.kind = kind.unwrap_or_default();
        v.optional(key("at", &TIME, "When a step comes.").not_negative(), &mut self.at);
        v.optional(key(unit.value, of, "Of a step, until the next; how far a ramp goes."), &mut self.value);
        v.quantities(
            key("times", &TIME, "When each of several steps comes.").not_negative(),
            &mut self.times,
        );
        v.quantities(key(unit.values, of, "Of several steps, each until the next."), &mut self.values);
        let k = key("start", &TIME, "When it begins; absent: at once.").not_negative();
        v.optional(k, &mut self.start);
        let k = key("duration", &TIME, "How long it moves; it holds the value it ends with.").positive();
        v.optional(k, &mut self.duration);
        let k = key("amplitude", of, "Of a sine, a chirp, or each sine of a multisine.").positive();
        v.optional(k, &mut self.amplitude);
        let k = key("amplitudes", of, "Of each sine of a multisine.").positive();
        v.quantities(k, &mut self.amplitudes);
        let k = key("frequency", &ANGULAR_FREQUENCY, "Of a sine, or where a chirp begins.").positive();
        v.optional(k, &mut self.frequency);
        let k = key("final_frequency", &ANGULAR_FREQUENCY, "Where a chirp ends.").positive();
        v.optional(k, &mut self.final_frequency);
        let k = key("frequencies", &ANGULAR_FREQUENCY, "Of the sines of a multisine.").positive();
        v.quantities(k, &mut self.frequencies);
        let k = key("phases", &ANGLE, "Of the sines of a multisine; absent: Schroeder's.");
        v.quantities(k, &mut self.phases);
        v.text(plain("file", "A CSV file with time and value."), &mut self.file, false);
        if unit.published {
            let k =
                plain("published", "Metrics somebody published of this step, for the report to set beside.");
            v.table(k, &mut self.published, Published::visit);
        }
    }
}
