//! A machine under its controller.

use phea_dynamics::controller::{Converter, SampledController};
use phea_dynamics::simulation::{
    ClosedLoop, HeldPlant, Observer, Outcome, Sensed, Settings, SimulationError, System, Task, drive_one,
};
use phea_hydraulics::machine::{Beginning, Machine};

/// Who looks at a run.
pub type Watcher<'a> = Box<dyn Observer + 'a>;

/// A machine under its controller.
#[derive(Clone, Debug)]
pub enum Control {
    /// The controller acts continuously.
    Continuous(Box<ClosedLoop<Sensed<Machine>>>),
    /// It acts once a sample.
    Sampled(Box<Sampled>),
    /// There is none: a stated command goes to the valve.
    Open(Box<HeldPlant<Sensed<Machine>>>),
}

/// A machine behind a hold, and the computer that commands it.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// The machine behind its hold.
    pub held: HeldPlant<Sensed<Machine>>,
    /// G and F in z.
    pub controller: SampledController,
    /// From a sample until its command takes effect, s.
    pub delay_s: f64,
    /// Largest magnitude of the command, V.
    pub command_limit: f64,
    /// From the load's velocity to the command, V s/m.
    pub feed_forward: f64,
    /// Converter of the command, where it rounds.
    pub command_converter: Option<Converter>,
    /// Converter of the measurement, where it rounds.
    pub measurement_converter: Option<Converter>,
    /// Root mean square of the noise, N.
    pub noise: f64,
    /// Where the random numbers of the noise begin.
    pub seed: u64,
}

impl Control {
    /// The plant as the controller sees it.
    pub fn sensed(&self) -> &Sensed<Machine> {
        match self {
            Control::Continuous(closed) => closed.plant(),
            Control::Sampled(sampled) => sampled.held.plant(),
            Control::Open(held) => held.plant(),
        }
    }

    /// The same around another machine.
    #[must_use]
    pub fn around(mut self, machine: Machine) -> Control {
        match &mut self {
            Control::Continuous(closed) => *closed.plant_mut().plant_mut() = machine,
            Control::Sampled(sampled) => *sampled.held.plant_mut().plant_mut() = machine,
            Control::Open(held) => *held.plant_mut().plant_mut() = machine,
        }
        self
    }

    /// Number of states and of inputs, waves that arrive among them.
    pub fn size(&self) -> [usize; 2] {
        match self {
            Control::Continuous(closed) => size(closed.as_ref()),
            Control::Sampled(sampled) => size(&sampled.held),
            Control::Open(held) => size(held.as_ref()),
        }
    }

    /// How many inputs come before those of the machine: the reference; behind a hold the command and the reference.
    pub fn leading_inputs(&self) -> usize {
        match self {
            Control::Continuous(_) => 1,
            Control::Sampled(_) | Control::Open(_) => 2,
        }
    }

    /// Delays of the waves under way, s.
    pub fn delays(&self) -> Vec<f64> {
        match self {
            Control::Continuous(closed) => System::<f64>::delays(closed.as_ref()),
            Control::Sampled(sampled) => System::<f64>::delays(&sampled.held),
            Control::Open(held) => System::<f64>::delays(held.as_ref()),
        }
    }

    /// Indicators in a state: those of the machine are positive while all is well, that of the command's limit while it is reached.
    pub fn indicators(&self, state: &[f64], inputs: &[f64]) -> Vec<f64> {
        match self {
            Control::Continuous(closed) => indicators(closed.as_ref(), state, inputs),
            Control::Sampled(sampled) => indicators(&sampled.held, state, inputs),
            Control::Open(held) => indicators(held.as_ref(), state, inputs),
        }
    }

    /// The waves under way while the machine stands as it begins: those of its lines, and those that controller and sensor sent. `first` are
    /// the inputs before the machine's.
    pub fn under_way(&self, state: &[f64], first: &[f64], beginning: &Beginning) -> Vec<f64> {
        match self {
            Control::Continuous(closed) => under_way(closed.as_ref(), state, first, beginning),
            Control::Sampled(sampled) => under_way(&sampled.held, state, first, beginning),
            Control::Open(held) => under_way(held.as_ref(), state, first, beginning),
        }
    }

    /// Drives it through a course; `watch` is told the simulated time after each step, and ends it by false.
    ///
    /// # Errors
    /// [`SimulationError`] when start or course do not fit the machine.
    pub fn drive(
        &self,
        task: Task<'_, Watcher<'_>>,
        settings: &Settings,
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Outcome, SimulationError> {
        let (outcome, _) = match self {
            Control::Continuous(closed) => drive_one(closed.as_ref(), task, settings, watch),
            Control::Sampled(sampled) => drive_one(&sampled.held, task, settings, watch),
            Control::Open(held) => drive_one(held.as_ref(), task, settings, watch),
        }?;
        Ok(outcome)
    }
}

fn size(system: &impl System<f64>) -> [usize; 2] {
    [system.states(), system.inputs()]
}

fn indicators(system: &impl System<f64>, state: &[f64], inputs: &[f64]) -> Vec<f64> {
    let mut indicators = vec![1.0; system.indicators()];
    system.indicate(state, inputs, &mut indicators);
    indicators
}

/// What is under way in each delay: the waves of the lines, and then what sensor and controller sent until now, the one from
/// the other. `first` stands before the inputs of the machine.
fn under_way(system: &impl System<f64>, state: &[f64], first: &[f64], beginning: &Beginning) -> Vec<f64> {
    let mut inputs = [first, &beginning.all_inputs()].concat();
    let (known, lines) = (inputs.len(), beginning.waves.len());
    inputs.resize(system.inputs(), 0.0);
    let mut sent = vec![0.0; system.delays().len()];
    for _ in known..inputs.len() {
        system.outgoing(state, &inputs, &mut sent);
        for (input, wave) in inputs.iter_mut().skip(known).zip(sent.iter().skip(lines)) {
            *input = *wave;
        }
    }
    inputs.split_off(known - lines)
}
