//! The turn of 1 + L below the first measured frequency, from the integrators of the loop.
//!
//! ```text
//! turn = -m pi/2 + off        L ~ k/s^m below the first point; off: angle between 1 + L there and the nearest half axis
//! ln|L| = a - m ln w          fitted over at least a factor of two in frequency
//! ```
//!
//! The sign of k is chosen to make `off` small, so that m and m + 2 fit one response: only the
//! slope, or a statement, distinguishes them, and a wrong choice changes the count by one pole.

use num_complex::Complex64;
use phea_dynamics::portable;

use super::{LARGE_GAIN, LoopPoint, SMALL_GAIN, TURN_MAXIMUM};
use crate::stability::Irresolution;

/// Factor above the first point that the points used for the slope must cover.
const REACH: f64 = 2.0;
/// Least number of these points: two for the line, two for its scatter.
const POINTS_MINIMUM: usize = 4;
/// Largest distance of the slope, with its uncertainty, from a whole number.
const SLOPE_TOLERANCE: f64 = 0.35;
/// Distance of a slope from the stated number of integrators that contradicts it.
const CONTRADICTION: f64 = 0.75;
/// Probability that the slope is not within its uncertainty.
const OUTSIDE: f64 = 0.05;

/// Slope d ln|L|/d ln w at the lowest frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slope {
    slope: f64,
    /// Half width of its interval, and that of ln|L| at the first point.
    uncertainty: f64,
    scatter: f64,
}

/// Behaviour of the loop below its first point.
pub(super) struct LowEnd<'a> {
    /// Open loop L from its first frequency on.
    pub(super) points: &'a [LoopPoint],
    /// Number of poles less zeros of L at the origin, if stated.
    pub(super) integrators: Option<f64>,
    /// True if the response is a model, not a measurement: two neighbours determine the slope.
    pub(super) is_known: bool,
}

impl LowEnd<'_> {
    /// The change of arg(1 + L) from zero frequency, where 1 + L is real, to the first point,
    /// passing m integrators on the right.
    pub(super) fn turn(&self) -> Result<f64, Irresolution> {
        let first = self.points.first().ok_or(Irresolution::Points)?;
        let slope = self.slope();
        let unknown = Err(Irresolution::LowEnd {
            frequency_rad_per_s: first.frequency,
            slope: slope.map(|found| [found.slope - found.uncertainty, found.slope + found.uncertainty]),
        });
        let gain = portable::magnitude(first.value);
        let Some(integrators) = self.integrators() else { return unknown };
        let contradicts = |found: Slope| (found.slope + integrators).abs() - found.uncertainty;
        if slope.is_some_and(|found| contradicts(found) > CONTRADICTION) {
            return Err(Irresolution::Integrators { frequency_rad_per_s: first.frequency, integrators });
        }
        let scatter = slope.map_or(0.0, |found| found.scatter * gain);
        let open = opening(1.0 + first.value, first.radius.max(scatter));
        if gain + first.radius <= SMALL_GAIN && integrators <= 0.0 {
            return Ok(portable::argument(1.0 + first.value));
        }
        if integrators < 0.0 || (integrators > 0.0 && gain < LARGE_GAIN) {
            return unknown;
        }
        let quarter = std::f64::consts::FRAC_PI_2;
        let mut rest = 1.0 + first.value;
        let mut done = 0.0;
        while done < integrators {
            rest *= Complex64::new(0.0, 1.0);
            done += 1.0;
        }
        let off = portable::argument(if rest.re < 0.0 { -rest } else { rest });
        if off.abs() + open > TURN_MAXIMUM { unknown } else { Ok(off - integrators * quarter) }
    }

    /// The stated integrators, or those that the slope indicates beyond its scatter.
    fn integrators(&self) -> Option<f64> {
        self.integrators.or_else(|| {
            let Slope { slope, uncertainty, .. } = self.slope()?;
            let whole = (-slope).round();
            ((slope + whole).abs() + uncertainty <= SLOPE_TOLERANCE).then_some(whole)
        })
    }

    /// The slope over at least a factor of two, with its confidence interval from the scatter about
    /// the fitted line.
    ///
    /// ```text
    /// |slope - fitted| <= sqrt(2 F(2, m)) s/sqrt(sum (x - mean)^2)        m = points - 2,  2 F(2, m) = m (0.05^(-2/m) - 1)
    /// ```
    fn slope(&self) -> Option<Slope> {
        let first = self.points.first()?.frequency;
        let reached = self.points.iter().position(|point| point.frequency >= REACH * first);
        let count = if self.is_known { 2 } else { (reached? + 1).max(POINTS_MINIMUM) };
        let points: Vec<[f64; 2]> = self
            .points
            .get(..count)?
            .iter()
            .map(|point| [portable::ln(point.frequency), portable::ln(portable::magnitude(point.value))])
            .collect();
        let mean = |of: usize| points.iter().map(|point| point[of]).sum::<f64>() / count as f64;
        let [x, y] = [mean(0), mean(1)];
        let width: f64 = points.iter().map(|point| (point[0] - x) * (point[0] - x)).sum();
        let slope = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>() / width;
        let rest: f64 = points
            .iter()
            .map(|point| {
                let off = point[1] - y - slope * (point[0] - x);
                off * off
            })
            .sum();
        let freedom = count as f64 - 2.0;
        if freedom <= 0.0 {
            return Some(Slope { slope, uncertainty: 0.0, scatter: 0.0 });
        }
        let times = (freedom * (portable::pow(OUTSIDE, -2.0 / freedom) - 1.0)).sqrt();
        let scatter = times * (rest / freedom).sqrt();
        Some(Slope { slope, uncertainty: scatter / width.sqrt(), scatter })
            .filter(|found| found.slope.is_finite())
    }
}

/// The angle that a disc around a point subtends at the origin, rad.
pub(super) fn opening(centre: Complex64, radius: f64) -> f64 {
    let fraction = radius / portable::magnitude(centre);
    if fraction < 1.0 { portable::asin(fraction) } else { std::f64::consts::PI }
}
