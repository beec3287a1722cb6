//! Steady-state response of a system to a sine: the fundamental and the harmonics.

use std::cell::Cell;

use num_complex::Complex64;

use super::task::Task;
use super::trajectory::drive_one;
use super::{
    Input, InputSchedule, Observer, Sampler, SimulationError, SimulationNumber, SimulationSettings, Status,
    StepCounts, System,
};
use crate::portable;
use crate::range::RequiredRange;

/// Rows per period: harmonics up to the thirtieth are not aliased.
const ROWS: usize = 64;
/// Number of harmonics that are computed.
const HARMONICS: usize = 20;

/// Limits of the evaluation of a response to a sine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinePlan {
    /// Frequency of the sine, rad/s.
    pub frequency_rad_per_s: f64,
    /// Periods of one window, over which the fundamental is evaluated; at least one.
    pub window_periods: u32,
    /// Largest number of windows; at least two.
    pub most_windows: u32,
    /// Largest difference of the fundamentals of two successive windows, relative to the
    /// fundamental, at which the response has settled.
    pub change: f64,
}

/// Response to a sine.
#[derive(Clone, Debug, PartialEq)]
pub struct SineResponse {
    /// Complex amplitude Y of the fundamental over the last window, y = y_0 + Im(Y e^(j w t)) +
    /// harmonics; NaN if no window was completed.
    pub fundamental: Complex64,
    /// Root of the sum of squares of the harmonics from the second to the twentieth, over the
    /// fundamental.
    pub distortion: f64,
    /// True if it settled within its windows.
    pub settled: bool,
    /// Difference of the last two windows, over the fundamental.
    pub change: f64,
    /// Number of simulated periods.
    pub periods: u64,
    /// Indicators that changed their sign, each once, in their order.
    pub indicators: Vec<usize>,
    /// Steps and evaluations.
    pub work: StepCounts,
    /// Status of the simulation, if it neither settled nor used up its windows.
    pub early_end: Option<Status>,
}

