//! Exact responses of linear systems to inputs that are constant or linear between samples.

use nalgebra::DVector;

use super::{ResponseCount, SampledSignal, TimeResponseError};
use crate::linear::double_double::DoubleDouble;
use crate::linear::matrix_exponential::ExactStep;
use crate::linear::{StateSpace, TimeDomain, TransferFunction};
use crate::order::sorted_distinct;

/// Response at these times to a unit step at time zero, from rest.
///
/// # Errors
/// Errors of [`forced_response`].
///
/// # Example
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::time_response::step_response;
/// # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
/// let lag = TransferFunction::from_factors(2.0, vec![], vec![Complex64::new(-2.0, 0.0)])?.with_dead_time(1.0)?;
/// let values = step_response(&lag, &[0.5, 1.0, 1.5])?;
/// assert_eq!(values[..2], [0.0, 0.0]);
/// assert!((values[2] - (1.0 - (-1.0_f64).exp())).abs() < 1e-15);
/// # Ok(())
/// # }
/// ```
pub fn step_response(system: &TransferFunction, times_s: &[f64]) -> Result<Vec<f64>, TimeResponseError> {
    forced_response(system, &SampledSignal::step(1.0), times_s)
}

/// Response of a transfer function, from rest at time zero, to a signal; dead time is exact.
///
/// The system is realised as a cascade of small sections. A sampled system takes the signal at its
/// sample instants and keeps its output between them.
///
/// # Errors
/// [`TimeResponseError::TimeOrder`] when the times fall or are negative;
/// [`TimeResponseError::Linear`] for an improper system.
pub fn forced_response(
    system: &TransferFunction,
    input: &SampledSignal,
    times_s: &[f64],
) -> Result<Vec<f64>, TimeResponseError> {
    let rational = system.clone().with_dead_time(0.0)?;
    let states = StateSpace::from_transfer_function(&rational)?;
    let rest = DVector::zeros(states.order());
    let inputs = [input.delayed(system.dead_time_s())];
    let outputs = forced_response_of_states(&states, &rest, &inputs, times_s)?;
    Ok(outputs.iter().map(|output| output.iter().sum()).collect())
}

/// Outputs of a state-space system at these times: one vector for each time, from the given state
/// at time zero, with one signal for each input. Exact between the signals' samples.
///
/// # Errors
/// [`TimeResponseError::Count`] when the number of signals or states does not fit;
/// [`TimeResponseError::TimeOrder`] when the times fall, are negative or are not finite.
pub fn forced_response_of_states(
    system: &StateSpace,
    initial_state: &DVector<f64>,
    inputs: &[SampledSignal],
    times_s: &[f64],
) -> Result<Vec<DVector<f64>>, TimeResponseError> {
    let counts = [
        (ResponseCount::InputSignals, inputs.len(), system.inputs()),
        (ResponseCount::InitialStates, initial_state.len(), system.order()),
    ];
    for (what, found, expected) in counts {
        if found != expected {
            return Err(TimeResponseError::Count { what, found, expected });
        }
    }
    let mut last = 0.0;
    for (index, &time_s) in times_s.iter().enumerate() {
        if !(time_s.is_finite() && time_s >= last) {
            return Err(TimeResponseError::TimeOrder { index, time_s });
        }
        last = time_s;
    }
    Ok(match system.domain() {
        TimeDomain::Continuous => continuous(system, initial_state, inputs, times_s),
        TimeDomain::Discrete { sample_time_s } => {
            sampled(system, sample_time_s, initial_state, inputs, times_s)
        }
    })
}

