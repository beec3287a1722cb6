//! Response at one frequency: a machine on its linear orbit, excited until its response has
//! settled.

use std::f64::consts::TAU;

use num_complex::Complex64;
use phea_dynamics::portable;
use phea_dynamics::simulation::{Input, Sampler, SimulationSettings, SinePlan, SineResponse};
use phea_hydraulics::machine::INDICATORS;
use phea_machine::{Control, Shaken};

use crate::simulate::RunStatus;
use crate::simulate::SimulateError;
use crate::simulate::run::{COMMAND_LIMIT, StoppedRun};

/// Shortest window, s, and in periods.
const WINDOW_S: f64 = 1.0;
const WINDOW_PERIODS: f64 = 2.0;
const MOST_WINDOWS: u32 = 60;
/// Largest difference between two windows.
const CHANGE: f64 = 1e-4;
/// Finest and coarsest tolerance of the integration.
const TOLERANCE: [f64; 2] = [1e-10, 1e-6];

/// The measured response at one frequency, and those of the models.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponsePoint {
    /// Frequency, rad/s.
    pub frequency_rad_per_s: f64,
    /// Amplitude of the sine: V in the open loop, N in the closed one.
    pub amplitude: f64,
    /// Fundamental of the force over the amplitude: N/V or 1; NaN if no window was completed.
    pub machine: Complex64,
    /// Response of the machine's exact derivatives at its equilibrium; absent if they do not form a
    /// linear system.
    pub linearised_machine: Option<Complex64>,
    /// Response of the linear plant, or of the loop that it closes.
    pub linear_plant: Complex64,
    /// Ratio of the harmonics from the second to the twentieth, root of the sum of squares, to the
    /// fundamental.
    pub distortion: f64,
    /// True if the fundamental changed by a ten-thousandth or less between the last two windows.
    pub settled: bool,
    /// Relative change of the fundamental.
    pub change: f64,
    /// Number of simulated periods.
    pub periods: u64,
    /// Number of integration steps.
    pub steps: u64,
    /// Events during the run, which are outside the neighbourhood of the equilibrium.
    pub reached: Vec<&'static str>,
    /// Reason for the end of the simulation if it did not settle.
    pub early_end: Option<RunStatus>,
}

impl ResponsePoint {
    /// Ratio of the machine's magnitude to that of a model, dB, and its phase minus the model's,
    /// degrees, within half a turn.
    pub fn differs(&self, model: Complex64) -> [f64; 2] {
        let quotient = self.machine / model;
        [20.0 * portable::log10(portable::magnitude(quotient)), portable::argument(quotient).to_degrees()]
    }
}

/// The rig that is excited, and its initial state.
pub(super) struct RestingRig<'a> {
    pub(super) control: &'a Control,
    /// Values of all states, followed by the waves in transit.
    pub(super) start: &'a [f64],
    /// Amplitudes of the states on the orbit of the linearised system, for an amplitude of one;
    /// empty if unknown.
    pub(super) orbit: Vec<Complex64>,
    pub(super) inputs: Vec<Input>,
    pub(super) settings: SimulationSettings,
}

/// Response of a machine to a sine of this frequency and amplitude. It begins on the orbit of its
/// linearisation, so that only the nonlinear part has to settle.
pub(super) fn respond(
    resting: RestingRig<'_>,
    sampler: Option<Box<dyn Sampler + '_>>,
    [frequency, amplitude]: [f64; 2],
    watch: &mut dyn FnMut() -> bool,
) -> Result<SineResponse, SimulateError> {
    let RestingRig { control, start, orbit, inputs, settings } = resting;
    let mut start = start.to_vec();
    for (state, part) in start.iter_mut().zip(&orbit) {
        *state += amplitude * part.im;
    }
    let window_periods = (WINDOW_S * frequency / TAU).max(WINDOW_PERIODS).ceil() as u32;
    let plan = SinePlan {
        frequency_rad_per_s: frequency,
        window_periods,
        most_windows: MOST_WINDOWS,
        change: CHANGE,
    };
    let mut steps = 0_u32;
    let mut watch = |_: f64| {
        steps = steps.wrapping_add(1);
        !steps.is_multiple_of(1024) || watch()
    };
    let shaken = Shaken { start: &start, inputs, sampler, settings, plan };
    let answered = control.shaken(shaken, &mut watch);
    answered.map_err(|error| SimulateError::Simulation { name: "frequency response".to_string(), error })
}

/// A tolerance fine enough for such a small sine, because errors are scaled by typical values,
/// which are larger.
pub(super) fn finer(settings: SimulationSettings, amplitude_over_typical: f64) -> SimulationSettings {
    let [finest, coarsest] = TOLERANCE;
    let wanted = (coarsest * amplitude_over_typical).clamp(finest, coarsest);
    SimulationSettings { tolerance: settings.tolerance.min(wanted), ..settings }
}

/// The measured point and its models.
pub(super) fn point(
    [frequency_rad_per_s, amplitude]: [f64; 2],
    found: &SineResponse,
    linear_plant: Complex64,
    linearised_machine: Option<Complex64>,
) -> ResponsePoint {
    let name = |index: &usize| INDICATORS.get(*index).copied().unwrap_or(COMMAND_LIMIT);
    ResponsePoint {
        frequency_rad_per_s,
        amplitude,
        machine: found.fundamental / amplitude,
        linearised_machine,
        linear_plant,
        distortion: found.distortion,
        settled: found.settled,
        change: found.change,
        periods: found.periods,
        steps: found.work.steps,
        reached: found.indicators.iter().map(name).collect(),
        early_end: found.early_end.and_then(|status| Some(StoppedRun::of(status)?.status)),
    }
}
