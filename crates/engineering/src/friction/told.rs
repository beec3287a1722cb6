//! What the recordings determine of each coefficient, and why they leave others open.

use std::f64::consts::PI;

use phea_dynamics::least_squares::{Linearised, Minimum, Uncertainty, uncertainty_by_scale};
use phea_dynamics::portable;
use phea_hydraulics::friction::{FRICTION_COEFFICIENTS, LuGre};

use super::problem::{DAMPING, FrictionProblem, ZERO};
use super::profile::{HeldCoefficient, SlidingProfile};

/// A coefficient as determined by the recordings. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionEstimate {
    /// Where the sum of squares has its minimum.
    pub value: f64,
    /// Ends of the 95 % interval; the upper one is infinite where nothing limits it.
    pub interval: [f64; 2],
    /// Why it is not determined; `None` where it is.
    pub untold: Option<UntoldFriction>,
}

/// Why the recordings do not determine a coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UntoldFriction {
    /// Nothing slides at a constant velocity.
    NothingSlides,
    /// The force is the same at all slow velocities: no fall from static friction is seen.
    NoFall,
    /// Friction falls from static to Coulomb friction, and too few runs slide in between.
    FewOnFall {
        /// m/s, up to which further runs would show it.
        below: f64,
    },
    /// Neither is a run slow enough for static friction, nor does the piston break away from rest.
    NotApproached,
    /// Nothing is pressed from rest while its position is recorded.
    NothingPressed,
    /// Nothing shakes the piston on its bristles while its position is recorded.
    NothingShaken {
        /// rad/s, at which the mass rings on the bristles, where their stiffness is determined.
        ringing: Option<f64>,
        /// N, static friction, where it is determined.
        breaking: Option<f64>,
    },
    /// The piston is shaken, and there are too few rows in a period of its ringing.
    TooFewRows {
        /// s between rows, the longest that would do.
        time_step: f64,
    },
    /// The piston is shaken too little, or away from where it rings.
    ShakenTooLittle {
        /// Standard deviation over the largest at which it is determined.
        factor: f64,
    },
    /// The force changes within a few rows, or rises too quickly, while the piston is pressed.
    QuickForce,
    /// Noise hides it.
    Hidden,
    /// What is pressed is not explained.
    NotExplained {
        /// What is left, over the noise.
        residual: f64,
    },
}

/// Half width of a 95 % interval of a normal distribution, in standard deviations.
const NORMAL_95: f64 = 1.96;

/// Standard deviation over the value beyond which a coefficient is not determined, as for a valve.
const UNTOLD: f64 = 0.5;

/// Duration of a force that rises slowly, over the delay by the damping: twice its inverse is the
/// error of the stiffness where the damping is not the one that is taken for granted.
const SLOW: f64 = 250.0;

/// Fewest rows in a period of the ringing.
pub const ROWS_OF_RINGING: f64 = 8.0;

/// Part of the friction of the slowest run that static friction has at least.
const UP_TO_NOISE: f64 = 0.98;

/// Residual over noise beyond which recordings are not explained.
const EXPLAINED: f64 = 1.5;

/// Standard deviation over the value beyond which an interval is taken from the profile of the sum.
const NOT_A_PARABOLA: f64 = 0.1;

/// First step along a profile, in the variables: logarithms, or parts of a typical value.
const FIRST_STEPS: [f64; 2] = [0.02, 0.3];

/// How a coefficient follows from the variables.
#[derive(Clone, Copy)]
enum VariableForm {
    /// In proportion to its variable, which is in this unit.
    Linear(f64),
    /// By the exponential of it.
    Logarithmic,
}

