//! Search for a design: within the limits of the project and of a deployable controller, aimed at
//! the requirements in time, and with stricter limits if the steps of the result still miss them.

use std::cmp::Ordering;

use phea_dynamics::watch::{Stopped, Watch, within};
use phea_qft::design::{ControllerChoice, DesignStatus, Finding, design_stricter};
use phea_qft::verification::Verdict;

use super::by_steps::{AimedSteps, SearchStarts, SteppedPlants, by_steps};
use super::command_of_steps::with_command_of_steps;
use super::problem::{design_options, design_problem};
use super::step_aim::{REPETITIONS, StepAim};
use super::{
    DesignError, DesignPart, DesignRun, Explanation, ProjectDesign, ReachedStructure, proven, structures,
};
use crate::audit::TimeFinding;
use crate::robust::RobustProblem;
use crate::setup::Setup;

/// Best design that was found for a problem with the limits of a deployable controller, from this
/// aim on, and the aim that led to it.
pub(super) fn found(
    setup: &Setup<'_>,
    (given, mut aim, plants): (&RobustProblem, StepAim, &SteppedPlants),
    seed: Option<u32>,
    watch: Watch<'_>,
) -> Result<(StepAim, DesignRun, ProjectDesign), DesignError> {
    let mut found: Vec<(StepAim, DesignRun, ProjectDesign)> = Vec::new();
    for repetition in 0..=REPETITIONS {
        let aimed = match aim.of(setup.project, given) {
            Ok(aimed) => aimed,
            // limits for a stricter aim may not exist: the earlier result remains
            Err(_) if !found.is_empty() => break,
            Err(error) => return Err(error),
        };
        let fraction = [repetition, repetition + 1].map(|done| done as f64 / (REPETITIONS + 1) as f64);
        let before = found.last().map(|(_, run, project_design)| (run, project_design));
        let design = searched(setup, (given, &aimed), (seed, before), &mut within(&mut *watch, fraction));
        match design {
            Ok((run, project_design)) => {
                let design = (run, with_command_of_steps((setup, project_design), plants, watch)?);
                let (run, project_design) =
                    led_by_steps(setup, (given, aim, plants), design, &mut within(&mut *watch, fraction));
                found.push((aim, run, project_design));
            }
            // the earlier result remains
            Err(error) if found.is_empty() => return Err(error),
            Err(_) => break,
        }
        // a stricter aim seldom helps if the limits of this one are missed, and takes as long
        let met = found.last().filter(|(.., project_design)| {
            !project_design.is_stopped() && project_design.design.status == DesignStatus::Met
        });
        let Some((.., project_design)) = met else { break };
        match aim.stricter(project_design).filter(|_| repetition < REPETITIONS) {
            Some(stricter) => aim = stricter,
            None => break,
        }
    }
    let reached_structures: Vec<ReachedStructure> =
        found.iter().flat_map(|(.., project_design)| project_design.structures.clone()).collect();
    let best = found.into_iter().min_by(|(.., one), (.., other)| by_rank(one, other));
    let (aim, run, project_design) = best.ok_or(Stopped)?;
    Ok((aim, run, project_design.with_shorter(reached_structures)))
}

/// A design whose steps miss the requirement, led to it by its steps; unchanged if that gains
/// nothing.
fn led_by_steps(
    setup: &Setup<'_>,
    (given, aim, plants): (&RobustProblem, StepAim, &SteppedPlants),
    (run, mut project_design): (DesignRun, ProjectDesign),
    watch: Watch<'_>,
) -> (DesignRun, ProjectDesign) {
    let misses = project_design.designed.view.in_time.iter().any(TimeFinding::violates);
    let command = project_design.exceeded_command().is_some_and(|command| !command.is_out_of_reach());
    if project_design.is_stopped() || !(misses || command) {
        return (run, project_design);
    }
    let aimed = AimedSteps { given, aim, added: &[], plants, from: SearchStarts::Nearest };
    match by_steps(setup, aimed, (&run, &project_design), watch) {
        Ok(Some(moved)) if by_rank(&moved.1, &project_design).is_lt() => moved,
        Err(DesignError::Stopped(_)) => {
            project_design.leave(DesignPart::Search);
            (run, project_design)
        }
        // the earlier result remains
        Ok(_) | Err(_) => (run, project_design),
    }
}

/// Rank of a design among several, the least the best: its verdict over frequency with a prefilter
/// within its permitted gain, then the distance of its steps from the requirement.
pub(super) fn rank(project_design: &ProjectDesign) -> (u8, f64) {
    let verdict = match project_design.designed.view.audit.verdict {
        Verdict::Met
            if project_design.design.status == DesignStatus::Met
                && project_design.exceeded_prefilter_gain().is_none() =>
        {
            0
        }
        Verdict::Met => 1,
        Verdict::NotProven => 2,
        // a stabilising loop is nearer than any that does not stabilise the plants
        Verdict::Violated => {
            3 + u8::from(project_design.designed.view.audit.stability.verdict == Verdict::Violated)
        }
    };
    (verdict, StepAim::AS_REQUIRED.excess(project_design))
}

/// Order of two designs by their rank: the lesser is nearer to the requirement.
fn by_rank(one: &ProjectDesign, other: &ProjectDesign) -> Ordering {
    let (one, other) = (rank(one), rank(other));
    one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
}

/// A design of the aimed problem, judged as the given one; plants that an earlier design sampled
/// are not sampled again.
fn searched(
    setup: &Setup<'_>,
    (given, aimed): (&RobustProblem, &RobustProblem),
    (seed, before): (Option<u32>, Option<(&DesignRun, &ProjectDesign)>),
    watch: Watch<'_>,
) -> Result<(DesignRun, ProjectDesign), DesignError> {
    let problem = design_problem(setup, aimed);
    let mut options = design_options(setup, aimed, seed)?;
    if let ControllerChoice::Any { from: first, .. } = &mut options.controller {
        // a structure too short for the earlier limits is too short for stricter ones
        *first = before.and_then(|(_, project_design)| project_design.design.name);
    }
    let mut outcome = match before {
        Some((run, _)) => design_stricter(&problem, &options, &run.outcome, watch)?,
        None => phea_qft::design::design(&problem, &options, watch)?,
    };
    outcome.conclude()?;
    let run = DesignRun { aimed: aimed.clone(), problem, outcome, led: None };
    let (run, proven) = proven::proven((setup, aimed), run, &options, watch)?;
    let DesignRun { problem, outcome, .. } = &run;
    let explained = |finding: &Finding| Explanation::of(finding, aimed);
    let explanations = outcome.findings.iter().map(explained).collect::<Vec<_>>();
    let Some(design) = outcome.design.clone() else {
        if outcome.stopped {
            return Err(Stopped.into());
        }
        return Err(DesignError::NoController(explanations));
    };
    let mut project_design = match proven {
        Some(project_design) => project_design,
        None => ProjectDesign::new(setup, aimed, problem, design, options, watch)?,
    };
    let unfinished = Vec::from_iter(outcome.stopped.then_some(DesignPart::Search));
    let (known, aimed_at) = (given.specifications.len(), &aimed.specifications);
    if given.specifications != aimed_at[..known] {
        project_design = project_design.judged_by(given, watch)?;
    }
    project_design = project_design.met_where_it_is(known);
    project_design.structures = structures::reached(&run, &project_design)?;
    Ok((run, ProjectDesign { unfinished, explanations, ..project_design }))
}
