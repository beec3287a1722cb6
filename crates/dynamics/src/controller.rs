//! A controller as a single value: its elements, its timing, and its limits.
//!
//! Loop shaping edits the elements, verification uses the responses, simulation and generated code
//! use the sample step of [`SampledController`]: all four use one value.

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

/// Timing of the controller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Sample time in s; absent for a continuous controller.
    pub sample_time_s: Option<f64>,
    /// Computation and transport delay of the loop in s.
    pub delay_s: f64,
    /// Method by which continuous elements are discretised.
    pub discretization: Discretization,
    /// True if the prefilter acts on the reference before it is sampled, in continuous time.
    pub continuous_prefilter: bool,
    /// Gain of the feed-forward of a disturbance's rate, sampled and delayed like the command: K in
    /// U = G (F R - Y) + K H_v s D. Zero without feed-forward.
    pub rate_feed_forward: f64,
    /// Sensor H_v of that rate, its filter and dead time, before the sampler.
    pub rate_sensor: RateSensor,
    /// Transfer function H of a second signal that is fed back, sampled and delayed like the
    /// command: U = G (F R - Y) - H P. In a continuous loop it is part of the plant.
    pub inner_feedback: InnerFeedback,
}

impl Timing {
    /// Timing of the prefilter: sampled with the controller, or in continuous time before the
    /// sampler.
    pub fn of_prefilter(&self) -> Timing {
        match self.continuous_prefilter {
            true => Timing { sample_time_s: None, ..*self },
            false => *self,
        }
    }
}

/// Behaviour of the integral part while the command is limited: u the command within its limit
/// u_m, u_w the command without it, e the error.
///
/// ```text
/// none               x' = A x + B e
/// back calculation   x' = A x + B (e + (u - u_w)/D)         D the feedthrough of G: this error would give u
/// clamping           x' = (1 - h) (A x + B e)               h = (|u_w| - u_m)/(10^-4 u_m) within [0, 1] while u_w e > 0, else 0
/// ```
///
/// A sampled controller steps from x_k to x_k+1 accordingly: back calculation continues the
/// recursion of the last section from its limited output, and clamping leaves x_k unchanged.
///
/// Sources: Åström and Wittenmark (1997) for back calculation; clamping is conditional integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AntiWindup {
    /// The integral part continues to integrate.
    #[default]
    None,
    /// The recursion continues from the limited command, so that the state is the one that would
    /// have produced this command.
    BackCalculation,
    /// The state is held while the command is limited and the error drives it further out.
    Clamping,
}

/// Quantity that is minimised or maximised among the controllers that satisfy every specification.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// lim s^r G(s), r the relative degree; in a sampled loop, the limit of the elements before
    /// sampling; by Tustin's rule it is |G| at pi/T without its r zeros there.
    #[default]
    LeastHighFrequencyGain,
    /// Gain crossover frequency of the nominal loop.
    LeastBandwidth,
    /// Smallest margin over all specifications.
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
    /// Feedback compensator G, acting on the error.
    pub feedback: Compensator,
    /// Prefilter F, acting on the reference.
    pub prefilter: Compensator,
    /// Timing.
    pub timing: Timing,
    /// Largest magnitude of the command, in its own unit (V); unlimited if absent.
    pub command_limit: Option<f64>,
    /// Behaviour of the integral part at the limit.
    pub anti_windup: AntiWindup,
}
