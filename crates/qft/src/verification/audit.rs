//! The audit, stage by stage.

use phea_dynamics::portable;

use super::criterion::{Criterion, criteria};
use super::evaluator::{Evaluator, FREQUENCY_TOLERANCE};
use super::finding::{self, Case, Part};
use super::frequencies::{Features, common_grid, features};
use super::minimum;
use super::response::decibels;
use super::scan::{Peak, Plant, Scan, WORTH_POLISHING};
use super::search::{Outcome, Task, search};
use super::start::{interior_range, tasks};
use super::{PlantPoint, SpecificationFinding};
use crate::closed_loop::Compensation;
use crate::family::{Extent, Family, UncertainFamily, vertices};
use crate::specification::{Requirement, Specification};

/// A margin of minus this much still counts as met unless another tolerance is asked for, dB.
pub const TOLERANCE_DB: f64 = 0.001;
/// Plants looked at, or peaks polished, in one step.
const PLANTS_A_STEP: usize = 32;
/// Corners of a box are looked at up to this dimension.
const CORNERS_DIMENSION_MAXIMUM: usize = 8;
/// Local minima of a family's margin that are followed.
pub(super) const STARTS: usize = 4;
/// Cases of each specification whose frequencies are looked at for the whole family.
const FREQUENCIES: usize = 8;

/// How a tracking specification is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrackingJudgement {
    /// `lower <= |F P G/(1+L)| <= upper` with the prefilter that is given.
    Magnitude,
    /// Without a prefilter: by the spread of the family, which no prefilter changes.
    ///
    /// ```text
    /// margin = 20 log10(upper/lower) - 20 log10(max|T| / min|T|)
    /// ```
    Spread,
}

/// What an audit did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Plants that were looked at, corners of the box among them.
    pub plants: u64,
    /// Searches inside the box.
    pub searches: u64,
    /// Responses of one plant at one frequency.
    pub responses: u64,
}

#[derive(Clone, Debug)]
enum Stage {
    Preparing(usize),
    Looking(usize),
    Polishing(usize),
    Gathering(usize),
    Searching(usize),
    Joining(usize),
    Done,
}

/// An audit of specifications over a family, stepped by its owner.
///
/// Every plant of the family and every corner of its box is looked at over the whole band: at common frequencies, around its
/// lightly damped roots, at the limits of zero and infinite frequency; peaks are polished; then the box is searched from
/// the worst of them. See the chapter on verification in the book.
///
/// # Example
/// An integrator whose gain may double, closed with gain 1; |S| = w/|jw + k| never exceeds 1:
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
/// use phea_qft::specification::{Limit, Requirement, Specification};
/// use phea_qft::verification::{SpecificationAudit, TOLERANCE_DB, TrackingJudgement, Verdict};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 2.0 };
/// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
/// })?;
/// let along = Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
/// let family = Family::Uncertain(UncertainFamily::new(plant, vec![along], vec![], Extent::Box)?);
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let sensitivity = Specification {
///     requirement: Requirement::Sensitivity(Limit::Constant(0.5)),
///     frequencies_rad_per_s: vec![1.0],
///     band_rad_per_s: [0.0, f64::INFINITY],
/// };
/// let mut audit = SpecificationAudit::new(
///     &family, &compensation, &[sensitivity], TrackingJudgement::Magnitude, TOLERANCE_DB,
/// );
/// while audit.step() {}
/// let finding = &audit.findings()[0];
/// assert_eq!(finding.verdict, Verdict::Violated);
/// let worst = finding.worst.as_ref().ok_or("a worst case")?;
/// assert_eq!(worst.frequency_rad_per_s, f64::INFINITY); // where |S| = 1, twice the limit
/// assert!((worst.margin_db + 6.0206).abs() < 1e-4);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct SpecificationAudit {
    family: Family,
    evaluator: Evaluator,
    specifications: Vec<Specification>,
    parts: Vec<Part>,
    tolerance_db: f64,
    values: Vec<Vec<f64>>,
    plants: Vec<Plant>,
    scan: Scan,
    /// What was found of each specification, beyond the family's worst at the common frequencies.
    cases: Vec<Vec<Case>>,
    /// Peaks to be polished, each with its specification and criterion, the highest of a criterion first.
    peaks: Vec<(usize, usize, Peak)>,
    /// Each with the specification it serves.
    tasks: Vec<(usize, Task)>,
    /// By specification: a frequency at which a plant met in a search has no margin.
    undefined: Vec<Option<f64>>,
    finished: Vec<SpecificationFinding>,
    stage: Stage,
}

