//! Comparison of a design's steps on the nonlinear rig with the requirement in time: if they miss
//! it, the search continues with the contribution of the rig to the steps of the linear loop.
//!
//! ```text
//! design -> trial on the nonlinear rig -> misses -> search with linear steps + contribution of the rig -> trial -> the better one
//! ```

use phea_dynamics::watch::{Watch, within};
use phea_qft::design::{Design, DesignProblem, DesignStatus};

use super::added_by_rig::{AddedByRig, added};
use super::by_steps::{AimedSteps, SearchStarts, SteppedPlants, by_steps, shortened, simpler};
use super::command_of_steps::with_command_of_steps;
use super::relaxed::relaxations;
use super::search::{found, rank};
use super::step_aim::StepAim;
use super::{
    AuditedController, DesignError, DesignPart, DesignRun, ProjectDesign, continuous_as_sampled,
    trial_design, unless_stopped,
};
use crate::audit::prove_claims;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::side_by_side::{all_cores, both};
use crate::source::Source;
use crate::trial::Agreement;

/// Largest number of continuations while the nonlinear rig misses the requirement.
const TRIES: usize = 6;

/// Largest number of continuations if the rig satisfies the requirement but lacks room.
const TRIES_FOR_ROOM: usize = 4;
/// Least relative improvement of the worst run by a useful continuation; this many useless ones in
/// succession are the last.
const GAIN: f64 = 0.05;
const IN_VAIN: usize = 2;

/// A design with its twin for the continuous loop.
pub(super) struct ContinuousTwin {
    /// The design.
    of: Design,
    /// The twin that was made without sampling, as found by [`continuous_as_sampled`].
    found: Result<Option<AuditedController>, DesignError>,
}

impl ContinuousTwin {
    /// Twin of this design; `None` for another one.
    pub(super) fn of(self, design: &Design) -> Option<Result<Option<AuditedController>, DesignError>> {
        (self.of == *design).then_some(self.found)
    }
}

