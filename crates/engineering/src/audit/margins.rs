//! Margins of the nominal loop, and the worst of the family.
//!
//! ```text
//! gain:      1/|L| at arg L = -180 deg              growth: the least above 1, reduction: the greatest below
//! phase:     |180 deg + arg L| where |L| = 1        the least
//! modulus:   min |1 + L|
//! delay:     the least dead time that brings L to -1
//! ```

pub(super) mod response;

use phea_dynamics::frequency::{GainMargin, Margins, PhaseMargin, decibels, margins};
use phea_dynamics::linear::{LinearError, TransferFunction};
use phea_qft::closed_loop::Member;
use phea_qft::family::{Extent, Family, UncertainFamily};
use phea_qft::stability::{StabilityStatus, member_stability};
use phea_qft::verification::{Audit, PlantPoint, SpecificationFinding, SpecificationMargin, Verdict};

use super::whole_loop;
use crate::robust::RobustProblem;

/// A margin and its frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopMargin {
    /// Value, dB, degrees, |1 + L| or s; infinite if nothing limits it.
    pub value: f64,
    /// Frequency, rad/s; `None` if nothing limits the margin.
    pub frequency_rad_per_s: Option<f64>,
    /// Plant with this margin.
    pub plant: PlantPoint,
}

/// Margins of a loop, or the worst of each in a family.
#[derive(Clone, Debug, PartialEq)]
pub struct MarginSet {
    /// Factor by which the gain may grow, dB.
    pub gain_db: LoopMargin,
    /// Factor to which the gain may fall, dB; minus infinity if it may vanish.
    pub gain_reduction_db: LoopMargin,
    /// Least angle between L and -1 at |L| = 1, degrees: lag (if positive) or lead (if negative)
    /// that brings L to -1.
    pub phase_deg: LoopMargin,
    /// Least |1 + L|.
    pub modulus: LoopMargin,
    /// Least dead time that brings L to -1, s.
    pub delay_s: LoopMargin,
}

/// Margins of the nominal loop and of the family.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AuditMargins {
    /// Margins of the nominal loop; `None` if it is not known to be stable.
    pub nominal: Option<MarginSet>,
    /// Worst margins that were found; `None` unless the family is stable.
    pub family: Option<MarginSet>,
    /// Number of plants among which these are the worst.
    pub plants: usize,
}

/// Largest number of members and corners whose margins are computed; fewer for plants without
/// polynomials.
const MEMBERS: usize = 150;
const CORNERS: usize = 64;
const MEMBERS_OF_RESPONSES: usize = 8;
/// First step of the search between the members, as a fraction of the box; it is halved this often.
const FIRST_FRACTION: f64 = 0.25;
const HALVINGS: usize = 3;

impl MarginSet {
    /// Each margin of the plant for which it is worse.
    fn worst_of(self, other: MarginSet) -> MarginSet {
        let least = |one: LoopMargin, other: LoopMargin| if other.value < one.value { other } else { one };
        let nearest = |one: LoopMargin, other: LoopMargin| {
            if other.value.abs() < one.value.abs() { other } else { one }
        };
        let greatest = |one: LoopMargin, other: LoopMargin| if other.value > one.value { other } else { one };
        MarginSet {
            gain_db: least(self.gain_db, other.gain_db),
            gain_reduction_db: greatest(self.gain_reduction_db, other.gain_reduction_db),
            phase_deg: nearest(self.phase_deg, other.phase_deg),
            modulus: least(self.modulus, other.modulus),
            delay_s: least(self.delay_s, other.delay_s),
        }
    }

    /// Margins that a search follows, each with a plant as its start.
    fn searched(&self) -> [&LoopMargin; 3] {
        [&self.gain_db, &self.gain_reduction_db, &self.phase_deg]
    }

