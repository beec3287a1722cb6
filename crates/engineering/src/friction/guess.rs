//! Initial estimate, at which the search begins.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::portable;
use phea_hydraulics::friction::{FrictionLevels, LuGre, Stribeck};

use super::FrictionRecording;
use super::motion::{ConstantVelocity, noise};
use super::pressing::{Breakaway, PressedRows, breakaway, compliance, pressed_rows};
use super::problem::Around;
use super::shaking::{ShakenRows, shaken_rows};

/// A friction near that of the recordings, and their pressed and shaken rows.
pub(super) struct Guess {
    pub(super) around: Around,
    /// Further curves and zero errors of the force from which a search begins.
    pub(super) others: Vec<(Stribeck, f64)>,
    /// A curve with levels for each direction; `None` if nothing slides in one of them.
    pub(super) by_direction: Option<Stribeck>,
    pub(super) presses: Vec<PressedRows>,
    pub(super) shakes: Vec<ShakenRows>,
}

/// Assumed damping ratio of the mass on its bristles: under a slow force it does not matter.
const DAMPING_RATIO: f64 = 0.5;

/// Ratio of the distance over which bristles settle to the shortest path at a constant velocity, if
/// nothing is known.
const SETTLED: f64 = 0.05;

/// Largest ratio of the distance over which the effect of a reversal decays to the shortest path at
/// a constant velocity: a run whose force still changes is not steady.
const LEFT_BY_REVERSAL: f64 = 0.2;

pub(super) fn guess(
    recordings: &[FrictionRecording],
    slides: &[ConstantVelocity],
    mass: f64,
) -> Option<Guess> {
    let mut shakes = Vec::new();
    let mut pressed = Vec::new();
    for (index, recording) in recordings.iter().enumerate() {
        if recording.has_position && !slides_in(slides, index) {
            match shaken_rows(recording, index) {
                Some(shake) => shakes.push(shake),
                None => pressed.push((index, recording)),
            }
        }
    }
    let breakaways: Vec<Breakaway> =
        pressed.iter().filter_map(|(_, recording)| breakaway(recording)).collect();
    let forces = recordings.iter().enumerate().filter(|(index, _)| !slides_in(slides, *index));
    let greatest = forces.map(|(_, one)| greatest_force(&one.forces)).fold(0.0, f64::max);
    let mut steady = steady_guesses(slides, &breakaways).into_iter();
    let first = steady.next();
    let (curve, zero) = first.or_else(|| (greatest > 0.0).then(|| (without_sliding(greatest), 0.0)))?;
    let mut compliances = Vec::new();
    let mut presses = Vec::new();
    for (index, recording) in pressed {
        let compliance = compliance(recording, curve.static_friction);
        let press = pressed_rows(recording, index, compliance * curve.static_friction);
        compliances.extend(press.is_some().then_some(compliance));
        presses.extend(press);
    }
    if presses.is_empty() && slides.is_empty() && shakes.is_empty() {
        return None;
    }
    // springs and dampers with the response of the shaken piston
    let alike: Vec<[f64; 2]> = shakes.iter().map(|shake| shake.spring_and_damper(mass)).collect();
    let mean = |place: usize| alike.iter().map(|one| one[place]).sum::<f64>() / alike.len().max(1) as f64;
    let bristle_stiffness = match compliances.is_empty() {
        _ if mean(0) > 0.0 => mean(0),
        false => compliances.len() as f64 / compliances.iter().sum::<f64>(),
        true => curve.static_friction / (SETTLED * shortest_way(slides, recordings)),
    };
    let damping = (bristle_stiffness * mass).sqrt();
    // the slip of the bristles adds damping, so that the total exceeds theirs
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
        zero,
        softest: curve.static_friction / (LEFT_BY_REVERSAL * shortest_way(slides, recordings)),
    };
    let by_direction = directed_guess(slides, &breakaways);
    Some(Guess { around, others: steady.collect(), by_direction, presses, shakes })
}

fn slides_in(slides: &[ConstantVelocity], recording: usize) -> bool {
    slides.iter().any(|slide| slide.recording == recording)
}

/// Greatest force, without its noise.
fn greatest_force(forces: &[f64]) -> f64 {
    let largest = forces.iter().map(|force| force.abs()).fold(0.0, f64::max);
    (largest - 3.0 * noise(forces)).max(0.0)
}

/// Curve without sliding: close to Coulomb friction, at velocities below any recorded one.
fn without_sliding(static_friction: f64) -> Stribeck {
    Stribeck {
        coulomb: 0.8 * static_friction,
        static_friction,
        stribeck_velocity: 0.01,
        stribeck_exponent: 2.0,
        viscous: 0.0,
        retracting: None,
    }
}

/// Shortest path of a run, m.
fn shortest_way(slides: &[ConstantVelocity], recordings: &[FrictionRecording]) -> f64 {
    let way = |slide: &ConstantVelocity| {
        let time_step = recordings.get(slide.recording).map_or(0.0, |recording| recording.time_step);
        slide.velocity.abs() * slide.rows.len() as f64 * time_step
    };
    slides.iter().map(way).fold(f64::INFINITY, f64::min)
}

/// Ratio of the velocity at which a piston breaks away to the slowest sliding velocity.
const AT_REST: f64 = 1e-6;

/// Ratio of the slowest evaluated Stribeck velocity to the slowest sliding velocity.
const BELOW_SLOWEST: f64 = 0.1;

/// Largest ratio of static friction to the greatest recorded force: few speeds are explained by any
/// fall that is over before the slowest.
const PLAUSIBLE: f64 = 1.5;

