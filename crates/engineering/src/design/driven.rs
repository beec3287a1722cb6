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
    tried_design, unless_stopped,
};
use crate::audit::try_to_prove;
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
    if first != StepAim::AS_REQUIRED && !driven.told.is_stopped() && misses(&driven.told) {
        let begins = (given, StepAim::AS_REQUIRED, &plants);
        match simplest((source, setup), begins, seed, &mut within(&mut *watch, [0.7, 0.9])) {
            Ok((other, _)) if is_better(&other.told, &driven.told) => {
                (driven, twin) = (other.with_missed(&driven.told), None);
            }
            Err(DesignError::Stopped(_)) => driven.told.leave(DesignPart::Search),
            // the earlier result remains
            Ok(_) | Err(_) => {}
        }
    }
    let DrivenDesign { aim, run, told, known } = driven;
    let best = (run, told);
    let aimed = AimedSteps { given, aim, added: &known, plants: &plants, from: SearchStarts::Nearest };
    let (run, mut told) = shorter((source, setup), aimed, best, &mut within(&mut *watch, [0.9, 0.94]));
    if told.command_of_steps.is_none() {
        told = with_command_of_steps((setup, told), &plants, watch)?;
    }
    // a design led by its steps is not proven before the end
    if told.designed.view.proof.is_none() {
        let problem = told.designed.problem.clone();
        let view = &mut told.designed.view;
        unless_stopped(&mut told.unfinished, DesignPart::Proof, || {
            Ok(Some(try_to_prove(&problem, view, &mut within(&mut *watch, [0.94, 0.97]))?))
        })?;
    }
    let mut unfinished = std::mem::take(&mut told.unfinished);
    let twin = twin.filter(|twin| twin.of == told.design);
    let is_to_be_found = twin.is_none() && run.problem.timing.sample_time_s.is_some() && !told.is_stopped();
    let (own_twin, found) = both(
        &mut within(watch, [0.97, 1.0]),
        0.5,
        |watch| is_to_be_found.then(|| continuous_as_sampled((source, setup), &run.problem, &told, watch)),
        |watch| {
            unless_stopped(&mut unfinished, DesignPart::Relaxations, || {
                relaxations(setup, aimed, (&run, &told), watch).map(Some)
            })
        },
    );
    let relaxations = found?.unwrap_or_default();
    let twin = own_twin.map(|found| ContinuousTwin { of: told.design.clone(), found }).or(twin);
    Ok((run, ProjectDesign { unfinished, relaxations, ..told }, twin))
}

/// A design with its trial, and the contribution of its runs to the steps of the linear loop.
struct DrivenDesign {
    aim: StepAim,
    run: DesignRun,
    told: ProjectDesign,
    known: Vec<AddedByRig>,
}

