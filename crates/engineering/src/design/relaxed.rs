//! Gain from relaxing a limit of a design: the last search, continued from the controller that it
//! found, with only that limit wider by a tenth.
//!
//! ```text
//! gained = f(limits) - f(limits, one of them wider),      f the least objective, or minus the greatest worst margin
//! ```
//!
//! The gain is the value of a search and not a slope, so that it includes the limits that bind in
//! place of the relaxed one. Structure, plants and frequencies are those of the design; the result
//! is not audited.

use phea_dynamics::watch::{Watch, part};
use phea_qft::closed_loop::Compensation;
use phea_qft::design::{BINDING_DB, DesignStatus, LoopDesignError, last_search, sample_near_worst};
use phea_qft::loop_shaping::{Aim, LocalOptimum, SearchProblem, Shaping, Structure};
use phea_qft::specification::Specification;

use super::by_steps::{AimedSteps, StepShaping, last_step_search};
use super::deployable::specification;
use super::structures::noise_gain_around;
use super::{DesignError, DesignLimit, DesignLimitKind, DesignRun, ProjectDesign};
use crate::limit_kind::RELAXED_BY;
use crate::robust::{RobustError, RobustProblem};
use crate::setup::Setup;

/// Name of the stage.
const STAGE: &str = "relaxing each limit";

/// A limit that can be relaxed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxedLimit {
    /// A specification of a closed loop, by its index.
    Specification(usize),
    /// The requirement of a step, by its index among the requirements in time.
    Steps(usize),
    /// A limit of a deployable controller.
    Design(DesignLimitKind),
}

/// Gain from relaxing one limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxedGain {
    /// Relaxed limit.
    pub limit: RelaxedLimit,
    /// Decrease of the objective or, if the worst margin counts, increase of that margin, dB.
    pub gained_db: f64,
    /// Decrease of the largest gain from the noise of the sensor to the command of the nominal
    /// loop, dB; absent if it is not known.
    pub noise_gained_db: Option<f64>,
}

/// Quantity by which gains of a design are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gained {
    /// The objective, for a design that is met.
    #[default]
    Objective,
    /// The worst margin, for a design for the best margin, and for one that is missed.
    WorstMargin,
}

/// Gains from relaxing the limits that bind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Relaxations {
    /// Quantity that is gained.
    pub of: Gained,
    /// Gain from each limit that binds.
    pub limits: Vec<RelaxedGain>,
}

/// The last search of a design.
#[derive(Clone)]
enum LastSearch<'a> {
    OverFrequency(Box<Shaping>),
    BySteps(Box<StepShaping<'a>>),
}

/// The limits of a search.
struct SearchLimits {
    structure: Structure,
    specifications: Vec<Specification>,
    delay_s: f64,
    /// Ratio of the permitted properties of a step to the requirement.
    steps: f64,
    /// Ratio of the permitted command of a step to its limit.
    command: f64,
}

/// A design whose limits are relaxed in turn.
struct RelaxedDesign<'a> {
    setup: &'a Setup<'a>,
    aimed: AimedSteps<'a>,
    project_design: &'a ProjectDesign,
    search: LastSearch<'a>,
    delay_s: f64,
}

