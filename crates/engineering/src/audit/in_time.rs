//! Requirements in time from which limits of tracking follow, or which are stated with them,
//! compared with the steps of the linear loop. A limit on magnitudes does not bound a response in
//! time, so a loop within the limits may still miss the requirement.

use phea_dynamics::portable;
use phea_dynamics::time_response::{StepBaseline, StepMetrics, TimeResponseError, step_metrics};
use phea_dynamics::watch::{Progress, Stopped, Watch};
use phea_qft::closed_loop::Member;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::{Audit, PlantPoint, Verdict};

use super::STAGE;
use super::margins::{corners, spread, worst_plants};
use crate::linear_step::{KnownResponses, StepResponse, StepSignal, linear_step_knowing};
use crate::robust::RobustProblem;
use crate::simulate::{ReachedStep, StepLimits, TimeRequirement};

/// Finding for the steps of the plants that were visited.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeFinding {
    /// Requirement in time.
    pub requirement: TimeRequirement,
    /// The result.
    pub outcome: TimeOutcome,
}

/// The result for a requirement in time.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeOutcome {
    /// The steps of plants were computed: evidence of a search.
    Searched {
        /// Number of plants.
        plants: usize,
        /// Greatest overshoot, percent of the step; `None` if it is not required.
        overshoot: Option<WorstStep>,
        /// Longest settling time, s; infinite if a step does not settle, or not within the computed
        /// time; `None` if it is not required.
        settling: Option<WorstStep>,
        /// Longest rise from 10 to 90 percent, s; infinite if a step does not rise within the
        /// computed time; `None` if it is not required.
        rise: Option<WorstStep>,
    },
    /// No step was computed.
    NotExamined(Unexamined),
}

/// Reason why no step was computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Unexamined {
    /// There is no prefilter: the spread of the family is judged instead of a response.
    NoPrefilter,
    /// Measured plants are unknown beyond their frequencies.
    Measured,
    /// Some plants are not known to be stable.
    NotStable,
    /// A step cannot be computed.
    Step(TimeResponseError),
}

/// A property of the worst step.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstStep {
    /// Value, percent or s.
    pub value: f64,
    /// True if the requirement is satisfied.
    pub is_satisfied: bool,
    /// Plant with this step.
    pub plant: PlantPoint,
}

/// Overshoot that counts as zero, percent of the step: the accuracy of a computed response.
const ACCURACY_PERCENT: f64 = 0.01;
/// Overshoot that counts as zero for a plant without polynomials, percent of the step.
const ACCURACY_OF_RESPONSE_PERCENT: f64 = 0.1;
/// Duration of a step in required settling times, and number of points of a continuous step.
const SETTLING_TIMES: f64 = 10.0;
const POINTS: usize = 2000;
/// Length, in required settling times, of the first part of a continuous step, which has as many
/// points.
const SOON: f64 = 2.0;
/// Fraction of a step within which it must have settled; otherwise it is computed for longer, by
/// this factor and at most this often: every plant is stable.
const SETTLED_BY: f64 = 0.5;
const LONGER: u16 = 4;
const EXTENSIONS: usize = 3;
/// Number of extensions of a step that has not settled at all although its final value is within
/// the band: the loop may be far slower than required.
const EXTENSIONS_UNSETTLED: usize = 7;
/// Number of extensions for a plant with waves in its lines, whose number of points grows with the
/// duration.
const EXTENSIONS_RESPONDING: usize = 4;
/// Frequency used in place of zero, at which integrators have no response, rad/s.
const AT_REST: f64 = 1e-9;
/// Largest number of members of a family whose steps are computed; for plants without polynomials
/// fewer, since their steps cost a hundred times as much.
const MEMBERS: usize = 150;
const MEMBERS_OF_RESPONSES: usize = 12;
const CORNERS_OF_RESPONSES: usize = 16;
/// Largest number of members whose steps are computed to compare loops that were not audited.
const MEMBERS_COMPARED: usize = 40;
/// Number of plants from which each property is followed between the members; first and last step,
/// as fractions of the box; largest number of visited plants.
const STARTS: usize = 3;
const FIRST_FRACTION: f64 = 0.25;
const LEAST_FRACTION: f64 = 0.01;
const VISITED_MAXIMUM: usize = 600;

impl TimeFinding {
    /// True if a step misses a requirement that is part of the verdict.
    pub fn violates(&self) -> bool {
        self.requirement.follows && self.verdict() == Some(Verdict::Violated)
    }

