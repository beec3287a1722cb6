//! A design whose steps miss what is required in time, moved until they do not: by the steps
//! themselves, from where the limits on frequency responses led.
//!
//! ```text
//! rows of the search: margins of the limits at the samples, beside margins of steps of the worst plants
//! y(t) <= 1 + M,    |y(t) - 1| <= b from t_s on,    rise <= t_r
//! search -> audit, with the worst steps between the samples -> what it finds joins the search
//! ```

mod shaping;

use phea_dynamics::watch::{Watch, part, within};
use phea_qft::closed_loop::Compensation;
use phea_qft::design::quantization::CoefficientFormat;
use phea_qft::design::{Design, DesignProblem, DesignStatus, LoopDesignError, TriedStructure};
use phea_qft::family::Family;
use phea_qft::loop_shaping::{Aim, DescentOptions, SampledMargin, Samples, SearchProblem, Shaping, descend};
use phea_qft::verification::Audit;

use self::shaping::{RESERVE_DB, StepShaping};
use super::problem::design_problem;
use super::search::rank;
use super::step_aim::StepAim;
use super::{DesignError, DesignRun, ProjectDesign, structures};
use crate::audit::audit_request;
use crate::robust::RobustProblem;
use crate::setup::Setup;
use crate::simulate::TrackingWish;

/// Name of the stage.
const STAGE: &str = "shaping by the steps";
/// Structures that it begins from.
const STARTS: usize = 3;
/// How often what an audit finds joins the search.
const ROUNDS: usize = 5;
/// A round that brings less than this share is the last one.
const GAIN: f64 = 0.01;
/// Steps of one search.
const DESCENT_STEPS: usize = 40;
/// Shares of what is required that the search keeps, since the nonlinear rig takes some of it.
const OVERSHOOT_SHARE: f64 = 0.6;
const SETTLING_SHARE: f64 = 0.9;
const BAND_SHARE: f64 = 0.8;
/// Least overshoot that is aimed at, percent.
const LEAST_OVERSHOOT_PERCENT: f64 = 0.3;

/// The design with its steps led towards the aimed share of what is required, from its own
/// structure and from others that came near: the first that reaches it, or else the nearest; `None`
/// where nothing is required in time, no loop is stable, or the coefficients are rounded.
pub(super) fn by_steps(
    setup: &Setup<'_>,
    (given, aim): (&RobustProblem, StepAim),
    (run, told): (&DesignRun, &ProjectDesign),
    watch: Watch<'_>,
) -> Result<Option<(DesignRun, ProjectDesign)>, DesignError> {
    let required = given.in_time.iter().find(|one| one.follows);
    let (Some(required), Family::Uncertain(_)) = (required, &given.family) else { return Ok(None) };
    let (Some(samples), CoefficientFormat::Double) = (run.outcome.samples(), told.options.coefficients)
    else {
        return Ok(None);
    };
    let problem = design_problem(setup, given);
    let samples = Samples::new(&problem, samples.plants(), &samples.frequencies_rad_per_s())
        .map_err(LoopDesignError::from)?;
    let led = LedDesign { setup, given, aim, problem, samples, wish: with_room(aim.wish(required.wish)) };
    let starts = starts(&told.design, run.outcome.tried());
    let mut best: Option<AuditedStep> = None;
    for (index, start) in starts.iter().enumerate() {
        let share = [index, index + 1].map(|done| done as f64 / starts.len() as f64);
        let Some(found) = led.begun_at(start, told, &mut within(&mut *watch, share))? else { continue };
        let is_reached = found.is_reached();
        if best.as_ref().is_none_or(|best| found.gains_on(best, 0.0)) {
            best = Some(found);
        }
        if is_reached {
            break;
        }
    }
    let Some(AuditedStep { told: mut best, least, .. }) = best else { return Ok(None) };
    best.structures = structures::led(run, told, &best, least)?;
    best.explanations = told.explanations.clone();
    let mut outcome = run.outcome.clone();
    outcome.design = Some(best.design.clone());
    Ok(Some((DesignRun { aimed: run.aimed.clone(), problem: run.problem.clone(), outcome }, *best)))
}

