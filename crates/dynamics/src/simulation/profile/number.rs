/// Number of a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProfileNumber {
    /// Value of a step.
    #[error("a value of the steps")]
    StepValue,
    /// Start of a smooth step, s.
    #[error("the start of a smooth step")]
    SmoothStepStart,
    /// Duration of a smooth step, s.
    #[error("the duration of a smooth step")]
    SmoothStepDuration,
    /// Height of a smooth step.
    #[error("the distance of a smooth step")]
    SmoothStepDistance,
    /// Start of a ramp, s.
    #[error("the start of a ramp")]
    RampStart,
    /// Duration of a ramp, s.
    #[error("the duration of a ramp")]
    RampDuration,
    /// Height of a ramp.
    #[error("the height of a ramp")]
    RampHeight,
    /// Start of a first-order step, s.
    #[error("the start of a first-order step")]
    LagStart,
    /// Time constant of a first-order step, s.
    #[error("the time constant of a first-order step")]
    LagTimeConstant,
    /// Height of a first-order step.
    #[error("the distance of a first-order step")]
    LagDistance,
    /// Start of a sine, s.
    #[error("the start of a sine")]
    SineStart,
    /// Amplitude of a sine.
    #[error("the amplitude of a sine")]
    SineAmplitude,
    /// Frequency of a sine, rad/s.
    #[error("the frequency of a sine")]
    SineFrequency,
    /// Start of a chirp, s.
    #[error("the start of a chirp")]
    ChirpStart,
    /// Duration of a chirp, s.
    #[error("the duration of a chirp")]
    ChirpDuration,
    /// Amplitude of a chirp.
    #[error("the amplitude of a chirp")]
    ChirpAmplitude,
    /// Frequency at which a chirp begins, rad/s.
    #[error("the initial frequency of a chirp")]
    ChirpInitialFrequency,
    /// Frequency at which a chirp ends, rad/s.
    #[error("the final frequency of a chirp")]
    ChirpFinalFrequency,
    /// Value of a table.
    #[error("a value of the table")]
    TableValue,
    /// Start of a multisine, s.
    #[error("the start of a multisine")]
    MultisineStart,
    /// Amplitude of a harmonic.
    #[error("an amplitude of a multisine")]
    MultisineAmplitude,
    /// Frequency of a harmonic, rad/s.
    #[error("a frequency of a multisine")]
    MultisineFrequency,
    /// Phase of a harmonic, rad.
    #[error("a phase of a multisine")]
    MultisinePhase,
}
