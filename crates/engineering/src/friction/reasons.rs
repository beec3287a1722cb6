//! Reasons why the recordings leave coefficients open. Each missing fact is a separate reason, and
//! is reported together with the others.

use std::f64::consts::PI;

use phea_hydraulics::friction::{FRICTION_COEFFICIENTS, LuGre};

use super::directions::DirectionModel;
use super::estimates::OpenCoefficient;
use super::problem::FrictionProblem;
use super::{ConstantVelocity, PressedRows};

/// Reason why the recordings do not determine a coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotIdentifiableFriction {
    /// Nothing slides at a constant velocity.
    NothingSlides,
    /// The force is equal at all slow velocities: no fall from static friction is visible.
    NoFall,
    /// Friction falls from static to Coulomb friction, and too few runs slide in between.
    FewOnFall {
        /// Velocity below which further runs would show it, m/s.
        below: f64,
    },
    /// Neither is a run slow enough for static friction, nor does the piston break away from rest.
    NotApproached,
    /// Nothing is pressed from rest while its position is recorded.
    NothingPressed,
    /// Nothing shakes the piston on its bristles while its position is recorded.
    NothingShaken {
        /// Frequency at which the mass oscillates on the bristles, rad/s, if their stiffness is
        /// determined.
        ringing: Option<f64>,
        /// Static friction, N, if it is determined.
        breaking: Option<f64>,
    },
    /// The piston is shaken, but there are too few rows in a period of its oscillation on the
    /// bristles.
    TooFewRows {
        /// Longest sufficient time between rows, s.
        time_step: f64,
    },
    /// The piston is shaken too little, or far from its natural frequency.
    ShakenTooLittle {
        /// Ratio of the standard deviation to the largest one at which it is determined.
        factor: f64,
    },
    /// The force changes within a few rows, or rises too quickly, while the piston is pressed.
    QuickForce,
    /// Noise hides the coefficient.
    Hidden,
    /// The rows that are pressed are not explained.
    NotExplained {
        /// Ratio of the residual to the noise.
        residual: f64,
    },
}

/// Duration of a slowly rising force in terms of the delay by the damping: twice its inverse is the
/// error of the stiffness if the damping is not the assumed one.
const SLOW: f64 = 250.0;

/// Fewest rows in a period of the oscillation on the bristles.
pub const ROWS_OF_RINGING: f64 = 8.0;

/// Least ratio of static friction to the friction of the slowest run.
const UP_TO_NOISE: f64 = 0.98;

/// Ratio of residual to noise beyond which recordings are not explained.
const EXPLAINED: f64 = 1.5;

impl OpenCoefficient {
    /// Adds a reason. A missing recording is more informative than hiding noise.
    fn leave_open(&mut self, reason: NotIdentifiableFriction) {
        self.reasons.retain(|known| *known != NotIdentifiableFriction::Hidden && *known != reason);
        self.reasons.push(reason);
    }
}

/// Fall from static to Coulomb friction of a direction, and its standard deviation, N.
#[derive(Clone, Copy)]
pub(super) struct Fall {
    pub(super) value: f64,
    pub(super) deviation: f64,
}

/// Coulomb and static friction of a direction, and the data that show them.
struct LoadedDirection<'a> {
    levels: [&'a mut OpenCoefficient; 2],
    fall: Fall,
    slides: Vec<&'a ConstantVelocity>,
    presses: Vec<&'a PressedRows>,
}

/// Adds the known reasons to each open coefficient.
pub(super) fn reasons(
    problem: &FrictionProblem<'_>,
    lugre: &LuGre,
    found: &mut [OpenCoefficient; FRICTION_COEFFICIENTS],
    falls: [Fall; 2],
) {
    let [coulomb, breaking, velocity, exponent, viscous, stiffness, damping, back_coulomb, back_breaking, _] =
        found;
    let differs = problem.directions == DirectionModel::DiffersByDirection;
    let directions = [(coulomb, breaking, 1.0), (back_coulomb, back_breaking, -1.0)];
    let mut directions: Vec<LoadedDirection<'_>> = directions
        .into_iter()
        .zip(falls)
        .take(if differs { 2 } else { 1 })
        .map(|((coulomb, breaking, way), fall)| LoadedDirection {
            levels: [coulomb, breaking],
            fall,
            slides: problem.slides.iter().filter(|one| !differs || one.velocity * way > 0.0).collect(),
            presses: problem.presses.iter().filter(|one| !differs || one.way() * way > 0.0).collect(),
        })
        .collect();
    of_the_fall(problem, &directions, [velocity, exponent]);
    for direction in &mut directions {
        of_levels(problem, lugre, direction);
    }
    if problem.slides.is_empty() {
        viscous.leave_open(NotIdentifiableFriction::NothingSlides);
    }
    if problem.presses.is_empty() && problem.shakes.is_empty() && !stiffness.is_determined() {
        stiffness.leave_open(NotIdentifiableFriction::NothingPressed);
    }
    let breaking = directions.first().and_then(|one| {
        let [_, breaking] = &one.levels;
        breaking.is_determined().then_some(breaking.estimate.value)
    });
    of_the_bristles(problem, [stiffness, damping], breaking);
}

