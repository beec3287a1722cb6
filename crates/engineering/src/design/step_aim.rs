//! Path to a requirement in time: limits on tracking that lead a search towards it. They follow
//! from the requirement, and are tightened if steps of the designed loop still miss it; the design
//! is judged without them.
//!
//! ```text
//! requirement in time -> limits of tracking -> design -> steps miss it by r -> repeated for a requirement stricter by r
//! ```

use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::order::sorted_distinct;
use phea_dynamics::portable;
use phea_qft::specification::{Limit, Requirement, Specification};

use super::deployable::limit_value;
use super::{CommandOfSteps, DesignError, DesignLimitKind, ProjectDesign, design_limits};
use crate::audit::TimeFinding;
use crate::project::{DeclaredLimit, DeclaredSpecification, Project, ResponseRequirement, SpecificationKind};
use crate::robust::{RobustError, RobustProblem};
use crate::setup::Setup;
use crate::simulate::{ReachedStep, StepLimits, TimeRequirement};
use crate::specification::{specification, specifications};
use phea_dynamics::closed_loop::ClosedLoop;

/// Largest number of repetitions of a design with stricter limits.
pub(super) const REPETITIONS: usize = 3;
/// Least gain of a prefilter towards which a loop is led.
const LEAST_PREFILTER_GAIN: f64 = 1.05;
/// Least lower limit of a response that counts as slow.
const SLOW: f64 = 0.9;
/// Number of points of a grid over the frequencies of a limit.
const POINTS: usize = 100;
/// Room that is left in a tightened limit.
const ROOM: f64 = 0.97;
/// Least fraction of a requirement that is aimed at.
const LEAST_FRACTION: f64 = 0.2;
/// Settling time of the upper limit divided by that of the lower one, and zero and pole multiplied
/// by it.
const UPPER_FRACTION: f64 = 0.4;
const EXTRA_ROOT: f64 = 15.0;
/// Least decay of zero and pole within the settling time, divided by the decay that a band
/// requires.
const EXTRA_DECAY: f64 = 2.0;
/// Least overshoot of an upper limit, percent.
const LEAST_OVERSHOOT_PERCENT: f64 = 0.1;
/// Design frequencies multiplied by the settling time; the last is the end of the band.
const FREQUENCIES: [f64; 6] = [0.025, 0.25, 1.25, 2.5, 5.0, 12.5];

/// Fractions of the requirements at which a search aims.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StepAim {
    overshoot: f64,
    settling: f64,
    /// Largest permitted gain of a prefilter of the loop.
    prefilter_gain: Option<f64>,
}

impl StepAim {
    /// The aim at exactly the requirement.
    pub(super) const AS_REQUIRED: StepAim = StepAim { overshoot: 1.0, settling: 1.0, prefilter_gain: None };

    /// Aim of the first search: exactly the requirement. If only a step leads the search, it aims
    /// at a loop with a deployable prefilter: a loop without gain has the spread of its plants at
    /// every frequency, and no neighbour of it is nearer to the limits on the path to the step.
    pub(super) fn first(setup: &Setup<'_>, given: &RobustProblem) -> StepAim {
        let prefilter_gain = required_step(given)
            .and(limit_value(&design_limits(setup, given), DesignLimitKind::PrefilterGain));
        StepAim { prefilter_gain, ..StepAim::AS_REQUIRED }
    }

    /// The aim with a larger permitted gain of the prefilter.
    pub(super) fn with_prefilter_gain(self, factor: f64) -> StepAim {
        StepAim { prefilter_gain: self.prefilter_gain.map(|gain| factor * gain), ..self }
    }

    /// Requirement in time at which the search aims, from the stated one.
    pub(super) fn step_limits(self, required: StepLimits) -> StepLimits {
        StepLimits {
            overshoot_percent: required.overshoot_percent.map(|most| most * self.overshoot),
            settling_time_s: required.settling_time_s.map(|time_s| time_s * self.settling),
            rise_time_s: required.rise_time_s.map(|time_s| time_s * self.settling),
            ..required
        }
    }

