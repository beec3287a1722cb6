//! A design whose steps miss what is required in time, moved until they do not: by the steps
//! themselves, from where the limits on frequency responses led.
//!
//! ```text
//! rows of the search: margins of the limits at the samples, beside margins of steps of the worst plants
//! y(t) <= 1 + M,    |y(t) - 1| <= b from t_s on,    rise <= t_r
//! search -> audit, with the worst steps between the samples -> what it finds joins the search
//! ```

mod led;
mod shaping;

use phea_dynamics::watch::{Watch, within};
use phea_qft::design::quantization::CoefficientFormat;
use phea_qft::design::{Design, LoopDesignError, TriedStructure};
use phea_qft::family::Family;
use phea_qft::loop_shaping::Samples;

use self::led::{AuditedStep, BegunDesign, LedDesign};
use super::added_by_rig::AddedByRig;
use super::problem::design_problem;
use super::step_aim::StepAim;
use super::{DesignError, DesignRun, ProjectDesign, structures};
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::TrackingWish;

/// Structures that it begins from.
const STARTS: usize = 3;
/// Shares of what is required that the search keeps for linear steps, since the nonlinear rig takes
/// some of it.
const OVERSHOOT_SHARE: f64 = 0.6;
const SETTLING_SHARE: f64 = 0.9;
const BAND_SHARE: f64 = 0.8;
/// The same for steps with what the rig adds to them.
const OVERSHOOT_SHARE_WITH_RIG: f64 = 0.9;
const SETTLING_SHARE_WITH_RIG: f64 = 0.97;
const BAND_SHARE_WITH_RIG: f64 = 0.95;
/// Least overshoot that is aimed at, percent.
const LEAST_OVERSHOOT_PERCENT: f64 = 0.3;

/// The design with its steps led towards the aimed share of what is required, from its own
/// structure and from others that came near: the first that reaches it, or else the nearest. What
/// the nonlinear rig is known to add to a step is added. `None` where nothing is required in time,
/// no loop is stable, or the coefficients are rounded.
pub(super) fn by_steps(
    setup: &Setup<'_>,
    (given, aim, added): (&RobustProblem, StepAim, &[AddedByRig]),
    (run, told): (&DesignRun, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let Some(led) = led(setup, (given, aim, added), (run, told))? else { return Ok(None) };
    let mut begun: Vec<BegunDesign> = Vec::new();
    let starts = starts(&told.design, run.outcome.tried());
    for (index, start) in starts.into_iter().enumerate() {
        let share = [index, index + 1].map(|done| 0.2 * done as f64 / STARTS as f64);
        begun.extend(led.begun(start, told, &mut within(&mut *watch, share))?);
    }
    begun.sort_by(|one, other| other.least_db.total_cmp(&one.least_db));
    let count = begun.len() as f64;
    let mut best: Option<AuditedStep> = None;
    for (index, begun) in begun.into_iter().enumerate() {
        let share = [index, index + 1].map(|done| 0.2 + 0.7 * done as f64 / count);
        let found = led.agreed(begun, best.as_ref(), told, &mut within(&mut *watch, share))?;
        if found.as_ref().is_some_and(|found| best.as_ref().is_none_or(|best| found.gains_on(best, 0.0))) {
            best = found;
        }
        if best.as_ref().is_some_and(|best| best.is_reached() || led.is_near(best)) {
            break;
        }
    }
    let Some(best) = best else { return Ok(None) };
    let best = led.completed(best, told, &mut within(watch, [0.9, 1.0]))?;
    Ok(Some(taken(best, (run, told))?))
}

/// The design without zeros and poles that do next to nothing, led again; `None` where it has none,
/// or does not reach what is required without them.
pub(super) fn shortened(
    setup: &Setup<'_>,
    aimed: (&RobustProblem, StepAim, &[AddedByRig]),
    (run, told): (&DesignRun, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let Some(led) = led(setup, aimed, (run, told))? else { return Ok(None) };
    let Some(begun) = led.shorter(told, watch)? else { return Ok(None) };
    let found = led.agreed(begun, None, told, watch)?.filter(AuditedStep::is_reached);
    found.map(|found| taken(found, (run, told))).transpose()
}

/// The problem of a design that is led; `None` where nothing is required in time, or the
/// coefficients are rounded.
fn led<'a>(
    setup: &'a Setup<'_>,
    (given, aim, added): (&'a RobustProblem, StepAim, &'a [AddedByRig]),
    (run, told): (&DesignRun, &ProjectDesign),
) -> Result<Option<LedDesign<'a>>, DesignError> {
    let required = given.in_time.iter().find(|one| one.follows);
    let (Some(required), Family::Uncertain(_)) = (required, &given.family) else { return Ok(None) };
    let (Some(samples), CoefficientFormat::Double) = (run.outcome.samples(), told.options.coefficients)
    else {
        return Ok(None);
    };
    let problem = design_problem(setup, given);
    let samples = Samples::new(&problem, samples.plants(), &samples.frequencies_rad_per_s())
        .map_err(LoopDesignError::from)?;
    Ok(Some(LedDesign { setup, given, aim, added, problem, samples, required: required.wish }))
}

