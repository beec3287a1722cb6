//! Equilibrium of a loop: all simulated time derivatives are zero.

use phea_dynamics::scalar::Scalar;
use phea_dynamics::simulation::{EquilibriumError, Plant, System, equilibrium};
use phea_hydraulics::machine::InitialCondition;

use super::control::{Commanded, Control};

/// Constant inputs of a loop in equilibrium.
#[derive(Clone, Copy, Debug)]
pub struct HeldInputs {
    /// Reference, N.
    pub reference_n: f64,
    /// Command of an open loop, V.
    pub command_v: f64,
    /// External force on the load, N, if the machine has that input.
    pub external_n: f64,
    /// Change of the setting of accumulators, if the machine has that input.
    pub setting_change: f64,
}

/// Loop in equilibrium.
#[derive(Clone, Debug)]
pub struct Rest {
    /// States of the loop, and the waves in transit.
    pub start: Vec<f64>,
    /// Measurement of the controller, N.
    pub measured_n: f64,
    /// Pressure signal that the controller may feed back, Pa.
    pub inner_pa: f64,
    /// Command of the controller, V.
    pub command_v: f64,
    /// Largest magnitude of the command, V.
    pub limit_v: f64,
}

/// Equilibrium of a loop under constant inputs, near a guess of its states; `beginning` is the
/// state of its machine there. The load is then at the rest position of its virtual impedance, if
/// there is one, which [`Control::rest_at`] sets.
///
/// # Errors
/// [`EquilibriumError`] if none is found.
///
/// # Example
/// The loop with an integrating controller rests at a force equal to its reference, 2 kN, instead
/// of the 3 kN of the guess:
/// ```
/// # use phea_dynamics::controller::{Compensator, Controller, Element};
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::simulation::{CommandedPlant, Sensed};
/// # use phea_hydraulics::actuator::Actuator;
/// # use phea_hydraulics::machine::{Machine, MachineOptions};
/// # use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// # use phea_hydraulics::reference_rig::{components, hose_line};
/// # use phea_hydraulics::stiffness::StiffnessModel;
/// use phea_machine::{Control, HeldInputs, at_rest, force};
/// let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume))?;
/// let machine = Machine::new(&actuator, &MachineOptions::default())?;
/// let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(3e3)))?;
/// let beginning = machine.rest(&point)?;
/// let law = Element::ProportionalIntegral { proportional_gain: 1e-4, integral_gain: 1e-3 };
/// let controller = Controller { feedback: Compensator::new(vec![law]), ..Controller::default() };
/// let sensed = Sensed::new(machine.clone(), &TransferFunction::gain_only(1.0))?;
/// let closed = CommandedPlant::in_loop(sensed, &controller, 0.0)?;
/// let guess = [beginning.state.clone(), closed.controller_at_rest(2e3, [3e3, 0.0], beginning.command)].concat();
/// let held_inputs = HeldInputs { reference_n: 2e3, command_v: 0.0, external_n: 0.0, setting_change: 0.0 };
/// let rest = at_rest(&Control::Continuous(Box::new(closed)), &guess, &beginning, held_inputs)?;
/// assert!((rest.measured_n - 2e3).abs() < 1e-3 && (force(&machine, &rest.start) - 2e3).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn at_rest(
    control: &Control,
    guess: &[f64],
    beginning: &InitialCondition,
    held_inputs: HeldInputs,
) -> Result<Rest, EquilibriumError> {
    let beside = control.impedance_states();
    if !beside.is_empty() {
        let other = [&guess[..beside.start], &guess[beside.end..]].concat();
        let mut rest = at_rest(&control.clone().without_impedance(), &other, beginning, held_inputs)?;
        rest.start.splice(beside.start..beside.start, vec![0.0; beside.len()]);
        return Ok(rest);
    }
    let machine = control.sensed().plant();
    let [ground, _] = beginning.inputs;
    let mut kept = machine.memories();
    kept.extend(machine.shut_gas(held_inputs.setting_change));
    let mut inputs = vec![held_inputs.reference_n, ground, 0.0];
    inputs.extend(machine.has_external_force().then_some(held_inputs.external_n));
    inputs.extend(
        machine.has_moving_setting().then_some([held_inputs.setting_change, 0.0]).into_iter().flatten(),
    );
    Ok(match control {
        Control::Open(commanded) | Control::Continuous(commanded) => {
            if let Control::Open(_) = control {
                inputs.insert(0, held_inputs.command_v);
            }
            let free = commanded.as_ref().clone().unlimited();
            let start = equilibrium(&free, guess, &inputs, &kept)?;
            let (state, waves) = start.split_at(System::<f64>::states(&free));
            let all = [inputs.as_slice(), waves].concat();
            let signals = free.signals::<f64, f64>(state, &all);
            let [_, measured_n, inner_pa] = free.sampled::<f64, f64>(state, &all);
            let limit_v = commanded.limit();
            Rest { measured_n, inner_pa, command_v: signals.wanted, limit_v, start }
        }
        Control::Sampled(sampled) => {
            let controller = &sampled.deployed.controller;
            let (gains, inner_gain) = (controller.steady_gains(), controller.steady_inner_gain());
            let resting = RestingMachine { held: &sampled.held, gains, inner_gain };
            let mut guess = guess.to_vec();
            let states = System::<f64>::states(&sampled.held);
            guess.insert(states, beginning.command);
            let mut start = equilibrium(&resting, &guess, &inputs, &kept)?;
            let command_v = start.remove(states);
            let (state, waves) = start.split_at(states);
            let all = [&[command_v][..], &inputs, waves].concat();
            let [_, measured_n, inner_pa] = sampled.held.sampled::<f64, f64>(state, &all);
            Rest { measured_n, inner_pa, command_v, limit_v: sampled.command_limit, start }
        }
    })
}

/// Machine whose command is held by a controller in steady state.
///
/// ```text
/// 0 = F(1) r - m                             if the controller integrates
/// 0 = G(1) (F(1) r - m) - H(1) p - u         if it does not
/// ```
///
/// The last state is the command u.
struct RestingMachine<'a> {
    held: &'a Commanded,
    /// Steady gains F(1) and G(1).
    gains: [Option<f64>; 2],
    /// Steady gain H(1) of the pressure feedback.
    inner_gain: f64,
}

impl System<f64> for RestingMachine<'_> {
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
        let [reference, measurement, inner] = self.held.sampled::<f64, T>(state, &inputs);
        let [of_prefilter, of_feedback] = self.gains;
        let error = reference.times(of_prefilter.unwrap_or(0.0)) - measurement;
        *closing =
            of_feedback.map_or(error, |gain| error.times(gain) - inner.times(self.inner_gain) - command);
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
