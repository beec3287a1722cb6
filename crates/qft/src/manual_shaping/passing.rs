//! An element solved so that the loop passes through a required point of the chart.

use num_complex::Complex64;
use phea_dynamics::controller::{Element, Timing};
use phea_dynamics::frequency::decibels;
use phea_dynamics::portable;

use super::reach::{ElementPattern, ElementTarget, Reach};

/// A point of the Nichols chart, or one of its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WantedPoint {
    /// Frequency w, rad/s.
    pub frequency_rad_per_s: f64,
    /// Magnitude 20 log10 |L|, dB; `None` if any.
    pub magnitude_db: Option<f64>,
    /// Phase arg L without whole turns, degrees; `None` if any.
    pub phase_deg: Option<f64>,
}

/// Reason why no element is found.
#[derive(Clone, Debug, PartialEq)]
pub enum PassError {
    /// A frequency that is not positive, or beyond the band of a sampled loop.
    Frequency {
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// A loop that is zero or not finite, which no element changes.
    NoLoop {
        /// Present value of the loop.
        present: Complex64,
        /// Frequency, rad/s.
        frequency_rad_per_s: f64,
    },
    /// The point does not specify the coordinate that the element needs.
    Incomplete {
        /// Type of the element.
        pattern: ElementPattern,
        /// Coordinate that it needs.
        needs: NeededCoordinate,
    },
    /// The given number of the element is invalid.
    Number {
        /// Type of the element.
        pattern: ElementPattern,
        /// Damping ratio, or frequency, rad/s.
        value: f64,
    },
    /// A sampled loop whose elements are not discretised by the bilinear rule, the only one with a
    /// closed form.
    Discretization,
    /// The element cannot move the loop to this point.
    Unreachable {
        /// Type of the element.
        pattern: ElementPattern,
        /// The change of phase required, degrees; `None` if no phase is specified.
        turn_deg: Option<f64>,
        /// The change of magnitude required, dB; `None` if no magnitude is specified.
        raise_db: Option<f64>,
        /// Reach of the element.
        reach: Reach,
    },
}

/// Coordinates of the point that an element needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NeededCoordinate {
    /// The magnitude; the element does not change the phase.
    Magnitude,
    /// Magnitude or phase.
    Either,
    /// Magnitude and phase.
    Both,
}

/// The element that moves the loop from `present` = L(jw) to the required point.
///
/// The required response is E(jw) = r e^(j theta), with r = |L required|/|L| and theta = arg L
/// required - arg L:
///
/// ```text
/// gain              k = r                                                       theta = 0
/// real pole         p = w/tan(-theta)               r = cos theta               -90 < theta < 0 degrees
/// real zero         z = w/tan(theta)                r = 1/cos theta             0 < theta < 90
/// lead, lag         z = w sin theta/(r - cos theta),  p = w sin theta/(cos theta - 1/r)
///                   lead: r > 1/cos theta, 0 < theta < 90;   lag: r < cos theta, -90 < theta < 0
/// complex poles     w_n = w/sqrt(1 - cos theta/r),  zeta = -sin theta w_n/(2 r w)    r > cos theta, -180 < theta < 0
/// complex zeros     w_n = w/sqrt(1 - r cos theta),  zeta = r sin theta w_n/(2 w)     r cos theta < 1, 0 < theta < 180
/// roll-off          w_n from theta, or from r <= 1 (the falling side of a peak), zeta given       -180 < theta < 0
/// PI                K_p = r cos theta,  K_i = -w r sin theta                    -90 < theta < 0
/// notch here        zeta_z = r zeta_p               r < 1                       theta = 0
/// notch beside      zeta_z, zeta_p = (1 - w^2/w_n^2) w_n/(2 w) times the lag's w/z, w/p
///                   r < cos theta, -90 < theta < 0 below w_n, 0 < theta < 90 above it
/// ```
///
/// Elements with one number need one coordinate of the point; if both are given, the point must be
/// on their curve. In a sampled loop the bilinear rule maps E(s) at frequency w to E at w' = 2/T
/// tan(w T/2), so that w' replaces w.
///
/// # Errors
/// [`PassError`]; for a point out of reach, it states the reach.
///
/// # Example
/// A lead that raises a loop from -12 dB, -160 degrees to 0 dB, -120 degrees at 20 rad/s; and a
/// point that no lead reaches:
/// ```
/// use num_complex::Complex64;
/// use phea_dynamics::controller::Timing;
/// use phea_qft::manual_shaping::{PassError, ElementPattern, WantedPoint, pass_through};
/// let polar = |size: f64, degrees: f64| {
///     Complex64::new(size * degrees.to_radians().cos(), size * degrees.to_radians().sin())
/// };
/// let present = polar(0.251_188_643, -160.0);
/// let wanted = WantedPoint { frequency_rad_per_s: 20.0, magnitude_db: Some(0.0), phase_deg: Some(-120.0) };
/// let lead = pass_through(ElementPattern::Lead, &wanted, present, &Timing::default())?;
/// let reached = present * lead.transfer_function().unwrap().at_frequency(20.0);
/// assert!((reached - polar(1.0, -120.0)).norm_sqr() < 1e-28);
/// let ahead = WantedPoint { phase_deg: Some(-60.0), ..wanted };
/// let refused = pass_through(ElementPattern::Lead, &ahead, present, &Timing::default());
/// assert!(matches!(refused, Err(PassError::Unreachable { reach, .. }) if reach.turn_deg == [0.0, 90.0]));
/// # Ok::<(), PassError>(())
/// ```
pub fn pass_through(
    pattern: ElementPattern,
    wanted: &WantedPoint,
    present: Complex64,
    timing: &Timing,
) -> Result<Element, PassError> {
    check_numbers(pattern)?;
    let change = change(pattern, wanted, present, timing)?;
    let (turn, raise) = (wanted.phase_deg.map(|_| change.turn), wanted.magnitude_db.map(|_| change.ratio));
    let incomplete = |needs| Err(PassError::Incomplete { pattern, needs });
    let element = match (raise, turn) {
        (None, None) => return incomplete(NeededCoordinate::Either),
        (Some(_), Some(_)) => pattern.through(&change),
        _ if !pattern.has_one_number() => return incomplete(NeededCoordinate::Both),
        (Some(_), None) => pattern.of_magnitude(&change),
        (None, Some(_)) if pattern.satisfies_phase() => return incomplete(NeededCoordinate::Magnitude),
        (None, Some(_)) => pattern.of_phase(&change),
    };
    element.ok_or_else(|| PassError::Unreachable {
        pattern,
        turn_deg: turn.map(f64::to_degrees),
        raise_db: raise.map(decibels),
        reach: pattern.reach(change.frequency, turn),
    })
}

