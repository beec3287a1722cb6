//! The audit of the specifications of a family.

mod stages;

use phea_dynamics::watch::{Stopped, Watch, part};

use super::criterion::{Criterion, criteria};
use super::evaluator::Evaluator;
use super::finding::{FoundMargin, SpecificationCriteria};
use super::frequencies::{Features, features};
use super::scan::{Scan, ScannedPlant};
use super::{Evidence, PlantPoint, SpecificationFinding, Verdict};
use crate::closed_loop::Compensation;
use crate::family::{Family, UncertainFamily, corners};
use crate::plant_cache::PlantCache;
use crate::specification::Specification;

/// Violation up to which a margin counts as met, unless another tolerance is requested, dB.
pub const TOLERANCE_DB: f64 = 0.001;

/// Evaluation of a tracking specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrackingJudgement {
    /// Limits `lower <= |F P G/(1+L)| <= upper` with the given prefilter.
    Magnitude,
    /// Spread of the family, without a prefilter, which cannot change it.
    ///
    /// ```text
    /// margin = 20 log10(upper/lower) - 20 log10(max|T| / min|T|)
    /// ```
    Spread,
}

/// Work of an audit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AuditWork {
    /// Number of plants examined, including corners of the box.
    pub plants: u64,
    /// Number of searches inside the box.
    pub searches: u64,
    /// Number of responses of one plant at one frequency.
    pub responses: u64,
    /// Number of plants of a sampled loop whose factors were computed.
    pub sampled: u64,
    /// Number of plants of a sampled loop evaluated by searches.
    pub evaluated: u64,
    /// Number of searches that were skipped because a plant was known to violate the specification.
    pub(crate) skipped: u64,
}

/// Extent of an audit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum AuditEffort {
    /// Complete audit.
    Complete,
    /// Skips the search of the box for a specification with a known margin below this, dB.
    UntilBelow(f64),
    /// Only the plants of the family and the corners of its box at every frequency, without a
    /// search between them.
    KnownPlants,
}

/// Input of an audit.
#[derive(Clone, Copy, Debug)]
pub struct AuditProblem<'a> {
    /// The plants.
    pub family: &'a Family,
    /// The loop around each plant.
    pub compensation: &'a Compensation,
    /// The specifications that the loop must satisfy with each plant.
    pub specifications: &'a [Specification],
    /// Evaluation of tracking.
    pub tracking: TrackingJudgement,
    /// Violation up to which a margin counts as met, dB.
    pub tolerance_db: f64,
}

impl AuditProblem<'_> {
    /// The specifications before any examination: not proven.
    pub(crate) fn unexamined(&self) -> Vec<SpecificationFinding> {
        let finding = |specification: &Specification| SpecificationFinding {
            requirement: specification.requirement.clone(),
            verdict: Verdict::NotProven,
            evidence: Evidence::of(self.family),
            worst: None,
            interior: None,
            as_bad: vec![],
            violations: vec![],
            at_design_frequencies: vec![],
            envelope: vec![],
            remarks: vec![],
        };
        self.specifications.iter().map(finding).collect()
    }
}

/// Audits the specifications over the family, without its stability.
///
/// Every plant of the family and every corner of its box is examined over the whole band: at common
/// frequencies, around its lightly damped roots, and in the limits of zero and infinite frequency;
/// peaks are refined; then the box is searched from the worst of them. See the chapter on
/// verification in the book.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// Integrator whose gain may double, closed with gain 1; |S| = w/|jw + k| never exceeds 1:
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict, audit_specifications};
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
///     requirement: Requirement::at_most(ClosedLoop::Sensitivity, Limit::Constant(0.5)),
///     frequencies_rad_per_s: vec![1.0],
///     band_rad_per_s: [0.0, f64::INFINITY],
/// };
/// let problem = AuditProblem {
///     family: &family,
///     compensation: &compensation,
///     specifications: &[sensitivity],
///     tracking: TrackingJudgement::Magnitude,
///     tolerance_db: TOLERANCE_DB,
/// };
/// let (findings, _) = audit_specifications(&problem, &mut unwatched)?;
/// let finding = &findings[0];
/// assert_eq!(finding.verdict, Verdict::Violated);
/// let worst = finding.worst.as_ref().ok_or("a worst case")?;
/// assert_eq!(worst.frequency_rad_per_s, f64::INFINITY); // where |S| = 1, twice the limit
/// assert!((worst.margin_db + 6.0206).abs() < 1e-4);
/// # Ok(())
/// # }
/// ```
pub fn audit_specifications(
    problem: &AuditProblem<'_>,
    watch: Watch<'_>,
) -> Result<(Vec<SpecificationFinding>, AuditWork), Stopped> {
    audit_among(problem, &[], (&PlantCache::default(), AuditEffort::Complete), watch)
}