    /// Contribution to the verdict on a project: not proven if no step of a separate specification
    /// was computed.
    pub fn part_of_verdict(&self) -> Verdict {
        match self.verdict() {
            Some(Verdict::Violated) if self.requirement.follows => Verdict::Violated,
            None if self.requirement.limits.is_none() => Verdict::NotProven,
            _ => Verdict::Met,
        }
    }

    /// Worst value of each required property, zero if it is not required; `None` if no step was
    /// computed.
    pub fn reached(&self) -> Option<ReachedStep> {
        let TimeOutcome::Searched { overshoot, settling, rise, .. } = &self.outcome else { return None };
        let value = |worst: &Option<WorstStep>| worst.as_ref().map_or(0.0, |worst| worst.value);
        Some(ReachedStep {
            overshoot_percent: value(overshoot),
            settling_time_s: value(settling),
            rise_time_s: value(rise),
        })
    }

    /// Worst step of the property that is furthest beyond its limit, or else nearest to it.
    pub fn nearest(&self) -> Option<&WorstStep> {
        let TimeOutcome::Searched { overshoot, settling, rise, .. } = &self.outcome else { return None };
        let StepLimits { overshoot_percent, settling_time_s, rise_time_s, .. } = self.requirement.step_limits;
        let each = [(overshoot, overshoot_percent), (settling, settling_time_s), (rise, rise_time_s)];
        let fractions = each.into_iter().filter_map(|(worst, most)| {
            let worst = worst.as_ref()?;
            Some((worst.value / most?.max(ACCURACY_PERCENT), worst))
        });
        fractions.max_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, worst)| worst)
    }

    /// Verdict on the steps; `None` if no step was computed.
    pub fn verdict(&self) -> Option<Verdict> {
        let TimeOutcome::Searched { overshoot, settling, rise, .. } = &self.outcome else { return None };
        let satisfied = overshoot.iter().chain(settling).chain(rise).all(|worst| worst.is_satisfied);
        Some(if satisfied { Verdict::Met } else { Verdict::Violated })
    }
}

/// Findings for every requirement in time of a problem, after its audit.
///
/// # Errors
/// [`Stopped`] if `watch` cancels them.
pub(super) fn findings(
    problem: &RobustProblem,
    audit: &Audit,
    watch: Watch<'_>,
) -> Result<Vec<TimeFinding>, Stopped> {
    let of = |requirement: &TimeRequirement| {
        let outcome = outcome(problem, audit, requirement, &mut *watch)?;
        let outcome = outcome.unwrap_or_else(TimeOutcome::NotExamined);
        Ok(TimeFinding { requirement: *requirement, outcome })
    };
    problem.in_time.iter().map(of).collect()
}

fn outcome(
    problem: &RobustProblem,
    audit: &Audit,
    requirement: &TimeRequirement,
    watch: Watch<'_>,
) -> Result<Result<TimeOutcome, Unexamined>, Stopped> {
    let Family::Uncertain(family) = &problem.family else { return Ok(Err(Unexamined::Measured)) };
    if requirement.limits.is_some() && !problem.has_prefilter {
        return Ok(Err(Unexamined::NoPrefilter));
    }
    if audit.stability.verdict != Verdict::Met {
        return Ok(Err(Unexamined::NotStable));
    }
    let mut search = StepSearch { problem, family, step_limits: requirement.step_limits, visited: vec![] };
    let plants = visited(family, audit);
    for (index, values) in plants.iter().enumerate() {
        if !watch(Progress { stage: STAGE, fraction: index as f64 / plants.len() as f64 }) {
            return Err(Stopped);
        }
        if let Err(error) = search.visit(values) {
            return Ok(Err(Unexamined::Step(error)));
        }
    }
    let between = match family.extent() == Extent::Box && family.plant().is_rational() {
        true => search.between(),
        false => Ok(()),
    };
    let [overshoot, settling, rise] = [0, 1, 2].map(|property| search.worst(property));
    let found = TimeOutcome::Searched { plants: search.visited.len(), overshoot, settling, rise };
    Ok(between.map(|()| found).map_err(Unexamined::Step))
}

/// Worst steps of the nominal plant and of members spread over the family, without an audit; `None`
/// if one of them is not known to be stable, or has no step.
pub(crate) fn steps_of_members(
    problem: &RobustProblem,
    requirement: &TimeRequirement,
) -> Option<ReachedStep> {
    let Family::Uncertain(family) = &problem.family else { return None };
    let most = if family.plant().is_rational() { MEMBERS_COMPARED } else { MEMBERS_OF_RESPONSES };
    let mut search = StepSearch { problem, family, step_limits: requirement.step_limits, visited: vec![] };
    for values in std::iter::once(family.plant().nominal()).chain(spread(family.members(), most)) {
        let member = problem.compensation.member_of(family.plant(), &values).ok()?;
        if member_stability(&member, &problem.compensation).status != StabilityStatus::Stable {
            return None;
        }
        search.visit(&values).ok()?;
    }
    let [overshoot, settling, rise] = [0, 1, 2].map(|property| search.worst(property));
    let outcome = TimeOutcome::Searched { plants: search.visited.len(), overshoot, settling, rise };
    TimeFinding { requirement: *requirement, outcome }.reached()
}

