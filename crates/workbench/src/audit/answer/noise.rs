//! The noise of signals that are fed forward or back, in the answer of an audit.

use phea_engineering::audit::{SignalNoise, SignalNoiseEffect};
use phea_engineering::plant_names::{NamedPlant, PlantNames};

use crate::answer::{Answer, OrReason};
use crate::audit::signal_noise::unknown_words;
use crate::quantity::{FORCE, QuantityName, VELOCITY};

/// Noise of the load velocity that is fed forward, with its effects in a sampled loop.
#[derive(Answer)]
pub(super) struct VelocityNoiseAnswer {
    /// Noise and rounding of the velocity together.
    #[answer(key = QuantityName::moving("rms", &VELOCITY))]
    rms: f64,
    #[answer(flatten)]
    effect: NoiseEffectAnswer,
}

/// Noise of the pressures that are fed back, with its effects in a sampled loop.
#[derive(Answer)]
pub(super) struct PressureNoiseAnswer {
    /// Noise of the pressure signal.
    rms_pa: f64,
    #[answer(flatten)]
    effect: NoiseEffectAnswer,
}

/// Largest effects of a noise among the plants that are examined one by one.
#[derive(Answer)]
struct NoiseEffectAnswer {
    /// Effect on the command at the valve.
    command_rms_v: OrReason<f64>,
    /// Plant with this effect.
    #[answer(optional)]
    command_plant: Option<NamedPlant>,
    /// Effect on the force or torque.
    #[answer(key = QuantityName::OfMotion(["force_rms", "torque_rms"], &FORCE))]
    force_rms: OrReason<f64>,
    /// Plant with this effect.
    #[answer(optional)]
    force_plant: Option<NamedPlant>,
}

/// The noise of a velocity.
pub(super) fn velocity_noise(noise: &SignalNoise, names: &PlantNames) -> VelocityNoiseAnswer {
    VelocityNoiseAnswer { rms: noise.rms, effect: effect(noise, names) }
}

/// The noise of pressures.
pub(super) fn pressure_noise(noise: &SignalNoise, names: &PlantNames) -> PressureNoiseAnswer {
    PressureNoiseAnswer { rms_pa: noise.rms, effect: effect(noise, names) }
}

fn effect(noise: &SignalNoise, names: &PlantNames) -> NoiseEffectAnswer {
    let effect = noise.effect.as_ref();
    let known = |of: fn(&SignalNoiseEffect) -> f64| OrReason(effect.map(of).map_err(unknown_words));
    NoiseEffectAnswer {
        command_rms_v: known(|effect| effect.command_rms_v),
        command_plant: effect.ok().map(|effect| names.named(&effect.command_plant)),
        force_rms: known(|effect| effect.force_rms_n),
        force_plant: effect.ok().map(|effect| names.named(&effect.force_plant)),
    }
}