/// Audits the specifications, with additional plants that another audit of this box found worth
/// examining, and with plants already sampled in this loop.
pub(crate) fn audit_among(
    problem: &AuditProblem<'_>,
    others: &[Vec<f64>],
    (cache, effort): (&PlantCache, AuditEffort),
    watch: Watch<'_>,
) -> Result<(Vec<SpecificationFinding>, AuditWork), Stopped> {
    let before = cache.sampled();
    let mut audit = SpecificationAudit::new(problem, others, cache);
    audit.prepare(&mut part(watch, STAGE, [0.0, 0.2]))?;
    audit.evaluate(&mut part(watch, STAGE, [0.2, 0.6]))?;
    audit.polish(&mut part(watch, STAGE, [0.6, 0.7]))?;
    audit.evaluate_worst(&mut part(watch, STAGE, [0.7, 0.75]))?;
    audit.search(effort, &mut part(watch, STAGE, [0.75, 0.95]))?;
    let findings = audit.findings(&mut part(watch, STAGE, [0.95, 1.0]))?;
    let (plants, searches) = (audit.plants.len() as u64, audit.searches as u64);
    let skipped = audit.skipped as u64;
    let [evaluated, completed] = audit.evaluated.map(|count| count as u64);
    let sampled = (cache.sampled() - before) as u64 + completed;
    let responses = audit.evaluator.responses();
    Ok((findings, AuditWork { plants, searches, responses, sampled, evaluated, skipped }))
}

/// Name of the stage in progress reports.
const STAGE: &str = "specifications";

/// Results of an audit so far.
struct SpecificationAudit<'a> {
    problem: &'a AuditProblem<'a>,
    evaluator: Evaluator<'a>,
    parts: Vec<SpecificationCriteria>,
    /// The plants to be examined, by their parameters; empty for measured ones.
    values: Vec<Vec<f64>>,
    plants: Vec<ScannedPlant>,
    scan: Scan,
    /// The findings for each specification, in addition to the worst of the family at the common
    /// frequencies.
    cases: Vec<Vec<FoundMargin>>,
    /// Frequency for each specification at which a plant found in a search has no margin.
    undefined: Vec<Option<f64>>,
    searches: usize,
    skipped: usize,
    /// Number of plants evaluated by searches, and number of those whose factors were all needed.
    evaluated: [usize; 2],
}

impl<'a> SpecificationAudit<'a> {
    fn new(
        problem: &'a AuditProblem<'a>,
        others: &[Vec<f64>],
        cache: &'a PlantCache,
    ) -> SpecificationAudit<'a> {
        let AuditProblem { family, compensation, specifications, tracking, .. } = *problem;
        let mut all: Vec<Criterion> = Vec::new();
        let mut parts = Vec::new();
        for specification in specifications {
            let own = criteria(specification, compensation.highest_frequency_rad_per_s());
            let spread = specification.requirement.is_tracking() && tracking == TrackingJudgement::Spread;
            parts.push(SpecificationCriteria { first: all.len(), count: own.len(), spread });
            all.extend(own);
        }
        let with_prefilter = tracking == TrackingJudgement::Magnitude;
        let evaluator = Evaluator::new(compensation, all, with_prefilter, cache);
        let mut values = Vec::new();
        if let Family::Uncertain(family) = family {
            values = [family.members(), &corners(family)].concat();
            for other in others {
                if !values.contains(other) {
                    values.push(other.clone());
                }
            }
        }
        SpecificationAudit {
            problem,
            scan: Scan::new(&evaluator, &[]),
            evaluator,
            cases: vec![Vec::new(); parts.len()],
            undefined: vec![None; parts.len()],
            parts,
            values,
            plants: Vec::new(),
            searches: 0,
            skipped: 0,
            evaluated: [0; 2],
        }
    }

    /// Number of plants to be examined.
    fn count(&self) -> usize {
        match self.problem.family {
            Family::Uncertain(_) => self.values.len(),
            Family::Measured(family) => family.plants().len(),
        }
    }

    fn plant(&self, index: usize) -> Option<ScannedPlant> {
        match self.problem.family {
            Family::Uncertain(family) => Some(plant_at(&self.evaluator, family, self.values.get(index)?)),
            Family::Measured(family) => {
                let member = self.evaluator.compensation.measured(family.plants().get(index)?);
                let features = features(&self.evaluator, &member);
                Some(ScannedPlant { point: PlantPoint::Measured(index), member: Some(member), features })
            }
        }
    }
}

fn plant_at(evaluator: &Evaluator<'_>, family: &UncertainFamily, values: &[f64]) -> ScannedPlant {
    let member = evaluator.member(family.plant(), values);
    let features = member.as_ref().map_or_else(Features::none, |member| features(evaluator, member));
    ScannedPlant { point: PlantPoint::Parameters(values.to_vec()), member, features }
}
