//! The convex subproblem of one step: linear margins, an objective with curvature, and a box.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use super::descent::Curvature;
use super::search::{Aim, MarginRow};
use super::triplets::Triplets;

/// Fraction of the box below which the range of a coordinate is so small that it stays fixed.
const RANGE_MINIMUM: f64 = 1e-9;
/// Tolerated distance to a binding bound, as a fraction of the box.
const ROOM_LARGEST: f64 = 1e-6;
/// Largest error of the optimality conditions, relative to the slopes in them.
const ERROR_MAXIMUM: f64 = 1e-5;
/// Number of rows among which a step is first sought, in addition to one for each coordinate.
const ROWS_FIRST: usize = 24;
/// Violation beyond which an excluded row is added, in units of the box.
const VIOLATED: f64 = 1e-8;
const ITERATIONS_MAXIMUM: u32 = 100;
const TOLERANCE: f64 = 1e-9;

/// Linearisation at a point, and bounds of the step to the next one.
///
/// ```text
/// minimise    g.d + d.B d/2 + sigma v              over the step d and the violation v
/// subject to  m_i + s_i.d + r_i v >= r_i m_r       every margin m_i with its slopes s_i and its rate r_i
///             l <= d <= u,   v >= 0
/// ```
///
/// For [`Aim::WorstMargin`] g = 0, sigma = 1, and v may be negative: -v is the amount by which the
/// worst margin exceeds the reserve m_r. The violation v is the slack of an exact penalty, so that
/// a step always exists. The order of the rows affects only the rounding.
pub(super) struct Subproblem<'a> {
    pub(super) aim: Aim,
    /// Slopes g of the objective, dB per unit of x.
    pub(super) objective_slopes: &'a [f64],
    /// Curvature B; `None` for zero.
    pub(super) curvature: Option<&'a Curvature>,
    pub(super) margins: &'a [MarginRow],
    /// Bounds l <= 0 and u >= 0 of each coordinate.
    pub(super) step_bounds: &'a [[f64; 2]],
    /// Reserve m_r, dB.
    pub(super) reserve_db: f64,
    /// Penalty sigma, dB of the objective per dB of violation.
    pub(super) penalty: f64,
}

/// A step and its predicted effect.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PredictedStep {
    /// Step d.
    pub(super) step: Vec<f64>,
    /// Violation v at this step over all rows, dB.
    pub(super) violation_db: f64,
    /// Predicted decrease of g.d + d.B d/2 + sigma v relative to no step, dB.
    pub(super) decrease_db: f64,
    /// Gain in the objective per dB of relaxation of a margin, dB/dB, in the order of the rows.
    pub(super) multipliers: Vec<f64>,
}

/// Reason why there is no step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SubproblemFailure {
    /// A slope, a margin or a bound is NaN.
    NotFinite,
    /// Lack of free coordinates, or of a margin to improve.
    NothingToDo,
    /// The interior-point method found no solution.
    NotSolved,
    /// Solution of the interior-point method that violates the optimality conditions by this
    /// amount, relative to the slopes in them.
    Inaccurate(f64),
}

/// The subproblem scaled by its box: d = scale e, v = v0 + scale w, with everything divided by
/// scale.
struct Scaled {
    scale: f64,
    /// Violation v0 without a step.
    violation: f64,
    /// The coordinates that may move.
    free: Vec<usize>,
    /// The rows that can matter in this box.
    cache: Vec<ScaledRow>,
    /// Bounds of e.
    bounds: Vec<[f64; 2]>,
    /// Least w; `None` if it is free.
    least: Option<f64>,
}

/// The index of a row, and its margin with v0, divided by scale.
type ScaledRow = (usize, f64);

/// The best step overall, or the further rows that the best step for some rows violates.
enum Among {
    Best(PredictedStep),
    Violates(Vec<ScaledRow>),
}