/// The nominal plant and at most this many members spread over the family. Members of plants
/// without polynomials do not include the corners of the box, so those are added.
pub(crate) fn spread_over(family: &UncertainFamily, most: usize) -> Vec<Vec<f64>> {
    let mut found = vec![family.plant().nominal()];
    found.extend(spread(family.members(), most));
    if !family.plant().is_rational() {
        found.extend(spread(&corners(family), CORNERS_OF_RESPONSES));
    }
    found
}

/// Plants spread over the family, and the worst ones of the audit.
pub(crate) fn visited(family: &UncertainFamily, audit: &Audit) -> Vec<Vec<f64>> {
    let is_rational = family.plant().is_rational();
    let mut found = spread_over(family, if is_rational { MEMBERS } else { MEMBERS_OF_RESPONSES });
    for plant in audit.specifications.iter().flat_map(worst_plants) {
        if let PlantPoint::Parameters(values) = plant {
            found.push(values.clone());
        }
    }
    let mut distinct: Vec<Vec<f64>> = Vec::new();
    for values in found {
        if !distinct.contains(&values) {
            distinct.push(values);
        }
    }
    distinct
}

/// Computed steps of plants, each computed once: overshoot, percent, settling time and rise time,
/// s.
struct StepSearch<'a> {
    problem: &'a RobustProblem,
    family: &'a UncertainFamily,
    step_limits: StepLimits,
    visited: Vec<(Vec<f64>, [f64; 3])>,
}

