//! Effect, on the valve's command and on the force, of noise in the signals that a controller reads
//! in addition to the force.

use phea_dynamics::linear::LinearError;
use phea_qft::design::quantization::{QuantizationError, RateNoise, inner_noise, rate_noise};
use phea_qft::family::Family;
use phea_qft::verification::{PlantPoint, Verdict};

use crate::quantity::Units;
use crate::robust::{NoPolynomials, RobustProblem};

/// A signal that a controller reads in addition to the force.
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
    /// Noisy signal.
    pub signal: NoisySignal,
    /// Noise, m/s or Pa rms: noise and rounding of the velocity together, or noise of the pressure
    /// signal.
    pub rms: f64,
    /// Motion of the rig.
    pub units: Units,
    /// Largest effects in the family, or the reason why they are not known.
    pub effect: Result<SignalNoiseEffect, UnknownNoiseEffect>,
}

/// Reason why the effects of a noise are not known.
#[derive(Clone, Debug, PartialEq)]
pub enum UnknownNoiseEffect {
    /// Some plants are not stable.
    Unstable,
    /// The plants have no polynomials: only a simulation shows the effects.
    NoPolynomials(NoPolynomials),
    /// A plant cannot be sampled.
    Member(LinearError),
    /// The response to the noise cannot be summed.
    Response(QuantizationError),
}

/// Largest effects among the plants of a family that are examined one by one.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalNoiseEffect {
    /// Effect on the command at the valve, V rms.
    pub command_rms_v: f64,
    /// Plant with this effect on the command.
    pub command_plant: PlantPoint,
    /// Effect on the force, N rms.
    pub force_rms_n: f64,
    /// Plant with this effect on the force.
    pub force_plant: PlantPoint,
}

impl SignalNoise {
    /// Noise in the loop of this problem; `None` if there is no noise, or the signal is not read.
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
            _ if stability == Verdict::Violated => Err(UnknownNoiseEffect::Unstable),
            Some(why) => Err(UnknownNoiseEffect::NoPolynomials(why)),
            None => problem.members().map_err(UnknownNoiseEffect::Member).and_then(|members| {
                let found = match signal {
                    NoisySignal::LoadVelocity => rate_noise(around, &members, rms),
                    NoisySignal::Pressures => inner_noise(around, &members, rms),
                };
                found.map(|found| named(&found, problem)).map_err(UnknownNoiseEffect::Response)
            }),
        };
        Some(SignalNoise { signal, rms, units: problem.units, effect })
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
