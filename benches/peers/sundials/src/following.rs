//! Simulation of a system of phea under an input schedule by CVODE, as a reference for phea's own
//! method.

use std::cell::RefCell;

use phea_dynamics::random;
use phea_dynamics::simulation::{Input, InputSchedule, Sampler, System};

use crate::waves::{Waves, integrate_delayed};
use crate::{CvodeError, Method, integrate};

/// Equations in the form that CVODE needs: every [`System`] has them, and code compiled elsewhere
/// may.
pub trait Equations {
    /// Number of states: [`System::states`].
    fn states(&self) -> usize;
    /// Number of inputs: [`System::inputs`].
    fn inputs(&self) -> usize;
    /// Scales of the states: [`System::scales`].
    fn scales(&self) -> Vec<f64>;
    /// Delays, s: [`System::delays`].
    fn delays(&self) -> Vec<f64>;
    /// Rates of the states: [`System::rates`].
    fn rates(&self, state: &[f64], inputs: &[f64], rates: &mut [f64]);
    /// Outgoing waves: [`System::outgoing`].
    fn outgoing(&self, state: &[f64], inputs: &[f64], waves: &mut [f64]);
    /// Called with the time before the rates there are computed. CVODE attempts one step for each
    /// such time.
    fn is_evaluated_at(&self, _time: f64) {}
}

impl<E: System<f64>> Equations for E {
    fn states(&self) -> usize {
        System::states(self)
    }

    fn inputs(&self) -> usize {
        System::inputs(self)
    }

    fn scales(&self) -> Vec<f64> {
        System::scales(self)
    }

    fn delays(&self) -> Vec<f64> {
        System::delays(self)
    }

    fn rates(&self, state: &[f64], inputs: &[f64], rates: &mut [f64]) {
        System::rates(self, state, inputs, rates);
    }

    fn outgoing(&self, state: &[f64], inputs: &[f64], waves: &mut [f64]) {
        System::outgoing(self, state, inputs, waves);
    }
}

/// Small errors added to a solution on purpose, to observe how they grow.
///
/// ```text
/// at 0, T, 2T, ...:    y_i -> y_i + e s_i scale_i,    s_i = +1 or -1 by chance
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kicks {
    /// Time T between them in s; positive.
    pub period_s: f64,
    /// Size e, relative to the scale of each state.
    pub size: f64,
    /// Seed of the signs.
    pub seed: u64,
}

/// Settings of the integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// Tolerance of one step of CVODE, relative to state plus scale.
    pub tolerance: f64,
    /// Method of CVODE's steps.
    pub method: Method,
    /// Errors added on purpose.
    pub kicks: Option<Kicks>,
}

impl Following {
    /// Settings without errors on purpose.
    pub fn new(tolerance: f64, method: Method) -> Following {
        Following { tolerance, method, kicks: None }
    }
}