/// Of each coefficient, and of the zero of the force.
pub(super) fn estimates(
    problem: &FrictionProblem<'_>,
    minimum: &Minimum,
) -> ([FrictionEstimate; FRICTION_COEFFICIENTS], Option<FrictionEstimate>) {
    let (lugre, zero) = problem.friction(&minimum.variables);
    let told = uncertainty_by_scale(&searched_only(problem, minimum), problem.count());
    let around = problem.around;
    let force = around.force;
    let values = lugre.to_array();
    let forms = [
        VariableForm::Linear(force),
        VariableForm::Linear(force),
        VariableForm::Logarithmic,
        VariableForm::Logarithmic,
        VariableForm::Linear(around.damping[0]),
        VariableForm::Logarithmic,
        VariableForm::Linear(around.damping[1]),
    ];
    let alone = |index: usize| told.deviations.get(index).copied().unwrap_or(f64::INFINITY);
    let profile = SlidingProfile::around(problem, minimum);
    let mut index = 0;
    let found = values.map(|value| {
        // F_C is F_S, the first variable, less the fall, the second
        let deviation = match index {
            0 => difference(&told),
            1 => alone(0),
            other => alone(other),
        };
        index += 1;
        let form = forms.get(index - 1).copied().unwrap_or(VariableForm::Logarithmic);
        let mut interval = interval(value, form, deviation);
        let mut relative = match form {
            VariableForm::Linear(unit) => unit * deviation / value,
            VariableForm::Logarithmic => deviation,
        };
        let is_parabola = relative <= NOT_A_PARABOLA;
        let profile = profile.as_ref().filter(|_| !is_parabola && index - 1 < DAMPING);
        if let Some(profile) = profile {
            let [low, high] = profiled(profile, problem, index - 1, deviation);
            interval = [low.min(value), high.max(value)];
            relative = match form {
                VariableForm::Linear(_) => (interval[1] - interval[0]) / (2.0 * NORMAL_95 * value),
                VariableForm::Logarithmic => portable::ln(interval[1] / interval[0]) / (2.0 * NORMAL_95),
            };
        }
        let untold = match relative {
            relative if relative <= UNTOLD => None,
            relative if index == DAMPING + 1 && relative.is_finite() => {
                Some(UntoldFriction::ShakenTooLittle { factor: relative / UNTOLD })
            }
            _ => Some(UntoldFriction::Hidden),
        };
        FrictionEstimate { value, interval, untold }
    });
    let fall = [lugre.curve.static_friction - lugre.curve.coulomb, force * alone(1)];
    let zero = problem.finds_zero.then(|| {
        let half = NORMAL_95 * force * alone(ZERO);
        FrictionEstimate { value: zero, interval: [zero - half, zero + half], untold: None }
    });
    (reasons((problem, &lugre), found, fall), zero)
}

/// The minimum without what was not searched for.
fn searched_only(problem: &FrictionProblem<'_>, minimum: &Minimum) -> Linearised {
    let mut at = minimum.linearised.clone();
    let known = [(DAMPING, problem.shakes.is_empty()), (ZERO, !problem.finds_zero)];
    for row in at.jacobian.chunks_exact_mut(problem.count()) {
        for (index, _) in known.iter().filter(|(_, is_known)| *is_known) {
            row.iter_mut().skip(*index).take(1).for_each(|slope| *slope = 0.0);
        }
    }
    at
}

/// Standard deviation of the first variable less the second.
fn difference(told: &Uncertainty) -> f64 {
    let [first, second] = [0, 1].map(|index| told.deviations.get(index).copied().unwrap_or(f64::INFINITY));
    let correlation = told.correlations.get(1).copied().unwrap_or(0.0);
    match first.is_finite() && second.is_finite() {
        true => (first * first + second * second - 2.0 * correlation * first * second).max(0.0).sqrt(),
        false => f64::INFINITY,
    }
}

fn interval(value: f64, form: VariableForm, deviation: f64) -> [f64; 2] {
    let half = NORMAL_95 * deviation;
    match form {
        _ if !half.is_finite() => [0.0, f64::INFINITY],
        VariableForm::Linear(unit) => [(value - half * unit).max(0.0), value + half * unit],
        VariableForm::Logarithmic => [-half, half].map(|by| value * portable::exp(by)),
    }
}

/// The interval of a coefficient by the profile; 0 and infinity where nothing limits it.
fn profiled(
    profile: &SlidingProfile<'_>,
    problem: &FrictionProblem<'_>,
    coefficient: usize,
    deviation: f64,
) -> [f64; 2] {
    let held = match coefficient {
        0 => HeldCoefficient::Coulomb,
        1 => HeldCoefficient::Variable(0),
        other => HeldCoefficient::Variable(other),
    };
    let [shortest, longest] = FIRST_STEPS;
    let step = if deviation.is_finite() { deviation.clamp(shortest, longest) } else { longest };
    let lugre = problem.around.lugre;
    let value = |variable: f64| match coefficient {
        0 | 1 => variable * problem.around.force,
        2 => lugre.curve.stribeck_velocity * portable::exp(variable),
        EXPONENT => lugre.curve.stribeck_exponent * portable::exp(variable),
        4 => variable * problem.around.damping[0],
        _ => lugre.bristle_stiffness * portable::exp(variable),
    };
    // no exponent is beyond its bounds; all else is from nothing to anything
    let limits = match coefficient {
        EXPONENT => profile.bound(held).map(value),
        _ => [0.0, f64::INFINITY],
    };
    let [low, high] = profile.ends(held, step);
    [low.map_or(limits[0], value), high.map_or(limits[1], value)]
}

