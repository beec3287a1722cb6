//! Controller as executed by its computer: converters, noise, samples.

use std::cell::RefCell;

use phea_dynamics::controller::{ControllerInput, ControllerState};
use phea_dynamics::random;
use phea_dynamics::simulation::{FrozenWatch, Plant, Sampler};

use super::control::Sampled;
use super::frozen::{FrozenSample, least_stable};
use super::samples::{ControllerSample, ControllerSamples};

/// State of a sampled controller.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DigitalMemory {
    /// Last command, V.
    pub command_v: f64,
    /// States of its sections.
    pub memories: Vec<f64>,
    /// Position in its random numbers.
    pub random: u64,
}

/// Initial state of a sampled controller.
#[derive(Clone, Debug, PartialEq)]
pub enum Waking {
    /// State of rest.
    AtRest,
    /// State that holds a command while its inputs are constant.
    Holding {
        /// Inputs of the controller.
        read: ControllerInput,
        /// Command, V.
        command_v: f64,
    },
    /// State at the end of another run.
    Resumed(DigitalMemory),
}

/// Sampled controller in operation.
///
/// ```text
/// m = AD(y + n)                                    y the sensor output, n white noise, AD rounds and ends at its range
/// v = q round((v_m + n_v)/q)                       v_m the velocity sensor output, n_v white noise, q its resolution
/// p = p_m + n_p                                    p_m the pressure signal, n_p white noise
/// u = DA(limit(G (F r - m) + k v - H p))           k v the feed-forward, H p the pressure feedback, DA rounds
/// ```
pub struct Digital<'a> {
    sampled: &'a Sampled,
    state: ControllerState,
    random: u64,
    /// Command held before the first one takes effect, V.
    held: f64,
    /// Growth of the loop from sample to sample.
    watch: FrozenWatch,
    log: &'a RefCell<ControllerSamples>,
    /// Destination of its stored state.
    memory: Option<&'a RefCell<DigitalMemory>>,
}

impl<'a> Digital<'a> {
    /// Controller with this initial state.
    pub fn new(sampled: &'a Sampled, waking: &Waking, log: &'a RefCell<ControllerSamples>) -> Digital<'a> {
        let controller = &sampled.controller;
        let (state, held, random) = match waking {
            Waking::AtRest => (controller.at_rest(), 0.0, sampled.seed),
            Waking::Holding { read, command_v } => {
                (controller.holding_with(read, *command_v), *command_v, sampled.seed)
            }
            Waking::Resumed(memory) => {
                // a state from a file has as many memories as its controller
                let resumed = controller.resumed(&memory.memories).unwrap_or_else(|| controller.at_rest());
                (resumed, memory.command_v, memory.random)
            }
        };
        Digital { sampled, state, random, held, watch: FrozenWatch::default(), log, memory: None }
    }

    /// Stores its state after each sample.
    pub fn remembered_in(self, memory: &'a RefCell<DigitalMemory>) -> Digital<'a> {
        Digital { memory: Some(memory), ..self }
    }
}

impl Digital<'_> {
    /// Velocity of the load for the feedforward, m/s.
    fn velocity(&mut self, state: &[f64], inputs: &[f64]) -> f64 {
        let Sampled { held, velocity_noise, velocity_resolution, .. } = self.sampled;
        let states: usize = Plant::<f64>::states(held.plant());
        let mut velocity = held.plant().disturbance(&state[..states], &inputs[2..]);
        if *velocity_noise > 0.0 {
            velocity += velocity_noise * random::normal(&mut self.random);
        }
        match *velocity_resolution > 0.0 {
            true => velocity_resolution * (velocity / velocity_resolution).round(),
            false => velocity,
        }
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
        let Sampled { held, controller, noise, pressure_noise, feed_forward, .. } = self.sampled;
        let [reference, mut measurement, mut inner] = held.sampled(state, inputs);
        if *noise > 0.0 {
            measurement += noise * random::normal(&mut self.random);
        }
        if let Some(converter) = self.sampled.measurement_converter {
            measurement = converter.rounded(measurement);
        }
        let looked = self.watch.passes(1, time_s);
        let before = looked.then(|| self.state.clone());
        let mut added = 0.0;
        if *feed_forward != 0.0 {
            added = feed_forward * self.velocity(state, inputs);
        }
        if controller.reads_inner() && *pressure_noise > 0.0 {
            inner += pressure_noise * random::normal(&mut self.random);
        }
        let read = ControllerInput { reference, measurement, inner, added };
        let output = controller.step_with(&mut self.state, &read);
        if let Some(memory) = before {
            let sample = FrozenSample { state, inputs, memory, read: [reference, measurement, inner] };
            self.watch.take(time_s, least_stable(self.sampled, &sample));
            self.log.borrow_mut().amplification = self.watch.amplification();
        }
        let converter = self.sampled.command_converter;
        let command_v = converter.map_or(output.command, |converter| converter.rounded(output.command));
        self.log.borrow_mut().take(ControllerSample {
            time_s,
            filtered_reference_n: output.filtered_reference,
            command_v,
            unlimited_v: output.wanted,
            integral_v: output.integral,
            measurement_n: measurement,
            limited: output.limited,
        });
        if let Some(memory) = self.memory {
            let memories = self.state.memories();
            *memory.borrow_mut() = DigitalMemory { command_v, memories, random: self.random };
        }
        command_v
    }
}
