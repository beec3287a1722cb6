//! Step response that the linear loop predicts.

use phea_dynamics::time_response::{StepBaseline, StepMetrics, step_metrics};
use phea_qft::stability::{StabilityStatus, member_stability};

use super::TrialError;
use super::rigs::TrialRig;
use super::run::{BAND_PERCENT, TrialStep};
use crate::linear_step::{StepResponse, linear_step};
use crate::robust::RobustProblem;

/// Durations that are computed until the response has settled, s, and number of points of each.
const DURATIONS_S: [f64; 4] = [0.5, 2.0, 10.0, 40.0];
const POINTS: usize = 4000;

/// Duration of a step in settling times of the linear loop, within bounds: a slow part of it may
/// reach its maximum long after it has settled within the band.
pub(super) const SETTLING_TIMES: f64 = 5.0;

/// Bounds of the duration of a step, s.
const SHORTEST_HOLD_S: f64 = 0.5;
pub(super) const LONGEST_HOLD_S: f64 = 20.0;

/// The response of the linear loop to a unit step of its reference.
pub(super) enum Prediction {
    /// The response settles, or would settle.
    Step(StepMetrics, StepResponse),
    /// The response grows without bound.
    Grows,
    /// The response is not known.
    Unknown,
}

/// The prediction for one machine: the step of its plant in the loop of the audit.
pub(super) fn predicted(trial_rig: &TrialRig, problem: &RobustProblem) -> Result<Prediction, TrialError> {
    let compensation = &problem.compensation;
    let Some(plant) = trial_rig.plant.clone() else { return Ok(Prediction::Unknown) };
    let Ok(member) = compensation.around(plant) else { return Ok(Prediction::Unknown) };
    match member_stability(&member, compensation).status {
        StabilityStatus::Stable => {}
        StabilityStatus::Unstable(_) => return Ok(Prediction::Grows),
        StabilityStatus::NotResolved(_) => return Ok(Prediction::Unknown),
    }
    let mut found = Prediction::Unknown;
    for duration in DURATIONS_S {
        let Ok(response) = linear_step(&member, compensation, duration, POINTS) else { break };
        let metrics = step_metrics(&response.times_s, &response.values, StepBaseline::unit(), BAND_PERCENT)?;
        let settles_s = metrics.settling.time_s().filter(|time_s| *time_s < 0.5 * duration);
        found = Prediction::Step(metrics, response);
        let Some(settles_s) = settles_s else { continue };
        let known_s = (SETTLING_TIMES * settles_s).min(LONGEST_HOLD_S);
        if known_s > duration
            && let Ok(response) = linear_step(&member, compensation, known_s, POINTS)
        {
            let (times_s, values) = (&response.times_s, &response.values);
            let metrics = step_metrics(times_s, values, StepBaseline::unit(), BAND_PERCENT)?;
            found = Prediction::Step(metrics, response);
        }
        break;
    }
    Ok(found)
}

/// Response of the linear loop to a step.
pub(super) struct LinearStep {
    pub(super) step: Option<TrialStep>,
    pub(super) response: StepResponse,
    /// True if the response grows without bound.
    pub(super) grows: bool,
}

impl LinearStep {
    pub(super) fn of(trial_rig: &TrialRig, problem: &RobustProblem) -> Result<LinearStep, TrialError> {
        Ok(match predicted(trial_rig, problem)? {
            Prediction::Step(metrics, response) => {
                let overshoot_percent = Some(metrics.overshoot_percent);
                let settling_time_s = metrics.settling.time_s();
                LinearStep {
                    step: Some(TrialStep { overshoot_percent, settling_time_s }),
                    response,
                    grows: false,
                }
            }
            Prediction::Grows => LinearStep { step: None, response: StepResponse::default(), grows: true },
            Prediction::Unknown => LinearStep { step: None, response: StepResponse::default(), grows: false },
        })
    }

    /// Duration of this number of settling times, s, within bounds.
    pub(super) fn hold_s(&self, settling_times: f64) -> f64 {
        let [shortest, longest] = [SHORTEST_HOLD_S, LONGEST_HOLD_S];
        let settles_s = match self.step {
            Some(step) => step.settling_time_s.unwrap_or(longest),
            None => shortest,
        };
        (settling_times * settles_s).clamp(shortest, longest)
    }
}
