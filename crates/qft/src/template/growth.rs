//! Growth of the region: plants on its contour are pushed outward over all coordinates, and the
//! region that they sweep is filled.
//!
//! The edges of two-dimensional faces do not reach folds inside the box, where the gradients of
//! magnitude and phase are parallel. From a plant p on the contour, with outward normal n and
//! tangent t in the plane of phase and magnitude z, the next one is the linear solution of
//!
//! ```text
//! maximise n . dz     subject to t . dz = 0,   dz = sum_i (dz/dp_i) d_i,   p + d in the box, |d_i| <= reach
//! ```
//!
//! accepted if the plant found there is indeed further out; the walk from the contour to the new
//! plants and back is closed, so that the region it encloses is filled.

use std::collections::BTreeSet;

use super::plants::{Plants, Stop};
use super::region::{Corner, Region};
use phea_dynamics::order::sort_by_number;

/// Least outward gain of a push, in tolerances.
const GAIN_MINIMUM: f64 = 0.1;

/// Longest outward gain of one push, in tolerances: towards a pole it would be unlimited.
const STRIDE_MAXIMUM: f64 = 20.0;

/// Number of pushes of one plant in a round.
const PUSHES: usize = 6;

/// Difference of a fraction over which a slope is computed.
const SLOPE_FRACTION: f64 = 1e-4;

/// Smallest reach of a push, as a fraction.
const REACH_MINIMUM: f64 = 0.003;

/// Performs one round: pushes every new corner of the contour. Returns true if anything moved.
pub(super) fn grow(
    plants: &mut Plants,
    region: &mut Region,
    tried: &mut BTreeSet<(i64, i32)>,
) -> Result<bool, Stop> {
    let mut walks = vec![];
    let mut outcome = Ok(());
    for contour in region.contours() {
        outcome = sweep(plants, region, &contour, tried, &mut walks);
        if outcome.is_err() {
            break;
        }
    }
    let closed: Vec<_> = walks.iter().filter_map(|walk: &Vec<usize>| plants.closed_walk(walk)).collect();
    if !closed.is_empty() {
        region.fill(&closed);
    }
    outcome.map(|()| !closed.is_empty())
}

/// Closed walks between a contour and the plants to which its corners are pushed.
fn sweep(
    plants: &mut Plants,
    region: &Region,
    contour: &[Corner],
    tried: &mut BTreeSet<(i64, i32)>,
    walks: &mut Vec<Vec<usize>>,
) -> Result<(), Stop> {
    let count = contour.len();
    let mut trails: Vec<Option<Vec<usize>>> = vec![];
    for index in 0..count {
        let (before, corner, after) =
            (contour[(index + count - 1) % count], contour[index], contour[(index + 1) % count]);
        let plant = corner.plant.or(before.plant).or(after.plant);
        let Some(plant) = plant else {
            trails.push(None);
            continue;
        };
        let fresh = region.key(corner.place).is_some_and(|key| tried.insert(key));
        let direction = if fresh { outward(plants, before, corner, after) } else { None };
        trails.push(Some(match direction {
            Some(normal) => pushed(plants, plant, normal)?,
            None => vec![plant],
        }));
        if let Some(&end) = trails.last().and_then(|trail| trail.as_ref()?.last()) {
            tried.extend(region.key(plants.place(end)));
        }
    }
    for index in 0..count {
        let (Some(first), Some(second)) = (&trails[index], &trails[(index + 1) % count]) else { continue };
        if first.len() == 1 && second.len() == 1 {
            continue;
        }
        let inner = plants.line(first[0], second[0], 1)?;
        let outer = plants.line(second[second.len() - 1], first[first.len() - 1], 1)?;
        let mut walk = inner.plants;
        walk.extend(second.iter().skip(1));
        walk.extend(outer.plants.iter().skip(1));
        walk.extend(first.iter().rev().skip(1));
        walks.push(walk);
    }
    Ok(())
}

/// The outward normal at a corner, in tolerances; the region is on the left of the contour.
fn outward(plants: &Plants, before: Corner, corner: Corner, after: Corner) -> Option<[f64; 2]> {
    let arriving = direction(plants.steps(before.place, corner.place));
    let leaving = direction(plants.steps(corner.place, after.place));
    let along = match (arriving, leaving) {
        (Some(first), Some(second)) => {
            direction([first[0] + second[0], first[1] + second[1]]).or(Some(first))
        }
        (first, second) => first.or(second),
    }?;
    Some([along[1], -along[0]])
}

fn direction(step: [f64; 2]) -> Option<[f64; 2]> {
    let length = (step[0] * step[0] + step[1] * step[1]).sqrt();
    (length > 0.0 && length.is_finite()).then(|| [step[0] / length, step[1] / length])
}

