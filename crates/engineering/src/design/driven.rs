//! A design whose steps on the nonlinear rig are held against what is required in time: where they
//! miss it, the search aims lower by as much, from the design that was found.
//!
//! ```text
//! design -> trial on the nonlinear rig -> misses by r -> design for what is required over r -> trial -> the better one
//! ```

use phea_dynamics::watch::{Watch, within};
use phea_qft::design::DesignStatus;

use super::by_steps::by_steps;
use super::search::{found, rank};
use super::step_aim::StepAim;
use super::{DesignError, DesignRun, ProjectDesign, tried_design, unless_stopped};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;
use crate::trial::{HeldRequirement, Trial};

/// A way to a design with a stricter aim.
#[derive(Clone, Copy)]
enum Way {
    /// From the one before, by its steps.
    BySteps,
    /// By a search from the beginning.
    Anew,
}

/// The ways that are tried in turn as long as the nonlinear rig misses what is required.
const WAYS: [Way; 4] = [Way::BySteps, Way::BySteps, Way::Anew, Way::BySteps];

/// A design with its trial; with neither where the watch stops it before.
pub(super) fn found_and_tried(
    (source, setup): (&dyn Source, &Setup<'_>),
    given: &RobustProblem,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(DesignRun, ProjectDesign), DesignError> {
    let (aim, run, told) =
        found(setup, (given, StepAim::AS_REQUIRED), seed, &mut within(&mut *watch, [0.0, 0.5]))?;
    let told = with_trial((source, setup), told, &mut within(&mut *watch, [0.5, 0.6]))?;
    let mut best = (run, told);
    // the design that the next one is stricter than, unless that is the best one
    let (mut aim, mut latest): (StepAim, Option<(DesignRun, ProjectDesign)>) = (aim, None);
    for (index, way) in WAYS.into_iter().enumerate() {
        let share = [index, index + 1].map(|done| 0.6 + 0.4 * done as f64 / WAYS.len() as f64);
        let before = latest.as_ref().unwrap_or(&best);
        let Some(stricter) = stricter_aim(aim, &before.1) else { break };
        let part = &mut within(&mut *watch, share);
        match stricter_design((source, setup), (given, stricter), (before, way, seed), part) {
            Ok(Some(found)) => {
                let is_better = is_better(&found.1, &best.1);
                aim = stricter;
                latest = if is_better {
                    best = found;
                    None
                } else {
                    Some(found)
                };
            }
            Err(DesignError::Stopped(_)) => best.1.stopped = true,
            // what was found before remains
            Ok(None) | Err(_) => {}
        }
        if best.1.stopped {
            break;
        }
    }
    Ok(best)
}

/// An aim that is stricter by what the nonlinear rig misses under a design that is met; `None`
/// where it misses nothing that ends.
fn stricter_aim(aim: StepAim, told: &ProjectDesign) -> Option<StepAim> {
    let is_met = told.design.status == DesignStatus::Met && !told.stopped;
    let missed = told.trial.as_ref().and_then(furthest).filter(|_| is_met)?;
    aim.stricter_by(&missed.wish, &missed.reached)
}

/// A design with a stricter aim and its trial; `None` where the steps of the one before do not
/// lead.
fn stricter_design(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: (&RobustProblem, StepAim),
    ((run, told), way, seed): (&(DesignRun, ProjectDesign), Way, Option<u32>),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let mut searching = within(&mut *watch, [0.0, 0.7]);
    let found = match way {
        Way::BySteps => by_steps(setup, aimed, (run, told), &mut searching)?,
        Way::Anew => found(setup, aimed, seed, &mut searching).map(|(_, run, told)| Some((run, told)))?,
    };
    drop(searching);
    let Some((run, told)) = found else { return Ok(None) };
    Ok(Some((run, with_trial((source, setup), told, &mut within(watch, [0.7, 1.0]))?)))
}

/// A design with the trial of its controller; absent once the watch has stopped it.
fn with_trial(
    (source, setup): (&dyn Source, &Setup<'_>),
    told: ProjectDesign,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    let mut stopped = told.stopped;
    let trial = unless_stopped(&mut stopped, || tried_design(source, setup.project, &told, watch))?;
    Ok(ProjectDesign { stopped, trial, ..told })
}

/// The requirement that a run misses by most, among those that end: no design is led to the end of
/// a step that does not settle.
fn furthest(trial: &Trial) -> Option<&HeldRequirement> {
    let missed = trial.runs.iter().flat_map(|run| &run.requirements).filter(|held| !held.is_satisfied);
    let finite = missed.filter(|held| excess(held).is_finite());
    finite.max_by(|one, other| excess(one).total_cmp(&excess(other)))
}

fn excess(held: &HeldRequirement) -> f64 {
    held.wish.excess(&held.reached)
}

/// True where one design is as good as another over frequency, and its worst run is nearer to what
/// is required.
fn is_better(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    let worst = |told: &ProjectDesign| {
        let runs = told.trial.iter().flat_map(|trial| &trial.runs);
        runs.flat_map(|run| &run.requirements).map(excess).fold(0.0, f64::max)
    };
    !one.stopped && rank(one).0 <= rank(other).0 && worst(one) < worst(other)
}
