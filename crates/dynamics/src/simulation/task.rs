//! Simulation tasks: where they come from, and whether they fit the system.

use super::course::{Observer, Outcome, Sampler, SimulationError};
use super::kernel::Kernel;
use super::{InputSchedule, Lane, SimulationCount, SimulationNumber};
use crate::range::RequiredRange;

/// One simulation.
pub struct Task<'a, O> {
    /// State at time zero, followed, if given, by the wave that entered each delay before. If not
    /// given, each wave is what the start sends while nothing arrives.
    pub start: Vec<f64>,
    /// What it is driven by.
    pub course: &'a InputSchedule,
    /// A digital controller, if one commands it.
    pub sampler: Option<Box<dyn Sampler + 'a>>,
    /// What receives the results.
    pub observer: O,
}

/// Supplies simulations and takes their outcomes.
pub trait Queue<'a, E> {
    /// What receives the results of each machine.
    type Observer: Observer;

    /// The next machine: its parameters put into this lane of the system, and what is to be done
    /// with it. `None` when there are no more.
    fn next(&mut self, system: &mut E, lane: usize) -> Option<Task<'a, Self::Observer>>;

    /// Takes the outcome of the simulation in this lane.
    fn done(&mut self, lane: usize, outcome: Outcome, observer: Self::Observer);

    /// Called once per step with the simulated time of a lane; false stops all lanes.
    fn goes_on(&mut self, lane: usize, time_s: f64) -> bool;
}

/// True if a machine in its lane can be driven by its task.
pub(super) fn check<S: Lane, O: Observer>(
    system: &dyn Kernel<S>,
    task: &Task<'_, O>,
    lane: usize,
    delays: &[f64],
) -> Result<(), SimulationError> {
    let InputSchedule { duration_s, output_step_s, inputs } = task.course;
    let with_waves = system.states() + delays.len();
    let expected = if task.start.len() == with_waves { with_waves } else { system.states() };
    let scales = system.scales();
    let counts = [
        (SimulationCount::StartStates, task.start.len(), expected),
        (SimulationCount::Inputs, inputs.len() + delays.len(), system.inputs()),
        (SimulationCount::Scales, scales.len(), system.states()),
    ];
    for (what, found, expected) in counts {
        if found != expected {
            return Err(SimulationError::Count { what, found, expected });
        }
    }
    let states = system.states();
    if let Some(index) = task.observer.wanted().iter().find(|&&index| index >= states) {
        let what = SimulationCount::ObservedStates;
        return Err(SimulationError::Count { what, found: index + 1, expected: states });
    }
    let sample_time = task.sampler.as_ref().map(|sampler| sampler.sample_time_s());
    let delay = task.sampler.as_ref().map_or(0.0, |sampler| sampler.delay_s());
    let positive =
        [(SimulationNumber::Duration, *duration_s), (SimulationNumber::OutputStep, *output_step_s)];
    let sample = sample_time.map(|value| (SimulationNumber::SampleTime, value));
    let travel = delays.iter().map(|&delay| (SimulationNumber::WaveDelay, delay));
    let magnitudes = scales.iter().map(|scale| (SimulationNumber::StateScale, scale.lane(lane)));
    for (what, value) in positive.into_iter().chain(sample).chain(travel).chain(magnitudes) {
        if !(value > 0.0 && value.is_finite()) {
            return Err(SimulationError::Setting { what, value, requirement: RequiredRange::Positive });
        }
    }
    if !(delay >= 0.0 && delay.is_finite()) {
        let (what, requirement) = (SimulationNumber::CommandDelay, RequiredRange::ZeroOrPositive);
        return Err(SimulationError::Setting { what, value: delay, requirement });
    }
    match task.start.iter().enumerate().find(|(_, value)| !value.is_finite()) {
        Some((index, &value)) => Err(SimulationError::Start { index, value }),
        None => Ok(()),
    }
}
