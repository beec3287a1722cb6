//! What converters do to a designed loop, as JSON shows it.

use phea_qft::design::quantisation::LimitCycle;
use serde::Serialize;

use crate::answer::Number;
use crate::audit::{NamedPlant, PlantNames};
use crate::design::Rounding;

#[derive(Serialize)]
pub(super) struct RoundingRow {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    effects: Vec<EffectRow>,
    #[serde(skip_serializing_if = "Option::is_none")]
    command_steps_at_once: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit_cycle: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

#[derive(Serialize)]
struct EffectRow {
    of: &'static str,
    on: &'static str,
    peak: Number,
    peak_plant: NamedPlant,
    rms: Number,
    rms_plant: NamedPlant,
}

pub(super) fn row(rounding: &Rounding, names: &PlantNames) -> RoundingRow {
    let plant = |index: usize| names.named(&rounding.plant(index));
    let effects = rounding.each().into_iter().map(|(of, on, effect)| EffectRow {
        of,
        on,
        peak: Number(effect.peak),
        peak_plant: plant(effect.peak_plant),
        rms: Number(effect.rms),
        rms_plant: plant(effect.rms_plant),
    });
    let known = rounding.effects().ok();
    RoundingRow {
        effects: effects.collect(),
        command_steps_at_once: known.and_then(|effects| effects.command_steps_at_once),
        limit_cycle: known.and_then(|effects| effects.limit_cycle).map(|cycle| match cycle {
            LimitCycle::NotIntegrating => "not_integrating",
            LimitCycle::CanRest { .. } => "can_rest",
            LimitCycle::Expected { .. } => "expected",
        }),
        reason: rounding.effects().err().map(str::to_string),
    }
}
