//! Machine under its controller.

use std::ops::Range;

use phea_dynamics::simulation::{
    CommandedPlant, Observer, Outcome, Plant, Sensed, SimulationError, SimulationSettings, System, Task,
    drive_one,
};
use phea_hydraulics::machine::{InitialCondition, Machine};

use super::deployed::Deployed;

/// Observer of a run.
pub type Watcher<'a> = Box<dyn Observer + 'a>;

/// Machine as the plant of the controller, with its source of commands.
pub type Commanded<S = f64> = CommandedPlant<Sensed<Machine<S>>>;

/// Machine under its controller.
#[derive(Clone, Debug)]
pub enum Control {
    /// Continuous controller.
    Continuous(Box<Commanded>),
    /// Controller that acts once per sample.
    Sampled(Box<Sampled>),
    /// Machine without a controller: a stated command is applied to the valve.
    Open(Box<Commanded>),
}

/// Machine whose command is held between samples, and the computer that commands it.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// Machine with its hold.
    pub held: Commanded,
    /// Controller as the computer executes it.
    pub deployed: Deployed,
    /// Delay from a sample until its command takes effect, s.
    pub delay_s: f64,
    /// Largest magnitude of the command, V.
    pub command_limit: f64,
    /// Root mean square of the measurement noise, N.
    pub noise: f64,
    /// Root mean square of the noise of the velocity that is fed forward, m/s.
    pub velocity_noise: f64,
    /// Root mean square of the noise of the pressure signal that is fed back, Pa.
    pub pressure_noise: f64,
    /// Seed of the random numbers of the noise.
    pub seed: u64,
}

impl Control {
    /// Machine with its source of commands, which is a hold between samples.
    pub fn commanded(&self) -> &Commanded {
        match self {
            Control::Continuous(commanded) | Control::Open(commanded) => commanded,
            Control::Sampled(sampled) => &sampled.held,
        }
    }

    fn commanded_mut(&mut self) -> &mut Commanded {
        match self {
            Control::Continuous(commanded) | Control::Open(commanded) => commanded,
            Control::Sampled(sampled) => &mut sampled.held,
        }
    }

    /// Plant of the controller, including sensor and virtual impedance.
    pub fn sensed(&self) -> &Sensed<Machine> {
        self.commanded().plant()
    }

    /// Loop without its virtual impedance and the states of that impedance.
    #[must_use]
    pub fn without_impedance(mut self) -> Control {
        let sensed = self.commanded_mut().plant_mut();
        *sensed = sensed.clone().without_impedance();
        self
    }

    /// Indices of the states of its virtual impedance among those of the loop; empty without one.
    pub fn impedance_states(&self) -> Range<usize> {
        let sensed = self.sensed();
        let end = Plant::<f64>::states(sensed);
        end - sensed.impedance_states()..end
    }

    /// Sets the rest position of its virtual impedance to the position of the load in a state of
    /// the loop, with the load's ground there, m.
    pub fn rest_at(&self, state: &mut [f64], ground_m: f64) {
        let sensed = self.sensed();
        let mut inputs = vec![0.0; Plant::<f64>::inputs(sensed)];
        if let Some(ground) = inputs.first_mut() {
            *ground = ground_m;
        }
        sensed.rest_at(state, &inputs);
    }

    /// Control around another machine.
    #[must_use]
    pub fn around(mut self, machine: Machine) -> Control {
        *self.commanded_mut().plant_mut().plant_mut() = machine;
        self
    }

    /// Number of states and of inputs, including arriving waves.
    pub fn size(&self) -> [usize; 2] {
        let system = self.commanded();
        [System::<f64>::states(system), System::<f64>::inputs(system)]
    }

    /// Number of inputs before those of the machine: the reference; with a hold, the command and
    /// the reference.
    pub fn leading_inputs(&self) -> usize {
        self.commanded().leading_inputs()
    }

    /// Delays of the waves in transit, s.
    pub fn delays(&self) -> Vec<f64> {
        System::<f64>::delays(self.commanded())
    }

    /// Typical magnitude of each state, in its unit.
    pub fn scales(&self) -> Vec<f64> {
        System::<f64>::scales(self.commanded())
    }

    /// Time derivatives of all states, per second: for another solver of these equations.
    pub fn rates(&self, state: &[f64], inputs: &[f64], rates: &mut [f64]) {
        self.commanded().rates(state, inputs, rates);
    }

    /// Waves sent into the delays.
    pub fn outgoing(&self, state: &[f64], inputs: &[f64], waves: &mut [f64]) {
        self.commanded().outgoing(state, inputs, waves);
    }

    /// Indicators in a state: those of the machine are positive in ordinary operation, that of the
    /// command's limit is positive while the limit is reached.
    pub fn indicators(&self, state: &[f64], inputs: &[f64]) -> Vec<f64> {
        let system = self.commanded();
        let mut indicators = vec![1.0; System::<f64>::indicators(system)];
        system.indicate(state, inputs, &mut indicators);
        indicators
    }

    /// Waves in transit while the machine is in its initial state: those of its lines, and those
    /// between controller and sensor. `first` are the inputs before the machine's.
    pub fn under_way(&self, state: &[f64], first: &[f64], beginning: &InitialCondition) -> Vec<f64> {
        let system = self.commanded();
        let mut inputs = [first, &beginning.all_inputs()].concat();
        let (known, lines) = (inputs.len(), beginning.waves.len());
        inputs.resize(System::<f64>::inputs(system), 0.0);
        let mut sent = vec![0.0; System::<f64>::delays(system).len()];
        for _ in known..inputs.len() {
            system.outgoing(state, &inputs, &mut sent);
            for (input, wave) in inputs.iter_mut().skip(known).zip(sent.iter().skip(lines)) {
                *input = *wave;
            }
        }
        inputs.split_off(known - lines)
    }

    /// Simulates the loop under an input schedule; `watch` is called with the simulated time after
    /// each step and cancels the simulation by returning false.
    ///
    /// # Errors
    /// [`SimulationError`] if start or input schedule do not fit the machine.
    pub fn drive(
        &self,
        task: Task<'_, Watcher<'_>>,
        settings: &SimulationSettings,
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Result<Outcome, SimulationError> {
        let (outcome, _) = drive_one(self.commanded(), task, settings, watch)?;
        Ok(outcome)
    }
}