impl Subproblem<'_> {
    /// The best step for the rows of least margin and those that such a step violates: few bind.
    pub(super) fn solve(&self) -> Result<PredictedStep, SubproblemFailure> {
        if !self.is_finite() {
            return Err(SubproblemFailure::NotFinite);
        }
        let scaled = self.scaled()?;
        let mut rows = scaled.nearest();
        loop {
            let is_all = rows.len() == scaled.cache.len();
            match self.solve_among(&scaled, &rows) {
                Ok(Among::Best(step)) => return Ok(step),
                Ok(Among::Violates(further)) => {
                    rows.extend(further);
                    rows.sort_unstable_by_key(|(index, _)| *index);
                }
                Err(failure) if is_all => return Err(failure),
                Err(_) => rows.clone_from(&scaled.cache),
            }
        }
    }

    /// The best step that satisfies these rows, or the further rows that it violates.
    fn solve_among(&self, scaled: &Scaled, rows: &[ScaledRow]) -> Result<Among, SubproblemFailure> {
        let (matrix, limits) = scaled.constraints(rows, self.margins);
        let (quadratic, linear) = self.cost(scaled);
        let settings = DefaultSettings {
            verbose: false,
            max_iter: ITERATIONS_MAXIMUM,
            max_threads: 1,
            direct_solve_method: "qdldl".to_string(),
            presolve_enable: false,
            tol_gap_abs: TOLERANCE,
            tol_gap_rel: TOLERANCE,
            tol_feas: TOLERANCE,
            ..DefaultSettings::default()
        };
        let cones = [NonnegativeConeT(limits.len())];
        let mut solver = DefaultSolver::new(&quadratic, &linear, &matrix, &limits, &cones, settings)
            .map_err(|_| SubproblemFailure::NotSolved)?;
        solver.solve();
        let solution = &solver.solution;
        let usable = [SolverStatus::Solved, SolverStatus::AlmostSolved, SolverStatus::InsufficientProgress];
        if !usable.contains(&solution.status) || !finite(&solution.x) || !finite(&solution.z) {
            return Err(SubproblemFailure::NotSolved);
        }
        let further = scaled.violated(&solution.x, rows, self.margins);
        if !further.is_empty() {
            return Ok(Among::Violates(further));
        }
        self.answer(scaled, rows, (&solution.x, &solution.z)).map(Among::Best)
    }

    fn is_finite(&self) -> bool {
        let row = |row: &MarginRow| {
            row.margin_db.is_finite() && row.rate > 0.0 && row.rate.is_finite() && finite(&row.slopes)
        };
        finite(self.objective_slopes)
            && self.margins.iter().all(row)
            && self.step_bounds.iter().all(|bounds| finite(bounds))
            && self.reserve_db.is_finite()
    }

    /// The least v allowed by the rows at a step.
    fn violation(&self, step: &[f64]) -> f64 {
        let needed = |row: &MarginRow| self.reserve_db - (row.margin_db + dot(&row.slopes, step)) / row.rate;
        let least = match self.aim {
            Aim::WorstMargin => f64::NEG_INFINITY,
            Aim::Objective => 0.0,
        };
        self.margins.iter().map(needed).fold(least, f64::max)
    }

    fn penalty(&self) -> f64 {
        match self.aim {
            Aim::WorstMargin => 1.0,
            Aim::Objective => self.penalty,
        }
    }

    fn scaled(&self) -> Result<Scaled, SubproblemFailure> {
        let scale = self.step_bounds.iter().flatten().fold(0.0, |scale: f64, bound| scale.max(bound.abs()));
        if scale <= 0.0 || (self.aim == Aim::WorstMargin && self.margins.is_empty()) {
            return Err(SubproblemFailure::NothingToDo);
        }
        let bounds: Vec<[f64; 2]> =
            self.step_bounds.iter().map(|[low, high]| [low / scale, high / scale]).collect();
        let free = (0..bounds.len()).zip(&bounds).filter(|(_, [low, high])| high - low > RANGE_MINIMUM);
        let free: Vec<usize> = free.map(|(coordinate, _)| coordinate).collect();
        let violation = self.violation(&vec![0.0; bounds.len()]);
        let eased = |row: &MarginRow| (row.margin_db + row.rate * (violation - self.reserve_db)) / scale;
        let reach = |row: &MarginRow, side: usize| -> f64 {
            let other = 1 - side;
            let pairs = row.slopes.iter().zip(&bounds);
            pairs.map(|(&slope, ends)| slope * if slope > 0.0 { ends[side] } else { ends[other] }).sum()
        };
        let floor = self.margins.iter().map(|row| -(eased(row) + reach(row, 1)) / row.rate);
        let least = (self.aim == Aim::Objective).then_some(-violation / scale);
        let floor = floor.fold(least.unwrap_or(f64::NEG_INFINITY), f64::max);
        let matters = |row: &MarginRow| eased(row) + reach(row, 0) + row.rate * floor <= 0.0;
        let cache = self.margins.iter().enumerate().filter(|(_, row)| matters(row));
        let cache = cache.map(|(index, row)| (index, eased(row))).collect();
        Ok(Scaled { scale, violation, free, cache, bounds, least })
    }

    /// Upper triangle of the quadratic term, and the linear term, of e and w.
    fn cost(&self, scaled: &Scaled) -> (CscMatrix<f64>, Vec<f64>) {
        let size = scaled.free.len() + 1;
        let linear = scaled.free.iter().map(|&coordinate| match self.aim {
            Aim::WorstMargin => 0.0,
            Aim::Objective => self.objective_slopes[coordinate],
        });
        let linear = linear.chain([self.penalty()]).collect();
        let mut triangle = Triplets::default();
        if let Some(curvature) = self.curvature {
            for (column, &across) in scaled.free.iter().enumerate() {
                for (row, &down) in scaled.free.iter().enumerate().take(column + 1) {
                    triangle.push(row, column, scaled.scale * curvature.at(down, across));
                }
            }
        }
        (triangle.matrix(size, size), linear)
    }

    fn answer(
        &self,
        scaled: &Scaled,
        rows: &[ScaledRow],
        (point, dual): (&[f64], &[f64]),
    ) -> Result<PredictedStep, SubproblemFailure> {
        let mut step = vec![0.0; self.step_bounds.len()];
        let held = dual.iter().skip(rows.len());
        let held = held.clone().step_by(2).zip(held.skip(1).step_by(2));
        for ((&coordinate, &fraction), (&above, &below)) in scaled.free.iter().zip(point).zip(held) {
            let ([low, high], [least, greatest]) = (self.step_bounds[coordinate], scaled.bounds[coordinate]);
            step[coordinate] = if is_held(greatest - fraction, above) {
                high
            } else if is_held(fraction - least, below) {
                low
            } else {
                (scaled.scale * fraction).max(low).min(high)
            };
        }
        let mut multipliers = vec![0.0; self.margins.len()];
        for ((index, _), &multiplier) in rows.iter().zip(dual) {
            multipliers[*index] = multiplier.max(0.0);
        }
        let error = self.optimality_error(scaled, &step, &multipliers);
        if error > ERROR_MAXIMUM {
            return Err(SubproblemFailure::Inaccurate(error));
        }
        let violation_db = self.violation(&step);
        let bent = self.curvature.map_or(0.0, |curvature| dot(&curvature.times(&step), &step) / 2.0);
        let risen = match self.aim {
            Aim::WorstMargin => bent,
            Aim::Objective => dot(self.objective_slopes, &step) + bent,
        };
        let decrease_db = self.penalty() * (scaled.violation - violation_db) - risen;
        Ok(PredictedStep { step, violation_db, decrease_db, multipliers })
    }

    /// Possible decrease of the Lagrangian within the box, relative to the possible change of its
    /// terms: zero at the optimum.
    ///
    /// ```text
    /// g + B d - sum lambda_i s_i = 0 where d is within its bounds, pointing inwards at a bound
    /// sigma - sum lambda_i r_i >= 0, zero where v > 0 or free;    lambda_i (slack of row i) = 0
    /// ```
    fn optimality_error(&self, scaled: &Scaled, step: &[f64], multipliers: &[f64]) -> f64 {
        let bent = self.curvature.map(|curvature| curvature.times(step));
        let (mut fall, mut size) = (0.0, self.penalty());
        for &coordinate in &scaled.free {
            let slope = match self.aim {
                Aim::WorstMargin => 0.0,
                Aim::Objective => self.objective_slopes[coordinate],
            };
            let slope = slope + bent.as_ref().map_or(0.0, |bent| bent[coordinate]);
            let pulls = self
                .margins
                .iter()
                .zip(multipliers)
                .map(|(row, multiplier)| multiplier * row.slopes[coordinate]);
            let (pull, pulled) =
                pulls.fold((0.0, 0.0), |(sum, size), pull| (sum + pull, size + f64::abs(pull)));
            let [low, high] = self.step_bounds[coordinate];
            let rest = slope - pull;
            let room = if rest > 0.0 { step[coordinate] - low } else { high - step[coordinate] };
            fall += rest.abs() * room / scaled.scale;
            size += slope.abs() + pulled;
        }
        let violation = self.violation(step);
        let weights = self.margins.iter().zip(multipliers).map(|(row, multiplier)| multiplier * row.rate);
        let rest = self.penalty() - weights.sum::<f64>();
        fall += match self.aim {
            Aim::Objective if rest > 0.0 => rest * violation / scaled.scale,
            _ => rest.abs(),
        };
        for (row, multiplier) in self.margins.iter().zip(multipliers) {
            let slack = row.margin_db + dot(&row.slopes, step) + row.rate * (violation - self.reserve_db);
            fall += multiplier * slack / scaled.scale;
        }
        fall / size
    }
}

