//! The effect of the noise of the signals that a controller reads in addition to the force, in a
//! sentence.

use phea_engineering::audit::{NoisySignal, SignalNoise, UnknownNoiseEffect};
use phea_engineering::plant_names::PlantNames;
use phea_qft::design::quantization::QuantizationError;
use phea_qft::verification::PlantPoint;

use super::family_and_loop::no_polynomials_words;
use crate::plant_names::plant_text;
use crate::quantity::{PRESSURE, VELOCITY, display, significant};

/// The noise and its largest effects, or the reason why these are not known.
pub fn noise_sentence(noise: &SignalNoise, names: &PlantNames) -> String {
    let (what, dimension) = match noise.signal {
        NoisySignal::LoadVelocity => ("measured load velocity", noise.units.motion.dimension(&VELOCITY)),
        NoisySignal::Pressures => ("pressures that are fed back", &PRESSURE),
    };
    let rms = display(noise.rms, dimension, 3);
    match &noise.effect {
        Ok(effect) => {
            let of = |plant: &PlantPoint| match names.headings().is_empty() {
                true => String::new(),
                false => format!(" ({})", plant_text(names, plant)),
            };
            format!(
                "the noise of the {what}, {rms} rms, moves the command at the valve by {} mV rms{} and the {} by {} rms{}",
                significant(1e3 * effect.command_rms_v, 3),
                of(&effect.command_plant),
                noise.units.motion.words().force,
                noise.units.force.text(effect.force_rms_n, 3),
                of(&effect.force_plant),
            )
        }
        Err(unknown) => {
            let reason = unknown_words(unknown);
            format!("the effect of the noise of the {what}, {rms} rms, is not known: {reason}")
        }
    }
}

/// The reason why the effects are not known.
pub(super) fn unknown_words(unknown: &UnknownNoiseEffect) -> String {
    match unknown {
        UnknownNoiseEffect::Unstable => "not every plant is stable".to_string(),
        UnknownNoiseEffect::NoPolynomials(why) => {
            format!("only a simulation shows it with {}", no_polynomials_words(*why))
        }
        UnknownNoiseEffect::Member(error) => error.to_string(),
        UnknownNoiseEffect::Response(QuantizationError::NotSettled { .. }) => {
            "with one plant at least it does not die away in the loop".to_string()
        }
        UnknownNoiseEffect::Response(error) => error.to_string(),
    }
}
