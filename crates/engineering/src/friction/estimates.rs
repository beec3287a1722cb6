//! Estimates and intervals of the coefficients.

use phea_dynamics::least_squares::{Linearised, Minimum, Uncertainty, uncertainty_by_scale};
use phea_dynamics::portable;
use phea_hydraulics::friction::FRICTION_COEFFICIENTS;

use super::BOTH_WAYS;
use super::directions::DirectionModel;
use super::problem::{
    Around, DAMPING, EXTENDING, FrictionProblem, LevelVariables, MeasuredFriction, RETRACTING, ZERO,
};
use super::profile::{HeldCoefficient, SlidingProfile};
use super::reasons::{Fall, NotIdentifiableFriction, reasons};
use crate::estimate::{Estimate, NORMAL_95};

/// A coefficient that the recordings do not determine, with the available information.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenCoefficient {
    /// Minimum of the sum of squares, and the interval that the recordings leave.
    pub estimate: Estimate,
    /// Reasons, each once.
    pub reasons: Vec<NotIdentifiableFriction>,
}

impl OpenCoefficient {
    /// True while there is no reason against the estimate.
    pub(super) fn is_determined(&self) -> bool {
        self.reasons.is_empty()
    }

    /// The estimate, if there is no reason against it.
    fn judged(self) -> Result<Estimate, OpenCoefficient> {
        if self.is_determined() { Ok(self.estimate) } else { Err(self) }
    }
}

/// All coefficients.
pub(super) struct Estimates {
    pub(super) estimates: [Result<Estimate, OpenCoefficient>; BOTH_WAYS],
    pub(super) retracting: Option<[Result<Estimate, OpenCoefficient>; FRICTION_COEFFICIENTS - BOTH_WAYS]>,
    pub(super) zero: Option<Estimate>,
}

/// Relative standard deviation beyond which a coefficient is not determined, as for a valve.
const NOT_IDENTIFIABLE: f64 = 0.5;

/// Relative standard deviation beyond which an interval is taken from the profile of the sum.
const NOT_A_PARABOLA: f64 = 0.1;

/// First step along a profile, in the variables: logarithms, or fractions of a typical value.
const FIRST_STEPS: [f64; 2] = [0.02, 0.3];

/// Index of the exponent of the curve among the variables.
const EXPONENT: usize = 3;

/// Relation of a coefficient to the variables.
#[derive(Clone, Copy)]
struct CoefficientForm {
    held: HeldCoefficient,
    scale: VariableScale,
}

#[derive(Clone, Copy)]
enum VariableScale {
    /// Proportional to its variable, which is in this unit.
    Linear(f64),
    /// Exponential of its variable, multiplied by this factor.
    Logarithmic(f64),
}

/// Forms in the order of the coefficients.
fn forms(around: &Around) -> [CoefficientForm; FRICTION_COEFFICIENTS] {
    let Around { lugre, force, damping, .. } = *around;
    let variable = |index: usize, scale| CoefficientForm { held: HeldCoefficient::Variable(index), scale };
    let coulomb = |of: LevelVariables| CoefficientForm {
        held: HeldCoefficient::Coulomb(of),
        scale: VariableScale::Linear(force),
    };
    let levels = |of: LevelVariables| {
        [
            coulomb(of),
            variable(of.static_friction, VariableScale::Linear(force)),
            variable(of.viscous, VariableScale::Linear(damping[0])),
        ]
    };
    let [[coulomb, breaking, viscous], [back_coulomb, back_breaking, back_viscous]] =
        [EXTENDING, RETRACTING].map(levels);
    [
        coulomb,
        breaking,
        variable(2, VariableScale::Logarithmic(lugre.curve.stribeck_velocity)),
        variable(EXPONENT, VariableScale::Logarithmic(lugre.curve.stribeck_exponent)),
        viscous,
        variable(5, VariableScale::Logarithmic(lugre.bristle_stiffness)),
        variable(DAMPING, VariableScale::Linear(damping[1])),
        back_coulomb,
        back_breaking,
        back_viscous,
    ]
}

/// Estimates of each coefficient, and of the zero error of the force.
pub(super) fn estimates(problem: &FrictionProblem<'_>, minimum: &Minimum) -> Estimates {
    let MeasuredFriction { lugre, zero } = problem.friction(&minimum.variables);
    let uncertainty = uncertainty_by_scale(&searched_only(problem, minimum), problem.count());
    let force = problem.around.force;
    let profile = SlidingProfile::around(problem, minimum);
    let values = lugre.to_array();
    let forms = forms(&problem.around);
    let differs = problem.directions == DirectionModel::DiffersByDirection;
    let of = |index: usize| match differs || index < BOTH_WAYS {
        true => estimate(values[index], forms[index], &uncertainty, profile.as_ref()),
        // equal to that of extending, which comes first
        false => {
            let estimate = Estimate { value: values[index], interval: [0.0, f64::INFINITY] };
            OpenCoefficient { estimate, reasons: vec![] }
        }
    };
    let mut all: [OpenCoefficient; FRICTION_COEFFICIENTS] = std::array::from_fn(of);
    let falls = [EXTENDING, RETRACTING].map(|levels| {
        let at = |index: usize| minimum.variables.get(index).copied().unwrap_or(0.0);
        Fall { value: force * at(levels.fall), deviation: force * deviation_of(&uncertainty, levels.fall) }
    });
    reasons(problem, &lugre, &mut all, falls);
    let [a, b, c, d, e, f, g, back @ ..] = all.map(OpenCoefficient::judged);
    let zero = problem.finds_zero().then(|| Estimate::of(zero, force * deviation_of(&uncertainty, ZERO)));
    Estimates { estimates: [a, b, c, d, e, f, g], retracting: differs.then_some(back), zero }
}

