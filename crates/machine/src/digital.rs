//! Controller as executed by its computer: converters, noise, samples.

use std::cell::RefCell;

use phea_dynamics::controller::ControllerInput;
use phea_dynamics::random;
use phea_dynamics::simulation::{FrozenWatch, Plant, Sampler};

use super::control::Sampled;
use super::deployed::{DeployedState, SampledSignals};
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

/// Sampled controller in operation: a [`super::Deployed`] that reads these signals.
///
/// ```text
/// y + n          y the output of the force sensor, n white noise
/// v_m + n_v      v_m the output of the velocity sensor, n_v white noise
/// p_m + n_p      p_m the pressure signal, n_p white noise
/// ```
pub struct Digital<'a> {
    sampled: &'a Sampled,
    state: DeployedState,
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
        let deployed = &sampled.deployed;
        let (state, random) = match waking {
            Waking::AtRest => (deployed.at_rest(), sampled.seed),
            Waking::Holding { read, command_v } => {
                let controller = deployed.controller.holding_with(read, *command_v);
                (DeployedState { controller, command_v: *command_v }, sampled.seed)
            }
            Waking::Resumed(memory) => {
                // a state from a file has as many memories as its controller
                let resumed = deployed.controller.resumed(&memory.memories);
                let controller = resumed.unwrap_or_else(|| deployed.controller.at_rest());
                (DeployedState { controller, command_v: memory.command_v }, memory.random)
            }
        };
        let held = state.command_v;
        Digital { sampled, state, random, held, watch: FrozenWatch::default(), log, memory: None }
    }

    /// Stores its state after each sample.
    pub fn remembered_in(self, memory: &'a RefCell<DigitalMemory>) -> Digital<'a> {
        Digital { memory: Some(memory), ..self }
    }
}

impl Digital<'_> {
    /// Value with white noise of this root mean square.
    fn noisy(&mut self, value: f64, noise: f64) -> f64 {
        if noise > 0.0 { value + noise * random::normal(&mut self.random) } else { value }
    }

    /// Signals of a sample, with their noise.
    fn reading(&mut self, state: &[f64], inputs: &[f64]) -> SampledSignals {
        let Sampled { held, deployed, .. } = self.sampled;
        let [reference, measurement, pressure] = held.sampled(state, inputs);
        let measurement = self.noisy(measurement, self.sampled.noise);
        let mut read = SampledSignals { reference, measurement, velocity: 0.0, pressure };
        if deployed.feed_forward != 0.0 {
            let states: usize = Plant::<f64>::states(held.plant());
            let velocity = held.plant().disturbance(&state[..states], &inputs[2..]);
            read.velocity = self.noisy(velocity, self.sampled.velocity_noise);
        }
        if deployed.controller.reads_inner() {
            read.pressure = self.noisy(pressure, self.sampled.pressure_noise);
        }
        read
    }
}

impl Sampler for Digital<'_> {
    fn sample_time_s(&self) -> f64 {
        self.sampled.deployed.controller.sample_time_s()
    }

    fn delay_s(&self) -> f64 {
        self.sampled.delay_s
    }

    fn held(&self) -> f64 {
        self.held
    }

    fn command(&mut self, time_s: f64, state: &[f64], inputs: &[f64]) -> f64 {
        let read = self.reading(state, inputs);
        let watched = self.watch.passes(1, time_s);
        let before = watched.then(|| self.state.controller.clone());
        let executed = self.sampled.deployed.step(&mut self.state, &read);
        if let Some(memory) = before {
            let read = [read.reference, executed.measurement, read.pressure];
            let sample = FrozenSample { state, inputs, memory, read };
            self.watch.take(time_s, least_stable(self.sampled, &sample));
            self.log.borrow_mut().amplification = self.watch.amplification();
        }
        self.log.borrow_mut().take(ControllerSample {
            time_s,
            filtered_reference_n: executed.output.filtered_reference,
            command_v: executed.command_v,
            unlimited_v: executed.output.wanted,
            integral_v: executed.output.integral,
            measurement_n: executed.measurement,
            limited: executed.output.limited,
        });
        if let Some(memory) = self.memory {
            let memories = self.state.controller.memories();
            let command_v = executed.command_v;
            *memory.borrow_mut() = DigitalMemory { command_v, memories, random: self.random };
        }
        executed.command_v
    }
}
