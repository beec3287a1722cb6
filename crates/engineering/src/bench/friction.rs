//! Friction tests of the cylinder: sliding at constant velocities, pressed until it breaks away,
//! and shaken on its bristles, as instruments would record them.
//!
//! ```text
//! velocity | force over time -> LuGre friction, moving mass -> pressures in the chambers -> instruments -> rows
//! ```

mod shaken;

use phea_dynamics::random::{normal, stream};
use phea_dynamics::watch::{Watch, report_progress};
use phea_hydraulics::cylinder::Cylinder;
use phea_hydraulics::friction::{Friction, LuGre, PressedMass};

use super::instrument::Instruments;
use super::{BenchError, MOST_ROWS};
use crate::project::FrictionBench;
use crate::setup::Setup;

/// Readings of the instruments at one time. Units: s, m, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionRow {
    /// Time from the beginning.
    pub time: f64,
    /// Position of the piston.
    pub position: f64,
    /// Pressure p_A.
    pub pressure_a: f64,
    /// Pressure p_B.
    pub pressure_b: f64,
}

/// A recorded run of the cylinder.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionRun {
    /// Kind of the run.
    pub series: FrictionSeries,
    /// Rows in the order of time.
    pub rows: Vec<FrictionRow>,
}

/// Kind of a continuous recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrictionSeries {
    /// Constant velocities in both directions.
    Sliding,
    /// Pressed from A to B until it breaks away.
    Breakaway,
    /// Pressed from B to A until it breaks away.
    BreakawayBack,
    /// Shaken by a force of several frequencies that does not break it away.
    Shaken,
}

impl FrictionSeries {
    const ALL: [FrictionSeries; 4] = [
        FrictionSeries::Sliding,
        FrictionSeries::Breakaway,
        FrictionSeries::BreakawayBack,
        FrictionSeries::Shaken,
    ];

    /// Name in file names.
    pub fn name(self) -> &'static str {
        match self {
            FrictionSeries::Sliding => "sliding",
            FrictionSeries::Breakaway => "breakaway",
            FrictionSeries::BreakawayBack => "breakaway_back",
            FrictionSeries::Shaken => "shaken",
        }
    }
}

/// Position, and force of the pressures on the piston, at one time. Units: m, N.
struct CylinderMoment {
    position: f64,
    force: f64,
}

/// Time at rest at the beginning and after each release, s.
const REST: f64 = 0.05;

/// Fraction of the static friction that is applied before a release.
const PART: f64 = 0.7;

/// Displacement at which a run ends after breakaway, divided by that of the bristles at breakaway.
const BROKEN_AWAY: f64 = 40.0;

/// All runs of the cylinder that `[bench.friction]` requests.
///
/// # Errors
/// [`BenchError`] for a cylinder without bristles, too many rows, or runs beyond the stroke.
pub fn friction_runs(setup: &Setup<'_>, watch: Watch<'_>) -> Result<Vec<FrictionRun>, BenchError> {
    let bench = &setup.project.bench;
    let Some(settings) = bench.friction else { return Ok(Vec::new()) };
    let components = setup.rig()?.actuator.components();
    let Friction::LuGre(lugre) = components.friction else { return Err(BenchError::NoBristles) };
    let nominal_voltage = components.valve.nominal_voltage;
    let mean = f64::midpoint(components.supply.pressure, components.supply.tank_pressure);
    let mut runs = Vec::new();
    for series in FrictionSeries::ALL {
        report_progress(watch, series.name(), 0, 1)?;
        let moments = match series {
            FrictionSeries::Sliding => sliding(&lugre, &components.cylinder, &settings)?,
            FrictionSeries::Breakaway => breakaway(&lugre, &components.cylinder, &settings, 1.0)?,
            FrictionSeries::BreakawayBack => breakaway(&lugre, &components.cylinder, &settings, -1.0)?,
            FrictionSeries::Shaken => shaken::shaken(&lugre, &components.cylinder, &settings.shaken)?,
        };
        let sample_time = match series {
            FrictionSeries::Shaken => settings.shaken.sample_time,
            _ => settings.sample_time,
        };
        let mut noise = stream(u64::from(bench.seed), FIRST_STREAM + series as u64);
        let instruments = Instruments::new(bench, nominal_voltage);
        let chambers = EvenChambers { cylinder: &components.cylinder, mean };
        runs.push(FrictionRun {
            series,
            rows: recorded((&moments, sample_time), (&chambers, &settings), instruments, &mut noise),
        });
    }
    Ok(runs)
}

