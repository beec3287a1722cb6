//! The audit of a controller: stability, delay margin and specifications of a family put together into one verdict.

use crate::closed_loop::Compensation;
use crate::family::Family;
use crate::sampled::SampledPlants;
use crate::specification::{Requirement, Specification};
use crate::stability::StabilityAudit;
use crate::verification::{
    Audit, Evidence, PlantPoint, SpecificationAudit, SpecificationFinding, StabilityFinding,
    TrackingJudgement, Verdict,
};

/// Share of the work that stability takes, for the progress.
const STABILITY_SHARE: f64 = 0.4;

/// What an audit is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Stability,
    Specifications,
    /// Stability once more, of the worst plants of each specification.
    Suspects,
    Done,
}

/// An audit stepped by its owner, who may show its progress or stop it at any step.
///
/// # Example
/// The integrator 1/s closed with gain 1 is stable, bears pi/2 s of delay, and keeps |T| <= 1.2 everywhere:
/// ```
/// use phea_dynamics::controller::Controller;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
/// use phea_qft::audit::AuditRun;
/// use phea_qft::closed_loop::Compensation;
/// use phea_qft::family::{Extent, Family, UncertainFamily};
/// use phea_qft::specification::{Limit, Requirement, Specification};
/// use phea_qft::verification::{TOLERANCE_DB, TrackingJudgement, Verdict};
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
///     requirement: Requirement::RobustStability(Limit::Constant(1.2)),
///     frequencies_rad_per_s: vec![1.0],
///     band_rad_per_s: [0.0, f64::INFINITY],
/// }];
/// let mut run =
///     AuditRun::new(&family, &compensation, &specifications, TrackingJudgement::Magnitude, TOLERANCE_DB);
/// while run.step() {}
/// let audit = run.audit();
/// assert_eq!(audit.verdict, Verdict::Met);
/// let bears = audit.delay_margin.ok_or("it is stable")?.delay_s;
/// assert!((bears - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct AuditRun {
    stability: StabilityAudit,
    stage: Stage,
    specifications: SpecificationAudit,
    tolerance_db: f64,
}

impl AuditRun {
    /// An audit that has not begun. A margin of minus `tolerance_db` still counts as met.
    pub fn new(
        family: &Family,
        compensation: &Compensation,
        specifications: &[Specification],
        tracking: TrackingJudgement,
        tolerance_db: f64,
    ) -> AuditRun {
        AuditRun {
            stability: StabilityAudit::new(family, compensation),
            stage: Stage::Stability,
            specifications: SpecificationAudit::new(
                family,
                compensation,
                specifications,
                tracking,
                tolerance_db,
            ),
            tolerance_db,
        }
    }

    /// Hands over the plants of the audit of stability, for the tests of this package.
    #[doc(hidden)]
    pub fn take_stability_plants(&mut self) -> SampledPlants {
        self.stability.take_sampled()
    }

    /// Takes over plants of the same family within the same loop, whatever its controller, so that none is sampled twice.
    pub(crate) fn take_over(&mut self, sampled: SampledPlants) {
        self.stability.take_over(sampled);
    }

    /// Hands over the plants that were sampled, once all is done.
    pub(crate) fn take_sampled(&mut self) -> SampledPlants {
        self.specifications.take_sampled()
    }

    /// Does a small part of the work; whether there is more to do.
    ///
    /// Both audits share their plants: those that the audit of stability looked at between members and corners, and the nearest to
    /// instability, are looked at for every specification, and the worst of each specification is judged for its stability.
    pub fn step(&mut self) -> bool {
        match self.stage {
            Stage::Stability => {
                if !self.stability.step() {
                    self.specifications.take_over(self.stability.take_sampled());
                    if self.stability.searched() {
                        self.specifications.add(self.stability.plants_between());
                    }
                    // an unstable loop has no margins to look for
                    let decided = is_unstable(&self.stability.result().finding);
                    self.stage = if decided { Stage::Done } else { Stage::Specifications };
                }
            }
            Stage::Specifications => {
                if !self.specifications.step() {
                    let worst = suspects(self.specifications.findings());
                    self.stability.take_over(self.specifications.take_sampled());
                    if self.stability.searched() {
                        self.stability.look_at(worst);
                    }
                    self.stage = Stage::Suspects;
                }
            }
            Stage::Suspects => {
                if !self.stability.step() {
                    self.specifications.take_over(self.stability.take_sampled());
                    self.stage = Stage::Done;
                }
            }
            Stage::Done => return false,
        }
        self.stage != Stage::Done
    }

