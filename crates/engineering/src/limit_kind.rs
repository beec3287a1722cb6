//! Limits of a deployable controller: their keys, the origins of their values, and those that a
//! loop violates.

/// Quantity of a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignLimitKind {
    /// Noise of the force sensor in the command.
    NoiseToCommand,
    /// Distance of the loop from -1.
    ModulusMargin,
    /// Frequency from which the loop no longer follows its reference.
    HighestBandwidth,
    /// Delay in addition to that of the loop.
    MinimumDelayMargin,
    /// Damping of the controller's poles.
    PoleDampingRatio,
    /// Natural frequency of the controller's poles.
    FastestPole,
    /// Gain of the prefilter.
    PrefilterGain,
    /// Command of the steps of the reference in the scenarios.
    CommandOfSteps,
    /// Limits of tracking at which a search aims, on the path to a required step.
    RequiredStep,
}

/// Key of a limit in `[design]`; for the fastest pole, which has no key, a name.
pub fn limit_key(kind: DesignLimitKind) -> &'static str {
    match kind {
        DesignLimitKind::NoiseToCommand => "noise_to_command",
        DesignLimitKind::ModulusMargin => "modulus_margin",
        DesignLimitKind::HighestBandwidth => "highest_bandwidth",
        DesignLimitKind::MinimumDelayMargin => "minimum_delay_margin",
        DesignLimitKind::PoleDampingRatio => "pole_damping_ratio",
        DesignLimitKind::FastestPole => "fastest_pole",
        DesignLimitKind::PrefilterGain => "prefilter_gain",
        DesignLimitKind::CommandOfSteps => "command_of_steps",
        DesignLimitKind::RequiredStep => "required_step",
    }
}

impl DesignLimitKind {
    /// True if `[design]` has a key of this name.
    pub fn has_key(self) -> bool {
        !matches!(self, DesignLimitKind::FastestPole | DesignLimitKind::RequiredStep)
    }
}

/// The unit of a limit at the end of a key: `value_rad_per_s`, `value_s`, or `value` without one.
pub fn limit_unit_key(kind: DesignLimitKind) -> &'static str {
    match kind {
        DesignLimitKind::HighestBandwidth | DesignLimitKind::FastestPole => "_rad_per_s",
        DesignLimitKind::MinimumDelayMargin => "_s",
        DesignLimitKind::NoiseToCommand
        | DesignLimitKind::ModulusMargin
        | DesignLimitKind::PoleDampingRatio
        | DesignLimitKind::PrefilterGain
        | DesignLimitKind::CommandOfSteps
        | DesignLimitKind::RequiredStep => "",
    }
}

/// Fraction by which a limit is relaxed to find the resulting gain.
pub const RELAXED_BY: f64 = 0.1;

impl DesignLimitKind {
    /// Value of the limit relaxed by a tenth: larger, or smaller for a least value.
    pub fn relaxed(self, value: f64) -> f64 {
        match self {
            DesignLimitKind::ModulusMargin
            | DesignLimitKind::MinimumDelayMargin
            | DesignLimitKind::PoleDampingRatio => (1.0 - RELAXED_BY) * value,
            DesignLimitKind::NoiseToCommand
            | DesignLimitKind::HighestBandwidth
            | DesignLimitKind::FastestPole
            | DesignLimitKind::PrefilterGain
            | DesignLimitKind::CommandOfSteps
            | DesignLimitKind::RequiredStep => (1.0 + RELAXED_BY) * value,
        }
    }

    /// True if a specification of the search only leads towards the limit, while the design is
    /// judged by something else.
    pub fn is_led_to(self) -> bool {
        matches!(self, DesignLimitKind::RequiredStep | DesignLimitKind::PrefilterGain)
    }
}

/// Reason why a limit has its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitOrigin {
    /// Statement in the project.
    Stated,
    /// Default for every rig.
    Default,
    /// Quarter-wave frequency of the lines.
    QuarterWave,
    /// Natural frequency of the servovalve.
    Servovalve,
    /// Sample time.
    Sampling,
    /// Consequence of the highest bandwidth.
    Bandwidth,
}

/// Key of an origin in output for programs.
pub fn origin_key(origin: LimitOrigin) -> &'static str {
    match origin {
        LimitOrigin::Stated => "stated",
        LimitOrigin::Default => "default",
        LimitOrigin::QuarterWave => "quarter_wave",
        LimitOrigin::Servovalve => "servovalve",
        LimitOrigin::Sampling => "sampling",
        LimitOrigin::Bandwidth => "highest_bandwidth",
    }
}

/// Limits of a design that an audited loop satisfies or violates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JudgedLimits {
    /// Violated limits.
    pub exceeded: Vec<ExceededLimit>,
    /// Satisfied limits.
    pub satisfied: Vec<DesignLimitKind>,
}

/// A limit that an audited loop violates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExceededLimit {
    /// Kind of the limit.
    pub kind: DesignLimitKind,
    /// Value that the worst plant of the family reaches, in the unit of the limit; for the
    /// bandwidth, the frequency above which |L/(1+L)| remains below -3 dB, infinite if none is
    /// known.
    pub reached: f64,
    /// Value of the limit, SI.
    pub limit: f64,
    /// Origin of the value.
    pub origin: LimitOrigin,
}
