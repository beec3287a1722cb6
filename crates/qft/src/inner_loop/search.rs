//! Search for gain and corner: a grid, then local maxima; over the binding plants, to which those
//! that are worst with the feedback found are added.

use phea_dynamics::controller::InnerFeedback;
use phea_dynamics::linear::LinearError;
use phea_dynamics::minimum;
use phea_dynamics::portable;

use super::limits::FedBackPlants;
use super::{FoundInnerFeedback, InnerLoopProblem, InnerLoopReach};

/// Number of corners of the grid.
const CORNERS: usize = 17;
/// Number of gains of the grid at each corner, and ratio of the largest to the least.
const GAINS: usize = 20;
const GAIN_RATIO: f64 = 3000.0;
/// Magnitude |k Q| at the reference up to which gains are searched if nothing limits them.
const BEYOND_REFERENCE: f64 = 100.0;
/// Fraction of a cell of the grid to which a maximum is located.
const CELL_FRACTION: f64 = 1e-3;
/// Ratio of the loop gain over all plants to that over the searched plants that counts as equal.
const AS_GOOD: f64 = 0.998;

pub(super) fn best(problem: &InnerLoopProblem) -> Result<Option<FoundInnerFeedback>, LinearError> {
    let Some(without) = problem.reach(&InnerFeedback::default())? else { return Ok(None) };
    let all: Vec<usize> = (0..problem.plants.len()).collect();
    let mut searched = vec![without.plant];
    let mut best: Option<FoundInnerFeedback> = None;
    // each round adds a plant
    for _ in &all {
        let Some((feedback, own)) = best_of(problem, &searched)? else { return Ok(best) };
        let whole = FedBackPlants::new(problem, &InnerFeedback { gain: 1.0, ..feedback }, &all)?;
        let reach = whole.reach(feedback.gain);
        if let Some(reach) = reach
            && best.is_none_or(|known| reach.loop_gain > known.reach.loop_gain)
        {
            best = Some(FoundInnerFeedback { feedback, reach, without });
        }
        if reach.is_some_and(|reach| reach.loop_gain >= AS_GOOD * own.loop_gain) {
            break;
        }
        let known = searched.len();
        searched.extend(whole.worst(feedback.gain));
        searched.sort_unstable();
        searched.dedup();
        if searched.len() == known {
            break;
        }
    }
    Ok(best)
}

/// The best feedback for this subset of plants.
fn best_of(
    problem: &InnerLoopProblem,
    plants: &[usize],
) -> Result<Option<(InnerFeedback, InnerLoopReach)>, LinearError> {
    let [low, high] = problem.high_pass_rad_per_s.map(portable::ln);
    let cell = (high - low) / (CORNERS - 1) as f64;
    let corners: Vec<f64> = (0..CORNERS).map(|step| low + cell * step as f64).collect();
    let mut best: Option<(f64, InnerFeedback, InnerLoopReach)> = None;
    let mut at = |corner: f64| -> Result<f64, LinearError> {
        let found = best_gain(problem, plants, portable::exp(corner))?;
        let Some((feedback, reach)) = found else { return Ok(0.0) };
        if best.as_ref().is_none_or(|(_, _, known)| reach.loop_gain > known.loop_gain) {
            best = Some((corner, feedback, reach));
        }
        Ok(reach.loop_gain)
    };
    let mut start = (low, f64::NEG_INFINITY);
    for corner in corners {
        let value = at(corner)?;
        if value > start.1 {
            start = (corner, value);
        }
    }
    let ends = [(start.0 - cell).max(low), (start.0 + cell).min(high)];
    let mut failed = None;
    minimum::between(
        |corner| match at(corner) {
            Ok(value) => -value,
            Err(error) => {
                failed = Some(error);
                0.0
            }
        },
        ends,
        (start.0, -start.1),
        CELL_FRACTION * cell,
    );
    match failed {
        Some(error) => Err(error),
        None => Ok(best.map(|(_, feedback, reach)| (feedback, reach))),
    }
}

/// The best gain in series with a high pass of this corner; `None` if no gain satisfies the limits.
fn best_gain(
    problem: &InnerLoopProblem,
    plants: &[usize],
    corner: f64,
) -> Result<Option<(InnerFeedback, InnerLoopReach)>, LinearError> {
    let unit = InnerFeedback {
        gain: 1.0,
        high_pass_rad_per_s: Some(corner),
        low_pass_rad_per_s: problem.low_pass_rad_per_s,
    };
    let shaped = FedBackPlants::new(problem, &unit, plants)?;
    let Some(signal) = shaped.least_reference_signal().filter(|size| *size > 0.0) else { return Ok(None) };
    let most = portable::ln(shaped.largest_inner_gain().min(BEYOND_REFERENCE / signal));
    let value = |gain: f64| shaped.reach(portable::exp(gain)).map_or(0.0, |reach| reach.loop_gain);
    let cell = portable::ln(GAIN_RATIO) / GAINS as f64;
    let mut start = (most, f64::NEG_INFINITY);
    for step in 0..=GAINS {
        let gain = most - cell * step as f64;
        let found = value(gain);
        if found > start.1 {
            start = (gain, found);
        }
    }
    let ends = [start.0 - cell, (start.0 + cell).min(most)];
    let (gain, _) = minimum::between(|gain| -value(gain), ends, (start.0, -start.1), CELL_FRACTION * cell);
    let feedback = InnerFeedback { gain: portable::exp(gain), ..unit };
    Ok(shaped.reach(feedback.gain).map(|reach| (feedback, reach)))
}
