//! Inputs, observers, settings and outcome of a simulation.

use std::ops::DerefMut;

use super::{Method, Profile, SimulationCount, SimulationNumber, Stretch};
use crate::portable;
use crate::range::RequiredRange;

/// Duration, inputs and output step of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct InputSchedule {
    /// From time zero, in s; positive.
    pub duration_s: f64,
    /// Time between rows of the result in s; positive.
    pub output_step_s: f64,
    /// One for each input of the system, in order, delayed waves excluded.
    pub inputs: Vec<Input>,
}

/// What an input is.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A known function of time.
    Value(Profile),
    /// Its first derivative.
    Rate(Profile),
    /// The last command of the sampler; before its first one, [`Sampler::held`].
    Command,
}

/// Acts once per sample: a digital controller with its converters.
pub trait Sampler {
    /// Time between samples in s; positive. The first is at time zero.
    fn sample_time_s(&self) -> f64;

    /// Time from a sample until its command takes effect, in s; zero or positive.
    fn delay_s(&self) -> f64;

    /// What is held before the first command takes effect.
    fn held(&self) -> f64 {
        0.0
    }

    /// The command for the state and the inputs at a sample.
    fn command(&mut self, time_s: f64, state: &[f64], inputs: &[f64]) -> f64;
}

/// Receives the results during a simulation.
pub trait Observer {
    /// Indices of the states it needs, in the order in which it needs them.
    fn wanted(&self) -> &[usize];

    /// True if it needs the row with this index, counted from zero.
    fn wants_row(&self, _row: u64) -> bool {
        true
    }

    /// Called at each row of the result that it wants, with those states and all inputs, beginning
    /// with time zero. At a break it sees the inputs as they are from then on.
    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]);

    /// True if it needs the inputs; if not, the list of inputs is empty.
    fn wants_inputs(&self) -> bool {
        true
    }

    /// True if it needs the steps in addition to the rows.
    fn attention(&self) -> Attention {
        Attention::Rows
    }

    /// Called with each step that was taken, after its rows, where it pays attention to steps.
    fn follow(&mut self, _stretch: &Stretch<'_>) {}

    /// Asked before [`Observer::follow`]: whether it needs the solution within a step from sample
    /// to sample more accurately than by a cubic.
    fn looks_closer(&self, _stretch: &Stretch<'_>) -> bool {
        false
    }
}

impl<P: DerefMut<Target: Observer>> Observer for P {
    fn wanted(&self) -> &[usize] {
        (**self).wanted()
    }

    fn wants_row(&self, row: u64) -> bool {
        (**self).wants_row(row)
    }

    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]) {
        (**self).observe(time_s, states, inputs);
    }

    fn wants_inputs(&self) -> bool {
        (**self).wants_inputs()
    }

    fn attention(&self) -> Attention {
        (**self).attention()
    }

    fn follow(&mut self, stretch: &Stretch<'_>) {
        (**self).follow(stretch);
    }

    fn looks_closer(&self, stretch: &Stretch<'_>) -> bool {
        (**self).looks_closer(stretch)
    }
}

/// What an observer needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attention {
    /// Rows alone: how often there are rows may decide how a step is made.
    #[default]
    Rows,
    /// Every step as a whole. Between samples a machine may go by known matrices;
    /// [`Observer::looks_closer`] is asked of each such step.
    Steps,
    /// Every step as a whole and every row, so that rows decide nothing: no step is made by known
    /// matrices.
    Everything,
}

/// Tolerance, limit of the work and method of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulationSettings {
    /// Largest error of a step as it is estimated, relative to the state plus its scale. Above 0
    /// and below 1.
    ///
    /// Where a rate has a kink within the step, as friction has at a standstill, one step in a
    /// hundred is off by ten times as much and more.
    pub tolerance: f64,
    /// Largest number of steps, rejected ones included.
    pub maximum_steps: u64,
    /// How steps are made.
    pub method: Method,
}

impl Default for SimulationSettings {
    fn default() -> SimulationSettings {
        SimulationSettings { tolerance: 1e-6, maximum_steps: 10_000_000, method: Method::default() }
    }
}

/// How a simulation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status {
    /// At the end of its duration.
    Completed,
    /// By its watch.
    Cancelled {
        /// When, in s of simulated time.
        time_s: f64,
    },
    /// No step was short enough for the tolerance.
    StepTooSmall {
        /// When, in s of simulated time.
        time_s: f64,
    },
    /// A rate or an input was not a finite number.
    NotFinite {
        /// When, in s of simulated time.
        time_s: f64,
    },
    /// It took more steps than it was allowed, and the last of them were short because a mode
    /// grows: its oscillation would take more steps than there are.
    UnresolvedOscillation {
        /// When, in s of simulated time.
        time_s: f64,
        /// Magnitude of the mode's eigenvalue, in rad/s.
        frequency_rad_per_s: f64,
        /// Its real part, in 1/s.
        growth_per_s: f64,
    },
    /// It took more steps than it was allowed.
    TooManySteps {
        /// When, in s of simulated time.
        time_s: f64,
    },
}

