use phea_dynamics::linear::{Polynomial, TransferFunction};
use phea_dynamics::portable::log10;

use super::TimeDomainError;

/// How far apart the limits of tracking are over frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackingSpread {
    /// Whether the upper limit is above the lower one.
    pub order: LimitOrder,
    /// Frequency from which on upper/lower never falls again, rad/s; none when it falls at the end of the band.
    ///
    /// A loop that vanishes at high frequency leaves the spread of the plants as it is: there the limits must be at least as
    /// far apart as the plants are.
    pub grows_from_rad_per_s: Option<f64>,
    /// upper/lower at the end of the band, dB; may be infinite at infinite frequency.
    pub at_end_db: f64,
}

/// Whether the upper limit is above the lower one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LimitOrder {
    /// Everywhere in the band, up to a billionth of a decibel.
    Kept {
        /// Least upper/lower, dB.
        least_db: f64,
        /// Where, rad/s.
        frequency_rad_per_s: f64,
    },
    /// Not so: no loop meets both limits there.
    Crossed {
        /// The lowest frequency at which lower and upper limit meet, rad/s.
        from_rad_per_s: f64,
        /// By how much the lower limit exceeds the upper one where that is worst, dB.
        excess_db: f64,
        /// Where it is worst, rad/s.
        frequency_rad_per_s: f64,
    },
}

/// Compares the magnitudes of two limits of tracking over a band `[from, to]` in rad/s (`to` may be infinite).
///
/// ```text
/// spread(w) = 20 log10(|B_U(jw)|/|B_L(jw)|)
/// ```
///
/// The squared ratio is a rational function of w^2; between the roots of its derivative it rises or falls throughout, so
/// those roots and the ends of the band tell everything.
///
/// # Errors
/// [`TimeDomainError::OutOfRange`] for the band, [`TimeDomainError::NotContinuous`], and where the roots cannot be found.
///
/// # Example
/// Two lags part by 20 dB, from the corner of the slow one to that of the fast one:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::linear::TransferFunction;
/// use phea_qft::specification::{LimitOrder, tracking_spread};
/// let lag = |pole: f64| TransferFunction::from_factors(pole, vec![], vec![Complex64::new(-pole, 0.0)]);
/// let spread = tracking_spread(&lag(1.0)?, &lag(10.0)?, [0.0, f64::INFINITY])?;
/// assert_eq!(spread.order, LimitOrder::Kept { least_db: 0.0, frequency_rad_per_s: 0.0 });
/// assert_eq!((spread.grows_from_rad_per_s, spread.at_end_db), (Some(0.0), 20.0));
/// let swapped = tracking_spread(&lag(10.0)?, &lag(1.0)?, [0.0, f64::INFINITY])?;
/// assert!(matches!(swapped.order, LimitOrder::Crossed { from_rad_per_s: 0.0, excess_db: 20.0, .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tracking_spread(
    lower: &TransferFunction,
    upper: &TransferFunction,
    band_rad_per_s: [f64; 2],
) -> Result<TrackingSpread, TimeDomainError> {
    let [from, to] = band_rad_per_s;
    if !(from >= 0.0 && from.is_finite() && to >= from) {
        let (what, expected) = ("the band in rad/s", "zero or positive, and increasing");
        return Err(TimeDomainError::OutOfRange { what, value: from, expected });
    }
    let ratio = SquaredRatio::new(lower, upper)?;
    let mut knots = vec![from];
    knots.extend(ratio.extremes()?.into_iter().filter(|w| from < *w && *w < to));
    knots.push(to);
    let spread: Vec<(f64, f64)> = knots.into_iter().map(|w| (w, ratio.decibels(w))).collect();
    let falls = |pair: &[(f64, f64)]| matches!(pair, [a, b] if b.1 < a.1 - ROUNDING_DB);
    let grows_from = match spread.windows(2).rposition(falls) {
        None => Some(from),
        Some(last) => spread.get(last + 1).map(|knot| knot.0).filter(|w| *w < to),
    };
    let at_end_db = spread.last().map_or(f64::NAN, |knot| knot.1);
    Ok(TrackingSpread { order: order(&ratio, &spread), grows_from_rad_per_s: grows_from, at_end_db })
}

/// Differences below this are rounding, dB.
const ROUNDING_DB: f64 = 1e-9;

