//! Division of boxes with nonpolynomial coefficients, so that polynomials replace them with small
//! remainders.

use super::NotProven;
use super::certificate::{Certificate, ParameterSegment};
use super::claimed::Loop;
use super::model::{parameters_over, turn};
use phea_dynamics::order::sort_by_number;

/// Degrees of the polynomials that replace such coefficients: the first with a small remainder is
/// used, otherwise the last.
const DEGREES: [usize; 3] = [3, 5, 8];
/// Last degree for each number of variables, and for more: the number of terms grows with the
/// number of variables.
const LAST_DEGREES: [usize; 5] = [8, 8, 8, 6, 5];
const MANY_VARIABLES_DEGREE: usize = 4;
/// Remainder of a coefficient, relative to it, that needs no smaller box.
const SMALL: f64 = 1e-6;
/// Factor of the remainder below which halving a box is worthwhile.
const WORTH: f64 = 0.5;
/// Number of halvings of a box across one variable in the search for a part with polynomials.
const HALVINGS_MAXIMUM: usize = 6;
/// Largest number of boxes.
const BOXES_MAXIMUM: usize = 64;

/// Replaces nonpolynomial coefficients by polynomials with a remainder, and halves boxes until the
/// remainder is small.
pub(super) fn with_model(certificate: &mut Certificate) -> Result<(), NotProven> {
    let of_all = |certificate: &Certificate| -> Option<Vec<f64>> {
        (0..certificate.plant.boxes.len()).map(|of_box| fraction(certificate, of_box)).collect()
    };
    if certificate.plant.is_straight() && of_all(certificate).is_some() {
        return Ok(());
    }
    let variables = certificate.plant.variables;
    let last = LAST_DEGREES.get(variables).copied().unwrap_or(MANY_VARIABLES_DEGREE);
    let mut fractions = vec![];
    for degree in DEGREES.into_iter().filter(|degree| *degree < last).chain([last]) {
        certificate.plant.model_degree = degree;
        let boxes = 0..certificate.plant.boxes.len();
        fractions = boxes.map(|of_box| fraction(certificate, of_box).unwrap_or(f64::INFINITY)).collect();
        if fractions.iter().all(|fraction| *fraction <= SMALL) {
            return Ok(());
        }
    }
    divide(certificate, fractions);
    if of_all(certificate).is_some() { Ok(()) } else { Err(NotProven::NotPolynomial) }
}

/// Divides the box with the greatest remainder, relative to its coefficients, repeatedly as long as
/// it is worthwhile.
fn divide(certificate: &mut Certificate, fractions: Vec<f64>) {
    let mut left: Vec<(f64, bool)> =
        fractions.into_iter().map(|fraction| (fraction, fraction > SMALL)).collect();
    while left.len() < BOXES_MAXIMUM {
        let worst = left.iter().enumerate().filter(|(_, (_, is_open))| *is_open);
        let Some((of_box, &(own, _))) = worst.max_by(|(_, (one, _)), (_, (other, _))| one.total_cmp(other))
        else {
            break;
        };
        let worth = |(_, of_parts): &(Halves, [f64; 2])| {
            // any finite remainder is better than none
            own.is_infinite() || of_parts.iter().all(|part| *part <= WORTH * own)
        };
        // on either side of a switching point the coefficients are smooth
        let divided = cut(certificate, of_box).or_else(|| halved(certificate, of_box).filter(worth));
        let Some((parts, of_parts)) = divided else {
            left[of_box].1 = false;
            continue;
        };
        certificate.plant.boxes.splice(of_box..=of_box, parts);
        left.splice(of_box..=of_box, of_parts.map(|fraction| (fraction, fraction > SMALL)));
        if let Some(sampling) = &mut certificate.sampling {
            let bounds = sampling.bounds[of_box].clone();
            sampling.bounds.insert(of_box, bounds);
        }
    }
}

