//! Functions of time in a scenario: a reference force, an open-loop command, an external force, the
//! setting of accumulators.

use super::published::Published;
use phea_quantity::{ANGLE, ANGULAR_FREQUENCY, Dimension, FORCE, RATIO, TIME, VOLTAGE};
use phea_table::{Key, key, plain};
use phea_table::{Variants, Visitor};

/// Part of a function of time; the parts add up, each zero before it begins. Values and amplitudes
/// are in the unit of the signal, times in s, frequencies in rad/s. It begins immediately without a
/// start; after its duration it holds its final value.
#[derive(Clone, Debug, PartialEq)]
pub enum InputSignal {
    /// Step to a value that holds until the next step.
    Step {
        /// Time of the step.
        at: f64,
        /// Value after the step.
        value: f64,
        /// Published values for a step of the reference, for comparison with the simulation.
        published: Option<Published>,
    },
    /// Several steps.
    Steps {
        /// Times of the steps.
        times: Vec<f64>,
        /// Values, each from its time until the next.
        values: Vec<f64>,
    },
    /// Ramp from zero to a value.
    Ramp {
        /// Final value.
        value: f64,
        /// Start.
        start: Option<f64>,
        /// Duration.
        duration: f64,
    },
    /// Sine.
    Sine {
        /// Start.
        start: Option<f64>,
        /// Duration; if absent, to the end.
        duration: Option<f64>,
        /// Amplitude of the sine.
        amplitude: f64,
        /// Frequency of the sine.
        frequency: f64,
    },
    /// Sine whose frequency changes linearly.
    Chirp {
        /// Start.
        start: Option<f64>,
        /// Duration.
        duration: f64,
        /// Amplitude of the sine.
        amplitude: f64,
        /// Initial frequency.
        frequency: f64,
        /// Final frequency.
        final_frequency: f64,
    },
    /// Sum of several sines.
    Multisine(Multisine),
    /// Signal from a CSV file with time and value.
    File {
        /// Start.
        start: Option<f64>,
        /// Name of the file.
        file: String,
    },
}

/// Sum of several sines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multisine {
    /// Start, s; immediate if absent.
    pub start: Option<f64>,
    /// Duration, s; if absent, to the end.
    pub duration: Option<f64>,
    /// Amplitudes of the sines.
    pub amplitudes: Amplitudes,
    /// Frequencies, rad/s.
    pub frequencies: Vec<f64>,
    /// Phases, rad; if absent, Schroeder's phases, which keep the peak low.
    pub phases: Vec<f64>,
}

/// Amplitudes of the sines of a multisine.
#[derive(Clone, Debug, PartialEq)]
pub enum Amplitudes {
    /// Equal amplitudes.
    Equal(f64),
    /// Amplitude of each sine.
    Each(Vec<f64>),
}

impl Default for Amplitudes {
    fn default() -> Self {
        Amplitudes::Each(Vec::new())
    }
}

impl Default for InputSignal {
    fn default() -> Self {
        InputSignal::Step { at: 0.0, value: 0.0, published: None }
    }
}

/// Quantity of a signal, and the names of its values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InputUnit {
    /// Key of a single value.
    pub(crate) value: &'static str,
    /// Key of several values.
    pub(crate) values: &'static str,
    pub(crate) dimension: &'static Dimension,
    /// True if a step may have published values.
    published: bool,
    /// True if it acts on the load.
    on_load: bool,
}

impl InputUnit {
    /// Unit of a reference.
    pub(crate) const REFERENCE: InputUnit =
        InputUnit { value: "force", values: "forces", dimension: &FORCE, published: true, on_load: false };
    /// Unit of an external force on the load.
    pub(crate) const EXTERNAL_FORCE: InputUnit =
        InputUnit { value: "force", values: "forces", dimension: &FORCE, published: false, on_load: true };
    /// Unit of an open-loop command.
    pub(crate) const COMMAND: InputUnit = InputUnit {
        value: "voltage",
        values: "voltages",
        dimension: &VOLTAGE,
        published: false,
        on_load: false,
    };
    /// Unit of the setting of accumulators.
    pub(crate) const SETTING_CHANGE: InputUnit =
        InputUnit { value: "change", values: "changes", dimension: &RATIO, published: false, on_load: false };
}

