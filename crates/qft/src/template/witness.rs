//! Witnesses: plants of the box that must be inside the region, and are added to it if they are
//! not.

use super::plants::{PlantPosition, Plants, Stop};
use super::region::{Corner, Region};
use phea_dynamics::order::{ends, sort_by_number};

/// Number of witnesses added at a time.
const TAKEN_IN: usize = 8;

/// A plant outside the region, with its distance in tolerances and the nearest corners that are
/// plants.
pub(super) struct Outside {
    pub(super) plant: usize,
    pub(super) distance: f64,
    pub(super) beside: Option<[usize; 2]>,
}

/// Points spread evenly over the box: multiples of powers of the generalised golden ratio (Roberts
/// 2018), modulo 1.
pub(super) fn probes(dimension: usize, count: usize) -> Vec<Vec<f64>> {
    let mut ratio = 1.5;
    for _ in 0..60 {
        ratio = phea_dynamics::portable::pow(1.0 + ratio, 1.0 / (dimension as f64 + 1.0));
    }
    let fraction = |number: usize, axis: usize| {
        let step = phea_dynamics::portable::pow(ratio, -(axis as f64 + 1.0));
        let multiple = 0.5 + step * number as f64;
        multiple - multiple.floor()
    };
    (1..=count).map(|number| (0..dimension).map(|axis| fraction(number, axis)).collect()).collect()
}

/// Witnesses more than a tolerance outside the contours, the farthest first.
pub(super) fn outside(plants: &Plants, contours: &[Vec<Corner>], witnesses: &[usize]) -> Vec<Outside> {
    let found = witnesses.iter().filter_map(|&plant| {
        let (distance, beside) = distance(plants, contours, plants.place(plant));
        (distance > 1.0).then_some(Outside { plant, distance, beside })
    });
    let mut found: Vec<Outside> = found.collect();
    sort_by_number(&mut found, |outside| -outside.distance);
    found
}

/// Adds the farthest witnesses, by a walk from the contour to each and back.
pub(super) fn take_in(plants: &mut Plants, region: &mut Region, outside: &[Outside]) -> Result<(), Stop> {
    let mut walks = vec![];
    for witness in outside.iter().take(TAKEN_IN) {
        let Some([first, second]) = witness.beside else { continue };
        let mut walk = plants.line(first, witness.plant, 1)?.plants;
        walk.extend(plants.line(witness.plant, second, 1)?.plants.iter().skip(1));
        walk.extend(plants.line(second, first, 1)?.plants.iter().skip(1));
        walks.extend(plants.closed_walk(&walk));
    }
    region.fill(&walks);
    Ok(())
}

/// Distance of a position from the region, for any number of turns, and the plants at or next to
/// the nearest corner.
fn distance(plants: &Plants, contours: &[Vec<Corner>], place: PlantPosition) -> (f64, Option<[usize; 2]>) {
    let phases = || contours.iter().flatten().map(|corner| corner.place.phase_deg);
    let [low, high] = ends(phases());
    let first = ((low - place.phase_deg) / 360.0).floor();
    let turns = ((high - low) / 360.0).ceil() + 1.0;
    let mut nearest = (f64::INFINITY, None);
    let mut turn = 0.0;
    while turn <= turns {
        let phase_deg = place.phase_deg + 360.0 * (first + turn);
        let candidate = distance_here(plants, contours, PlantPosition { phase_deg, ..place });
        if candidate.0 < nearest.0 {
            nearest = candidate;
        }
        turn += 1.0;
    }
    nearest
}

fn distance_here(
    plants: &Plants,
    contours: &[Vec<Corner>],
    place: PlantPosition,
) -> (f64, Option<[usize; 2]>) {
    let mut inside = false;
    let mut nearest = (f64::INFINITY, None);
    for contour in contours {
        for (index, from) in contour.iter().enumerate() {
            let to = contour[(index + 1) % contour.len()];
            let (start, end) = (plants.steps(place, from.place), plants.steps(place, to.place));
            inside ^= crosses(start, end);
            let distance = to_segment(start, end);
            if distance < nearest.0 {
                let after = contour[(index + 2) % contour.len()];
                let first = from.plant.or(to.plant);
                let second = to.plant.or(after.plant).or(first);
                nearest = (distance, first.zip(second).map(|(first, second)| [first, second]));
            }
        }
    }
    if inside { (0.0, nearest.1) } else { nearest }
}

/// True if the ray from the origin to the right intersects the segment.
fn crosses(start: [f64; 2], end: [f64; 2]) -> bool {
    (start[1] > 0.0) != (end[1] > 0.0)
        && start[0] - start[1] * (end[0] - start[0]) / (end[1] - start[1]) > 0.0
}

/// Distance of the origin from a segment.
fn to_segment(start: [f64; 2], end: [f64; 2]) -> f64 {
    let along = [end[0] - start[0], end[1] - start[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let part = if length > 0.0 { -(start[0] * along[0] + start[1] * along[1]) / length } else { 0.0 };
    let part = part.clamp(0.0, 1.0);
    let foot = [start[0] + part * along[0], start[1] + part * along[1]];
    (foot[0] * foot[0] + foot[1] * foot[1]).sqrt()
}