/// Gain from relaxing each limit that binds; empty if no search ended.
///
/// # Errors
/// [`DesignError`] for a loop that cannot be sampled, and for cancellation by `watch`.
pub(super) fn relaxations<'a>(
    setup: &'a Setup<'a>,
    aimed: AimedSteps<'a>,
    (run, project_design): (&'a DesignRun, &'a ProjectDesign),
    watch: Watch<'_>,
) -> Result<Relaxations, DesignError> {
    let has_no_end = matches!(
        project_design.design.status,
        DesignStatus::NotConverged { .. } | DesignStatus::NotStabilised
    );
    let (Some(samples), false) = (run.outcome.samples(), has_no_end || project_design.is_stopped()) else {
        return Ok(Relaxations::default());
    };
    let watch = &mut part(watch, STAGE, [0.0, 1.0]);
    let (search, (aim, reserve_db)) = match last_step_search(setup, aimed, (run, project_design))? {
        Some((search, aim)) => (LastSearch::BySteps(Box::new(search)), aim),
        None => {
            let found = last_search(&project_design.design, samples.clone(), &project_design.options);
            let (shaping, aim) = found.map_err(LoopDesignError::from)?;
            (LastSearch::OverFrequency(Box::new(shaping)), (aim, 0.0))
        }
    };
    let at = project_design.design.free_numbers.as_slice();
    let end = LocalOptimum::near(search.clone().problem(), at, (aim, reserve_db), watch)?;
    let Some(end) = end else { return Ok(Relaxations::default()) };
    let delay_s = run.problem.minimum_delay_margin_s;
    let relaxed = RelaxedDesign { setup, aimed, project_design, search, delay_s };
    let mut limits = Vec::new();
    for limit in relaxed.binding() {
        // a limit that does not exist in its wider form cannot be relaxed
        let Ok(wider) = relaxed.wider(limit) else { continue };
        let mut wider = relaxed.search.with_limits(wider);
        let Some(first) = end.continued(wider.problem(), watch)? else { continue };
        sample_near_worst(wider.shaping(), &first.x)?;
        let Some(found) = first.continued(wider.problem(), watch)? else { continue };
        let noise_db = |x: &[f64]| relaxed.noise_gain_db(x);
        limits.push(RelaxedGain {
            limit,
            gained_db: (end.value_db - found.value_db).max(0.0),
            noise_gained_db: noise_db(&end.x).zip(noise_db(&found.x)).map(|(own, other)| own - other),
        });
    }
    let of = if aim == Aim::Objective { Gained::Objective } else { Gained::WorstMargin };
    Ok(Relaxations { of, limits })
}

impl<'a> LastSearch<'a> {
    fn problem(&mut self) -> &mut dyn SearchProblem {
        match self {
            LastSearch::OverFrequency(shaping) => shaping.as_mut(),
            LastSearch::BySteps(search) => search.as_mut(),
        }
    }

    /// Shaping of the search, with its samples.
    fn shaping(&mut self) -> &mut Shaping {
        match self {
            LastSearch::OverFrequency(shaping) => shaping.as_mut(),
            LastSearch::BySteps(search) => &mut search.shaping,
        }
    }

    fn with_limits(&self, limits: SearchLimits) -> LastSearch<'a> {
        let SearchLimits { structure, specifications, delay_s, steps, command } = limits;
        let limits = (specifications, delay_s);
        match self {
            LastSearch::OverFrequency(shaping) => {
                LastSearch::OverFrequency(Box::new(shaping.with_limits(structure, limits)))
            }
            LastSearch::BySteps(search) => {
                LastSearch::BySteps(Box::new(search.with_limits(structure, limits, [steps, command])))
            }
        }
    }
}

