//! The effect of the converters of the controller's computer, in words.

use phea_engineering::design::{RoundedSignal, Rounding};
use phea_qft::design::quantization::LimitCycle;

use crate::quantity::{DisplayUnit, significant};

/// The word of a signal, in sentences and in JSON.
pub(super) fn signal_word(signal: RoundedSignal) -> &'static str {
    match signal {
        RoundedSignal::Command => "command",
        RoundedSignal::Measurement => "measurement",
        RoundedSignal::Output => "output",
    }
}

/// The effect in sentences, the output in this unit and the command in V; bare numbers for a plant
/// without units.
pub(super) fn rounding_sentences(rounding: &Rounding, unit: Option<DisplayUnit>) -> Vec<String> {
    let effects = match rounding.effects() {
        Ok(effects) => effects,
        Err(error) => return vec![format!("the effect of the converters is unknown: {error}")],
    };
    let mut sentences: Vec<String> = rounding
        .each()
        .into_iter()
        .map(|(of, on, effect)| {
            let shown = |size: f64| match (unit, on) {
                (None, _) => significant(size, 3),
                (Some(_), RoundedSignal::Command) => DisplayUnit::VOLT.text(size, 3),
                (Some(unit), _) => unit.text(size, 3),
            };
            let [peak, rms] = [effect.peak, effect.rms].map(shown);
            let [of, on] = [of, on].map(signal_word);
            format!("the rounded {of} moves the {on} by {rms} rms, and by {peak} at most")
        })
        .collect();
    sentences.extend(effects.limit_cycle.and_then(|cycle| match cycle {
        LimitCycle::NotIntegrating => None,
        LimitCycle::CanRest { .. } => {
            Some("the loop can come to rest between the levels of its converters".to_string())
        }
        LimitCycle::Expected { .. } => Some(
            "no level of the command leaves an error that the measurement does not show: expect the command to wander between two"
                .to_string(),
        ),
    }));
    sentences
}