impl StepSearch<'_> {
    /// Overshoot, percent, and settling time and rise time, s, of the step of a plant.
    fn step(&self, values: &[f64]) -> Result<[f64; 3], TimeResponseError> {
        let compensation = &self.problem.compensation;
        let member = compensation.member_of(self.family.plant(), values)?;
        let known = KnownResponses::default();
        let within = |duration_s: f64, points: usize| {
            let signal = StepSignal::Output;
            let StepResponse { times_s, values } =
                linear_step_knowing(&member, signal, compensation, duration_s, points, &known)?;
            step_metrics(&times_s, &values, StepBaseline::unit(), self.step_limits.band_percent)
        };
        let is_responding = matches!(member, Member::Responding { .. });
        let mut duration_s = SETTLING_TIMES * self.step_limits.horizon_s;
        let mut metrics = within(duration_s, POINTS)?;
        let mut overshoot_percent = metrics.overshoot_percent;
        let mut points = POINTS;
        let most = if is_responding { EXTENSIONS_RESPONDING } else { EXTENSIONS_UNSETTLED };
        for extension in 0..most {
            let is_long = is_responding || extension >= EXTENSIONS;
            let is_enough = match metrics.settling.time_s() {
                None => is_long && !(self.lacks(&metrics) && self.ends_in_band(&member)),
                // a late swing may leave the band once more
                Some(time_s) => is_long || time_s < SETTLED_BY * duration_s,
            };
            if is_enough {
                break;
            }
            duration_s *= f64::from(LONGER);
            // the integral over time needs points as dense as before
            if is_responding {
                points *= usize::from(LONGER);
            }
            metrics = within(duration_s, points)?;
            overshoot_percent = overshoot_percent.max(metrics.overshoot_percent);
        }
        let mut times_s = [metrics.settling.time_s(), metrics.rise_time_10_90_s];
        if matches!(member, Member::Continuous { .. }) {
            // the peak of a fast swing may fall between the points of a long response
            let soon_s = SOON * self.step_limits.horizon_s;
            let soon = within(soon_s, POINTS)?;
            overshoot_percent = overshoot_percent.max(soon.overshoot_percent);
            let finer = [soon.settling.time_s(), soon.rise_time_10_90_s];
            for (time_s, finer) in times_s.iter_mut().zip(finer) {
                *time_s = time_s.filter(|known| *known > soon_s).or(finer).or(*time_s);
            }
        }
        let [settling_s, rise_s] = times_s.map(|time_s| time_s.unwrap_or(f64::INFINITY));
        Ok([overshoot_percent, settling_s, rise_s])
    }

    /// True if a required time is unknown.
    fn lacks(&self, metrics: &StepMetrics) -> bool {
        let StepLimits { settling_time_s, rise_time_s, .. } = self.step_limits;
        settling_time_s.is_some() && metrics.settling.time_s().is_none()
            || rise_time_s.is_some() && metrics.rise_time_10_90_s.is_none()
    }

    /// True if the response to a step comes to rest within the band, and if that is unknown.
    fn ends_in_band(&self, member: &Member) -> bool {
        let response = self.problem.response(member, AT_REST);
        let at_rest = response.map(|found| {
            let forward = found.controller * found.plant;
            found.prefilter * forward / (1.0 + forward * found.sensor)
        });
        let is_within = |at_rest| 100.0 * portable::magnitude(at_rest - 1.0) <= self.step_limits.band_percent;
        at_rest.is_none_or(is_within)
    }

    /// Step of a plant from the computed ones, or computed and stored.
    fn visit(&mut self, values: &[f64]) -> Result<[f64; 3], TimeResponseError> {
        if let Some((_, known)) = self.visited.iter().find(|(known, _)| known == values) {
            return Ok(*known);
        }
        let found = self.step(values)?;
        self.visited.push((values.to_vec(), found));
        Ok(found)
    }

    /// Limit of each property; `None` if it is not required.
    fn required(&self) -> [Option<f64>; 3] {
        let room =
            if self.family.plant().is_rational() { ACCURACY_PERCENT } else { ACCURACY_OF_RESPONSE_PERCENT };
        let StepLimits { overshoot_percent, settling_time_s, rise_time_s, .. } = self.step_limits;
        [overshoot_percent.map(|most| most.max(room)), settling_time_s, rise_time_s]
    }

    /// Worst value of a required property.
    fn worst(&self, property: usize) -> Option<WorstStep> {
        let most = self.required().get(property).copied().flatten()?;
        let (values, found) = self.worst_first(property).next()?;
        let value = found[property];
        let plant = PlantPoint::Parameters(values.clone());
        Some(WorstStep { value, is_satisfied: value <= most, plant })
    }

    fn worst_first(&self, property: usize) -> impl Iterator<Item = &(Vec<f64>, [f64; 3])> {
        let mut sorted: Vec<&(Vec<f64>, [f64; 3])> = self.visited.iter().collect();
        sorted.sort_by(|(_, one), (_, other)| other[property].total_cmp(&one[property]));
        sorted.into_iter()
    }

    /// Follows each required property from its worst plants along the coordinates of the box, as
    /// long as it becomes worse.
    fn between(&mut self) -> Result<(), TimeResponseError> {
        for property in 0..self.required().len() {
            if self.required()[property].is_none() {
                continue;
            }
            let starts: Vec<Vec<f64>> =
                self.worst_first(property).take(STARTS).map(|(values, _)| values.clone()).collect();
            for start in starts {
                self.follow(property, start)?;
            }
        }
        Ok(())
    }

    /// Moves from a plant to a worse neighbour.
    fn follow(&mut self, property: usize, start: Vec<f64>) -> Result<(), TimeResponseError> {
        let family = self.family;
        worst_additional(family, start, |values| {
            let value = self.visit(values)?[property];
            Ok(VisitedPlant { value, is_last: self.visited.len() >= VISITED_MAXIMUM })
        })
    }
}

/// A plant that a search for a worse one visited.
pub(crate) struct VisitedPlant {
    /// Value of the property; larger is worse.
    pub(crate) value: f64,
    /// True if the search has visited as many plants as allowed.
    pub(crate) is_last: bool,
}

/// Moves from a plant of a family to a worse neighbour, one coordinate after the other, and in
/// smaller steps once none is worse.
pub(crate) fn worst_additional<E>(
    family: &UncertainFamily,
    start: Vec<f64>,
    mut visit: impl FnMut(&[f64]) -> Result<VisitedPlant, E>,
) -> Result<(), E> {
    let VisitedPlant { value: mut worst, mut is_last } = visit(&start)?;
    let mut fractions = family.fractions(&start);
    let mut step = FIRST_FRACTION;
    while step >= LEAST_FRACTION && worst.is_finite() && !is_last {
        let before = worst;
        for coordinate in 0..fractions.len() {
            for moved in [step, -step] {
                let mut beside = fractions.clone();
                beside[coordinate] = (beside[coordinate] + moved).clamp(0.0, 1.0);
                let found = visit(&family.values(&beside))?;
                is_last = found.is_last;
                if found.value > worst {
                    (worst, fractions) = (found.value, beside);
                    break;
                }
            }
        }
        if worst <= before {
            step *= 0.5;
        }
    }
    Ok(())
}
