//! A force of several frequencies that shakes the piston on its bristles.

use std::f64::consts::PI;

use phea_dynamics::simulation::schroeder_phases;
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::friction::{LuGre, MultisineForce, PressedMass, TRENDS};

use super::{CylinderMoment, counted, least_static, longest_step};
use crate::bench::BenchError;
use crate::project::ShakenFriction;

/// Ratio of the greatest force to the static friction, if none is stated. At the natural frequency
/// the bristles carry several times the force of one sine: more would mostly make them slip.
const PART: f64 = 1.0 / 3.0;

/// Ratios of the frequencies to the natural frequency on the bristles, if none are stated.
const AROUND: [f64; 2] = [0.4, 1.7];

/// Largest angle by which the highest frequency turns between two rows, rad.
const LARGEST_ANGLE: f64 = PI / 2.0;

/// Angle in an integration step, rad.
const STEP_ANGLE: f64 = 0.05;

/// Displacement up to which there are rows, relative to that of the bristles at breakaway.
const FARTHEST: f64 = 40.0;

/// One period that is not recorded, and the recorded ones, until the piston breaks away.
pub(super) fn shaken(
    lugre: &LuGre,
    cylinder: &Cylinder,
    settings: &ShakenFriction,
) -> Result<Vec<CylinderMoment>, BenchError> {
    let breaking = least_static(lugre);
    let ringing = (lugre.bristle_stiffness / cylinder.moving_mass).sqrt();
    let frequencies = excited(settings, ringing)?;
    let length = breaking / lugre.bristle_stiffness;
    let highest = frequencies.last().copied().unwrap_or(ringing).max(ringing);
    // an upper bound of the velocity of the bristles
    let by_slip = longest_step(lugre, highest * 2.0 * length);
    let steps = settings.sample_time / by_slip.min(STEP_ANGLE / highest);
    let steps = counted(steps.ceil())?.max(1);
    let before = counted(settings.period / settings.sample_time)?;
    let rows = before + counted(settings.period * f64::from(settings.periods) / settings.sample_time)?;
    counted(rows as f64 * steps as f64 / 100.0)?;
    let time_step = settings.sample_time / steps as f64;
    let force = unit_force(frequencies, rows).along(rows * steps, time_step);
    let highest = force.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
    let size = settings.force.unwrap_or(PART * breaking) / highest;
    let force: Vec<f64> = force.into_iter().map(|force| size * force).collect();
    let pressed = PressedMass { mass: cylinder.moving_mass, time_step, substeps: 1 };
    let moved = pressed.displacements(lugre, &force);
    let both = moved.iter().zip(&force).step_by(steps).skip(before);
    let stays = both.take_while(|(moved, _)| moved.abs() <= FARTHEST * length);
    let middle = cylinder.stroke.middle();
    Ok(stays.map(|(moved, force)| CylinderMoment { position: middle + moved, force: *force }).collect())
}

/// Sines of equal size with the phases of Schroeder.
fn unit_force(frequencies: Vec<f64>, rows: usize) -> MultisineForce {
    let phases = schroeder_phases(&vec![1.0; frequencies.len()]);
    let sines = phases.iter().flat_map(|phase| {
        // sin(omega t + phase)
        [phea_dynamics::portable::sin(*phase), phea_dynamics::portable::cos(*phase)]
    });
    let sizes = [0.0; TRENDS].into_iter().chain(sines).collect();
    MultisineForce { rows, sizes, duration: 1.0, frequencies }
}

/// Multiples of the frequency of the period between the ends, evenly spaced.
fn excited(settings: &ShakenFriction, ringing: f64) -> Result<Vec<f64>, BenchError> {
    let spacing = 2.0 * PI / settings.period;
    let [low, high] = settings.frequencies.unwrap_or(AROUND.map(|fraction| fraction * ringing));
    let most = LARGEST_ANGLE / settings.sample_time;
    if high > most {
        return Err(BenchError::ShakenTooFast { highest: high, sample_time: LARGEST_ANGLE / high });
    }
    let [first, last] = [(low / spacing).ceil().max(1.0), (high / spacing).floor()];
    if last < first {
        return Err(BenchError::NothingShaken { frequencies: [low, high], spacing });
    }
    let count = (last - first + 1.0).min(f64::from(settings.lines)) as u32;
    let line = |index: u32| {
        let fraction = if count > 1 { f64::from(index) / f64::from(count - 1) } else { 0.5 };
        (first + fraction * (last - first)).round() * spacing
    };
    Ok((0..count).map(line).collect())
}
