//! Inputs, observers, settings and outcome of a simulation.

use std::ops::DerefMut;

use super::{Method, Profile, SimulationCount, SimulationNumber, Stretch};
use crate::portable;
use crate::range::RequiredRange;

/// Duration, inputs and output step of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct InputSchedule {
    /// Duration from time zero, in s; positive.
    pub duration_s: f64,
    /// Time between rows of the result in s; positive.
    pub output_step_s: f64,
    /// Inputs of the system, in order, without delayed waves.
    pub inputs: Vec<Input>,
}

/// Input of a system.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A known function of time.
    Value(Profile),
    /// First derivative of a known function of time.
    Rate(Profile),
    /// Last command of the sampler; before its first one, [`Sampler::held`].
    Command,
}

/// Controller that acts once per sample, with its converters.
pub trait Sampler {
    /// Time between samples in s; positive. The first is at time zero.
    fn sample_time_s(&self) -> f64;

    /// Time from a sample until its command takes effect, in s; zero or positive.
    fn delay_s(&self) -> f64;

    /// Command that is held before the first sampled command takes effect.
    fn held(&self) -> f64 {
        0.0
    }

    /// Command for the state and the inputs at a sample.
    fn command(&mut self, time_s: f64, state: &[f64], inputs: &[f64]) -> f64;
}

/// Receiver of the results of a simulation.
pub trait Observer {
    /// Indices of the required states, in the required order.
    fn wanted(&self) -> &[usize];

    /// True if the row with this index, counted from zero, is required.
    fn wants_row(&self, _row: u64) -> bool {
        true
    }

    /// Called at each required row of the result, with the required states and all inputs,
    /// beginning with time zero. At a break, the inputs are those after it.
    fn observe(&mut self, time_s: f64, states: &[f64], inputs: &[f64]);

    /// True if inputs are required; if not, the list of inputs is empty.
    fn wants_inputs(&self) -> bool {
        true
    }

    /// Required level of detail.
    fn attention(&self) -> Attention {
        Attention::Rows
    }

    /// Called with each accepted step, after its rows, if steps are required.
    fn follow(&mut self, _stretch: &Stretch<'_>) {}

    /// True if the solution within a step from sample to sample must be more accurate than a cubic;
    /// called before [`Observer::follow`].
    fn needs_accurate_solution(&self, _stretch: &Stretch<'_>) -> bool {
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

    fn needs_accurate_solution(&self, stretch: &Stretch<'_>) -> bool {
        (**self).needs_accurate_solution(stretch)
    }
}

/// Level of detail that an observer requires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attention {
    /// Rows only: the spacing of rows may determine how a step is made.
    #[default]
    Rows,
    /// Every step as a whole. Between samples a step may use precomputed matrices;
    /// [`Observer::needs_accurate_solution`] is called for each such step.
    Steps,
    /// Every step as a whole and every row, independent of the spacing of rows: no step uses
    /// precomputed matrices.
    Everything,
}

/// Tolerance, limit of the work and method of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulationSettings {
    /// Largest estimated error of a step, relative to the state plus its scale. Above 0 and below
    /// 1.
    ///
    /// If a rate has a kink within the step, as friction has at standstill, one step in a hundred
    /// is off by ten times as much or more.
    pub tolerance: f64,
    /// Largest number of steps, including rejected ones.
    pub maximum_steps: u64,
    /// Integration method.
    pub method: Method,
}

impl Default for SimulationSettings {
    fn default() -> SimulationSettings {
        SimulationSettings { tolerance: 1e-6, maximum_steps: 10_000_000, method: Method::default() }
    }
}

/// Reason for the end of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Status {
    /// The duration was reached.
    Completed,
    /// The watch stopped the simulation.
    Cancelled {
        /// Simulated time of the end, s.
        time_s: f64,
    },
    /// No step was short enough for the tolerance.
    StepTooSmall {
        /// Simulated time of the end, s.
        time_s: f64,
    },
    /// A rate or an input was not finite.
    NotFinite {
        /// Simulated time of the end, s.
        time_s: f64,
    },
    /// The limit of steps was reached, and the last steps were short because a mode grows: to
    /// resolve its oscillation would take more steps than allowed.
    UnresolvedOscillation {
        /// Simulated time of the end, s.
        time_s: f64,
        /// Magnitude of the mode's eigenvalue, in rad/s.
        frequency_rad_per_s: f64,
        /// Real part of the eigenvalue, in 1/s.
        growth_per_s: f64,
    },
    /// The limit of steps was reached.
    TooManySteps {
        /// Simulated time of the end, s.
        time_s: f64,
    },
}

