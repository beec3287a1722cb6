//! Proof of the result of an audit.

use phea_dynamics::pieces::{WorkPiece, Workers};
use phea_dynamics::portable;
use phea_dynamics::watch::{Stopped, Watch, part};

use super::bounds::with_bounds;
use super::certificate::{
    Certificate, CertificateMember, CertificateSide, Claim, FrequencyPanel, LimitOf, LimitedLoop, PoleCount,
    StableBox,
};
use super::checker::check_claim;
use super::claimed::{Claimed, Loop};
use super::count::poles_outside;
use super::hurwitz::{RootLocation, roots_of};
use super::panels::walk_band;
use super::sampling::poles_of_law;
use super::statement::{limit, member_of, stated, values_of};
use super::supremum::{EnclosedSupremum, PlantAtFrequency, SoughtSupremum, corners, enclose};
use super::walk::{ProofBudget, ProofEffort, ProofRegion, WalkOutcome};
use super::{ClaimStatus, NotProven, Proof, SpecificationProof};
use crate::family::Family;
use crate::specification::{Limit, Specification};
use crate::verification::{
    Audit, AuditProblem, PlantPoint, SpecificationFinding, SpecificationMargin, TrackingJudgement,
};

/// Accuracy and limits of a proof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProofOptions {
    /// Largest width of the enclosure of a supremum, dB.
    pub width_db: f64,
    /// Largest number of leaves of one panel.
    pub leaves_maximum: usize,
    /// Largest number of control points of all boxes that one claim may use; the time is
    /// proportional to them.
    pub points_maximum: u64,
    /// The worker threads; the proof does not depend on them.
    pub workers: Workers,
}

impl Default for ProofOptions {
    /// Defaults: 0.05 dB, enough leaves for every known example, and one thread.
    fn default() -> ProofOptions {
        let workers = Workers::CALLER;
        ProofOptions { width_db: 0.05, leaves_maximum: 100_000, points_maximum: 1_000_000_000, workers }
    }
}

/// Reserve for the rounding of the checker, as a fraction of |V|^2: first attempt, and second if
/// that fails.
const ROOMS: [f64; 2] = [1e-11, 3e-5];
/// Largest number of halvings on the way to a leaf.
const DEPTH_MAXIMUM: usize = 120;
/// Plants that are always examined: the nominal one, and the least stable one that the audit found.
const NAMED: usize = 2;
/// Band from the lowest to the highest frequency.
const WHOLE: [f64; 2] = [0.0, f64::INFINITY];

