//! The closed loop at rest: where a scenario begins that states no start.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{EquilibriumError, HeldPlant, Plant, Sensed, System, equilibrium};
use phea_hydraulics::machine::{Beginning, Machine, SIGNALS};

use super::SimulateError;
use super::bench::{Bench, Control};

/// What stands still while a loop rests.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    pub(super) reference_n: f64,
    /// Of an open loop.
    pub(super) command_v: f64,
    /// On the load from outside, where the machine has that input.
    pub(super) external_n: f64,
}

/// A loop in equilibrium.
pub(super) struct Rest {
    /// States of the loop, and the waves under way.
    pub(super) start: Vec<f64>,
    /// Position of the load's ground, m.
    pub(super) ground_m: f64,
    /// What the controller measures, N, and what it gives out, V.
    pub(super) measured_n: f64,
    pub(super) command_v: f64,
}

/// The rest of the loop under what stands still, with the piston where the guess has it: the rates that are simulated, all zero.
pub(super) fn rest(
    bench: &Bench,
    guess: &[f64],
    beginning: &Beginning,
    standing: Standing,
    name: &str,
) -> Result<Rest, SimulateError> {
    let Standing { reference_n, command_v, external_n } = standing;
    let named = |error| match error {
        EquilibriumError::NotFound { state, rate } => {
            SimulateError::NoRest { name: name.to_string(), reference_n, what: what(state), rate }
        }
        error => SimulateError::Rest { name: name.to_string(), error },
    };
    let [ground, _] = beginning.inputs;
    let kept = bench.machine.memories();
    let mut inputs = vec![reference_n, ground, 0.0];
    inputs.extend(bench.machine.has_external_force().then_some(external_n));
    let limit;
    let mut rest = match &bench.control {
        Control::Open(held) => {
            limit = f64::INFINITY;
            inputs.insert(0, command_v);
            let start = equilibrium(held.as_ref(), guess, &inputs, &kept).map_err(named)?;
            let (state, waves) = start.split_at(System::<f64>::states(held.as_ref()));
            let [_, measured_n] = held.sampled::<f64, f64>(state, &[inputs.as_slice(), waves].concat());
            Rest { ground_m: ground, measured_n, command_v, start }
        }
        Control::Continuous(closed) => {
            limit = closed.limit();
            let free = closed.as_ref().clone().unlimited();
            let start = equilibrium(&free, guess, &inputs, &kept).map_err(named)?;
            let (state, waves) = start.split_at(System::<f64>::states(&free));
            let all = [inputs.as_slice(), waves].concat();
            let signals = free.signals::<f64, f64>(state, &all);
            Rest { ground_m: ground, measured_n: signals.measurement, command_v: signals.wanted, start }
        }
        Control::Sampled(sampled) => {
            limit = sampled.command_limit;
            let resting = Resting { held: &sampled.held, gains: sampled.controller.steady_gains() };
            let mut guess = guess.to_vec();
            let states = System::<f64>::states(&sampled.held);
            guess.insert(states, beginning.command);
            let mut start = equilibrium(&resting, &guess, &inputs, &kept).map_err(named)?;
            let command_v = start.remove(states);
            let (state, waves) = start.split_at(states);
            let all = [&[command_v][..], &inputs, waves].concat();
            let [_, measured_n] = sampled.held.sampled::<f64, f64>(state, &all);
            Rest { ground_m: ground, measured_n, command_v, start }
        }
    };
    if rest.command_v.abs() > limit {
        let (name, command_v) = (name.to_string(), rest.command_v);
        return Err(SimulateError::RestBeyondLimit { name, reference_n, command_v, limit_v: limit });
    }
    // nothing but its position knows where the ground lies
    let place = SIGNALS.iter().position(|signal| *signal == "position_m");
    let own = beginning.all_inputs();
    let position =
        |start: &[f64]| place.map_or(0.0, |place| bench.machine.outputs::<f64>(start, &own)[place]);
    rest.ground_m -= position(&rest.start) - position(&beginning.state);
    Ok(rest)
}

/// A state in words, by its place: [`phea_hydraulics::machine::MachineState`].
fn what(state: usize) -> &'static str {
    let first = [
        "the spool",
        "the spool",
        "the pressure of chamber A",
        "the pressure of chamber B",
        "the force",
        "the piston",
    ];
    first.get(state).copied().unwrap_or("a state beside force, pressures and spool")
}

/// A machine behind a hold under a controller that stands still.
///
/// ```text
/// 0 = F(1) r - m                 where the controller integrates
/// 0 = G(1) (F(1) r - m) - u      where it does not
/// ```
///
/// Its last state is the command u.
struct Resting<'a> {
    held: &'a HeldPlant<Sensed<Machine>>,
    /// F(1) and G(1).
    gains: [Option<f64>; 2],
}

impl System<f64> for Resting<'_> {
    fn states(&self) -> usize {
        System::<f64>::states(self.held) + 1
    }

    fn inputs(&self) -> usize {
        System::<f64>::inputs(self.held) - 1
    }

    fn scales(&self) -> Vec<f64> {
        let command = Plant::<f64>::command_scale(self.held.plant());
        System::<f64>::scales(self.held).into_iter().chain([command]).collect()
    }

    fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
        let Some((&command, state)) = state.split_last() else { return };
        let Some((closing, rates)) = rates.split_last_mut() else { return };
        let inputs = [&[command][..], inputs].concat();
        self.held.rates(state, &inputs, rates);
        let [reference, measurement] = self.held.sampled::<f64, T>(state, &inputs);
        let [of_prefilter, of_feedback] = self.gains;
        let error = reference.times(of_prefilter.unwrap_or(0.0)) - measurement;
        *closing = of_feedback.map_or(error, |gain| error.times(gain) - command);
    }

    fn delays(&self) -> Vec<f64> {
        System::<f64>::delays(self.held)
    }

    fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], waves: &mut [T]) {
        let Some((&command, state)) = state.split_last() else { return };
        let inputs = [&[command][..], inputs].concat();
        self.held.outgoing(state, &inputs, waves);
    }
}