impl Scaled {
    /// The rows of least margin, in their order.
    fn nearest(&self) -> Vec<ScaledRow> {
        let mut rows = self.cache.clone();
        let count = ROWS_FIRST + self.free.len();
        if count < rows.len() {
            rows.select_nth_unstable_by(count, |one, other| {
                one.1.total_cmp(&other.1).then(one.0.cmp(&other.0))
            });
            rows.truncate(count);
            rows.sort_unstable_by_key(|(index, _)| *index);
        }
        rows
    }

    /// The other rows that (e, w) violates.
    fn violated(&self, point: &[f64], rows: &[ScaledRow], margins: &[MarginRow]) -> Vec<ScaledRow> {
        if rows.len() == self.cache.len() {
            return vec![];
        }
        let is_violated = |(index, eased): &&ScaledRow| {
            let Some((row, relaxed)) = margins.get(*index).zip(point.last()) else { return false };
            let moved =
                self.free.iter().zip(point).map(|(&coordinate, fraction)| row.slopes[coordinate] * fraction);
            eased + moved.sum::<f64>() + row.rate * relaxed < -VIOLATED
        };
        let is_other =
            |(index, _): &&ScaledRow| rows.binary_search_by_key(index, |(index, _)| *index).is_err();
        self.cache.iter().filter(is_other).filter(is_violated).copied().collect()
    }

