//! Responses in time, the metrics of a step response, and second-order specifications.
//!
//! # Example
//! The step response of a second-order system, measured and predicted:
//! ```
//! use phea_dynamics::time_response::{SecondOrder, StepBaseline, step_metrics, step_response, uniform_times};
//! # fn main() -> Result<(), phea_dynamics::time_response::TimeResponseError> {
//! let model = SecondOrder::new(10.0, 0.5)?;
//! let times = uniform_times(2.0, 2001)?;
//! let values = step_response(&model.transfer_function(), &times)?;
//! let metrics = step_metrics(&times, &values, StepBaseline::unit(), 2.0)?;
//! assert!((metrics.overshoot_percent - model.overshoot_percent()).abs() < 1e-4);
//! assert!((metrics.peak_time_s - model.peak_time_s().unwrap_or(f64::NAN)).abs() < 1e-3);
//! # Ok(())
//! # }
//! ```

mod cosine_sums;
mod delayed_loop;
mod linear_response;
mod of_frequency_response;
mod quantities;
mod sampled_loop;
mod second_order;
mod signal;
mod step_metrics;

pub use delayed_loop::delayed_loop_step;
pub use linear_response::{forced_response, forced_response_of_states, step_response};
pub use of_frequency_response::{step_of_frequency_response, weights_of_frequency_response};
pub use quantities::{ResponseCount, ResponseNumber};
pub use sampled_loop::sampled_loop_step;
pub use second_order::{SecondOrder, SettlingRule, damping_ratio_from_overshoot};
pub use signal::{Interpolation, SampledSignal, uniform_times};
pub use step_metrics::{Settling, StepBaseline, StepMetrics, step_metrics};

use crate::linear::LinearError;
use crate::range::RequiredRange;

/// Error for a response in time, or a characteristic of one, that does not exist.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TimeResponseError {
    /// Error of the linear system.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// Two lists that belong together but differ in length.
    #[error("{what}: {found} where {expected} are needed")]
    Count {
        /// Name of the count.
        what: ResponseCount,
        /// Number found.
        found: usize,
        /// Number required.
        expected: usize,
    },
    /// Times that decrease, are negative where they must not be, or are not finite.
    #[error("time number {index} ({time_s} s) is out of order")]
    TimeOrder {
        /// Position in the list, from zero.
        index: usize,
        /// The time, s.
        time_s: f64,
    },
    /// A number outside the range in which the formula has a meaning.
    #[error("{what} is {value}; it must be {expected}")]
    OutOfRange {
        /// Name of the number.
        what: ResponseNumber,
        /// The number.
        value: f64,
        /// Range of the number.
        expected: RequiredRange,
    },
    /// Baseline without a step: its initial and final values are equal.
    #[error("initial and final value are equal ({value}): there is no step to measure")]
    NoStep {
        /// Both values.
        value: f64,
    },
}
