//! Requirements in time that limits of tracking follow from, or are stated with, compared with the
//! steps of the linear loop. A limit on magnitudes does not bound a response in time, so a loop
//! within the limits may still miss the requirement.

use phea_dynamics::portable;
use phea_dynamics::time_response::{StepBaseline, StepMetrics, TimeResponseError, step_metrics};
use phea_qft::closed_loop::Member;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::{Audit, PlantPoint, Verdict};

use super::margins::{corners, spread, worst_plants};
use crate::linear_step::{KnownResponses, StepResponse, StepSignal, linear_step_knowing};
use crate::robust::RobustProblem;
use crate::simulate::{ReachedStep, TimeRequirement, TrackingWish};

/// What the steps of the plants that were visited do.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeFinding {
    /// What is required.
    pub requirement: TimeRequirement,
    /// The result.
    pub outcome: TimeOutcome,
}

/// The result for a requirement in time.
#[derive(Clone, Debug, PartialEq)]
pub enum TimeOutcome {
    /// The steps of plants were computed: evidence of a search.
    Searched {
        /// How many.
        plants: usize,
        /// The most overshoot, percent of the step; `None` where none is required.
        overshoot: Option<WorstStep>,
        /// The longest settling time, s, infinite where a step does not settle, or not within the
        /// time that was computed; likewise.
        settling: Option<WorstStep>,
        /// The longest rise from 10 to 90 percent, s, infinite where a step does not rise within
        /// the time that was computed; likewise.
        rise: Option<WorstStep>,
    },
    /// No step was computed.
    NotExamined(Unexamined),
}

/// Why no step was computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Unexamined {
    /// Without a prefilter the spread of the family is judged, and no response.
    NoPrefilter,
    /// Measured plants are not known beyond their frequencies.
    Measured,
    /// Not every plant is known to be stable.
    NotStable,
    /// A step cannot be computed.
    Step(TimeResponseError),
}

/// A property of the worst step.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstStep {
    /// Percent or s.
    pub value: f64,
    /// Whether the requirement is satisfied.
    pub is_satisfied: bool,
    /// The plant.
    pub plant: PlantPoint,
}

/// Overshoot that counts as none, percent of the step: the accuracy of a computed response.
const ACCURACY_PERCENT: f64 = 0.01;
/// The same for a plant without polynomials.
const ACCURACY_OF_RESPONSE_PERCENT: f64 = 0.1;
/// Duration of a step, in settling times that are required, and the points of a continuous one.
const SETTLING_TIMES: f64 = 10.0;
const POINTS: usize = 2000;
/// The first part of a continuous one has as many points by itself, in settling times.
const SOON: f64 = 2.0;
/// A step that has not settled in this share of it is computed for longer, by this factor and so
/// often: every plant is stable.
const SETTLED_BY: f64 = 0.5;
const LONGER: u16 = 4;
const EXTENSIONS: usize = 3;
/// The same of a step that has not settled at all, though it ends in its band: the loop may be far
/// slower than what is required.
const EXTENSIONS_UNSETTLED: usize = 7;
/// The same of a plant with waves in its lines, whose points grow with the duration.
const EXTENSIONS_RESPONDING: usize = 4;
/// Frequency that stands for zero, at which integrators have no response, rad/s.
const AT_REST: f64 = 1e-9;
/// Most members of a family whose steps are computed; of plants without polynomials, whose steps
/// cost a hundred times as much.
const MEMBERS: usize = 150;
const MEMBERS_OF_RESPONSES: usize = 12;
const CORNERS_OF_RESPONSES: usize = 16;
/// Most members whose steps are computed where loops are compared that were not audited.
const MEMBERS_COMPARED: usize = 40;
/// Plants from which each property is followed between the members; first and last step, as shares
/// of the box; most plants that are visited.
const STARTS: usize = 3;
const FIRST_SHARE: f64 = 0.25;
const LEAST_SHARE: f64 = 0.01;
const VISITED_MAXIMUM: usize = 600;

impl TimeFinding {
    /// Whether a step misses what is part of the verdict.
    pub fn violates(&self) -> bool {
        self.requirement.follows && self.verdict() == Some(Verdict::Violated)
    }

