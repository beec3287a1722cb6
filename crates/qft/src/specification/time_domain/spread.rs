use num_complex::Complex64;
use phea_dynamics::linear::{Polynomial, TimeDomain};
use phea_dynamics::order::{sort_numbers, sorted_distinct};
use phea_dynamics::portable::{ln, log10};
use phea_dynamics::range::RequiredRange;

use super::super::Limit;
use super::{TimeDomainError, TimeDomainNumber};

/// Distance between the tracking limits over frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingSpread {
    /// Order of the two limits.
    pub order: LimitOrder,
    /// Frequency from which on upper/lower never falls again, rad/s; `None` if it falls at the end
    /// of the band.
    ///
    /// A loop that vanishes at high frequency leaves the spread of the plants unchanged: there the
    /// limits must differ by at least as much as the plants do.
    pub grows_from_rad_per_s: Option<f64>,
    /// Ratio upper/lower at the end of the band, dB; may be infinite at infinite frequency.
    pub at_end_db: f64,
}

/// Order of the two limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitOrder {
    /// The upper limit is above the lower one everywhere in the band, up to a billionth of a
    /// decibel.
    Satisfied {
        /// Least ratio upper/lower, dB.
        least_db: f64,
        /// Frequency of the least ratio, rad/s.
        frequency_rad_per_s: f64,
    },
    /// The limits cross: no loop satisfies both there.
    Crossed {
        /// The lowest frequency at which lower and upper limit meet, rad/s.
        from_rad_per_s: f64,
        /// Largest excess of the lower limit over the upper one, dB.
        excess_db: f64,
        /// Frequency of the largest excess, rad/s.
        frequency_rad_per_s: f64,
    },
}

/// Compares two tracking limits over a band `[from, to]`, rad/s (`to` may be infinite), where both
/// apply: a table sets no limit beyond its ends.
///
/// ```text
/// spread(w) = 20 log10(B_U(w)/B_L(w))
/// ```
///
/// The squared ratio is a rational function of x = w^2, times a power of x between the points of
/// tables; between the roots of its derivative it rises or falls throughout, so those roots and the
/// ends of the pieces determine the result.
///
/// # Errors
/// [`TimeDomainError::OutOfRange`] for the band, [`TimeDomainError::NeverTogether`],
/// [`TimeDomainError::NotContinuous`], and roots that cannot be found.
///
/// # Example
/// Two lags diverge by 20 dB, from the corner of the slow one to that of the fast one:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_qft::specification::{Limit, LimitOrder, tracking_spread};
/// let lag = |pole: f64| {
///     TransferFunction::from_factors(pole, vec![], vec![Complex64::new(-pole, 0.0)]).map(Limit::Rational)
/// };
/// let spread = tracking_spread(&lag(1.0)?, &lag(10.0)?, [0.0, f64::INFINITY])?;
/// assert_eq!(spread.order, LimitOrder::Satisfied { least_db: 0.0, frequency_rad_per_s: 0.0 });
/// assert_eq!((spread.grows_from_rad_per_s, spread.at_end_db), (Some(0.0), 20.0));
/// let swapped = tracking_spread(&lag(10.0)?, &lag(1.0)?, [0.0, f64::INFINITY])?;
/// assert!(matches!(swapped.order, LimitOrder::Crossed { from_rad_per_s: 0.0, excess_db: 20.0, .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tracking_spread(
    lower: &Limit,
    upper: &Limit,
    band_rad_per_s: [f64; 2],
) -> Result<TrackingSpread, TimeDomainError> {
    let [from, to] = common_band(lower, upper, band_rad_per_s)?;
    let ratio = SquaredRatio::new(lower, upper)?;
    let mut spread = vec![(from, ratio.decibels(from))];
    for piece in pieces(lower, upper, [from, to]).windows(2) {
        let &[start, end] = piece else { continue };
        let turns = ratio.extremes(start, end)?.into_iter().filter(|w| start < *w && *w < end);
        spread.extend(turns.chain([end]).map(|w| (w, ratio.decibels(w))));
    }
    let falls = |pair: &[(f64, f64)]| matches!(pair, [a, b] if b.1 < a.1 - ROUNDING_DB);
    let grows_from = match spread.windows(2).rposition(falls) {
        None => Some(from),
        Some(last) => spread.get(last + 1).map(|knot| knot.0).filter(|w| *w < to),
    };
    let at_end_db = spread.last().map_or(f64::NAN, |knot| knot.1);
    Ok(TrackingSpread { order: order(&ratio, &spread), grows_from_rad_per_s: grows_from, at_end_db })
}