    /// Largest ratio of a property of the steps of a design to the aim: at most 1 if all are within
    /// it.
    pub(super) fn excess(self, project_design: &ProjectDesign) -> f64 {
        let required =
            project_design.designed.view.in_time.iter().filter(|finding| finding.requirement.follows);
        let ratio = |finding: &TimeFinding| {
            let step_limits = self.step_limits(finding.requirement.step_limits);
            finding.reached().map_or(f64::INFINITY, |reached| step_limits.excess(&reached))
        };
        let command = project_design.exceeded_command().map_or(0.0, CommandOfSteps::ratio);
        required.map(ratio).fold(command, f64::max)
    }

    /// Aim made stricter by the deficits of a design: a loop that does without its prefilter what
    /// the prefilter exaggerates, and steps that miss a requirement; `None` without deficits, or if
    /// a stricter aim gains nothing.
    pub(super) fn stricter(self, project_design: &ProjectDesign) -> Option<StepAim> {
        let Some([most, largest]) = project_design.exceeded_prefilter_gain() else {
            return self.stricter_steps(project_design);
        };
        let lower = |known: f64| (known * most / largest).max(LEAST_PREFILTER_GAIN);
        let aim = StepAim { prefilter_gain: Some(self.prefilter_gain.map_or(most, lower)), ..self };
        (aim != self).then_some(aim)
    }

    /// Aim made stricter by as much as the steps of a design miss a requirement; `None` if they
    /// miss none, or if a stricter aim gains nothing.
    fn stricter_steps(self, project_design: &ProjectDesign) -> Option<StepAim> {
        let missed = project_design.designed.view.in_time.iter().find(|finding| finding.violates())?;
        self.stricter_by(&missed.requirement.step_limits, &missed.reached()?)
    }

    /// Aim made stricter by as much as these steps miss a requirement.
    pub(super) fn stricter_by(self, step_limits: &StepLimits, reached: &ReachedStep) -> Option<StepAim> {
        let over = |value: f64, most: Option<f64>| {
            let ratio = value / most?.max(LEAST_OVERSHOOT_PERCENT);
            (ratio > 1.0).then_some(ratio)
        };
        let late = |time_s: f64, most: Option<f64>| Some(time_s / most?).filter(|ratio| *ratio > 1.0);
        let overshoot = over(reached.overshoot_percent, step_limits.overshoot_percent);
        let slower = late(reached.settling_time_s, step_limits.settling_time_s)
            .into_iter()
            .chain(late(reached.rise_time_s, step_limits.rise_time_s))
            .reduce(f64::max);
        let tightened = |fraction: f64, ratio: Option<f64>| match ratio {
            Some(ratio) if ratio.is_finite() => (fraction * ROOM / ratio).max(LEAST_FRACTION),
            Some(_) => (0.5 * fraction).max(LEAST_FRACTION),
            None => fraction,
        };
        let aim = StepAim {
            overshoot: tightened(self.overshoot, overshoot),
            settling: tightened(self.settling, slower),
            ..self
        };
        (aim != self).then_some(aim)
    }

    /// Problem that is searched with this aim: limits of tracking that follow from a requirement
    /// are replaced by those of a stricter one; if only a step is required, limits that lead to it
    /// are added.
    ///
    /// # Errors
    /// [`DesignError`] for a requirement without limits.
    pub(super) fn of(self, project: &Project, given: &RobustProblem) -> Result<RobustProblem, DesignError> {
        let mut problem = given.clone();
        let aimed = Project {
            specifications: project.specifications.iter().map(|one| self.aimed(one)).collect(),
            ..project.clone()
        };
        let limits = specifications(&aimed).map_err(RobustError::from)?;
        for (own, limit) in problem.specifications.iter_mut().zip(limits) {
            *own = limit;
        }
        if let Some(required) = required_step(given) {
            problem.specifications.push(self.towards(required)?);
            problem.design_limits.push(DesignLimitKind::RequiredStep);
        }
        let led = self.prefilter_gain.and_then(|most| without_prefilter(&problem.specifications, most));
        if let Some(specification) = led {
            problem.specifications.push(specification);
            problem.design_limits.push(DesignLimitKind::PrefilterGain);
        }
        Ok(problem)
    }