impl SpecificationAudit {
    /// An audit that has not begun.
    pub fn new(
        family: &Family,
        compensation: &Compensation,
        specifications: &[Specification],
        tracking: TrackingJudgement,
        tolerance_db: f64,
    ) -> SpecificationAudit {
        let mut all: Vec<Criterion> = Vec::new();
        let mut parts = Vec::new();
        for specification in specifications {
            let own = criteria(specification, compensation.highest_frequency_rad_per_s());
            let spread = matches!(specification.requirement, Requirement::Tracking { .. })
                && tracking == TrackingJudgement::Spread;
            parts.push(Part { first: all.len(), count: own.len(), spread });
            all.extend(own);
        }
        let evaluator = Evaluator::new(compensation.clone(), all, tracking == TrackingJudgement::Magnitude);
        let values = match family {
            Family::Uncertain(family) => {
                let corners = corners(family);
                [family.members(), &corners].concat()
            }
            Family::Measured(_) => Vec::new(),
        };
        SpecificationAudit {
            scan: Scan::new(&evaluator, &[]),
            family: family.clone(),
            evaluator,
            specifications: specifications.to_vec(),
            cases: vec![Vec::new(); parts.len()],
            undefined: vec![None; parts.len()],
            peaks: Vec::new(),
            parts,
            tolerance_db,
            values,
            plants: Vec::new(),
            tasks: Vec::new(),
            finished: Vec::new(),
            stage: Stage::Preparing(0),
        }
    }

    /// Does a small part of the work; false when there is none left.
    pub fn step(&mut self) -> bool {
        self.stage = match self.stage {
            Stage::Preparing(next) => self.prepare(next),
            Stage::Looking(next) => self.look(next),
            Stage::Polishing(next) => self.polish(next),
            Stage::Gathering(next) => self.gather(next),
            Stage::Searching(next) => self.search(next),
            Stage::Joining(next) => self.join(next),
            Stage::Done => Stage::Done,
        };
        !matches!(self.stage, Stage::Done)
    }

    /// The share of the work that is done, as far as it can be foreseen; 1 when all is.
    pub fn progress(&self) -> f64 {
        let share = |done: usize, all: usize| done as f64 / all.max(1) as f64;
        match self.stage {
            Stage::Preparing(next) => 0.2 * share(next, self.count()),
            Stage::Looking(next) => 0.2 + 0.4 * share(next, self.count()),
            Stage::Polishing(next) => 0.6 + 0.1 * share(next, self.peaks.len()),
            Stage::Gathering(next) => 0.7 + 0.05 * share(next, self.parts.len()),
            Stage::Searching(next) => 0.75 + 0.2 * share(next, self.tasks.len()),
            Stage::Joining(next) => 0.95 + 0.05 * share(next, self.parts.len()),
            Stage::Done => 1.0,
        }
    }
}

impl SpecificationAudit {
    /// What was found of each specification, in order; empty until the last step.
    pub fn findings(&self) -> &[SpecificationFinding] {
        &self.finished
    }

    /// What was done so far.
    pub fn work(&self) -> Work {
        Work {
            plants: self.plants.len() as u64,
            searches: match self.stage {
                Stage::Preparing(_) | Stage::Looking(_) | Stage::Polishing(_) | Stage::Gathering(_) => 0,
                Stage::Searching(next) => next as u64,
                Stage::Joining(_) | Stage::Done => self.tasks.len() as u64,
            },
            responses: self.evaluator.responses(),
        }
    }

    /// Number of plants to be looked at.
    fn count(&self) -> usize {
        match &self.family {
            Family::Uncertain(_) => self.values.len(),
            Family::Measured(family) => family.plants().len(),
        }
    }

