//! Location of the roots of a polynomial relative to the imaginary axis, by Routh's array in
//! intervals.

use phea_dynamics::scalar::Interval;

use super::part::number;
use super::polynomial::InS;

/// Location of the roots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RootLocation {
    /// All roots have negative real parts.
    AllLeft,
    /// The polynomial has a root with a non-negative real part.
    SomeNotLeft,
    /// The location is hidden by rounding.
    Unknown,
}

/// Location of the roots of a polynomial with numbers as coefficients.
///
/// Each entry of the first column is a quotient of two Hurwitz determinants: all have one sign if
/// and only if all roots have negative real parts.
pub(crate) fn roots_of(polynomial: &InS<Interval>) -> RootLocation {
    let Some(degree) = polynomial.degree() else { return RootLocation::Unknown };
    let number = |power: usize| number(&polynomial.0[power]);
    let leading = number(degree);
    let Some(sign) = sign_of(leading) else { return RootLocation::Unknown };
    let highest_first = (0..=degree).rev().map(|power| number(power) * Interval::from(sign));
    let coefficients: Vec<Interval> = highest_first.collect();
    // all coefficients of a stable polynomial have one sign, and none is zero
    if coefficients.iter().any(|coefficient| coefficient.high() <= 0.0) {
        return RootLocation::SomeNotLeft;
    }
    let take = |first: usize| coefficients.iter().skip(first).step_by(2).copied().collect::<Vec<_>>();
    let (mut above, mut row) = (take(0), take(1));
    for _ in 0..degree {
        let (Some(&upper), Some(&pivot)) = (above.first(), row.first()) else { return RootLocation::Unknown };
        if pivot.high() <= 0.0 {
            return RootLocation::SomeNotLeft;
        }
        if pivot.low() <= 0.0 {
            return RootLocation::Unknown;
        }
        let factor = upper / pivot;
        let zero = Interval::from(0.0);
        let under = |place: usize| row.get(place).copied().unwrap_or(zero);
        let next =
            above.iter().enumerate().skip(1).map(|(place, &value)| value - factor * under(place)).collect();
        above = std::mem::replace(&mut row, next);
    }
    RootLocation::AllLeft
}

/// Sign 1 or -1; `None` if the value may be zero.
fn sign_of(value: Interval) -> Option<f64> {
    match (value.low() > 0.0, value.high() < 0.0) {
        (true, _) => Some(1.0),
        (_, true) => Some(-1.0),
        _ => None,
    }
}
