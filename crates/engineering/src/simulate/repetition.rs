//! Repetition of a run whose errors may be visible, at a tenth of the tolerance until its metrics
//! agree.

use phea_dynamics::portable;
use phea_dynamics::simulation::{Amplification, Status, StepCounts};

use super::check::{FOLD, LARGEST_PART};
use super::metric::Metric;
use super::metrics::Measured;
use super::{Cause, Metrics, RunStatus, StoppedRun, Window};

/// Smallest tolerance of a pass: below it, rounding errors are visible.
pub const SMALLEST_TOLERANCE: f64 = 1e-10;

/// Number of passes that must agree with the one before, if errors as large as their tolerance may
/// still be visible: two that agree may both be wrong.
const TRUSTED: u32 = 2;

/// Largest difference of the last passes with which a run counts as a result.
const LARGEST_DOUBT: f64 = 0.1;

/// Tolerance and start of a pass over a scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassPlan {
    /// Tolerance of the integration.
    pub tolerance: f64,
    /// True if the value of each state starts a few rounding errors away.
    pub moved: bool,
}

impl PassPlan {
    /// True for the pass at the tolerance of the project.
    pub fn is_first(&self, tolerance: f64) -> bool {
        self.tolerance == tolerance && !self.moved
    }
}

/// A pass that was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Tolerance and start of the pass.
    pub plan: PassPlan,
    /// Work of the integration.
    pub work: StepCounts,
    /// Early end of the pass, if it did not complete.
    pub stopped: Option<StoppedRun>,
}

/// Agreement of the passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassAgreement {
    /// The last two passes agree within a thousandth.
    Agreed,
    /// The last two passes differ, and no smaller tolerance is used.
    Apart,
    /// A start moved by a few rounding errors gives another result: no solver determines it.
    Undetermined,
    /// A pass ended early; the one before is reported.
    Stopped,
}

/// All passes of a run that was repeated.
#[derive(Clone, Debug, PartialEq)]
pub struct Repetition {
    /// Passes in order.
    pub passes: Vec<Pass>,
    /// Agreement of the passes.
    pub agreement: PassAgreement,
    /// Largest difference between the last two passes that were compared; `None` if they have no
    /// number in common.
    pub spread: Option<PassSpread>,
}

/// Largest difference between two passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassSpread {
    /// Index of the window, from 0, and metric; `None` for the force of a run without metrics.
    pub of: Option<(usize, Metric)>,
    /// Values in the earlier and the later pass.
    pub values: [Measured; 2],
    /// Difference divided by the metric; divided by the step for an overshoot, by the largest
    /// deviation of the window for a steady-state error. Infinite if one pass has no such number.
    pub part: f64,
}

/// The results by which passes are compared.
#[derive(Clone, Debug)]
pub struct PassResult {
    /// Status of the integration.
    pub status: Status,
    /// Work of the integration.
    pub work: StepCounts,
    /// Largest amplification of errors; `None` if none grew.
    pub amplification: Option<Amplification>,
    /// True if the command swings from end to end of its range: such a run separates from its
    /// neighbours.
    pub swings: bool,
    /// Metrics of each window.
    pub metrics: Vec<(Window, Metrics)>,
    /// Force at some times of the run, N.
    pub force_n: Vec<f64>,
}

impl PassResult {
    /// True if errors as large as a tolerance may be visible.
    fn grows(&self, tolerance: f64) -> bool {
        self.amplification.is_some_and(|grown| grown.may_show_errors(tolerance))
    }

    fn pass(&self, plan: PassPlan) -> Pass {
        Pass { plan, work: self.work, stopped: StoppedRun::of(self.status) }
    }

    /// Largest difference from another pass: of the metrics, or of the forces if no window has a
    /// number.
    pub fn spread(&self, other: &PassResult) -> Option<PassSpread> {
        spread(self, other)
    }
}

impl Repetition {
    /// True if `watch` cancelled a pass.
    pub fn was_cancelled(&self) -> bool {
        self.passes
            .iter()
            .any(|pass| pass.stopped.is_some_and(|stopped| stopped.status == RunStatus::Cancelled))
    }

    /// True if there is a result: rounding does not decide it, and the last passes agree within a
    /// tenth.
    pub fn is_determined(&self) -> bool {
        let near = self.spread.is_some_and(|spread| spread.part <= LARGEST_DOUBT);
        match self.agreement {
            PassAgreement::Agreed | PassAgreement::Stopped => true,
            PassAgreement::Apart => near,
            PassAgreement::Undetermined => false,
        }
    }

    /// Number of steps of all passes.
    pub fn steps(&self) -> u64 {
        self.passes.iter().map(|pass| pass.work.steps).sum()
    }
}

