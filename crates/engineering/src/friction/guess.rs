//! Where the search begins.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::portable;
use phea_hydraulics::friction::{LuGre, Stribeck};

use super::FrictionRecording;
use super::motion::{ConstantVelocity, noise};
use super::pressing::{PressedRows, compliance, pressed_rows};
use super::problem::Around;
use super::shaking::{ShakenRows, shaken_rows};

/// A friction near that of the recordings, and what is pressed and shaken in them.
pub(super) struct Guess {
    pub(super) around: Around,
    pub(super) presses: Vec<PressedRows>,
    pub(super) shakes: Vec<ShakenRows>,
}

/// Damping ratio of the mass on its bristles that is taken for granted: under a slow force it does
/// not matter.
const DAMPING_RATIO: f64 = 0.5;

/// Distance over which bristles settle, over the shortest way at a constant velocity, where nothing
/// is known.
const SETTLED: f64 = 0.05;

pub(super) fn guess(
    recordings: &[FrictionRecording],
    slides: &[ConstantVelocity],
    mass: f64,
) -> Option<Guess> {
    let is_pressed =
        |index: usize| recordings.get(index).is_some_and(|one| one.has_position) && !slides_in(slides, index);
    let pressed: Vec<usize> = (0..recordings.len()).filter(|index| is_pressed(*index)).collect();
    let forces = pressed.iter().filter_map(|index| recordings.get(*index));
    let greatest = forces.map(|one| greatest_force(&one.forces)).fold(0.0, f64::max);
    let curve = steady_guess(slides).or_else(|| (greatest > 0.0).then(|| without_sliding(greatest)))?;
    let mut compliances = Vec::new();
    let mut presses = Vec::new();
    let mut shakes = Vec::new();
    for index in pressed {
        let Some(recording) = recordings.get(index) else { continue };
        if let Some(shake) = shaken_rows(recording, index) {
            shakes.push(shake);
            continue;
        }
        let compliance = compliance(recording, curve.static_friction);
        let press = pressed_rows(recording, index, compliance * curve.static_friction);
        compliances.extend(press.is_some().then_some(compliance));
        presses.extend(press);
    }
    if presses.is_empty() && slides.is_empty() && shakes.is_empty() {
        return None;
    }
    // springs and dampers that answer as the shaken piston did
    let alike: Vec<[f64; 2]> = shakes.iter().map(|shake| shake.spring_and_damper(mass)).collect();
    let mean = |place: usize| alike.iter().map(|one| one[place]).sum::<f64>() / alike.len().max(1) as f64;
    let bristle_stiffness = match compliances.is_empty() {
        _ if mean(0) > 0.0 => mean(0),
        false => compliances.len() as f64 / compliances.iter().sum::<f64>(),
        true => curve.static_friction / (SETTLED * shortest_way(slides, recordings)),
    };
    let damping = (bristle_stiffness * mass).sqrt();
    // the slip of the bristles damps too, so that there is more than theirs
    let bristle_damping = match mean(1) > 0.0 {
        true => (mean(1) - curve.viscous).max(0.1 * mean(1)),
        false => 2.0 * DAMPING_RATIO * damping,
    };
    let fastest = slides.iter().map(|slide| slide.velocity.abs()).fold(0.0, f64::max);
    let usual = curve.stribeck_velocity;
    let around = Around {
        lugre: LuGre { curve, bristle_stiffness, bristle_damping },
        force: curve.static_friction,
        damping: [curve.static_friction / if fastest > 0.0 { fastest } else { usual }, damping],
        length: curve.static_friction / bristle_stiffness,
    };
    Some(Guess { around, presses, shakes })
}

fn slides_in(slides: &[ConstantVelocity], recording: usize) -> bool {
    slides.iter().any(|slide| slide.recording == recording)
}

/// The greatest force, without the noise on it.
fn greatest_force(forces: &[f64]) -> f64 {
    let largest = forces.iter().map(|force| force.abs()).fold(0.0, f64::max);
    (largest - 3.0 * noise(forces)).max(0.0)
}

/// Where nothing slides: as good as Coulomb friction, at velocities below which it is not recorded.
fn without_sliding(static_friction: f64) -> Stribeck {
    Stribeck {
        coulomb: 0.8 * static_friction,
        static_friction,
        stribeck_velocity: 0.01,
        stribeck_exponent: 2.0,
        viscous: 0.0,
    }
}

/// m, of the slowest run.
fn shortest_way(slides: &[ConstantVelocity], recordings: &[FrictionRecording]) -> f64 {
    let way = |slide: &ConstantVelocity| {
        let time_step = recordings.get(slide.recording).map_or(0.0, |recording| recording.time_step);
        slide.velocity.abs() * slide.rows.len() as f64 * time_step
    };
    slides.iter().map(way).fold(f64::INFINITY, f64::min)
}

/// The steady curve through the forces in the second half of each constant velocity: linear least
/// squares for each of some Stribeck velocities and exponents, and the best of them.
fn steady_guess(slides: &[ConstantVelocity]) -> Option<Stribeck> {
    const VELOCITIES: usize = 12;
    if slides.is_empty() {
        return None;
    }
    let points: Vec<(f64, f64)> =
        slides.iter().map(|slide| (slide.velocity, slide.settled_force())).collect();
    let speeds = || points.iter().map(|(velocity, _)| velocity.abs());
    let [slowest, fastest] = [speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max)];
    let typical = points.iter().map(|(_, force)| force.abs()).fold(0.0, f64::max);
    let mut best: Option<(f64, Stribeck)> = None;
    for index in 0..VELOCITIES {
        let share = index as f64 / (VELOCITIES - 1) as f64;
        let stribeck_velocity = slowest * portable::pow(fastest / slowest, share);
        for stribeck_exponent in [2.0, 1.0] {
            let Some((cost, [coulomb, fall, viscous])) =
                linear_part(&points, stribeck_velocity, stribeck_exponent)
            else {
                continue;
            };
            let coulomb = coulomb.max(0.01 * typical);
            let curve = Stribeck {
                coulomb,
                static_friction: coulomb + fall.max(0.01 * typical),
                stribeck_velocity,
                stribeck_exponent,
                viscous: viscous.max(0.0),
            };
            // what a friction cannot be is worse than anything it can be
            let cost = if fall < 0.0 || viscous < 0.0 { 1e6 * (1.0 + cost) } else { cost };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, curve));
            }
        }
    }
    best.filter(|_| typical > 0.0).map(|(_, curve)| curve)
}

/// Sum of squares, and F_C, F_S - F_C and sigma_2; with a zero of the force where it goes both
/// ways.
fn linear_part(points: &[(f64, f64)], velocity: f64, exponent: f64) -> Option<(f64, [f64; 3])> {
    let both = points.iter().any(|(v, _)| *v > 0.0) && points.iter().any(|(v, _)| *v < 0.0);
    let row = |v: f64| {
        let falling = portable::exp(-portable::pow(v.abs() / velocity, exponent));
        [v.signum(), v.signum() * falling, v, if both { 1.0 } else { 0.0 }]
    };
    let rows: Vec<f64> = points.iter().flat_map(|(v, _)| row(*v)).collect();
    let matrix = DMatrix::from_row_slice(points.len(), 4, &rows);
    let forces = DVector::from_iterator(points.len(), points.iter().map(|(_, force)| *force));
    let solved = matrix.clone().svd(true, true).solve(&forces, 1e-9).ok()?;
    let left = &matrix * &solved - forces;
    Some((left.norm_squared(), [solved[0], solved[1], solved[2]]))
}