/// Runs from event to event (output times and samples of the inputs), between which each input is
/// one linear piece.
fn continuous(
    system: &StateSpace,
    initial_state: &DVector<f64>,
    inputs: &[SampledSignal],
    times_s: &[f64],
) -> Vec<DVector<f64>> {
    let end = times_s.last().copied().unwrap_or(0.0);
    let mut events: Vec<f64> = inputs.iter().flat_map(|input| input.times_s().iter().copied()).collect();
    events.retain(|time| *time > 0.0 && *time < end);
    events.extend_from_slice(times_s);
    let events = sorted_distinct(events);
    let mut steps = StepCache::new(system, 8.0 * f64::EPSILON * end);
    let mut state = initial_state.clone();
    // rounding error of the state in the last step; without it long runs of short steps drift
    let mut carried = DVector::zeros(system.order());
    // `reached` follows the lengths of the steps taken, `now` the times requested: they differ by
    // rounding only
    let (mut now, mut reached) = (0.0, DoubleDouble::ZERO);
    let mut outputs = Vec::with_capacity(times_s.len());
    let mut wanted = times_s.iter().copied().peekable();
    for event in std::iter::once(0.0).chain(events) {
        if event > now {
            let (length, step) = steps.of_length((DoubleDouble::from(event) - reached).value());
            let pieces: Vec<(f64, f64, f64)> = inputs.iter().map(|input| input.piece_at(now)).collect();
            let at_start =
                DVector::from_fn(inputs.len(), |i, _| pieces[i].0 + pieces[i].1 * (now - pieces[i].2));
            let rise = DVector::from_fn(inputs.len(), |i, _| pieces[i].1 * (event - now));
            let change = &step.increment * &state + &step.constant * at_start + &step.ramp * rise + &carried;
            for (index, change) in change.iter().enumerate() {
                let sum = DoubleDouble::sum_of(state[index], *change);
                (state[index], carried[index]) = (sum.high, sum.low);
            }
            now = event;
            reached = reached + length.into();
        }
        while wanted.next_if(|time| *time <= now).is_some() {
            let input = DVector::from_fn(inputs.len(), |i, _| inputs[i].value_at(now));
            outputs.push(system.c() * &state + system.d() * input);
        }
    }
    outputs
}

/// Exact steps by their length: a uniform grid has one, within rounding.
struct StepCache<'a> {
    system: &'a StateSpace,
    tolerance: f64,
    steps: Vec<(f64, ExactStep)>,
}

impl<'a> StepCache<'a> {
    fn new(system: &'a StateSpace, tolerance: f64) -> Self {
        StepCache { system, tolerance, steps: Vec::new() }
    }

    fn of_length(&mut self, length: f64) -> (f64, &ExactStep) {
        let same = |known: f64| (known - length).abs() <= self.tolerance.min(1e-9 * length.abs());
        let index = match self.steps.iter().position(|(known, _)| same(*known)) {
            Some(index) => index,
            None => {
                // an irregular grid is not worth storing in full
                if self.steps.len() >= 64 {
                    self.steps.clear();
                }
                self.steps.push((length, ExactStep::new(self.system.a(), self.system.b(), length)));
                self.steps.len() - 1
            }
        };
        let (known, step) = &self.steps[index];
        (*known, step)
    }
}

/// Sampled response: the output at time t is that of the last sample instant not after t.
///
/// ```text
/// x(k+1) = A x(k) + B u(kT)
/// ```
fn sampled(
    system: &StateSpace,
    sample_time_s: f64,
    initial_state: &DVector<f64>,
    inputs: &[SampledSignal],
    times_s: &[f64],
) -> Vec<DVector<f64>> {
    let mut state = initial_state.clone();
    let mut sample = 0.0_f64;
    let mut outputs = Vec::with_capacity(times_s.len());
    // a sample of the input that is late by rounding still counts for its instant
    let slack = 1e-9 * sample_time_s;
    let input_at = |sample: f64| {
        DVector::from_fn(inputs.len(), |i, _| inputs[i].value_at(sample * sample_time_s + slack))
    };
    for &time in times_s {
        while (sample + 1.0) * sample_time_s <= time + slack {
            state = system.a() * state + system.b() * input_at(sample);
            sample += 1.0;
        }
        outputs.push(system.c() * &state + system.d() * input_at(sample));
    }
    outputs
}