/// Index of the exponent of the curve among the coefficients.
const EXPONENT: usize = 3;

/// Why each is open, as far as it is known.
fn reasons(
    (problem, lugre): (&FrictionProblem<'_>, &LuGre),
    mut found: [FrictionEstimate; FRICTION_COEFFICIENTS],
    [fall, fall_deviation]: [f64; 2],
) -> [FrictionEstimate; FRICTION_COEFFICIENTS] {
    let [coulomb, static_friction, velocity, exponent, viscous, stiffness, damping] = &mut found;
    let falls = fall > 2.0 * fall_deviation || static_friction.interval[0] > coulomb.interval[1];
    if problem.slides.is_empty() {
        for one in [&mut *coulomb, velocity, exponent, viscous] {
            one.untold = Some(UntoldFriction::NothingSlides);
        }
    } else if !falls {
        for one in [velocity, exponent] {
            one.untold = Some(UntoldFriction::NoFall);
        }
    } else {
        let fastest = problem.slides.iter().map(|slide| slide.velocity.abs()).fold(0.0, f64::max);
        let below = (2.0 * velocity.interval[1]).min(fastest);
        for one in [velocity, exponent].into_iter().filter(|one| one.untold.is_some()) {
            one.untold = Some(UntoldFriction::FewOnFall { below });
        }
    }
    if !problem.slides.is_empty() && problem.presses.is_empty() && static_friction.untold.is_some() {
        static_friction.untold = Some(UntoldFriction::NotApproached);
        // it is no less than what the slowest run shows, up to noise
        let slowest = problem.slides.iter().map(|slide| slide.velocity.abs()).fold(f64::INFINITY, f64::min);
        let shown = UP_TO_NOISE * lugre.curve.sliding_force(slowest);
        static_friction.interval[0] = static_friction.interval[0].min(shown);
    }
    if problem.presses.is_empty() {
        if stiffness.untold.is_some() && problem.shakes.is_empty() {
            stiffness.untold = Some(UntoldFriction::NothingPressed);
        }
        if problem.slides.is_empty() {
            static_friction.untold = Some(UntoldFriction::NothingPressed);
        }
    }
    let explained = problem.channels.get(problem.sliding_channels()..).unwrap_or_default();
    let residual = explained.iter().map(|channel| channel.scale / channel.noise).fold(0.0, f64::max);
    if residual > EXPLAINED {
        for one in [&mut *stiffness, damping] {
            one.untold = one.untold.or(Some(UntoldFriction::NotExplained { residual }));
        }
    }
    let ringing = (stiffness.value / problem.mass).sqrt();
    if problem.shakes.is_empty() {
        let ringing = stiffness.untold.is_none().then_some(ringing);
        let breaking = static_friction.untold.is_none().then_some(static_friction.value);
        let untold = Some(UntoldFriction::NothingShaken { ringing, breaking });
        *damping = FrictionEstimate { interval: [0.0, f64::INFINITY], untold, ..*damping };
    }
    let longest = 2.0 * PI / (ROWS_OF_RINGING * ringing);
    if shaken_time_step(problem).is_some_and(|time_step| time_step > longest) {
        damping.untold = Some(UntoldFriction::TooFewRows { time_step: longest });
    }
    if presses_quickly(problem, stiffness, damping) {
        // what to record says more than that noise hides it
        for one in [stiffness, damping] {
            one.untold = match one.untold {
                None | Some(UntoldFriction::Hidden) => Some(UntoldFriction::QuickForce),
                other => other,
            };
        }
    }
    found
}

/// s between the rows of what is shaken, the longest.
fn shaken_time_step(problem: &FrictionProblem<'_>) -> Option<f64> {
    let recordings = problem.shakes.iter().filter_map(|shake| problem.recordings.get(shake.recording));
    recordings.map(|one| one.time_step).reduce(f64::max)
}

/// Whether a force that presses is not known between its rows, or is too quick for a damping that
/// is taken for granted, which delays the mass.
fn presses_quickly(
    problem: &FrictionProblem<'_>,
    stiffness: &FrictionEstimate,
    damping: &FrictionEstimate,
) -> bool {
    let delay = if damping.untold.is_none() { 0.0 } else { damping.value / stiffness.value };
    problem.presses.iter().any(|press| {
        let time_step = problem.recordings.get(press.recording).map_or(0.0, |one| one.time_step);
        press.has_quick_force || press.rows as f64 * time_step < SLOW * delay
    })
}
