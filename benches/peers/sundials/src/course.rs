//! A system of phea driven through a course by CVODE: what its own method is held against.

use phea_dynamics::simulation::{Course, Input, Sampler, System};

use crate::{CvodeError, Method, integrate};

/// The states at each row of a course, from time zero.
///
/// The same equations, inputs, samples and held commands as in [`phea_dynamics::simulation::simulate`], on another
/// method. CVODE starts anew at each break of an input, at each sample and where a command takes effect; the error is
/// measured by `tolerance` times state and scale, as there.
///
/// # Errors
///
/// As [`integrate`]; [`CvodeError::Argument`] for a system with delayed waves, whose history CVODE does not keep.
///
/// # Example
///
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{Course, Input, Profile, System};
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
/// let course = Course { duration_s: 3.0, output_step_s: 1.0, inputs };
/// let rows = sundials::follow(&Lag, &[0.0], &course, None, 1e-10, sundials::Method::Adams)?;
/// assert!((rows[3][0] - 5.0 * (1.0 - (-2.0f64).exp())).abs() < 1e-8);
/// # Ok::<(), sundials::CvodeError>(())
/// ```
pub fn follow<E: System<f64>>(
    system: &E,
    start: &[f64],
    course: &Course,
    mut sampler: Option<&mut dyn Sampler>,
    tolerance: f64,
    method: Method,
) -> Result<Vec<Vec<f64>>, CvodeError> {
    if !system.delays().is_empty() {
        return Err(CvodeError::Argument("the system has delayed waves"));
    }
    let absolute: Vec<f64> = system.scales().iter().map(|scale| tolerance * scale).collect();
    let breaks = breaks(course);
    let (mut rows, mut state, mut time) = (vec![start.to_vec()], start.to_vec(), 0.0);
    let mut held = Held { sample: 0, command: 0.0, pending: Vec::new() };
    while time < course.duration_s {
        let mut inputs = vec![0.0; course.inputs.len()];
        let mut until = course.duration_s;
        if let Some(sampler) = &mut sampler {
            inputs_at(course, time, held.command, &mut inputs);
            until = until.min(held.act(*sampler, time, &state, &inputs));
        }
        let mut rates = |time: f64, state: &[f64], rates: &mut [f64]| {
            inputs_at(course, time, held.command, &mut inputs);
            system.rates(state, &inputs, rates);
        };
        let times = times(course, time, until, rows.len());
        let states = integrate(&mut rates, &state, &times, tolerance, &absolute, method, &breaks)?;
        for (reached, row) in times.iter().zip(&states).skip(1) {
            if *reached >= rows.len() as f64 * course.output_step_s {
                rows.push(row.clone());
            }
        }
        (state, time) = (states.last().unwrap_or(&state).clone(), until);
    }
    Ok(rows)
}

/// Samples taken, the command in force, and commands on their way with the time that they take effect.
struct Held {
    sample: u64,
    command: f64,
    pending: Vec<(f64, f64)>,
}

impl Held {
    /// Samples if it is time to, puts due commands into force, and tells when something happens next.
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

fn inputs_at(course: &Course, time: f64, command: f64, inputs: &mut [f64]) {
    for (place, input) in inputs.iter_mut().zip(&course.inputs) {
        *place = match input {
            Input::Value(profile) => profile.value(time),
            Input::Rate(profile) => profile.rate(time),
            Input::Command => command,
        };
    }
}

fn breaks(course: &Course) -> Vec<f64> {
    let profiles = course.inputs.iter().filter_map(|input| match input {
        Input::Value(profile) | Input::Rate(profile) => Some(profile),
        Input::Command => None,
    });
    profiles.flat_map(|profile| profile.breaks().to_vec()).collect()
}

/// From one time to another, over the rows between them; a row is as many output steps from zero as there are before it.
fn times(course: &Course, from: f64, until: f64, row: usize) -> Vec<f64> {
    let rows = (row..).map(|row| row as f64 * course.output_step_s);
    let between = rows.take_while(|time| *time < until).filter(|time| *time > from);
    std::iter::once(from).chain(between).chain([until]).collect()
}
