//! The checker of certificates. It relies on nothing but the certificate, and rounds outwards
//! wherever it rounds.
//!
//! ```text
//! leaf with direction (a, b):   x_k = a Re U_k + b Im U_k - (|a| + |b|) e_k > 0,   x_k^2 >= (a^2 + b^2) |V_k|^2      for every control point
//! ```
//!
//! Re(conj(d) U) - |d| (|V| + e) is concave in (U, V, e): if it is not negative at the control
//! points, it is not negative between them.

use phea_dynamics::scalar::{Interval, Scalar};

use super::certificate::{
    Certificate, CertificateMember, CertificateSide, Claim, FrequencyPanel, LEAF, Late, LimitOf, LimitedLoop,
    ParameterSegment, PoleCount, Quotient, StableBox,
};
use super::claimed::{BandClaim, Claimed, Loop};
use super::count::poles_outside;
use super::dead_time::ends;
use super::hurwitz::{RootLocation, roots_of};
use super::images::PlantImages;
use super::patch::{Patch, at_point};
use super::points::{PanelPoint, PanelRange};
use super::polynomial::VARIABLES_MAXIMUM;
use super::sampling::{check_bounds, check_sampling, pi_over_t, poles_of_law, prefilter_is_stable};
use crate::specification::ClosedLoop;

/// Largest number of halvings on the way to a leaf: more than any proof needs.
const DEPTH_MAXIMUM: usize = 256;

/// Largest degree of a polynomial that replaces a coefficient.
const MODEL_DEGREE_MAXIMUM: usize = 8;
/// Largest number of terms of the series of dead time.
const DEAD_TIME_TERMS_MAXIMUM: usize = 24;

/// Kind of a number in a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CertificateNumber {
    /// Frequency of a panel, rad/s.
    #[error("a frequency")]
    Frequency,
    /// Variable of a plant of the family.
    #[error("a variable of a plant")]
    PlantVariable,
    /// End of the interval of a parameter.
    #[error("an end of a parameter")]
    ParameterEnd,
    /// Ratio to a limit, or end of a band.
    #[error("a ratio or the end of a band")]
    RatioOrBandEnd,
    /// Band without a claim.
    #[error("a band without a limit")]
    BandWithoutLimit,
    /// Dead time, s.
    #[error("a dead time")]
    DeadTime,
    /// Number in the sampling data.
    #[error("of the sampling")]
    Sampling,
}

/// Reason why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The plant is not polynomial in its parameters, or lacks the path that is limited.
    #[error("the certificate does not describe the loop that it makes a claim about")]
    NoSuchLoop,
    /// A number that is not finite, a band without width, a ratio or frequency that is negative.
    #[error("{0} is not a number that it can be")]
    Number(CertificateNumber),
    /// A certificate without claims.
    #[error("the certificate makes no claim")]
    NoClaim,
    /// A number of boxes other than that of the family.
    #[error("it does not cover every box of the family")]
    Boxes,
    /// More control points than a claim may have.
    #[error("a claim has too many control points")]
    TooLarge,
    /// Panels with a gap, or that do not reach an end.
    #[error("the panels do not cover the band: there is a gap at {0} rad/s")]
    Gap(f64),
    /// A panel or a band beyond the frequencies up to which a sampled loop is known.
    #[error("{0} rad/s is beyond half of the sampling frequency")]
    Beyond(f64),
    /// Treatment of dead time that is absent, or in a way that such a panel does not allow.
    #[error("dead time is not taken as it is on the panel from {0} rad/s")]
    Late(f64),
    /// A tree that ends too early or too late, or halves an axis that does not exist.
    #[error("the tree of the panel from {0} rad/s is not well formed")]
    Tree(f64),
    /// A leaf that does not prove the claim.
    #[error("leaf {leaf} of the panel from {from} rad/s does not show the claim")]
    Leaf {
        /// Number of the leaf, from 1.
        leaf: usize,
        /// Lower end of the panel, rad/s.
        from: f64,
    },
    /// A plant that does not have the claimed poles.
    #[error("the poles of the plant that is named cannot be shown to be where they are said to be")]
    Poles,
    /// A point at which the ratio is not reached.
    #[error("the ratio is not reached at the point that is named")]
    Point,
}