/// Proves or refutes the result of an audit.
///
/// # Errors
/// [`Stopped`] by the watch.
///
/// # Example
/// Plants k/s with k from 1 to 4, closed with gain 1, are stable; |T| reaches 1 at zero frequency,
/// and stays within 1.2 for every plant.
/// ```
/// # use phea_dynamics::controller::Controller;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_dynamics::watch::unwatched;
/// # use phea_qft::audit::audit;
/// # use phea_qft::closed_loop::Compensation;
/// # use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
/// use phea_qft::proof::{ProofOptions, ClaimStatus, check, prove};
/// use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let gain = UncertainParameter { name: "k".into(), nominal: 1.0, minimum: 1.0, maximum: 4.0 };
/// # let plant = UncertainPlant::record(vec![gain], |p| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![p[0]], denominator: vec![1.0.into(), 0.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// # let coordinate = Coordinate { parameters: vec![0], opposed: vec![], spacing: vec![Spacing::Linear], points: 2 };
/// # let members = vertices(&plant, &[coordinate.clone()])?;
/// # let family = Family::Uncertain(UncertainFamily::new(plant, vec![coordinate], members, Extent::Box)?);
/// # let compensation = Compensation::new(&Controller::default(), TransferFunction::gain_only(1.0))?;
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
/// let found = audit(&problem, &mut unwatched)?;
/// let options = ProofOptions::default();
/// let proof = prove(&problem, &found, options, &mut unwatched)?;
/// assert_eq!([&proof.stability, &proof.specifications[0].claim_status], [&ClaimStatus::Proven; 2]);
/// // the greatest ratio, 1/1.2, lies within the enclosure
/// let (least_db, most_db) = (proof.specifications[0].least_db, proof.specifications[0].most_db);
/// let (least_db, most_db) = (least_db.ok_or("reached")?, most_db.ok_or("bounded")?);
/// let ratio_db = -20.0 * f64::log10(1.2);
/// assert!(least_db <= ratio_db + 1e-9 && ratio_db - 1e-9 <= most_db && most_db - least_db < 0.1);
/// assert_eq!(check(&proof.certificate.ok_or("polynomial")?), Ok(()));
/// # Ok(())
/// # }
/// ```
pub fn prove(
    problem: &AuditProblem<'_>,
    audit: &Audit,
    options: ProofOptions,
    watch: Watch<'_>,
) -> Result<Proof, Stopped> {
    let certificate = match stated(problem.family, problem.compensation) {
        Ok(stated) => stated,
        Err(reason) => return Ok(nothing(problem, reason)),
    };
    let budget = ProofBudget::new(options.points_maximum);
    let leaves = options.leaves_maximum;
    let effort = ProofEffort { leaves, depth: DEPTH_MAXIMUM, room: ROOMS[0], budget: &budget };
    let Some(certificate) = with_bounds(certificate, effort, watch)? else {
        return Ok(nothing(problem, NotProven::Images));
    };
    budget.renew();
    let fraction = 1.0 / (problem.specifications.len() as f64 + 1.0);
    let mut prover = Prover { problem, certificate: certificate.clone(), options, effort };
    let stability = prover.stability(audit, &mut part(&mut *watch, "proving", [0.0, fraction]))?;
    let mut certified = prover.certificate;
    // each specification is proven for one loop, without the claims of others
    let mut found: Vec<Option<(SpecificationProof, Vec<Claim>)>> = vec![None; problem.specifications.len()];
    let each = found.iter_mut().zip(&audit.specifications).enumerate();
    let pieces = each.map(|(index, (place, finding))| {
        let (certificate, stability) = (&certificate, &stability);
        let piece: WorkPiece<'_> = Box::new(move |watch: Watch<'_>| {
            let budget = &ProofBudget::new(options.points_maximum);
            let effort = ProofEffort { leaves, depth: DEPTH_MAXIMUM, room: ROOMS[0], budget };
            let mut prover = Prover { problem, certificate: certificate.clone(), options, effort };
            let proof = prover.specification(index, finding, stability, watch)?;
            *place = Some((proof, prover.certificate.claims));
            Ok(())
        });
        piece
    });
    options.workers.work(pieces.collect(), "proving", &mut part(watch, "proving", [fraction, 1.0]))?;
    let (specifications, claims): (Vec<SpecificationProof>, Vec<Vec<Claim>>) =
        found.into_iter().flatten().unzip();
    certified.claims.extend(claims.into_iter().flatten());
    Ok(Proof { certificate: Some(certified), stability, specifications })
}

/// Result for a loop that cannot be stated as a certificate.
fn nothing(problem: &AuditProblem<'_>, reason: NotProven) -> Proof {
    let one = SpecificationProof::without(ClaimStatus::NotProven(reason.clone()));
    Proof {
        certificate: None,
        stability: ClaimStatus::NotProven(reason),
        specifications: vec![one; problem.specifications.len()],
    }
}

impl SpecificationProof {
    fn without(claim_status: ClaimStatus) -> SpecificationProof {
        SpecificationProof { claim_status, least_db: None, most_db: None, worst: None }
    }
}

struct Prover<'a> {
    problem: &'a AuditProblem<'a>,
    certificate: Certificate,
    options: ProofOptions,
    effort: ProofEffort<'a>,
}