    fn of(found: &Margins, plant: &PlantPoint) -> MarginSet {
        let gain = |margin: Option<&GainMargin>, none: f64| LoopMargin {
            value: margin.map_or(none, |margin| decibels(margin.factor)),
            frequency_rad_per_s: margin.map(|margin| margin.frequency_rad_per_s),
            plant: plant.clone(),
        };
        let crossing = |margin: Option<&PhaseMargin>, value: fn(&PhaseMargin) -> f64| LoopMargin {
            value: margin.map_or(f64::INFINITY, value),
            frequency_rad_per_s: margin.map(|margin| margin.frequency_rad_per_s),
            plant: plant.clone(),
        };
        MarginSet {
            gain_db: gain(found.gain_increase(), f64::INFINITY),
            gain_reduction_db: gain(found.gain_decrease(), f64::NEG_INFINITY),
            phase_deg: crossing(found.critical_phase(), |margin| margin.phase_deg),
            modulus: LoopMargin {
                value: found.modulus_margin.distance,
                frequency_rad_per_s: Some(found.modulus_margin.frequency_rad_per_s),
                plant: plant.clone(),
            },
            delay_s: crossing(found.critical_delay(), |margin| margin.delay_s),
        }
    }
}

impl AuditMargins {
    /// Margins after an audit. Modulus and delay margin of the family are the worst that the audit
    /// found in its box; gain and phase margin are those of the members, corners and worst plants,
    /// and of a search from the worst of these.
    pub(super) fn of(problem: &RobustProblem, audit: &Audit) -> AuditMargins {
        let is_stable = audit.stability.verdict == Verdict::Met;
        let nominal = nominal_point(problem);
        let nominal =
            of_plant(problem, &nominal).filter(|_| is_stable || member_is_stable(problem, &nominal));
        if !is_stable {
            return AuditMargins { nominal, family: None, plants: 0 };
        }
        let mut search = MarginSearch { problem, worst: nominal.clone(), plants: nominal.iter().count() };
        for plant in visited(problem, audit).iter().skip(1) {
            search.visit(plant);
        }
        search.between();
        let MarginSearch { worst, plants, .. } = search;
        let family = worst.map(|worst| with_audited(worst, audit));
        let nominal = nominal.map(|nominal| with_whole_loop(problem, nominal));
        // a delay between whole samples also changes the sampled plant: the audit samples it anew
        let least_s = family.as_ref().map_or(0.0, |family| family.delay_s.value);
        let nominal = nominal.map(|mut nominal| {
            nominal.delay_s.value = nominal.delay_s.value.max(least_s);
            nominal
        });
        AuditMargins { nominal, family, plants }
    }
}

/// The margins with the modulus and delay margin for which the audit searched the box.
fn with_audited(mut worst: MarginSet, audit: &Audit) -> MarginSet {
    if let Some(closest) = &audit.stability.closest_approach
        && closest.distance < worst.modulus.value
    {
        worst.modulus = LoopMargin {
            value: closest.distance,
            frequency_rad_per_s: Some(closest.frequency_rad_per_s),
            plant: closest.plant.clone(),
        };
    }
    if let Some(least) = &audit.delay_margin {
        worst.delay_s = LoopMargin {
            value: least.delay_s,
            frequency_rad_per_s: least.delay_s.is_finite().then_some(least.frequency_rad_per_s),
            plant: least.plant.clone(),
        };
    }
    worst
}

/// The margins with the delay that the force loop and the paths within it tolerate together.
fn with_whole_loop(problem: &RobustProblem, mut nominal: MarginSet) -> MarginSet {
    if let Some(found) = whole_loop::delay_margin(problem, &nominal.delay_s.plant) {
        nominal.delay_s = LoopMargin {
            value: found.delay_s,
            frequency_rad_per_s: found.delay_s.is_finite().then_some(found.frequency_rad_per_s),
            plant: found.plant,
        };
    }
    nominal
}

pub(super) fn nominal_point(problem: &RobustProblem) -> PlantPoint {
    match &problem.family {
        Family::Uncertain(family) => PlantPoint::Parameters(family.plant().nominal()),
        Family::Measured(_) => PlantPoint::Measured(0),
    }
}