/// Checks every claim; there must be at least one.
///
/// # Errors
/// [`Rejection`] with the number of the claim, from 1, that is not proven.
///
/// # Example
/// The certificate that k/s with k from 1 to 4, closed with gain 1, satisfies |T| <= 1.2 is valid;
/// one that claims 0.9 is not, since |T| is 1 at zero frequency, and neither is one without claims.
/// ```
/// # use phea_dynamics::controller::Controller;
/// # use phea_dynamics::linear::TransferFunction;
/// # use phea_dynamics::uncertain_plant::{PlantCoefficients, RationalCoefficients, UncertainParameter, UncertainPlant};
/// # use phea_dynamics::watch::unwatched;
/// # use phea_qft::audit::audit;
/// # use phea_qft::closed_loop::Compensation;
/// # use phea_qft::family::{Coordinate, Extent, Family, Spacing, UncertainFamily, vertices};
/// use phea_qft::proof::{Certificate, Claim, ProofOptions, Rejection, check, prove};
/// # use phea_qft::specification::{ClosedLoop, Limit, Requirement, Specification};
/// # use phea_qft::verification::{AuditProblem, TOLERANCE_DB, TrackingJudgement};
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
/// # let specifications = [Specification {
/// #     requirement: Requirement::at_most(ClosedLoop::RobustStability, Limit::Constant(1.2)),
/// #     frequencies_rad_per_s: vec![1.0],
/// #     band_rad_per_s: [0.0, f64::INFINITY],
/// # }];
/// # let problem = AuditProblem {
/// #     family: &family,
/// #     compensation: &compensation,
/// #     specifications: &specifications,
/// #     tracking: TrackingJudgement::Magnitude,
/// #     tolerance_db: TOLERANCE_DB,
/// # };
/// # let found = audit(&problem, &mut unwatched)?;
/// let proof = prove(&problem, &found, ProofOptions::default(), &mut unwatched)?;
/// let certificate = proof.certificate.ok_or("polynomial")?;
/// assert_eq!(check(&certificate), Ok(()));
/// let mut tampered = certificate.clone();
/// for claim in &mut tampered.claims {
///     if let Claim::Limited { ratio, .. } = claim {
///         *ratio = 0.9 / 1.2;
///     }
/// }
/// assert!(check(&tampered).is_err());
/// let empty = Certificate { claims: vec![], ..certificate };
/// assert_eq!(check(&empty), Err((1, Rejection::NoClaim)));
/// # Ok(())
/// # }
/// ```
pub fn check(certificate: &Certificate) -> Result<(), (usize, Rejection)> {
    if certificate.claims.is_empty() {
        return Err((1, Rejection::NoClaim));
    }
    let claims = certificate.claims.iter().enumerate();
    claims
        .map(|(index, claim)| (index + 1, check_claim(certificate, claim)))
        .try_for_each(|(number, checked)| checked.map_err(|rejection| (number, rejection)))
}