impl RelaxedDesign<'_> {
    /// Largest gain of the nominal loop from the noise of the sensor to the command, dB.
    fn noise_gain_db(&self, x: &[f64]) -> Option<f64> {
        let shaping = match &self.search {
            LastSearch::OverFrequency(shaping) => shaping,
            LastSearch::BySteps(search) => &search.shaping,
        };
        let sensor = self.setup.sensor.clone();
        let compensation = Compensation::new(&shaping.controller(x), sensor).ok()?;
        let around = RobustProblem { compensation, ..self.project_design.designed.problem.clone() };
        noise_gain_around(&around, &shaping.samples().frequencies_rad_per_s())
    }

    /// Limits that bind: those within [`BINDING_DB`] of the loop or in conflict, ends of ranges
    /// that a free number reaches, and, for a design led by its steps, their requirement.
    fn binding(&self) -> Vec<RelaxedLimit> {
        let own = self.project_design.designed.problem.specifications.len();
        let touched = self.project_design.touched();
        let specifications = (0..own).filter(|index| touched.contains(index));
        let steps = self.project_design.designed.view.in_time.iter().enumerate();
        let steps =
            steps.filter(|(_, finding)| finding.requirement.limits.is_none() && self.leads_to_steps());
        let limits = self.project_design.limits.iter().filter(|limit| self.is_relaxed(limit));
        specifications
            .map(RelaxedLimit::Specification)
            .chain(steps.map(|(index, _)| RelaxedLimit::Steps(index)))
            .chain(limits.map(|limit| RelaxedLimit::Design(limit.kind)))
            .collect()
    }

    /// True if the search was led by its steps, or the limits on the path to them bind.
    fn leads_to_steps(&self) -> bool {
        matches!(self.search, LastSearch::BySteps(_)) || self.touches_way()
    }

    /// True if the limits of tracking on the path to a required step bind.
    fn touches_way(&self) -> bool {
        let worst = self.project_design.limit_finding(DesignLimitKind::RequiredStep);
        worst.and_then(|found| found.worst.as_ref()).is_some_and(|worst| worst.margin_db < BINDING_DB)
    }

    /// True if a limit binds and this search can relax it: the command of steps is no limit of a
    /// search over frequency.
    fn is_relaxed(&self, limit: &DesignLimit) -> bool {
        let is_searched =
            limit.kind != DesignLimitKind::CommandOfSteps || matches!(self.search, LastSearch::BySteps(_));
        is_searched && self.project_design.binds(limit) == Some(true)
    }

    /// Index of a limit among those that are specifications.
    fn index(&self, kind: DesignLimitKind) -> Option<usize> {
        self.project_design.limit_findings.iter().position(|(known, _)| *known == kind)
    }

    /// Specifications for which the search was made, with this permitted multiple of the prefilter
    /// gain.
    fn specifications(
        &self,
        given: RobustProblem,
        prefilter_gain: f64,
    ) -> Result<Vec<Specification>, DesignError> {
        let aim = self.aimed.aim.with_prefilter_gain(prefilter_gain);
        Ok(match self.search {
            LastSearch::OverFrequency(_) => aim.of(self.setup.project, &given)?.specifications,
            LastSearch::BySteps(_) => given.specifications,
        })
    }

    /// Limits of the search with one of them wider.
    fn wider(&self, limit: RelaxedLimit) -> Result<SearchLimits, DesignError> {
        let mut given = self.aimed.given.clone();
        let (mut steps, mut command, mut gain, mut delay_s) = (1.0, 1.0, 1.0, self.delay_s);
        let mut structure = self.project_design.design.structure.clone();
        match limit {
            RelaxedLimit::Steps(index) => {
                steps = 1.0 + RELAXED_BY;
                if let Some(required) = given.in_time.get_mut(index) {
                    required.step_limits = required.step_limits.wider(steps);
                }
            }
            RelaxedLimit::Design(DesignLimitKind::PrefilterGain) => gain = 1.0 + RELAXED_BY,
            RelaxedLimit::Design(kind @ DesignLimitKind::CommandOfSteps) => command = kind.relaxed(command),
            RelaxedLimit::Design(kind @ DesignLimitKind::MinimumDelayMargin) => {
                delay_s = kind.relaxed(delay_s);
            }
            RelaxedLimit::Design(kind) => structure = self.project_design.structure_with_wider(kind),
            RelaxedLimit::Specification(_) => {}
        }
        let mut specifications = self.specifications(given, gain)?;
        let own = self.project_design.designed.problem.specifications.len();
        match limit {
            RelaxedLimit::Specification(index) => {
                if let Some(one) = specifications.get_mut(index) {
                    let wider = one.requirement.wider(1.0 + RELAXED_BY);
                    one.requirement = wider.map_err(RobustError::from)?;
                }
            }
            RelaxedLimit::Design(kind) => {
                let place = self.index(kind).and_then(|index| specifications.get_mut(own + index));
                let limit = self.project_design.limits.iter().find(|known| known.kind == kind);
                let wider = limit.and_then(|limit| {
                    specification((self.setup, self.aimed.given), kind, kind.relaxed(limit.value))
                });
                if let (Some(place), Some(wider)) = (place, wider) {
                    *place = wider;
                }
            }
            RelaxedLimit::Steps(_) => {}
        }
        Ok(SearchLimits { structure, specifications, delay_s, steps, command })
    }
}