fn member_is_stable(problem: &RobustProblem, plant: &PlantPoint) -> bool {
    problem.member(plant).is_some_and(|member| {
        member_stability(&member, &problem.compensation).status == StabilityStatus::Stable
    })
}

/// Nominal plant, members and corners spread over the family, and the worst plants of the audit.
fn visited(problem: &RobustProblem, audit: &Audit) -> Vec<PlantPoint> {
    let mut all = vec![nominal_point(problem)];
    match &problem.family {
        Family::Measured(family) => all.extend((0..family.plants().len()).map(PlantPoint::Measured)),
        Family::Uncertain(family) => {
            let is_rational = family.plant().is_rational();
            let most = if is_rational { MEMBERS } else { MEMBERS_OF_RESPONSES };
            all.extend(spread(family.members(), most).map(PlantPoint::Parameters));
            let most = if is_rational { CORNERS } else { MEMBERS_OF_RESPONSES };
            all.extend(spread(&corners(family), most).map(PlantPoint::Parameters));
        }
    }
    all.extend(worst_of(audit));
    let mut distinct: Vec<PlantPoint> = Vec::new();
    for plant in all {
        if !distinct.contains(&plant) {
            distinct.push(plant);
        }
    }
    distinct
}

/// Worst plants of the audit in any respect.
pub(super) fn worst_of(audit: &Audit) -> impl Iterator<Item = PlantPoint> {
    let closest = audit.stability.closest_approach.iter().map(|closest| &closest.plant);
    let delayed = audit.delay_margin.iter().map(|margin| &margin.plant);
    let of_specifications = audit.specifications.iter().flat_map(worst_plants);
    of_specifications.chain([&audit.stability.plant]).chain(closest).chain(delayed).cloned()
}

/// Plants whose margins are compared for the worst, without a search between them.
pub(crate) fn plants_of_margins(problem: &RobustProblem, audit: &Audit) -> Family {
    let Family::Uncertain(family) = &problem.family else { return problem.family.clone() };
    let members = visited(problem, audit).into_iter().filter_map(|plant| match plant {
        PlantPoint::Parameters(values) => Some(values),
        PlantPoint::Measured(_) | PlantPoint::Additional(_) => None,
    });
    let members = UncertainFamily::new(family.plant().clone(), vec![], members.collect(), Extent::Members);
    members.map_or_else(|_| problem.family.clone(), Family::Uncertain)
}

/// Plants spread over these, and the last.
pub(super) fn spread(plants: &[Vec<f64>], most: usize) -> impl Iterator<Item = Vec<f64>> {
    let step = plants.len().div_ceil(most).max(1);
    plants.iter().step_by(step).chain(plants.last()).cloned()
}

/// Corners of the box, at most those of its first eight coordinates.
pub(super) fn corners(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let dimension = family.coordinates().len();
    if family.extent() != Extent::Box || dimension == 0 || dimension > 8 {
        return Vec::new();
    }
    let fraction = |mask: usize, index: usize| if (mask >> index) & 1 == 1 { 1.0 } else { 0.0 };
    let fractions = |mask: usize| (0..dimension).map(|index| fraction(mask, index)).collect::<Vec<f64>>();
    (0..1_usize << dimension).map(|mask| family.values(&fractions(mask))).collect()
}

/// Plants at which a specification is worst.
pub(super) fn worst_plants(finding: &SpecificationFinding) -> impl Iterator<Item = &PlantPoint> {
    finding.worst.iter().chain(&finding.interior).flat_map(SpecificationMargin::plants)
}

/// Worst of each margin so far.
struct MarginSearch<'a> {
    problem: &'a RobustProblem,
    worst: Option<MarginSet>,
    plants: usize,
}