/// Checks one claim.
///
/// # Errors
/// [`Rejection`] of the claim.
pub(crate) fn check_claim(certificate: &Certificate, claim: &Claim) -> Result<(), Rejection> {
    check_numbers(certificate)?;
    check_sampling(certificate)?;
    let variables = certificate.plant.variables;
    match claim {
        Claim::Stable(boxes) => {
            check_boxes(certificate, boxes.len())?;
            for (of_box, one) in boxes.iter().enumerate() {
                let member = CertificateMember { of_box, variables: one.member.clone() };
                check_stable_box(certificate, &member, one)?;
            }
            Ok(())
        }
        Claim::Unstable { member, count } => check_unstable(certificate, member, count.as_ref()),
        Claim::Limited { limited, ratio, boxes } => {
            check_ratio(certificate, limited, *ratio)?;
            check_boxes(certificate, boxes.len())?;
            for (of_box, panels) in boxes.iter().enumerate() {
                let around = sound(Loop::over_box(certificate, of_box))?;
                check_bounds(certificate, of_box, &around)?;
                let pieces = around.claimed(limited, *ratio).ok_or(Rejection::NoSuchLoop)?;
                check_pieces(&pieces, variables, panels)?;
            }
            Ok(())
        }
        Claim::Reached { limited, ratio, frequency_rad_per_s, member } => {
            check_ratio(certificate, limited, *ratio)?;
            let [from, to] = limited.band_rad_per_s;
            if !(from <= *frequency_rad_per_s && *frequency_rad_per_s <= to) {
                return Err(Rejection::Number(CertificateNumber::Frequency));
            }
            check_bounds_of(certificate, member.of_box)?;
            let pieces = at(certificate, member)?.claimed(limited, *ratio).ok_or(Rejection::NoSuchLoop)?;
            let at = *frequency_rad_per_s;
            let mut within = pieces.iter().filter(|piece| piece.holds(at));
            if within.any(|piece| reaches(&piece.claimed, at)) { Ok(()) } else { Err(Rejection::Point) }
        }
    }
}

fn check_stable_box(
    certificate: &Certificate,
    member: &CertificateMember,
    one: &StableBox,
) -> Result<(), Rejection> {
    let whole = stability_band(certificate);
    let at = at(certificate, member)?;
    let around = sound(Loop::over_box(certificate, member.of_box))?;
    check_bounds(certificate, member.of_box, &around)?;
    match (&certificate.sampling, &one.count) {
        (None, None) => {
            if [&at.without_dead_time(), at.prefilter_denominator()].map(roots_of)
                != [RootLocation::AllLeft; 2]
            {
                return Err(Rejection::Poles);
            }
            if certificate.plant.is_late() {
                check_panels(&at.stability_while_delayed(), 1, whole, &one.delays)?;
            }
        }
        (Some(_), Some(count)) => {
            let outside = counted(certificate, &at, count)?;
            if outside != 0 || !prefilter_is_stable(certificate, &at) {
                return Err(Rejection::Poles);
            }
        }
        _ => return Err(Rejection::Poles),
    }
    check_panels(&around.stability(), certificate.plant.variables, whole, &one.panels)
}

/// Band from zero to infinity, or to pi/T.
fn stability_band(certificate: &Certificate) -> [f64; 2] {
    [0.0, if certificate.sampling.is_some() { f64::MAX } else { f64::INFINITY }]
}

/// Number of poles of a sampled loop outside the unit circle with one plant.
fn counted(certificate: &Certificate, at: &Loop<Interval>, count: &PoleCount) -> Result<usize, Rejection> {
    let pi_over_t = pi_over_t(certificate).ok_or(Rejection::Poles)?;
    let (denominator, _) = at.denominator_claimed();
    check_panels(&at.stability(), 0, stability_band(certificate), &count.characteristic)?;
    let end = count.denominator.last().map_or(0.0, |panel| panel.to);
    check_panels(&denominator, 0, [0.0, end], &count.denominator)?;
    check_panels(&denominator, 0, [end, f64::INFINITY], &count.beyond)?;
    let controller_poles = poles_of_law(&certificate.feedback);
    poles_outside(at, controller_poles, count, pi_over_t).ok_or(Rejection::Poles)
}

fn check_unstable(
    certificate: &Certificate,
    member: &CertificateMember,
    count: Option<&PoleCount>,
) -> Result<(), Rejection> {
    let at = at(certificate, member)?;
    let is_shown = match count {
        None if certificate.sampling.is_some() => false,
        None => {
            let found = [&at.without_dead_time(), at.prefilter_denominator()].map(roots_of);
            found[1] == RootLocation::SomeNotLeft
                || (found[0] == RootLocation::SomeNotLeft && !certificate.plant.is_late())
        }
        Some(count) => {
            check_bounds_of(certificate, member.of_box)?;
            counted(certificate, &at, count)? > 0
        }
    };
    if is_shown { Ok(()) } else { Err(Rejection::Poles) }
}