/// The design, and the structures that came nearest, behind its prefilter where they have none.
fn starts(design: &Design, tried: &[TriedStructure]) -> Vec<Design> {
    let least = |one: &TriedStructure| one.least.as_ref().map_or(f64::NEG_INFINITY, |least| least.margin_db);
    let mut others: Vec<&TriedStructure> =
        tried.iter().filter(|one| one.structure != design.structure && one.least.is_some()).collect();
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

/// A design with what it lacks.
struct AuditedStep {
    told: Box<ProjectDesign>,
    /// The rank of its verdict over frequency.
    verdict: u8,
    /// How far its steps are from what is aimed at, 1 where they reach it.
    excess: f64,
    /// The least margin to a limit of the samples.
    least: Option<SampledMargin>,
}

impl AuditedStep {
    fn is_reached(&self) -> bool {
        self.told.is_met() && self.excess <= 1.0
    }

    /// True where it is nearer than another by more than this share.
    fn gains_on(&self, other: &AuditedStep, share: f64) -> bool {
        self.verdict < other.verdict
            || self.verdict == other.verdict && self.excess < (1.0 - share) * other.excess
    }
}

/// The problem of a design that is led by its steps, and its aim.
struct LedDesign<'a> {
    setup: &'a Setup<'a>,
    given: &'a RobustProblem,
    aim: StepAim,
    problem: DesignProblem,
    samples: Samples,
    wish: TrackingWish,
}

impl LedDesign<'_> {
    /// The nearest design that was audited from this start; `None` where its loop is not stable.
    fn begun_at(
        &self,
        start: &Design,
        told: &ProjectDesign,
        watch: Watch<'_>,
    ) -> Result<Option<AuditedStep>, DesignError> {
        let structures = (start.structure.clone(), start.prefilter.clone());
        let shaping = Shaping::new(structures.0, structures.1, told.options.objective, self.samples.clone())?;
        let sensor = self.problem.sensor.clone();
        let mut search = StepShaping::new(shaping, self.wish, sensor);
        if !search.judge(&start.free_numbers).stable {
            return Ok(None);
        }
        search.take_worst(&told.design)?;
        search.take_steps(told)?;
        let mut best: Option<AuditedStep> = None;
        let mut free_numbers = start.free_numbers.clone();
        for round in 0..ROUNDS {
            let share = [round, round + 1].map(|done| done as f64 / ROUNDS as f64);
            let options = DescentOptions {
                reserve_db: RESERVE_DB,
                tolerance_db: 1e-3,
                steps_maximum: DESCENT_STEPS,
                ..DescentOptions::new(Aim::Objective)
            };
            let found = descend(&mut search, &free_numbers, options, &mut part(&mut *watch, STAGE, share))?;
            free_numbers = found.x;
            let moved = self.audited(&search, &free_numbers, (start, told), watch)?;
            let is_new = search.take_worst(&moved.design)? | search.take_steps(&moved)?;
            let moved = AuditedStep {
                verdict: rank(&moved).0,
                excess: self.aim.excess(&moved),
                least: search.least_of_limits(&free_numbers),
                told: Box::new(moved),
            };
            let (is_reached, gains) =
                (moved.is_reached(), best.as_ref().is_none_or(|best| moved.gains_on(best, GAIN)));
            if gains {
                best = Some(moved);
            }
            if is_reached || !is_new || !gains {
                break;
            }
        }
        Ok(best)
    }

    /// The design at x with its audit.
    fn audited(
        &self,
        search: &StepShaping,
        x: &[f64],
        (start, told): (&Design, &ProjectDesign),
        watch: Watch<'_>,
    ) -> Result<ProjectDesign, DesignError> {
        let compensation = Compensation::new(&search.shaping.controller(x), self.problem.sensor.clone())?;
        let has_prefilter = told.designed.problem.has_prefilter;
        let problem =
            RobustProblem { compensation, has_controller: true, has_prefilter, ..self.given.clone() };
        let audit: Audit = phea_qft::audit::audit(&audit_request(&problem, &problem.family), watch)?;
        let status = DesignStatus::NotConverged { rounds: start.rounds.len() };
        let design = Design { status, ..start.clone() };
        let moved = design.moved(&search.shaping, x.to_vec(), audit, &told.options);
        ProjectDesign::new(self.setup, self.given, &self.problem, moved, told.options.clone(), watch)
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
