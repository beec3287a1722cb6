//! The effect of the noise of the velocity that is fed forward on the valve's command and the
//! force.

use phea_qft::design::quantization::{QuantizationError, RateNoise, rate_noise};
use phea_qft::family::Family;
use phea_qft::verification::{PlantPoint, Verdict};

use crate::plant_names::PlantNames;
use crate::quantity::{Units, VELOCITY, display, significant};
use crate::robust::RobustProblem;

/// The noise of the measured velocity of the load with the effects that it has in a sampled loop.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocityNoise {
    /// Noise and rounding of the velocity together, m/s rms.
    pub rms_m_per_s: f64,
    /// How the rig moves.
    pub units: Units,
    /// The largest effects in the family, or why they are not known.
    pub effect: Result<VelocityNoiseEffect, String>,
}

/// The largest effects among the plants of a family that are examined one by one.
#[derive(Clone, Debug, PartialEq)]
pub struct VelocityNoiseEffect {
    /// On the command at the valve, V rms.
    pub command_rms_v: f64,
    /// The plant with this effect.
    pub command_plant: PlantPoint,
    /// On the force, N rms.
    pub force_rms_n: f64,
    /// The plant with this effect.
    pub force_plant: PlantPoint,
}

impl VelocityNoise {
    /// In the loop of this problem; `None` where there is no noise, or nothing is fed forward.
    pub(super) fn of(problem: &RobustProblem, stability: Verdict) -> Option<VelocityNoise> {
        let rms_m_per_s = problem.velocity_noise;
        if rms_m_per_s == 0.0 || problem.compensation.rate_feed_forward() == 0.0 {
            return None;
        }
        let effect = match problem.without_polynomials {
            _ if stability == Verdict::Violated => Err("not every plant is stable".to_string()),
            Some(why) => Err(format!("only a simulation shows it with {why}")),
            None => problem.members().map_err(|error| error.to_string()).and_then(|members| {
                let found = rate_noise(&problem.compensation, &members, rms_m_per_s);
                found.map(|found| named(&found, problem)).map_err(|error| words(&error))
            }),
        };
        Some(VelocityNoise { rms_m_per_s, units: problem.units, effect })
    }

    /// In a sentence.
    pub fn sentence(&self, names: &PlantNames) -> String {
        let rms = display(self.rms_m_per_s, self.units.motion.dimension(&VELOCITY), 3);
        match &self.effect {
            Ok(effect) => {
                let of = |plant: &PlantPoint| match names.headings().is_empty() {
                    true => String::new(),
                    false => format!(" ({})", names.text(plant)),
                };
                format!(
                    "the noise of the measured load velocity, {rms} rms, moves the command at the valve by {} mV rms{} and the force by {} rms{}",
                    significant(1e3 * effect.command_rms_v, 3),
                    of(&effect.command_plant),
                    self.units.force.text(effect.force_rms_n, 3),
                    of(&effect.force_plant),
                )
            }
            Err(reason) => {
                format!(
                    "the effect of the noise of the measured load velocity, {rms} rms, is not known: {reason}"
                )
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

fn named(found: &RateNoise, problem: &RobustProblem) -> VelocityNoiseEffect {
    let plant = |index: usize| match &problem.family {
        Family::Uncertain(family) => {
            PlantPoint::Parameters(family.members().get(index).cloned().unwrap_or_default())
        }
        Family::Measured(_) => PlantPoint::Measured(index),
    };
    VelocityNoiseEffect {
        command_rms_v: found.command_rms,
        command_plant: plant(found.command_plant),
        force_rms_n: found.output_rms,
        force_plant: plant(found.output_plant),
    }
}
