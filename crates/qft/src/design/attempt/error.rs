//! Error of a design.

use phea_dynamics::linear::LinearError;
use phea_dynamics::watch::Stopped;

use crate::design::quantization::QuantizationError;
use crate::loop_shaping::SamplesError;
use crate::prefilter::PrefilterError;

/// Reason why a design cannot continue.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoopDesignError {
    /// A part is not a transfer function, or cannot be sampled.
    #[error("{0}")]
    Linear(#[from] LinearError),
    /// The plants cannot be evaluated.
    #[error("{0}")]
    Samples(#[from] SamplesError),
    /// There is no band for a prefilter.
    #[error("{0}")]
    Prefilter(PrefilterError),
    /// The coefficients of the controller cannot be represented in their format.
    #[error("{0}")]
    Quantization(#[from] QuantizationError),
    /// The watch stopped the design.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

impl From<PrefilterError> for LoopDesignError {
    fn from(error: PrefilterError) -> LoopDesignError {
        match error {
            PrefilterError::Stopped(stopped) => LoopDesignError::Stopped(stopped),
            error => LoopDesignError::Prefilter(error),
        }
    }
}
