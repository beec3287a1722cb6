//! The step response that the linear loop predicts: of polynomials, or of responses where lines move.

use std::sync::Arc;

use num_complex::Complex64;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::responding::RespondingPlant;
use phea_dynamics::time_response::{StepBaseline, StepMetrics, step_metrics, step_of_frequency_response};
use phea_dynamics::uncertain_plant::PlantMember;
use phea_hydraulics::linear::transfer_functions;
use phea_qft::closed_loop::{Compensation, Member};
use phea_qft::family::{FINE, tabulated};
use phea_qft::stability::{StabilityStatus, member_stability};

use super::rigs::Tried;
use super::run::{BAND_PERCENT, Response};
use crate::command::CommandError;
use crate::linear_loop::{LinearLoop, LoopStability, linear_loop};
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Durations that are tried until the response has settled, s, and the points of each.
const DURATIONS_S: [f64; 3] = [0.5, 2.0, 10.0];
const POINTS: usize = 4000;
/// Part of the step by which the closed loop's response may lie off the line between two points.
const STRAIGHT: f64 = 1e-3;
/// Two points are no closer than this part of their frequency.
const CLOSEST: f64 = 1e-6;

/// What the linear loop does after a unit step of its reference.
pub(super) enum Prediction {
    /// It settles, or would.
    Step(StepMetrics, Response),
    /// It grows without bound.
    Grows,
    /// It has no response that is known.
    Unknown,
}

/// The prediction for one machine.
pub(super) fn predicted(tried: &Tried, problem: &RobustProblem) -> Result<Prediction, CommandError> {
    match &tried.plant {
        None => Ok(Prediction::Unknown),
        Some(PlantMember::Responding(plant)) => {
            Ok(of_responses(plant, &problem.compensation).unwrap_or(Prediction::Unknown))
        }
        Some(PlantMember::Rational(plant)) => {
            let setup = Setup::new(&tried.project)?;
            let Some(given) = &setup.controller else { return Ok(Prediction::Unknown) };
            let given = setup.deployed(given)?;
            let plant = transfer_functions(plant)?.command;
            let closed = linear_loop(&plant, &given, &setup.sensor, BAND_PERCENT);
            Ok(match closed {
                Ok(LinearLoop { step: Ok(step), .. }) => {
                    Prediction::Step(step.metrics, Response { times_s: step.times_s, values: step.response })
                }
                Ok(LinearLoop { stability: LoopStability::Unstable, .. }) => Prediction::Grows,
                Ok(_) | Err(_) => Prediction::Unknown,
            })
        }
    }
}

fn of_responses(
    plant: &Arc<dyn RespondingPlant>,
    compensation: &Compensation,
) -> Result<Prediction, CommandError> {
    let member = compensation.responding(plant.clone());
    match member_stability(&member, compensation).status {
        StabilityStatus::Stable => {}
        StabilityStatus::Unstable(_) => return Ok(Prediction::Grows),
        StabilityStatus::NotResolved(_) => return Ok(Prediction::Unknown),
    }
    let highest = compensation.highest_frequency_rad_per_s();
    let grid = tabulated(plant.as_ref(), plant.range_rad_per_s(), FINE).frequencies_rad_per_s;
    let prefilter = compensation.prefilter_of_step()?;
    let points = straight(&grid, highest, |frequency| closed(&member, compensation, &prefilter, frequency));
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
        found = Prediction::Step(metrics, Response { times_s, values });
        if settles_early {
            break;
        }
    }
    Ok(found)
}

/// F P G/(1 + L), F as a step meets it.
fn closed(
    member: &Member,
    compensation: &Compensation,
    prefilter: &TransferFunction,
    frequency: f64,
) -> Option<Complex64> {
    let plant = member.response(frequency)?;
    let forward = plant.plant * compensation.feedback().at_frequency(frequency);
    Some(prefilter.at_frequency(frequency) * forward / (1.0 + forward * plant.sensor))
}

/// The real part at these frequencies, and between them until it is straight there.
fn straight(grid: &[f64], highest: f64, response: impl Fn(f64) -> Option<Complex64>) -> Vec<(f64, f64)> {
    let at = |frequency: f64| response(frequency).map(|value| (frequency, value.re));
    let within = grid.iter().rev().filter(|frequency| **frequency <= highest);
    let mut left: Vec<(f64, f64)> = within.filter_map(|frequency| at(*frequency)).collect();
    let mut found: Vec<(f64, f64)> = left.pop().into_iter().collect();
    while let (Some(&next), Some(&last)) = (left.last(), found.last()) {
        let close = next.0 - last.0 <= CLOSEST * next.0;
        let middle = at(0.5 * (last.0 + next.0)).filter(|middle| {
            let mean = 0.5 * (last.1 + next.1);
            !close && (middle.1 - mean).abs() > STRAIGHT
        });
        match middle {
            Some(middle) => left.push(middle),
            None => found.extend(left.pop()),
        }
    }
    found
}
