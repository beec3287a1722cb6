//! Names of quantities that a simulation rejects.

/// Count of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SimulationCount {
    /// States at the start.
    #[error("states at the start")]
    StartStates,
    /// Inputs.
    #[error("inputs")]
    Inputs,
    /// Scales of the states.
    #[error("scales")]
    Scales,
    /// States that an observer requires.
    #[error("states that are looked at")]
    ObservedStates,
    /// Finished machines.
    #[error("results")]
    Results,
}

/// Number of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SimulationNumber {
    /// Duration, s.
    #[error("duration")]
    Duration,
    /// Time between rows, s.
    #[error("output step")]
    OutputStep,
    /// Sample time of the controller, s.
    #[error("sample time")]
    SampleTime,
    /// Delay of a wave, s.
    #[error("delay of a wave")]
    WaveDelay,
    /// Typical magnitude of a state.
    #[error("scale of a state")]
    StateScale,
    /// Delay of the command, s.
    #[error("delay of the command")]
    CommandDelay,
    /// Relative error of a step.
    #[error("tolerance")]
    Tolerance,
    /// Frequency of a sine response, rad/s.
    #[error("plan of a sine")]
    SinePlan,
}
