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
    AuditedController, DesignError, DesignPart, ProjectDesign, SearchedDesign, continuous_as_sampled,
    trial_design, unless_stopped,
};
use crate::audit::prove_claims;
use crate::robust::RobustProblem;
use crate::setup::{ProjectInputs, Setup};
use crate::side_by_side::{all_cores, both};
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
    inputs: ProjectInputs<'_>,
    given: &RobustProblem,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(SearchedDesign, Option<ContinuousTwin>), DesignError> {
    let setup = inputs.setup;
    let plants = SteppedPlants::default();
    let first = StepAim::first(setup, given);
    let begins = AimedSteps::without_rig(given, first, &plants);
    let (mut driven, mut twin) = simplest(inputs, begins, seed, &mut within(&mut *watch, [0.0, 0.7]))?;
    // without the limit that leads away from a loop without gain, the search takes another path
    let of_first = &driven.searched.project_design;
    if first != StepAim::AS_REQUIRED && !of_first.is_stopped() && misses(of_first) {
        let begins = AimedSteps { aim: StepAim::AS_REQUIRED, ..begins };
        match simplest(inputs, begins, seed, &mut within(&mut *watch, [0.7, 0.9])) {
            Ok((other, _)) if is_better(&other.searched.project_design, of_first) => {
                (driven, twin) = (other.with_missed(of_first), None);
            }
            Err(DesignError::Stopped(_)) => driven.searched.project_design.leave(DesignPart::Search),
            // the earlier result remains
            Ok(_) | Err(_) => {}
        }
    }
    let DrivenDesign { aim, searched, known } = driven;
    let aimed = AimedSteps { aim, added: &known, ..begins };
    let searched = shorter(inputs, aimed, searched, &mut within(&mut *watch, [0.9, 0.94]));
    let SearchedDesign { run, mut project_design } = searched;
    if project_design.command_of_steps.is_none() {
        project_design = with_command_of_steps(setup, project_design, &plants, watch)?;
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
    let searched = SearchedDesign { run, project_design };
    let (own_twin, found) = both(
        &mut within(watch, [0.97, 1.0]),
        0.5,
        |watch| {
            is_to_be_found.then(|| {
                continuous_as_sampled(inputs, &searched.run.problem, &searched.project_design, watch)
            })
        },
        |watch| {
            unless_stopped(&mut unfinished, DesignPart::Relaxations, || {
                relaxations(setup, aimed, &searched, watch).map(Some)
            })
        },
    );
    let relaxations = found?.unwrap_or_default();
    let SearchedDesign { run, project_design } = searched;
    let twin = own_twin.map(|found| ContinuousTwin { of: project_design.design.clone(), found }).or(twin);
    let project_design = ProjectDesign { unfinished, relaxations, ..project_design };
    Ok((SearchedDesign { run, project_design }, twin))
}

/// A design with its trial, and the contribution of its runs to the steps of the linear loop.
struct DrivenDesign {
    aim: StepAim,
    searched: SearchedDesign,
    known: Vec<AddedByRig>,
}

impl DrivenDesign {
    /// The design together with a shorter structure whose runs miss the requirement.
    fn with_missed(mut self, shorter: &ProjectDesign) -> DrivenDesign {
        self.searched.project_design.note_missed_on_rig(shorter);
        self
    }
}

/// Best design to which a search with this aim leads: the simplest structure by its steps, unless
/// the nonlinear rig misses the requirement with that and misses less with another.
fn simplest(
    inputs: ProjectInputs<'_>,
    begins: AimedSteps<'_>,
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(DrivenDesign, Option<ContinuousTwin>), DesignError> {
    let (aim, mut searched) = found(inputs.setup, begins, seed, &mut within(&mut *watch, [0.0, 0.5]))?;
    let aimed = AimedSteps { aim, ..begins };
    let simple = simpler_searched(inputs.setup, aimed, &mut searched, &mut within(&mut *watch, [0.5, 0.55]));
    let Some(simple) = simple else {
        return driven(inputs, aimed, searched, &mut within(watch, [0.55, 1.0]));
    };
    let (of_simple, twin) = driven(inputs, aimed, simple, &mut within(&mut *watch, [0.55, 0.8]))?;
    let simple = &of_simple.searched.project_design;
    if simple.is_stopped() || !misses(simple) {
        return Ok((of_simple, twin));
    }
    let (other, _) = driven(inputs, aimed, searched, &mut within(watch, [0.8, 1.0]))?;
    Ok(match is_better(&other.searched.project_design, simple) {
        true => (other.with_missed(simple), None),
        false => (of_simple, twin),
    })
}

/// The simplest structure that is as good a design by its steps, if there is one; a cancellation is
/// recorded in the design.
fn simpler_searched(
    setup: &Setup<'_>,
    aimed: AimedSteps<'_>,
    searched: &mut SearchedDesign,
    watch: Watch<'_>,
) -> Option<SearchedDesign> {
    if searched.project_design.is_stopped() || !searched.project_design.is_met() {
        return None;
    }
    let found = simpler(setup, aimed, searched, watch);
    if matches!(found, Err(DesignError::Stopped(_))) {
        searched.project_design.leave(DesignPart::Search);
    }
    // the earlier result remains
    found.ok().flatten()
}

/// A design with its trial and, as long as the trial misses the requirement, the designs that
/// follow from the contributions of the runs: the best of them.
fn driven(
    inputs: ProjectInputs<'_>,
    aimed: AimedSteps<'_>,
    searched: SearchedDesign,
    watch: Watch<'_>,
) -> Result<(DrivenDesign, Option<ContinuousTwin>), DesignError> {
    let SearchedDesign { run, project_design } = searched;
    let (project_design, twin) =
        with_trial_and_twin(inputs, &run.problem, project_design, &mut within(&mut *watch, [0.0, 0.25]))?;
    let mut best = SearchedDesign { run, project_design };
    // the design from which the next one begins, unless it is the best one
    let mut latest: Option<SearchedDesign> = None;
    let mut known = added(&best.project_design, &[]);
    let (mut nearest, mut in_vain) = (best.project_design.worst_run_with_room(), 0);
    let mut for_room = 0;
    for index in 0..TRIES {
        let fraction = [index, index + 1].map(|done| 0.25 + 0.75 * done as f64 / TRIES as f64);
        let before = latest.as_ref().unwrap_or(&best);
        // a search with these runs may satisfy a limit that the design misses although the rig
        // satisfies the requirement
        let lacks_a_limit = latest.as_ref().is_some_and(|latest| rank(&latest.project_design).0 > 0);
        let suffices = best.project_design.worst_run() <= 1.0;
        if !misses(&before.project_design) && !lacks_a_limit
            || in_vain > IN_VAIN
            || for_room >= TRIES_FOR_ROOM
        {
            break;
        }
        for_room += usize::from(suffices);
        let from = if in_vain == IN_VAIN { SearchStarts::Others } else { SearchStarts::Nearest };
        let aimed = AimedSteps { added: &known, from, ..aimed };
        match next_design(inputs, aimed, before, &mut within(&mut *watch, fraction)) {
            Ok(Some(found)) => {
                known = added(&found.project_design, &known);
                if found.project_design.is_stopped() {
                    best.project_design.leave(DesignPart::Search);
                }
                let gains = found.project_design.worst_run_with_room() < (1.0 - GAIN) * nearest;
                in_vain =
                    if gains || found.project_design.worst_run_with_room() <= 1.0 { 0 } else { in_vain + 1 };
                nearest = nearest.min(found.project_design.worst_run_with_room());
                latest = if is_better(&found.project_design, &best.project_design) {
                    best = found;
                    None
                } else {
                    Some(found)
                };
            }
            Err(DesignError::Stopped(_)) => best.project_design.leave(DesignPart::Search),
            // the earlier result remains
            Ok(None) | Err(_) => break,
        }
        if best.project_design.is_stopped() {
            break;
        }
    }
    Ok((DrivenDesign { aim: aimed.aim, searched: best, known }, twin))
}

/// A design with the trial of its controller, and concurrently with the design made without
/// sampling.
fn with_trial_and_twin(
    inputs: ProjectInputs<'_>,
    problem: &DesignProblem,
    project_design: ProjectDesign,
    watch: Watch<'_>,
) -> Result<(ProjectDesign, Option<ContinuousTwin>), DesignError> {
    // a rig that misses a requirement in time leads to another design
    let is_required = project_design.designed.problem.in_time.iter().any(|one| one.follows);
    if project_design.is_stopped() || is_required || all_cores().at_once == 1 {
        return Ok((with_trial(inputs, project_design, watch)?, None));
    }
    let untried = project_design.clone();
    let (found, project_design) = both(
        watch,
        0.5,
        |watch| continuous_as_sampled(inputs, problem, &untried, watch),
        |watch| with_trial(inputs, project_design, watch),
    );
    Ok((project_design?, Some(ContinuousTwin { of: untried.design, found })))
}

/// The design without zeros and poles that have next to no effect, if the nonlinear rig satisfies
/// the requirement with it too; otherwise the unchanged design.
fn shorter(
    inputs: ProjectInputs<'_>,
    aimed: AimedSteps<'_>,
    mut searched: SearchedDesign,
    watch: Watch<'_>,
) -> SearchedDesign {
    let project_design = &searched.project_design;
    if project_design.is_stopped() || !project_design.is_met() || misses(project_design) {
        return searched;
    }
    let found = shortened(inputs.setup, aimed, &searched, &mut within(&mut *watch, [0.0, 0.7]));
    // the earlier result remains
    let found = found.and_then(|found| {
        let Some(SearchedDesign { run, project_design }) = found else { return Ok(None) };
        let project_design = with_trial(inputs, project_design, &mut within(watch, [0.7, 1.0]))?;
        Ok(Some(SearchedDesign { run, project_design }))
    });
    match found {
        Ok(Some(shorter)) if shorter.project_design.is_stopped() => {
            searched.project_design.leave(DesignPart::Search);
        }
        Ok(Some(shorter))
            if agrees_as_well(&shorter.project_design, &searched.project_design)
                && !misses(&shorter.project_design) =>
        {
            return shorter;
        }
        Err(DesignError::Stopped(_)) => searched.project_design.leave(DesignPart::Search),
        Ok(_) | Err(_) => {}
    }
    searched
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
    inputs: ProjectInputs<'_>,
    aimed: AimedSteps<'_>,
    before: &SearchedDesign,
    watch: Watch<'_>,
) -> Result<Option<SearchedDesign>, DesignError> {
    let found = by_steps(inputs.setup, aimed, before, &mut within(&mut *watch, [0.0, 0.7]))?;
    let Some(SearchedDesign { run, project_design }) = found else { return Ok(None) };
    let project_design = with_trial(inputs, project_design, &mut within(watch, [0.7, 1.0]))?;
    Ok(Some(SearchedDesign { run, project_design }))
}

/// A design with the trial of its controller; the trial is absent after cancellation, and without a
/// rig.
fn with_trial(
    inputs: ProjectInputs<'_>,
    project_design: ProjectDesign,
    watch: Watch<'_>,
) -> Result<ProjectDesign, DesignError> {
    if inputs.setup.project.actuator.is_none() {
        return Ok(project_design);
    }
    let mut unfinished = project_design.unfinished.clone();
    let trial =
        unless_stopped(&mut unfinished, DesignPart::Trial, || trial_design(inputs, &project_design, watch))?;
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