/// Signal as written, which depends on its quantity.
#[derive(Clone)]
struct WrittenSignal {
    unit: InputUnit,
    signal: InputSignal,
}

impl Variants for WrittenSignal {
    const STRICT: bool = true;

    fn all(&self) -> Vec<WrittenSignal> {
        let (start, amplitude, frequency) = (None, 0.0, 0.0);
        let all = [
            InputSignal::default(),
            InputSignal::Steps { times: Vec::new(), values: Vec::new() },
            InputSignal::Ramp { value: 0.0, start, duration: 0.0 },
            InputSignal::Sine { start, duration: None, amplitude, frequency },
            InputSignal::Chirp { start, duration: 0.0, amplitude, frequency, final_frequency: 0.0 },
            InputSignal::Multisine(Multisine::default()),
            InputSignal::File { start, file: String::new() },
        ];
        all.map(|signal| WrittenSignal { unit: self.unit, signal }).into()
    }

    fn word(&self) -> &'static str {
        self.signal.kind()
    }

    fn goes_without_saying(&self) -> bool {
        matches!(self.signal, InputSignal::Step { .. })
    }

    fn visit<V: Visitor>(&mut self, v: &mut V) {
        let of = self.unit.dimension;
        let moving = |key: Key| if self.unit.on_load { key.of_load() } else { key.of_motion() };
        let level = moving(key(self.unit.value, of, "Of a step, until the next; how far a ramp goes."));
        let begins = key("start", &TIME, "When it begins; absent: at once.").not_negative();
        let how_long =
            key("duration", &TIME, "How long it moves; it holds the value it ends with.").positive();
        let size =
            moving(key("amplitude", of, "Of a sine, a chirp, or each sine of a multisine.").positive());
        let first = key("frequency", &ANGULAR_FREQUENCY, "Of a sine, or where a chirp begins.").positive();
        match &mut self.signal {
            InputSignal::Step { at, value, published } => {
                v.quantity(key("at", &TIME, "When a step comes.").not_negative(), at);
                v.quantity(level, value);
                if self.unit.published {
                    let doc =
                        "Published metrics of this step, which the report prints next to the computed ones.";
                    v.table(plain("published", doc), published, Published::visit);
                }
            }
            InputSignal::Steps { times, values } => {
                let k = key("times", &TIME, "When each of several steps comes.").not_negative();
                v.quantities(k, times, true);
                let k = moving(key(self.unit.values, of, "Of several steps, each until the next."));
                v.quantities(k, values, true);
            }
            InputSignal::Ramp { value, start, duration } => {
                v.quantity(level, value);
                v.optional(begins, start);
                v.quantity(how_long, duration);
            }
            InputSignal::Sine { start, duration, amplitude, frequency } => {
                v.optional(begins, start);
                v.optional(how_long, duration);
                v.quantity(size, amplitude);
                v.quantity(first, frequency);
            }
            InputSignal::Chirp { start, duration, amplitude, frequency, final_frequency } => {
                v.optional(begins, start);
                v.quantity(how_long, duration);
                v.quantity(size, amplitude);
                v.quantity(first, frequency);
                let k = key("final_frequency", &ANGULAR_FREQUENCY, "Where a chirp ends.").positive();
                v.quantity(k, final_frequency);
            }
            InputSignal::Multisine(sines) => {
                v.optional(begins, &mut sines.start);
                v.optional(how_long, &mut sines.duration);
                sines.amplitudes.visit(size, v);
                let k = key("frequencies", &ANGULAR_FREQUENCY, "Of the sines of a multisine.").positive();
                v.quantities(k, &mut sines.frequencies, true);
                let k = key("phases", &ANGLE, "Of the sines of a multisine; absent: Schroeder's.");
                v.quantities(k, &mut sines.phases, false);
            }
            InputSignal::File { start, file } => {
                v.optional(begins, start);
                let mut name = Some(std::mem::take(file));
                v.text(plain("file", "A CSV file with time and value."), &mut name, true);
                *file = name.unwrap_or_default();
            }
        }
    }
}

