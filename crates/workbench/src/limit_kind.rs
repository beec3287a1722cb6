//! The limits of what may be built, in words and in JSON.

use phea_engineering::limit_kind::{DesignLimitKind, LimitOrigin, limit_key, limit_unit_key, origin_key};

use crate::answer::{KeyList, Keyed, ObjectKey, words};

words! {
    /// Limit of what may be built: its key in `[design]`, or a name of its own.
    DesignLimitKind by limit_key [
        NoiseToCommand, ModulusMargin, HighestBandwidth, MinimumDelayMargin, PoleDampingRatio,
        FastestPole, PrefilterGain, CommandOfSteps, RequiredStep,
    ]
}

words! {
    /// Origin of the value of a limit.
    LimitOrigin by origin_key [Stated, Default, QuarterWave, Servovalve, Sampling, Bandwidth]
}

/// Key of a quantity in the unit of a limit.
pub(crate) trait InLimitUnit {
    /// Key without its unit.
    const STEM: &str;
    /// Description without its unit.
    const DESCRIPTION: &str;
}

/// Keys of what a loop reaches of a limit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LimitValueKeys;

impl InLimitUnit for LimitValueKeys {
    const STEM: &str = "value";
    const DESCRIPTION: &str = "Value";
}

/// Keys of the limit itself.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LimitKeys;

impl InLimitUnit for LimitKeys {
    const STEM: &str = "limit";
    const DESCRIPTION: &str = "Limit";
}

impl<Own: InLimitUnit> KeyList for Own {
    const ONE: bool = true;

    fn keys() -> Vec<(ObjectKey, String)> {
        let units = [
            ("", "of a ratio or gain"),
            ("_rad_per_s", "of a bandwidth or natural frequency"),
            ("_s", "of a delay"),
        ];
        let key = |(unit, of): (&str, &str)| {
            (format!("{}{unit}", Own::STEM).into(), format!("{} {of}.", Own::DESCRIPTION))
        };
        units.map(key).to_vec()
    }
}

/// A value in the unit of a limit.
pub(crate) fn in_limit_unit<Own: InLimitUnit>(kind: DesignLimitKind, value: f64) -> Keyed<Own, f64> {
    Keyed::new([(format!("{}{}", Own::STEM, limit_unit_key(kind)).into(), value)])
}

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
