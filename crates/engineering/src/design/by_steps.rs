//! Search by steps for a design whose steps miss their requirement in time, starting from the
//! result of the limits on frequency responses.
//!
//! ```text
//! rows of the search: margins of the limits at the samples, and margins of steps of the worst plants
//! y(t) <= 1 + M,    |y(t) - 1| <= b from t_s on,    rise <= t_r,    |u(t)| <= u_max in the steps of the scenarios
//! search -> audit, with the worst steps between the samples -> its findings join the search
//! ```

mod commands;
mod led;
mod plants;
mod shaping;
mod starts;
mod wider;

use phea_dynamics::watch::{Watch, within};
use phea_qft::design::LoopDesignError;
use phea_qft::design::quantization::CoefficientFormat;
use phea_qft::family::Family;
use phea_qft::loop_shaping::{Samples, Shaping};

use self::led::{AuditedStep, BegunDesign, LedDesign};
pub(super) use self::plants::SteppedPlants;
pub(super) use self::shaping::StepShaping;
use self::starts::SearchReach;
pub(super) use self::wider::last_step_search;
use super::added_by_rig::AddedByRig;
use super::problem::design_problem;
use super::step_aim::StepAim;
use super::{DesignError, DesignRun, LedBy, ProjectDesign, structures};
use crate::audit::spread_over;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::StepLimits;
use crate::trial::BAND_WITH_ROOM;

/// Largest number of members whose steps are checked after each search.
const MOST_CHECKED: usize = 12;
/// Largest shortfall of a search by steps, dB, for which a trial on the nonlinear rig gives more
/// information than another start.
const NEARLY_DB: f64 = 0.05;
/// Fractions of the requirement at which the search aims with linear steps, since the nonlinear rig
/// takes part of it.
const OVERSHOOT_FRACTION: f64 = 0.6;
const SETTLING_FRACTION: f64 = 0.9;
const BAND_FRACTION: f64 = 0.8;
/// Fractions for steps including the contribution of the rig.
const OVERSHOOT_FRACTION_WITH_RIG: f64 = 0.9;
const SETTLING_FRACTION_WITH_RIG: f64 = 0.97;
/// Least overshoot at which the search aims, percent.
const LEAST_OVERSHOOT_PERCENT: f64 = 0.3;

/// Designs from which a search by steps begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SearchStarts {
    /// The design, and the structures nearest to the requirement.
    Nearest,
    /// The structures after those.
    Others,
}

/// Aim of a search by steps, and the known data of the steps.
#[derive(Clone, Copy)]
pub(super) struct AimedSteps<'a> {
    pub(super) given: &'a RobustProblem,
    pub(super) aim: StepAim,
    /// Differences of steps on the nonlinear rig, where known.
    pub(super) added: &'a [AddedByRig],
    /// Plants common to all searches of a design.
    pub(super) plants: &'a SteppedPlants,
    /// Designs from which a search begins.
    pub(super) from: SearchStarts,
}

