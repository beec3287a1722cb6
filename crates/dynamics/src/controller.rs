//! A controller as one value: its elements, its timing, and its limits.
//!
//! Loop shaping edits the elements, verification takes the responses, simulation and generated code
//! take the sample step of [`SampledController`]: four users of one value.

mod converter;
mod element;
mod inner_feedback;
mod integral;
mod named_structure;
mod rate_sensor;
mod sampled;
mod section;
mod virtual_impedance;

pub(crate) use integral::integral_row;

pub use converter::{CoefficientFormat, CoefficientTooLarge, Converter, ConverterError};
pub use element::{Compensator, Element, Stage};
pub use inner_feedback::InnerFeedback;
pub use named_structure::NamedStructure;
pub use rate_sensor::{RateFilter, RateSensor};
pub use sampled::{ControllerInput, ControllerOutput, ControllerState, SampledController};
pub use section::Section;
pub use virtual_impedance::VirtualImpedance;

use crate::linear::Discretization;

/// When the controller acts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Sample time in s; absent for a continuous controller.
    pub sample_time_s: Option<f64>,
    /// Computation and transport delay of the loop in s.
    pub delay_s: f64,
    /// How continuous elements become sampled ones.
    pub discretization: Discretization,
    /// True if the prefilter acts on the reference before it is sampled, in continuous time.
    pub continuous_prefilter: bool,
    /// Gain of the feed-forward of a disturbance's rate, sampled and delayed as the command is: K
    /// in U = G (F R - Y) + K H_v s D. Zero without feed-forward.
    pub rate_feed_forward: f64,
    /// H_v: filter and dead time of the sensor of that rate, before the samples.
    pub rate_sensor: RateSensor,
    /// H of a second signal that is fed back, sampled and delayed as the command is: U = G (F R -
    /// Y) - H P. A continuous loop has it in its plant.
    pub inner_feedback: InnerFeedback,
}

impl Timing {
    /// When the prefilter acts: with the controller, or in continuous time before its samples.
    pub fn of_prefilter(&self) -> Timing {
        match self.continuous_prefilter {
            true => Timing { sample_time_s: None, ..*self },
            false => *self,
        }
    }
}

/// The behaviour of the integral part while the command is limited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AntiWindup {
    /// It goes on integrating.
    #[default]
    None,
    /// The recursion continues from the limited command, so that the state is the one that would
    /// have given it.
    BackCalculation,
    /// The state is held while the command is limited and the error drives it further out.
    Clamping,
}

/// What is minimised or maximised among the controllers that satisfy every specification.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// lim s^r G(s), r the relative degree; in a sampled loop that of the elements before they are
    /// sampled, which by Tustin's rule is |G| at pi/T without its r zeros there.
    #[default]
    LeastHighFrequencyGain,
    /// The gain crossover of the nominal loop.
    LeastBandwidth,
    /// The least margin of all specifications.
    BestWorstMargin,
}

/// Feedback compensator G, prefilter F, timing and limits.
///
/// ```text
/// u = G(s) (F(s) r - y),    |u| <= limit
/// ```
///
/// # Example
/// The proportional-integral controller (0.001 s + 0.008)/s with a limit of 10 V
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Element};
/// let integral = Element::ProportionalIntegral { proportional_gain: 0.001, integral_gain: 0.008 };
/// let controller =
///     Controller { feedback: Compensator::new(vec![integral]), command_limit: Some(10.0), ..Controller::default() };
/// let g = controller.feedback.transfer_function()?;
/// assert_eq!((g.gain(), g.zeros()[0].re, g.poles()[0].re), (0.001, -8.0, 0.0));
/// # Ok::<(), phea_dynamics::linear::LinearError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// G, acting on the error.
    pub feedback: Compensator,
    /// F, acting on the reference.
    pub prefilter: Compensator,
    /// When it acts.
    pub timing: Timing,
    /// Largest magnitude of the command, in its own unit (V); absent: unlimited.
    pub command_limit: Option<f64>,
    /// The behaviour of the integral part at the limit.
    pub anti_windup: AntiWindup,
}