/// Simulates a system from a state (and the waves in transit after it) under inputs of which one is
/// a sine that begins at time zero, until the fundamental of an output has settled. The output is a
/// function of states and inputs.
///
/// ```text
/// Y = (2 j/N) sum over a window of (y - trend) e^(-j w t)         N rows, 64 a period, whole periods
/// ```
///
/// The trend removed is the straight line between the ends of the window: a slow drift does not
/// affect the fundamental to first order. `watch` is called with the simulated time after each
/// step; if it returns false, the simulation stops.
///
/// # Errors
/// [`SimulationError`] when start, inputs or settings do not fit the system, or the plan is
/// invalid.
///
/// # Example
/// The cube of a sine of amplitude a has the fundamental 3/4 a^3 and the third harmonic a^3/4.
/// ```
/// use phea_dynamics::scalar::Scalar;
/// use phea_dynamics::simulation::{Input, Profile, SimulationSettings, SinePlan, System, sine_response};
/// #[derive(Clone)]
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
///         rates[0] = T::from(5.0) * (inputs[0] - state[0]);
///     }
/// }
/// let plan = SinePlan { frequency_rad_per_s: 10.0, window_periods: 2, most_windows: 20, change: 1e-6 };
/// let inputs = vec![Input::Value(Profile::sine(0.0, 0.5, 10.0)?)];
/// let settings = SimulationSettings { tolerance: 1e-9, ..SimulationSettings::default() };
/// let cubed = |_: &[f64], inputs: &[f64]| inputs[0].powi(3);
/// let found = sine_response(&Lag, &[0.0], inputs.clone(), None, &settings, &plan, &cubed, &mut |_| true)?;
/// assert!(found.settled && (found.fundamental.re - 0.75 * 0.125).abs() < 1e-9 && found.fundamental.im.abs() < 1e-9);
/// assert!((found.distortion - 1.0 / 3.0).abs() < 1e-9);
/// // and the lag itself answers 5/(5 + 10 j)
/// let level = |state: &[f64], _: &[f64]| state[0];
/// let found = sine_response(&Lag, &[0.0], inputs, None, &settings, &plan, &level, &mut |_| true)?;
/// let expected = 0.5 * num_complex::Complex64::new(0.2, -0.4);
/// assert!((found.fundamental - expected).norm_sqr() < 1e-14 && found.distortion < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[expect(clippy::too_many_arguments, reason = "what a system is driven by, in the order of `simulate`")]
pub fn sine_response<E: System<f64> + Clone>(
    system: &E,
    start: &[f64],
    inputs: Vec<Input>,
    sampler: Option<Box<dyn Sampler + '_>>,
    settings: &SimulationSettings,
    plan: &SinePlan,
    output: &dyn Fn(&[f64], &[f64]) -> f64,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<SineResponse, SimulationError> {
    let window = plan.window_periods as usize * ROWS;
    let period_s = std::f64::consts::TAU / plan.frequency_rad_per_s;
    if window == 0 || plan.most_windows < 2 || !(period_s > 0.0 && period_s.is_finite()) {
        let (what, requirement) = (SimulationNumber::SinePlan, RequiredRange::OnePeriodAndTwoWindows);
        return Err(SimulationError::Setting { what, value: plan.frequency_rad_per_s, requirement });
    }
    let output_step_s = period_s / ROWS as f64;
    let rows = window as f64 * f64::from(plan.most_windows);
    // half a row more, so that rounding does not omit the last one
    let schedule = InputSchedule { duration_s: (rows + 0.5) * output_step_s, output_step_s, inputs };
    let done = Cell::new(false);
    let observer = Windows {
        wanted: (0..system.states()).collect(),
        output,
        done: &done,
        plan: *plan,
        phasors: phasors(),
        rows: 0,
        sums: [Complex64::ZERO; HARMONICS],
        first: 0.0,
        fundamental: Complex64::new(f64::NAN, f64::NAN),
        distortion: f64::NAN,
        change: f64::NAN,
    };
    let task = Task { start: start.to_vec(), schedule: &schedule, sampler, observer };
    let mut continues = |time_s: f64| !done.get() && watch(time_s);
    let (outcome, windows) = drive_one(system, task, settings, &mut continues)?;
    let settled = done.get();
    let mut indicators: Vec<usize> = outcome.events.iter().map(|event| event.indicator).collect();
    indicators.sort_unstable();
    indicators.dedup();
    Ok(SineResponse {
        fundamental: windows.fundamental,
        distortion: windows.distortion,
        settled,
        change: windows.change,
        periods: (windows.rows / ROWS) as u64,
        indicators,
        work: outcome.work,
        early_end: (!settled && outcome.status != Status::Completed).then_some(outcome.status),
    })
}

/// Factors e^(-j k) for each row of a period.
fn phasors() -> [Complex64; ROWS] {
    let angle = |row: usize| -std::f64::consts::TAU * row as f64 / ROWS as f64;
    std::array::from_fn(|row| portable::exp_complex(Complex64::new(0.0, angle(row))))
}

/// Running sums over the rows of a window.
struct Windows<'a> {
    wanted: Vec<usize>,
    output: &'a dyn Fn(&[f64], &[f64]) -> f64,
    done: &'a Cell<bool>,
    plan: SinePlan,
    phasors: [Complex64; ROWS],
    rows: usize,
    /// Sums of the first harmonic, the second, and so on.
    sums: [Complex64; HARMONICS],
    /// First value of the window.
    first: f64,
    fundamental: Complex64,
    distortion: f64,
    change: f64,
}

impl Observer for Windows<'_> {
    fn wanted(&self) -> &[usize] {
        &self.wanted
    }

    fn observe(&mut self, _time_s: f64, states: &[f64], inputs: &[f64]) {
        if self.done.get() {
            return;
        }
        let value = (self.output)(states, inputs);
        let window = self.plan.window_periods as usize * ROWS;
        if self.rows.is_multiple_of(window) {
            if self.rows > 0 {
                self.end_window(value, window as f64);
            }
            if self.done.get() {
                return;
            }
            self.first = value;
            self.sums = [Complex64::ZERO; HARMONICS];
        }
        // without the initial value, which adds only rounding to the harmonics
        let above = value - self.first;
        for (place, sum) in self.sums.iter_mut().enumerate() {
            *sum += self.phasors[(place + 1) * self.rows % ROWS] * above;
        }
        self.rows += 1;
    }
}

impl Windows<'_> {
    /// Subtracts the trend up to the value after the window: for the ramp r, the sum of r z^r over
    /// whole periods is N/(z - 1).
    fn end_window(&mut self, last: f64, rows: f64) {
        let mut squares = 0.0;
        let mut fundamental = Complex64::ZERO;
        for (place, sum) in self.sums.iter().enumerate() {
            let ramp = (last - self.first) / (self.phasors[place + 1] - 1.0);
            let amplitude = Complex64::new(0.0, 2.0 / rows) * (sum - ramp);
            if place == 0 {
                fundamental = amplitude;
            } else {
                squares += amplitude.norm_sqr();
            }
        }
        let size = portable::magnitude(fundamental);
        self.change = portable::magnitude(fundamental - self.fundamental) / size;
        self.fundamental = fundamental;
        self.distortion = squares.sqrt() / size;
        self.done.set(self.change <= self.plan.change);
    }
}