/// The design with its steps led towards the aimed fraction of the requirement, from its structure
/// and from others that came near: the first that reaches the aim, or else the nearest. The known
/// contribution of the nonlinear rig to a step is added. `None` if nothing is required in time, no
/// loop is stable, or the coefficients are rounded.
pub(super) fn by_steps(
    setup: &Setup<'_>,
    aimed: AimedSteps<'_>,
    (run, project_design): (&DesignRun, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let Some(led) = led(setup, aimed, (run, project_design))? else { return Ok(None) };
    let starts = led.starts(project_design, run.outcome.searched());
    let count = starts.len() as f64;
    let least_db = if aimed.added.is_empty() { 0.0 } else { -NEARLY_DB };
    let mut best: Option<AuditedStep> = None;
    let mut waiting: Vec<BegunDesign<'_>> = Vec::new();
    for (index, (start, reach)) in starts.into_iter().enumerate() {
        let fraction = [index, index + 1].map(|done| 0.6 * done as f64 / count);
        let watch = &mut within(&mut *watch, fraction);
        let begun = led.begun(start, project_design, reach, &mut within(&mut *watch, [0.0, 0.5]))?;
        match begun {
            Some(begun) if begun.least_db >= least_db => {
                best = led.better(best, begun, project_design, &mut within(watch, [0.5, 1.0]))?;
            }
            // other structures may reach what the neighbours of a design do not
            Some(begun) if reach == SearchReach::Anywhere => waiting.push(begun),
            _ => {}
        }
        if led.suffices(best.as_ref()) {
            break;
        }
    }
    waiting.sort_by(|one, other| other.least_db.total_cmp(&one.least_db));
    let count = waiting.len() as f64;
    for (index, begun) in waiting.into_iter().enumerate() {
        if led.suffices(best.as_ref()) {
            break;
        }
        let fraction = [index, index + 1].map(|done| 0.6 + 0.3 * done as f64 / count);
        best = led.better(best, begun, project_design, &mut within(&mut *watch, fraction))?;
    }
    let Some(best) = best else { return Ok(None) };
    let best = led.completed(best, project_design, &mut within(watch, [0.9, 1.0]))?;
    Ok(Some(taken(best, aimed.added, (run, project_design))?))
}

/// The simplest structure that reaches the requirement by its steps: shorter than that of a design,
/// and rejected by the search over frequency since it misses the limits on the path to the step,
/// which may be stricter than the step itself; `None` if there is none.
pub(super) fn simpler(
    setup: &Setup<'_>,
    aimed: AimedSteps<'_>,
    (run, project_design): (&DesignRun, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let Some(led) = led(setup, aimed, (run, project_design))? else { return Ok(None) };
    let starts = led.simpler(project_design, run)?;
    let count = starts.len() as f64;
    for (index, start) in starts.into_iter().enumerate() {
        let fraction = [index, index + 1].map(|done| done as f64 / count);
        let mut watch = within(&mut *watch, fraction);
        let suffices = |begun: &BegunDesign<'_>| begun.least_db >= 0.0;
        let begun = led.begun(start.clone(), project_design, SearchReach::Anywhere, &mut watch)?;
        let begun = match begun.filter(suffices) {
            None => led.with_less_room().begun(start, project_design, SearchReach::Anywhere, &mut watch)?,
            begun => begun,
        };
        let Some(begun) = begun.filter(suffices) else { continue };
        let found = led.agreed(begun, None, project_design, &mut watch)?.filter(AuditedStep::is_reached);
        let Some(found) = found else { continue };
        if !structures::earns_its_poles(run, project_design, &found.project_design)? {
            let found = led.completed(found, project_design, &mut watch)?;
            return Ok(Some(taken(found, aimed.added, (run, project_design))?));
        }
    }
    Ok(None)
}

/// The design without zeros and poles that have next to no effect, searched again; `None` if it has
/// none, or does not reach the requirement without them.
pub(super) fn shortened(
    setup: &Setup<'_>,
    aimed: AimedSteps<'_>,
    (run, project_design): (&DesignRun, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let Some(led) = led(setup, aimed, (run, project_design))? else { return Ok(None) };
    let Some(begun) = led.shorter(project_design, watch)? else { return Ok(None) };
    let found = led.agreed(begun, None, project_design, watch)?.filter(AuditedStep::is_reached);
    found.map(|found| taken(found, aimed.added, (run, project_design))).transpose()
}

/// Problem of a design that is led by its steps; `None` if nothing is required in time and no
/// command is exceeded, or the coefficients are rounded.
fn led<'a>(
    setup: &'a Setup<'_>,
    aimed: AimedSteps<'a>,
    (run, project_design): (&DesignRun, &ProjectDesign),
) -> Result<Option<LedDesign<'a>>, DesignError> {
    let given = aimed.given;
    let required = given.in_time.iter().find(|one| one.follows).map(|one| one.step_limits);
    let required =
        required
            .or((run.led.is_some() || project_design.exceeded_command().is_some())
                .then_some(StepLimits::NOTHING));
    let (Some(required), Family::Uncertain(family)) = (required, &given.family) else { return Ok(None) };
    let (Some(samples), CoefficientFormat::Double) =
        (run.outcome.samples(), project_design.options.coefficients)
    else {
        return Ok(None);
    };
    let problem = design_problem(setup, given);
    let samples = Samples::new(&problem, samples.plants(), &samples.frequencies_rad_per_s())
        .map_err(LoopDesignError::from)?;
    let evaluated = spread_over(family, MOST_CHECKED);
    let room = run.led.as_ref().map_or(StepRoom::Usual, |led| led.room);
    Ok(Some(LedDesign { setup, aimed, evaluated, problem, samples, required, room }))
}

/// A design led by its steps, replacing the one before it.
fn taken(
    found: AuditedStep,
    added: &[AddedByRig],
    (run, project_design): (&DesignRun, &ProjectDesign),
) -> Result<(DesignRun, ProjectDesign), DesignError> {
    let AuditedStep { project_design: mut best, least, search, .. } = found;
    best.structures = structures::led(run, project_design, &best, least)?;
    best.explanations = project_design.explanations.clone();
    best.led_by = if added.is_empty() { LedBy::LinearSteps } else { LedBy::NonlinearRuns };
    let mut outcome = run.outcome.clone();
    outcome.design = Some(best.design.clone());
    let (aimed, problem) = (run.aimed.clone(), run.problem.clone());
    Ok((DesignRun { aimed, problem, outcome, led: Some(search) }, *best))
}

/// Search in which a design was led by its steps.
pub(super) struct LedSearch {
    /// Limits and samples of the search.
    shaping: Shaping,
    room: StepRoom,
}

/// Part of the requirement that a search reserves for the contribution of the nonlinear rig to
/// linear steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StepRoom {
    /// Room as large as the common contribution of rigs.
    Usual,
    /// Room as small as suffices once the contribution of the rig is known.
    Little,
}

impl StepRoom {
    /// Requirement at which the search aims.
    fn of(self, step_limits: StepLimits) -> StepLimits {
        match self {
            StepRoom::Usual => with_room(step_limits),
            StepRoom::Little => with_rig(step_limits),
        }
    }
}

/// Requirement of steps including the contribution of the rig.
fn with_rig(step_limits: StepLimits) -> StepLimits {
    StepLimits {
        overshoot_percent: step_limits.overshoot_percent.map(|most| most * OVERSHOOT_FRACTION_WITH_RIG),
        settling_time_s: step_limits.settling_time_s.map(|time_s| time_s * SETTLING_FRACTION_WITH_RIG),
        rise_time_s: step_limits.rise_time_s.map(|time_s| time_s * SETTLING_FRACTION_WITH_RIG),
        band_percent: step_limits.band_percent * BAND_WITH_ROOM,
        ..step_limits
    }
}

/// Requirement at which the search aims, reduced by what the nonlinear rig may take.
fn with_room(step_limits: StepLimits) -> StepLimits {
    let lower = |most: f64| (most * OVERSHOOT_FRACTION).max(LEAST_OVERSHOOT_PERCENT.min(most));
    StepLimits {
        overshoot_percent: step_limits.overshoot_percent.map(lower),
        settling_time_s: step_limits.settling_time_s.map(|time_s| time_s * SETTLING_FRACTION),
        rise_time_s: step_limits.rise_time_s.map(|time_s| time_s * SETTLING_FRACTION),
        band_percent: step_limits.band_percent * BAND_FRACTION,
        ..step_limits
    }
}
