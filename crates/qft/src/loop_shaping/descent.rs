//! Descent from one point: a sequence of convex subproblems within a trust region.

mod curvature;
mod outcome;
mod place;

use std::collections::BTreeMap;

use phea_dynamics::order::sort_by_number;
use phea_dynamics::watch::{Stopped, Watch, report_progress};

use super::search::{Aim, Judgement, MarginRow, SearchProblem, Slopes};
use super::subproblem::{PredictedStep, Subproblem, SubproblemFailure, dot};
pub(super) use curvature::Curvature;
pub use outcome::{Binding, DescentResult, DescentStatus, DescentWork};
use place::DescentPoint;

/// Initial and largest radius of the trust region, in units of x.
const RADIUS_FIRST: f64 = 0.3;
const RADIUS_NEAR: f64 = 0.1;
const RADIUS_LARGEST: f64 = 2.0;
/// Radius of the trust region below which the descent ends.
const RADIUS_LEAST: f64 = 1e-8;
/// Fractions of the predicted decrease above which a step is accepted, the region is retained, and
/// it may grow.
const TAKEN: f64 = 0.05;
const KEPT: f64 = 0.25;
const GROWN: f64 = 0.7;
/// Largest number of corrections of one step.
const CORRECTIONS_MAXIMUM: usize = 3;
/// Initial penalty, its growth factor and its maximum, dB of the objective per dB of violation.
const PENALTY_FIRST: f64 = 10.0;
const PENALTY_GROWTH: f64 = 4.0;
const PENALTY_LARGEST: f64 = 1e7;
/// Fraction of the tolerance by which margins may miss the reserve for [`Aim::Objective`].
const ENTERED: f64 = 0.5;
/// Remaining distance along the slopes below which a point counts as the end, in units of x.
const REACH: f64 = 0.1;
/// Number of successive subproblems without a solution after which the descent is abandoned.
const FAILURES_MAXIMUM: usize = 8;
/// Fraction of the largest multiplier below which a multiplier is rounding error.
const MULTIPLIER_LEAST: f64 = 1e-6;

/// Aim, accuracy and limits of a descent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DescentOptions {
    /// The aim: objective or worst margin.
    pub aim: Aim,
    /// Least margin required for [`Aim::Objective`], dB. Limits without room between them, such as
    /// those of tracking at low frequency, permit no reserve; a negative reserve, equal to the
    /// tolerance of an audit, accounts for this.
    pub reserve_db: f64,
    /// Accuracy of objective or worst margin, and amount by which a margin may miss its reserve,
    /// dB.
    pub tolerance_db: f64,
    /// Largest number of steps.
    pub steps_maximum: usize,
    /// True if the start is near the end, as after a margin was added: objective and violation are
    /// then reduced together from the beginning; reducing the worst violation first may diverge.
    pub is_near: bool,
}

impl DescentOptions {
    /// Defaults: no reserve, a tolerance of 0.0001 dB, 200 steps.
    pub fn new(aim: Aim) -> DescentOptions {
        DescentOptions { aim, reserve_db: 0.0, tolerance_db: 1e-4, steps_maximum: 200, is_near: false }
    }

    /// True if a worst margin satisfies the reserve, except for a fraction of the tolerance.
    fn keeps(&self, worst_margin_db: f64, fraction: f64) -> bool {
        worst_margin_db >= self.reserve_db - fraction * self.tolerance_db
    }
}