/// An indicator that changed its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// When, in s of simulated time.
    pub time_s: f64,
    /// Which indicator.
    pub indicator: usize,
    /// True if it became positive.
    pub rising: bool,
}

/// Steps and evaluations of a simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepCounts {
    /// Accepted steps.
    pub steps: u64,
    /// Steps tried again with a shorter one.
    pub rejected: u64,
    /// Evaluations of the rates, that for derivatives at the start of each step not counted.
    pub evaluations: u64,
}

/// Part of the scale of a state from which on an error is visible.
const VISIBLE: f64 = 1e-3;

/// A mode that grew by itself, without being suppressed by the method.
///
/// ```text
/// factor = exp(integral of Re(lambda) over the time from its begin to its end)
/// ```
///
/// lambda is the least stable of the fast eigenvalues of the Jacobian along the trajectory, or of
/// the slower ones with the delays in the loop, or from sample to sample that of the loop with its
/// controller ([`super::Frozen`]), as far as these are known between the steps at which they are
/// computed. The factor shows where errors of the solver may have been amplified; it is not the
/// ratio of two amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplification {
    /// Logarithm of the factor.
    pub logarithm: f64,
    /// When the growth began, in s of simulated time.
    pub from_s: f64,
    /// When it was largest, in s of simulated time.
    pub until_s: f64,
    /// Magnitude of the eigenvalue at that time, in rad/s; zero where no single mode grows.
    pub frequency_rad_per_s: f64,
    /// What grows.
    pub cause: GrowthCause,
}

/// What amplifies errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GrowthCause {
    /// A mode of the machine, with a continuous controller if there is one.
    #[default]
    Mode,
    /// The closed loop: from sample to sample, or with its delays.
    Loop,
    /// The motion from kink to kink, though no mode grows: bouncing off a wall.
    Motion,
}

impl Amplification {
    /// The one that grew more.
    pub fn larger(all: [Option<Amplification>; 2]) -> Option<Amplification> {
        let [one, other] = all;
        let more = other.filter(|other| one.is_none_or(|one| one.logarithm < other.logarithm));
        more.or(one)
    }

    /// The one that names a mode where it may show errors of this tolerance, else the one that grew
    /// more.
    pub(super) fn named(
        mode: Option<Amplification>,
        motion: Option<Amplification>,
        tolerance: f64,
    ) -> Option<Amplification> {
        mode.filter(|mode| mode.may_show_errors(tolerance)).or(Amplification::larger([mode, motion]))
    }

    /// True if rounding may have grown to a thousandth of the scales of the states: no tolerance
    /// determines the result then.
    pub fn may_show_rounding(&self) -> bool {
        self.may_show_errors(f64::EPSILON)
    }

    /// True if errors as large as the tolerance may have grown to a thousandth of the scales of the
    /// states.
    pub fn may_show_errors(&self, tolerance: f64) -> bool {
        self.logarithm >= portable::ln(VISIBLE / tolerance)
    }
}

/// Kinks that a run passed without a deviation being carried from one to the next: what they
/// amplify together is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnfollowedKinks {
    /// Steps within which some kink was passed.
    pub steps: u64,
    /// Why nothing was carried.
    pub cause: UnfollowedCause,
}

/// The reason why a deviation is not carried along a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnfollowedCause {
    /// A controller acts at samples.
    Samples,
    /// A delay holds a part of the deviation: of a command, or of a wave.
    Delays,
    /// The method has no matrix for it.
    Method,
}

/// The outcome of one simulation, apart from what its observer received.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub status: Status,
    /// Events, in order of time.
    pub events: Vec<Event>,
    /// Steps and evaluations of a simulation.
    pub work: StepCounts,
    /// State at the end.
    pub end: Vec<f64>,
    /// What grew most; `None` where nothing did.
    pub amplification: Option<Amplification>,
    /// `None` where a deviation was carried along, or fewer than two steps passed a kink.
    pub unfollowed: Option<UnfollowedKinks>,
}

/// Why a simulation did not start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// A count does not fit the system.
    #[error("{found} {what} where the system has {expected}")]
    Count {
        /// Name of the count.
        what: SimulationCount,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A time or a tolerance is invalid.
    #[error("{what} is {value}, but must be {requirement}")]
    Setting {
        /// Name of the number.
        what: SimulationNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        requirement: RequiredRange,
    },
    /// A state at the start is not a finite number.
    #[error("state {index} is {value} at the start")]
    Start {
        /// Which state.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Lanes need vector instructions that the processor lacks.
    #[error(
        "machines cannot be driven side by side on this processor: it lacks the vector instructions AVX2 and FMA"
    )]
    NoVectors,
    /// More states and inputs than a simulation can have.
    #[error(
        "{states} states and {inputs} inputs are more than {} together",
        crate::scalar::Dependence::CAPACITY
    )]
    TooLarge {
        /// Number of states.
        states: usize,
        /// Number of inputs.
        inputs: usize,
    },
}
