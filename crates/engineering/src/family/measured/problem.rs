//! Problems of a file with a measured response, and its expected content.

/// A problem of the headings, or of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum MeasurementProblem {
    /// No column is a frequency.
    #[error("the columns lack a frequency: `frequency_hz` or `frequency_rad_per_s`")]
    NoFrequency,
    /// No pair of columns is a response.
    #[error(
        "the columns lack a magnitude and a phase (`magnitude_db` or `magnitude`, `phase_deg` or `phase_rad`), or `real` and `imaginary`, one pair of them"
    )]
    NoResponse,
    /// The response to the motion of the load is incomplete.
    #[error(
        "the columns lack half of the load motion's pair: a magnitude and a phase (`magnitude_db` or `magnitude`, `phase_deg` or `phase_rad`), or `real` and `imaginary`, each with `load_motion_` before it"
    )]
    HalfOfLoadMotion,
    /// A frequency is zero or negative.
    #[error("frequencies must be positive")]
    FrequencyNotPositive,
    /// A frequency is not above the ones before.
    #[error("frequencies must increase from row to row")]
    FrequencyNotRising,
    /// A radius of a confidence disc is negative.
    #[error("a radius is not negative")]
    NegativeRadius,
    /// A magnitude is negative.
    #[error("a magnitude is not negative")]
    NegativeMagnitude,
    /// A response is zero.
    #[error("the response is zero: it has no logarithm to interpolate")]
    ZeroResponse,
}

/// A value that is expected instead of a wrong one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum ExpectedValue {
    /// A frequency above the ones before, in this unit.
    #[error("a higher frequency in {unit}")]
    HigherFrequency {
        /// The unit.
        unit: String,
    },
    /// The radius of a confidence disc.
    #[error("the radius of the disc that holds the response with 95 %")]
    Radius,
    /// A magnitude without a sign.
    #[error("the sign in the phase, as 180 degrees")]
    SignInPhase,
    /// A response that has a logarithm.
    #[error("a response that is not zero, or no row for this frequency")]
    NonzeroResponse,
}