impl Prover<'_> {
    /// Retains a claim that the checker confirms; returns true if it does.
    fn keeps(&mut self, claim: Claim) -> bool {
        let confirmed = check_claim(&self.certificate, &claim).is_ok();
        if confirmed {
            self.certificate.claims.push(claim);
        }
        confirmed
    }

    fn stability(&mut self, audit: &Audit, watch: Watch<'_>) -> Result<ClaimStatus, Stopped> {
        let mut boxes = vec![];
        let worst = self.member(&audit.stability.plant);
        for of_box in 0..self.certificate.plant.boxes.len() {
            let nominal = match self.problem.family {
                Family::Uncertain(family) => member_of(&self.certificate.plant, &family.plant().nominal()),
                Family::Measured(_) => None,
            };
            let named = nominal.into_iter().chain(worst.clone()).filter(|member| member.of_box == of_box);
            let members: Vec<CertificateMember> = named.chain(corners(&self.certificate, of_box)).collect();
            match self.stable_box(&members, watch)? {
                Ok(stable) => boxes.push(stable),
                Err(claim_status) => return Ok(claim_status),
            }
        }
        Ok(match self.keeps(Claim::Stable(boxes)) {
            true => ClaimStatus::Proven,
            false => ClaimStatus::NotProven(NotProven::Rounding),
        })
    }

    /// Proof for one box, in which one of these plants is stable.
    fn stable_box(
        &mut self,
        members: &[CertificateMember],
        watch: Watch<'_>,
    ) -> Result<Result<StableBox, ClaimStatus>, Stopped> {
        let mut stable = None;
        for (index, member) in members.iter().enumerate() {
            // in a sampled loop every other plant is determined by the box
            if stable.is_some() && self.certificate.sampling.is_some() && index >= NAMED {
                break;
            }
            match self.poles(member, watch)? {
                PoleLocation::Beyond(count)
                    if self.keeps(Claim::Unstable { member: member.clone(), count: count.clone() }) =>
                {
                    return Ok(Err(ClaimStatus::Refuted));
                }
                PoleLocation::Within(count) if stable.is_none() => stable = Some((member, count)),
                _ => {}
            }
        }
        let not_proven = |reason| Ok(Err(ClaimStatus::NotProven(reason)));
        let Some((member, count)) = stable else { return not_proven(NotProven::NoStableMember) };
        let around = Loop::<f64>::over_box(&self.certificate, member.of_box);
        let (Some(around), Some(at)) = (around, Loop::<f64>::at(&self.certificate, member)) else {
            return not_proven(NotProven::NotPolynomial);
        };
        let variables = self.certificate.plant.variables;
        let panels = match self.never_zero(&around.stability(), variables, member.of_box, watch)? {
            Ok(panels) => panels,
            Err(reason) => return not_proven(reason),
        };
        let mut delays = vec![];
        if self.certificate.plant.is_late() && count.is_none() {
            delays = match self.never_zero(&at.stability_while_delayed(), 1, member.of_box, watch)? {
                Ok(panels) => panels,
                Err(reason) => return not_proven(reason),
            };
        }
        Ok(Ok(StableBox { member: member.variables.clone(), panels, delays, count }))
    }

    /// The position of the poles of the loop with one plant, including those of the prefilter.
    fn poles(&self, member: &CertificateMember, watch: Watch<'_>) -> Result<PoleLocation, Stopped> {
        if self.certificate.sampling.is_some() {
            return self.counted(member, watch);
        }
        let Some(at) = Loop::at(&self.certificate, member) else { return Ok(PoleLocation::Unknown) };
        let roots = [&at.without_dead_time(), at.prefilter_denominator()].map(roots_of);
        Ok(match roots {
            [RootLocation::AllLeft, RootLocation::AllLeft] => PoleLocation::Within(None),
            roots if roots.contains(&RootLocation::SomeNotLeft) => PoleLocation::Beyond(None),
            _ => PoleLocation::Unknown,
        })
    }

    /// The position of the poles of a sampled loop.
    fn counted(&self, member: &CertificateMember, watch: Watch<'_>) -> Result<PoleLocation, Stopped> {
        let (Some(at), Some(sampling)) =
            (Loop::<f64>::at(&self.certificate, member), &self.certificate.sampling)
        else {
            return Ok(PoleLocation::Unknown);
        };
        let (claimed, of_box) = (at.stability(), member.of_box);
        let (denominator, _) = at.denominator_claimed();
        let [_, end] = claimed.band_covered(WHOLE);
        let bands = [(&claimed, WHOLE), (&denominator, [0.0, end]), (&denominator, [end, f64::INFINITY])];
        let mut found = vec![];
        for (claimed, band) in bands {
            match self.never_zero_within(claimed, band, 0, of_box, watch)? {
                Ok(panels) => found.push(panels),
                Err(_) => return Ok(PoleLocation::Unknown),
            }
        }
        let mut found = found.into_iter();
        let (Some(characteristic), Some(denominator), Some(beyond)) =
            (found.next(), found.next(), found.next())
        else {
            return Ok(PoleLocation::Unknown);
        };
        let count = PoleCount { characteristic, denominator, beyond };
        let controller_poles = poles_of_law(&self.certificate.feedback);
        let half = std::f64::consts::PI / sampling.sample_time_s;
        Ok(match poles_outside(&at, controller_poles, &count, half) {
            Some(0) => PoleLocation::Within(Some(count)),
            Some(_) => PoleLocation::Beyond(Some(count)),
            None => PoleLocation::Unknown,
        })
    }

    /// Trees that prove that U is not zero at any frequency.
    fn never_zero(
        &self,
        claimed: &Claimed<f64>,
        variables: usize,
        of_box: usize,
        watch: Watch<'_>,
    ) -> Result<Result<Vec<FrequencyPanel>, NotProven>, Stopped> {
        self.never_zero_within(claimed, WHOLE, variables, of_box, watch)
    }

    fn never_zero_within(
        &self,
        claimed: &Claimed<f64>,
        band: [f64; 2],
        variables: usize,
        of_box: usize,
        watch: Watch<'_>,
    ) -> Result<Result<Vec<FrequencyPanel>, NotProven>, Stopped> {
        let band = claimed.band_covered(band);
        Ok(match walk_band(claimed, variables, band, self.effort, watch)? {
            WalkOutcome::Shown(panels) => Ok(panels),
            WalkOutcome::Open(region) => Err(NotProven::Budget(ProofRegion { of_box, ..region })),
            WalkOutcome::Wrong { .. } => Err(NotProven::Rounding),
            WalkOutcome::TooLarge => Err(NotProven::TooManyVariables),
        })
    }

    fn specification(
        &mut self,
        index: usize,
        finding: &SpecificationFinding,
        stability: &ClaimStatus,
        watch: Watch<'_>,
    ) -> Result<SpecificationProof, Stopped> {
        let specification = &self.problem.specifications[index];
        let requirement = &specification.requirement;
        let highest = self.problem.compensation.highest_frequency_rad_per_s();
        if specification.band_rad_per_s[0] >= highest {
            return Ok(SpecificationProof::without(ClaimStatus::NotProven(NotProven::BeyondSampling)));
        }
        if requirement.is_tracking() && self.problem.tracking == TrackingJudgement::Spread {
            return Ok(SpecificationProof::without(ClaimStatus::NotProven(NotProven::Spread)));
        }
        let hints: Vec<PlantAtFrequency> = self.hints(finding);
        let mut whole = SpecificationProof::without(ClaimStatus::Proven);
        for limited in limited_loops(specification) {
            whole = whole.and(self.side((index, &limited), &hints, stability, watch)?);
        }
        Ok(whole)
    }

    /// One side of a specification, given by its index.
    fn side(
        &mut self,
        (specification, limited): (usize, &LimitedLoop),
        hints: &[PlantAtFrequency],
        stability: &ClaimStatus,
        watch: Watch<'_>,
    ) -> Result<SpecificationProof, Stopped> {
        let decisive = from_db(self.problem.tolerance_db);
        let wanted = SoughtSupremum {
            width: from_db(self.options.width_db),
            decisive,
            effort: self.effort,
            only_points: *stability != ClaimStatus::Proven,
        };
        if let LimitOf::Table(points) = &limited.limit {
            let [from, to] = limited.band_rad_per_s;
            let highest = self.problem.compensation.highest_frequency_rad_per_s().min(to);
            let meets = |pair: &[(f64, f64)]| pair[0].0.max(from) < pair[1].0.min(highest);
            if !points.windows(2).any(meets) {
                return Ok(SpecificationProof::without(ClaimStatus::NotProven(NotProven::TableLimit)));
            }
        }
        let Some(mut found) = enclose(&self.certificate, limited, hints, wanted, watch)? else {
            return Ok(SpecificationProof::without(ClaimStatus::NotProven(NotProven::NotPolynomial)));
        };
        let reached = Claim::Reached {
            limited: limited.clone(),
            ratio: found.least,
            frequency_rad_per_s: found.at.frequency_rad_per_s,
            member: found.at.member.clone(),
        };
        let is_reached = self.keeps(reached);
        let mut most_db = self.keeps_most(limited, found.most.take());
        let rounding = most_db == Some(None);
        if rounding {
            let effort = ProofEffort { room: ROOMS[1], ..wanted.effort };
            let again =
                enclose(&self.certificate, limited, hints, SoughtSupremum { effort, ..wanted }, watch)?;
            most_db = self.keeps_most(limited, again.and_then(|again| again.most));
        }
        let most_db = most_db.flatten();
        let EnclosedSupremum { least, at, open, .. } = found;
        let claim_status = match most_db {
            _ if is_reached && least > decisive => ClaimStatus::Refuted,
            Some(most_db) if most_db <= self.problem.tolerance_db => ClaimStatus::Proven,
            _ if wanted.only_points => ClaimStatus::NotProven(NotProven::Unstable),
            _ if rounding => ClaimStatus::NotProven(NotProven::Rounding),
            _ => ClaimStatus::NotProven(open.map_or(NotProven::Unbounded, NotProven::Budget)),
        };
        let values = values_of(&self.certificate.plant, &at.member);
        let worst = is_reached.then(|| SpecificationMargin {
            specification,
            frequency_rad_per_s: at.frequency_rad_per_s,
            margin_db: -db(least),
            plant: PlantPoint::Parameters(values),
            other: None,
        });
        Ok(SpecificationProof { claim_status, least_db: is_reached.then(|| db(least)), most_db, worst })
    }

    /// Retains a claim that a ratio is not exceeded; returns that ratio, dB, or `None` if the
    /// checker could not confirm it.
    fn keeps_most(
        &mut self,
        limited: &LimitedLoop,
        shown: Option<(f64, Vec<Vec<FrequencyPanel>>)>,
    ) -> Option<Option<f64>> {
        let (ratio, boxes) = shown?;
        let claim = Claim::Limited { limited: limited.clone(), ratio, boxes };
        Some(self.keeps(claim).then(|| db(ratio)))
    }

    /// Points where the audit found the specification to be worst.
    fn hints(&self, finding: &SpecificationFinding) -> Vec<PlantAtFrequency> {
        let cases = finding.worst_margins().chain(&finding.at_design_frequencies);
        cases.filter_map(|case| self.place(&case.plant, case.frequency_rad_per_s)).collect()
    }

    fn place(&self, plant: &PlantPoint, frequency_rad_per_s: f64) -> Option<PlantAtFrequency> {
        Some(PlantAtFrequency { frequency_rad_per_s, member: self.member(plant)? })
    }

    fn member(&self, plant: &PlantPoint) -> Option<CertificateMember> {
        let PlantPoint::Parameters(values) = plant else { return None };
        member_of(&self.certificate.plant, values)
    }
}

