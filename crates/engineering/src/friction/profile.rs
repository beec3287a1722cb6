//! Intervals of coefficients that the recordings determine badly: their sum of squares is not
//! parabolic, and standard deviations mean little.
//!
//! ```text
//! S(theta) = min over all other variables of sum rho(r)        S(end) - S(least) = 1.96^2/2
//! ```
//!
//! the profile of the likelihood (Venzon and Moolgavkar 1988). Pressed and shaken rows count by
//! their information about the coefficients, as a normal distribution, except about the shape of
//! the curve; sliding rows count in full, because the steady curve causes the deviation from a
//! parabola.

use nalgebra::{DMatrix, DVector};
use phea_dynamics::least_squares::{Ending, Linearised, Minimum, Settings, minimise};

use super::problem::{FrictionProblem, LevelVariables, SHARED};
use crate::estimate::NORMAL_95;

/// Increase of the sum at the ends of a 95 % interval, divided by the efficiency of the loss.
const AT_THE_END: f64 = NORMAL_95 * NORMAL_95 / 2.0 / 0.95;

/// Number of evaluations of a search with one coefficient fixed.
const EVALUATIONS: usize = 30;

/// Relative decrease of the sum at which such a search ends.
const TOLERANCE: f64 = 1e-4;

/// Number of steps outwards, each longer than the one before by a factor, and number of bisections
/// after them.
const STEPS: usize = 14;
const LONGER: f64 = 2.5;
const HALVINGS: usize = 9;

/// Index of the logarithm of the Stribeck velocity; that of the exponent follows.
const STRIBECK_VELOCITY: usize = 2;

/// Changes of both in further starts.
const OTHER_CURVES: [(f64, f64); 5] = [(-1.0, 0.0), (1.0, 0.0), (1.0, 0.7), (0.0, 0.7), (0.0, -0.7)];

/// Residual of the robust loss beyond which all are outliers.
const ROBUST_BEYOND: f64 = 1.345;

/// Ratio of an eigenvalue of the information to the largest below which nothing is known.
const UNKNOWN: f64 = 1e-12;

/// A fixed coefficient: one of the variables, or F_C of a direction, which is F_S minus the fall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HeldCoefficient {
    Coulomb(LevelVariables),
    Variable(usize),
}

/// Sliding runs, and the information of everything else about the shared variables.
pub(super) struct SlidingProfile<'a> {
    problem: &'a FrictionProblem<'a>,
    /// Shared variables of the minimum.
    centre: Vec<f64>,
    /// Slopes of residuals with respect to the shared variables, and the residuals at the centre.
    others: Vec<(Vec<f64>, f64)>,
    least: Minimum,
}

