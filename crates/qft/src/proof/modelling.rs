//! How far a box is divided where coefficients are not polynomials, so that polynomials replace
//! them with small remainders.

use super::NotProven;
use super::certificate::{Certificate, ParameterSegment};
use super::claimed::Loop;

/// Degrees of the polynomials that replace such coefficients: the first with a small remainder is
/// used, otherwise the last.
const DEGREES: [usize; 3] = [3, 5, 8];
/// The number of terms grows with the number of variables: the last degree for this number of
/// variables, and for more.
const LAST_DEGREES: [usize; 5] = [8, 8, 8, 6, 5];
const MANY_VARIABLES_DEGREE: usize = 4;
/// A remainder of a coefficient this small, relative to it, needs no smaller box.
const SMALL: f64 = 1e-6;
/// A box is halved if this reduces its remainder below this share.
const WORTH: f64 = 0.5;
/// Boxes at most.
const BOXES_MAXIMUM: usize = 64;

/// Coefficients that are not polynomials are replaced by polynomials with a remainder, and boxes
/// are halved until the remainder is small.
pub(super) fn with_model(certificate: &mut Certificate) -> Result<(), NotProven> {
    let of_all = |certificate: &Certificate| -> Option<Vec<f64>> {
        (0..certificate.plant.boxes.len()).map(|of_box| share(certificate, of_box)).collect()
    };
    if certificate.plant.is_straight() && of_all(certificate).is_some() {
        return Ok(());
    }
    let variables = certificate.plant.variables;
    let last = LAST_DEGREES.get(variables).copied().unwrap_or(MANY_VARIABLES_DEGREE);
    let mut shares = vec![];
    for degree in DEGREES.into_iter().filter(|degree| *degree < last).chain([last]) {
        certificate.plant.model_degree = degree;
        let boxes = 0..certificate.plant.boxes.len();
        shares = boxes.map(|of_box| share(certificate, of_box).unwrap_or(f64::INFINITY)).collect();
        if shares.iter().all(|share| *share <= SMALL) {
            return Ok(());
        }
    }
    let mut place = 0;
    while place < shares.len() && shares.len() < BOXES_MAXIMUM {
        let (of_box, own) = (place, shares[place]);
        let worth = |(_, of_halves): &(Halves, [f64; 2])| {
            // any is better than none
            own.is_infinite() || of_halves.iter().all(|half| *half <= WORTH * own)
        };
        let halves = if own > SMALL { halved(certificate, of_box).filter(worth) } else { None };
        let Some((halves, of_halves)) = halves else {
            place += 1;
            continue;
        };
        certificate.plant.boxes.splice(of_box..=of_box, halves);
        shares.splice(of_box..=of_box, of_halves);
        if let Some(sampling) = &mut certificate.sampling {
            let bounds = sampling.bounds[of_box].clone();
            sampling.bounds.insert(of_box, bounds);
        }
    }
    if of_all(certificate).is_some() { Ok(()) } else { Err(NotProven::NotPolynomial) }
}

/// The greatest remainder of a coefficient of the plant over a box, relative to its size; `None`
/// where the box has no such polynomials.
fn share(certificate: &Certificate, of_box: usize) -> Option<f64> {
    Some(Loop::<f64>::over_box(certificate, of_box)?.remainder_share())
}

/// Both halves of a box.
type Halves = [Vec<ParameterSegment>; 2];

/// Both halves of a box across the variable that makes the remainders smallest, with these
/// remainders.
fn halved(certificate: &Certificate, of_box: usize) -> Option<(Halves, [f64; 2])> {
    let own = certificate.plant.boxes.get(of_box)?;
    let mut alone = certificate.clone();
    let candidates = (0..certificate.plant.variables).filter_map(|variable| {
        let halves = halves(own, variable)?;
        let shares = halves.each_ref().map(|half| {
            alone.plant.boxes = vec![half.clone()];
            share(&alone, 0).unwrap_or(f64::INFINITY)
        });
        Some((halves, shares))
    });
    let greatest = |shares: &[f64; 2]| shares[0].max(shares[1]);
    candidates.min_by(|(_, one), (_, other)| greatest(one).total_cmp(&greatest(other)))
}

/// Both halves of a box across a variable; `None` where it changes nothing.
fn halves(whole: &[ParameterSegment], variable: usize) -> Option<Halves> {
    let moved = |one: &ParameterSegment| one.variable == Some(variable);
    let half = |lower: bool| {
        let each = whole.iter().map(|one| match (moved(one), lower) {
            (false, _) => *one,
            (true, true) => ParameterSegment { high: one.value(0.5), ..*one },
            (true, false) => ParameterSegment { low: one.value(0.5), ..*one },
        });
        each.collect()
    };
    whole.iter().any(moved).then(|| [half(true), half(false)])
}