/// Reasons for Stribeck velocity and exponent.
fn of_the_fall(
    problem: &FrictionProblem<'_>,
    directions: &[LoadedDirection<'_>],
    [velocity, exponent]: [&mut OpenCoefficient; 2],
) {
    let falls = directions.iter().any(|direction| {
        let [coulomb, breaking] = &direction.levels;
        direction.fall.value > 2.0 * direction.fall.deviation
            || breaking.estimate.interval[0] > coulomb.estimate.interval[1]
    });
    let fastest = problem.slides.iter().map(|slide| slide.velocity.abs()).fold(0.0, f64::max);
    let below = (2.0 * velocity.estimate.interval[1]).min(fastest);
    for one in [velocity, exponent] {
        if problem.slides.is_empty() {
            one.leave_open(NotIdentifiableFriction::NothingSlides);
        } else if !falls {
            one.leave_open(NotIdentifiableFriction::NoFall);
        } else if !one.is_determined() {
            one.leave_open(NotIdentifiableFriction::FewOnFall { below });
        }
    }
}

/// Reasons for Coulomb and static friction.
fn of_levels(problem: &FrictionProblem<'_>, lugre: &LuGre, direction: &mut LoadedDirection<'_>) {
    let LoadedDirection { levels: [coulomb, breaking], slides, presses, .. } = direction;
    if slides.is_empty() {
        coulomb.leave_open(NotIdentifiableFriction::NothingSlides);
    }
    if presses.is_empty() && !slides.is_empty() && !breaking.is_determined() {
        breaking.leave_open(NotIdentifiableFriction::NotApproached);
        // static friction is no less than the friction of the slowest run, up to noise
        let slowest = slides.iter().map(|slide| slide.velocity);
        let slowest = slowest.min_by(|one, other| one.abs().total_cmp(&other.abs())).unwrap_or(0.0);
        let shown = UP_TO_NOISE * lugre.curve.sliding_force(slowest);
        let [low, _] = &mut breaking.estimate.interval;
        *low = low.min(shown);
    }
    if problem.presses.is_empty() && problem.slides.is_empty() {
        breaking.leave_open(NotIdentifiableFriction::NothingPressed);
    }
}

/// Reasons for stiffness and damping of the bristles.
fn of_the_bristles(
    problem: &FrictionProblem<'_>,
    [stiffness, damping]: [&mut OpenCoefficient; 2],
    breaking: Option<f64>,
) {
    let explained = problem.channels.get(problem.sliding_channels()..).unwrap_or_default();
    let residual = explained.iter().map(|channel| channel.scale / channel.noise).fold(0.0, f64::max);
    if residual > EXPLAINED {
        for one in [&mut *stiffness, &mut *damping] {
            one.leave_open(NotIdentifiableFriction::NotExplained { residual });
        }
    }
    let ringing = (stiffness.estimate.value / problem.mass).sqrt();
    let longest = 2.0 * PI / (ROWS_OF_RINGING * ringing);
    if shaken_time_step(problem).is_some_and(|time_step| time_step > longest) {
        damping.leave_open(NotIdentifiableFriction::TooFewRows { time_step: longest });
    }
    let is_quick = presses_quickly(problem, stiffness, damping);
    if problem.shakes.is_empty() {
        let ringing = stiffness.is_determined().then_some(ringing);
        damping.estimate.interval = [0.0, f64::INFINITY];
        damping.leave_open(NotIdentifiableFriction::NothingShaken { ringing, breaking });
    } else if is_quick {
        damping.leave_open(NotIdentifiableFriction::QuickForce);
    }
    if is_quick {
        stiffness.leave_open(NotIdentifiableFriction::QuickForce);
    }
}

/// Longest time between the rows of the shakes, s.
fn shaken_time_step(problem: &FrictionProblem<'_>) -> Option<f64> {
    let recordings = problem.shakes.iter().filter_map(|shake| problem.recordings.get(shake.recording));
    recordings.map(|one| one.time_step).reduce(f64::max)
}

/// True if a pressing force is not known between its rows, or is too quick for an assumed damping,
/// which delays the mass.
fn presses_quickly(
    problem: &FrictionProblem<'_>,
    stiffness: &OpenCoefficient,
    damping: &OpenCoefficient,
) -> bool {
    let is_searched = !problem.shakes.is_empty() && damping.is_determined();
    let delay = if is_searched { 0.0 } else { damping.estimate.value / stiffness.estimate.value };
    problem.presses.iter().any(|press| {
        let time_step = problem.recordings.get(press.recording).map_or(0.0, |one| one.time_step);
        press.has_quick_force || press.rows as f64 * time_step < SLOW * delay
    })
}