    /// Its part of the verdict on a project: not proven where no step of a specification of its own
    /// was computed.
    pub fn part_of_verdict(&self) -> Verdict {
        match self.verdict() {
            Some(Verdict::Violated) if self.requirement.follows => Verdict::Violated,
            None if self.requirement.limits.is_none() => Verdict::NotProven,
            _ => Verdict::Met,
        }
    }

    /// The worst of each property that is required, zero where it is not; `None` where no step was
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

    /// The worst step of the property that is furthest beyond its limit, or else nearest to it.
    pub fn nearest(&self) -> Option<&WorstStep> {
        let TimeOutcome::Searched { overshoot, settling, rise, .. } = &self.outcome else { return None };
        let TrackingWish { overshoot_percent, settling_time_s, rise_time_s, .. } = self.requirement.wish;
        let each = [(overshoot, overshoot_percent), (settling, settling_time_s), (rise, rise_time_s)];
        let shares = each.into_iter().filter_map(|(worst, most)| {
            let worst = worst.as_ref()?;
            Some((worst.value / most?.max(ACCURACY_PERCENT), worst))
        });
        shares.max_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, worst)| worst)
    }

    /// The verdict on the steps alone; `None` where no step was computed.
    pub fn verdict(&self) -> Option<Verdict> {
        let TimeOutcome::Searched { overshoot, settling, rise, .. } = &self.outcome else { return None };
        let satisfied = overshoot.iter().chain(settling).chain(rise).all(|worst| worst.is_satisfied);
        Some(if satisfied { Verdict::Met } else { Verdict::Violated })
    }
}

/// The findings for every requirement in time of a problem, after its audit.
pub(super) fn findings(problem: &RobustProblem, audit: &Audit) -> Vec<TimeFinding> {
    let of = |requirement: &TimeRequirement| TimeFinding {
        requirement: *requirement,
        outcome: outcome(problem, audit, requirement).unwrap_or_else(TimeOutcome::NotExamined),
    };
    problem.in_time.iter().map(of).collect()
}

fn outcome(
    problem: &RobustProblem,
    audit: &Audit,
    requirement: &TimeRequirement,
) -> Result<TimeOutcome, Unexamined> {
    let Family::Uncertain(family) = &problem.family else { return Err(Unexamined::Measured) };
    if requirement.limits.is_some() && !problem.has_prefilter {
        return Err(Unexamined::NoPrefilter);
    }
    if audit.stability.verdict != Verdict::Met {
        return Err(Unexamined::NotStable);
    }
    let mut search = StepSearch { problem, family, wish: requirement.wish, visited: vec![] };
    for values in visited(family, audit) {
        search.visit(&values).map_err(Unexamined::Step)?;
    }
    if family.extent() == Extent::Box && family.plant().is_rational() {
        search.between().map_err(Unexamined::Step)?;
    }
    let [overshoot, settling, rise] = [0, 1, 2].map(|property| search.worst(property));
    Ok(TimeOutcome::Searched { plants: search.visited.len(), overshoot, settling, rise })
}

/// The worst of the nominal plant and of members spread over the family, without an audit; `None`
/// where one of them is not known to be stable, or has no step.
pub(crate) fn steps_of_members(
    problem: &RobustProblem,
    requirement: &TimeRequirement,
) -> Option<ReachedStep> {
    let Family::Uncertain(family) = &problem.family else { return None };
    let most = if family.plant().is_rational() { MEMBERS_COMPARED } else { MEMBERS_OF_RESPONSES };
    let mut search = StepSearch { problem, family, wish: requirement.wish, visited: vec![] };
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

/// The nominal plant and members spread over the family, so many at most. The members of plants
/// without polynomials are without the corners of the box: these are among them too.
pub(crate) fn spread_over(family: &UncertainFamily, most: usize) -> Vec<Vec<f64>> {
    let mut found = vec![family.plant().nominal()];
    found.extend(spread(family.members(), most));
    if !family.plant().is_rational() {
        found.extend(spread(&corners(family), CORNERS_OF_RESPONSES));
    }
    found
}

/// Plants spread over the family, and those that the audit found worst.
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

/// Steps of plants: overshoot in percent, settling time and rise time in s, each computed once.
struct StepSearch<'a> {
    problem: &'a RobustProblem,
    family: &'a UncertainFamily,
    wish: TrackingWish,
    visited: Vec<(Vec<f64>, [f64; 3])>,
}

