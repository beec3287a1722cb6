use std::f64::consts::PI;

use num_complex::Complex64;
use phea_dynamics::frequency::logarithmic_grid;
use phea_dynamics::linear::TransferFunction;
use phea_dynamics::order::sort_numbers;
use phea_dynamics::portable::{exp, ln, magnitude, sin, tan};

use super::super::minimum::minimum_between;
use super::super::{Limit, LimitTable};
use super::{MarginError, in_range, phase_margin, positive};

/// The limit on |L/(1+L)| that lets every loop tolerate this much additional delay in s (positive).
///
/// ```text
/// |L/(1+L)| <= 1/(w tau)          since 1 + L e^(-s tau) = (1 + L)(1 + (e^(-s tau) - 1) L/(1+L))
///                                 and |e^(-jw tau) - 1| <= w tau
/// ```
///
/// Sufficient, by the small gain theorem: the loop may tolerate more. [`delay_margin_limit_table`]
/// is sharper but not a rational function.
///
/// # Errors
/// [`MarginError::OutOfRange`].
///
/// # Example
/// ```
/// let limit = phea_qft::specification::delay_margin_limit(0.5e-3)?;
/// assert_eq!(limit.magnitude(1000.0), Some(2.0)); // one millisecond's worth at 1000 rad/s is 1, half of it 2
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn delay_margin_limit(delay_s: f64) -> Result<Limit, MarginError> {
    let gain = 1.0 / positive("the delay in s", delay_s)?;
    let limit = TransferFunction::from_factors(gain, Vec::new(), vec![Complex64::new(0.0, 0.0)]);
    let expected = "large enough that its inverse is finite";
    limit.map(Limit::Rational).map_err(|_| MarginError::OutOfRange {
        what: "the delay in s",
        value: delay_s,
        expected,
    })
}

/// The sharper limit on |L/(1+L)| for a delay in s (positive), as a table over a band `[from, to]`
/// in rad/s (positive, finite).
///
/// ```text
/// |L/(1+L)| <= 1/(2 sin(w tau/2))     w tau < pi,       since |e^(-jw t) - 1| = 2 |sin(w t/2)|
///              1/2                    above             for each delay t up to tau
/// ```
///
/// (1/2 less a billionth, since |L| = 1 is to be excluded there.)
///
/// Where |L| = 1 this requires a phase margin of exactly w tau: it is sharp there. In a double
/// logarithmic diagram the limit is convex, so the table, straight between its points, is made of
/// its tangents: never above it, less than 0.01 dB below. Outside the band the table demands
/// nothing; the guarantee then covers encirclements of -1 inside the band.
///
/// # Errors
/// [`MarginError::OutOfRange`].
///
/// # Example
/// At 1000 rad/s and 1 ms, w tau = 1 rad: 1/(2 sin 0.5) = 1.043, where 1/(w tau) allows 1.
/// ```
/// let limit = phea_qft::specification::delay_margin_limit_table(1e-3, [1.0, 1e5])?;
/// assert!(limit.magnitude(1000.0).is_some_and(|value| (value - 1.043).abs() < 1e-3));
/// assert!(limit.magnitude(1e4).is_some_and(|value| (value - 0.5).abs() < 1e-9));
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn delay_margin_limit_table(delay_s: f64, band_rad_per_s: [f64; 2]) -> Result<Limit, MarginError> {
    positive("the delay in s", delay_s)?;
    let [from, to] = finite_band(band_rad_per_s)?;
    let lines = tangents(delay_s);
    let value = |abscissa: f64| lines.iter().fold(f64::NEG_INFINITY, |top, line| top.max(line.at(abscissa)));
    let corners = lines.windows(2).filter_map(|pair| match pair {
        [left, right] => Some(left.meets(right)),
        _ => None,
    });
    let mut points = vec![(from, exp(value(ln(from))))];
    points.extend(
        corners
            .map(|abscissa| (exp(abscissa), exp(value(abscissa))))
            .filter(|point| from < point.0 && point.0 < to),
    );
    points.push((to, exp(value(ln(to)))));
    let expected = "such that limit and band stay in the range of numbers";
    let table = LimitTable::new(points);
    table.map(Limit::Table).map_err(|_| MarginError::OutOfRange {
        what: "the delay in s",
        value: delay_s,
        expected,
    })
}

/// A straight line in the diagram of ln limit over ln w.
struct LogarithmicLine {
    slope: f64,
    offset: f64,
}

impl LogarithmicLine {
    fn at(&self, abscissa: f64) -> f64 {
        self.slope * abscissa + self.offset
    }

    fn meets(&self, other: &LogarithmicLine) -> f64 {
        (other.offset - self.offset) / (self.slope - other.slope)
    }
}

