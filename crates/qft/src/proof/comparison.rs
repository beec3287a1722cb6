//! Comparison of a certificate with a problem: a proof holds only for the plant, box and controller
//! that it states.

use super::certificate::{Certificate, CertificateSide, Claim, LimitedLoop, ParameterSegment, Sampling};
use super::prove::{from_db, limited_loops};
use super::statement::stated;
use super::{CertifiedPlant, NotProven};
use crate::verification::{AuditProblem, TrackingJudgement};

/// Difference between the statements of a certificate and a problem, or a missing claim.
#[derive(Clone, Debug, PartialEq)]
pub enum CertificateDifference {
    /// The coefficients of the plant, or its dead time.
    Plant,
    /// The parameters, or their ranges.
    Box,
    /// Feedback G.
    Feedback,
    /// Prefilter F.
    Prefilter,
    /// Sensor H.
    Sensor,
    /// Sampling of the loop.
    Sampling,
    /// Stability of every plant is not claimed.
    Stability,
    /// A side of this specification is not claimed to be satisfied within the tolerance.
    Specification {
        /// Index of the specification.
        index: usize,
        /// Side of the limit.
        side: CertificateSide,
    },
    /// The loop of the problem cannot be stated in a certificate.
    NotStated(NotProven),
}

/// All differences of a certificate from the one that a proof of the problem would make,
/// independent of the validity of its claims; empty if it is the certificate of this problem.
///
/// # Example
/// Without claims, the certificate of another loop differs in its controller and in the missing
/// claims.
/// ```
/// # use phea_dynamics::controller::{Compensator, Controller, Element};
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainPlant};
/// # use phea_dynamics::watch::unwatched;
/// # use phea_qft::audit::audit;
/// # use phea_qft::closed_loop::Compensation;
/// # use phea_qft::family::{Family, UncertainFamily};
/// use phea_qft::proof::{CertificateDifference, ProofOptions, differences, prove};
/// # use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let plant = UncertainPlant::record(vec![], |_| PlantCoefficients {
/// #     command: RationalCoefficients { numerator: vec![1.0.into()], denominator: vec![1.0.into(), 0.0.into()] },
/// #     disturbance: None,
/// #     dead_time_s: 0.0.into(),
/// #     rate: None,
/// # })?;
/// # let family = Family::Uncertain(UncertainFamily::of_nominal(plant));
/// # let with = |gain: f64| {
/// #     let feedback = Compensator::new(vec![Element::Gain(gain)]);
/// #     Compensation::new(&Controller { feedback, ..Controller::default() }, TransferFunction::gain_only(1.0))
/// # };
/// # let (one, two) = (with(1.0)?, with(2.0)?);
/// # let problem = |compensation| AuditProblem {
/// #     family: &family, compensation, specifications: &[], tracking: TrackingJudgement::Magnitude, tolerance_db: TOLERANCE_DB,
/// # };
/// let found = audit(&problem(&one), &mut unwatched)?;
/// let proof = prove(&problem(&one), &found, ProofOptions::default(), &mut unwatched)?;
/// let certificate = proof.certificate.ok_or("polynomials")?;
/// assert_eq!(differences(&certificate, &problem(&one)), []);
/// assert_eq!(differences(&certificate, &problem(&two)), [CertificateDifference::Feedback]);
/// # Ok(())
/// # }
/// ```
pub fn differences(certificate: &Certificate, problem: &AuditProblem<'_>) -> Vec<CertificateDifference> {
    let own = match stated(problem.family, problem.compensation) {
        Ok(own) => own,
        Err(reason) => return vec![CertificateDifference::NotStated(reason)],
    };
    let timing = |sampling: &Option<Sampling>| {
        sampling.as_ref().map(|sampling| [sampling.sample_time_s, sampling.sensor_delay_s])
    };
    let parts = [
        (same_plant(&certificate.plant, &own.plant), CertificateDifference::Plant),
        (ranges(&certificate.plant) == ranges(&own.plant), CertificateDifference::Box),
        (certificate.feedback == own.feedback, CertificateDifference::Feedback),
        (certificate.prefilter == own.prefilter, CertificateDifference::Prefilter),
        (certificate.sensor == own.sensor, CertificateDifference::Sensor),
        (timing(&certificate.sampling) == timing(&own.sampling), CertificateDifference::Sampling),
        (certificate.claims_stability(), CertificateDifference::Stability),
    ];
    let found = parts.into_iter().filter(|(is_same, _)| !is_same).map(|(_, difference)| difference);
    found.chain(unclaimed(certificate, problem)).collect()
}

impl Certificate {
    /// True if it claims that every plant is stable in the loop.
    pub fn claims_stability(&self) -> bool {
        self.claims.iter().any(|claim| matches!(claim, Claim::Stable(_)))
    }

    /// True if it claims that this closed loop stays within this ratio of its limit.
    fn claims(&self, sought: &LimitedLoop, most: f64) -> bool {
        let is_it = |claim: &Claim| match claim {
            Claim::Limited { limited, ratio, .. } => limited == sought && *ratio <= most,
            Claim::Stable(_) | Claim::Unstable { .. } | Claim::Reached { .. } => false,
        };
        self.claims.iter().any(is_it)
    }
}

fn same_plant(one: &CertifiedPlant, other: &CertifiedPlant) -> bool {
    one.coefficients == other.coefficients
        && one.lengths == other.lengths
        && one.has_dead_time == other.has_dead_time
        && one.delay_s == other.delay_s
}

/// Names and ranges of the parameters.
fn ranges(plant: &CertifiedPlant) -> (&[String], usize, &[Vec<ParameterSegment>]) {
    (&plant.parameters, plant.variables, &plant.boxes)
}

/// The sides of specifications that the certificate does not claim to be satisfied.
fn unclaimed(certificate: &Certificate, problem: &AuditProblem<'_>) -> Vec<CertificateDifference> {
    // a number read back from a file equals the one printed, and the ratio is such a number
    let most = from_db(problem.tolerance_db);
    let mut found = vec![];
    for (index, specification) in problem.specifications.iter().enumerate() {
        let is_spread =
            specification.requirement.is_tracking() && problem.tracking == TrackingJudgement::Spread;
        for limited in limited_loops(specification) {
            if is_spread || !certificate.claims(&limited, most) {
                found.push(CertificateDifference::Specification { index, side: limited.side });
            }
        }
    }
    found
}
