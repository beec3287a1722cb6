//! From an audit to its proof.

use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch, part};

use super::certificate::{Certificate, Claim, Limited, Side};
use super::checker::check_claim;
use super::claimed::Loop;
use super::hurwitz::{Roots, roots_of};
use super::polynomial::InS;
use super::statement::{Stated, limit, stated, values_at, variables_of};
use super::supremum::{Enclosed, Wanted, enclose, ranges};
use super::walk::{Effort, Place, Walk, walk};
use super::{NotProven, Proof, SpecificationProof, Standing};
use crate::specification::{Limit, Specification};
use crate::verification::{
    Audit, AuditProblem, PlantPoint, SpecificationFinding, TrackingJudgement, WorstCase,
};

/// How far a proof goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProofOptions {
    /// The enclosure of a supremum is at most this wide, dB.
    pub width_db: f64,
    /// Leaves of one claim at most.
    pub leaves_maximum: usize,
}

impl Default for ProofOptions {
    /// 0.05 dB, and leaves enough for every example that is known.
    fn default() -> ProofOptions {
        ProofOptions { width_db: 0.05, leaves_maximum: 100_000 }
    }
}

/// Halvings on the way to a leaf at most.
const DEPTH_MAXIMUM: usize = 120;
/// Corners of the box among which a stable plant is looked for.
const CORNERS_MAXIMUM: usize = 64;

/// Proves or refutes what an audit found.
///
/// # Errors
/// [`Stopped`] by the watch.
pub fn prove(
    problem: &AuditProblem<'_>,
    audit: &Audit,
    options: ProofOptions,
    watch: Watch<'_>,
) -> Result<Proof, Stopped> {
    let Stated { certificate, larger } = match stated(problem.family, problem.compensation) {
        Ok(stated) => stated,
        Err(reason) => return Ok(nothing(problem, reason)),
    };
    if Loop::<f64>::over_box(&certificate).is_none() {
        return Ok(nothing(problem, NotProven::NotPolynomial));
    }
    let effort = Effort { leaves: options.leaves_maximum, depth: DEPTH_MAXIMUM };
    let mut prover = Prover { problem, certificate, larger, options, effort };
    let parts = problem.specifications.len() as f64 + 1.0;
    let stability = prover.stability(audit, &mut part(watch, "proving", [0.0, 1.0 / parts]))?;
    let mut specifications = Vec::with_capacity(problem.specifications.len());
    for (index, (specification, finding)) in
        problem.specifications.iter().zip(&audit.specifications).enumerate()
    {
        let share = [(index as f64 + 1.0) / parts, (index as f64 + 2.0) / parts];
        let watch = &mut part(watch, "proving", share);
        specifications.push(prover.specification(specification, finding, &stability, watch)?);
    }
    Ok(Proof { certificate: Some(prover.certificate), stability, specifications })
}

/// Of a loop that cannot be stated.
fn nothing(problem: &AuditProblem<'_>, reason: NotProven) -> Proof {
    let one = SpecificationProof::without(Standing::NotProven(reason.clone()));
    Proof {
        certificate: None,
        stability: Standing::NotProven(reason),
        specifications: vec![one; problem.specifications.len()],
    }
}

impl SpecificationProof {
    fn without(standing: Standing) -> SpecificationProof {
        SpecificationProof { standing, least_db: None, most_db: None, worst: None }
    }
}

struct Prover<'a> {
    problem: &'a AuditProblem<'a>,
    certificate: Certificate,
    larger: bool,
    options: ProofOptions,
    effort: Effort,
}