impl DrivenDesign {
    /// The design together with a shorter structure whose runs miss the requirement.
    fn with_missed(mut self, shorter: &ProjectDesign) -> DrivenDesign {
        self.told.note_missed_on_rig(shorter);
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
    let (aim, run, told) = found(setup, (given, first, plants), seed, &mut within(&mut *watch, [0.0, 0.5]))?;
    let aimed = AimedSteps { given, aim, added: &[], plants, from: SearchStarts::Nearest };
    let (simple, told) = with_simpler(setup, aimed, (&run, told), &mut within(&mut *watch, [0.5, 0.55]));
    let Some(simple) = simple else {
        return driven(rig, aimed, (run, told), &mut within(watch, [0.55, 1.0]));
    };
    let (of_simple, twin) = driven(rig, aimed, simple, &mut within(&mut *watch, [0.55, 0.8]))?;
    if of_simple.told.is_stopped() || !misses(&of_simple.told) {
        return Ok((of_simple, twin));
    }
    let (other, _) = driven(rig, aimed, (run, told), &mut within(watch, [0.8, 1.0]))?;
    Ok(match is_better(&other.told, &of_simple.told) {
        true => (other.with_missed(&of_simple.told), None),
        false => (of_simple, twin),
    })
}

/// The simplest structure that is as good a design by its steps, if there is one, and the design
/// itself.
fn with_simpler(
    setup: &Setup<'_>,
    aimed: AimedSteps<'_>,
    (run, mut told): (&DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> (Option<(DesignRun, ProjectDesign)>, ProjectDesign) {
    if told.is_stopped() || !told.is_met() {
        return (None, told);
    }
    let found = simpler(setup, aimed, (run, &told), watch);
    if matches!(found, Err(DesignError::Stopped(_))) {
        told.leave(DesignPart::Search);
    }
    // the earlier result remains
    (found.ok().flatten(), told)
}

/// A design with its trial and, as long as the trial misses the requirement, the designs that
/// follow from the contributions of the runs: the best of them.
fn driven(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, told): (DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> Result<(DrivenDesign, Option<ContinuousTwin>), DesignError> {
    let problem = run.problem.clone();
    let (told, twin) =
        with_trial_and_twin((source, setup), &problem, told, &mut within(&mut *watch, [0.0, 0.25]))?;
    let mut best = (run, told);
    // the design from which the next one begins, unless it is the best one
    let mut latest: Option<(DesignRun, ProjectDesign)> = None;
    let mut known = added(&best.1, &[]);
    let (mut nearest, mut in_vain) = (best.1.worst_run_with_room(), 0);
    let mut for_room = 0;
    for index in 0..TRIES {
        let share = [index, index + 1].map(|done| 0.25 + 0.75 * done as f64 / TRIES as f64);
        let before = latest.as_ref().unwrap_or(&best);
        // a search with these runs may satisfy a limit that the design misses although the rig
        // satisfies the requirement
        let lacks_a_limit = latest.as_ref().is_some_and(|(_, told)| rank(told).0 > 0);
        let suffices = best.1.worst_run() <= 1.0;
        if !misses(&before.1) && !lacks_a_limit || in_vain > IN_VAIN || for_room >= TRIES_FOR_ROOM {
            break;
        }
        for_room += usize::from(suffices);
        let from = if in_vain == IN_VAIN { SearchStarts::Others } else { SearchStarts::Nearest };
        let aimed = AimedSteps { added: &known, from, ..aimed };
        match next_design((source, setup), aimed, before, &mut within(&mut *watch, share)) {
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
    let (run, told) = best;
    Ok((DrivenDesign { aim: aimed.aim, run, told, known }, twin))
}

/// A design with the trial of its controller, and concurrently with the design made without
/// sampling.
fn with_trial_and_twin(
    (source, setup): (&dyn Source, &Setup<'_>),
    problem: &DesignProblem,
    told: ProjectDesign,
    watch: Watch<'_>,
) -> Result<(ProjectDesign, Option<ContinuousTwin>), DesignError> {
    // a rig that misses a requirement in time leads to another design
    let is_required = told.designed.problem.in_time.iter().any(|one| one.follows);
    if told.is_stopped() || is_required || all_cores().at_once == 1 {
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

/// The design without zeros and poles that have next to no effect, if the nonlinear rig satisfies
/// the requirement with it too; otherwise the unchanged design.
fn shorter(
    (source, setup): (&dyn Source, &Setup<'_>),
    aimed: AimedSteps<'_>,
    (run, told): (DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> (DesignRun, ProjectDesign) {
    if told.is_stopped() || !told.is_met() || misses(&told) {
        return (run, told);
    }
    let found = shortened(setup, aimed, (&run, &told), &mut within(&mut *watch, [0.0, 0.7]));
    // the earlier result remains
    let found = found.and_then(|found| {
        let Some((run, shorter)) = found else { return Ok(None) };
        Ok(Some((run, with_trial((source, setup), shorter, &mut within(watch, [0.7, 1.0]))?)))
    });
    match found {
        Ok(Some((_, tried))) if tried.is_stopped() => stopped_in_search(run, told),
        Ok(Some((run, tried))) if agrees_as_well(&tried, &told) && !misses(&tried) => (run, tried),
        Err(DesignError::Stopped(_)) => stopped_in_search(run, told),
        Ok(_) | Err(_) => (run, told),
    }
}

/// A design whose continued search was cancelled.
fn stopped_in_search(run: DesignRun, mut told: ProjectDesign) -> (DesignRun, ProjectDesign) {
    told.leave(DesignPart::Search);
    (run, told)
}

/// True if the nonlinear rig agrees with one design as well as with another; settling times that
/// satisfy the requirement need not be those of the linear loop.
fn agrees_as_well(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    one.agreement() <= other.agreement().max(Agreement::AgreesButForSettling)
}

/// True if the nonlinear rig misses the requirement under a design that is met, or satisfies it
/// without room for the plants between the simulated ones.
fn misses(told: &ProjectDesign) -> bool {
    let is_met = told.design.status == DesignStatus::Met && !told.is_stopped();
    is_met && told.misses_on_rig()
}

/// A design with the known contribution of the rig to its steps, and its trial; `None` if the steps
/// of the one before lead to none.
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

/// A design with the trial of its controller; the trial is absent after cancellation, and without a
/// rig.
fn with_trial(
    (source, setup): (&dyn Source, &Setup<'_>),
    told: ProjectDesign,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    if setup.project.actuator.is_none() {
        return Ok(told);
    }
    let mut unfinished = told.unfinished.clone();
    let trial = unless_stopped(&mut unfinished, DesignPart::Trial, || {
        tried_design(source, setup.project, &told, watch)
    })?;
    Ok(ProjectDesign { unfinished, trial, ..told })
}

/// True if one design is as good as another over frequency and its worst run is nearer to the
/// requirement; if the runs of both satisfy it, the worst run with room for the plants between
/// counts.
fn is_better(one: &ProjectDesign, other: &ProjectDesign) -> bool {
    let runs = |told: &ProjectDesign| (told.worst_run().max(1.0), told.worst_run_with_room());
    !one.is_stopped() && rank(one).0 <= rank(other).0 && runs(one) < runs(other)
}