/// Change of sign of an indicator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Simulated time of the event, s.
    pub time_s: f64,
    /// Index of the indicator.
    pub indicator: usize,
    /// True if the indicator became positive.
    pub rising: bool,
}

/// Steps and evaluations of a simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepCounts {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, which were repeated with a shorter step.
    pub rejected: u64,
    /// Evaluations of the rates, without those for derivatives at the start of each step.
    pub evaluations: u64,
}

/// Fraction of the scale of a state above which an error is visible.
const VISIBLE: f64 = 1e-3;

/// Mode that grew freely, without being suppressed by the method.
///
/// ```text
/// factor = exp(integral of Re(lambda) over the time from its beginning to its end)
/// ```
///
/// lambda is the least stable of the fast eigenvalues of the Jacobian along the trajectory, or of
/// the slower ones with the delays in the loop, or from sample to sample that of the loop with its
/// controller ([`super::Frozen`]), as far as these are known between the steps at which they are
/// computed. The factor shows where errors of the solver may have been amplified; it is not the
/// ratio of two amplitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplification {
    /// Logarithm of the growth factor.
    pub logarithm: f64,
    /// Simulated time at which the growth began, s.
    pub from_s: f64,
    /// Simulated time at which the growth was largest, s.
    pub until_s: f64,
    /// Magnitude of the eigenvalue at that time, in rad/s; zero if no single mode grows.
    pub frequency_rad_per_s: f64,
    /// Cause of the growth.
    pub cause: GrowthCause,
}

/// Cause that amplifies errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GrowthCause {
    /// A mode of the machine, including a continuous controller.
    #[default]
    Mode,
    /// The closed loop: from sample to sample, or with its delays.
    Loop,
    /// The motion from kink to kink, although no mode grows: bouncing off a wall.
    Motion,
}

impl Amplification {
    /// The amplification with the larger growth.
    pub fn larger(all: [Option<Amplification>; 2]) -> Option<Amplification> {
        let [one, other] = all;
        let more = other.filter(|other| one.is_none_or(|one| one.logarithm < other.logarithm));
        more.or(one)
    }

    /// The amplification that identifies a mode if it may show errors of this tolerance, otherwise
    /// the one with the larger growth.
    pub(super) fn named(
        mode: Option<Amplification>,
        motion: Option<Amplification>,
        tolerance: f64,
    ) -> Option<Amplification> {
        mode.filter(|mode| mode.may_show_errors(tolerance)).or(Amplification::larger([mode, motion]))
    }

    /// True if rounding may have grown to a thousandth of the scales of the states: then no
    /// tolerance determines the result.
    pub fn may_show_rounding(&self) -> bool {
        self.may_show_errors(f64::EPSILON)
    }

    /// True if errors as large as the tolerance may have grown to a thousandth of the scales of the
    /// states.
    pub fn may_show_errors(&self, tolerance: f64) -> bool {
        self.logarithm >= portable::ln(VISIBLE / tolerance)
    }
}

/// Kinks that a run passed without propagation of a deviation from one to the next: their combined
/// amplification is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnfollowedKinks {
    /// Steps within which some kink was passed.
    pub steps: u64,
    /// Reason why no deviation was propagated.
    pub cause: UnfollowedCause,
}

/// Reason why a deviation is not propagated along a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnfollowedCause {
    /// A controller acts at samples.
    Samples,
    /// A delay of a command or of a wave holds a part of the deviation.
    Delays,
    /// The method has no matrix for the propagation.
    Method,
}

/// Outcome of one simulation, except the data received by its observer.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Reason for the end of the simulation.
    pub status: Status,
    /// Events, in order of time.
    pub events: Vec<Event>,
    /// Steps and evaluations of a simulation.
    pub work: StepCounts,
    /// State at the end.
    pub end: Vec<f64>,
    /// Largest amplification; `None` if nothing grew.
    pub amplification: Option<Amplification>,
    /// Kinks that were not followed; `None` if a deviation was propagated, or fewer than two steps
    /// passed a kink.
    pub unfollowed: Option<UnfollowedKinks>,
}

/// Error for a simulation that did not start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// A count that does not fit the system.
    #[error("{found} {what} where the system has {expected}")]
    Count {
        /// Name of the count.
        what: SimulationCount,
        /// Number found.
        found: usize,
        /// Number required.
        expected: usize,
    },
    /// An invalid time or tolerance.
    #[error("{what} is {value}, but must be {requirement}")]
    Setting {
        /// Name of the number.
        what: SimulationNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        requirement: RequiredRange,
    },
    /// A state at the start that is not a finite number.
    #[error("state {index} is {value} at the start")]
    Start {
        /// Index of the state.
        index: usize,
        /// Value of the state.
        value: f64,
    },
    /// Lanes that need vector instructions which the processor lacks.
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
