//! The controller as its computer runs it: converters, noise, samples.

use std::cell::RefCell;

use phea_dynamics::controller::ControllerState;
use phea_dynamics::random;
use phea_dynamics::simulation::{Plant, Sampler};

use super::bench::Sampled;

/// What happened at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) time_s: f64,
    /// Behind the prefilter, N.
    pub(crate) filtered_reference_n: f64,
    /// What the computer gives out, V.
    pub(crate) command_v: f64,
    pub(crate) limited: bool,
}

/// What is kept of a sampled controller on the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Samples {
    /// The last one.
    pub(crate) last: Option<Sample>,
    /// When the command came to its limit (`true`) or left it, s.
    pub(crate) limits: Vec<(f64, bool)>,
}

impl Samples {
    fn take(&mut self, sample: Sample) {
        let before = self.last.is_some_and(|last| last.limited);
        if before != sample.limited {
            self.limits.push((sample.time_s, sample.limited));
        }
        self.last = Some(sample);
    }
}

/// A sampled controller at work.
///
/// ```text
/// m = AD(y + n)                                    y the sensor's, n white noise, AD rounds and ends at its range
/// u = DA(limit(G (F r - m) + k v_L))               k v_L the feed-forward, DA rounds
/// ```
pub(crate) struct Digital<'a> {
    sampled: &'a Sampled,
    state: ControllerState,
    random: u64,
    /// Before its first command takes effect, V.
    held: f64,
    log: &'a RefCell<Samples>,
}

impl<'a> Digital<'a> {
    /// At rest, or holding a command while reference and measurement stand still.
    pub(crate) fn new(
        sampled: &'a Sampled,
        holding: Option<[f64; 3]>,
        log: &'a RefCell<Samples>,
    ) -> Digital<'a> {
        let state = match holding {
            Some([reference, measurement, command]) => {
                sampled.controller.holding(reference, measurement, command)
            }
            None => sampled.controller.at_rest(),
        };
        let held = holding.map_or(0.0, |[_, _, command]| command);
        Digital { sampled, state, random: sampled.seed, held, log }
    }
}

impl Sampler for Digital<'_> {
    fn sample_time_s(&self) -> f64 {
        self.sampled.controller.sample_time_s()
    }

    fn delay_s(&self) -> f64 {
        self.sampled.delay_s
    }

    fn held(&self) -> f64 {
        self.held
    }

    fn command(&mut self, time_s: f64, state: &[f64], inputs: &[f64]) -> f64 {
        let Sampled { held, controller, converters, noise, feed_forward, command_limit, .. } = self.sampled;
        let [reference, mut measurement] = held.sampled(state, inputs);
        if *noise > 0.0 {
            measurement += noise * random::normal(&mut self.random);
        }
        if let Some(converter) = converters.measurement {
            measurement = converter.rounded(measurement);
        }
        let output = controller.step(&mut self.state, reference, measurement);
        let mut wanted = output.command;
        if *feed_forward != 0.0 {
            let states: usize = Plant::<f64>::states(held.plant());
            wanted += feed_forward * held.plant().disturbance(&state[..states], &inputs[2..]);
        }
        let within = wanted.clamp(-command_limit, *command_limit);
        let command_v = converters.command.map_or(within, |converter| converter.rounded(within));
        self.log.borrow_mut().take(Sample {
            time_s,
            filtered_reference_n: output.filtered_reference,
            command_v,
            limited: output.limited || within != wanted,
        });
        command_v
    }
}