    fn plant(&self, index: usize) -> Option<Plant> {
        let (point, member) = match &self.family {
            Family::Uncertain(family) => {
                let values = self.values.get(index)?;
                let member = self.evaluator.member(family.plant(), values);
                (PlantPoint::Parameters(values.clone()), member)
            }
            Family::Measured(family) => {
                let member = self.evaluator.compensation.measured(family.plants().get(index)?);
                (PlantPoint::Measured(index), Some(member))
            }
        };
        let features =
            member.as_ref().map_or_else(Features::none, |member| features(&self.evaluator, member));
        Some(Plant { point, member, features })
    }

    fn prepare(&mut self, next: usize) -> Stage {
        let until = (next + PLANTS_A_STEP).min(self.count());
        let plants: Vec<Plant> = (next..until).filter_map(|index| self.plant(index)).collect();
        self.plants.extend(plants);
        if until < self.count() {
            return Stage::Preparing(until);
        }
        let given: Vec<f64> = self
            .specifications
            .iter()
            .flat_map(|specification| specification.frequencies_rad_per_s.iter().copied())
            .collect();
        let features = self.plants.iter().map(|plant| &plant.features);
        let grid = common_grid(&self.evaluator, features, &given);
        self.scan = Scan::new(&self.evaluator, &grid);
        Stage::Looking(0)
    }

    fn look(&mut self, next: usize) -> Stage {
        let until = (next + PLANTS_A_STEP).min(self.plants.len());
        for (index, plant) in self.plants.iter().enumerate().take(until).skip(next) {
            self.scan.look_at(&self.evaluator, plant, index);
        }
        if until < self.plants.len() {
            return Stage::Looking(until);
        }
        for (number, part) in self.parts.iter().enumerate() {
            for criterion in part.criteria() {
                let peaks = self.scan.peaks(criterion);
                self.peaks.extend(peaks.into_iter().map(|peak| (number, criterion, peak)));
            }
        }
        Stage::Polishing(0)
    }

    /// Polishes some peaks, as long as they can become the worst of their criterion.
    fn polish(&mut self, next: usize) -> Stage {
        let until = (next + PLANTS_A_STEP).min(self.peaks.len());
        for (number, criterion, peak) in self.peaks.iter().take(until).skip(next) {
            let (Some(plant), Some(cases)) = (self.plants.get(peak.plant), self.cases.get_mut(*number))
            else {
                continue;
            };
            let own = cases.iter().filter(|case| case.criteria.contains(criterion));
            let worst = own.map(|case| case.margin_db).fold(f64::INFINITY, f64::min);
            if decibels(peak.excess / WORTH_POLISHING) > worst {
                continue;
            }
            let member = plant.member.as_ref();
            let polished =
                member.and_then(|member| self.evaluator.polished(*criterion, member, peak.bracket));
            cases.extend(polished.map(|(frequency, margin_db)| Case {
                margin_db,
                frequency,
                criteria: vec![*criterion],
                points: vec![plant.point.clone()],
                interior: true,
            }));
        }
        if until < self.peaks.len() { Stage::Polishing(until) } else { Stage::Gathering(0) }
    }

    /// Looks at the whole family where one specification is worst; with a spread, polishes the family's margin there.
    fn gather(&mut self, number: usize) -> Stage {
        let (Some(&part), Some(cases)) = (self.parts.get(number), self.cases.get(number)) else {
            self.tasks = self.starts();
            return Stage::Searching(0);
        };
        let mut cases = cases.clone();
        self.look_at_worst(&mut cases);
        if part.spread {
            cases = self.polished_spread(part);
            self.look_at_worst(&mut cases);
        }
        if let Some(slot) = self.cases.get_mut(number) {
            *slot = cases;
        }
        Stage::Gathering(number + 1)
    }

    /// Looks at the whole family where the worst cases are.
    fn look_at_worst(&mut self, cases: &mut [Case]) {
        cases.sort_by(|left, right| left.margin_db.total_cmp(&right.margin_db));
        for case in cases.iter().take(FREQUENCIES) {
            self.scan.add_frequency(&self.evaluator, &self.plants, case.frequency);
        }
    }

