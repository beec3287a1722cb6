//! The limits of what may be built, by name.

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
        DesignLimitKind::RequiredStep => "required_step",
    }
}

/// The name of a limit for people.
pub fn limit_words(kind: DesignLimitKind) -> &'static str {
    match kind {
        DesignLimitKind::NoiseToCommand => "noise to command",
        DesignLimitKind::ModulusMargin => "modulus margin",
        DesignLimitKind::HighestBandwidth => "bandwidth",
        DesignLimitKind::MinimumDelayMargin => "delay margin",
        DesignLimitKind::PoleDampingRatio => "damping of poles",
        DesignLimitKind::FastestPole => "fastest pole",
        DesignLimitKind::PrefilterGain => "gain of the prefilter",
        DesignLimitKind::RequiredStep => "way to the required step",
    }
}

impl DesignLimitKind {
    /// Whether a specification of the search only leads to it: the design is judged by something
    /// else.
    pub fn is_led_to(self) -> bool {
        matches!(self, DesignLimitKind::RequiredStep | DesignLimitKind::PrefilterGain)
    }
}
