//! Frequency response of a machine: from its exact derivatives, and from simulated sines until the
//! response has settled.

use num_complex::Complex64;
use phea_dynamics::scalar::Dual;
use phea_dynamics::simulation::{
    Input, Plant, Sampler, SimulationError, SimulationSettings, SinePlan, SineResponse, sine_response,
    small_signal,
};
use phea_hydraulics::machine::Machine;

use super::control::Control;

/// Excited machine, and its initial state.
pub struct Shaken<'a> {
    /// States at the start, followed by the waves in transit.
    pub start: &'a [f64],
    /// Inputs of the machine.
    pub inputs: Vec<Input>,
    /// Computer that commands it, if there is one.
    pub sampler: Option<Box<dyn Sampler + 'a>>,
    /// Accuracy of the simulation.
    pub settings: SimulationSettings,
    /// Duration of the simulation.
    pub plan: SinePlan,
}

impl Control {
    /// Response of the force on the load to a sine on an input; `watch` is called with the
    /// simulated time and cancels the simulation by returning false.
    ///
    /// # Errors
    /// [`SimulationError`] if start or inputs do not fit the machine.
    pub fn shaken(
        &self,
        shaken: Shaken<'_>,
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Result<SineResponse, SimulationError> {
        let Shaken { start, inputs, sampler, settings, plan } = shaken;
        let force = |state: &[f64], _: &[f64]| force(self.sensed().plant(), state);
        sine_response(self.commanded(), start, inputs, sampler, &settings, &plan, &force, watch)
    }

    /// Amplitudes of the states for a sine of amplitude one at the first input, by exact
    /// derivatives; `None` if they do not form a linear system.
    pub fn orbit(&self, state: &[f64], inputs: &[f64], frequency_rad_per_s: f64) -> Option<Vec<Complex64>> {
        let amplitude = [Complex64::ONE];
        small_signal(self.commanded(), state, inputs, &amplitude, frequency_rad_per_s)
    }
}

/// Force on the load at a state of a machine, or at the beginning of a longer vector; NaN for fewer
/// states.
///
/// # Example
/// The force at rest is that of the operating point; without a progressive spring, an amplitude j
/// times its state gives j times that force.
/// ```
/// # use num_complex::Complex64;
/// # use phea_dynamics::portable::magnitude;
/// # use phea_hydraulics::actuator::Actuator;
/// # use phea_hydraulics::machine::{Machine, MachineOptions};
/// # use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// # use phea_hydraulics::reference_rig::{components, hose_line};
/// # use phea_hydraulics::stiffness::StiffnessModel;
/// use phea_machine::{force, force_amplitude};
/// let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume))?;
/// let machine = Machine::new(&actuator, &MachineOptions::default())?;
/// let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(3e3)))?;
/// let beginning = machine.rest(&point)?;
/// assert!((force(&machine, &beginning.state) - 3e3).abs() < 1e-6);
/// let turned: Vec<Complex64> = beginning.state.iter().map(|state| Complex64::I * state).collect();
/// let amplitude = force_amplitude(&machine, &beginning.state, &turned);
/// assert!(magnitude(amplitude - Complex64::I * 3e3) < 1e-6);
/// assert!(force(&machine, &[]).is_nan());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn force(machine: &Machine, state: &[f64]) -> f64 {
    let own: usize = Plant::<f64>::states(machine);
    state.get(..own).map_or(f64::NAN, |state| Plant::<f64>::measurement(machine, state, &[]))
}

/// Complex amplitude of the force for small complex amplitudes of the states about a state of rest;
/// NaN for fewer states.
///
/// ```text
/// F^ = (dF/dy at y_0) y^
/// ```
pub fn force_amplitude(machine: &Machine, rest: &[f64], amplitudes: &[Complex64]) -> Complex64 {
    let own: usize = Plant::<f64>::states(machine);
    let moved: Vec<Dual<2>> = rest
        .iter()
        .zip(amplitudes)
        .take(own)
        .map(|(&value, amplitude)| Dual::new(value, [amplitude.re, amplitude.im]))
        .collect();
    if moved.len() < own {
        return Complex64::new(f64::NAN, f64::NAN);
    }
    let &[re, im] = Plant::<f64>::measurement(machine, &moved, &[]).gradient();
    Complex64::new(re, im)
}