/// Largest number of curves from which a search begins.
const STARTS: usize = 8;

/// Steady curves, and zero errors of the force, N, through the forces in the second half of each
/// constant velocity and those at which the piston breaks away: linear least squares for each of
/// some Stribeck velocities and exponents, the best first. Many curves explain few speeds.
fn steady_guesses(slides: &[ConstantVelocity], breakaways: &[Breakaway]) -> Vec<(Stribeck, f64)> {
    if slides.is_empty() {
        return without_slides(breakaways).into_iter().collect();
    }
    let points = steady_points(slides, breakaways);
    let mut found: Vec<(f64, Stribeck, f64)> =
        shapes(slides).filter_map(|(velocity, exponent)| steady_curve(&points, velocity, exponent)).collect();
    found.sort_by(|one, other| one.0.total_cmp(&other.0));
    found.into_iter().take(STARTS).map(|(_, curve, zero)| (curve, zero)).collect()
}

/// Best curve through these forces with levels for each direction, which have the Stribeck velocity
/// and its exponent in common.
fn directed_guess(slides: &[ConstantVelocity], breakaways: &[Breakaway]) -> Option<Stribeck> {
    let (out, back): (Vec<_>, Vec<_>) =
        steady_points(slides, breakaways).into_iter().partition(|(velocity, _)| *velocity > 0.0);
    let slides_both_ways =
        [1.0, -1.0].iter().all(|way| slides.iter().any(|slide| slide.velocity * way > 0.0));
    let curve = |(velocity, exponent): (f64, f64)| {
        let (cost, curve, _) = steady_curve(&out, velocity, exponent)?;
        let (cost_back, back, _) = steady_curve(&back, velocity, exponent)?;
        let Stribeck { coulomb, static_friction, viscous, .. } = back;
        let retracting = Some(FrictionLevels { coulomb, static_friction, viscous });
        Some((cost + cost_back, Stribeck { retracting, ..curve }))
    };
    let all = shapes(slides).filter(|_| slides_both_ways).filter_map(curve);
    all.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, curve)| curve)
}

/// Velocities and forces of all runs, with breakaway at almost zero velocity.
fn steady_points(slides: &[ConstantVelocity], breakaways: &[Breakaway]) -> Vec<(f64, f64)> {
    let slowest = slides.iter().map(|slide| slide.velocity.abs()).fold(f64::INFINITY, f64::min);
    let slid = slides.iter().map(|slide| (slide.velocity, slide.settled_force()));
    let broken = breakaways.iter().map(|one| (one.way * AT_REST * slowest, one.force));
    slid.chain(broken).collect()
}

/// Stribeck velocities and exponents that are tested.
fn shapes(slides: &[ConstantVelocity]) -> impl Iterator<Item = (f64, f64)> {
    const VELOCITIES: usize = 16;
    let speeds = || slides.iter().map(|slide| slide.velocity.abs());
    let [slowest, fastest] = [speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max)];
    let first = BELOW_SLOWEST * slowest;
    let ratio = portable::pow(fastest / first, 1.0 / (VELOCITIES - 1) as f64);
    let velocities = (0..VELOCITIES).map(move |index| first * portable::pow(ratio, index as f64));
    velocities.flat_map(|velocity| [2.0, 1.0].map(|exponent| (velocity, exponent)))
}

/// Curve with this Stribeck velocity and exponent, its zero error, and the misfit of both.
fn steady_curve(points: &[(f64, f64)], velocity: f64, exponent: f64) -> Option<(f64, Stribeck, f64)> {
    let typical = points.iter().map(|(_, force)| force.abs()).fold(0.0, f64::max);
    let (cost, [coulomb, fall, viscous, zero]) = linear_part(points, velocity, exponent)?;
    // an impossible friction is worse than any possible one
    let is_friction = coulomb > 0.0 && fall >= 0.0 && viscous >= 0.0 && coulomb + fall <= PLAUSIBLE * typical;
    let cost = if is_friction { cost } else { 1e6 * (1.0 + cost) };
    let coulomb = coulomb.max(0.01 * typical);
    let curve = Stribeck {
        coulomb,
        static_friction: coulomb + fall.clamp(0.01 * typical, PLAUSIBLE * typical),
        stribeck_velocity: velocity,
        stribeck_exponent: exponent,
        viscous: viscous.max(0.0),
        retracting: None,
    };
    (typical > 0.0).then_some((cost, curve, zero))
}

/// Curve from only the breakaway forces: those of both directions separate the zero error.
fn without_slides(breakaways: &[Breakaway]) -> Option<(Stribeck, f64)> {
    let mean = |way: f64| {
        let own = breakaways.iter().filter(|one| one.way == way).map(|one| one.force);
        let count = own.clone().count();
        (count > 0).then(|| own.sum::<f64>() / count as f64)
    };
    let zero = mean(1.0).zip(mean(-1.0)).map_or(0.0, |(out, back)| f64::midpoint(out, back));
    let static_friction = breakaways.iter().map(|one| (one.force - zero).abs()).fold(0.0, f64::max);
    (static_friction > 0.0).then(|| (without_sliding(static_friction), zero))
}

/// Sum of squares, and F_C, F_S - F_C, sigma_2 and the zero error of the force, which is 0 if the
/// force acts in only one direction.
fn linear_part(points: &[(f64, f64)], velocity: f64, exponent: f64) -> Option<(f64, [f64; 4])> {
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
    Some((left.norm_squared(), [solved[0], solved[1], solved[2], solved[3]]))
}