/// States at each row of an input schedule, from time zero.
///
/// Equations, inputs, samples and held commands are those of
/// [`phea_dynamics::simulation::simulate`], solved by another method. CVODE restarts at each break
/// of an input, at each sample and where a command takes effect; the error is measured by the
/// tolerance times state and scale, as there. Delayed waves, given after the states at the start,
/// are stored as polynomials of degree eleven over an eighth of the shortest delay or less; CVODE
/// never steps beyond the waves that have been sent, and restarts where a break returns.
///
/// # Errors
///
/// Errors of [`integrate`]; [`CvodeError::Argument`] for a start that does not give every state and
/// every wave.
///
/// # Example
///
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{InputSchedule, Input, Profile, System};
/// use sundials::{Following, Method};
/// struct Lag;
/// impl System<f64> for Lag {
///     fn states(&self) -> usize {
///         1
///     }
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn scales(&self) -> Vec<f64> {
///         vec![1.0]
///     }
///     fn rates<T: Scalar + From<f64>>(&self, state: &[T], inputs: &[T], rates: &mut [T]) {
///         rates[0] = inputs[0] - state[0];
///     }
/// }
/// let inputs = vec![Input::Value(Profile::steps(0.0, &[(1.0, 5.0)]).unwrap())];
/// let schedule = InputSchedule { duration_s: 3.0, output_step_s: 1.0, inputs };
/// let rows = sundials::follow(&Lag, &[0.0], &schedule, None, &Following::new(1e-10, Method::Adams))?;
/// assert!((rows[3][0] - 5.0 * (1.0 - (-2.0f64).exp())).abs() < 1e-8);
/// # Ok::<(), sundials::CvodeError>(())
/// ```
pub fn follow(
    system: &dyn Equations,
    start: &[f64],
    schedule: &InputSchedule,
    mut sampler: Option<&mut dyn Sampler>,
    following: &Following,
) -> Result<Vec<Vec<f64>>, CvodeError> {
    let (delays, scales) = (system.delays(), system.scales());
    if start.len() != system.states() + delays.len() {
        return Err(CvodeError::Argument("the start must give each state and each wave"));
    }
    let (start, sent) = start.split_at(system.states());
    let waves = RefCell::new(Waves::new(delays, sent.to_vec()));
    let mut breaks = breaks(schedule);
    if !waves.borrow().is_empty() {
        breaks = waves.borrow().echoes(&breaks, schedule.duration_s);
    }
    let (mut rows, mut state, mut time) = (vec![start.to_vec()], start.to_vec(), 0.0);
    let mut held = Held { sample: 0, command: 0.0, pending: Vec::new() };
    let mut kicked = following.kicks.map(|kicks| Kicked { kicks, count: 0, chance: kicks.seed });
    let mut inputs = vec![0.0; system.inputs()];
    while time < schedule.duration_s {
        let mut until = schedule.duration_s;
        if let Some(kicked) = &mut kicked {
            until = until.min(kicked.act(time, &mut state, &scales));
        }
        if let Some(sampler) = &mut sampler {
            inputs_at(schedule, time, held.command, &waves.borrow(), &mut inputs);
            until = until.min(held.act(*sampler, time, &state, &inputs));
        }
        let command = held.command;
        let inputs_at =
            |time: f64, waves: &Waves, inputs: &mut [f64]| inputs_at(schedule, time, command, waves, inputs);
        let delayed = !waves.borrow().is_empty();
        if delayed {
            until = breaks.iter().copied().find(|stop| *stop > time).map_or(until, |stop| until.min(stop));
        }
        let times = times(schedule, time, until, rows.len());
        let states = if delayed {
            integrate_delayed(system, &inputs_at, &waves, &state, &times, following)?
        } else {
            continued(system, &inputs_at, &state, &times, following, &breaks)?
        };
        for (reached, row) in times.iter().zip(&states).skip(1) {
            if *reached >= rows.len() as f64 * schedule.output_step_s {
                rows.push(row.clone());
            }
        }
        (state, time) = (states.last().unwrap_or(&state).clone(), until);
    }
    Ok(rows)
}

/// The states at `times`, if nothing is delayed.
fn continued(
    system: &dyn Equations,
    inputs_at: &dyn Fn(f64, &Waves, &mut [f64]),
    state: &[f64],
    times: &[f64],
    following: &Following,
    breaks: &[f64],
) -> Result<Vec<Vec<f64>>, CvodeError> {
    let Following { tolerance, method, .. } = *following;
    let absolute: Vec<f64> = system.scales().iter().map(|scale| tolerance * scale).collect();
    let (none, mut inputs) = (Waves::new(Vec::new(), Vec::new()), vec![0.0; system.inputs()]);
    let mut rates = |time: f64, state: &[f64], rates: &mut [f64]| {
        inputs_at(time, &none, &mut inputs);
        system.is_evaluated_at(time);
        system.rates(state, &inputs, rates);
    };
    integrate(&mut rates, state, times, tolerance, &absolute, method, breaks)
}

/// Samples taken so far, the command in force, and pending commands with the times at which they
/// take effect.
struct Held {
    sample: u64,
    command: f64,
    pending: Vec<(f64, f64)>,
}

impl Held {
    /// Takes a sample if it is due, puts due commands into force, and returns the time of the next
    /// event.
    fn act(&mut self, sampler: &mut dyn Sampler, time: f64, state: &[f64], inputs: &[f64]) -> f64 {
        if time >= self.sample as f64 * sampler.sample_time_s() {
            self.sample += 1;
            self.pending.push((time + sampler.delay_s(), sampler.command(time, state, inputs)));
        }
        for &(_, command) in self.pending.iter().filter(|(due, _)| *due <= time) {
            self.command = command;
        }
        self.pending.retain(|(due, _)| *due > time);
        let next_sample = self.sample as f64 * sampler.sample_time_s();
        self.pending.iter().fold(next_sample, |next, (due, _)| next.min(*due))
    }
}

/// Number of past kicks, and the source of the signs of the next ones.
struct Kicked {
    kicks: Kicks,
    count: u64,
    chance: u64,
}

impl Kicked {
    /// Kicks the state if it is due, and returns the time of the next kick.
    fn act(&mut self, time: f64, state: &mut [f64], scales: &[f64]) -> f64 {
        let Kicks { period_s, size, .. } = self.kicks;
        if time >= self.count as f64 * period_s {
            self.count += 1;
            for (value, scale) in state.iter_mut().zip(scales) {
                let sign = if random::uniform(&mut self.chance) < 0.5 { -1.0 } else { 1.0 };
                *value += sign * size * scale;
            }
        }
        self.count as f64 * period_s
    }
}

fn inputs_at(schedule: &InputSchedule, time: f64, command: f64, waves: &Waves, inputs: &mut [f64]) {
    let (prescribed, arriving) = inputs.split_at_mut(schedule.inputs.len().min(inputs.len()));
    waves.arriving(time, arriving);
    for (place, input) in prescribed.iter_mut().zip(&schedule.inputs) {
        *place = match input {
            Input::Value(profile) => profile.value(time),
            Input::Rate(profile) => profile.rate(time),
            Input::Command => command,
        };
    }
}

fn breaks(schedule: &InputSchedule) -> Vec<f64> {
    let profiles = schedule.inputs.iter().filter_map(|input| match input {
        Input::Value(profile) | Input::Rate(profile) => Some(profile),
        Input::Command => None,
    });
    profiles.flat_map(|profile| profile.breaks().to_vec()).collect()
}

/// Times from one time to another, with the rows between them; the time of a row is its index times
/// the output step.
fn times(schedule: &InputSchedule, from: f64, until: f64, row: usize) -> Vec<f64> {
    let rows = (row..).map(|row| row as f64 * schedule.output_step_s);
    let between = rows.take_while(|time| *time < until).filter(|time| *time > from);
    std::iter::once(from).chain(between).chain([until]).collect()
}
