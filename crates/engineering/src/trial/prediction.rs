//! The step response that the linear loop predicts: of polynomials, or of responses where lines
//! move.

use std::sync::Arc;

use phea_dynamics::time_response::{StepBaseline, StepMetrics, step_metrics, step_of_frequency_response};
use phea_dynamics::uncertain_plant::PlantMember;
use phea_dynamics::uncertain_plant::responding::RespondingPlant;
use phea_qft::closed_loop::Compensation;
use phea_qft::stability::{StabilityStatus, member_stability};

use super::TrialError;
use super::rigs::Tried;
use super::run::{BAND_PERCENT, StepResponse};
use crate::linear_loop::of_responses::real_parts;
use crate::linear_loop::{LinearLoop, LoopStability, linear_loop_of};
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Durations that are tried until the response has settled, s, and the points of each.
const DURATIONS_S: [f64; 3] = [0.5, 2.0, 10.0];
const POINTS: usize = 4000;

/// The response of the linear loop to a unit step of its reference.
pub(super) enum Prediction {
    /// It settles, or would.
    Step(StepMetrics, StepResponse),
    /// It grows without bound.
    Grows,
    /// Its response is not known.
    Unknown,
}

/// The prediction for one machine.
pub(super) fn predicted(
    tried: &Tried,
    setup: &Setup<'_>,
    problem: &RobustProblem,
) -> Result<Prediction, TrialError> {
    match &tried.plant {
        None => Ok(Prediction::Unknown),
        Some(PlantMember::Responding(plant)) => {
            Ok(of_responses(plant, &problem.compensation).unwrap_or(Prediction::Unknown))
        }
        Some(PlantMember::Rational(plant)) => {
            let Some(given) = &setup.controller else { return Ok(Prediction::Unknown) };
            let given = setup.deployed(given)?;
            let closed = linear_loop_of(plant, &given, &setup.sensor, BAND_PERCENT);
            Ok(match closed {
                Ok(LinearLoop { step: Ok(step), .. }) => Prediction::Step(
                    step.metrics,
                    StepResponse { times_s: step.times_s, values: step.response },
                ),
                Ok(LinearLoop { stability: LoopStability::Unstable, .. }) => Prediction::Grows,
                Ok(_) | Err(_) => Prediction::Unknown,
            })
        }
    }
}

fn of_responses(
    plant: &Arc<dyn RespondingPlant>,
    compensation: &Compensation,
) -> Result<Prediction, TrialError> {
    let member = compensation.responding(plant.clone());
    match member_stability(&member, compensation).status {
        StabilityStatus::Stable => {}
        StabilityStatus::Unstable(_) => return Ok(Prediction::Grows),
        StabilityStatus::NotResolved(_) => return Ok(Prediction::Unknown),
    }
    let points = real_parts(plant, compensation)?;
    let final_value = points.first().map_or(1.0, |(_, real)| *real);
    let mut found = Prediction::Unknown;
    for duration in DURATIONS_S {
        let (step_s, count) = match compensation.sample_time_s() {
            Some(sample_time) => (sample_time, (duration / sample_time).ceil() as usize + 1),
            None => (duration / POINTS as f64, POINTS + 1),
        };
        let sampled = compensation.sample_time_s().is_some();
        let values = step_of_frequency_response(&points, step_s, count, sampled);
        let times_s: Vec<f64> = (0..count).map(|sample| sample as f64 * step_s).collect();
        let metrics = step_metrics(&times_s, &values, StepBaseline::to_value(final_value), BAND_PERCENT)?;
        let settles_early = metrics.settling.time_s().is_some_and(|time_s| time_s < 0.5 * duration);
        found = Prediction::Step(metrics, StepResponse { times_s, values });
        if settles_early {
            break;
        }
    }
    Ok(found)
}