/// First stream of random numbers; the tests of the valve use the streams below.
const FIRST_STREAM: u64 = 64;

/// Chambers at constant mean pressure.
struct EvenChambers<'a> {
    cylinder: &'a Cylinder,
    mean: f64,
}

impl EvenChambers<'_> {
    /// Pressures p_A and p_B for a force on the piston, Pa.
    fn pressures(&self, force: f64) -> [f64; 2] {
        let [a, b] = [self.cylinder.area_a, self.cylinder.area_b];
        let pressure_a = (force + 2.0 * self.mean * b) / (a + b);
        [pressure_a, 2.0 * self.mean - pressure_a]
    }
}

fn recorded(
    (moments, sample_time): (&[CylinderMoment], f64),
    (chambers, settings): (&EvenChambers<'_>, &FrictionBench),
    mut instruments: Instruments,
    noise: &mut u64,
) -> Vec<FrictionRow> {
    let step = settings.position_resolution;
    let read = |position: f64| if step > 0.0 { (position / step).round() * step } else { position };
    let row = |(index, moment): (usize, &CylinderMoment)| {
        let position = read(moment.position + settings.position_noise * normal(noise));
        let [pressure_a, pressure_b] =
            chambers.pressures(moment.force).map(|value| instruments.pressure(value, noise));
        FrictionRow { time: index as f64 * sample_time, position, pressure_a, pressure_b }
    };
    moments.iter().enumerate().map(row).collect()
}

/// Steps between two rows while the piston slides: the bristles are solved exactly for the velocity
/// in the middle of each.
const STEPS: usize = 20;

/// Sliding from rest through all velocities, the slowest first, each forth and back.
fn sliding(
    lugre: &LuGre,
    cylinder: &Cylinder,
    settings: &FrictionBench,
) -> Result<Vec<CylinderMoment>, BenchError> {
    let corners = velocities(settings);
    let duration = corners.last().map_or(0.0, |(time, _)| *time);
    let rows = counted(duration / settings.sample_time)?;
    let step = settings.sample_time / STEPS as f64;
    let (mut position, mut deflection) = (cylinder.stroke.middle(), 0.0);
    let mut moments = Vec::with_capacity(rows);
    let mut piece = 0;
    for row in 0..rows {
        let time = row as f64 * settings.sample_time;
        let (velocity, acceleration) = along(&corners, time, &mut piece);
        let force = lugre.force(velocity, deflection) + cylinder.moving_mass * acceleration;
        moments.push(CylinderMoment { position, force });
        for part in 0..STEPS {
            let middle = time + (part as f64 + 0.5) * step;
            let (velocity, _) = along(&corners, middle, &mut piece);
            position += velocity * step;
            let carried = lugre.curve.sliding_force(velocity);
            let rate = lugre.bristle_stiffness * velocity.abs() / carried;
            let settled = velocity.signum() * carried / lugre.bristle_stiffness;
            deflection = settled + (deflection - settled) * phea_dynamics::portable::exp(-rate * step);
        }
        if !cylinder.stroke.contains(position) {
            let travel = settings.fastest * (settings.run_time + settings.change_time);
            return Err(BenchError::BeyondStroke {
                travel,
                stroke: cylinder.stroke.length().unwrap_or(f64::INFINITY),
            });
        }
    }
    Ok(moments)
}

/// Times and velocities between which the velocity is linear.
fn velocities(settings: &FrictionBench) -> Vec<(f64, f64)> {
    let count = settings.velocities.max(1);
    let ratio = settings.fastest / settings.slowest;
    let mut corners = vec![(0.0, 0.0), (REST, 0.0)];
    let mut time = REST;
    for index in 0..count {
        let fraction = if count > 1 { f64::from(index) / f64::from(count - 1) } else { 0.0 };
        let speed = settings.slowest * phea_dynamics::portable::pow(ratio, fraction);
        for velocity in [speed, -speed] {
            time += settings.change_time;
            corners.push((time, velocity));
            time += settings.run_time;
            corners.push((time, velocity));
        }
    }
    corners.push((time + settings.change_time, 0.0));
    corners
}

/// Value and slope at a time; `piece` is the index of the last piece found.
fn along(corners: &[(f64, f64)], time: f64, piece: &mut usize) -> (f64, f64) {
    while corners.get(*piece + 1).is_some_and(|(end, _)| *end <= time) && *piece + 2 < corners.len() {
        *piece += 1;
    }
    while corners.get(*piece).is_some_and(|(start, _)| *start > time) && *piece > 0 {
        *piece -= 1;
    }
    let (Some((start, from)), Some((end, to))) = (corners.get(*piece), corners.get(*piece + 1)) else {
        return (0.0, 0.0);
    };
    let slope = (to - from) / (end - start);
    (from + slope * (time - start).min(end - start), slope)
}

/// Breakaway from rest: a part of the static friction applied slowly and released quickly, in both
/// directions; then a ramp until the piston breaks away.
fn breakaway(
    lugre: &LuGre,
    cylinder: &Cylinder,
    settings: &FrictionBench,
    way: f64,
) -> Result<Vec<CylinderMoment>, BenchError> {
    let breaking = lugre.curve.levels(way).static_friction;
    let peak = settings.peak_force.unwrap_or(1.3 * breaking);
    let corners = forces(settings, peak, PART * least_static(lugre));
    let duration = corners.last().map_or(0.0, |(time, _)| *time);
    let rows = counted(duration / settings.sample_time)?;
    let length = breaking / lugre.bristle_stiffness;
    let fastest = (2.0 * peak * BROKEN_AWAY * length / cylinder.moving_mass).sqrt();
    let steps = counted((settings.sample_time / longest_step(lugre, fastest)).ceil())?.max(1);
    counted(rows as f64 * steps as f64 / 100.0)?;
    let time_step = settings.sample_time / steps as f64;
    let mut piece = 0;
    let force: Vec<f64> = (0..rows * steps)
        .map(|index| way * along(&corners, index as f64 * time_step, &mut piece).0)
        .collect();
    let pressed = PressedMass { mass: cylinder.moving_mass, time_step, substeps: 1 };
    let moved = pressed.displacements(lugre, &force);
    let both = moved.iter().zip(&force).step_by(steps);
    let before = both.take_while(|(moved, _)| moved.abs() <= BROKEN_AWAY * length);
    let middle = cylinder.stroke.middle();
    Ok(before.map(|(moved, force)| CylinderMoment { position: middle + moved, force: *force }).collect())
}

/// Largest slip of the bristles in a step, divided by their deflection.
const LONGEST_SLIP: f64 = 0.1;

/// Longest integration step up to this velocity, s.
fn longest_step(lugre: &LuGre, fastest: f64) -> f64 {
    let [extending, retracting] = lugre.curve.both_levels();
    let least = extending.coulomb.min(retracting.coulomb);
    LONGEST_SLIP * least / (lugre.bristle_stiffness * fastest)
}

/// Static friction, N, the lesser of both directions.
fn least_static(lugre: &LuGre) -> f64 {
    let [extending, retracting] = lugre.curve.both_levels();
    extending.static_friction.min(retracting.static_friction)
}

/// Times and forces between which the force is linear.
fn forces(settings: &FrictionBench, peak: f64, part: f64) -> Vec<(f64, f64)> {
    // no corner coincides with a row
    let mut time = REST + 0.37 * settings.sample_time;
    let mut corners = vec![(0.0, 0.0), (time, 0.0)];
    for index in 0..settings.releases {
        let way = if index % 2 == 0 { 1.0 } else { -1.0 };
        time += settings.ramp_time * part / peak;
        corners.push((time, way * part));
        time += settings.release_time;
        corners.push((time, 0.0));
        time += REST;
        corners.push((time, 0.0));
    }
    corners.push((time + settings.ramp_time, peak));
    corners
}

/// Number of rows, if it can be recorded.
fn counted(rows: f64) -> Result<usize, BenchError> {
    match rows {
        rows if rows <= MOST_ROWS as f64 => Ok(rows as usize),
        rows => Err(BenchError::TooManyRows { rows, most: MOST_ROWS }),
    }
}