/// A design that was led, in place of the one before it.
fn taken(
    found: AuditedStep,
    (run, told): (&DesignRun, &ProjectDesign),
) -> Result<(DesignRun, ProjectDesign), DesignError> {
    let AuditedStep { told: mut best, least, .. } = found;
    best.structures = structures::led(run, told, &best, least)?;
    best.explanations = told.explanations.clone();
    let mut outcome = run.outcome.clone();
    outcome.design = Some(best.design.clone());
    Ok((DesignRun { aimed: run.aimed.clone(), problem: run.problem.clone(), outcome }, *best))
}

/// The design, and the structures that came nearest as they were found, its own among them where it
/// was led since, behind its prefilter where they have none.
fn starts(design: &Design, tried: &[TriedStructure]) -> Vec<Design> {
    let least = |one: &TriedStructure| one.least.as_ref().map_or(f64::NEG_INFINITY, |least| least.margin_db);
    let is_other = |one: &TriedStructure| {
        one.least.is_some() && (one.structure != design.structure || one.free_numbers != design.free_numbers)
    };
    let mut others: Vec<&TriedStructure> = tried.iter().filter(|one| is_other(one)).collect();
    others.sort_by(|one, other| least(other).total_cmp(&least(one)));
    let own = design.free_numbers.get(design.structure.dimension()..).unwrap_or_default();
    let start = |tried: &TriedStructure| {
        let mut free_numbers = tried.free_numbers.clone();
        let prefilter = match &tried.prefilter {
            Some(prefilter) => Some(prefilter.clone()),
            None => {
                free_numbers.extend_from_slice(own);
                design.prefilter.clone()
            }
        };
        let structure = tried.structure.clone();
        Design { structure, prefilter, free_numbers, name: tried.name, ..design.clone() }
    };
    let others = others.into_iter().take(STARTS - 1).map(start);
    std::iter::once(design.clone()).chain(others).filter(|one| !one.free_numbers.is_empty()).collect()
}

/// The requirement of steps with what the rig adds to them.
fn with_rig(wish: TrackingWish) -> TrackingWish {
    TrackingWish {
        overshoot_percent: wish.overshoot_percent.map(|most| most * OVERSHOOT_SHARE_WITH_RIG),
        settling_time_s: wish.settling_time_s.map(|time_s| time_s * SETTLING_SHARE_WITH_RIG),
        rise_time_s: wish.rise_time_s.map(|time_s| time_s * SETTLING_SHARE_WITH_RIG),
        band_percent: wish.band_percent * BAND_SHARE_WITH_RIG,
        ..wish
    }
}

/// The requirement that is aimed at, stricter by what the nonlinear rig may take.
fn with_room(wish: TrackingWish) -> TrackingWish {
    let lower = |most: f64| (most * OVERSHOOT_SHARE).max(LEAST_OVERSHOOT_PERCENT.min(most));
    TrackingWish {
        overshoot_percent: wish.overshoot_percent.map(lower),
        settling_time_s: wish.settling_time_s.map(|time_s| time_s * SETTLING_SHARE),
        rise_time_s: wish.rise_time_s.map(|time_s| time_s * SETTLING_SHARE),
        band_percent: wish.band_percent * BAND_SHARE,
        ..wish
    }
}