/// The part of the band that all tables cover.
fn common_band(lower: &Limit, upper: &Limit, [from, to]: [f64; 2]) -> Result<[f64; 2], TimeDomainError> {
    if !(from >= 0.0 && from.is_finite() && to >= from) {
        let (what, expected) = (TimeDomainNumber::Band, RequiredRange::IncreasingFromZero);
        return Err(TimeDomainError::OutOfRange { what, value: from, expected });
    }
    let ends = [lower, upper].into_iter().filter_map(|limit| {
        let points = table(limit);
        points.first().zip(points.last()).map(|(first, last)| (first.0, last.0))
    });
    let [from, to] = ends.fold([from, to], |[from, to], (first, last)| [from.max(first), to.min(last)]);
    if from <= to { Ok([from, to]) } else { Err(TimeDomainError::NeverTogether) }
}

/// The points of a table; empty for other limits.
fn table(limit: &Limit) -> &[(f64, f64)] {
    match limit {
        Limit::Table(table) => table.points(),
        Limit::Constant(_) | Limit::Rational(_) => &[],
    }
}

/// The ends of the band, and between them the points of tables.
fn pieces(lower: &Limit, upper: &Limit, [from, to]: [f64; 2]) -> Vec<f64> {
    let points = table(lower).iter().chain(table(upper)).map(|point| point.0);
    sorted_distinct(points.filter(|w| from < *w && *w < to).chain([from, to]).collect())
}

/// Difference that counts as rounding error, dB.
const ROUNDING_DB: f64 = 1e-9;