fn order(ratio: &SquaredRatio, spread: &[(f64, f64)]) -> LimitOrder {
    let least = spread.iter().copied().fold((0.0, f64::INFINITY), |a, b| if b.1 < a.1 { b } else { a });
    let Some(first) = spread.iter().position(|knot| knot.1 < -ROUNDING_DB) else {
        return LimitOrder::Kept { least_db: least.1, frequency_rad_per_s: least.0 };
    };
    let before = spread.get(first.saturating_sub(1)).copied().unwrap_or(least);
    let crossed = spread.get(first).map_or(before.0, |knot| knot.0);
    // limits that are equal at the knot before part from there on
    let from_rad_per_s = if before.1 > ROUNDING_DB { crossing(ratio, before.0, crossed) } else { before.0 };
    LimitOrder::Crossed { from_rad_per_s, excess_db: -least.1, frequency_rad_per_s: least.0 }
}

/// Where the limits meet, between a frequency where they are apart and one, perhaps infinite, where they have crossed.
fn crossing(ratio: &SquaredRatio, apart: f64, crossed: f64) -> f64 {
    let (mut apart, mut crossed) = (apart, crossed);
    loop {
        let middle = if crossed.is_finite() { apart + 0.5 * (crossed - apart) } else { 2.0 * apart.max(1.0) };
        if middle <= apart || middle >= crossed {
            return crossed;
        }
        if ratio.decibels(middle) > 0.0 { apart = middle } else { crossed = middle }
    }
}

/// |upper|^2/|lower|^2 as a quotient of polynomials in x = w^2.
struct SquaredRatio {
    above: Polynomial,
    below: Polynomial,
}

impl SquaredRatio {
    fn new(lower: &TransferFunction, upper: &TransferFunction) -> Result<SquaredRatio, TimeDomainError> {
        use phea_dynamics::linear::TimeDomain::Continuous;
        if lower.domain() != Continuous || upper.domain() != Continuous {
            return Err(TimeDomainError::NotContinuous);
        }
        let square = |gain: f64| gain * gain;
        let above = squared(upper.zeros()).product(&squared(lower.poles())).scaled(square(upper.gain()));
        let below = squared(lower.zeros()).product(&squared(upper.poles())).scaled(square(lower.gain()));
        Ok(SquaredRatio { above, below })
    }

    fn decibels(&self, frequency: f64) -> f64 {
        let (above, below) = (&self.above, &self.below);
        let ratio = if frequency.is_finite() {
            let x = num_complex::Complex64::new(frequency * frequency, 0.0);
            above.evaluate(x).re / below.evaluate(x).re
        } else {
            match above.degree().cmp(&below.degree()) {
                std::cmp::Ordering::Less => 0.0,
                std::cmp::Ordering::Equal => above.leading_coefficient() / below.leading_coefficient(),
                std::cmp::Ordering::Greater => f64::INFINITY,
            }
        };
        10.0 * log10(ratio)
    }

    /// Frequencies at which the ratio is at rest, rad/s, increasing.
    fn extremes(&self) -> Result<Vec<f64>, TimeDomainError> {
        let (above, below) = (&self.above, &self.below);
        let slope = above.derivative().product(below).sum(&above.product(&below.derivative()).scaled(-1.0));
        if slope.is_zero() {
            return Ok(Vec::new());
        }
        // a point too many does no harm: roots that are real up to rounding count
        let real = slope.roots()?.into_iter().filter(|root| root.re > 0.0 && root.im.abs() <= 1e-6 * root.re);
        let mut frequencies: Vec<f64> = real.map(|root| root.re.sqrt()).collect();
        frequencies.sort_by(f64::total_cmp);
        Ok(frequencies)
    }
}

/// The product of |jw - root|^2 as a polynomial in x = w^2, pair by pair.
fn squared(roots: &[num_complex::Complex64]) -> Polynomial {
    roots.iter().filter(|root| root.im >= 0.0).fold(Polynomial::new(vec![1.0]), |product, root| {
        let (re, im) = (root.re * root.re, root.im * root.im);
        let factor =
            if root.im == 0.0 { vec![1.0, re] } else { vec![1.0, 2.0 * (re - im), (re + im) * (re + im)] };
        product.product(&Polynomial::new(factor))
    })
}
