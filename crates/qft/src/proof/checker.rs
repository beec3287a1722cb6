//! The checker: whether a certificate proves what it claims. It trusts nobody, and rounds outwards wherever it rounds.
//!
//! ```text
//! leaf with direction (a, b):   x_k = a Re U_k + b Im U_k - (|a| + |b|) e_k > 0,   x_k^2 >= (a^2 + b^2) |V_k|^2      for every control point
//! ```
//!
//! Re(conj(d) U) - |d| (|V| + e) is concave in (U, V, e): where it is not negative at the control points, it is not between them.

use phea_dynamics::scalar::{Interval, Scalar};

use super::certificate::{Certificate, Claim, LEAF, Late, Limited, Member, Panel, Segment, StableBox};
use super::claimed::{Claimed, Loop};
use super::dead_time::ends;
use super::hurwitz::{Roots, roots_of};
use super::points::{Point, Points, Range};
use super::polynomial::VARIABLES_MAXIMUM;

/// Halvings on the way to a leaf at most: no proof needs as many.
const DEPTH_MAXIMUM: usize = 256;

/// Terms of the series of dead time at most.
const DEAD_TIME_TERMS_MAXIMUM: usize = 24;

/// Why a certificate is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The plant is not polynomial in its parameters, or has not the path that is limited.
    #[error("the certificate does not describe the loop that it makes a claim about")]
    NoSuchLoop,
    /// A number that is not finite, a band without width, a ratio or frequency that is negative.
    #[error("{0} is not a number that it can be")]
    Number(&'static str),
    /// A certificate of nothing.
    #[error("the certificate makes no claim")]
    NoClaim,
    /// Another number of boxes than the family has.
    #[error("it does not speak of every box of the family")]
    Boxes,
    /// More control points than a claim has.
    #[error("a claim has too many control points")]
    TooLarge,
    /// Panels with a gap, or short of an end.
    #[error("the panels do not cover the band: there is a gap at {0} rad/s")]
    Gap(f64),
    /// Dead time taken where there is none, or not as it can be on such a panel.
    #[error("dead time is not taken as it is on the panel from {0} rad/s")]
    Late(f64),
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

/// Checks every claim, of which there must be one.
///
/// # Errors
/// [`Rejection`] with the number of the claim, from 1, that is not shown.
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
/// [`Rejection`].
pub(crate) fn check_claim(certificate: &Certificate, claim: &Claim) -> Result<(), Rejection> {
    check_numbers(certificate)?;
    let variables = certificate.plant.variables;
    match claim {
        Claim::Stable(boxes) => {
            check_boxes(certificate, boxes.len())?;
            for (of_box, one) in boxes.iter().enumerate() {
                let member = Member { of_box, variables: one.member.clone() };
                check_stable_box(certificate, &member, one)?;
            }
            Ok(())
        }
        Claim::Unstable(member) => {
            let at = at(certificate, member)?;
            let found = [&at.without_dead_time(), at.prefilter_denominator()].map(roots_of);
            let is_shown = found[1] == Roots::SomeNotLeft
                || (found[0] == Roots::SomeNotLeft && !certificate.plant.is_late());
            if is_shown { Ok(()) } else { Err(Rejection::Poles) }
        }
        Claim::Limited { limited, ratio, boxes } => {
            check_ratio(limited, *ratio)?;
            check_boxes(certificate, boxes.len())?;
            for (of_box, panels) in boxes.iter().enumerate() {
                let around = sound(Loop::over_box(certificate, of_box))?;
                let claimed = around.claimed(limited, *ratio).ok_or(Rejection::NoSuchLoop)?;
                check_panels(&claimed, variables, limited.band_rad_per_s, panels)?;
            }
            Ok(())
        }
        Claim::Reached { limited, ratio, frequency_rad_per_s, member } => {
            check_ratio(limited, *ratio)?;
            let [from, to] = limited.band_rad_per_s;
            if !(from <= *frequency_rad_per_s && *frequency_rad_per_s <= to) {
                return Err(Rejection::Number("a frequency"));
            }
            let claimed = at(certificate, member)?.claimed(limited, *ratio).ok_or(Rejection::NoSuchLoop)?;
            if reaches(&claimed, *frequency_rad_per_s) { Ok(()) } else { Err(Rejection::Point) }
        }
    }
}

fn check_stable_box(certificate: &Certificate, member: &Member, one: &StableBox) -> Result<(), Rejection> {
    const WHOLE: [f64; 2] = [0.0, f64::INFINITY];
    let at = at(certificate, member)?;
    if [&at.without_dead_time(), at.prefilter_denominator()].map(roots_of) != [Roots::AllLeft; 2] {
        return Err(Rejection::Poles);
    }
    if certificate.plant.is_late() {
        check_panels(&at.stability_while_delayed(), 1, WHOLE, &one.delays)?;
    }
    let around = sound(Loop::over_box(certificate, member.of_box))?;
    check_panels(&around.stability(), certificate.plant.variables, WHOLE, &one.panels)
}

/// The loop of one plant, which belongs to the family.
fn at(certificate: &Certificate, member: &Member) -> Result<Loop<Interval>, Rejection> {
    let within = member.variables.iter().all(|share| (0.0..=1.0).contains(share));
    if !within || member.variables.len() != certificate.plant.variables {
        return Err(Rejection::Number("a variable of a plant"));
    }
    sound(Loop::at(certificate, member))
}

fn sound(around: Option<Loop<Interval>>) -> Result<Loop<Interval>, Rejection> {
    around.filter(Loop::has_denominators).ok_or(Rejection::NoSuchLoop)
}

/// The parameters are finite and moved by variables that exist, so that every box is a box; nothing is late by less than nothing.
fn check_numbers(certificate: &Certificate) -> Result<(), Rejection> {
    let plant = &certificate.plant;
    let is_box = |one: &Vec<Segment>| {
        one.len() == plant.parameters.len()
            && one.iter().all(|one| {
                let moved = one.variable.is_none_or(|variable| variable < plant.variables);
                one.low.is_finite() && one.high.is_finite() && moved
            })
    };
    let in_time = plant.delay_s >= 0.0 && (1..=DEAD_TIME_TERMS_MAXIMUM).contains(&plant.dead_time_terms);
    let in_bounds = plant.variables <= VARIABLES_MAXIMUM && !plant.boxes.is_empty();
    match plant.boxes.iter().all(is_box) && in_bounds && in_time {
        true => Ok(()),
        false => Err(Rejection::Number("an end of a parameter")),
    }
}

fn check_boxes(certificate: &Certificate, shown: usize) -> Result<(), Rejection> {
    if shown == certificate.plant.boxes.len() { Ok(()) } else { Err(Rejection::Boxes) }
}

fn check_ratio(limited: &Limited, ratio: f64) -> Result<(), Rejection> {
    let [from, to] = limited.band_rad_per_s;
    let has_limit = [&limited.limit.numerator, &limited.limit.denominator]
        .iter()
        .all(|coefficients| coefficients.iter().any(|coefficient| *coefficient != 0.0));
    match ratio.is_finite() && ratio > 0.0 && from >= 0.0 && from < to && has_limit {
        true => Ok(()),
        false => Err(Rejection::Number("a ratio or the end of a band")),
    }
}

fn check_panels(
    claimed: &Claimed<Interval>,
    variables: usize,
    [from, to]: [f64; 2],
    panels: &[Panel],
) -> Result<(), Rejection> {
    if ends(&claimed.dead_time)[0].low() < 0.0 {
        return Err(Rejection::Number("a dead time"));
    }
    let mut reached = from;
    for panel in panels {
        let is_panel = panel.from == reached && panel.to > panel.from;
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
        let range = Range { from: panel.from, to: panel.to, late: panel.late };
        let whole = Points::over(claimed, variables, range).ok_or(Rejection::TooLarge)?;
        check_tree(whole, panel)?;
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
                if !shows([direction.0, direction.1], points.points()) {
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
fn shows([a, b]: [f64; 2], points: &[Point<Interval>]) -> bool {
    let of = Interval::from;
    // integers of 16 bits: both are exact
    let (square, length) = (a * a + b * b, a.abs() + b.abs());
    points.iter().all(|[ur, ui, vr, vi, rest]| {
        let least = (ur.times(a) + ui.times(b) - rest.times(length)).low();
        least > 0.0 && of(least).square().low() >= (vr.square() + vi.square()).times(square).high()
    })
}

/// Whether |V| >= |U| at a frequency, or in the limit towards infinity, where dead time must not matter; coefficients are numbers.
fn reaches(claimed: &Claimed<Interval>, frequency_rad_per_s: f64) -> bool {
    // the first control point over a panel is the value where it begins
    let range = match frequency_rad_per_s.is_finite() {
        true => {
            let dead_time = ends(&claimed.dead_time)[0];
            let angle = 0.5 * frequency_rad_per_s * (dead_time.low() + dead_time.high());
            let late = if claimed.dead_time.value.is_zero() { Late::Not } else { Late::Turns(angle) };
            Range { from: frequency_rad_per_s, to: frequency_rad_per_s, late }
        }
        false if claimed.dead_time.value.is_zero() => Range { from: 1.0, to: f64::INFINITY, late: Late::Not },
        false => Range { from: 1.0, to: f64::INFINITY, late: Late::Less },
    };
    let Some(points) = Points::over(claimed, 0, range) else { return false };
    let Some([ur, ui, vr, vi, rest]) = points.points().first() else { return false };
    // a remainder makes |U| greater and |V| less by at most so much
    let [u, v] = [(ur.square() + ui.square()).sqrt() + *rest, (vr.square() + vi.square()).sqrt() - *rest];
    v.low() > 0.0 && v.low() >= u.high()
}