impl MarginSearch<'_> {
    fn visit(&mut self, plant: &PlantPoint) {
        let Some(found) = of_plant(self.problem, plant) else { return };
        self.plants += 1;
        self.worst = Some(match self.worst.take() {
            Some(worst) => worst.worst_of(found),
            None => found,
        });
    }

    /// Follows gain and phase from their worst plants along the coordinates of the box, as long as
    /// they become worse.
    fn between(&mut self) {
        let Family::Uncertain(family) = &self.problem.family else { return };
        if family.extent() != Extent::Box || !family.plant().is_rational() {
            return;
        }
        let mut fraction = FIRST_FRACTION;
        for _ in 0..HALVINGS {
            for index in 0..3 {
                for coordinate in 0..family.coordinates().len() {
                    [fraction, -fraction]
                        .into_iter()
                        .for_each(|step| self.beside(family, index, coordinate, step));
                }
            }
            fraction *= 0.5;
        }
    }

    /// Plant at a step from the worst of one margin, within the box.
    fn beside(&mut self, family: &UncertainFamily, index: usize, coordinate: usize, step: f64) {
        let worst = self.worst.as_ref().and_then(|worst| worst.searched().into_iter().nth(index).cloned());
        let Some(LoopMargin { plant: PlantPoint::Parameters(values), value, .. }) = worst else { return };
        if value.is_infinite() {
            return;
        }
        let mut fractions = family.fractions(&values);
        let Some(own) = fractions.get_mut(coordinate) else { return };
        let moved = (*own + step).clamp(0.0, 1.0);
        if moved != *own {
            *own = moved;
            self.visit(&PlantPoint::Parameters(family.values(&fractions)));
        }
    }
}

/// Number of members and corners whose crossover is computed.
const CROSSOVERS: usize = 8;

/// Highest frequency at which |L| = 1, of the nominal plant, members and corners spread over the
/// family, rad/s; `None` if |L| = 1 for none of them, or no response is known.
pub(crate) fn highest_crossover(problem: &RobustProblem) -> Option<f64> {
    let mut plants = vec![nominal_point(problem)];
    match &problem.family {
        Family::Measured(family) => {
            plants = (0..family.plants().len()).map(PlantPoint::Measured).collect();
        }
        Family::Uncertain(family) => {
            plants.extend(spread(family.members(), CROSSOVERS).map(PlantPoint::Parameters));
            plants.extend(spread(&corners(family), CROSSOVERS).map(PlantPoint::Parameters));
        }
    }
    let crossover = |plant: &PlantPoint| {
        let found = margins_of(problem, plant)?.phase_margins;
        found.iter().map(|margin| margin.frequency_rad_per_s).reduce(f64::max)
    };
    plants.iter().filter_map(crossover).reduce(f64::max)
}

/// Margins of the loop of one plant; `None` if its response is not known.
fn of_plant(problem: &RobustProblem, plant: &PlantPoint) -> Option<MarginSet> {
    Some(MarginSet::of(&margins_of(problem, plant)?, plant))
}

pub(super) fn margins_of(problem: &RobustProblem, plant: &PlantPoint) -> Option<Margins> {
    let member = problem.member(plant)?;
    match open_loop(problem, &member) {
        Ok(Some(open_loop)) => Some(margins(&open_loop)),
        Ok(None) => response::margins(problem, &member),
        Err(_) => None,
    }
}

/// Open loop L = G P H with the delay of the loop, in z if it samples; `None` for a plant without
/// polynomials.
///
/// # Errors
/// [`LinearError`] for a plant that is not a transfer function.
fn open_loop(problem: &RobustProblem, member: &Member) -> Result<Option<TransferFunction>, LinearError> {
    let with_sensor = match member {
        Member::Continuous { plant, sensor, .. } => {
            plant.command.transfer_function()?.with_dead_time(plant.dead_time_s)?.series(sensor)?
        }
        Member::Sampled { with_sensor, .. } => with_sensor.clone(),
        Member::Responding { .. } | Member::Measured { .. } => return Ok(None),
    };
    with_sensor.series(problem.compensation.feedback()).map(Some)
}
