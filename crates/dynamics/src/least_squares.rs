//! Nonlinear least squares with bounds and a robust loss.
//!
//! ```text
//! minimise  sum rho(r_i(x))    with  lower <= x <= upper,     rho(r) = r^2/2 for |r| <= k,  k|r| - k^2/2 beyond
//! ```
//!
//! A damped Gauss-Newton method (Levenberg 1944, Marquardt 1963) on the normal equations, with psi
//! = rho' (Huber 1964) for the residuals and psi' for their curvature. A variable at a bound that
//! the step would leave is held for that step. After many evaluations, as in a curved valley, each
//! step bends with the second derivative of the residuals along it (Transtrum and Sethna 2012). The
//! caller scales the variables to order one and the residuals to their noise.

mod uncertainty;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

pub use uncertainty::{Direction, Uncertainty, uncertainty, uncertainty_by_scale, uncertainty_with_shared};

use crate::portable;
use crate::watch::Stopped;

/// Residuals, and their derivatives row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// Residuals r_i.
    pub residuals: Vec<f64>,
    /// Derivatives dr_i/dx_j, one row for each residual.
    pub jacobian: Vec<f64>,
}

/// Bounds, loss and limits of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Constant k of the loss; infinite for plain squares.
    pub robust_beyond: f64,
    /// Number of evaluations after which the search ends.
    pub maximum_evaluations: usize,
    /// Relative decrease of the sum below which the search has converged.
    pub tolerance: f64,
    /// Damping of the first step: small if the start is near the minimum, so that a long valley
    /// does not take many steps.
    pub first_damping: f64,
}

impl Default for Settings {
    /// 1.345 has 95 % of the efficiency of plain squares for normal noise (Huber 1981).
    fn default() -> Settings {
        Settings {
            robust_beyond: 1.345,
            maximum_evaluations: 100,
            tolerance: 1e-10,
            first_damping: FULL_STEP,
        }
    }
}

/// Damping below which a step is as good as a Gauss-Newton step.
const FULL_STEP: f64 = 1e-3;

/// Number of evaluations after which steps bend: if few evaluations suffice, none is spent on
/// bending.
const STRAIGHT: usize = 40;

/// Fraction of a step at which the second derivative along it is taken.
const PROBE: f64 = 0.1;

/// Largest bend over a step: beyond it, the series is not a guide, since only its first two terms
/// are known.
const MOST_BEND: f64 = 0.375;

/// Reason for the end of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// No step decreases the sum further.
    Converged,
    /// The sum was still decreasing.
    OutOfEvaluations,
    /// The start cannot be evaluated.
    NoStart,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Variables x.
    pub variables: Vec<f64>,
    /// Sum of the losses.
    pub cost: f64,
    /// Residuals at the minimum, with derivatives.
    pub linearised: Linearised,
    /// Number of evaluations.
    pub evaluations: usize,
    /// Reason for the end of the search.
    pub ending: Ending,
}

/// Residuals at a point; `None` if the model does not exist there.
pub type Evaluate<'a> = &'a mut dyn FnMut(&[f64]) -> Result<Option<Linearised>, Stopped>;

/// Loss rho of a residual.
///
/// # Example
/// ```
/// use phea_dynamics::least_squares::loss;
/// assert_eq!([loss(1.0, 2.0), loss(-2.0, 2.0), loss(4.0, 2.0)], [0.5, 2.0, 6.0]);
/// ```
pub fn loss(residual: f64, beyond: f64) -> f64 {
    let magnitude = residual.abs();
    if magnitude <= beyond { residual * residual / 2.0 } else { beyond * (magnitude - beyond / 2.0) }
}

/// Number of rounds in which the likeliest scale is found.
const SCALE_ROUNDS: usize = 30;

/// Contribution of residuals to the negative logarithm of a likelihood, at their likeliest scale s,
/// which is at least `least`. A constant is omitted.
///
/// ```text
/// n ln s + sum rho(r/s)        s^2 = sum psi(r/s) r s/n
/// ```
///
/// # Example
/// The scale of plain squares is the root mean square, and half of each residual's loss remains.
/// ```
/// use phea_dynamics::least_squares::negative_log_likelihood;
/// let found = negative_log_likelihood(&[3.0, -3.0, 3.0], 0.0, f64::INFINITY);
/// assert!((found - 3.0 * (3.0_f64.ln() + 0.5)).abs() < 1e-12);
/// ```
pub fn negative_log_likelihood(residuals: &[f64], least: f64, beyond: f64) -> f64 {
    let count = residuals.len().max(1) as f64;
    let mut scale = 1.0_f64.max(least);
    for _ in 0..SCALE_ROUNDS {
        let weighted = |residual: &f64| {
            let relative = (residual / scale).abs();
            relative.min(beyond) * relative
        };
        let square = residuals.iter().map(weighted).sum::<f64>() / count;
        scale = (scale * square.sqrt()).max(least);
    }
    count * portable::ln(scale) + residuals.iter().map(|residual| loss(residual / scale, beyond)).sum::<f64>()
}