    /// Constraints `matrix (e, w) <= limits`: the rows, the upper and lower bounds of e, the least
    /// w.
    fn constraints(&self, cache: &[ScaledRow], margins: &[MarginRow]) -> (CscMatrix<f64>, Vec<f64>) {
        let (rows, columns) = (cache.len(), self.free.len());
        let mut entries = Triplets::default();
        for (row, (index, _)) in cache.iter().enumerate() {
            let margin = &margins[*index];
            for (column, &coordinate) in self.free.iter().enumerate() {
                entries.push(row, column, -margin.slopes[coordinate]);
            }
            entries.push(row, columns, -margin.rate);
        }
        let mut limits: Vec<f64> = cache.iter().map(|(_, eased)| *eased).collect();
        for (column, &coordinate) in self.free.iter().enumerate() {
            entries.push(rows + 2 * column, column, 1.0);
            entries.push(rows + 2 * column + 1, column, -1.0);
            limits.extend([self.bounds[coordinate][1], -self.bounds[coordinate][0]]);
        }
        if let Some(least) = self.least {
            entries.push(limits.len(), columns, -1.0);
            limits.push(-least);
        }
        (entries.matrix(limits.len(), columns + 1), limits)
    }
}

/// True if a bound is active: its multiplier is the larger of the two that the interior-point
/// method keeps above zero.
fn is_held(room: f64, multiplier: f64) -> bool {
    room < ROOM_LARGEST && room < multiplier
}