impl Amplitudes {
    /// Amplitude of each sine.
    pub fn of(&self, count: usize) -> Vec<f64> {
        match self {
            Amplitudes::Equal(amplitude) => vec![*amplitude; count],
            Amplitudes::Each(amplitudes) => amplitudes.clone(),
        }
    }

    fn visit<V: Visitor>(&mut self, size: Key, v: &mut V) {
        let (mut equal, mut each) = match std::mem::take(self) {
            Amplitudes::Equal(amplitude) => (Some(amplitude), Vec::new()),
            Amplitudes::Each(amplitudes) => (None, amplitudes),
        };
        v.optional(size, &mut equal);
        let k = Key { name: "amplitudes", doc: "Of each sine of a multisine.", ..size };
        v.quantities(k, &mut each, false);
        v.one_of(&["amplitude", "amplitudes"], true);
        *self = equal.map_or(Amplitudes::Each(each), Amplitudes::Equal);
    }
}

impl InputSignal {
    /// Word of the shape in the project file.
    pub fn kind(&self) -> &'static str {
        match self {
            InputSignal::Step { .. } => "step",
            InputSignal::Steps { .. } => "steps",
            InputSignal::Ramp { .. } => "ramp",
            InputSignal::Sine { .. } => "sine",
            InputSignal::Chirp { .. } => "chirp",
            InputSignal::Multisine(_) => "multisine",
            InputSignal::File { .. } => "file",
        }
    }

    /// Start of the signal, s; of several steps, the first.
    pub fn begins_s(&self) -> f64 {
        match self {
            InputSignal::Step { at, .. } => *at,
            InputSignal::Steps { times, .. } => times.first().copied().unwrap_or(0.0),
            InputSignal::Ramp { start, .. }
            | InputSignal::Sine { start, .. }
            | InputSignal::Chirp { start, .. }
            | InputSignal::Multisine(Multisine { start, .. })
            | InputSignal::File { start, .. } => start.unwrap_or(0.0),
        }
    }

    /// Duration, if stated, s.
    pub fn duration_s(&self) -> Option<f64> {
        match self {
            InputSignal::Ramp { duration, .. } | InputSignal::Chirp { duration, .. } => Some(*duration),
            InputSignal::Sine { duration, .. } | InputSignal::Multisine(Multisine { duration, .. }) => {
                *duration
            }
            InputSignal::Step { .. } | InputSignal::Steps { .. } | InputSignal::File { .. } => None,
        }
    }

    /// Times and values of its steps.
    pub fn steps(&self) -> Vec<(f64, f64)> {
        match self {
            InputSignal::Step { at, value, .. } => vec![(*at, *value)],
            InputSignal::Steps { times, values } => {
                times.iter().copied().zip(values.iter().copied()).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Published values, for a step of the reference.
    pub fn published(&self) -> Option<&Published> {
        if let InputSignal::Step { published, .. } = self { published.as_ref() } else { None }
    }

    /// Visitor that reads or prints it as a signal of its quantity.
    pub(crate) fn visitor<V: Visitor>(unit: InputUnit) -> impl Fn(&mut InputSignal, &mut V) {
        move |signal, v| {
            let mut written = WrittenSignal { unit, signal: std::mem::take(signal) };
            v.variant(plain("kind", "Its shape in time; absent: a step."), &mut written, false);
            *signal = written.signal;
        }
    }
}