impl<'a> SlidingProfile<'a> {
    /// Profile around a minimum for all recordings; `None` if nothing slides.
    pub(super) fn around(problem: &'a FrictionProblem<'a>, minimum: &Minimum) -> Option<SlidingProfile<'a>> {
        let centre: Vec<f64> = minimum.variables.iter().take(SHARED).copied().collect();
        let others = information_of_others(problem, &minimum.linearised);
        let variables = minimum.variables.iter().take(SHARED + problem.slides.len()).copied().collect();
        let linearised = Linearised { residuals: vec![], jacobian: vec![] };
        let ending = Ending::NoStart;
        let least = Minimum { variables, cost: f64::INFINITY, linearised, evaluations: 0, ending };
        let mut found = SlidingProfile { problem, centre, others, least };
        found.least = found.searched(&found.least.variables, &found.bounds(), None)?;
        (!problem.slides.is_empty()).then_some(found)
    }

    fn bounds(&self) -> Vec<[f64; 2]> {
        self.problem.bounds().into_iter().take(SHARED + self.problem.slides.len()).collect()
    }

    /// Value of the fixed coefficient for these variables.
    pub(super) fn value(held: HeldCoefficient, variables: &[f64]) -> f64 {
        let at = |index: usize| variables.get(index).copied().unwrap_or(0.0);
        match held {
            HeldCoefficient::Coulomb(of) => at(of.static_friction) - at(of.fall),
            HeldCoefficient::Variable(index) => at(index),
        }
    }

    /// Ends of the 95 % interval of the fixed coefficient, as the variables have it; `None` if its
    /// bound is as good.
    pub(super) fn ends(&self, held: HeldCoefficient, step: f64) -> [Option<f64>; 2] {
        [-1.0, 1.0].map(|way| self.end(held, way * step))
    }

    /// Bounds of the fixed coefficient.
    pub(super) fn bound(&self, held: HeldCoefficient) -> [f64; 2] {
        let bounds = self.problem.bounds();
        let of = |index: usize| bounds.get(index).copied().unwrap_or([0.0, 0.0]);
        match held {
            HeldCoefficient::Coulomb(levels) => of(levels.static_friction),
            HeldCoefficient::Variable(index) => of(index),
        }
    }

    fn end(&self, held: HeldCoefficient, step: f64) -> Option<f64> {
        let [lower, upper] = self.bound(held);
        let bound = if step < 0.0 { lower } else { upper };
        let is_inside = |found: &Minimum| self.is_inside(found);
        let mut inside = Self::value(held, &self.least.variables);
        let mut variables = self.least.variables.clone();
        let mut step = step;
        let mut outside = None;
        for _ in 0..STEPS {
            let next = (inside + step).clamp(lower, upper);
            let Some(found) = self.held(held, next, &variables).filter(is_inside) else {
                outside = Some(next);
                break;
            };
            (inside, variables) = (next, found.variables);
            if next == bound {
                return None;
            }
            step *= LONGER;
        }
        let mut outside = outside?;
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(inside, outside);
            match self.held(held, middle, &variables).filter(is_inside) {
                Some(found) => (inside, variables) = (middle, found.variables),
                None => outside = middle,
            }
        }
        Some(outside)
    }

    /// Least sum with a coefficient fixed: from a start and, if that is outside the interval, from
    /// others with curves that fall at other velocities and with other shapes.
    fn held(&self, held: HeldCoefficient, value: f64, start: &[f64]) -> Option<Minimum> {
        let mut best = self.held_from(held, value, start);
        for (velocity, exponent) in OTHER_CURVES {
            if best.as_ref().is_some_and(|best| self.is_inside(best)) {
                break;
            }
            let mut other = start.to_vec();
            let changes = [(STRIBECK_VELOCITY, velocity), (STRIBECK_VELOCITY + 1, exponent)];
            for (index, change) in changes {
                other.iter_mut().skip(index).take(1).for_each(|variable| *variable += change);
            }
            let found = self.held_from(held, value, &other);
            best = [best, found].into_iter().flatten().min_by(|one, other| one.cost.total_cmp(&other.cost));
        }
        best
    }

    /// True if a sum is within the interval.
    fn is_inside(&self, found: &Minimum) -> bool {
        found.cost - self.least.cost <= AT_THE_END
    }

    fn held_from(&self, held: HeldCoefficient, value: f64, start: &[f64]) -> Option<Minimum> {
        let mut bounds = self.bounds();
        let mut set = |index: usize, bound: [f64; 2]| {
            bounds.iter_mut().skip(index).take(1).for_each(|to| *to = bound);
        };
        match held {
            HeldCoefficient::Variable(index) => {
                set(index, [value; 2]);
                self.searched(start, &bounds, None)
            }
            HeldCoefficient::Coulomb(levels) => {
                // the fall represents F_C here, and F_S is at least that
                set(levels.fall, [value; 2]);
                set(levels.static_friction, [value, 1e3]);
                let mut found = self.searched(&exchanged(start, levels), &bounds, Some(levels))?;
                found.variables = exchanged(&found.variables, levels);
                Some(found)
            }
        }
    }

    /// End of a search over the variables, or over F_C in place of the fall of a direction.
    fn searched(
        &self,
        start: &[f64],
        bounds: &[[f64; 2]],
        coulomb_of: Option<LevelVariables>,
    ) -> Option<Minimum> {
        let settings =
            Settings { maximum_evaluations: EVALUATIONS, tolerance: TOLERANCE, ..Settings::default() };
        let count = start.len();
        let mut evaluate = |x: &[f64]| {
            let Some(levels) = coulomb_of else { return Ok(self.linearised(x)) };
            Ok(self.linearised(&exchanged(x, levels)).map(|mut found| {
                for row in found.jacobian.chunks_exact_mut(count) {
                    let by_fall = row.get(levels.fall).copied().unwrap_or(0.0);
                    row.iter_mut().skip(levels.static_friction).take(1).for_each(|slope| *slope += by_fall);
                    row.iter_mut().skip(levels.fall).take(1).for_each(|slope| *slope = -by_fall);
                }
                found
            }))
        };
        minimise(start, bounds, settings, &mut evaluate).ok().filter(|found| found.ending != Ending::NoStart)
    }

    fn linearised(&self, variables: &[f64]) -> Option<Linearised> {
        let mut found = self.problem.slides_linearised(variables)?;
        for (slopes, residual) in &self.others {
            let away = variables.iter().zip(&self.centre).map(|(at, centre)| at - centre);
            found.residuals.push(residual + away.zip(slopes).map(|(away, slope)| away * slope).sum::<f64>());
            let from = found.jacobian.len();
            found.jacobian.extend(slopes);
            found.jacobian.resize(from + variables.len(), 0.0);
        }
        Some(found)
    }
}

