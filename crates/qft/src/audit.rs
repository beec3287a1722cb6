//! The audit of a controller: stability, delay margin and specifications of a family, combined into
//! one verdict.
//!
//! ```text
//! stability -> unstable: nothing more to evaluate
//!           -> specifications, also at the plants nearest to instability -> stability of the worst plants of each
//! ```

use phea_dynamics::pieces::Workers;
use phea_dynamics::watch::{Stopped, Watch, part};

use crate::plant_cache::PlantCache;
use crate::stability::{FamilyStability, StabilityAudit};
use crate::verification::{
    Audit, AuditEffort, AuditProblem, Evidence, PlantPoint, Remark, SpecificationFinding,
    SpecificationMargin, StabilityFinding, Verdict, audit_among,
};

/// Name of the stage in progress reports.
const STAGE: &str = "auditing";

/// Audits a controller over the whole family and band.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// The integrator 1/s closed with gain 1 is stable, tolerates pi/2 s of delay, and satisfies |T| <=
/// 1.2 everywhere:
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::audit::audit;
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Extent, Family, UncertainFamily};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let plant = UncertainPlant::record(vec![], |_| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![1.0.into()], denominator: vec![1.0.into(), 0.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let family = Family::Uncertain(UncertainFamily::new(plant, vec![], vec![], Extent::Box)?);
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let specifications = [Specification {
///     requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
///     frequencies_rad_per_s: vec![1.0],
///     band_rad_per_s: [0.0, f64::INFINITY],
/// }];
/// let problem = AuditProblem {
///     family: &family,
///     compensation: &compensation,
///     specifications: &specifications,
///     tracking: TrackingJudgement::Magnitude,
///     tolerance_db: TOLERANCE_DB,
/// };
/// let audit = audit(&problem, &mut unwatched)?;
/// assert_eq!(audit.verdict, Verdict::Met);
/// let tolerated = audit.delay_margin.ok_or("it is stable")?.delay_s;
/// assert!((tolerated - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
pub fn audit(problem: &AuditProblem<'_>, watch: Watch<'_>) -> Result<Audit, Stopped> {
    audit_by(problem, Workers::CALLER, watch)
}

/// Audits as [`audit`] does, on the given worker threads; the result does not depend on them.
///
/// # Errors
/// [`Stopped`] by the watch.
pub fn audit_by(problem: &AuditProblem<'_>, workers: Workers, watch: Watch<'_>) -> Result<Audit, Stopped> {
    audit_with(problem, (&PlantCache::of(workers), AuditEffort::Complete), watch).map(|(audit, _)| audit)
}

/// Audits only the members and corners of the family, without a search between them. Meant for a
/// design search that audits often and audits its final result in full.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// An integrator of gain 1/2 or 2 in a loop of gain 1: |T| = k/sqrt(w^2 + k^2) is at most 1, as the
/// complete audit also finds.
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// use phea_dynamics::watch::unwatched;
/// use phea_qft::audit::{audit, audit_of_known_plants};
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Extent, Family, UncertainFamily};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement, Verdict};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 0.5, maximum: 2.0 };
/// let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
///     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
///     disturbance: None,
///     dead_time_s: 0.0.into(),
///     rate: None,
/// })?;
/// let members = vec![vec![0.5], vec![2.0]];
/// let family = Family::Uncertain(UncertainFamily::new(plant, vec![], members, Extent::Members)?);
/// let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
/// let specifications = [Specification {
///     requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
///     frequencies_rad_per_s: vec![1.0],
///     band_rad_per_s: [0.0, f64::INFINITY],
/// }];
/// let problem = AuditProblem {
///     family: &family,
///     compensation: &compensation,
///     specifications: &specifications,
///     tracking: TrackingJudgement::Magnitude,
///     tolerance_db: TOLERANCE_DB,
/// };
/// let known = audit_of_known_plants(&problem, &mut unwatched)?;
/// assert_eq!(known.verdict, audit(&problem, &mut unwatched)?.verdict);
/// # Ok(())
/// # }
/// ```
pub fn audit_of_known_plants(problem: &AuditProblem<'_>, watch: Watch<'_>) -> Result<Audit, Stopped> {
    audit_of_known_plants_by(problem, Workers::CALLER, watch)
}

/// Audits as [`audit_of_known_plants`] does, on the given worker threads; the result does not
/// depend on them.
///
/// # Errors
/// [`Stopped`] by the watch.
pub fn audit_of_known_plants_by(
    problem: &AuditProblem<'_>,
    workers: Workers,
    watch: Watch<'_>,
) -> Result<Audit, Stopped> {
    let effort = AuditEffort::KnownPlants;
    audit_with(problem, (&PlantCache::of(workers), effort), watch).map(|(audit, _)| audit)
}

/// Audits to the given extent, with plants of this family already sampled in the same loop (with
/// any controller), so that none is sampled twice. Returns the audit and true if no search was
/// skipped.
pub(crate) fn audit_with(
    problem: &AuditProblem<'_>,
    (cache, effort): (&PlantCache, AuditEffort),
    watch: Watch<'_>,
) -> Result<(Audit, bool), Stopped> {
    let mut stability = StabilityAudit::new(problem.family, problem.compensation, cache);
    let searches = stability.searched() && effort != AuditEffort::KnownPlants;
    match effort {
        AuditEffort::KnownPlants => stability.evaluate_plants(&mut part(watch, STAGE, [0.0, 0.4]))?,
        _ => stability.evaluate(&mut part(watch, STAGE, [0.0, 0.4]))?,
    }
    let found = stability.result();
    if is_unstable(&found.finding) {
        // an unstable loop has no margins to search for
        return Ok((joined(problem, found, problem.unexamined()), true));
    }
    let between = if searches { stability.plants_between() } else { vec![] };
    let (specifications, work) =
        audit_among(problem, &between, (cache, effort), &mut part(watch, STAGE, [0.4, 0.98]))?;
    if searches {
        stability.evaluate_at(&suspects(&specifications), &mut part(watch, STAGE, [0.98, 1.0]))?;
    }
    Ok((joined(problem, stability.result(), specifications), work.skipped == 0))
}

/// Combines stability and specifications into one verdict.
fn joined(
    problem: &AuditProblem<'_>,
    stability: FamilyStability,
    mut specifications: Vec<SpecificationFinding>,
) -> Audit {
    if is_unstable(&stability.finding) {
        specifications = problem.unexamined();
    }
    for finding in &mut specifications {
        without_stability(finding, &stability.finding);
    }
    let (verdict, evidence) = together(&stability.finding, &specifications);
    Audit {
        verdict,
        evidence,
        tolerance_db: problem.tolerance_db,
        delay_margin: stability.delay_margin,
        stability: stability.finding,
        specifications,
    }
}

impl Audit {
    /// The audit of the first `count` specifications, and the findings for the rest.
    pub fn split_off(&self, count: usize) -> (Audit, Vec<SpecificationFinding>) {
        let mut own = self.clone();
        let others = own.specifications.split_off(count.min(own.specifications.len()));
        (own.verdict, own.evidence) = together(&own.stability, &own.specifications);
        (own, others)
    }
}

/// The worst verdict over stability and specifications, and the weakest evidence.
fn together(stability: &StabilityFinding, specifications: &[SpecificationFinding]) -> (Verdict, Evidence) {
    let verdicts = specifications.iter().map(|finding| finding.verdict);
    let evidences = specifications.iter().map(|finding| finding.evidence);
    (verdicts.fold(stability.verdict, Verdict::max), evidences.fold(stability.evidence, Evidence::min))
}

/// The plants at which the specifications are worst, without duplicates.
fn suspects(findings: &[SpecificationFinding]) -> Vec<PlantPoint> {
    let mut plants: Vec<PlantPoint> = Vec::new();
    for finding in findings {
        for plant in finding.worst_margins().flat_map(SpecificationMargin::plants) {
            if !plants.contains(plant) {
                plants.push(plant.clone());
            }
        }
    }
    plants
}

/// True if a loop of the family is unstable. If stability is violated although all poles of the
/// loop decay, the prefilter is unstable; only the reference passes through it.
fn is_unstable(stability: &StabilityFinding) -> bool {
    let decays = stability.largest_real_part.is_some_and(|real| real < 0.0);
    stability.verdict == Verdict::Violated && !decays
}

/// The magnitudes of an unstable loop do not describe a response: it satisfies no specification and
/// has no margin. This may also be true of a loop that is not known to be stable.
fn without_stability(finding: &mut SpecificationFinding, stability: &StabilityFinding) {
    let tracks = finding.requirement.is_tracking();
    match stability.verdict {
        Verdict::Met => {}
        Verdict::Violated if !is_unstable(stability) && !tracks => {}
        Verdict::Violated => {
            *finding = SpecificationFinding {
                requirement: finding.requirement.clone(),
                verdict: Verdict::Violated,
                evidence: finding.evidence,
                worst: None,
                interior: None,
                as_bad: vec![],
                violations: vec![],
                at_design_frequencies: vec![],
                envelope: vec![],
                remarks: vec![Remark::Unstable],
            };
        }
        Verdict::NotProven => {
            finding.verdict = finding.verdict.max(Verdict::NotProven);
            finding.remarks.push(Remark::StabilityNotKnown);
        }
    }
}
