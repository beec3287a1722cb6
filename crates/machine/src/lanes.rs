//! Simulation of many machines, one after the other or one in each lane, each with its own time and
//! step.

use phea_dynamics::controller::{Controller, RateSensor, VirtualImpedance};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::scalar::{Lanes, Parameters};
use phea_dynamics::simulation::{
    CommandedPlant, Lane, Outcome, Queue, Sensed, SimulationError, SimulationSettings, Task, can_drive, drive,
};
use phea_hydraulics::machine::{Machine, MachineError};

use super::control::{Commanded, Control, Watcher};

/// Source of machines, and destination of their outcomes.
pub trait Fleet<'a> {
    /// Puts the next machine into its lane, and returns its task; `None` if there are no more.
    fn next(
        &mut self,
        lane: usize,
        put: &mut dyn FnMut(&Machine) -> Result<(), MachineError>,
    ) -> Option<Task<'a, Watcher<'a>>>;

    /// Receives the outcome of the machine in this lane.
    fn done(&mut self, lane: usize, outcome: Outcome);

    /// Progress callback, called once per step; return `false` to cancel.
    fn continues(&mut self) -> bool;
}

/// Simulates machines one by one until none remain. Simulations in lanes must agree with it.
///
/// # Errors
/// [`SimulationError`] if a task does not fit its machine.
///
/// # Example
/// Two machines that begin at rest stay at rest under their holding command:
/// ```
/// # use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::simulation::{
///     CommandedPlant, Input, InputSchedule, Observer, Outcome, Profile, Sensed, SimulationSettings, Task,
/// };
/// # use phea_hydraulics::actuator::Actuator;
/// # use phea_hydraulics::machine::{Machine, MachineOptions};
/// # use phea_hydraulics::operating_point::{Condition, SteadyLoad, operating_point};
/// # use phea_hydraulics::reference_rig::{components, hose_line};
/// # use phea_hydraulics::stiffness::StiffnessModel;
/// # use phea_hydraulics::machine::MachineError;
/// use phea_machine::{Control, Fleet, Watcher, force, one_by_one};
/// struct Blind;
/// impl Observer for Blind {
///     fn wanted(&self) -> &[usize] {
///         &[]
///     }
///     fn observe(&mut self, _time_s: f64, _states: &[f64], _inputs: &[f64]) {}
/// }
/// struct Pair<'a> {
///     machine: &'a Machine,
///     start: &'a [f64],
///     schedule: &'a InputSchedule,
///     left: usize,
///     ends: Vec<Vec<f64>>,
/// }
/// impl<'a> Fleet<'a> for Pair<'a> {
///     fn next(
///         &mut self,
///         _lane: usize,
///         put: &mut dyn FnMut(&Machine) -> Result<(), MachineError>,
///     ) -> Option<Task<'a, Watcher<'a>>> {
///         self.left = self.left.checked_sub(1)?;
///         put(self.machine).ok()?;
///         let observer: Watcher<'a> = Box::new(Blind);
///         Some(Task { start: self.start.to_vec(), schedule: self.schedule, sampler: None, observer })
///     }
///     fn done(&mut self, _lane: usize, outcome: Outcome) {
///         self.ends.push(outcome.end);
///     }
///     fn continues(&mut self) -> bool {
///         true
///     }
/// }
/// let actuator = Actuator::new(components(hose_line(), StiffnessModel::ByVolume))?;
/// let machine = Machine::new(&actuator, &MachineOptions::default())?;
/// let point = operating_point(&actuator, 0.2, Condition::Load(SteadyLoad::Force(3e3)))?;
/// let beginning = machine.rest(&point)?;
/// let direct = TransferFunction::gain_only(1.0);
/// let held = CommandedPlant::on_hold(Sensed::new(machine.clone(), &direct)?, &direct)?;
/// // command, reference, and position and velocity of the load
/// let held_inputs = [beginning.command, 0.0].into_iter().chain(beginning.inputs);
/// let inputs = held_inputs.map(|value| Input::Value(Profile::constant(value))).collect();
/// let schedule = InputSchedule { duration_s: 0.5, output_step_s: 0.1, inputs };
/// let mut pair = Pair { machine: &machine, start: &beginning.state, schedule: &schedule, left: 2, ends: vec![] };
/// one_by_one(&Control::Open(Box::new(held)), &mut pair, &SimulationSettings::default())?;
/// assert_eq!(pair.ends.len(), 2);
/// assert!(pair.ends.iter().all(|end| (force(&machine, end) - 3e3).abs() < 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn one_by_one<'a>(
    control: &Control,
    fleet: &mut dyn Fleet<'a>,
    settings: &SimulationSettings,
) -> Result<(), SimulationError> {
    drive::<f64, _, _>(&mut control.commanded().clone(), &mut Queued(fleet), settings)
}

/// Motion of the load in a loop of its force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FedMotion {
    /// Gain from the measured velocity to the command, V s/m; zero without feedforward.
    pub gain: f64,
    /// Sensor of the velocity.
    pub sensor: RateSensor,
    /// Contribution of the position to the measured force.
    pub impedance: VirtualImpedance,
}

/// Parallel machines, one in each lane, under one continuous controller or a stated command.
pub struct Lanewise(Box<Commanded<Lanes>>);

impl Lanewise {
    /// True if this processor has the vector instructions that lanes need; [`one_by_one`] gives the
    /// same bits without them.
    pub fn is_available() -> bool {
        can_drive::<Lanes>()
    }

    /// Lanes of machines built like this one, with this sensor, under a controller with its
    /// feedforward of the load velocity and its virtual impedance, or without one under a stated
    /// command.
    ///
    /// # Errors
    /// [`LinearError`] for a sensor or a controller that cannot be simulated.
    pub fn new(
        machine: &Machine,
        sensor: &TransferFunction,
        controller: Option<(&Controller, FedMotion)>,
    ) -> Result<Lanewise, LinearError> {
        let machine = machine.convert(&mut |value: f64| Lanes::from(value));
        let sensed = Sensed::new(machine, sensor)?;
        Ok(Lanewise(Box::new(match controller {
            Some((controller, FedMotion { gain, sensor, impedance })) => {
                let sensed = if gain == 0.0 { sensed } else { sensed.with_rate_sensor(&sensor)? };
                CommandedPlant::in_loop(sensed.with_impedance(&impedance)?, controller, gain)?
            }
            None => CommandedPlant::on_hold(sensed, &TransferFunction::gain_only(1.0))?,
        })))
    }

    /// Simulates machines until none remain.
    ///
    /// # Errors
    /// Errors of [`one_by_one`].
    pub fn in_lanes<'a>(
        &mut self,
        fleet: &mut dyn Fleet<'a>,
        settings: &SimulationSettings,
    ) -> Result<(), SimulationError> {
        drive(self.0.as_mut(), &mut Queued(fleet), settings)
    }
}

struct Queued<'f, 'a>(&'f mut dyn Fleet<'a>);

impl<'a, S: Lane> Queue<'a, Commanded<S>> for Queued<'_, 'a> {
    type Observer = Watcher<'a>;

    fn next(&mut self, system: &mut Commanded<S>, lane: usize) -> Option<Task<'a, Watcher<'a>>> {
        self.0.next(lane, &mut |machine| system.plant_mut().plant_mut().put(lane, machine))
    }

    fn done(&mut self, lane: usize, outcome: Outcome, _: Watcher<'a>) {
        self.0.done(lane, outcome);
    }

    fn continues(&mut self, _lane: usize, _time_s: f64) -> bool {
        self.0.continues()
    }
}
