//! Names of numbers and operations that a linear system rejects.

/// Number of a linear system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinearNumber {
    /// Gain.
    #[error("a gain")]
    Gain,
    /// Coefficient of a polynomial.
    #[error("a coefficient")]
    Coefficient,
    /// Zero or pole.
    #[error("a zero or pole")]
    ZeroOrPole,
    /// Entry of a matrix.
    #[error("an entry of a matrix")]
    MatrixEntry,
    /// Pole of a sampled plant.
    #[error("a pole of the sampled plant")]
    SampledPole,
    /// Gain of a sampled system.
    #[error("the gain of the sampled system")]
    SampledGain,
}

/// Operation on linear systems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinearOperation {
    /// Inverse.
    #[error("an inverse")]
    Inverse,
    /// Sum.
    #[error("a sum")]
    Sum,
    /// Closed loop.
    #[error("a closed loop")]
    ClosedLoop,
    /// Realisation by states.
    #[error("a state space")]
    StateSpace,
    /// Sections of a controller.
    #[error("sections")]
    Sections,
    /// Passivity of an impedance.
    #[error("passivity")]
    Passivity,
    /// Feedback of a rate within the plant.
    #[error("a rate that is fed back")]
    RateFeedback,
    /// Feedback of a rate and of an inner signal.
    #[error("a rate and an inner signal that are both fed back")]
    RateAndInnerFeedback,
    /// Discretisation.
    #[error("discretisation")]
    Discretisation,
    /// Discretisation by matched poles and zeros.
    #[error("matched discretisation")]
    MatchedDiscretisation,
    /// Prewarping of a discretisation.
    #[error("prewarping")]
    Prewarping,
    /// Logarithmic grid of frequencies.
    #[error("a logarithmic grid")]
    LogarithmicGrid,
    /// Action of a filter between samples.
    #[error("acting between samples")]
    BetweenSamples,
    /// Step response by samples.
    #[error("a step by samples")]
    StepBySamples,
    /// Sensor in a loop.
    #[error("a sensor")]
    Sensor,
    /// Search for a controller.
    #[error("loop shaping")]
    LoopShaping,
}