impl Prover<'_> {
    fn refuted(&self) -> Standing {
        if self.larger { Standing::NotProven(NotProven::LargerBox) } else { Standing::Refuted }
    }

    /// Keeps a claim that the checker confirms.
    fn keeps(&mut self, claim: Claim) -> bool {
        let confirmed = check_claim(&self.certificate, &claim).is_ok();
        if confirmed {
            self.certificate.claims.push(claim);
        }
        confirmed
    }

    fn stability(&mut self, audit: &Audit, watch: Watch<'_>) -> Result<Standing, Stopped> {
        let mut stable = None;
        for member in self.members(audit) {
            let Some(at) = Loop::at(&self.certificate, &member) else { continue };
            let roots = [&at.characteristic(), at.prefilter_denominator()].map(roots_of);
            if roots.contains(&Roots::SomeNotLeft) && self.keeps(Claim::Unstable { member: member.clone() }) {
                return Ok(self.refuted());
            }
            if stable.is_none() && roots == [Roots::AllLeft; 2] {
                stable = Some(member);
            }
        }
        let Some(member) = stable else { return Ok(Standing::NotProven(NotProven::NoStableMember)) };
        let Some(around) = Loop::<f64>::over_box(&self.certificate) else {
            return Ok(Standing::NotProven(NotProven::NotPolynomial));
        };
        let u = around.characteristic();
        let ranges = ranges([0.0, f64::INFINITY], &[&u]);
        let found = walk(&[u, InS(vec![])], self.certificate.plant.variables, &ranges, self.effort, watch)?;
        Ok(match found {
            Walk::Shown(panels) => match self.keeps(Claim::Stable { member, panels }) {
                true => Standing::Proven,
                false => Standing::NotProven(NotProven::Rounding),
            },
            Walk::Open(region) => Standing::NotProven(NotProven::Budget(region)),
            Walk::Wrong { .. } => Standing::NotProven(NotProven::Rounding),
        })
    }

    /// Plants of which one may be unstable, and one will be stable: the nominal one first.
    fn members(&self, audit: &Audit) -> Vec<Vec<f64>> {
        let plant = &self.certificate.plant;
        let mut members = vec![];
        if let crate::family::Family::Uncertain(family) = self.problem.family {
            members.push(variables_of(plant, &family.plant().nominal()));
        }
        members.extend(self.place(&audit.stability.plant, 0.0).map(|place| place.member));
        let corners = (0..1_usize << plant.variables).take(CORNERS_MAXIMUM);
        members
            .extend(corners.map(|bits| (0..plant.variables).map(|axis| (bits >> axis & 1) as f64).collect()));
        members
    }

    fn specification(
        &mut self,
        specification: &Specification,
        finding: &SpecificationFinding,
        stability: &Standing,
        watch: Watch<'_>,
    ) -> Result<SpecificationProof, Stopped> {
        let requirement = &specification.requirement;
        if requirement.is_tracking() && self.problem.tracking == TrackingJudgement::Spread {
            return Ok(SpecificationProof::without(Standing::NotProven(NotProven::Spread)));
        }
        let hints: Vec<Place> = self.hints(finding);
        let (lower, upper) = requirement.limits();
        let lower = lower.filter(|lower| **lower != Limit::Constant(0.0)).map(|lower| (Side::Lower, lower));
        let mut whole = SpecificationProof::without(Standing::Proven);
        for (side, own) in lower.into_iter().chain([(Side::Upper, upper)]) {
            let one = match limit(own) {
                None => SpecificationProof::without(Standing::NotProven(NotProven::TableLimit)),
                Some(limit) => {
                    let closed_loop = requirement.closed_loop();
                    let band_rad_per_s = specification.band_rad_per_s;
                    let limited = Limited { closed_loop, side, limit, band_rad_per_s };
                    self.side(&limited, &hints, stability, watch)?
                }
            };
            whole = whole.and(one);
        }
        Ok(whole)
    }

    /// One side of a specification.
    fn side(
        &mut self,
        limited: &Limited,
        hints: &[Place],
        stability: &Standing,
        watch: Watch<'_>,
    ) -> Result<SpecificationProof, Stopped> {
        let decisive = from_db(self.problem.tolerance_db);
        let wanted = Wanted {
            width: from_db(self.options.width_db),
            decisive,
            effort: self.effort,
            only_points: *stability != Standing::Proven,
        };
        let Some(found) = enclose(&self.certificate, limited, hints, wanted, watch)? else {
            return Ok(SpecificationProof::without(Standing::NotProven(NotProven::NotPolynomial)));
        };
        let Enclosed { least, at, most, open } = found;
        let reached = Claim::Reached {
            limited: limited.clone(),
            ratio: least,
            frequency_rad_per_s: at.frequency_rad_per_s,
            member: at.member.clone(),
        };
        let is_reached = self.keeps(reached);
        let mut rounding = false;
        let most_db = most.and_then(|(ratio, panels)| {
            let claim = Claim::Limited { limited: limited.clone(), ratio, panels };
            rounding = !self.keeps(claim);
            (!rounding).then(|| db(ratio))
        });
        let standing = match most_db {
            _ if is_reached && least > decisive => self.refuted(),
            Some(most_db) if most_db <= self.problem.tolerance_db => Standing::Proven,
            _ if wanted.only_points => Standing::NotProven(NotProven::Unstable),
            _ if rounding => Standing::NotProven(NotProven::Rounding),
            _ => Standing::NotProven(open.map_or(NotProven::Unbounded, NotProven::Budget)),
        };
        let values = values_at(&self.certificate.plant, &at.member);
        let worst = is_reached.then(|| WorstCase {
            margin_db: -db(least),
            frequency_rad_per_s: at.frequency_rad_per_s,
            plant: PlantPoint::Parameters(values),
            other: None,
        });
        Ok(SpecificationProof { standing, least_db: is_reached.then(|| db(least)), most_db, worst })
    }

    /// Where the audit found the specification to be worst.
    fn hints(&self, finding: &SpecificationFinding) -> Vec<Place> {
        let bands = finding.violations.iter().map(|band| &band.worst);
        let cases =
            finding.worst.iter().chain(&finding.interior).chain(bands).chain(&finding.at_design_frequencies);
        cases.filter_map(|case| self.place(&case.plant, case.frequency_rad_per_s)).collect()
    }

    fn place(&self, plant: &PlantPoint, frequency_rad_per_s: f64) -> Option<Place> {
        let PlantPoint::Parameters(values) = plant else { return None };
        Some(Place { frequency_rad_per_s, member: variables_of(&self.certificate.plant, values) })
    }
}

impl SpecificationProof {
    /// Both sides together: the worse standing, and the greater of both suprema.
    fn and(self, other: SpecificationProof) -> SpecificationProof {
        let rank = |standing: &Standing| match standing {
            Standing::Refuted => 0,
            Standing::NotProven(_) => 1,
            Standing::Proven => 2,
        };
        if self.least_db.is_none() && self.standing == Standing::Proven {
            return other;
        }
        let other_is_worse = other.least_db > self.least_db;
        let (worst, least_db) = match other_is_worse {
            true => (other.worst, other.least_db),
            false => (self.worst, self.least_db),
        };
        let most_db = self.most_db.zip(other.most_db).map(|(one, other)| one.max(other));
        let standing =
            if rank(&other.standing) < rank(&self.standing) { other.standing } else { self.standing };
        SpecificationProof { standing, least_db, most_db, worst }
    }
}

fn db(ratio: f64) -> f64 {
    20.0 * portable::log10(ratio)
}

fn from_db(decibels: f64) -> f64 {
    portable::pow(10.0, decibels / 20.0)
}
