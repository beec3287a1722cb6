//! Simulation of one system under one input schedule, with every state recorded.

use super::driver::drive;
use super::task::{Queue, Task};
use super::{
    InputSchedule, Observer, Outcome, Sampler, SimulationCount, SimulationError, SimulationSettings, System,
};

/// States and inputs at the rows of a result.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times of the rows in s.
    pub times_s: Vec<f64>,
    /// All states at each time.
    pub states: Vec<Vec<f64>>,
    /// All inputs at each time; at a break, those after it.
    pub inputs: Vec<Vec<f64>>,
}

/// Result of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// Rows up to the end of the simulation.
    pub trajectory: Trajectory,
    /// Reason for the end, events and work.
    pub outcome: Outcome,
}

struct Recorder {
    wanted: Vec<usize>,
    trajectory: Trajectory,
}

impl Observer for Recorder {
    fn wanted(&self) -> &[usize] {
        &self.wanted
    }

    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]) {
        self.trajectory.times_s.push(time_s);
        self.trajectory.states.push(states.to_vec());
        self.trajectory.inputs.push(inputs.to_vec());
    }
}

/// Queue of one machine.
struct Single<'a, 'w, O> {
    task: Option<Task<'a, O>>,
    watch: &'w mut dyn FnMut(f64) -> bool,
    result: Option<(Outcome, O)>,
}

impl<'a, E, O: Observer> Queue<'a, E> for Single<'a, '_, O> {
    type Observer = O;

    fn next(&mut self, _system: &mut E, _lane: usize) -> Option<Task<'a, O>> {
        self.task.take()
    }

    fn done(&mut self, _lane: usize, outcome: Outcome, observer: O) {
        self.result = Some((outcome, observer));
    }

    fn continues(&mut self, _lane: usize, time_s: f64) -> bool {
        (self.watch)(time_s)
    }
}

/// Simulates one system according to its task, and returns its observer, which recorded the
/// required data of each row: no other data are stored. `watch` is called with the simulated time
/// after each step; if it returns false, the simulation stops.
///
/// # Errors
/// Errors of [`simulate`].
///
/// # Example
/// Largest force of a spring of 8 N/m whose end is drawn out at 2 m/s for 3 s, without its
/// trajectory:
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{InputSchedule, Observer, SimulationSettings, System, Task, drive_one};
/// #[derive(Clone)]
/// struct Drawn;
/// impl System<f64> for Drawn {
///     fn states(&self) -> usize {
///         1
///     }
///     fn inputs(&self) -> usize {
///         0
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0]
///     }
///     fn rates<T: Scalar + From<f64>>(&self, _state: &[T], _inputs: &[T], rates: &mut [T]) {
///         rates[0] = T::from(2.0);
///     }
/// }
/// struct Largest(f64);
/// impl Observer for Largest {
///     fn wanted(&self) -> &[usize] {
///         &[0]
///     }
///     fn observe(&mut self, _time_s: f64, states: &[f64], _inputs: &[f64]) {
///         self.0 = self.0.max(8.0 * states[0]);
///     }
/// }
/// let schedule = InputSchedule { duration_s: 3.0, output_step_s: 1e-3, inputs: vec![] };
/// let task = Task { start: vec![0.0], schedule: &schedule, sampler: None, observer: Largest(0.0) };
/// let (_, Largest(force_n)) = drive_one(&Drawn, task, &SimulationSettings::default(), &mut |_| true)?;
/// assert!((force_n - 48.0).abs() < 1e-9);
/// # Ok::<(), phea_dynamics::simulation::SimulationError>(())
/// ```
pub fn drive_one<'a, E: System<f64> + Clone, O: Observer>(
    system: &E,
    task: Task<'a, O>,
    settings: &SimulationSettings,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<(Outcome, O), SimulationError> {
    let mut queue = Single { task: Some(task), watch, result: None };
    drive(&mut system.clone(), &mut queue, settings)?;
    queue.result.ok_or(SimulationError::Count { what: SimulationCount::Results, found: 0, expected: 1 })
}

/// Simulates a system from its state at time zero (followed by the waves in transit, if given)
/// under an input schedule. `watch` is called with the simulated time after each step; if it
/// returns false, the simulation stops.
///
/// # Errors
/// [`SimulationError`] when start, input schedule or settings do not fit the system. A failure
/// during the simulation is in the status.
///
/// # Example
/// A mass of 2 kg on a spring of 8 N/m, pulled by 1 m and released
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{InputSchedule, SimulationSettings, Status, System, simulate};
/// #[derive(Clone)]
/// struct Oscillator;
/// impl System<f64> for Oscillator {
///     fn states(&self) -> usize {
///         2
///     }
///     fn inputs(&self) -> usize {
///         0
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0, 2.0]
///     }
///     fn rates<T: Scalar + From<f64>>(&self, state: &[T], _inputs: &[T], rates: &mut [T]) {
///         rates[0] = state[1];
///         rates[1] = T::from(-8.0) * state[0] / T::from(2.0);
///     }
/// }
/// let schedule = InputSchedule { duration_s: 3.0, output_step_s: 0.5, inputs: vec![] };
/// let settings = SimulationSettings { tolerance: 1e-9, ..SimulationSettings::default() };
/// let result = simulate(&Oscillator, &[1.0, 0.0], &schedule, None, &settings, &mut |_| true)?;
/// assert_eq!(result.outcome.status, Status::Completed);
/// for (time, state) in result.trajectory.times_s.iter().zip(&result.trajectory.states) {
///     assert!((state[0] - (2.0 * time).cos()).abs() < 1e-7);
/// }
/// # Ok::<(), phea_dynamics::simulation::SimulationError>(())
/// ```
pub fn simulate<E: System<f64> + Clone>(
    system: &E,
    start: &[f64],
    schedule: &InputSchedule,
    sampler: Option<Box<dyn Sampler + '_>>,
    settings: &SimulationSettings,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<Simulated, SimulationError> {
    let recorder = Recorder { wanted: (0..system.states()).collect(), trajectory: Trajectory::default() };
    let task = Task { start: start.to_vec(), schedule, sampler, observer: recorder };
    let (outcome, recorder) = drive_one(system, task, settings, watch)?;
    Ok(Simulated { trajectory: recorder.trajectory, outcome })
}
