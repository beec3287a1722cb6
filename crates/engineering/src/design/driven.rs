//! A design whose steps on the nonlinear rig are held against what is required in time: where they
//! miss it, the search goes on with what the rig added to the steps of the linear loop.
//!
//! ```text
//! design -> trial on the nonlinear rig -> misses -> search with linear steps + what the rig added -> trial -> the better one
//! ```

use phea_dynamics::watch::{Watch, within};
use phea_qft::design::{Design, DesignProblem, DesignStatus};

use super::added_by_rig::added;
use super::by_steps::{AimedSteps, SteppedPlants, by_steps, shortened};
use super::command_of_steps::{CommandDepth, command_of_steps};
use super::relaxed::relaxations;
use super::search::{found, rank};
use super::step_aim::StepAim;
use super::{
    AuditedController, DesignError, DesignRun, ProjectDesign, continuous_as_sampled, tried_design,
    unless_stopped,
};
use crate::audit::try_to_prove;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::side_by_side::{all_cores, both};
use crate::source::Source;
use crate::trial::Agreement;

/// How often the search goes on as long as the nonlinear rig misses what is required.
const TRIES: usize = 6;

/// A design, and its twin for the continuous loop.
pub(super) struct ContinuousTwin {
    /// The design.
    of: Design,
    /// The one that was made without samples, as [`continuous_as_sampled`] finds it.
    found: Result<Option<AuditedController>, DesignError>,
}

impl ContinuousTwin {
    /// The twin of this design; `None` of another one.
    pub(super) fn of(self, design: &Design) -> Option<Result<Option<AuditedController>, DesignError>> {
        (self.of == *design).then_some(self.found)
    }
}

/// The best design with its trial; without one where the watch stops it before. Also the design
/// made without samples, which is looked for during the trial where that leads to no other design.
pub(super) fn found_and_tried(
    (source, setup): (&dyn Source, &Setup<'_>),
    given: &RobustProblem,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(DesignRun, ProjectDesign, Option<ContinuousTwin>), DesignError> {
    let plants = SteppedPlants::default();
    let first = StepAim::first(setup, given);
    let (aim, run, told) = found(setup, (given, first, &plants), seed, &mut within(&mut *watch, [0.0, 0.5]))?;
    let (told, twin) =
        with_trial_and_twin((source, setup), &run.problem, told, &mut within(&mut *watch, [0.5, 0.6]))?;
    let mut best = (run, told);
    // the design that the next one begins from, unless that is the best one
    let mut latest: Option<(DesignRun, ProjectDesign)> = None;
    let aimed = AimedSteps { given, aim, added: &[], plants: &plants };
    let mut known = added(&best.1, &[]);
    for index in 0..TRIES {
        let share = [index, index + 1].map(|done| 0.6 + 0.3 * done as f64 / TRIES as f64);
        let before = latest.as_ref().unwrap_or(&best);
        // what the rig satisfies and a limit does not, a search with its runs may
        let lacks_a_limit = latest.as_ref().is_some_and(|(_, told)| rank(told).0 > 0);
        if !misses(&before.1) && !lacks_a_limit {
            break;
        }
        let aimed = AimedSteps { added: &known, ..aimed };
        match next_design((source, setup), aimed, before, &mut within(&mut *watch, share)) {
            Ok(Some(found)) => {
                known = added(&found.1, &known);
                latest = if is_better(&found.1, &best.1) {
                    best = found;
                    None
                } else {
                    Some(found)
                };
            }
            Err(DesignError::Stopped(_)) => best.1.stopped = true,
            // what was found before remains
            Ok(None) | Err(_) => break,
        }
        if best.1.stopped {
            break;
        }
    }
    let aimed = AimedSteps { added: &known, ..aimed };
    let (run, mut told) = shorter((source, setup), aimed, best, &mut within(&mut *watch, [0.9, 0.94]));
    if told.command_of_steps.is_none() {
        told.command_of_steps = command_of_steps(setup, &told, &plants, CommandDepth::Whole);
    }
    // a design that was led by its steps is not proven on the way
    if told.designed.view.proof.is_none() {
        let problem = told.designed.problem.clone();
        let view = &mut told.designed.view;
        let proof = unless_stopped(&mut told.stopped, || {
            Ok(Some(try_to_prove(&problem, view, &mut within(&mut *watch, [0.94, 0.97]))?))
        });
        proof?;
    }
    match relaxations(setup, aimed, (&run, &told), &mut within(watch, [0.97, 1.0])) {
        Ok(found) => told.relaxations = found,
        Err(DesignError::Stopped(_)) => told.stopped = true,
        Err(error) => return Err(error),
    }
    Ok((run, told, twin))
}

/// A design with the trial of its controller, and meanwhile with what was made without samples.
fn with_trial_and_twin(
    (source, setup): (&dyn Source, &Setup<'_>),
    problem: &DesignProblem,
    told: ProjectDesign,
    watch: Watch<'_>,
) -> Result<(ProjectDesign, Option<ContinuousTwin>), DesignError> {
    // a rig that misses what is required in time leads to another design
    let is_required = told.designed.problem.in_time.iter().any(|one| one.follows);
    if told.stopped || is_required || all_cores().at_once == 1 {
        return Ok((with_trial((source, setup), told, watch)?, None));
    }
    let untried = told.clone();
    let (found, told) = both(
        watch,
        0.5,
        |watch| continuous_as_sampled((source, setup), problem, &untried, watch),
        |watch| with_trial((source, setup), told, watch),
    );
    Ok((told?, Some(ContinuousTwin { of: untried.design, found })))
}

/// The design without zeros and poles that do next to nothing, where the nonlinear rig satisfies
/// what is required with it too; as it is otherwise.
fn shorter(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, told): (DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> (DesignRun, ProjectDesign) {
    if told.stopped || !told.is_met() || misses(&told) {
        return (run, told);
    }
    let found = shortened(setup, aimed, (&run, &told), &mut within(&mut *watch, [0.0, 0.7]));
    // what was found before remains
    let found = found.and_then(|found| {
        let Some((run, shorter)) = found else { return Ok(None) };
        Ok(Some((run, with_trial((source, setup), shorter, &mut within(watch, [0.7, 1.0]))?)))
    });
    match found {
        Ok(Some((run, tried))) if !tried.stopped && agrees_as_well(&tried, &told) && !misses(&tried) => {
            (run, tried)
        }
        Ok(Some((_, ProjectDesign { stopped: true, .. }))) | Err(DesignError::Stopped(_)) => {
            (run, ProjectDesign { stopped: true, ..told })
        }
        Ok(_) | Err(_) => (run, told),
    }
}

/// True where the nonlinear rig agrees with one design as with another; settling times that satisfy
/// what is required need not be those of the linear loop.
fn agrees_as_well(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    one.agreement() <= other.agreement().max(Agreement::AgreesButForSettling)
}

/// True where the nonlinear rig misses what is required under a design that is met.
fn misses(told: &ProjectDesign) -> bool {
    let is_met = told.design.status == DesignStatus::Met && !told.stopped;
    is_met && told.misses_on_rig()
}

/// A design with what the rig is known to add to its steps, and its trial; `None` where the steps
/// of the one before do not lead.
fn next_design(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, told): &(DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let found = by_steps(setup, aimed, (run, told), &mut within(&mut *watch, [0.0, 0.7]))?;
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

/// True where one design is as good as another over frequency, and its worst run is nearer to what
/// is required.
fn is_better(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    !one.stopped && rank(one).0 <= rank(other).0 && one.worst_run() < other.worst_run()
}
