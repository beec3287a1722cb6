//! The limits of what may be built: their keys, where their values come from, and those that a
//! loop does not keep.

/// What a limit is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesignLimitKind {
    /// Noise of the force sensor in the command.
    NoiseToCommand,
    /// Distance of the loop from -1.
    ModulusMargin,
    /// Frequency from which the loop no longer follows.
    HighestBandwidth,
    /// Delay beyond that of the loop.
    MinimumDelayMargin,
    /// Damping of the controller's poles.
    PoleDampingRatio,
    /// Natural frequency of the controller's poles.
    FastestPole,
    /// Gain of the prefilter.
    PrefilterGain,
    /// Command of the steps of the reference in the scenarios.
    CommandOfSteps,
    /// No limit but the way to a required step: limits of tracking that a search aims at.
    RequiredStep,
}

/// The key of a limit in `[design]`; of the fastest pole, which has none, a name.
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
    /// Whether `[design]` has a key of this name.
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

/// Fraction by which a limit is relaxed to find what that would buy.
pub const RELAXED_BY: f64 = 0.1;

impl DesignLimitKind {
    /// A value of the limit that is relaxed by a tenth: larger, or of a least value smaller.
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

    /// Whether a specification of the search only leads to it: the design is judged by something
    /// else.
    pub fn is_led_to(self) -> bool {
        matches!(self, DesignLimitKind::RequiredStep | DesignLimitKind::PrefilterGain)
    }
}

/// Reason why a limit has its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitOrigin {
    /// The project states it.
    Stated,
    /// It is the default of every rig.
    Default,
    /// The lines are a quarter wave long there.
    QuarterWave,
    /// The natural frequency of the servovalve.
    Servovalve,
    /// The sample time.
    Sampling,
    /// It follows from the highest bandwidth.
    Bandwidth,
}

/// The name of an origin for programs.
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

/// The limits of a design that an audited loop keeps and does not keep.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JudgedLimits {
    /// Those that it does not keep.
    pub exceeded: Vec<ExceededLimit>,
    /// Those that it keeps.
    pub kept: Vec<DesignLimitKind>,
}

/// A limit that an audited loop does not keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExceededLimit {
    /// Which limit.
    pub kind: DesignLimitKind,
    /// What the worst plant of the family reaches, in the unit of the limit; of the bandwidth the
    /// frequency from which |L/(1+L)| remains below -3 dB, infinite where none is known.
    pub reached: f64,
    /// The limit, in SI.
    pub limit: f64,
    /// Where its value comes from.
    pub origin: LimitOrigin,
}