fn check_bounds_of(certificate: &Certificate, of_box: usize) -> Result<(), Rejection> {
    if certificate.sampling.is_none() {
        return Ok(());
    }
    check_bounds(certificate, of_box, &sound(Loop::over_box(certificate, of_box))?)
}

/// The loop of one plant, which belongs to the family.
fn at(certificate: &Certificate, member: &CertificateMember) -> Result<Loop<Interval>, Rejection> {
    let within = member.variables.iter().all(|fraction| (0.0..=1.0).contains(fraction));
    if !within || member.variables.len() != certificate.plant.variables {
        return Err(Rejection::Number(CertificateNumber::PlantVariable));
    }
    sound(Loop::at(certificate, member))
}

fn sound(around: Option<Loop<Interval>>) -> Result<Loop<Interval>, Rejection> {
    around.filter(Loop::has_denominators).ok_or(Rejection::NoSuchLoop)
}

/// The parameters are finite and moved by existing variables, so that every box is valid; no dead
/// time is negative.
fn check_numbers(certificate: &Certificate) -> Result<(), Rejection> {
    let plant = &certificate.plant;
    let is_box = |one: &Vec<ParameterSegment>| {
        one.len() == plant.parameters.len()
            && one.iter().all(|one| {
                let moved = one.variable.is_none_or(|variable| variable < plant.variables);
                let by_factors =
                    !one.by_factors || (one.low > 0.0 && one.high > 0.0 && plant.model_degree > 0);
                one.low.is_finite() && one.high.is_finite() && moved && by_factors
            })
    };
    let in_time = plant.delay_s >= 0.0 && (1..=DEAD_TIME_TERMS_MAXIMUM).contains(&plant.dead_time_terms);
    let in_bounds = plant.variables <= VARIABLES_MAXIMUM
        && plant.model_degree <= MODEL_DEGREE_MAXIMUM
        && !plant.boxes.is_empty();
    match plant.boxes.iter().all(is_box) && in_bounds && in_time {
        true => Ok(()),
        false => Err(Rejection::Number(CertificateNumber::ParameterEnd)),
    }
}

fn check_boxes(certificate: &Certificate, shown: usize) -> Result<(), Rejection> {
    if shown == certificate.plant.boxes.len() { Ok(()) } else { Err(Rejection::Boxes) }
}

fn check_ratio(certificate: &Certificate, limited: &LimitedLoop, ratio: f64) -> Result<(), Rejection> {
    let [from, to] = limited.band_rad_per_s;
    if pi_over_t(certificate).is_some_and(|end| from >= end.low()) {
        return Err(Rejection::Beyond(from));
    }
    let has_limit = match &limited.limit {
        LimitOf::Quotient(Quotient { numerator, denominator }) => {
            [numerator, denominator].iter().all(|coefficients| coefficients.iter().any(|one| *one != 0.0))
        }
        LimitOf::Table(points) => {
            let is_point = |(frequency, magnitude): &(f64, f64)| *frequency > 0.0 && *magnitude > 0.0;
            points.iter().all(is_point) && points.windows(2).all(|pair| pair[0].0 < pair[1].0)
        }
    };
    let has_side = limited.side == CertificateSide::Upper || limited.closed_loop == ClosedLoop::Tracking;
    match ratio.is_finite() && ratio > 0.0 && from >= 0.0 && from < to && has_limit && has_side {
        true => Ok(()),
        false => Err(Rejection::Number(CertificateNumber::RatioOrBandEnd)),
    }
}

/// Checks the pieces of a band, one after the other; each panel belongs to one of them.
fn check_pieces(
    pieces: &[BandClaim<Interval>],
    variables: usize,
    panels: &[FrequencyPanel],
) -> Result<(), Rejection> {
    let mut left = panels;
    for (index, BandClaim { band, claimed }) in pieces.iter().enumerate() {
        let is_last = index + 1 == pieces.len();
        let end =
            if is_last { left.len() } else { left.iter().take_while(|panel| panel.to <= band[1]).count() };
        let (own, others) = left.split_at(end);
        check_panels(claimed, variables, *band, own)?;
        left = others;
    }
    if pieces.is_empty() { Err(Rejection::Number(CertificateNumber::BandWithoutLimit)) } else { Ok(()) }
}

