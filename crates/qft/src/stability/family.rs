//! Stability of a family: every member, then the worst plants between them.

mod delayed;
mod judged;
mod jumps;

use phea_dynamics::order::sort_by_number;
use phea_dynamics::watch::{Stopped, Watch, part, report_progress};

use super::badness::{Badness, badness_of};
use super::folding::{self, Folded};
use super::infinity::{self, Infinity};
use super::record::StabilityRecord;
use super::{DelayMargin, Irresolution, MemberStability, StabilityFinding, StabilityMethod, StabilityReason};
use crate::closed_loop::Compensation;
use crate::coordinate_climb::LONGEST_STEP;
use crate::family::{Extent, Family, UncertainFamily, corners};
use crate::plant_cache::PlantCache;
use crate::verdict::{Evidence, PlantPoint, Verdict};
use judged::{JudgedFamily, StabilitySearch};

/// Number of pieces into which the plants are divided for parallel work.
const PIECES: usize = 8;
/// Number of starts of the search for each worst case.
const STARTS: usize = 4;
/// Relative change of 1 + L by folding below which folding between the examined plants is ignored;
/// number of plants for which it is computed.
const FOLDED_LITTLE: f64 = 0.25;
const FOLDING_PLANTS: usize = 40;
/// Value of |1 + L| below which it counts as zero.
const ZERO: f64 = 1e-6;

/// Stability results of a family.
#[derive(Clone, Debug, PartialEq)]
pub struct FamilyStability {
    /// The verdict, its basis, and the plant nearest to instability.
    pub finding: StabilityFinding,
    /// The least additional dead time that makes a plant unstable; `None` unless the family is
    /// stable.
    pub delay_margin: Option<DelayMargin>,
}

/// Stability of a family: every member, then the plants between the members.
///
/// Over a box, searches start from the worst members for the largest real part (if there are
/// poles), for the smallest
/// |1 + L|, and for the least critical delay.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// Plant k (s + a)/(s^2 - 2.5) with an uncertain gain and zero, which needs C k a > 2.5:
/// ```
/// use phea_dynamics::controller::{Compensator, Controller, Element};
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
/// use phea_qft::stability::family_stability;
/// use phea_qft::verification::Verdict;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let parameter =
///     |name: &str, minimum, maximum| UncertainParameter { name: name.into(), nominal: minimum, minimum, maximum };
/// let parameters = vec![parameter("k", 1.0, 10.0), parameter("a", 0.1, 1.0)];
/// let plant = UncertainPlant::record(parameters, |p| PlantCoefficients {
///     command: RationalCoefficients {
///         numerator: vec![p[0], p[0] * p[1]],
///         denominator: vec![1.0.into(), 0.0.into(), (-2.5).into()],
///     },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let coordinate =
///     |index| Coordinate { parameters: vec![index], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
/// let coordinates = vec![coordinate(0), coordinate(1)];
/// let members = vertices(&plant, &coordinates)?;
/// let family = Family::Uncertain(UncertainFamily::new(plant, coordinates, members, Extent::Box)?);
/// let verdict = |gain: f64| {
///     let feedback = Compensator::new(vec![Element::Gain(gain)]);
///     let controller = Controller { feedback, ..Controller::default() };
///     let compensation = Compensation::new(&controller, TransferFunction::gain_only(1.0))?;
///     let found = family_stability(&family, &compensation, &mut unwatched)?;
///     Ok::<_, Box<dyn std::error::Error>>(found.finding.verdict)
/// };
/// assert_eq!(verdict(24.9)?, Verdict::Violated);
/// assert_eq!(verdict(25.1)?, Verdict::Met);
/// # Ok(())
/// # }
/// ```
pub fn family_stability(
    family: &Family,
    compensation: &Compensation,
    watch: Watch<'_>,
) -> Result<FamilyStability, Stopped> {
    let cache = PlantCache::default();
    let mut audit = StabilityAudit::new(family, compensation, &cache);
    audit.evaluate(watch)?;
    Ok(audit.result())
}

/// The audit of stability of one family.
pub(crate) struct StabilityAudit<'a> {
    around: JudgedFamily<'a>,
    /// The members, the corners of the box, and plants between them whose modes fold.
    plants: Vec<PlantPoint>,
    /// Folding plants, the last of them, once the others are examined.
    folded: Folded,
    /// Bound on the effect of folding, if plants between need not be examined for it.
    folding: Option<f64>,
    /// Real part, closeness and delay sensitivity of each plant, as far as examined.
    badness: Vec<[f64; 3]>,
    /// Plants of a sampled loop whose critical delay is still an estimate.
    estimated: Vec<Vec<f64>>,
    /// True if the delay margin of a sampled loop is already exact, not an estimate.
    resampled: bool,
    /// The evaluated plants, within a sampled loop.
    cache: &'a PlantCache,
    record: StabilityRecord,
}