/// The best design with its trial; without a trial if `watch` cancels before. Also the design made
/// without sampling, which is searched during the trial if that leads to no other design.
pub(super) fn found_and_tried(
    (source, setup): (&dyn Source, &Setup<'_>),
    given: &RobustProblem,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(DesignRun, ProjectDesign, Option<ContinuousTwin>), DesignError> {
    let plants = SteppedPlants::default();
    let first = StepAim::first(setup, given);
    let begins = (given, first, &plants);
    let (mut driven, mut twin) =
        simplest((source, setup), begins, seed, &mut within(&mut *watch, [0.0, 0.7]))?;
    // without the limit that leads away from a loop without gain, the search takes another path
    if first != StepAim::AS_REQUIRED && !driven.project_design.is_stopped() && misses(&driven.project_design)
    {
        let begins = (given, StepAim::AS_REQUIRED, &plants);
        match simplest((source, setup), begins, seed, &mut within(&mut *watch, [0.7, 0.9])) {
            Ok((other, _)) if is_better(&other.project_design, &driven.project_design) => {
                (driven, twin) = (other.with_missed(&driven.project_design), None);
            }
            Err(DesignError::Stopped(_)) => driven.project_design.leave(DesignPart::Search),
            // the earlier result remains
            Ok(_) | Err(_) => {}
        }
    }
    let DrivenDesign { aim, run, project_design, known } = driven;
    let best = (run, project_design);
    let aimed = AimedSteps { given, aim, added: &known, plants: &plants, from: SearchStarts::Nearest };
    let (run, mut project_design) =
        shorter((source, setup), aimed, best, &mut within(&mut *watch, [0.9, 0.94]));
    if project_design.command_of_steps.is_none() {
        project_design = with_command_of_steps((setup, project_design), &plants, watch)?;
    }
    // a design led by its steps is not proven before the end
    if project_design.designed.view.proof.is_none() {
        let problem = project_design.designed.problem.clone();
        let view = &mut project_design.designed.view;
        unless_stopped(&mut project_design.unfinished, DesignPart::Proof, || {
            Ok(Some(prove_claims(&problem, view, &mut within(&mut *watch, [0.94, 0.97]))?))
        })?;
    }
    let mut unfinished = std::mem::take(&mut project_design.unfinished);
    let twin = twin.filter(|twin| twin.of == project_design.design);
    let is_to_be_found =
        twin.is_none() && run.problem.timing.sample_time_s.is_some() && !project_design.is_stopped();
    let (own_twin, found) = both(
        &mut within(watch, [0.97, 1.0]),
        0.5,
        |watch| {
            is_to_be_found
                .then(|| continuous_as_sampled((source, setup), &run.problem, &project_design, watch))
        },
        |watch| {
            unless_stopped(&mut unfinished, DesignPart::Relaxations, || {
                relaxations(setup, aimed, (&run, &project_design), watch).map(Some)
            })
        },
    );
    let relaxations = found?.unwrap_or_default();
    let twin = own_twin.map(|found| ContinuousTwin { of: project_design.design.clone(), found }).or(twin);
    Ok((run, ProjectDesign { unfinished, relaxations, ..project_design }, twin))
}

/// A design with its trial, and the contribution of its runs to the steps of the linear loop.
struct DrivenDesign {
    aim: StepAim,
    run: DesignRun,
    project_design: ProjectDesign,
    known: Vec<AddedByRig>,
}

impl DrivenDesign {
    /// The design together with a shorter structure whose runs miss the requirement.
    fn with_missed(mut self, shorter: &ProjectDesign) -> DrivenDesign {
        self.project_design.note_missed_on_rig(shorter);
        self
    }
}

/// Best design to which a search with this aim leads: the simplest structure by its steps, unless
/// the nonlinear rig misses the requirement with that and misses less with another.
fn simplest(
    (source, setup): (&dyn Source, &Setup<'_>),
    (given, first, plants): (&RobustProblem, StepAim, &SteppedPlants),
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(DrivenDesign, Option<ContinuousTwin>), DesignError> {
    let rig = (source, setup);
    let (aim, run, project_design) =
        found(setup, (given, first, plants), seed, &mut within(&mut *watch, [0.0, 0.5]))?;
    let aimed = AimedSteps { given, aim, added: &[], plants, from: SearchStarts::Nearest };
    let (simple, project_design) =
        with_simpler(setup, aimed, (&run, project_design), &mut within(&mut *watch, [0.5, 0.55]));
    let Some(simple) = simple else {
        return driven(rig, aimed, (run, project_design), &mut within(watch, [0.55, 1.0]));
    };
    let (of_simple, twin) = driven(rig, aimed, simple, &mut within(&mut *watch, [0.55, 0.8]))?;
    if of_simple.project_design.is_stopped() || !misses(&of_simple.project_design) {
        return Ok((of_simple, twin));
    }
    let (other, _) = driven(rig, aimed, (run, project_design), &mut within(watch, [0.8, 1.0]))?;
    Ok(match is_better(&other.project_design, &of_simple.project_design) {
        true => (other.with_missed(&of_simple.project_design), None),
        false => (of_simple, twin),
    })
}

/// The simplest structure that is as good a design by its steps, if there is one, and the design
/// itself.
fn with_simpler(
    setup: &Setup<'_>,
    aimed: AimedSteps<'_>,
    (run, mut project_design): (&DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> (Option<(DesignRun, ProjectDesign)>, ProjectDesign) {
    if project_design.is_stopped() || !project_design.is_met() {
        return (None, project_design);
    }
    let found = simpler(setup, aimed, (run, &project_design), watch);
    if matches!(found, Err(DesignError::Stopped(_))) {
        project_design.leave(DesignPart::Search);
    }
    // the earlier result remains
    (found.ok().flatten(), project_design)
}

/// A design with its trial and, as long as the trial misses the requirement, the designs that
/// follow from the contributions of the runs: the best of them.
fn driven(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, project_design): (DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> Result<(DrivenDesign, Option<ContinuousTwin>), DesignError> {
    let problem = run.problem.clone();
    let (project_design, twin) = with_trial_and_twin(
        (source, setup),
        &problem,
        project_design,
        &mut within(&mut *watch, [0.0, 0.25]),
    )?;
    let mut best = (run, project_design);
    // the design from which the next one begins, unless it is the best one
    let mut latest: Option<(DesignRun, ProjectDesign)> = None;
    let mut known = added(&best.1, &[]);
    let (mut nearest, mut in_vain) = (best.1.worst_run_with_room(), 0);
    let mut for_room = 0;
    for index in 0..TRIES {
        let fraction = [index, index + 1].map(|done| 0.25 + 0.75 * done as f64 / TRIES as f64);
        let before = latest.as_ref().unwrap_or(&best);
        // a search with these runs may satisfy a limit that the design misses although the rig
        // satisfies the requirement
        let lacks_a_limit = latest.as_ref().is_some_and(|(_, project_design)| rank(project_design).0 > 0);
        let suffices = best.1.worst_run() <= 1.0;
        if !misses(&before.1) && !lacks_a_limit || in_vain > IN_VAIN || for_room >= TRIES_FOR_ROOM {
            break;
        }
        for_room += usize::from(suffices);
        let from = if in_vain == IN_VAIN { SearchStarts::Others } else { SearchStarts::Nearest };
        let aimed = AimedSteps { added: &known, from, ..aimed };
        match next_design((source, setup), aimed, before, &mut within(&mut *watch, fraction)) {
            Ok(Some(found)) => {
                known = added(&found.1, &known);
                if found.1.is_stopped() {
                    best.1.leave(DesignPart::Search);
                }
                let gains = found.1.worst_run_with_room() < (1.0 - GAIN) * nearest;
                in_vain = if gains || found.1.worst_run_with_room() <= 1.0 { 0 } else { in_vain + 1 };
                nearest = nearest.min(found.1.worst_run_with_room());
                latest = if is_better(&found.1, &best.1) {
                    best = found;
                    None
                } else {
                    Some(found)
                };
            }
            Err(DesignError::Stopped(_)) => best.1.leave(DesignPart::Search),
            // the earlier result remains
            Ok(None) | Err(_) => break,
        }
        if best.1.is_stopped() {
            break;
        }
    }
    let (run, project_design) = best;
    Ok((DrivenDesign { aim: aimed.aim, run, project_design, known }, twin))
}

/// A design with the trial of its controller, and concurrently with the design made without
/// sampling.
fn with_trial_and_twin(
    (source, setup): (&dyn Source, &Setup<'_>),
    problem: &DesignProblem,
    project_design: ProjectDesign,
    watch: Watch<'_>,
) -> Result<(ProjectDesign, Option<ContinuousTwin>), DesignError> {
    // a rig that misses a requirement in time leads to another design
    let is_required = project_design.designed.problem.in_time.iter().any(|one| one.follows);
    if project_design.is_stopped() || is_required || all_cores().at_once == 1 {
        return Ok((with_trial((source, setup), project_design, watch)?, None));
    }
    let untried = project_design.clone();
    let (found, project_design) = both(
        watch,
        0.5,
        |watch| continuous_as_sampled((source, setup), problem, &untried, watch),
        |watch| with_trial((source, setup), project_design, watch),
    );
    Ok((project_design?, Some(ContinuousTwin { of: untried.design, found })))
}

/// The design without zeros and poles that have next to no effect, if the nonlinear rig satisfies
/// the requirement with it too; otherwise the unchanged design.
fn shorter(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, project_design): (DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> (DesignRun, ProjectDesign) {
    if project_design.is_stopped() || !project_design.is_met() || misses(&project_design) {
        return (run, project_design);
    }
    let found = shortened(setup, aimed, (&run, &project_design), &mut within(&mut *watch, [0.0, 0.7]));
    // the earlier result remains
    let found = found.and_then(|found| {
        let Some((run, shorter)) = found else { return Ok(None) };
        Ok(Some((run, with_trial((source, setup), shorter, &mut within(watch, [0.7, 1.0]))?)))
    });
    match found {
        Ok(Some((_, searched))) if searched.is_stopped() => stopped_in_search(run, project_design),
        Ok(Some((run, searched))) if agrees_as_well(&searched, &project_design) && !misses(&searched) => {
            (run, searched)
        }
        Err(DesignError::Stopped(_)) => stopped_in_search(run, project_design),
        Ok(_) | Err(_) => (run, project_design),
    }
}

/// A design whose continued search was cancelled.
fn stopped_in_search(run: DesignRun, mut project_design: ProjectDesign) -> (DesignRun, ProjectDesign) {
    project_design.leave(DesignPart::Search);
    (run, project_design)
}

/// True if the nonlinear rig agrees with one design as well as with another; settling times that
/// satisfy the requirement need not be those of the linear loop.
fn agrees_as_well(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    one.agreement() <= other.agreement().max(Agreement::AgreesButForSettling)
}

/// True if the nonlinear rig misses the requirement under a design that is met, or satisfies it
/// without room for the plants between the simulated ones.
fn misses(project_design: &ProjectDesign) -> bool {
    let is_met = project_design.design.status == DesignStatus::Met && !project_design.is_stopped();
    is_met && project_design.misses_on_rig()
}

/// A design with the known contribution of the rig to its steps, and its trial; `None` if the steps
/// of the one before lead to none.
fn next_design(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, project_design): &(DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let found = by_steps(setup, aimed, (run, project_design), &mut within(&mut *watch, [0.0, 0.7]))?;
    let Some((run, project_design)) = found else { return Ok(None) };
    Ok(Some((run, with_trial((source, setup), project_design, &mut within(watch, [0.7, 1.0]))?)))
}

/// A design with the trial of its controller; the trial is absent after cancellation, and without a
/// rig.
fn with_trial(
    (source, setup): (&dyn Source, &Setup<'_>),
    project_design: ProjectDesign,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    if setup.project.actuator.is_none() {
        return Ok(project_design);
    }
    let mut unfinished = project_design.unfinished.clone();
    let trial = unless_stopped(&mut unfinished, DesignPart::Trial, || {
        trial_design(source, setup.project, &project_design, watch)
    })?;
    Ok(ProjectDesign { unfinished, trial, ..project_design })
}

/// True if one design is as good as another over frequency and its worst run is nearer to the
/// requirement; if the runs of both satisfy it, the worst run with room for the plants between
/// counts.
fn is_better(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    let runs = |project_design: &ProjectDesign| {
        (project_design.worst_run().max(1.0), project_design.worst_run_with_room())
    };
    !one.is_stopped() && rank(one).0 <= rank(other).0 && runs(one) < runs(other)
}
