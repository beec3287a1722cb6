//! Simulation of a queue of systems.

use super::Drive;
use crate::range::RequiredRange;
use crate::scalar::{Dependence, Dual};
use crate::simulation::derivatives::DIRECTIONS;
use crate::simulation::interface::{SimulationError, SimulationSettings, Status};
use crate::simulation::slot::Slot;
use crate::simulation::task::Queue;
use crate::simulation::vector::can_drive;
use crate::simulation::{Lane, SimulationNumber, System};

/// Simulates every machine of a queue to its end. A lane whose machine is finished takes the next
/// one; each machine has its own time, step and breaks, and its outcome does not depend on its
/// neighbours.
///
/// # Errors
/// [`SimulationError`] when a task does not fit the system.
///
/// # Example
/// Two decays at 1/s and 2/s, one after the other in a single lane: after a second exp(-1) and
/// exp(-2) remain.
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{
///     InputSchedule, Observer, Outcome, Queue, SimulationError, SimulationSettings, System, Task, drive,
/// };
/// struct Decay(f64);
/// impl System<f64> for Decay {
///     fn states(&self) -> usize {
///         1
///     }
///     fn inputs(&self) -> usize {
///         0
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0]
///     }
///     fn rates<T: Scalar + From<f64>>(&self, state: &[T], _inputs: &[T], rates: &mut [T]) {
///         rates[0] = state[0].times(-self.0);
///     }
/// }
/// struct Blind;
/// impl Observer for Blind {
///     fn wanted(&self) -> &[usize] {
///         &[]
///     }
///     fn observe(&mut self, _time_s: f64, _states: &[f64], _inputs: &[f64]) {}
/// }
/// struct Decays<'a> {
///     schedule: &'a InputSchedule,
///     rates: Vec<f64>,
///     left: Vec<f64>,
/// }
/// impl<'a> Queue<'a, Decay> for Decays<'a> {
///     type Observer = Blind;
///     fn next(&mut self, decay: &mut Decay, _lane: usize) -> Option<Task<'a, Blind>> {
///         decay.0 = self.rates.pop()?;
///         Some(Task { start: vec![1.0], schedule: self.schedule, sampler: None, observer: Blind })
///     }
///     fn done(&mut self, _lane: usize, outcome: Outcome, _: Blind) {
///         self.left.push(outcome.end[0]);
///     }
///     fn continues(&mut self, _lane: usize, _time_s: f64) -> bool {
///         true
///     }
/// }
/// let schedule = InputSchedule { duration_s: 1.0, output_step_s: 1.0, inputs: vec![] };
/// let mut decays = Decays { schedule: &schedule, rates: vec![2.0, 1.0], left: vec![] };
/// drive::<f64, _, _>(&mut Decay(0.0), &mut decays, &SimulationSettings::default())?;
/// let [slow, fast] = decays.left[..] else { panic!("two decays") };
/// assert!((slow - f64::exp(-1.0)).abs() < 1e-5 && (fast - f64::exp(-2.0)).abs() < 1e-5);
/// # Ok::<(), SimulationError>(())
/// ```
pub fn drive<'a, S, E, Q>(
    system: &mut E,
    queue: &mut Q,
    settings: &SimulationSettings,
) -> Result<(), SimulationError>
where
    S: Lane,
    E: System<S>,
    Q: Queue<'a, E>,
    Dependence: From<S>,
    Dual<DIRECTIONS, S>: From<f64> + From<S>,
{
    let tolerance = settings.tolerance;
    if !(tolerance > 0.0 && tolerance < 1.0) {
        let (what, requirement) = (SimulationNumber::Tolerance, RequiredRange::BetweenZeroAndOne);
        return Err(SimulationError::Setting { what, value: tolerance, requirement });
    }
    if !can_drive::<S>() {
        return Err(SimulationError::NoVectors);
    }
    let mut drive = Drive::new(&*system, settings)?;
    let mut empty = false;
    loop {
        for lane in 0..S::COUNT {
            if drive.slots[lane].is_none() && !empty {
                match queue.next(system, lane) {
                    Some(task) => drive.enter(&*system, lane, task)?,
                    None => empty = true,
                }
            }
        }
        if drive.slots.iter().all(Option::is_none) {
            return Ok(());
        }
        drive.step(&*system);
        drive.limit_work();
        let mut running = drive.slots.iter().enumerate().filter_map(|(lane, slot)| {
            let passage = &slot.as_ref()?.passage;
            passage.status.is_none().then_some((lane, passage.time_s))
        });
        if !running.all(|(lane, time_s)| queue.continues(lane, time_s)) {
            empty = true;
            for Slot { passage, .. } in drive.slots.iter_mut().flatten() {
                passage.status.get_or_insert(Status::Cancelled { time_s: passage.time_s });
            }
        }
        for lane in 0..S::COUNT {
            if let Some((outcome, observer)) = drive.leave(lane) {
                queue.done(lane, outcome, observer);
            }
        }
    }
}