/// Derivative of the loss over the residual, psi(r)/r.
fn weight(residual: f64, beyond: f64) -> f64 {
    let magnitude = residual.abs();
    if magnitude <= beyond { 1.0 } else { beyond / magnitude }
}

/// Searches from a start, which is moved into the bounds `[lower, upper]` of each variable.
///
/// # Errors
/// [`Stopped`] if `evaluate` stops the search.
///
/// # Example
/// A line through points with one outlier:
/// ```
/// use phea_dynamics::least_squares::{Linearised, Settings, minimise};
/// let points = [(0.0, 1.0), (1.0, 3.0), (2.0, 5.0), (3.0, 700.0), (4.0, 9.0)];
/// let mut line = |x: &[f64]| {
///     let residuals = points.iter().map(|(at, value)| (x[0] + x[1] * at - value) / 1e-3).collect();
///     let jacobian = points.iter().flat_map(|(at, _)| [1.0 / 1e-3, at / 1e-3]).collect();
///     Ok(Some(Linearised { residuals, jacobian }))
/// };
/// let found = minimise(&[0.0, 0.0], &[[-10.0, 10.0]; 2], Settings::default(), &mut line).unwrap();
/// assert!((found.variables[0] - 1.0).abs() < 2e-3 && (found.variables[1] - 2.0).abs() < 2e-3);
/// ```
pub fn minimise(
    start: &[f64],
    bounds: &[[f64; 2]],
    settings: Settings,
    evaluate: Evaluate<'_>,
) -> Result<Minimum, Stopped> {
    let within = |x: f64, [lower, upper]: [f64; 2]| x.max(lower).min(upper);
    let sum = |found: &Linearised| -> f64 {
        found.residuals.iter().map(|residual| loss(*residual, settings.robust_beyond)).sum()
    };
    let variables: Vec<f64> = start.iter().zip(bounds).map(|(x, bounds)| within(*x, *bounds)).collect();
    let mut evaluations = 1;
    let Some(linearised) = evaluate(&variables)?.filter(|found| sum(found).is_finite()) else {
        let linearised = Linearised { residuals: vec![], jacobian: vec![] };
        let cost = f64::INFINITY;
        return Ok(Minimum { variables, cost, linearised, evaluations, ending: Ending::NoStart });
    };
    let cost = sum(&linearised);
    let mut best = Minimum { variables, cost, linearised, evaluations, ending: Ending::OutOfEvaluations };
    let mut damping = settings.first_damping;
    let mut curvature = CurvatureWeight::OfLoss;
    // consecutive steps with a negligible change
    let mut idle = 0;
    while evaluations < settings.maximum_evaluations && idle < 3 {
        let Some(mut step) = step(&best, bounds, damping, (curvature, settings.robust_beyond)) else {
            idle = 3;
            continue;
        };
        if evaluations > STRAIGHT {
            evaluations += 1;
            step.bend(&best, bounds, evaluate)?;
        }
        let moved = best.variables.iter().zip(step.along.iter()).zip(bounds);
        let tried: Vec<f64> = moved.map(|((x, step), bounds)| within(x + step, *bounds)).collect();
        evaluations += 1;
        let found = evaluate(&tried)?;
        let better = found.map(|found| (sum(&found), found)).filter(|(cost, _)| *cost < best.cost);
        let Some((cost, linearised)) = better else {
            (curvature, damping) = match curvature {
                CurvatureWeight::OfLoss => (CurvatureWeight::Weighted, damping),
                CurvatureWeight::Weighted => (CurvatureWeight::OfLoss, 8.0 * damping),
            };
            idle = if damping > 1e12 { 3 } else { idle };
            continue;
        };
        let changed = best.cost - cost > settings.tolerance * best.cost;
        // after a nearly undamped step with a negligible change, there will be no further step
        let is_full = damping <= FULL_STEP;
        idle = if changed { 0 } else { idle + if is_full { 3 } else { 1 } };
        best = Minimum { variables: tried, cost, linearised, ..best };
        (curvature, damping) = (CurvatureWeight::OfLoss, (damping / 5.0).max(1e-12));
    }
    let ending = if idle < 3 { Ending::OutOfEvaluations } else { Ending::Converged };
    Ok(Minimum { evaluations, ending, ..best })
}

/// Weight of a residual in the curvature of the sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CurvatureWeight {
    /// Weight psi': Newton's method for linear residuals, good near the minimum.
    OfLoss,
    /// Weight psi/r: shorter steps, good if most residuals are beyond the bend of the loss.
    Weighted,
}

impl CurvatureWeight {
    fn of(self, residual: f64, beyond: f64) -> f64 {
        let weight = weight(residual, beyond);
        match self {
            CurvatureWeight::Weighted => weight,
            CurvatureWeight::OfLoss if weight < 1.0 => 0.0,
            CurvatureWeight::OfLoss => 1.0,
        }
    }
}

/// Damped step, and the equations that it solves.
struct DampedStep {
    along: DVector<f64>,
    normal: Cholesky<f64, Dyn>,
    /// Weights of the residuals in the equations, and the variables that are held.
    weights: Vec<f64>,
    held: Vec<bool>,
}