/// Limited closed loops of a specification, the lower side first.
pub(super) fn limited_loops(specification: &Specification) -> Vec<LimitedLoop> {
    let requirement = &specification.requirement;
    let (lower, upper) = requirement.limits();
    let lower = lower.filter(|lower| **lower != Limit::Constant(0.0));
    let sides = lower.map(|lower| (CertificateSide::Lower, lower)).into_iter();
    let limited = |(side, own): (CertificateSide, &Limit)| LimitedLoop {
        closed_loop: requirement.closed_loop(),
        side,
        limit: limit(own),
        band_rad_per_s: specification.band_rad_per_s,
    };
    sides.chain([(CertificateSide::Upper, upper)]).map(limited).collect()
}

/// The position of the poles of a loop with one plant: all inside the stability boundary, or at
/// least one on it or beyond.
enum PoleLocation {
    Within(Option<PoleCount>),
    Beyond(Option<PoleCount>),
    Unknown,
}

impl SpecificationProof {
    /// Combination of both sides: the worse verdict, and the greater of both suprema.
    fn and(self, other: SpecificationProof) -> SpecificationProof {
        if self.least_db.is_none() && self.claim_status == ClaimStatus::Proven {
            return other;
        }
        let other_is_worse = other.least_db > self.least_db;
        let (worst, least_db) = match other_is_worse {
            true => (other.worst, other.least_db),
            false => (self.worst, self.least_db),
        };
        let most_db = self.most_db.zip(other.most_db).map(|(one, other)| one.max(other));
        let claim_status = match other.claim_status.verdict() > self.claim_status.verdict() {
            true => other.claim_status,
            false => self.claim_status,
        };
        SpecificationProof { claim_status, least_db, most_db, worst }
    }
}

fn db(ratio: f64) -> f64 {
    20.0 * portable::log10(ratio)
}

pub(super) fn from_db(decibels: f64) -> f64 {
    portable::pow(10.0, decibels / 20.0)
}
