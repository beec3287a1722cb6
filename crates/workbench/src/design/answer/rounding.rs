//! The effect of converters on a designed loop, in JSON.

use phea_qft::design::quantization::LimitCycle;

use crate::answer::Object;
use crate::plant_names::PlantNames;

use crate::design::Rounding;
use crate::design::rounding::signal_word;

pub(super) fn row(rounding: &Rounding, names: &PlantNames) -> Object {
    let plant = |index: usize| names.named(&rounding.plant(index));
    let effects = rounding.each().into_iter().map(|(of, on, effect)| {
        Object::new()
            .with("of", signal_word(of))
            .with("on", signal_word(on))
            .with("peak", effect.peak)
            .with("peak_plant", plant(effect.peak_plant))
            .with("rms", effect.rms)
            .with("rms_plant", plant(effect.rms_plant))
    });
    let effects: Vec<Object> = effects.collect();
    let known = rounding.effects().ok();
    let limit_cycle = known.and_then(|effects| effects.limit_cycle).map(|cycle| match cycle {
        LimitCycle::NotIntegrating => "not_integrating",
        LimitCycle::CanRest { .. } => "can_rest",
        LimitCycle::Expected { .. } => "expected",
    });
    Object::new()
        .maybe("effects", Some(effects).filter(|effects| !effects.is_empty()))
        .maybe("command_steps_at_once", known.and_then(|effects| effects.command_steps_at_once))
        .maybe("limit_cycle", limit_cycle)
        .maybe("reason", rounding.effects().err().map(ToString::to_string))
}