/// Descends from one point.
///
/// ```text
/// merit(x) = f(x) + sigma max(0, m_r - m(x)),   m(x) the worst margin;     -m(x) for Aim::WorstMargin
/// ```
///
/// Each step minimises a convex model of the merit within a box (sequential quadratic programming,
/// the box a trust region, the penalty exact), and is accepted if the merit falls by a fraction of
/// the predicted decrease; a step into an unstable region is never accepted. A step that the
/// curvature of the margins makes too long is corrected with the margins found at its end
/// (second-order correction). The curvature of the Lagrangian is estimated from its slopes (damped
/// BFGS). For [`Aim::Objective`] the worst margin is raised first, until all satisfy their reserve.
///
/// The end is a local optimum. Source: Fletcher (1987), chapters 12 and 14; Nocedal and Wright
/// (2006), chapter 18.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// ```
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::loop_shaping::{
///     Aim, DescentOptions, DescentStatus, Judgement, MarginRow, SearchProblem, Slopes, descend,
/// };
///
/// /// Least x + y with margin 1 - x^2 - y^2: at x = y = -sqrt(1/2).
/// struct Disc([[f64; 2]; 2]);
///
/// impl SearchProblem for Disc {
///     fn bounds(&self) -> &[[f64; 2]] {
///         &self.0
///     }
///     fn judge(&mut self, x: &[f64]) -> Judgement {
///         let margin = 1.0 - x[0] * x[0] - x[1] * x[1];
///         Judgement { objective_db: x[0] + x[1], worst_margin_db: margin, stable: true, instability: 0.0 }
///     }
///     fn slopes(&mut self, x: &[f64]) -> Slopes {
///         let margin_db = self.judge(x).worst_margin_db;
///         let row = MarginRow { sample: 0, margin_db, rate: 1.0, slopes: vec![-2.0 * x[0], -2.0 * x[1]] };
///         Slopes { objective_db: x[0] + x[1], objective_slopes: vec![1.0, 1.0], margins: vec![row] }
///     }
/// }
///
/// let mut disc = Disc([[-3.0, 3.0]; 2]);
/// let options = DescentOptions { reserve_db: 0.0, ..DescentOptions::new(Aim::Objective) };
/// let found = descend(&mut disc, &[2.0, 1.0], options, &mut unwatched)?;
/// assert_eq!(found.status, DescentStatus::Converged);
/// assert!((found.judgement.unwrap().objective_db + 2_f64.sqrt()).abs() < 1e-4);
/// let multiplier = 0.5_f64.sqrt(); // of x + y against the square of the radius
/// assert!((found.binding[0].multiplier - multiplier).abs() < 1e-2);
/// # Ok::<(), phea_dynamics::watch::Stopped>(())
/// ```
pub fn descend(
    problem: &mut dyn SearchProblem,
    start: &[f64],
    options: DescentOptions,
    watch: Watch<'_>,
) -> Result<DescentResult, Stopped> {
    let mut descent = Descent::new(start, options);
    loop {
        if let Some(status) = descent.advance(problem) {
            return Ok(descent.result(status));
        }
        report_progress(watch, "descent", descent.steps, options.steps_maximum)?;
    }
}

/// A descent in progress.
#[derive(Clone, Debug)]
pub(super) struct Descent {
    options: DescentOptions,
    x: Vec<f64>,
    /// The present point; `None` before the first step.
    here: Option<DescentPoint>,
    /// The present aim: first the worst margin, then the objective.
    aim: Aim,
    radius: f64,
    penalty: f64,
    curvature: Option<Curvature>,
    binding: Vec<Binding>,
    failures: usize,
    steps: usize,
    work: DescentWork,
    status: Option<DescentStatus>,
}

impl Descent {
    /// A new descent.
    pub(super) fn new(x: &[f64], options: DescentOptions) -> Descent {
        Descent {
            options,
            x: x.to_vec(),
            here: None,
            aim: options.aim,
            radius: if options.is_near { RADIUS_NEAR } else { RADIUS_FIRST },
            penalty: PENALTY_FIRST,
            curvature: None,
            binding: vec![],
            failures: 0,
            steps: 0,
            work: DescentWork::default(),
            status: None,
        }
    }

    /// The present point x.
    pub(super) fn x(&self) -> &[f64] {
        self.here.as_ref().map_or(&self.x, |here| &here.x)
    }

    /// Ends at the end of another descent, with this much work done.
    pub(super) fn end_at(&mut self, other: &Descent, work: DescentWork) {
        self.work = work;
        self.here.clone_from(&other.here);
        self.binding.clone_from(&other.binding);
        self.status = other.status;
    }

    /// The evaluation of the present point; `None` before the first step.
    pub(super) fn judgement(&self) -> Option<Judgement> {
        self.here.as_ref().map(|here| here.judgement)
    }

    /// Final status; `None` while it continues.
    pub(super) fn status(&self) -> Option<DescentStatus> {
        self.status
    }

    /// The margins that limited the last step, the strongest first.
    pub(super) fn binding(&self) -> &[Binding] {
        &self.binding
    }

    /// Work done so far.
    pub(super) fn work(&self) -> DescentWork {
        self.work
    }

    fn result(self, status: DescentStatus) -> DescentResult {
        let Descent { x, here, binding, work, .. } = self;
        let judgement = here.as_ref().map(|here| here.judgement);
        DescentResult { x: here.map_or(x, |here| here.x), judgement, status, binding, work }
    }

    /// Makes one step, with a few evaluations; returns the status of the descent once that is
    /// final.
    pub(super) fn advance(&mut self, problem: &mut dyn SearchProblem) -> Option<DescentStatus> {
        if self.status.is_some() {
            return self.status;
        }
        match self.here.take() {
            None => self.begin(problem),
            Some(here) if self.steps >= self.options.steps_maximum => {
                self.status = Some(DescentStatus::BudgetSpent { steps: self.steps });
                self.here = Some(here);
            }
            Some(here) => {
                self.steps += 1;
                self.here = Some(self.advanced(problem, here));
            }
        }
        self.status
    }

    fn begin(&mut self, problem: &mut dyn SearchProblem) {
        let inside = |(x, [low, high]): (&f64, &[f64; 2])| low <= x && x <= high;
        let bounds = problem.bounds();
        if bounds.len() != self.x.len() || !self.x.iter().zip(bounds).all(inside) {
            self.status = Some(DescentStatus::StartOutside);
            return;
        }
        let x = self.x.clone();
        let judgement = self.judged(problem, &x);
        let slopes = match is_usable(&judgement) {
            true => self.slopes_at(problem, &x),
            false => {
                self.status = Some(DescentStatus::StartUnusable);
                Slopes { objective_db: judgement.objective_db, objective_slopes: vec![], margins: vec![] }
            }
        };
        self.aim = match self.options.aim {
            Aim::Objective if self.options.keeps(judgement.worst_margin_db, ENTERED) => Aim::Objective,
            _ => Aim::WorstMargin,
        };
        self.here = Some(DescentPoint { x, judgement, slopes, beyond: vec![] });
    }

    /// One step: the resulting point, or the starting point.
    fn advanced(&mut self, problem: &mut dyn SearchProblem, here: DescentPoint) -> DescentPoint {
        let bounds = problem.bounds().to_vec();
        let answer = match self.solved(&here, &here.rows(), &bounds) {
            Ok(answer) => answer,
            Err(failure) => return self.without_answer(failure, here),
        };
        self.note_binding(&here, &answer);
        if !self.continues(&here, &answer) {
            return here;
        }
        let (x, judgement) = self.tried(problem, &here, &answer.step, &bounds);
        let fraction = self.gain(&here, &judgement) / answer.decrease_db;
        if !is_usable(&judgement) {
            self.shrink(greatest(&answer.step) / 4.0);
            return here;
        }
        let there = DescentPoint { slopes: self.slopes_at(problem, &x), x, judgement, beyond: vec![] };
        self.learn(&here, &there, &answer);
        if fraction >= GROWN {
            self.taken(there, &answer, fraction)
        } else {
            self.corrected(problem, here, there, &answer, fraction, &bounds)
        }
    }

    /// Repeats the step with the margins found at its end as constants and the slopes at its start,
    /// as long as the result improves. The best point is accepted if it is good enough.
    fn corrected(
        &mut self,
        problem: &mut dyn SearchProblem,
        here: DescentPoint,
        there: DescentPoint,
        answer: &PredictedStep,
        fraction: f64,
        bounds: &[[f64; 2]],
    ) -> DescentPoint {
        let (mut last, mut last_step) = (there.clone(), answer.step.clone());
        let mut best = (fraction, there, answer.clone());
        for _ in 0..CORRECTIONS_MAXIMUM {
            let Ok(next) = self.solved(&here, &here.corrected_rows(&last, &last_step), bounds) else { break };
            let (x, judgement) = self.tried(problem, &here, &next.step, bounds);
            let fraction = self.gain(&here, &judgement) / answer.decrease_db;
            if fraction <= best.0 || !is_usable(&judgement) {
                break;
            }
            last = DescentPoint { slopes: self.slopes_at(problem, &x), x, judgement, beyond: vec![] };
            last_step.clone_from(&next.step);
            self.learn(&here, &last, &next);
            best = (fraction, last.clone(), next);
            if fraction >= GROWN {
                break;
            }
        }
        let (fraction, there, taken) = best;
        if fraction >= TAKEN {
            return self.taken(there, &taken, fraction);
        }
        self.shrink(greatest(&answer.step) / 3.0);
        here.with_rows_of(&there)
    }

    /// Moves to the new point, and adapts the trust region to the accuracy of the prediction.
    fn taken(&mut self, there: DescentPoint, answer: &PredictedStep, fraction: f64) -> DescentPoint {
        let size = greatest(&answer.step);
        if fraction < KEPT {
            self.radius = size / 2.0;
        } else if fraction > GROWN && size > 0.9 * self.radius {
            self.radius = (2.0 * self.radius).min(RADIUS_LARGEST);
        }
        let is_feasible = self.options.keeps(there.judgement.worst_margin_db, ENTERED);
        if self.aim == Aim::WorstMargin && self.options.aim == Aim::Objective && is_feasible {
            self.aim = Aim::Objective;
            self.curvature = None;
        }
        there
    }

    /// The solution of the subproblem around a point, with the penalty raised as long as that
    /// reduces the violation.
    fn solved(
        &mut self,
        here: &DescentPoint,
        rows: &[MarginRow],
        bounds: &[[f64; 2]],
    ) -> Result<PredictedStep, SubproblemFailure> {
        let reach =
            |(x, [low, high]): (&f64, &[f64; 2])| [(low - x).max(-self.radius), (high - x).min(self.radius)];
        let step_bounds: Vec<[f64; 2]> = here.x.iter().zip(bounds).map(reach).collect();
        let subproblem = |penalty| Subproblem {
            aim: self.aim,
            objective_slopes: &here.slopes.objective_slopes,
            curvature: self.curvature.as_ref(),
            margins: rows,
            step_bounds: &step_bounds,
            reserve_db: self.options.reserve_db,
            penalty,
        };
        let (mut penalty, mut solved) = (self.penalty, 1);
        let mut answer = subproblem(penalty).solve()?;
        while self.aim == Aim::Objective
            && answer.violation_db > self.options.tolerance_db
            && penalty < PENALTY_LARGEST
        {
            solved += 1;
            match subproblem(PENALTY_GROWTH * penalty).solve() {
                Ok(stricter) if stricter.violation_db < 0.9 * answer.violation_db => answer = stricter,
                _ => break,
            }
            penalty *= PENALTY_GROWTH;
        }
        self.penalty = penalty;
        self.work.subproblems += solved;
        Ok(answer)
    }

    /// Continues with a smaller region and a reset curvature after a subproblem without a solution.
    fn without_answer(&mut self, failure: SubproblemFailure, here: DescentPoint) -> DescentPoint {
        self.work.subproblems += 1;
        self.failures += 1;
        let hopeless = matches!(failure, SubproblemFailure::NotFinite | SubproblemFailure::NothingToDo);
        if hopeless || self.failures >= FAILURES_MAXIMUM {
            self.status = Some(DescentStatus::NoStep { penalty: self.penalty });
        }
        self.curvature = None;
        self.shrink(self.radius / 2.0);
        here
    }

    /// True if the step is worth evaluating. If the model predicts no further gain, `status` states
    /// the reason; if that is only the curvature, it is reset.
    fn continues(&mut self, here: &DescentPoint, answer: &PredictedStep) -> bool {
        self.failures = 0;
        let tolerance = self.options.tolerance_db;
        let left = self.curvature.as_ref().map_or(0.0, |curvature| {
            curvature.times(&answer.step).iter().map(|slope| slope.abs()).sum::<f64>()
        });
        if answer.decrease_db > tolerance / 10.0 {
            return true;
        }
        if REACH * left > 10.0 * tolerance {
            let is_stuck = answer.decrease_db <= tolerance / 1e4;
            self.curvature = self.curvature.take().filter(|_| !is_stuck);
            return !is_stuck;
        }
        let size = greatest(&answer.step);
        if size > 0.9 * self.radius && self.radius < REACH / 10.0 && answer.decrease_db > tolerance / 1e4 {
            return true;
        }
        let worst_margin_db = here.judgement.worst_margin_db;
        let misses = !self.options.keeps(worst_margin_db, 1.0);
        if self.aim == Aim::Objective && misses && self.penalty < PENALTY_LARGEST {
            self.penalty *= PENALTY_GROWTH;
            return false;
        }
        self.status = Some(match self.options.aim {
            Aim::Objective if misses => DescentStatus::Infeasible { worst_margin_db },
            _ => DescentStatus::Converged,
        });
        false
    }

    fn note_binding(&mut self, here: &DescentPoint, answer: &PredictedStep) {
        let largest =
            answer.multipliers.iter().fold(0.0, |largest: f64, &multiplier| largest.max(multiplier));
        let mut strengths: BTreeMap<usize, f64> = BTreeMap::new();
        for (row, &multiplier) in here.rows().iter().zip(&answer.multipliers) {
            if multiplier > MULTIPLIER_LEAST * largest {
                *strengths.entry(row.sample).or_default() += multiplier;
            }
        }
        self.binding =
            strengths.into_iter().map(|(sample, multiplier)| Binding { sample, multiplier }).collect();
        sort_by_number(&mut self.binding, |binding| -binding.multiplier);
    }

    /// Updates the curvature of the Lagrangian from a step.
    fn learn(&mut self, here: &DescentPoint, there: &DescentPoint, answer: &PredictedStep) {
        let step: Vec<f64> = there.x.iter().zip(&here.x).map(|(there, here)| there - here).collect();
        let change = here.change_of_slopes(there, self.aim, &answer.multipliers);
        self.curvature = match &self.curvature {
            Some(curvature) if dot(&step, &step) > 0.0 => curvature.updated(&step, &change),
            _ => Curvature::first(&step, &change),
        };
    }

    fn shrink(&mut self, radius: f64) {
        self.radius = radius;
        if radius < RADIUS_LEAST && self.status.is_none() {
            self.status = Some(DescentStatus::TrustRegionTooSmall { radius });
        }
    }

    /// The decrease of the merit, dB; minus infinity if the margins are meaningless.
    fn gain(&self, here: &DescentPoint, there: &Judgement) -> f64 {
        let merit = |judgement: &Judgement| match self.aim {
            Aim::WorstMargin => -judgement.worst_margin_db,
            Aim::Objective => {
                let violation = (self.options.reserve_db - judgement.worst_margin_db).max(0.0);
                judgement.objective_db + self.penalty * violation
            }
        };
        if is_usable(there) { merit(&here.judgement) - merit(there) } else { f64::NEG_INFINITY }
    }

    fn tried(
        &mut self,
        problem: &mut dyn SearchProblem,
        here: &DescentPoint,
        step: &[f64],
        bounds: &[[f64; 2]],
    ) -> (Vec<f64>, Judgement) {
        let moved = here.x.iter().zip(step).zip(bounds);
        let x: Vec<f64> = moved.map(|((x, d), [low, high])| (x + d).max(*low).min(*high)).collect();
        let judgement = self.judged(problem, &x);
        (x, judgement)
    }

    fn judged(&mut self, problem: &mut dyn SearchProblem, x: &[f64]) -> Judgement {
        self.work.judgements += 1;
        problem.judge(x)
    }

    fn slopes_at(&mut self, problem: &mut dyn SearchProblem, x: &[f64]) -> Slopes {
        self.work.slopes += 1;
        problem.slopes(x)
    }
}

/// True if the margins are meaningful.
pub(super) fn is_usable(judgement: &Judgement) -> bool {
    judgement.stable && judgement.worst_margin_db.is_finite() && judgement.objective_db.is_finite()
}

/// Largest magnitude.
fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |greatest, value| greatest.max(value.abs()))
}
