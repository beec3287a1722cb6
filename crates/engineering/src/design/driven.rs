//! A design whose steps on the nonlinear rig are held against what is required in time: where they
//! miss it, the search aims lower by as much, once.
//!
//! ```text
//! design -> trial on the nonlinear rig -> misses by r -> design for what is required over r -> trial -> the better one
//! ```

use phea_dynamics::watch::{Watch, within};
use phea_qft::design::DesignStatus;

use super::search::{found, rank};
use super::step_aim::StepAim;
use super::{DesignError, DesignRun, ProjectDesign, tried_design, unless_stopped};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::source::Source;
use crate::trial::{HeldRequirement, Trial};

/// A design with its trial; with neither where the watch stops it before.
pub(super) fn found_and_tried(
    (source, setup): (&dyn Source, &Setup<'_>),
    given: &RobustProblem,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(DesignRun, ProjectDesign), DesignError> {
    let (aim, run, told) =
        found(setup, (given, StepAim::AS_REQUIRED), seed, &mut within(&mut *watch, [0.0, 0.5]))?;
    let mut told = with_trial((source, setup), told, &mut within(&mut *watch, [0.5, 0.6]))?;
    let is_met = told.design.status == DesignStatus::Met;
    let missed = told.trial.as_ref().and_then(furthest).filter(|_| !told.stopped && is_met);
    let Some(stricter) = missed.and_then(|held| aim.stricter_by(&held.wish, &held.reached)) else {
        return Ok((run, told));
    };
    let again = found(setup, (given, stricter), seed, &mut within(&mut *watch, [0.6, 0.9]));
    let again = again.and_then(|(_, run, found)| {
        Ok((run, with_trial((source, setup), found, &mut within(watch, [0.9, 1.0]))?))
    });
    match again {
        Ok((run, found)) if is_better(&found, &told) => Ok((run, found)),
        Ok((_, found)) => {
            told.stopped = found.stopped;
            Ok((run, told))
        }
        Err(DesignError::Stopped(_)) => {
            told.stopped = true;
            Ok((run, told))
        }
        // what was found before remains
        Err(_) => Ok((run, told)),
    }
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