/// Exchange of F_C and the fall of a direction: each is F_S minus the other.
fn exchanged(variables: &[f64], of: LevelVariables) -> Vec<f64> {
    let mut exchanged = variables.to_vec();
    let static_friction = variables.get(of.static_friction).copied().unwrap_or(0.0);
    exchanged.iter_mut().skip(of.fall).take(1).for_each(|fall| *fall = static_friction - *fall);
    exchanged
}

/// Information of pressed and shaken rows about the shared variables: residuals that are as well
/// explained with all separate variables free.
///
/// ```text
/// I = J_s'J_s - J_s'J_o (J_o'J_o)^-1 J_o'J_s        g likewise        R'R = I,  R'b = g
/// ```
fn information_of_others(problem: &FrictionProblem<'_>, at: &Linearised) -> Vec<(Vec<f64>, f64)> {
    let count = problem.count();
    let first_own = SHARED + problem.slides.len();
    let own = count - first_own;
    let first_row = problem.first_row_of_others();
    let size = SHARED + own;
    let mut information = DMatrix::<f64>::zeros(size, size);
    let mut gradient = DVector::<f64>::zeros(size);
    let rows = at.jacobian.chunks_exact(count).zip(&at.residuals).skip(first_row);
    for (row, residual) in rows {
        let weight = (ROBUST_BEYOND / residual.abs()).min(1.0);
        let slopes = row.iter().take(SHARED).chain(row.iter().skip(first_own));
        let entries: Vec<(usize, f64)> =
            slopes.copied().enumerate().filter(|(_, slope)| *slope != 0.0).collect();
        for (i, first) in &entries {
            gradient[*i] += weight * first * residual;
            for (j, second) in &entries {
                information[(*i, *j)] += weight * first * second;
            }
        }
    }
    let mut shared = information.view((0, 0), (SHARED, SHARED)).into_owned();
    let mut slope = gradient.rows(0, SHARED).into_owned();
    if own > 0 {
        let across = information.view((0, SHARED), (SHARED, own)).into_owned();
        let Some(factor) = information.view((SHARED, SHARED), (own, own)).into_owned().cholesky() else {
            return Vec::new();
        };
        shared -= &across * factor.solve(&across.transpose());
        slope -= &across * factor.solve(&gradient.rows(SHARED, own).into_owned());
    }
    let (shared, slope) = without_the_shape(&shared, &slope);
    let eigen = shared.symmetric_eigen();
    let largest = eigen.eigenvalues.iter().copied().fold(0.0, f64::max);
    let known = eigen.eigenvalues.iter().enumerate().filter(|(_, value)| **value > UNKNOWN * largest);
    known
        .map(|(index, value)| {
            let direction = eigen.eigenvectors.column(index);
            let size = value.sqrt();
            (direction.iter().map(|one| size * one).collect(), direction.dot(&slope) / size)
        })
        .collect()
}

/// Information with Stribeck velocity and exponent free: the linear dependence of breakaway on them
/// holds only over changes much smaller than those of a profile.
fn without_the_shape(shared: &DMatrix<f64>, slope: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let across = shared.columns(STRIBECK_VELOCITY, 2).into_owned();
    let own = across.rows(STRIBECK_VELOCITY, 2).into_owned();
    let least = UNKNOWN * own.trace();
    let Ok(inverse) = own.pseudo_inverse(least) else { return (shared.clone(), slope.clone()) };
    let taken = &across * inverse;
    let mut left = shared - &taken * across.transpose();
    let mut slope = slope - &taken * slope.rows(STRIBECK_VELOCITY, 2);
    for index in STRIBECK_VELOCITY..STRIBECK_VELOCITY + 2 {
        left.row_mut(index).fill(0.0);
        left.column_mut(index).fill(0.0);
        slope[index] = 0.0;
    }
    (left, slope)
}
