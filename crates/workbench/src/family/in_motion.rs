//! The family of a rig whose lines move: the responses of its members, point by point where they bend.
//!
//! ```text
//! members of the box -> PlantInMotion -> points, denser until the response between two of them is known -> MeasuredFamily
//! ```

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::portable;
use phea_dynamics::uncertain_plant::UncertainParameter;
use phea_hydraulics::plant::PlantInMotion;
use phea_qft::family::{Extent, MeasuredFamily, MeasuredPlant, UncertainFamily, vertices};

use super::FamilyError;
use super::hydraulic;
use super::visited::Visited;
use crate::project::Project;
use crate::rig::Rig;

/// Members of a box that are looked at, its corners among them.
const MEMBERS_MAXIMUM: usize = 200;
/// Boxes with more coordinates have too many corners to look at.
const CORNER_COORDINATES: usize = 6;
/// Where the responses begin, rad/s, or this part of the lowest design frequency.
const LOWEST_RAD_PER_S: f64 = 1e-3;
const BELOW_DESIGN: f64 = 0.1;
/// They end at this multiple of the spool's frequency, of the quarter wave, and of half the sampling rate.
const ABOVE_SPOOL: f64 = 20.0;
const ABOVE_QUARTER_WAVE: f64 = 40.0;
const ABOVE_NYQUIST: f64 = 20.0;
/// Points in a decade before they are made denser.
const POINTS_PER_DECADE: f64 = 25.0;
/// Part of a response by which the middle between two points may lie off what is interpolated there.
const TOLERANCE: f64 = 2e-3;
/// Two points are no closer than this part of their frequency.
const CLOSEST: f64 = 1e-6;

/// The responses of the members; `None` where both lines are lumped.
pub(super) fn family(
    project: &Project,
    lumped: &UncertainFamily,
) -> Result<Option<MeasuredFamily>, FamilyError> {
    if project.actuator.is_none() {
        return Ok(None);
    }
    let rig = Rig::new(project)?;
    if rig.in_motion.is_none() {
        return Ok(None);
    }
    let visited = Visited::new(project, lumped.plant().parameters())?;
    let members = members(lumped)?;
    let mut grid: Option<Vec<f64>> = None;
    let mut plants = Vec::with_capacity(members.len());
    for (index, values) in members.iter().enumerate() {
        let named = || named(lumped.plant().parameters(), values);
        let plant = hydraulic::in_motion(project, &visited, values)
            .map_err(|error| FamilyError::Line { error, member: named() })?;
        let Some(plant) = plant else { return Ok(None) };
        if !plant.is_passive() {
            return Err(FamilyError::NotPassive { member: named() });
        }
        let first = match grid.take() {
            Some(grid) => grid,
            None => coarse(project, &rig, &plant)?,
        };
        let measured = points(&plant, &first, format!("{}", index + 1));
        grid = Some(if index == 0 { measured.frequencies_rad_per_s.clone() } else { first });
        plants.push(measured);
    }
    Ok(Some(MeasuredFamily::new(plants)?.of_model(visited.names, members)))
}

/// The nominal plant, the corners of a box where they are few, and as many of the other members as are looked at, spread over all.
fn members(lumped: &UncertainFamily) -> Result<Vec<Vec<f64>>, FamilyError> {
    let all = lumped.members();
    let mut chosen: Vec<Vec<f64>> = all.iter().take(1).cloned().collect();
    if lumped.extent() == Extent::Members {
        return Ok(all.to_vec());
    }
    if lumped.coordinates().len() <= CORNER_COORDINATES {
        chosen.extend(vertices(lumped.plant(), lumped.coordinates())?);
    }
    let room = MEMBERS_MAXIMUM.saturating_sub(chosen.len()).max(1);
    chosen.extend(all.iter().step_by(all.len().div_ceil(room).max(1)).cloned());
    let mut distinct: Vec<Vec<f64>> = Vec::with_capacity(chosen.len());
    for values in chosen {
        if !distinct.contains(&values) {
            distinct.push(values);
        }
    }
    Ok(distinct)
}

fn named(parameters: &[UncertainParameter], values: &[f64]) -> String {
    let parts: Vec<String> =
        parameters.iter().zip(values).map(|(one, value)| format!("{} = {value}", one.name)).collect();
    if parts.is_empty() { "the nominal plant".to_string() } else { parts.join(", ") }
}

/// Where the points of all members begin to be looked for.
fn coarse(project: &Project, rig: &Rig, plant: &PlantInMotion) -> Result<Vec<f64>, FamilyError> {
    let asked = project.specifications.iter().flat_map(|one| &one.frequencies).copied();
    let lowest = asked.filter(|frequency| *frequency > 0.0).fold(f64::INFINITY, f64::min);
    let from = LOWEST_RAD_PER_S.min(BELOW_DESIGN * lowest);
    let spool = rig.plant.valve_natural_frequency;
    let sampled = project.controller.as_ref().and_then(|controller| controller.sample_time);
    let to = [
        ABOVE_SPOOL * spool,
        ABOVE_QUARTER_WAVE * plant.quarter_wave_rad_per_s().unwrap_or(0.0),
        sampled.map_or(0.0, |sample_time| ABOVE_NYQUIST * std::f64::consts::PI / sample_time),
    ];
    let to = to.into_iter().fold(0.0, f64::max);
    let decades = portable::ln(to / from) / std::f64::consts::LN_10;
    logarithmic_grid(from, to, (POINTS_PER_DECADE * decades).ceil() as usize)
        .map_err(|_| FamilyError::Frequencies { from_rad_per_s: from, to_rad_per_s: to })
}

/// A response at these frequencies, and between them until it is known there.
fn points(plant: &PlantInMotion, grid: &[f64], name: String) -> MeasuredPlant {
    let at = |frequency: f64| (frequency, plant.response(Complex64::new(0.0, frequency)));
    let mut left: Vec<Point> = grid.iter().rev().map(|frequency| at(*frequency)).collect();
    let mut found: Vec<Point> = Vec::with_capacity(2 * left.len());
    found.extend(left.pop());
    while let Some(next) = left.last().copied() {
        let Some(previous) = found.last().copied() else { break };
        let middle = at((previous.0 * next.0).sqrt());
        let close = next.0 - previous.0 <= CLOSEST * next.0;
        if close || (0..2).all(|path| is_between(previous.1[path], middle.1[path], next.1[path])) {
            found.push(next);
            left.pop();
        } else {
            left.push(middle);
        }
    }
    let frequencies_rad_per_s: Vec<f64> = found.iter().map(|point| point.0).collect();
    // nothing in a passive plant grows but by what is fed forward
    let unstable_poles = plant.unstable_poles(&frequencies_rad_per_s);
    MeasuredPlant {
        name,
        frequencies_rad_per_s,
        command: found.iter().map(|point| point.1[0]).collect(),
        disturbance: Some(found.iter().map(|point| point.1[1]).collect()),
        is_resolved: unstable_poles.is_some(),
        unstable_poles: unstable_poles.unwrap_or(0),
    }
}

/// Frequency in rad/s, and both paths there.
type Point = (f64, [Complex64; 2]);

/// Whether the middle between two points is their geometric mean, near enough.
fn is_between(from: Complex64, middle: Complex64, to: Complex64) -> bool {
    let turn = to / from;
    let half = Complex64::new(portable::ln(portable::magnitude(turn)), portable::argument(turn)) / 2.0;
    let mean = from * portable::exp_complex(half);
    portable::magnitude(middle / mean - 1.0) <= TOLERANCE
}