/// Result to be reported, after the first pass at a tolerance. If its errors may be visible,
/// further passes follow, each at a tenth of the tolerance of the one before, until two agree; the
/// last complete one is returned. If even rounding errors may be visible, or no two passes agree, a
/// pass from a start moved by rounding errors follows.
///
/// # Errors
/// The error of a pass.
pub fn repeated<R, E>(
    (tolerance, first): (f64, R),
    result: impl Fn(&R) -> PassResult,
    mut again: impl FnMut(PassPlan) -> Result<R, E>,
) -> Result<(R, f64, Option<Repetition>), E> {
    let (mut kept, mut seen, mut tolerance) = (result(&first), first, tolerance);
    if !(kept.grows(tolerance) || kept.swings) || kept.status != Status::Completed {
        return Ok((seen, tolerance, None));
    }
    let plan = |tolerance, moved| PassPlan { tolerance, moved };
    let mut passes = vec![kept.pass(plan(tolerance, false))];
    let (first, mut fold, mut agreed) = (tolerance, 1.0, 0);
    let (mut agreement, mut found) = (PassAgreement::Apart, None);
    while agreement == PassAgreement::Apart && tolerance > SMALLEST_TOLERANCE {
        fold *= FOLD;
        let tighter = portable::rounded(first / fold, 12).max(SMALLEST_TOLERANCE);
        let next = again(plan(tighter, false))?;
        let later = result(&next);
        passes.push(later.pass(plan(tighter, false)));
        if later.status != Status::Completed {
            agreement = PassAgreement::Stopped;
            break;
        }
        found = kept.spread(&later);
        agreed = if found.is_none_or(|found| found.part <= LARGEST_PART) { agreed + 1 } else { 0 };
        let needed = if tighter > SMALLEST_TOLERANCE && later.grows(tighter) { TRUSTED } else { 1 };
        if agreed >= needed {
            agreement = PassAgreement::Agreed;
        }
        (kept, seen, tolerance) = (later, next, tighter);
    }
    let rounded = kept.amplification.is_some_and(|grown| grown.may_show_rounding());
    if agreement == PassAgreement::Apart || (rounded && agreement == PassAgreement::Agreed) {
        let moved = result(&again(plan(tolerance, true))?);
        passes.push(moved.pass(plan(tolerance, true)));
        let moved = kept.spread(&moved);
        if moved.is_some_and(|moved| moved.part > LARGEST_PART) {
            (agreement, found) = (PassAgreement::Undetermined, moved);
        }
    }
    Ok((seen, tolerance, Some(Repetition { passes, agreement, spread: found })))
}

/// A state whose values are moved by a few rounding errors, each in its own direction.
pub fn moved(start: &mut [f64], scales: &[f64]) {
    for (place, (state, scale)) in start.iter_mut().zip(scales).enumerate() {
        let towards = if place.is_multiple_of(2) { 4.0 } else { -4.0 };
        *state += towards * f64::EPSILON * (state.abs() + scale);
    }
}

/// Largest difference between the metrics of two passes; between their forces if no window has a
/// number.
fn spread(one: &PassResult, other: &PassResult) -> Option<PassSpread> {
    let windows = one.metrics.iter().zip(&other.metrics).enumerate();
    let of_metrics = windows.flat_map(|(place, ((window, one), (_, other)))| {
        Metric::ALL.into_iter().filter_map(move |metric| {
            let (here, there) = (one.get(metric), other.get(metric));
            let part = match (here, there) {
                (Err(_), Err(_)) => return None,
                (Ok(here), Ok(there)) => {
                    part((here - there).abs(), magnitude(metric, window, [one, other], [here, there]))
                }
                _ => f64::INFINITY,
            };
            Some(PassSpread { of: Some((place, metric)), values: [here, there], part })
        })
    });
    let largest = of_metrics.max_by(|one, other| one.part.total_cmp(&other.part));
    largest.or_else(|| of_forces(&one.force_n, &other.force_n))
}

fn of_forces(one: &[f64], other: &[f64]) -> Option<PassSpread> {
    let all = one.iter().chain(other);
    let peak = all.fold(0.0_f64, |peak, force| peak.max(force.abs()));
    let pairs = one.iter().zip(other);
    let (here, there) = pairs.max_by(|(a, b), (c, d)| (*a - *b).abs().total_cmp(&(*c - *d).abs()))?;
    let part = part((here - there).abs(), peak);
    Some(PassSpread { of: None, values: [Ok(*here), Ok(*there)], part })
}

fn part(difference: f64, magnitude: f64) -> f64 {
    if difference > 0.0 { difference / magnitude } else { 0.0 }
}

/// Reference value to which a difference of a metric is related.
fn magnitude(metric: Metric, window: &Window, both: [&Metrics; 2], values: [f64; 2]) -> f64 {
    let own = values[0].abs().max(values[1].abs());
    match metric {
        Metric::Overshoot => own.max(100.0),
        Metric::SteadyStateError => {
            let step = match window.cause {
                Cause::ReferenceStep { from_n, to_n } => (to_n - from_n).abs(),
                _ => 0.0,
            };
            let peaks = both.iter().flat_map(|one| [one.disturbance_peak_n, one.tracking_error_peak_n]);
            peaks.flatten().fold(own.max(step), f64::max)
        }
        Metric::RiseTime
        | Metric::SettlingTime
        | Metric::DisturbancePeak
        | Metric::TrackingErrorPeak
        | Metric::ForcePeak
        | Metric::ControlPeak
        | Metric::ControlRms => own,
    }
}
