//! The audit as its owner steps it.

mod stages;

use super::criterion::{Criterion, criteria};
use super::evaluator::Evaluator;
use super::finding::{Case, Part};
use super::frequencies::{Features, features};
use super::scan::{Peak, Plant, Scan};
use super::search::Task;
use super::{Evidence, PlantPoint, SpecificationFinding, Verdict};
use crate::closed_loop::Compensation;
use crate::family::{Extent, Family, UncertainFamily, vertices};
use crate::sampled::SampledPlants;
use crate::specification::{Requirement, Specification};

/// A margin of minus this much still counts as met unless another tolerance is asked for, dB.
pub const TOLERANCE_DB: f64 = 0.001;
/// Corners of a box are looked at up to this dimension.
const CORNERS_DIMENSION_MAXIMUM: usize = 8;

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
///     rate: None,
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

    /// Takes over plants of the same family within the same loop, whatever its controller, so that none is sampled twice.
    #[doc(hidden)]
    pub fn take_over(&mut self, sampled: SampledPlants) {
        self.evaluator.sampled = sampled;
    }

    /// Looks at these plants too, which another audit of the same box found to be worth it. Before the first step.
    pub(crate) fn add(&mut self, plants: Vec<Vec<f64>>) {
        for values in plants {
            if matches!(self.family, Family::Uncertain(_)) && !self.values.contains(&values) {
                self.values.push(values);
            }
        }
    }

    /// Hands over the plants that were sampled.
    pub(crate) fn take_sampled(&mut self) -> SampledPlants {
        std::mem::take(&mut self.evaluator.sampled)
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

    /// The specifications as they stand before anything was looked at: not proven.
    pub(crate) fn unexamined(&self) -> Vec<SpecificationFinding> {
        let finding = |specification: &Specification| SpecificationFinding {
            requirement: specification.requirement.clone(),
            verdict: Verdict::NotProven,
            evidence: Evidence::of(&self.family),
            worst: None,
            interior: None,
            violations: vec![],
            at_design_frequencies: vec![],
            envelope: vec![],
            remarks: vec![],
        };
        self.specifications.iter().map(finding).collect()
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
        match &self.family {
            Family::Uncertain(family) => Some(plant_at(&self.evaluator, family, self.values.get(index)?)),
            Family::Measured(family) => {
                let member = self.evaluator.compensation.measured(family.plants().get(index)?);
                let features = features(&self.evaluator, &member);
                Some(Plant { point: PlantPoint::Measured(index), member: Some(member), features })
            }
        }
    }
}

fn plant_at(evaluator: &Evaluator, family: &UncertainFamily, values: &[f64]) -> Plant {
    let member = evaluator.member(family.plant(), values);
    let features = member.as_ref().map_or_else(Features::none, |member| features(evaluator, member));
    Plant { point: PlantPoint::Parameters(values.to_vec()), member, features }
}

/// The corners of a family's box, if it has one and they are not too many.
pub(crate) fn corners(family: &UncertainFamily) -> Vec<Vec<f64>> {
    let dimension = family.coordinates().len();
    if family.extent() == Extent::Members || dimension == 0 || dimension > CORNERS_DIMENSION_MAXIMUM {
        return Vec::new();
    }
    vertices(family.plant(), family.coordinates()).unwrap_or_default()
}