/// The greatest remainder of a coefficient of the plant over a box, relative to its size; `None` if
/// the box has no such polynomials.
fn fraction(certificate: &Certificate, of_box: usize) -> Option<f64> {
    Some(Loop::<f64>::over_box(certificate, of_box)?.remainder_fraction())
}

/// Both halves of a box.
type Halves = [Vec<ParameterSegment>; 2];

/// Both parts of a box at the switching point of a choice between them, with their remainders.
fn cut(certificate: &Certificate, of_box: usize) -> Option<(Halves, [f64; 2])> {
    let parameters = parameters_over(certificate, of_box)?;
    let (variable, fraction) =
        turn(&certificate.plant.coefficients, &parameters, certificate.plant.model_degree)?;
    let parts = parts(certificate.plant.boxes.get(of_box)?, variable, fraction)?;
    let mut alone = certificate.clone();
    let fractions = parts.each_ref().map(|part| {
        alone.plant.boxes = vec![part.clone()];
        self::fraction(&alone, 0).unwrap_or(f64::INFINITY)
    });
    Some((parts, fractions))
}

/// Both halves of a box across the variable that makes the remainders smallest, with these
/// remainders; if no halves have polynomials, across the variable that needs the fewest halvings
/// until a part has them.
fn halved(certificate: &Certificate, of_box: usize) -> Option<(Halves, [f64; 2])> {
    let own = certificate.plant.boxes.get(of_box)?;
    let mut alone = certificate.clone();
    let mut fraction_of = |part: &Vec<ParameterSegment>| {
        alone.plant.boxes = vec![part.clone()];
        fraction(&alone, 0).unwrap_or(f64::INFINITY)
    };
    let candidates = (0..certificate.plant.variables).filter_map(|variable| {
        let halves = halves(own, variable)?;
        let fractions = halves.each_ref().map(&mut fraction_of);
        Some((variable, halves, fractions))
    });
    let mut candidates: Vec<(usize, Halves, [f64; 2])> = candidates.collect();
    if candidates.iter().all(|(_, _, fractions)| greatest(fractions).is_infinite()) {
        candidates.sort_by_cached_key(|(variable, halves, _)| halvings(halves, *variable, &mut fraction_of));
    } else {
        sort_by_number(&mut candidates, |(.., fractions)| greatest(fractions));
    }
    candidates.into_iter().next().map(|(_, halves, fractions)| (halves, fractions))
}

fn greatest(fractions: &[f64; 2]) -> f64 {
    fractions[0].max(fractions[1])
}

/// Number of further halvings of the lower of these halves across a variable until its upper part
/// has polynomials; [`HALVINGS_MAXIMUM`] if that is not enough.
fn halvings(
    [lower, _]: &Halves,
    variable: usize,
    fraction_of: &mut impl FnMut(&Vec<ParameterSegment>) -> f64,
) -> usize {
    let mut part = lower.clone();
    for count in 0..HALVINGS_MAXIMUM {
        if fraction_of(&part).is_finite() {
            return count;
        }
        let Some([_, upper]) = halves(&part, variable) else { break };
        part = upper;
    }
    HALVINGS_MAXIMUM
}

/// Both halves of a box across a variable; `None` if that changes nothing.
fn halves(whole: &[ParameterSegment], variable: usize) -> Option<Halves> {
    parts(whole, variable, 0.5)
}

/// Both parts of a box that meet at this value of a variable in t; `None` if that changes nothing.
fn parts(whole: &[ParameterSegment], variable: usize, fraction: f64) -> Option<Halves> {
    let moved = |one: &ParameterSegment| one.variable == Some(variable);
    let half = |lower: bool| {
        let each = whole.iter().map(|one| match (moved(one), lower) {
            (false, _) => *one,
            (true, true) => ParameterSegment { high: one.value(fraction), ..*one },
            (true, false) => ParameterSegment { low: one.value(fraction), ..*one },
        });
        each.collect()
    };
    whole.iter().any(moved).then(|| [half(true), half(false)])
}
