//! The effect of converters on a designed loop, in JSON.

use phea_engineering::design::{RoundedSignal, Rounding};
use phea_engineering::plant_names::{NamedPlant, PlantNames};
use phea_qft::design::quantization::LimitCycle;

use crate::answer::{Answer, words};
use crate::design::rounding::signal_word;

/// Effect of the converters of the controller's computer on the loop.
#[derive(Answer)]
pub(super) struct RoundingAnswer {
    /// Effect of each rounded signal on others; left out if there is none.
    #[answer(optional)]
    effects: Option<Vec<RoundingEffectAnswer>>,
    /// Immediate change of the command for one step of the measurement, in steps of the command.
    #[answer(optional)]
    command_steps_at_once: Option<f64>,
    /// Ability of the loop to come to rest; left out if it is unknown.
    #[answer(optional)]
    limit_cycle: Option<LimitCycle>,
    /// Reason for which the effect is unknown.
    #[answer(optional)]
    reason: Option<String>,
}

/// Largest effect of a rounded signal over the plants, in the SI unit of the affected signal.
#[derive(Answer)]
struct RoundingEffectAnswer {
    /// Rounded signal.
    of: RoundedSignal,
    /// Affected signal.
    on: RoundedSignal,
    /// Largest possible effect at any sample.
    peak: f64,
    /// Plant with this peak.
    peak_plant: NamedPlant,
    /// Root-mean-square effect of independent rounding errors.
    rms: f64,
    /// Plant with this root-mean-square effect.
    rms_plant: NamedPlant,
}

words! {
    /// Signal that a converter rounds, or that rounding affects.
    RoundedSignal by signal_word [Command, Measurement, Output]
}

words! {
    /// Ability of a loop to come to rest between the levels of its converters: it does not
    /// integrate, it can rest, or a limit cycle between two levels is expected.
    LimitCycle {
        NotIntegrating => "not_integrating",
        CanRest { .. } => "can_rest",
        Expected { .. } => "expected",
    }
}

/// The effect of the converters.
pub(super) fn answer(rounding: &Rounding, names: &PlantNames) -> RoundingAnswer {
    let plant = |index: usize| names.named(&rounding.plant(index));
    let effects = rounding.each().into_iter().map(|(of, on, effect)| RoundingEffectAnswer {
        of,
        on,
        peak: effect.peak,
        peak_plant: plant(effect.peak_plant),
        rms: effect.rms,
        rms_plant: plant(effect.rms_plant),
    });
    let effects: Vec<RoundingEffectAnswer> = effects.collect();
    let known = rounding.effects().ok();
    RoundingAnswer {
        effects: Some(effects).filter(|effects| !effects.is_empty()),
        command_steps_at_once: known.and_then(|effects| effects.command_steps_at_once),
        limit_cycle: known.and_then(|effects| effects.limit_cycle),
        reason: rounding.effects().err().map(ToString::to_string),
    }
}