fn order(ratio: &SquaredRatio<'_>, spread: &[(f64, f64)]) -> LimitOrder {
    let least = spread.iter().copied().fold((0.0, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
    let Some(first) = spread.iter().position(|knot| knot.1 < -ROUNDING_DB) else {
        return LimitOrder::Satisfied { least_db: least.1, frequency_rad_per_s: least.0 };
    };
    let before = spread.get(first.saturating_sub(1)).copied().unwrap_or(least);
    let crossed = spread.get(first).map_or(before.0, |knot| knot.0);
    // limits that are equal at the preceding point diverge from there on
    let from_rad_per_s = if before.1 > ROUNDING_DB { crossing(ratio, before.0, crossed) } else { before.0 };
    LimitOrder::Crossed { from_rad_per_s, excess_db: -least.1, frequency_rad_per_s: least.0 }
}

/// Frequency at which the limits meet, between one where they are apart and one, perhaps infinite,
/// where they have crossed.
fn crossing(ratio: &SquaredRatio<'_>, apart: f64, crossed: f64) -> f64 {
    let (mut apart, mut crossed) = (apart, crossed);
    loop {
        let middle = if crossed.is_finite() { apart + 0.5 * (crossed - apart) } else { 2.0 * apart.max(1.0) };
        if middle <= apart || middle >= crossed {
            return crossed;
        }
        if ratio.decibels(middle) > 0.0 { apart = middle } else { crossed = middle }
    }
}

/// The ratio B_U^2/B_L^2: a quotient of polynomials in x = w^2, times the quotient of tables.
struct SquaredRatio<'a> {
    above: Polynomial,
    below: Polynomial,
    lower: &'a Limit,
    upper: &'a Limit,
}

impl<'a> SquaredRatio<'a> {
    fn new(lower: &'a Limit, upper: &'a Limit) -> Result<SquaredRatio<'a>, TimeDomainError> {
        let ((upper_zeros, upper_poles), (lower_zeros, lower_poles)) = (squared(upper)?, squared(lower)?);
        let (above, below) = (upper_zeros.product(&lower_poles), lower_zeros.product(&upper_poles));
        Ok(SquaredRatio { above, below, lower, upper })
    }

    fn decibels(&self, frequency: f64) -> f64 {
        let (above, below) = (&self.above, &self.below);
        let ratio = if frequency.is_finite() {
            let x = Complex64::new(frequency * frequency, 0.0);
            above.evaluate(x).re / below.evaluate(x).re
        } else {
            match above.degree().cmp(&below.degree()) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => above.leading_coefficient() / below.leading_coefficient(),
                std::cmp::Ordering::Greater => f64::INFINITY,
            }
        };
        10.0 * log10(ratio) + 20.0 * log10(self.tables(frequency))
    }

    /// The quotient of the tables; one without tables.
    fn tables(&self, frequency: f64) -> f64 {
        let value = |limit: &Limit| match limit {
            Limit::Table(_) => limit.magnitude(frequency).unwrap_or(f64::NAN),
            Limit::Constant(_) | Limit::Rational(_) => 1.0,
        };
        value(self.upper) / value(self.lower)
    }

    /// Frequencies at which the ratio may be stationary within a piece, rad/s, increasing.
    ///
    /// For the ratio x^m A/B, the slope over ln x vanishes with x (A' B - A B') + m A B.
    fn extremes(&self, start: f64, end: f64) -> Result<Vec<f64>, TimeDomainError> {
        let (above, below) = (&self.above, &self.below);
        let turn = above.derivative().product(below).sum(&above.product(&below.derivative()).scaled(-1.0));
        let rational_only = table(self.lower).is_empty() && table(self.upper).is_empty();
        let slope = if rational_only {
            turn
        } else {
            let power = ln(self.tables(end) / self.tables(start)) / ln(end / start);
            turn.product(&Polynomial::new(vec![1.0, 0.0])).sum(&above.product(below).scaled(power))
        };
        if slope.is_zero() {
            return Ok(Vec::new());
        }
        // a surplus point does no harm: roots that are real up to rounding are included
        let real = slope.roots()?.into_iter().filter(|root| root.re > 0.0 && root.im.abs() <= 1e-6 * root.re);
        let mut frequencies: Vec<f64> = real.map(|root| root.re.sqrt()).collect();
        sort_numbers(&mut frequencies);
        Ok(frequencies)
    }
}

/// Numerator and denominator of the squared magnitude of a limit as polynomials in x = w^2; one for
/// a table.
fn squared(limit: &Limit) -> Result<(Polynomial, Polynomial), TimeDomainError> {
    let one = || Polynomial::new(vec![1.0]);
    match limit {
        Limit::Table(_) => Ok((one(), one())),
        Limit::Constant(value) => Ok((one().scaled(value * value), one())),
        Limit::Rational(function) if function.domain() == TimeDomain::Continuous => {
            let square = function.gain() * function.gain();
            Ok((of_roots(function.zeros()).scaled(square), of_roots(function.poles())))
        }
        Limit::Rational(_) => Err(TimeDomainError::NotContinuous),
    }
}

/// The product of |jw - root|^2 as a polynomial in x = w^2, pair by pair.
fn of_roots(roots: &[Complex64]) -> Polynomial {
    roots.iter().filter(|root| root.im >= 0.0).fold(Polynomial::new(vec![1.0]), |product, root| {
        let (re, im) = (root.re * root.re, root.im * root.im);
        let factor =
            if root.im == 0.0 { vec![1.0, re] } else { vec![1.0, 2.0 * (re - im), (re + im) * (re + im)] };
        product.product(&Polynomial::new(factor))
    })
}