    /// The share of the work that is done, 0 to 1.
    pub fn progress(&self) -> f64 {
        match self.stage {
            Stage::Stability => STABILITY_SHARE * self.stability.progress(),
            Stage::Specifications => {
                STABILITY_SHARE + (0.98 - STABILITY_SHARE) * self.specifications.progress()
            }
            Stage::Suspects => 0.98,
            Stage::Done => 1.0,
        }
    }

    /// What was found; complete once [`AuditRun::step`] has answered that there is nothing left.
    pub fn audit(&self) -> Audit {
        let stability = self.stability.result();
        let mut specifications = match is_unstable(&stability.finding) && self.stage == Stage::Done {
            true => self.specifications.unexamined(),
            false => self.specifications.findings().to_vec(),
        };
        for finding in &mut specifications {
            without_stability(finding, &stability.finding);
        }
        let verdicts = specifications.iter().map(|finding| finding.verdict);
        let verdict = verdicts.fold(stability.finding.verdict, worse);
        let evidences = specifications.iter().map(|finding| finding.evidence);
        let evidence = evidences.fold(stability.finding.evidence, Evidence::min);
        Audit {
            verdict,
            evidence,
            tolerance_db: self.tolerance_db,
            delay_margin: stability.delay_margin,
            stability: stability.finding,
            specifications,
        }
    }
}

/// The plants at which specifications are worst, each once.
fn suspects(findings: &[SpecificationFinding]) -> Vec<PlantPoint> {
    let mut plants: Vec<PlantPoint> = Vec::new();
    for finding in findings {
        let cases = finding.worst.iter().chain(&finding.interior);
        let cases = cases.chain(finding.violations.iter().map(|band| &band.worst));
        for plant in cases.flat_map(|case| std::iter::once(&case.plant).chain(&case.other)) {
            if !plants.contains(plant) {
                plants.push(plant.clone());
            }
        }
    }
    plants
}

/// A violation outweighs what is not proven, and that what is met.
fn worse(one: Verdict, other: Verdict) -> Verdict {
    match (one, other) {
        (Verdict::Violated, _) | (_, Verdict::Violated) => Verdict::Violated,
        (Verdict::NotProven, _) | (_, Verdict::NotProven) => Verdict::NotProven,
        (Verdict::Met, Verdict::Met) => Verdict::Met,
    }
}

/// Whether a loop of the family is unstable. Where all poles decay and stability is violated, it is by the prefilter, which only the
/// reference goes through.
fn is_unstable(stability: &StabilityFinding) -> bool {
    let decays = stability.largest_real_part.is_some_and(|real| real < 0.0);
    stability.verdict == Verdict::Violated && !decays
}

/// The magnitudes of an unstable loop are those of no response: it keeps to no specification, by no margin. Of a loop that is not known to
/// be stable, they may be.
fn without_stability(finding: &mut SpecificationFinding, stability: &StabilityFinding) {
    let tracks = matches!(finding.requirement, Requirement::Tracking { .. });
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
                violations: vec![],
                at_design_frequencies: vec![],
                envelope: vec![],
                remarks: vec!["the loop is unstable, so that it has no margin".to_string()],
            };
        }
        Verdict::NotProven => {
            if finding.verdict == Verdict::Met {
                finding.verdict = Verdict::NotProven;
            }
            let remark = "the loop is not known to be stable: its margins may be those of no response";
            finding.remarks.push(remark.to_string());
        }
    }
}
