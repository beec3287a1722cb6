//! Modes of a whole loop linearised at a state: with its delays, or from sample to sample with the
//! controller's memory.

mod law;
mod watch;

pub use law::SampledLaw;
pub use watch::FrozenWatch;

use nalgebra::DMatrix;

use super::kernel::Kernel;
use super::{Lane, System};
use crate::linear::working_eigenvalues;
use crate::portable;

/// Loop linearised at a state, each delay d of a wave replaced by a rational function.
///
/// ```text
/// x' = A x + B u,      e^(-s d) = (1 - s d/3)/(1 + 2 s d/3 + (s d)^2/6) + O((s d)^4)
/// ```
///
/// States are over their scales, and two a delay follow them. The matrices are central differences:
/// accurate to 1e-6, with identical operations for one machine and in lanes.
#[derive(Clone, Debug)]
pub struct Frozen {
    a: DMatrix<f64>,
    /// Input matrix, one column for each input before the waves.
    b: DMatrix<f64>,
    /// Scales of all states and waves.
    scales: Vec<f64>,
    states: usize,
    longest_delay_s: f64,
}

/// Least stable mode of a linearised loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrozenMode {
    /// Real part of its eigenvalue in 1/s; from sample to sample the logarithm of its magnitude
    /// over the sample time.
    pub growth_per_s: f64,
    /// Magnitude of the eigenvalue in rad/s; from sample to sample its angle over the sample time.
    pub frequency_rad_per_s: f64,
}

impl FrozenMode {
    /// Least stable of all modes that are not faster than this in rad/s.
    pub(super) fn least_stable(all: &[FrozenMode], below_rad_per_s: f64) -> Option<FrozenMode> {
        let fastest = all.iter().fold(0.0, |most, mode| mode.frequency_rad_per_s.max(most));
        let slower = all.iter().filter(|mode| mode.frequency_rad_per_s <= below_rad_per_s);
        let least = slower.max_by(|one, other| one.growth_per_s.total_cmp(&other.growth_per_s))?;
        let is_zero = least.growth_per_s.abs() <= LEAST_GROWTH * fastest;
        Some(FrozenMode { growth_per_s: if is_zero { 0.0 } else { least.growth_per_s }, ..*least })
    }
}

/// Displacement of a state, as a fraction of its magnitude and scale.
const DISPLACED: f64 = 1e-5;
/// Arriving wave of a delay in terms of its two states, times d.
const ARRIVING: [f64; 2] = [6.0, -2.0];
/// Largest angle of a mode in the longest delay that the rational function represents, in rad.
const SHOWN: f64 = 1.5;
/// Fraction of the fastest mode below which growth is the error of a zero eigenvalue.
const LEAST_GROWTH: f64 = 1e-6;

/// Derivatives with respect to one state or input.
struct Displaced {
    rates: Vec<f64>,
    sent: Vec<f64>,
}

impl Frozen {
    /// Linearises the loop of a system at a state, under all its inputs.
    ///
    /// # Example
    /// A level that falls freely at 2 1/s, measured 0.1 s late and fed back with the wrong sign:
    /// ```
    /// use phea_dynamics::scalar::Scalar;
    /// use phea_dynamics::simulation::{Frozen, System};
    /// struct Late;
    /// impl System<f64> for Late {
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
    ///         rates[0] = T::from(3.0) * inputs[0] - T::from(2.0) * state[0];
    ///     }
    ///     fn delays(&self) -> Vec<f64> {
    ///         vec![0.1]
    ///     }
    ///     fn outgoing<T: Scalar + From<f64>>(&self, state: &[T], _: &[T], waves: &mut [T]) {
    ///         waves[0] = state[0];
    ///     }
    /// }
    /// // s + 2 = 3 e^(-0.1 s)
    /// let growth = Frozen::at(&Late, &[0.3], &[0.3]).least_stable(f64::INFINITY).unwrap().growth_per_s;
    /// assert!((growth + 2.0 - 3.0 * (-0.1 * growth).exp()).abs() < 1e-5);
    /// ```
    pub fn at<E: System<f64>>(system: &E, state: &[f64], inputs: &[f64]) -> Frozen {
        Frozen::of::<f64>(system, state, inputs, 0)
    }

