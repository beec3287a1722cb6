//! Simulation tasks: their source, and their consistency with the system.

use super::interface::{Observer, Outcome, Sampler, SimulationError};
use super::kernel::Kernel;
use super::{InputSchedule, Lane, SimulationCount, SimulationNumber};
use crate::range::RequiredRange;

/// Single simulation.
pub struct Task<'a, O> {
    /// State at time zero, optionally followed by the wave that entered each delay before. Without
    /// it, each wave is the one that the start sends while nothing arrives.
    pub start: Vec<f64>,
    /// Input schedule.
    pub schedule: &'a InputSchedule,
    /// Digital controller of the plant, if there is one.
    pub sampler: Option<Box<dyn Sampler + 'a>>,
    /// Receiver of the results.
    pub observer: O,
}

/// Source of simulations and receiver of their outcomes.
pub trait Queue<'a, E> {
    /// Receiver of the results of each machine.
    type Observer: Observer;

    /// Next machine: its parameters are set in this lane of the system, and its task is returned.
    /// `None` when there are no more.
    fn next(&mut self, system: &mut E, lane: usize) -> Option<Task<'a, Self::Observer>>;

    /// Receives the outcome of the simulation in this lane.
    fn done(&mut self, lane: usize, outcome: Outcome, observer: Self::Observer);

    /// Called once per step with the simulated time of a lane; false stops all lanes.
    fn continues(&mut self, lane: usize, time_s: f64) -> bool;
}

/// Checks that the machine in a lane can be driven by its task.
pub(super) fn check<S: Lane, O: Observer>(
    system: &dyn Kernel<S>,
    task: &Task<'_, O>,
    lane: usize,
    delays: &[f64],
) -> Result<(), SimulationError> {
    let InputSchedule { duration_s, output_step_s, inputs } = task.schedule;
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
