//! Limits on what may be built, in words.

use phea_engineering::limit_kind::{DesignLimitKind, LimitOrigin};

/// The name of a limit for people.
pub(crate) fn limit_words(kind: DesignLimitKind) -> &'static str {
    match kind {
        DesignLimitKind::NoiseToCommand => "noise to command",
        DesignLimitKind::ModulusMargin => "modulus margin",
        DesignLimitKind::HighestBandwidth => "bandwidth",
        DesignLimitKind::MinimumDelayMargin => "delay margin",
        DesignLimitKind::PoleDampingRatio => "damping of poles",
        DesignLimitKind::FastestPole => "fastest pole",
        DesignLimitKind::PrefilterGain => "gain of the prefilter",
        DesignLimitKind::CommandOfSteps => "command of steps",
        DesignLimitKind::RequiredStep => "way to the required step",
    }
}

/// The name of an origin for people.
pub(crate) fn origin_words(origin: LimitOrigin) -> &'static str {
    match origin {
        LimitOrigin::Stated => "stated",
        LimitOrigin::Default => "default",
        LimitOrigin::QuarterWave => "quarter wave of the lines",
        LimitOrigin::Servovalve => "natural frequency of the valve",
        LimitOrigin::Sampling => "sample time",
        LimitOrigin::Bandwidth => "ten times the bandwidth",
    }
}
