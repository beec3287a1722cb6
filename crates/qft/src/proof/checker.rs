//! The checker: whether a certificate proves what it claims. It trusts nobody, and rounds outwards wherever it rounds.
//!
//! ```text
//! leaf with direction (a, b):   a Re U_k + b Im U_k > 0   and   (a Re U_k + b Im U_k)^2 >= (a^2 + b^2) |V_k|^2   for every control point
//! ```
//!
//! Re(conj(d) U) - |d| |V| is concave in (U, V): where it is not negative at the control points, it is not between them.

use phea_dynamics::scalar::Interval;

use super::certificate::{Certificate, Claim, LEAF, Limited, Panel};
use super::claimed::Loop;
use super::hurwitz::{Roots, roots_of};
use super::points::{Pair, Points, Range};
use super::polynomial::InS;

/// Halvings on the way to a leaf at most: no proof needs as many.
const DEPTH_MAXIMUM: usize = 256;

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The plant is not polynomial in its parameters, or has not the path that is limited.
    #[error("the certificate does not describe the loop that it makes a claim about")]
    NoSuchLoop,
    /// A number that is not finite, a band without width, a ratio or frequency that is negative.
    #[error("{0} is not a number that it can be")]
    Number(&'static str),
    /// Panels with a gap, or short of an end.
    #[error("the panels do not cover the band: there is a gap at {0} rad/s")]
    Gap(f64),
    /// A tree that ends too early or too late, or halves an axis that does not exist.
    #[error("the tree of the panel from {0} rad/s is not well formed")]
    Tree(f64),
    /// A leaf that does not show the claim.
    #[error("leaf {leaf} of the panel from {from} rad/s does not show the claim")]
    Leaf {
        /// Counted from 1.
        leaf: usize,
        /// rad/s
        from: f64,
    },
    /// A plant that does not have the poles that it is said to have.
    #[error("the poles of the plant that is named cannot be shown to be where they are said to be")]
    Poles,
    /// A point at which the ratio is not reached.
    #[error("the ratio is not reached at the point that is named")]
    Point,
}

/// Checks every claim.
///
/// # Errors
/// [`Rejection`] with the number of the claim, from 1, that is not shown.
pub fn check(certificate: &Certificate) -> Result<(), (usize, Rejection)> {
    let claims = certificate.claims.iter().enumerate();
    claims
        .map(|(index, claim)| check_claim(certificate, claim).map_err(|rejection| (index + 1, rejection)))
        .collect()
}

/// Checks one claim.
///
/// # Errors
/// [`Rejection`].
pub(crate) fn check_claim(certificate: &Certificate, claim: &Claim) -> Result<(), Rejection> {
    check_numbers(certificate)?;
    match claim {
        Claim::Stable { member, panels } => {
            check_member(certificate, member)?;
            let at = Loop::at(certificate, member).ok_or(Rejection::NoSuchLoop)?;
            let [of_loop, of_prefilter] = [&at.characteristic(), at.prefilter_denominator()].map(roots_of);
            if of_loop != Roots::AllLeft || of_prefilter != Roots::AllLeft {
                return Err(Rejection::Poles);
            }
            let u = Loop::over_box(certificate).ok_or(Rejection::NoSuchLoop)?.characteristic();
            check_panels(&u, &InS(vec![]), certificate.plant.variables, [0.0, f64::INFINITY], panels)
        }
        Claim::Unstable { member } => {
            check_member(certificate, member)?;
            let at = Loop::at(certificate, member).ok_or(Rejection::NoSuchLoop)?;
            let found = [&at.characteristic(), at.prefilter_denominator()].map(roots_of);
            if found.contains(&Roots::SomeNotLeft) { Ok(()) } else { Err(Rejection::Poles) }
        }
        Claim::Limited { limited, ratio, panels } => {
            check_ratio(limited, *ratio)?;
            let around = Loop::over_box(certificate).ok_or(Rejection::NoSuchLoop)?;
            let [u, v] = around.claimed(limited, *ratio).ok_or(Rejection::NoSuchLoop)?;
            check_panels(&u, &v, certificate.plant.variables, limited.band_rad_per_s, panels)
        }
        Claim::Reached { limited, ratio, frequency_rad_per_s, member } => {
            check_ratio(limited, *ratio)?;
            check_member(certificate, member)?;
            let [from, to] = limited.band_rad_per_s;
            if !(from <= *frequency_rad_per_s && *frequency_rad_per_s <= to) {
                return Err(Rejection::Number("a frequency"));
            }
            let at = Loop::at(certificate, member).ok_or(Rejection::NoSuchLoop)?;
            let [u, v] = at.claimed(limited, *ratio).ok_or(Rejection::NoSuchLoop)?;
            if reaches(&u, &v, *frequency_rad_per_s) { Ok(()) } else { Err(Rejection::Point) }
        }
    }
}