/// Neighbours from a plant to the one it is pushed to along the normal; only itself if it cannot
/// move.
fn pushed(plants: &mut Plants, plant: usize, normal: [f64; 2]) -> Result<Vec<usize>, Stop> {
    let mut trail = vec![plant];
    let mut from = plant;
    for _ in 0..PUSHES {
        let slopes = slopes(plants, from)?;
        let Some(next) = further(plants, from, &slopes, normal)? else { break };
        let link = plants.line(from, next, 1)?;
        if plants.unbroken(&link.plants).len() > 1 {
            break;
        }
        trail.extend(link.plants.iter().skip(1));
        from = next;
    }
    Ok(trail)
}

/// The first plant further out, from the whole box down to the smallest reach.
fn further(
    plants: &mut Plants,
    from: usize,
    slopes: &[[f64; 2]],
    normal: [f64; 2],
) -> Result<Option<usize>, Stop> {
    let mut reach = 1.0;
    while reach > REACH_MINIMUM {
        let fractions = plants.list[from].fractions.clone();
        let moves = outward_moves(slopes, &fractions, normal, reach);
        let gain: f64 = moves.iter().zip(slopes).map(|(step, slope)| step * dot(*slope, normal)).sum();
        if gain < GAIN_MINIMUM {
            return Ok(None);
        }
        let next =
            plants.at(fractions.iter().zip(&moves).map(|(fraction, step)| fraction + step).collect())?;
        let step = plants.step(from, next);
        let (out, along) = (dot(step, normal), dot(step, [-normal[1], normal[0]]).abs());
        let onward = out > GAIN_MINIMUM / 2.0 && out < STRIDE_MAXIMUM;
        if plants.is_finite(next) && onward && along < 2.0 * out + 2.0 {
            return Ok(Some(next));
        }
        reach /= 4.0;
    }
    Ok(None)
}

/// Change of phase and magnitude with each fraction, in tolerances.
fn slopes(plants: &mut Plants, from: usize) -> Result<Vec<[f64; 2]>, Stop> {
    let fractions = plants.list[from].fractions.clone();
    let mut slopes = vec![];
    for (axis, &fraction) in fractions.iter().enumerate() {
        let part = if fraction > 0.5 { -SLOPE_FRACTION } else { SLOPE_FRACTION };
        let mut moved = fractions.clone();
        moved[axis] = fraction + part;
        let beside = plants.at(moved)?;
        slopes.push(plants.step(from, beside).map(|change| change / part));
    }
    Ok(slopes)
}

/// The moves that lead farthest along the normal and, to first order, do not move along the
/// contour.
///
/// For a given price on moving sideways every coordinate goes to one of its ends; the price at
/// which the sum changes sign is that of one coordinate, which goes part of the way.
fn outward_moves(slopes: &[[f64; 2]], fractions: &[f64], normal: [f64; 2], reach: f64) -> Vec<f64> {
    let tangent = [-normal[1], normal[0]];
    let ends = fractions.iter().map(|&fraction| [(-fraction).max(-reach), (1.0 - fraction).min(reach)]);
    // each coordinate: gain and drift per fraction, with the ends in the order of a rising price
    let rates: Vec<[f64; 2]> =
        slopes.iter().map(|&slope| [dot(slope, normal), dot(slope, tangent)]).collect();
    let ends: Vec<[f64; 2]> = ends
        .zip(&rates)
        .map(|([low, high], &[gain, drift])| match drift {
            0.0 if gain == 0.0 => [0.0; 2],
            0.0 => [if gain > 0.0 { high } else { low }; 2],
            _ if drift > 0.0 => [low, high],
            _ => [high, low],
        })
        .collect();
    let mut order: Vec<usize> = (0..rates.len()).filter(|&axis| rates[axis][1] != 0.0).collect();
    sort_by_number(&mut order, |&axis| -rates[axis][0] / rates[axis][1]);
    let mut moves: Vec<f64> = ends.iter().map(|end| end[0]).collect();
    let mut drift: f64 = moves.iter().zip(&rates).map(|(step, rate)| step * rate[1]).sum();
    for axis in order {
        let full = (ends[axis][1] - ends[axis][0]) * rates[axis][1];
        if drift + full >= 0.0 {
            moves[axis] -= drift / rates[axis][1];
            break;
        }
        moves[axis] = ends[axis][1];
        drift += full;
    }
    moves
}

fn dot(first: [f64; 2], second: [f64; 2]) -> f64 {
    first[0] * second[0] + first[1] * second[1]
}