fn deviation_of(uncertainty: &Uncertainty, variable: usize) -> f64 {
    uncertainty.deviations.get(variable).copied().unwrap_or(f64::INFINITY)
}

/// Estimate of one coefficient: by its standard deviation, and by the profile if that is large.
fn estimate(
    value: f64,
    form: CoefficientForm,
    uncertainty: &Uncertainty,
    profile: Option<&SlidingProfile<'_>>,
) -> OpenCoefficient {
    let deviation = match form.held {
        // F_C is F_S minus the fall
        HeldCoefficient::Coulomb(of) => difference(uncertainty, of.static_friction, of.fall),
        HeldCoefficient::Variable(index) => deviation_of(uncertainty, index),
    };
    let mut interval = interval(value, form.scale, deviation);
    let mut relative = match form.scale {
        VariableScale::Linear(unit) => unit * deviation / value,
        VariableScale::Logarithmic(_) => deviation,
    };
    let is_damping = form.held == HeldCoefficient::Variable(DAMPING);
    if let Some(profile) = profile.filter(|_| relative > NOT_A_PARABOLA && !is_damping) {
        let [low, high] = profiled(profile, form, deviation);
        interval = [low.min(value), high.max(value)];
        relative = match form.scale {
            VariableScale::Linear(_) => (interval[1] - interval[0]) / (2.0 * NORMAL_95 * value),
            VariableScale::Logarithmic(_) => portable::ln(interval[1] / interval[0]) / (2.0 * NORMAL_95),
        };
    }
    let reasons = match relative {
        relative if relative <= NOT_IDENTIFIABLE => vec![],
        relative if is_damping && relative.is_finite() => {
            vec![NotIdentifiableFriction::ShakenTooLittle { factor: relative / NOT_IDENTIFIABLE }]
        }
        _ => vec![NotIdentifiableFriction::Hidden],
    };
    OpenCoefficient { estimate: Estimate { value, interval }, reasons }
}

/// The minimum without the variables that were not searched.
fn searched_only(problem: &FrictionProblem<'_>, minimum: &Minimum) -> Linearised {
    let mut at = minimum.linearised.clone();
    let known = problem.known_variables();
    for row in at.jacobian.chunks_exact_mut(problem.count()) {
        for index in &known {
            row.iter_mut().skip(*index).take(1).for_each(|slope| *slope = 0.0);
        }
    }
    at
}

/// Standard deviation of the difference of two variables.
fn difference(uncertainty: &Uncertainty, first: usize, second: usize) -> f64 {
    let place = first * uncertainty.deviations.len() + second;
    let [first, second] = [first, second].map(|index| deviation_of(uncertainty, index));
    let correlation = uncertainty.correlations.get(place).copied().unwrap_or(0.0);
    match first.is_finite() && second.is_finite() {
        true => (first * first + second * second - 2.0 * correlation * first * second).max(0.0).sqrt(),
        false => f64::INFINITY,
    }
}

fn interval(value: f64, scale: VariableScale, deviation: f64) -> [f64; 2] {
    let half = NORMAL_95 * deviation;
    match scale {
        _ if !half.is_finite() => [0.0, f64::INFINITY],
        VariableScale::Linear(unit) => [(value - half * unit).max(0.0), value + half * unit],
        VariableScale::Logarithmic(_) => [-half, half].map(|by| value * portable::exp(by)),
    }
}

/// Interval of a coefficient by the profile; 0 and infinity if nothing limits it.
fn profiled(profile: &SlidingProfile<'_>, form: CoefficientForm, deviation: f64) -> [f64; 2] {
    let [shortest, longest] = FIRST_STEPS;
    let step = if deviation.is_finite() { deviation.clamp(shortest, longest) } else { longest };
    let value = |variable: f64| match form.scale {
        VariableScale::Linear(unit) => variable * unit,
        VariableScale::Logarithmic(around) => around * portable::exp(variable),
    };
    // no exponent is beyond its bounds; everything else ranges from zero to infinity
    let limits = match form.held {
        HeldCoefficient::Variable(EXPONENT) => profile.bound(form.held).map(value),
        _ => [0.0, f64::INFINITY],
    };
    let [low, high] = profile.ends(form.held, step);
    [low.map_or(limits[0], value), high.map_or(limits[1], value)]
}