    /// The worst local minima of the margin of the spread, each polished over the whole family.
    fn polished_spread(&mut self, part: Part) -> Vec<Case> {
        let envelope = finding::envelope(part, &self.scan);
        let mut cases = Vec::new();
        for bracket in finding::local_minima(&envelope).into_iter().take(STARTS) {
            let mut margin = |logarithm: f64| {
                let frequency = portable::exp(logarithm);
                let worst = self.scan.family_at(&self.evaluator, &self.plants, frequency);
                part.combined(frequency, &worst).map_or(f64::INFINITY, |point| point.margin_db)
            };
            let [low, middle, high] = bracket.map(portable::ln);
            let start = (middle, margin(middle));
            let (logarithm, _) = minimum::between(margin, [low, high], start, FREQUENCY_TOLERANCE);
            let frequency = portable::exp(logarithm);
            let worst = self.scan.family_at(&self.evaluator, &self.plants, frequency);
            cases.extend(part.combined(frequency, &worst).map(|point| Case {
                margin_db: point.margin_db,
                frequency,
                criteria: point.criteria,
                points: finding::points(&self.plants, &point.plants),
                interior: true,
            }));
        }
        cases
    }

    fn starts(&self) -> Vec<(usize, Task)> {
        let Family::Uncertain(family) = &self.family else { return Vec::new() };
        if family.extent() == Extent::Members || family.coordinates().is_empty() {
            return Vec::new();
        }
        let mut starts = Vec::new();
        for (number, part) in self.parts.iter().enumerate() {
            let design = self.specifications.get(number).map(|one| one.frequencies_rad_per_s.as_slice());
            let cases = self.cases.get(number).map_or(&[][..], Vec::as_slice);
            for part in part.searched() {
                let range = interior_range(part, &self.evaluator, &self.scan);
                let seen = (&self.scan, self.plants.as_slice());
                let tasks = tasks(part, family, seen, cases, design.unwrap_or_default(), range);
                starts.extend(tasks.into_iter().map(|task| (number, task)));
            }
        }
        starts
    }

    fn search(&mut self, next: usize) -> Stage {
        let (Some((number, task)), Family::Uncertain(family)) = (self.tasks.get(next), &self.family) else {
            return Stage::Joining(0);
        };
        let Outcome { found, undefined } = search(&self.evaluator, family, task);
        if let Some(slot @ None) = self.undefined.get_mut(*number) {
            *slot = undefined;
        }
        if let Some(found) = found {
            let inside = |[low, high]: [f64; 2]| low < found.frequency && found.frequency < high;
            let points: Vec<PlantPoint> =
                found.values.iter().map(|values| PlantPoint::Parameters(values.clone())).collect();
            if let Some(cases) = self.cases.get_mut(*number) {
                cases.push(Case {
                    margin_db: found.margin_db,
                    frequency: found.frequency,
                    criteria: task.criteria.clone(),
                    points: points.clone(),
                    interior: task.range.is_some_and(inside),
                });
            }
            for (point, values) in points.into_iter().zip(found.values) {
                if self.plants.iter().any(|plant| plant.point == point) {
                    continue;
                }
                let member = self.evaluator.member(family.plant(), &values);
                let features =
                    member.as_ref().map_or_else(Features::none, |member| features(&self.evaluator, member));
                let plant = Plant { point, member, features };
                self.scan.look_at(&self.evaluator, &plant, self.plants.len());
                self.plants.push(plant);
            }
        }
        Stage::Searching(next + 1)
    }

    /// Makes the finding of one specification.
    fn join(&mut self, number: usize) -> Stage {
        let (Some(part), Some(specification)) =
            (self.parts.get(number).copied(), self.specifications.get(number).cloned())
        else {
            return Stage::Done;
        };
        let mut cases = self.cases.get(number).cloned().unwrap_or_default();
        self.look_at_worst(&mut cases);
        let finding = finding::Joining {
            part,
            specification: &specification,
            evaluator: &self.evaluator,
            plants: &self.plants,
            cases: &cases,
            undefined: self.undefined.get(number).copied().flatten().or(finding::undefined(part, &self.scan)),
            tolerance_db: self.tolerance_db,
        }
        .finding(&mut self.scan);
        self.finished.push(finding);
        Stage::Joining(number + 1)
    }
}

/// The corners of a family's box, if it has one and they are not too many.
pub(crate) fn corners(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let dimension = family.coordinates().len();
    if family.extent() == Extent::Members || dimension == 0 || dimension > CORNERS_DIMENSION_MAXIMUM {
        return Vec::new();
    }
    vertices(family.plant(), family.coordinates()).unwrap_or_default()
}