/// Name of the stage in progress reports.
const STAGE: &str = "stability";

impl<'a> StabilityAudit<'a> {
    /// A new audit; plants already sampled are not sampled again.
    pub(crate) fn new(
        family: &'a Family,
        compensation: &'a Compensation,
        cache: &'a PlantCache,
    ) -> StabilityAudit<'a> {
        let plants: Vec<PlantPoint> = match family {
            Family::Uncertain(family) => {
                let members = family.members().iter().cloned();
                members.chain(corners(family)).map(PlantPoint::Parameters).collect()
            }
            Family::Measured(family) => (0..family.plants().len()).map(PlantPoint::Measured).collect(),
        };
        StabilityAudit {
            around: JudgedFamily::new(family, compensation, plants.first()),
            plants,
            folded: Folded::none(0),
            folding: None,
            badness: Vec::new(),
            estimated: Vec::new(),
            resampled: false,
            cache,
            record: StabilityRecord::default(),
        }
    }

    /// Examines members and corners, the plants between them whose modes fold, and then searches
    /// between all of these.
    pub(crate) fn evaluate(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        self.evaluate_plants(&mut part(watch, STAGE, [0.0, 0.3]))?;
        self.folded = self.fold();
        self.plants.extend(self.folded.plants.iter().cloned().map(PlantPoint::Parameters));
        self.evaluate_plants(&mut part(watch, STAGE, [0.3, 0.8]))?;
        self.sample_between(&mut part(watch, STAGE, [0.8, 0.95]))?;
        if self.around.compensation.sample_time_s().is_some() {
            self.resample(&mut part(watch, STAGE, [0.95, 1.0]))?;
        }
        Ok(())
    }

    /// Examines members and corners not yet examined.
    pub(crate) fn evaluate_plants(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        let new = self.plants.get(self.badness.len()..).unwrap_or_default();
        let chunks: Vec<&[PlantPoint]> = new.chunks(new.len().div_ceil(PIECES).max(1)).collect();
        let around = &self.around;
        let judge = |cache: &PlantCache, chunk: &[PlantPoint], watch: Watch<'_>| {
            let judged = chunk.iter().enumerate().map(|(index, plant)| {
                report_progress(watch, STAGE, index, chunk.len())?;
                Ok(around.judged(cache, plant))
            });
            judged.collect::<Result<Vec<MemberStability>, Stopped>>()
        };
        let found = self.cache.each(chunks, (STAGE, watch), judge)?.concat();
        for (plant, found) in new.iter().zip(&found) {
            self.record.take(plant.clone(), found);
        }
        self.badness.extend(found.iter().map(badness_of));
        Ok(())
    }

    /// Searches from the worst plants of a box, and determines whether a pole passes through
    /// infinity inside it.
    fn sample_between(&mut self, watch: Watch<'_>) -> Result<(), Stopped> {
        let Family::Uncertain(family) = self.around.family else { return Ok(()) };
        // an unstable plant decides the verdict, and without polynomials a search is expensive
        let decided = self.record.unstable.is_some() && !family.plant().is_rational();
        if family.extent() != Extent::Box || decided {
            return Ok(());
        }
        let searches: [(Badness, &[Badness]); 4] = [
            (Badness::RealPart, &[Badness::RealPart]),
            (Badness::Closeness, &[Badness::Closeness]),
            (Badness::DelaySensitivity, &[Badness::DelaySensitivity]),
            (Badness::Closeness, &[Badness::Peak, Badness::DelaySensitivity]),
        ];
        let mut tasks = Vec::new();
        for (ranked_by, searched) in searches {
            let from = |first_step: f64| move |fractions| StabilitySearch { searched, first_step, fractions };
            tasks.extend(self.starts(family, ranked_by).into_iter().map(from(LONGEST_STEP)));
            tasks.extend(self.sides(family, ranked_by).into_iter().map(from(jumps::STEP)));
        }
        self.search(tasks, watch)?;
        self.through_infinity();
        Ok(())
    }

    fn judged(&self, plant: &PlantPoint) -> MemberStability {
        self.around.judged(self.cache, plant)
    }

    /// Searches from these plants, and records the end of each search.
    fn search(&mut self, tasks: Vec<StabilitySearch<'_>>, watch: Watch<'_>) -> Result<(), Stopped> {
        let around = &self.around;
        let search = |cache: &PlantCache, task: StabilitySearch<'_>, watch: Watch<'_>| {
            report_progress(watch, STAGE, 0, 1)?;
            Ok(task.searched(around, cache))
        };
        for (values, is_of_delay, found) in
            self.cache.each(tasks, (STAGE, watch), search)?.into_iter().flatten()
        {
            if is_of_delay {
                self.estimated.push(values.clone());
            }
            self.take(PlantPoint::Parameters(values), found);
        }
        Ok(())
    }

    /// Records a plant; an estimate of its delay no longer counts once the worst plants were
    /// resampled.
    fn take(&mut self, plant: PlantPoint, mut found: MemberStability) {
        found.critical_delay = found.critical_delay.filter(|_| !self.resampled);
        self.record.take(plant, &found);
    }

    /// The worst plants that are distinct from each other, as fractions of the box.
    fn starts(&self, family: &UncertainFamily, badness: Badness) -> Vec<Vec<f64>> {
        let mut order: Vec<(f64, &PlantPoint)> =
            self.badness.iter().map(|plant| badness.among(plant)).zip(&self.plants).collect();
        order.retain(|(value, _)| value.is_finite());
        sort_by_number(&mut order, |one| -one.0);
        let mut chosen: Vec<Vec<f64>> = Vec::new();
        for (_, plant) in order {
            let PlantPoint::Parameters(values) = plant else { continue };
            let fractions = family.fractions(values);
            if chosen.iter().all(|earlier| self.apart(earlier, &fractions)) {
                chosen.push(fractions);
            }
            if chosen.len() == STARTS {
                break;
            }
        }
        chosen
    }

    /// True if two plants are so far apart, along at least one coordinate, that searches from them
    /// may find different results.
    fn apart(&self, one: &[f64], other: &[f64]) -> bool {
        let distances = &self.folded.apart;
        one.iter().zip(other).zip(distances).any(|((a, b), distance)| (a - b).abs() > *distance)
    }

    /// Plants between members and corners, needed because of modes beyond half the sampling rate,
    /// around the worst plants so far.
    fn fold(&mut self) -> Folded {
        let Family::Uncertain(family) = self.around.family else { return Folded::none(0) };
        let dimension = family.coordinates().len();
        let Some(sample_time_s) = self.around.compensation.sample_time_s().filter(|_| self.searched()) else {
            return Folded::none(dimension);
        };
        if !family.plant().is_rational() {
            let folding = self.most_folding();
            self.folding = Some(folding).filter(|folding| *folding <= FOLDED_LITTLE);
            if self.folding.is_none() {
                self.record.doubt(Irresolution::FoldingUnknown, self.nominal());
            }
            return Folded::none(dimension);
        }
        let mut bases = vec![vec![0.5; dimension]];
        for badness in [Badness::Closeness, Badness::RealPart] {
            bases.extend(self.starts(family, badness).into_iter().take(1));
        }
        let folded = folding::plants(family, sample_time_s, &bases);
        if !folded.complete {
            self.record.doubt(Irresolution::Folding, self.nominal());
        }
        folded
    }

    /// Bound on the relative change of 1 + L by modes beyond half the sampling rate, at any folded
    /// frequency: for the nominal plant, corners, and members spread over the family; infinite if
    /// it is unknown for one.
    fn most_folding(&self) -> f64 {
        let step = self.plants.len().div_ceil(FOLDING_PLANTS).max(1);
        let JudgedFamily { compensation, .. } = self.around;
        let folding = |plant| self.around.member(self.cache, plant).ok()?.folding(compensation);
        let each = self.plants.iter().step_by(step).map(|plant| folding(plant).unwrap_or(f64::INFINITY));
        each.fold(0.0, f64::max)
    }

    /// The plants relevant to other audits: those whose modes fold, and those nearest to
    /// instability.
    pub(crate) fn plants_between(&self) -> Vec<Vec<f64>> {
        self.folded.plants.iter().cloned().chain(self.record.worst()).collect()
    }

    /// Examines plants that were the worst in another audit, and searches from those that are worse
    /// than the plants found here.
    pub(crate) fn evaluate_at(&mut self, plants: &[PlantPoint], watch: Watch<'_>) -> Result<(), Stopped> {
        for (done, plant) in plants.iter().rev().enumerate() {
            report_progress(watch, STAGE, done, plants.len())?;
            let found = self.judged(plant);
            let worse = self.record.is_worse(&found);
            self.take(plant.clone(), found);
            if let (true, Family::Uncertain(family), PlantPoint::Parameters(values)) =
                (worse, self.around.family, plant)
                && family.extent() == Extent::Box
            {
                let fractions = family.fractions(values);
                let of = |searched| StabilitySearch {
                    searched,
                    first_step: LONGEST_STEP,
                    fractions: fractions.clone(),
                };
                let fraction = [done, done + 1].map(|done| done as f64 / plants.len() as f64);
                let tasks = vec![of(&[Badness::Closeness]), of(&[Badness::RealPart])];
                self.search(tasks, &mut part(&mut *watch, STAGE, fraction))?;
            }
        }
        Ok(())
    }

    /// Evaluates plants on either side of a pole at infinity.
    fn through_infinity(&mut self) {
        let Family::Uncertain(family) = self.around.family else { return };
        match infinity::search(family, self.around.compensation) {
            Infinity::Kept => {}
            Infinity::Searched(found) => self.record.infinity = Some(found),
            Infinity::Open(found) => {
                let plant = found.plant.clone();
                self.record.doubt(Irresolution::InfinityOpen(found), plant);
            }
            Infinity::Changed(fractions) => {
                let values: Vec<Vec<f64>> =
                    fractions.iter().map(|fractions| family.values(fractions)).collect();
                let changed = values.first().cloned().map(PlantPoint::Parameters);
                for plant in values.into_iter().map(PlantPoint::Parameters) {
                    let found = self.judged(&plant);
                    self.record.take(plant, &found);
                }
                let changed = changed.unwrap_or_else(|| self.nominal());
                self.record.doubt(Irresolution::PoleThroughInfinity, changed);
            }
        }
    }

    /// Results so far.
    pub(crate) fn result(&self) -> FamilyStability {
        let record = &self.record;
        let (verdict, plant, reason) = self.judgement();
        let stable = verdict == Verdict::Met;
        FamilyStability {
            finding: StabilityFinding {
                folding: self.folding,
                verdict,
                evidence: if self.searched() { Evidence::Search } else { Evidence::Grid },
                largest_real_part: record.real_part.as_ref().map(|(real_part, _)| *real_part),
                plant,
                closest_approach: record.closest.clone().filter(|_| stable),
                infinity: record.infinity.clone().filter(|_| stable),
                reason,
            },
            delay_margin: record.delay.clone().filter(|_| stable),
        }
    }

    fn judgement(&self) -> (Verdict, PlantPoint, StabilityReason) {
        let record = &self.record;
        if let Some((_, reason, plant)) = &record.unstable {
            return (Verdict::Violated, plant.clone(), StabilityReason::Unstable(*reason));
        }
        if !self.around.compensation.prefilter().is_stable() {
            return (Verdict::Violated, self.nominal(), StabilityReason::UnstablePrefilter);
        }
        if let Some((reason, plant)) = &record.unresolved {
            return (Verdict::NotProven, plant.clone(), StabilityReason::NotResolved(reason.clone()));
        }
        if let Some(closest) = record.closest.as_ref().filter(|closest| closest.distance < ZERO) {
            let reason = Irresolution::NearBoundary { frequency_rad_per_s: closest.frequency_rad_per_s };
            return (Verdict::NotProven, closest.plant.clone(), StabilityReason::NotResolved(reason));
        }
        let nearest = record.real_part.as_ref().map(|(_, plant)| plant.clone());
        let nearest = nearest.or(record.closest.as_ref().map(|closest| closest.plant.clone()));
        (Verdict::Met, nearest.unwrap_or_else(|| self.nominal()), self.all_stable())
    }

    fn all_stable(&self) -> StabilityReason {
        let between = self.folded.plants.len();
        let JudgedFamily { family, compensation, .. } = self.around;
        let members = match family {
            Family::Uncertain(family) => family.members().len(),
            Family::Measured(family) => family.plants().len(),
        };
        let method = match (&self.record.real_part, family) {
            (_, Family::Measured(_)) => StabilityMethod::MeasuredPoints,
            (Some(_), _) => StabilityMethod::Poles,
            (None, Family::Uncertain(family)) if family.plant().is_rational() => StabilityMethod::Turns,
            (None, _) if compensation.sample_time_s().is_none() => StabilityMethod::Enclosed,
            (None, _) => StabilityMethod::Points,
        };
        let corners = self.plants.len() - members - between;
        StabilityReason::AllStable { members, corners, between, method, closest: self.record.closest.clone() }
    }

    fn nominal(&self) -> PlantPoint {
        self.plants.first().cloned().unwrap_or(PlantPoint::Measured(0))
    }

    /// True if plants between the members belong to the family.
    pub(crate) fn searched(&self) -> bool {
        match self.around.family {
            Family::Uncertain(family) => family.extent() == Extent::Box,
            Family::Measured(_) => false,
        }
    }
}