impl DampedStep {
    /// Adds half of the acceleration along the step, from the residuals after a part p of it; adds
    /// nothing if that is not a small fraction of the step, or is beyond the bounds.
    ///
    /// ```text
    /// step + a/2        (normal) a = -sum h j r'',    r'' = 2/p ((r(x + p step) - r)/p - j step)
    /// ```
    fn bend(&mut self, at: &Minimum, bounds: &[[f64; 2]], evaluate: Evaluate<'_>) -> Result<(), Stopped> {
        let moved = at.variables.iter().zip(self.along.iter());
        let probed: Vec<f64> = moved.map(|(x, step)| x + PROBE * step).collect();
        let mut all = probed.iter().zip(bounds);
        if !all.all(|(x, [lower, upper])| (lower..=upper).contains(&x)) {
            return Ok(());
        }
        if let Some(found) = evaluate(&probed)? {
            let half = self.acceleration(&at.linearised, &found.residuals) * 0.5;
            if half.norm() <= MOST_BEND * self.along.norm() {
                self.along += half;
            }
        }
        Ok(())
    }

    fn acceleration(&self, at: &Linearised, probed: &[f64]) -> DVector<f64> {
        let count = self.along.len();
        let mut slope = DVector::zeros(count);
        let rows = at.residuals.iter().zip(at.jacobian.chunks_exact(count));
        for (((residual, row), probed), weight) in rows.zip(probed).zip(&self.weights) {
            let linear: f64 = row.iter().zip(self.along.iter()).map(|(first, step)| first * step).sum();
            let second = 2.0 / PROBE * ((probed - residual) / PROBE - linear);
            for (sum, first) in slope.iter_mut().zip(row) {
                *sum -= weight * first * second;
            }
        }
        for (sum, held) in slope.iter_mut().zip(&self.held) {
            *sum = if *held { 0.0 } else { *sum };
        }
        self.normal.solve(&slope)
    }
}

/// Damped step; `None` if every variable is held by its bound.
///
/// ```text
/// (sum h j j' + damping diag(sum psi/r j j')) step = -sum psi j        h = psi' or psi/r
/// ```
fn step(
    at: &Minimum,
    bounds: &[[f64; 2]],
    damping: f64,
    (curvature, beyond): (CurvatureWeight, f64),
) -> Option<DampedStep> {
    let count = at.variables.len();
    let StepEquations { mut normal, mut weighted, mut slope } =
        equations(&at.linearised, count, curvature, beyond);
    let mut held = vec![false; count];
    for (index, (x, [lower, upper])) in at.variables.iter().zip(bounds).enumerate() {
        let descent = -slope.get(index).copied().unwrap_or(0.0);
        if (x <= lower && descent < 0.0) || (x >= upper && descent > 0.0) {
            normal.row_mut(index).fill(0.0);
            normal.column_mut(index).fill(0.0);
            weighted[index] = 0.0;
            slope[index] = 0.0;
            held.get_mut(index).into_iter().for_each(|held| *held = true);
        }
    }
    let largest = weighted.max();
    if largest <= 0.0 || slope.amax() == 0.0 {
        return None;
    }
    for index in 0..count {
        // a variable without influence does not move
        normal[(index, index)] += damping * weighted[index] + 1e-14 * largest;
    }
    let normal = normal.cholesky()?;
    let along = normal.solve(&-slope);
    let weights = at.linearised.residuals.iter().map(|residual| curvature.of(*residual, beyond));
    Some(DampedStep { along, normal, weights: weights.collect(), held })
}

/// Terms of the equations of a step.
struct StepEquations {
    /// Sum of h j j'.
    normal: DMatrix<f64>,
    /// Diagonal of the sum of psi/r j j'.
    weighted: DVector<f64>,
    /// Sum of psi j.
    slope: DVector<f64>,
}

fn equations(at: &Linearised, count: usize, curvature: CurvatureWeight, beyond: f64) -> StepEquations {
    let mut normal = DMatrix::zeros(count, count);
    let mut weighted = DVector::zeros(count);
    let mut slope = DVector::zeros(count);
    for (residual, row) in at.residuals.iter().zip(at.jacobian.chunks_exact(count)) {
        let weight = weight(*residual, beyond);
        // most residuals of a large problem depend on few of its variables
        for (i, first) in row.iter().enumerate().filter(|(_, first)| **first != 0.0) {
            slope[i] += weight * first * residual;
            weighted[i] += weight * first * first;
        }
        let counts = curvature.of(*residual, beyond);
        if counts == 0.0 {
            continue;
        }
        for (i, first) in row.iter().enumerate().filter(|(_, first)| **first != 0.0) {
            let column = normal.as_mut_slice().get_mut(i * count..=i * count + i).unwrap_or_default();
            for (sum, second) in column.iter_mut().zip(row) {
                *sum += counts * first * second;
            }
        }
    }
    normal.fill_lower_triangle_with_upper_triangle();
    StepEquations { normal, weighted, slope }
}
