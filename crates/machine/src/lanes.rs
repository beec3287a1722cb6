//! Many machines, one after the other or a machine in each lane, each with its own time and step.

use phea_dynamics::controller::Controller;
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_dynamics::scalar::Lanes;
use phea_dynamics::simulation::{
    CommandedPlant, Lane, Outcome, Queue, Sensed, SimulationError, SimulationSettings, Task, can_drive, drive,
};
use phea_hydraulics::machine::{Machine, MachineError};

use super::control::{Commanded, Control, Watcher};

/// Lanes of a vector: two registers of the widest kind that is common, which hide the time that
/// divisions and roots take.
const LANES: usize = 4;

/// The source of machines, and the destination of their outcomes.
pub trait Fleet<'a> {
    /// The next machine, put into its lane, with its task; `None` when there are no more.
    fn next(
        &mut self,
        lane: usize,
        put: &mut dyn FnMut(&Machine) -> Result<(), MachineError>,
    ) -> Option<Task<'a, Watcher<'a>>>;

    /// Takes the outcome of the machine in this lane.
    fn done(&mut self, lane: usize, outcome: Outcome);

    /// Called once per step: false ends everything.
    fn goes_on(&mut self) -> bool;
}

/// Simulates machines one by one until none are left. Simulations in lanes must agree with it.
///
/// # Errors
/// [`SimulationError`] when a task does not fit its machine.
pub fn one_by_one<'a>(
    control: &Control,
    fleet: &mut dyn Fleet<'a>,
    settings: &SimulationSettings,
) -> Result<(), SimulationError> {
    drive::<f64, _, _>(&mut control.commanded().clone(), &mut Queued(fleet), settings)
}

/// A machine in each lane, under one continuous controller or a stated command.
pub struct Lanewise(Box<Commanded<Lanes<LANES>>>);

impl Lanewise {
    /// Whether this processor has the vector instructions that lanes need; [`one_by_one`] gives the
    /// same bits without them.
    pub fn is_available() -> bool {
        can_drive::<Lanes<LANES>>()
    }

    /// Lanes of machines built like this one, with this sensor, under a controller with its
    /// feed-forward of the load velocity in V s/m, or without one under a stated command.
    ///
    /// # Errors
    /// [`LinearError`] for a sensor or a controller that cannot be simulated.
    pub fn new(
        machine: &Machine,
        sensor: &TransferFunction,
        controller: Option<(&Controller, f64)>,
    ) -> Result<Lanewise, LinearError> {
        let machine = machine.convert(&mut |value| Lanes([value; LANES]));
        let sensed = Sensed::new(machine, sensor)?;
        Ok(Lanewise(Box::new(match controller {
            Some((controller, gain)) => CommandedPlant::in_loop(sensed, controller, gain)?,
            None => CommandedPlant::on_hold(sensed, &TransferFunction::gain_only(1.0))?,
        })))
    }

    /// Simulates machines until none are left.
    ///
    /// # Errors
    /// As [`one_by_one`].
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

    fn goes_on(&mut self, _lane: usize, _time_s: f64) -> bool {
        self.0.goes_on()
    }
}