fn finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// Scalar product a.b.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use phea_dynamics::portable;

    use super::*;

    fn row(sample: usize, margin_db: f64, rate: f64, slopes: &[f64]) -> MarginRow {
        MarginRow { sample, margin_db, rate, slopes: slopes.to_vec() }
    }

    fn subproblem<'a>(
        aim: Aim,
        slopes: &'a [f64],
        margins: &'a [MarginRow],
        step_bounds: &'a [[f64; 2]],
    ) -> Subproblem<'a> {
        let (reserve_db, penalty) = (0.0, 10.0);
        Subproblem {
            aim,
            objective_slopes: slopes,
            curvature: None,
            margins,
            step_bounds,
            reserve_db,
            penalty,
        }
    }

    #[track_caller]
    fn near(found: &[f64], expected: &[f64]) {
        let close = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(found.len() == expected.len() && close, "{found:?} {expected:?}");
    }

    /// Maximum of x + 2 y below x + y <= 4 and y <= 2: the vertex (2, 2), each margin worth 1; a
    /// far margin and one in the direction of the objective have no effect. In a box a thousand
    /// times smaller: the corner.
    #[test]
    fn vertex_of_a_linear_problem() {
        let rows = [
            row(0, 4.0, 1.0, &[-1.0, -1.0]),
            row(1, 2.0, 1.0, &[0.0, -1.0]),
            row(2, 90.0, 1.0, &[-1.0, -2.0]),
            row(3, 6.1, 1.0, &[-1.0, -2.0]),
        ];
        let answer = subproblem(Aim::Objective, &[-1.0, -2.0], &rows, &[[0.0, 10.0]; 2]).solve().unwrap();
        near(&answer.step, &[2.0, 2.0]);
        near(&answer.multipliers, &[1.0, 1.0, 0.0, 0.0]);
        near(&[answer.decrease_db, answer.violation_db], &[6.0, 0.0]);
        let answer = subproblem(Aim::Objective, &[-1.0, -2.0], &rows, &[[-0.01, 0.01]; 2]).solve().unwrap();
        near(&answer.step, &[0.01, 0.01]);
        near(&answer.multipliers, &[0.0; 4]);
    }

    /// Minimum of (x - 1)^2 + (y - 5/2)^2 below x - 2 y + 2 >= 0 and other rows that do not bind,
    /// from the origin.
    #[test]
    fn multipliers_of_a_quadratic_problem() {
        // ORIGIN: Nocedal and Wright (2006), example 16.4: (1.4, 1.7), multiplier 0.8
        let curvature = Curvature::first(&[1.0, 1.0], &[2.0, 2.0]);
        let rows =
            [row(0, 2.0, 1.0, &[1.0, -2.0]), row(1, 6.0, 1.0, &[-1.0, -2.0]), row(2, 2.0, 1.0, &[-1.0, 2.0])];
        let problem = Subproblem {
            curvature: curvature.as_ref(),
            ..subproblem(Aim::Objective, &[-2.0, -5.0], &rows, &[[0.0, 3.0]; 2])
        };
        let answer = problem.solve().unwrap();
        near(&answer.step, &[1.4, 1.7]);
        near(&answer.multipliers, &[0.8, 0.0, 0.0]);
        near(&[answer.decrease_db], &[7.25 - 0.8]);
    }

    /// A margin that a relaxation improves twice as much: x >= t and 3 - x >= 2 t meet at t = 1,
    /// each worth a third.
    #[test]
    fn common_margin_is_weighed_by_the_rates() {
        let rows = [row(0, 0.0, 1.0, &[1.0]), row(1, 3.0, 2.0, &[-1.0])];
        let problem =
            Subproblem { reserve_db: 0.25, ..subproblem(Aim::WorstMargin, &[7.0], &rows, &[[-9.0, 9.0]]) };
        let answer = problem.solve().unwrap();
        near(&answer.step, &[1.0]);
        near(&answer.multipliers, &[1.0 / 3.0; 2]);
        near(&[answer.violation_db, answer.decrease_db], &[0.25 - 1.0, 1.0]);
    }

    /// Minimum of x + 2 y within a disc enclosed by a thousand tangents, of which few are examined
    /// first: the two next to (-1, -2)/sqrt(5) bind.
    #[test]
    fn few_of_many_rows_bind() {
        let tangent = |index: usize| {
            let angle = std::f64::consts::TAU * index as f64 / 1000.0;
            row(index, 1.0, 1.0, &[portable::cos(angle), portable::sin(angle)])
        };
        let rows: Vec<MarginRow> = (0..1000).map(tangent).collect();
        let answer = subproblem(Aim::Objective, &[1.0, 2.0], &rows, &[[-9.0, 9.0]; 2]).solve().unwrap();
        // a corner of the polygon is outside the circle by less than 5e-6 of its radius
        let circle = 5_f64.sqrt();
        assert!((answer.decrease_db / circle - 1.0).abs() < 5e-6, "{answer:?}");
        let bind: Vec<usize> = (0..1000).filter(|index| answer.multipliers[*index] > 1e-6).collect();
        assert_eq!(bind, [176, 177]); // of atan2(2, 1), 1000/(2 pi) to a radian
    }

    /// The part that the box does not allow remains as a violation, which is penalised.
    #[test]
    fn violation_is_elastic() {
        let rows = [row(0, -1.0, 1.0, &[1.0, 0.0])];
        let answer =
            subproblem(Aim::Objective, &[1.0, 1.0], &rows, &[[-0.5, 0.5], [-0.5, 0.5]]).solve().unwrap();
        near(&answer.step, &[0.5, -0.5]);
        near(&answer.multipliers, &[10.0]);
        near(&[answer.violation_db, answer.decrease_db], &[0.5, 10.0 * 0.5 - 0.5 + 0.5]);
    }

    #[test]
    fn what_has_no_answer_is_refused() {
        let rows = [row(0, f64::NAN, 1.0, &[1.0])];
        let solve =
            |aim, rows: &[MarginRow], bounds| subproblem(aim, &[1.0], rows, bounds).solve().unwrap_err();
        assert_eq!(solve(Aim::Objective, &rows, &[[-1.0, 1.0]]), SubproblemFailure::NotFinite);
        assert_eq!(solve(Aim::WorstMargin, &[], &[[-1.0, 1.0]]), SubproblemFailure::NothingToDo);
        assert_eq!(solve(Aim::Objective, &[], &[[0.0, 0.0]]), SubproblemFailure::NothingToDo);
    }
}