impl StepSearch<'_> {
    /// Overshoot in percent, settling time and rise time in s of the step of a plant.
    fn step(&self, values: &[f64]) -> Result<[f64; 3], TimeResponseError> {
        let compensation = &self.problem.compensation;
        let member = compensation.member_of(self.family.plant(), values)?;
        let known = KnownResponses::default();
        let within = |duration_s: f64, points: usize| {
            let signal = (&member, StepSignal::Output);
            let StepResponse { times_s, values } =
                linear_step_knowing(signal, compensation, (duration_s, points), &known)?;
            step_metrics(&times_s, &values, StepBaseline::unit(), self.wish.band_percent)
        };
        let is_responding = matches!(member, Member::Responding { .. });
        let mut duration_s = SETTLING_TIMES * self.wish.horizon_s;
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
            // the peak of a fast swing lies between the points of a long response
            let soon_s = SOON * self.wish.horizon_s;
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

    /// True while a time that is required is not known.
    fn lacks(&self, metrics: &StepMetrics) -> bool {
        let TrackingWish { settling_time_s, rise_time_s, .. } = self.wish;
        settling_time_s.is_some() && metrics.settling.time_s().is_none()
            || rise_time_s.is_some() && metrics.rise_time_10_90_s.is_none()
    }

    /// True where the response to a step comes to rest within the band, and where that is unknown.
    fn ends_in_band(&self, member: &Member) -> bool {
        let response = self.problem.response(member, AT_REST);
        let at_rest = response.map(|found| {
            let forward = found.controller * found.plant;
            found.prefilter * forward / (1.0 + forward * found.sensor)
        });
        let is_within = |at_rest| 100.0 * portable::magnitude(at_rest - 1.0) <= self.wish.band_percent;
        at_rest.is_none_or(is_within)
    }

    /// The same, kept.
    fn visit(&mut self, values: &[f64]) -> Result<[f64; 3], TimeResponseError> {
        if let Some((_, known)) = self.visited.iter().find(|(known, _)| known == values) {
            return Ok(*known);
        }
        let found = self.step(values)?;
        self.visited.push((values.to_vec(), found));
        Ok(found)
    }

    /// The limit of each property; `None` where none is required.
    fn required(&self) -> [Option<f64>; 3] {
        let room =
            if self.family.plant().is_rational() { ACCURACY_PERCENT } else { ACCURACY_OF_RESPONSE_PERCENT };
        let TrackingWish { overshoot_percent, settling_time_s, rise_time_s, .. } = self.wish;
        [overshoot_percent.map(|most| most.max(room)), settling_time_s, rise_time_s]
    }

    /// The worst of a property that is required.
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

    /// Follows each property that is required from its worst plants along the coordinates of the
    /// box, as long as it becomes worse.
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

    /// Moves from a plant to a worse one beside it.
    fn follow(&mut self, property: usize, start: Vec<f64>) -> Result<(), TimeResponseError> {
        let family = self.family;
        worst_beside(family, start, |values| {
            let value = self.visit(values)?[property];
            Ok(VisitedPlant { value, is_last: self.visited.len() >= VISITED_MAXIMUM })
        })
    }
}

/// A plant that a search for a worse one visited.
pub(crate) struct VisitedPlant {
    /// The larger the worse.
    pub(crate) value: f64,
    /// True where the search has visited as many plants as it may.
    pub(crate) is_last: bool,
}

/// Moves from a plant of a family to a worse one beside it, one coordinate after the other, and in
/// smaller steps once none is worse.
pub(crate) fn worst_beside<E>(
    family: &UncertainFamily,
    start: Vec<f64>,
    mut visit: impl FnMut(&[f64]) -> Result<VisitedPlant, E>,
) -> Result<(), E> {
    let VisitedPlant { value: mut worst, mut is_last } = visit(&start)?;
    let mut shares = family.shares(&start);
    let mut step = FIRST_SHARE;
    while step >= LEAST_SHARE && worst.is_finite() && !is_last {
        let before = worst;
        for coordinate in 0..shares.len() {
            for moved in [step, -step] {
                let mut beside = shares.clone();
                beside[coordinate] = (beside[coordinate] + moved).clamp(0.0, 1.0);
                let found = visit(&family.values(&beside))?;
                is_last = found.is_last;
                if found.value > worst {
                    (worst, shares) = (found.value, beside);
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