pub(super) fn check_panels(
    claimed: &Claimed<Interval>,
    variables: usize,
    [from, to]: [f64; 2],
    panels: &[FrequencyPanel],
) -> Result<(), Rejection> {
    if ends(&claimed.dead_time)[0].low() < 0.0 {
        return Err(Rejection::Number(CertificateNumber::DeadTime));
    }
    let mut reached = from;
    // the circle ends there, and the images are enclosed only slightly beyond it
    let circle = claimed.images.as_ref().map(PlantImages::band_ends);
    for panel in panels {
        let is_panel = panel.from == reached && panel.from >= 0.0 && panel.to > panel.from;
        if !is_panel || (panel.to.is_infinite() && panel.from == 0.0) {
            return Err(Rejection::Gap(reached));
        }
        let is_late = !claimed.dead_time.value.is_zero();
        let fits = match panel.late {
            Late::Not => !is_late,
            Late::Less => is_late,
            Late::More => is_late && panel.to.is_finite(),
            Late::Turns(angle) => is_late && panel.to.is_finite() && angle.is_finite(),
        };
        if !fits {
            return Err(Rejection::Late(panel.from));
        }
        if circle.is_some_and(|[_, greatest]| panel.to > greatest) {
            return Err(Rejection::Beyond(panel.to));
        }
        let range = PanelRange { from: panel.from, to: panel.to, late: panel.late };
        let whole = Patch::over(claimed, variables, range).ok_or(Rejection::TooLarge)?;
        check_tree(whole, panel)?;
        reached = panel.to;
    }
    let is_covered = reached == to || (reached < to && circle.is_some_and(|[least, _]| reached >= least));
    if is_covered { Ok(()) } else { Err(Rejection::Gap(reached)) }
}

/// Walks the tree; the remaining nodes are on a stack.
fn check_tree(whole: Patch<Interval>, panel: &FrequencyPanel) -> Result<(), Rejection> {
    let malformed = Rejection::Tree(panel.from);
    let mut bytes = panel.tree.iter().copied();
    let mut waiting = vec![whole];
    let mut leaf = 0;
    while let Some(patch) = waiting.pop() {
        match bytes.next() {
            Some(LEAF) => {
                leaf += 1;
                let mut number = || Some(f64::from(i16::from_be_bytes([bytes.next()?, bytes.next()?])));
                let direction = number().zip(number()).ok_or(malformed.clone())?;
                if !shows([direction.0, direction.1], patch.points().points()) {
                    return Err(Rejection::Leaf { leaf, from: panel.from });
                }
            }
            Some(axis) if usize::from(axis) < patch.axes() && waiting.len() < DEPTH_MAXIMUM => {
                let [lower, upper] = patch.halves(usize::from(axis));
                waiting.extend([upper, lower]);
            }
            _ => return Err(malformed),
        }
    }
    if bytes.next().is_none() { Ok(()) } else { Err(malformed) }
}

/// True if this direction proves |V| <= |U| and U nonzero on the whole leaf.
fn shows([a, b]: [f64; 2], points: &[PanelPoint<Interval>]) -> bool {
    let of = Interval::from;
    // integers of 16 bits: both are exact
    let (square, length) = (a * a + b * b, a.abs() + b.abs());
    points.iter().all(|[ur, ui, vr, vi, rest]| {
        let least = (ur.times(a) + ui.times(b) - rest.times(length)).low();
        least > 0.0 && of(least).square().low() >= (vr.square() + vi.square()).times(square).high()
    })
}

/// True if |V| >= |U| at a frequency, or in the limit towards infinity, where dead time must have
/// no effect; coefficients are numbers.
fn reaches(claimed: &Claimed<Interval>, frequency_rad_per_s: f64) -> bool {
    if claimed.images.as_ref().is_some_and(|images| frequency_rad_per_s > images.band_ends()[0]) {
        return false;
    }
    at_point(claimed, frequency_rad_per_s).is_some_and(|[u, v]| v.low() > 0.0 && v.low() >= u.high())
}
