//! Why a design cannot go on.

use phea_dynamics::linear::LinearError;

use crate::design::quantisation::QuantisationError;
use crate::loop_shaping::SamplesError;
use crate::prefilter::PrefilterError;

/// Why a step of the design cannot be made at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DesignError {
    /// A part is no transfer function, or cannot be sampled.
    #[error("{0}")]
    Linear(#[from] LinearError),
    /// The plants cannot be looked at.
    #[error("{0}")]
    Samples(#[from] SamplesError),
    /// There is no band for a prefilter.
    #[error("{0}")]
    Prefilter(#[from] PrefilterError),
    /// The coefficients of the controller cannot be kept in their format.
    #[error("{0}")]
    Quantisation(#[from] QuantisationError),
}