/// The required response of the element, and the frequency at which it is evaluated.
fn change(
    pattern: ElementPattern,
    wanted: &WantedPoint,
    present: Complex64,
    timing: &Timing,
) -> Result<ElementTarget, PassError> {
    let frequency_rad_per_s = wanted.frequency_rad_per_s;
    if !(frequency_rad_per_s > 0.0 && frequency_rad_per_s.is_finite()) {
        return Err(PassError::Frequency { frequency_rad_per_s });
    }
    let size = portable::magnitude(present);
    if !(size > 0.0 && size.is_finite()) {
        return Err(PassError::NoLoop { present, frequency_rad_per_s });
    }
    let magnitude = wanted.magnitude_db.map_or(size, |decibels| portable::pow(10.0, decibels / 20.0));
    let turn = wanted.phase_deg.map_or(0.0, |degrees| degrees.to_radians() - portable::argument(present));
    Ok(ElementTarget {
        frequency: element_frequency(pattern, frequency_rad_per_s, timing)?,
        ratio: magnitude / size,
        turn: principal(turn),
    })
}

/// Frequency w, or its image under the bilinear rule; a gain has no frequency.
fn element_frequency(
    pattern: ElementPattern,
    frequency_rad_per_s: f64,
    timing: &Timing,
) -> Result<f64, PassError> {
    let Some(sample_time_s) = timing.sample_time_s else { return Ok(frequency_rad_per_s) };
    let half = frequency_rad_per_s * sample_time_s / 2.0;
    if half >= std::f64::consts::FRAC_PI_2 {
        return Err(PassError::Frequency { frequency_rad_per_s });
    }
    let rate = timing.discretization.bilinear_rate(sample_time_s);
    match (pattern, rate.map_err(|_| PassError::Discretization)?) {
        (ElementPattern::Gain, _) => Ok(frequency_rad_per_s),
        (_, Some(rate)) => Ok(rate * portable::tan(half)),
        (_, None) => Err(PassError::Discretization),
    }
}

/// An angle normalised to (-pi, pi].
fn principal(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let rest = angle - turn * (angle / turn).round();
    if rest <= -std::f64::consts::PI { rest + turn } else { rest }
}

fn check_numbers(pattern: ElementPattern) -> Result<(), PassError> {
    let value = match pattern {
        ElementPattern::RollOff { damping_ratio: value }
        | ElementPattern::NotchHere { pole_damping_ratio: value }
        | ElementPattern::FurtherNotch { natural_frequency: value } => value,
        _ => return Ok(()),
    };
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(PassError::Number { pattern, value }) }
}