/// The parameters are finite and moved by variables that exist, so that the box is a box.
fn check_numbers(certificate: &Certificate) -> Result<(), Rejection> {
    let plant = &certificate.plant;
    let sound = plant.parameters.iter().all(|one| {
        let moved = one.variable.is_none_or(|variable| variable < plant.variables);
        one.low.is_finite() && one.high.is_finite() && moved
    });
    if sound { Ok(()) } else { Err(Rejection::Number("an end of a parameter")) }
}

fn check_member(certificate: &Certificate, member: &[f64]) -> Result<(), Rejection> {
    let within = member.iter().all(|share| (0.0..=1.0).contains(share));
    match within && member.len() == certificate.plant.variables {
        true => Ok(()),
        false => Err(Rejection::Number("a variable of a plant")),
    }
}

fn check_ratio(limited: &Limited, ratio: f64) -> Result<(), Rejection> {
    let [from, to] = limited.band_rad_per_s;
    match ratio.is_finite() && ratio > 0.0 && from >= 0.0 && from < to {
        true => Ok(()),
        false => Err(Rejection::Number("a ratio or the end of a band")),
    }
}

fn check_panels(
    u: &InS<Interval>,
    v: &InS<Interval>,
    variables: usize,
    [from, to]: [f64; 2],
    panels: &[Panel],
) -> Result<(), Rejection> {
    let mut reached = from;
    let powers = Points::powers(u, v, variables);
    for panel in panels {
        if panel.from != reached || panel.to.is_nan() || panel.to <= panel.from {
            return Err(Rejection::Gap(reached));
        }
        check_tree(powers.clone().over(Range { from: panel.from, to: panel.to }), panel)?;
        reached = panel.to;
    }
    if reached == to { Ok(()) } else { Err(Rejection::Gap(reached)) }
}

/// Walks the tree; what is still to be walked waits in a list, the next one last.
fn check_tree(whole: Points<Interval>, panel: &Panel) -> Result<(), Rejection> {
    let malformed = Rejection::Tree(panel.from);
    let mut bytes = panel.tree.iter().copied();
    let mut waiting = vec![whole];
    let mut leaf = 0;
    while let Some(points) = waiting.pop() {
        match bytes.next() {
            Some(LEAF) => {
                leaf += 1;
                let mut number = || Some(f64::from(i16::from_be_bytes([bytes.next()?, bytes.next()?])));
                let direction = number().zip(number()).ok_or(malformed.clone())?;
                if !shows([direction.0, direction.1], points.pairs()) {
                    return Err(Rejection::Leaf { leaf, from: panel.from });
                }
            }
            Some(axis) if usize::from(axis) < points.axes() && waiting.len() < DEPTH_MAXIMUM => {
                let [lower, upper] = points.halves(usize::from(axis));
                waiting.extend([upper, lower]);
            }
            _ => return Err(malformed),
        }
    }
    if bytes.next().is_none() { Ok(()) } else { Err(malformed) }
}

/// Whether |V| <= |U| and U is not zero on the whole leaf, shown by this direction.
fn shows([a, b]: [f64; 2], pairs: &[Pair<Interval>]) -> bool {
    let of = Interval::from;
    let square = of(a).square() + of(b).square();
    pairs.iter().all(|[ur, ui, vr, vi]| {
        let along = of(a) * *ur + of(b) * *ui;
        let least = along.low();
        least > 0.0 && of(least).square().low() >= (square * (vr.square() + vi.square())).high()
    })
}

/// Whether |V| >= |U| at a frequency, or in the limit towards infinity; U and V have numbers as coefficients.
fn reaches(u: &InS<Interval>, v: &InS<Interval>, frequency_rad_per_s: f64) -> bool {
    let powers = Points::powers(u, v, 0);
    // the first control point over a panel is the value where it begins
    let range = match frequency_rad_per_s.is_finite() {
        true => Range { from: frequency_rad_per_s, to: frequency_rad_per_s },
        false => Range { from: 1.0, to: f64::INFINITY },
    };
    let points = powers.over(range);
    let (Some([ur, ui, vr, vi]), true) = (points.pairs().first(), points.axes() == 1) else { return false };
    (vr.square() + vi.square()).low() >= (ur.square() + ui.square()).high()
}
