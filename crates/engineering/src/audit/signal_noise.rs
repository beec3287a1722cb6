//! The effect of the noise of what a controller reads in addition to the force on the valve's
//! command and the force.

use phea_qft::design::quantization::{QuantizationError, RateNoise, inner_noise, rate_noise};
use phea_qft::family::Family;
use phea_qft::verification::{PlantPoint, Verdict};

use crate::plant_names::PlantNames;
use crate::quantity::{PRESSURE, Units, VELOCITY, display, significant};
use crate::robust::RobustProblem;

/// What a controller reads in addition to the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoisySignal {
    /// The velocity of the load, which is fed forward.
    LoadVelocity,
    /// The pressures of the chambers, which are fed back.
    Pressures,
}

/// The noise of such a signal with the effects that it has in a sampled loop.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalNoise {
    /// Which signal.
    pub signal: NoisySignal,
    /// m/s or Pa rms: noise and rounding of the velocity together, noise of the pressure signal.
    pub rms: f64,
    /// How the rig moves.
    pub units: Units,
    /// The largest effects in the family, or why they are not known.
    pub effect: Result<SignalNoiseEffect, String>,
}

/// The largest effects among the plants of a family that are examined one by one.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalNoiseEffect {
    /// On the command at the valve, V rms.
    pub command_rms_v: f64,
    /// The plant with this effect.
    pub command_plant: PlantPoint,
    /// On the force, N rms.
    pub force_rms_n: f64,
    /// The plant with this effect.
    pub force_plant: PlantPoint,
}

impl SignalNoise {
    /// In the loop of this problem; `None` where there is no noise, or the signal is not read.
    pub(super) fn of(
        signal: NoisySignal,
        problem: &RobustProblem,
        stability: Verdict,
    ) -> Option<SignalNoise> {
        let around = &problem.compensation;
        let (rms, read) = match signal {
            NoisySignal::LoadVelocity => (problem.velocity_noise, around.rate_feed_forward() != 0.0),
            NoisySignal::Pressures => (problem.pressure_noise, around.inner_feedback().is_some()),
        };
        if rms == 0.0 || !read {
            return None;
        }
        let effect = match problem.without_polynomials {
            _ if stability == Verdict::Violated => Err("not every plant is stable".to_string()),
            Some(why) => Err(format!("only a simulation shows it with {why}")),
            None => problem.members().map_err(|error| error.to_string()).and_then(|members| {
                let found = match signal {
                    NoisySignal::LoadVelocity => rate_noise(around, &members, rms),
                    NoisySignal::Pressures => inner_noise(around, &members, rms),
                };
                found.map(|found| named(&found, problem)).map_err(|error| words(&error))
            }),
        };
        Some(SignalNoise { signal, rms, units: problem.units, effect })
    }

    /// In a sentence.
    pub fn sentence(&self, names: &PlantNames) -> String {
        let (what, dimension) = match self.signal {
            NoisySignal::LoadVelocity => ("measured load velocity", self.units.motion.dimension(&VELOCITY)),
            NoisySignal::Pressures => ("pressures that are fed back", &PRESSURE),
        };
        let rms = display(self.rms, dimension, 3);
        match &self.effect {
            Ok(effect) => {
                let of = |plant: &PlantPoint| match names.headings().is_empty() {
                    true => String::new(),
                    false => format!(" ({})", names.text(plant)),
                };
                format!(
                    "the noise of the {what}, {rms} rms, moves the command at the valve by {} mV rms{} and the force by {} rms{}",
                    significant(1e3 * effect.command_rms_v, 3),
                    of(&effect.command_plant),
                    self.units.force.text(effect.force_rms_n, 3),
                    of(&effect.force_plant),
                )
            }
            Err(reason) => {
                format!("the effect of the noise of the {what}, {rms} rms, is not known: {reason}")
            }
        }
    }
}

fn words(error: &QuantizationError) -> String {
    match error {
        QuantizationError::NotSettled { .. } => {
            "with one plant at least it does not die away in the loop".to_string()
        }
        other => other.to_string(),
    }
}

fn named(found: &RateNoise, problem: &RobustProblem) -> SignalNoiseEffect {
    let plant = |index: usize| match &problem.family {
        Family::Uncertain(family) => {
            PlantPoint::Parameters(family.members().get(index).cloned().unwrap_or_default())
        }
        Family::Measured(_) => PlantPoint::Measured(index),
    };
    SignalNoiseEffect {
        command_rms_v: found.command_rms,
        command_plant: plant(found.command_plant),
        force_rms_n: found.output_rms,
        force_plant: plant(found.output_plant),
    }
}