/// The asymptote 1/(w tau), tangents at w tau from 0.1 on, and just below the last one, at pi.
fn tangents(delay_s: f64) -> Vec<LogarithmicLine> {
    const COUNT: usize = 64;
    const FIRST: f64 = 0.1;
    const BELOW_ONE_HALF: f64 = 1e-9;
    let asymptote = LogarithmicLine { slope: -1.0, offset: -ln(delay_s) };
    let touching = (0..COUNT).map(|index| {
        let angle = FIRST * exp(ln(PI / FIRST) * index as f64 / COUNT as f64);
        let half = angle / 2.0;
        // d ln(1/(2 sin(x/2)))/d ln x = -(x/2)/tan(x/2)
        let slope = -half / tan(half);
        LogarithmicLine { slope, offset: -ln(2.0 * sin(half)) - slope * ln(angle / delay_s) }
    });
    let end = LogarithmicLine { slope: 0.0, offset: -ln(2.0) - BELOW_ONE_HALF };
    std::iter::once(asymptote).chain(touching).chain(std::iter::once(end)).collect()
}

/// The delay that a limit on |L/(1+L)| guarantees, and the frequency that decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DelayGuarantee {
    /// No shorter delay brings the loop to -1 at a frequency of the band, s; infinity where |L| can
    /// never be one.
    pub delay_s: f64,
    /// Where the limit allows the least delay, rad/s.
    pub frequency_rad_per_s: f64,
}

/// The additional delay that |L/(1+L)| <= W(w) guarantees over a band `[from, to]` in rad/s
/// (positive, finite).
///
/// ```text
/// tau = min over w of  2 asin(1/(2 W(w)))/w          over all w with W(w) >= 1/2
/// ```
///
/// Delay turns L without changing its size, so -1 is reached where |L| = 1; there the phase margin
/// is at least 2 asin(1/(2W)). The loop must be stable when closed. A constant limit over a band
/// that reaches far gives little: it is the decrease of the limit that guarantees delay. The
/// minimum is searched on a grid of 4000 points and refined.
///
/// # Errors
/// [`MarginError::OutOfRange`] for a band that is not positive, finite and increasing, or a limit
/// that is not positive; [`MarginError::Silent`] where a table does not cover the band.
///
/// # Example
/// There and back:
/// ```
/// use phea_qft::specification::{delay_margin_limit, guaranteed_delay};
/// let guarantee = guaranteed_delay(&delay_margin_limit(2e-3)?, [1e-3, 1e5])?;
/// assert!((guarantee.delay_s / 2e-3 - 1.0).abs() < 1e-9);
/// # Ok::<(), phea_qft::specification::MarginError>(())
/// ```
pub fn guaranteed_delay(limit: &Limit, band_rad_per_s: [f64; 2]) -> Result<DelayGuarantee, MarginError> {
    let [from, to] = finite_band(band_rad_per_s)?;
    let mut grid = logarithmic_grid(from, to, 4000).unwrap_or_default();
    let corners: Vec<f64> = match limit {
        Limit::Constant(_) => Vec::new(),
        Limit::Rational(function) => {
            function.zeros().iter().chain(function.poles()).map(|root| magnitude(*root)).collect()
        }
        Limit::Table(table) => table.points().iter().map(|point| point.0).collect(),
    };
    grid.extend(corners.into_iter().filter(|w| from < *w && *w < to));
    sort_numbers(&mut grid);
    let delays = grid.iter().map(|&w| delay_allowed(limit, w)).collect::<Result<Vec<f64>, _>>()?;
    let least = delays.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index);
    let around = grid.get(least.saturating_sub(1)).zip(grid.get(least + 1).or(grid.last()));
    let on_grid = grid.get(least).copied().zip(delays.get(least).copied()).unwrap_or((from, f64::INFINITY));
    let (low, high) = around.map_or((from, to), |(low, high)| (*low, *high));
    let refined = minimum_between(low, high, |w| delay_allowed(limit, w).unwrap_or(f64::INFINITY));
    let (frequency_rad_per_s, delay_s) = if refined.1 < on_grid.1 { refined } else { on_grid };
    Ok(DelayGuarantee { delay_s, frequency_rad_per_s })
}

/// 2 asin(1/(2W))/w; infinity where |L| cannot be one.
fn delay_allowed(limit: &Limit, frequency_rad_per_s: f64) -> Result<f64, MarginError> {
    let value = limit.magnitude(frequency_rad_per_s).ok_or(MarginError::Silent { frequency_rad_per_s })?;
    let value = in_range("the limit", value, value > 0.0, "positive")?;
    Ok(phase_margin(value) / frequency_rad_per_s)
}

fn finite_band([from, to]: [f64; 2]) -> Result<[f64; 2], MarginError> {
    let from = positive("the lower end of the band in rad/s", from)?;
    let expected = "finite and above the lower end";
    Ok([from, in_range("the upper end of the band in rad/s", to, to.is_finite() && to > from, expected)?])
}
