//! Names of quantities that a response in time rejects.

/// Count of a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResponseCount {
    /// Values of a sampled signal.
    #[error("values of a signal")]
    SignalValues,
    /// Values of a response.
    #[error("values of a response")]
    ResponseValues,
    /// Samples from the step on.
    #[error("samples after the step")]
    SamplesAfterStep,
    /// Signals of the inputs.
    #[error("input signals")]
    InputSignals,
    /// States at the start.
    #[error("initial states")]
    InitialStates,
}

/// Number of a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResponseNumber {
    /// Value of a sampled signal.
    #[error("a value of a signal")]
    SignalValue,
    /// Value of a response.
    #[error("a value of the response")]
    ResponseValue,
    /// Duration, s.
    #[error("a duration")]
    Duration,
    /// Undamped natural frequency, rad/s.
    #[error("the natural frequency in rad/s")]
    NaturalFrequency,
    /// Damping ratio.
    #[error("the damping ratio")]
    DampingRatio,
    /// Settling time, s.
    #[error("the settling time in s")]
    SettlingTime,
    /// Settling band, percent.
    #[error("the settling band in percent")]
    SettlingBand,
    /// Overshoot, percent.
    #[error("the overshoot in percent")]
    Overshoot,
    /// 1 + L at infinite frequency.
    #[error("1 + L(inf)")]
    LoopAtOnce,
}