    /// Linearises the loop of the machine in a lane.
    pub(super) fn of<S: Lane>(system: &dyn Kernel<S>, state: &[S], inputs: &[S], lane: usize) -> Frozen {
        let delays: Vec<f64> = system.delays().iter().map(|delay| delay.lane(lane)).collect();
        let (states, waves) = (system.states(), delays.len());
        let own = inputs.len() - waves;
        let columns = displaced(system, state, inputs, lane);
        let mut scales: Vec<f64> = system.scales().iter().map(|scale| scale.lane(lane)).collect();
        for wave in 0..waves {
            let typical = (0..states).map(|state| (columns[state].sent[wave] * scales[state]).abs());
            let typical = typical.fold(0.0, f64::max);
            scales.extend([if typical > 0.0 { typical } else { 1.0 }; 2]);
        }
        let order = states + 2 * waves;
        let (mut a, mut b) = (DMatrix::zeros(order, order), DMatrix::zeros(order, own));
        // rates and sent waves caused by a column, over the scales of their rows
        let put = |matrix: &mut DMatrix<f64>, place: usize, factor: f64, column: &Displaced| {
            for (row, (rate, scale)) in column.rates.iter().zip(&scales).enumerate() {
                matrix[(row, place)] += factor * rate / scale;
            }
            for (wave, delay) in delays.iter().enumerate() {
                let row = states + 2 * wave + 1;
                matrix[(row, place)] += factor * column.sent[wave] / (delay * scales[row]);
            }
        };
        let (of_states, of_inputs) = columns.split_at(states);
        for (place, (column, scale)) in of_states.iter().zip(&scales).enumerate() {
            put(&mut a, place, *scale, column);
        }
        for (place, column) in of_inputs.iter().take(own).enumerate() {
            put(&mut b, place, 1.0, column);
        }
        for (wave, delay) in delays.iter().enumerate() {
            let first = states + 2 * wave;
            for (place, part) in ARRIVING.into_iter().enumerate() {
                put(&mut a, first + place, part * scales[first], &of_inputs[own + wave]);
            }
            a[(first, first + 1)] += 1.0 / delay;
            a[(first + 1, first)] -= 6.0 / delay;
            a[(first + 1, first + 1)] -= 4.0 / delay;
        }
        let longest_delay_s = delays.iter().copied().fold(0.0, f64::max);
        Frozen { a, b, scales, states, longest_delay_s }
    }

    /// Least stable mode below a frequency in rad/s at which the delays are represented; `None` if
    /// there is none.
    pub fn least_stable(&self, below_rad_per_s: f64) -> Option<FrozenMode> {
        let values = working_eigenvalues(self.a.clone())?.into_iter();
        let all: Vec<FrozenMode> = values
            .map(|value| FrozenMode {
                growth_per_s: value.re,
                frequency_rad_per_s: portable::magnitude(value),
            })
            .collect();
        let shown = if self.longest_delay_s > 0.0 { SHOWN / self.longest_delay_s } else { f64::INFINITY };
        FrozenMode::least_stable(&all, below_rad_per_s.min(shown))
    }

    /// Derivatives of a signal with respect to all states, for a [`SampledLaw`]; state and inputs
    /// are those of the linearisation.
    pub fn row(&self, state: &[f64], inputs: &[f64], signal: impl Fn(&[f64], &[f64]) -> f64) -> Vec<f64> {
        let own = self.b.ncols();
        let mut row = vec![0.0; self.a.ncols()];
        let (mut state, mut inputs) = (state.to_vec(), inputs.to_vec());
        for (place, entry) in row.iter_mut().take(self.states).enumerate() {
            let at = state[place];
            let by = DISPLACED * (self.scales[place] + at.abs());
            let ends = [at + by, at - by].map(|value| {
                state[place] = value;
                signal(&state, &inputs)
            });
            state[place] = at;
            *entry = self.scales[place] * (ends[0] - ends[1]) / (2.0 * by);
        }
        for wave in 0..inputs.len() - own {
            let first = self.states + 2 * wave;
            let (at, by) = (inputs[own + wave], DISPLACED * (self.scales[first] + inputs[own + wave].abs()));
            let ends = [at + by, at - by].map(|value| {
                inputs[own + wave] = value;
                signal(&state, &inputs)
            });
            inputs[own + wave] = at;
            let slope = (ends[0] - ends[1]) / (2.0 * by);
            for (place, part) in ARRIVING.into_iter().enumerate() {
                row[first + place] = part * self.scales[first] * slope;
            }
        }
        row
    }
}

/// Central differences with respect to all states and then all inputs.
fn displaced<S: Lane>(system: &dyn Kernel<S>, state: &[S], inputs: &[S], lane: usize) -> Vec<Displaced> {
    let (states, waves) = (system.states(), system.delays().len());
    let scales = system.scales();
    let (mut state, mut inputs) = (state.to_vec(), inputs.to_vec());
    let mut rates = vec![S::from(0.0); states];
    let mut sent = vec![S::from(0.0); waves];
    let mut columns = Vec::with_capacity(states + inputs.len());
    for place in 0..states + inputs.len() {
        let at = place.checked_sub(states).map_or_else(|| state[place], |input| inputs[input]);
        let scale = scales.get(place).map_or(1.0, |scale| scale.lane(lane));
        let by = DISPLACED * (scale + at.lane(lane).abs());
        let ends = [by, -by].map(|by| {
            match place.checked_sub(states) {
                None => state[place] = at + S::from(by),
                Some(input) => inputs[input] = at + S::from(by),
            }
            system.rates(&state, &inputs, &mut rates);
            system.outgoing(&state, &inputs, &mut sent);
            let of_lane = |values: &[S]| values.iter().map(|value| value.lane(lane)).collect::<Vec<f64>>();
            [of_lane(&rates), of_lane(&sent)]
        });
        match place.checked_sub(states) {
            None => state[place] = at,
            Some(input) => inputs[input] = at,
        }
        let slopes = |which: usize| {
            let pairs = ends[0][which].iter().zip(&ends[1][which]);
            pairs.map(|(one, other)| (one - other) / (2.0 * by)).collect()
        };
        columns.push(Displaced { rates: slopes(0), sent: slopes(1) });
    }
    columns
}