    /// A specification with limits for a stricter requirement.
    fn aimed(self, declared: &DeclaredSpecification) -> DeclaredSpecification {
        let mut stricter = declared.clone();
        for limit in [&mut stricter.upper, &mut stricter.lower] {
            let Some(DeclaredLimit::Response(step_limits)) = limit else { continue };
            if step_limits.function.is_none() {
                step_limits.overshoot_percent = step_limits
                    .overshoot_percent
                    .map(|most| (self.overshoot * most).max(LEAST_OVERSHOOT_PERCENT));
            }
        }
        if let Some(DeclaredLimit::Response(step_limits)) = &mut stricter.lower
            && step_limits.function.is_none()
        {
            step_limits.settling_time = step_limits.settling_time.map(|time_s| self.settling * time_s);
        }
        stricter
    }

    /// Limits of tracking that lead to a required step.
    fn towards(self, required: &TimeRequirement) -> Result<Specification, DesignError> {
        let step_limits = required.step_limits;
        let settling_s = self.settling * step_limits.horizon_s;
        let response = |settling_s: f64| ResponseRequirement {
            settling_time: Some(settling_s),
            settling_band_percent: Some(step_limits.band_percent),
            ..ResponseRequirement::default()
        };
        // one pole settles at p t = ln(100/band)
        let decay = EXTRA_DECAY * portable::ln(100.0 / step_limits.band_percent);
        let root = Some(EXTRA_ROOT.max(decay) / step_limits.horizon_s);
        let overshoot_percent =
            self.overshoot * step_limits.overshoot_percent.unwrap_or(step_limits.band_percent);
        let upper = ResponseRequirement {
            overshoot_percent: Some(overshoot_percent.max(LEAST_OVERSHOOT_PERCENT)),
            zero: root,
            ..response(UPPER_FRACTION * settling_s)
        };
        let frequencies = FREQUENCIES.map(|factor| factor / step_limits.horizon_s).to_vec();
        let declared = DeclaredSpecification {
            kind: SpecificationKind::ClosedLoop(ClosedLoop::Tracking),
            upper: Some(DeclaredLimit::Response(upper)),
            lower: Some(DeclaredLimit::Response(ResponseRequirement { pole: root, ..response(settling_s) })),
            frequencies,
            ..DeclaredSpecification::default()
        };
        Ok(specification(&declared, ClosedLoop::Tracking, required.number).map_err(RobustError::from)?)
    }
}

/// The required step towards which separate limits on tracking lead a search; `None` if
/// specifications limit tracking, or no step is required.
fn required_step(given: &RobustProblem) -> Option<&TimeRequirement> {
    let tracks = |one: &Specification| one.requirement.is_tracking();
    let required = given.in_time.iter().find(|one| one.limits.is_none());
    required.filter(|_| !given.specifications.iter().any(tracks))
}

/// A limit that leads to a loop whose prefilter needs no larger gain, from the first limit on
/// tracking; `None` if there is none.
///
/// ```text
/// |F| <= gain,   |F T| >= lower          require  |T| >= lower/gain,   which follows from  |1 - T| = |S| <= 1 - lower/gain
/// ```
///
/// The limit is required where the lower limit is at least 0.9, and nowhere less than 0.9 at lower
/// frequencies.
fn without_prefilter(specifications: &[Specification], gain: f64) -> Option<Specification> {
    let tracking = specifications.iter().find(|one| one.requirement.is_tracking())?;
    let lower = tracking.requirement.limits().0?;
    let [first, last] = [tracking.frequencies_rad_per_s.first()?, tracking.frequencies_rad_per_s.last()?];
    let grid = logarithmic_grid(*first, *last, POINTS).unwrap_or_default();
    let is_slow = |frequency: &f64| lower.magnitude(*frequency).is_some_and(|limit| limit >= SLOW);
    let top = grid.into_iter().take_while(is_slow).last()?;
    let requirement =
        Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(1.0 - SLOW / gain.max(1.0)));
    let frequencies_rad_per_s = sorted_distinct([0.3 * top, top].into());
    Some(Specification { requirement, frequencies_rad_per_s, band_rad_per_s: [0.0, top] })
}
