//! Reach of one more element: possible changes of the loop at one frequency.

use num_complex::Complex64;
use phea_dynamics::controller::Element;
use phea_dynamics::frequency::decibels;
use phea_dynamics::portable;

/// Type of the element to be solved for, and its fixed numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElementPattern {
    /// Gain k > 0: changes only the magnitude.
    Gain,
    /// Real pole 1/(s/p + 1): sets magnitude or phase.
    RealPole,
    /// Real zero s/z + 1: sets magnitude or phase.
    RealZero,
    /// Lead (s/z + 1)/(s/p + 1), z < p: sets both.
    Lead,
    /// Lag (s/z + 1)/(s/p + 1), z > p: sets both.
    Lag,
    /// Pair of poles 1/(s^2/w^2 + 2 zeta s/w + 1): sets both.
    ComplexPoles,
    /// Pair of zeros s^2/w^2 + 2 zeta s/w + 1: sets both.
    ComplexZeros,
    /// Pair of poles 1/(s^2/w^2 + 2 zeta s/w + 1) of this damping: sets magnitude or phase.
    RollOff {
        /// Damping ratio zeta.
        damping_ratio: f64,
    },
    /// Proportional-integral element K_p + K_i/s: sets both.
    ProportionalIntegral,
    /// Notch of this width at the frequency of the point: changes only the magnitude.
    NotchHere {
        /// Damping ratio zeta_p of the poles.
        pole_damping_ratio: f64,
    },
    /// Notch at another frequency, with free depth and width: sets both.
    FurtherNotch {
        /// Natural frequency w, rad/s.
        natural_frequency: f64,
    },
}

/// The changes of the loop at one frequency that a pattern can achieve. Ends are excluded, unless
/// both coincide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Range of the change of phase, degrees.
    pub turn_deg: [f64; 2],
    /// Range of the change of magnitude at the required change of phase, dB; `None` if that phase
    /// is out of reach.
    pub raise_db: Option<[f64; 2]>,
}

/// Required response of an element at one frequency: E = r e^(j theta).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElementTarget {
    /// Frequency w, rad/s.
    pub(super) frequency: f64,
    /// Magnitude r.
    pub(super) ratio: f64,
    /// Angle theta in (-pi, pi], rad.
    pub(super) turn: f64,
}

/// Tolerance within which two magnitudes, or angles in rad, count as equal.
const TOLERANCE: f64 = 1e-9;

impl ElementPattern {
    /// True if magnitude or phase determines the element.
    pub(super) fn has_one_number(self) -> bool {
        use ElementPattern::{Gain, NotchHere, RealPole, RealZero, RollOff};
        matches!(self, Gain | RealPole | RealZero | RollOff { .. } | NotchHere { .. })
    }

    /// True if the element does not change the phase.
    pub(super) fn satisfies_phase(self) -> bool {
        matches!(self, ElementPattern::Gain | ElementPattern::NotchHere { .. })
    }

    /// Reach of the element; the magnitudes are those at this change of phase, or at any if none is
    /// given.
    pub(super) fn reach(self, frequency: f64, turn: Option<f64>) -> Reach {
        let (back, ahead) = ([-90.0, 0.0], [0.0, 90.0]);
        let turn_deg = match self {
            ElementPattern::Gain | ElementPattern::NotchHere { .. } => [0.0, 0.0],
            ElementPattern::RealPole | ElementPattern::Lag | ElementPattern::ProportionalIntegral => back,
            ElementPattern::RealZero | ElementPattern::Lead => ahead,
            ElementPattern::ComplexPoles | ElementPattern::RollOff { .. } => [-180.0, 0.0],
            ElementPattern::ComplexZeros => [0.0, 180.0],
            ElementPattern::FurtherNotch { natural_frequency } if frequency < natural_frequency => back,
            ElementPattern::FurtherNotch { .. } => ahead,
        };
        let raise_db = match turn {
            Some(turn) if !within(turn.to_degrees(), turn_deg) => None,
            turn => Some(self.raise(turn).map(decibels)),
        };
        Reach { turn_deg, raise_db }
    }

    /// Least and greatest ratio of magnitudes at a reachable change of phase.
    fn raise(self, turn: Option<f64>) -> [f64; 2] {
        let whole = [0.0, f64::INFINITY];
        let cosine = turn.map_or(1.0, portable::cos);
        match (self, turn) {
            (ElementPattern::Gain | ElementPattern::ProportionalIntegral, _) => whole,
            (ElementPattern::NotchHere { .. }, _) => [0.0, 1.0],
            (ElementPattern::Lag | ElementPattern::FurtherNotch { .. }, _) => [0.0, cosine],
            (ElementPattern::Lead, _) => [1.0 / cosine, f64::INFINITY],
            (ElementPattern::RealPole, None) => [0.0, 1.0],
            (ElementPattern::RealZero, None) => [1.0, f64::INFINITY],
            (ElementPattern::RealPole, Some(_)) => [cosine; 2],
            (ElementPattern::RealZero, Some(_)) => [1.0 / cosine; 2],
            (ElementPattern::ComplexPoles | ElementPattern::ComplexZeros, None) => whole,
            (ElementPattern::ComplexPoles, Some(_)) => [cosine.max(0.0), f64::INFINITY],
            (ElementPattern::ComplexZeros, Some(_)) if cosine > 0.0 => [0.0, 1.0 / cosine],
            (ElementPattern::ComplexZeros, Some(_)) => whole,
            (ElementPattern::RollOff { damping_ratio }, None) => [0.0, peak(damping_ratio)],
            (ElementPattern::RollOff { damping_ratio }, Some(turn)) => {
                [magnitude_of_pair(relative_frequency(damping_ratio, -turn), damping_ratio); 2]
            }
        }
    }

    /// The element with E(jw) = r e^(j theta); `None` if there is none.
    pub(super) fn through(self, change: &ElementTarget) -> Option<Element> {
        let reach = self.reach(change.frequency, Some(change.turn));
        let ratio_db = decibels(change.ratio);
        if !reach.raise_db.is_some_and(|range| within(ratio_db, range)) {
            return None;
        }
        if self.satisfies_phase() {
            return self.of_magnitude(change);
        }
        if self.has_one_number() {
            return self.of_phase(change);
        }
        self.of_both(change)
    }

    /// The element with the required magnitude, at any phase.
    pub(super) fn of_magnitude(self, change: &ElementTarget) -> Option<Element> {
        let &ElementTarget { frequency: w, ratio: r, .. } = change;
        let [least, greatest] = self.raise(None);
        let element = match self {
            ElementPattern::Gain => Element::Gain(r),
            ElementPattern::RealPole => {
                Element::RealPole { frequency: w * r / ((1.0 - r) * (1.0 + r)).sqrt() }
            }
            ElementPattern::RealZero => Element::RealZero { frequency: w / ((r - 1.0) * (r + 1.0)).sqrt() },
            ElementPattern::RollOff { damping_ratio } => {
                // (1 - u^2)^2 + (2 zeta u)^2 = 1/r^2, the falling side of a peak
                let half = 1.0 - 2.0 * damping_ratio * damping_ratio;
                let square = half + (half * half - (1.0 - 1.0 / r) * (1.0 + 1.0 / r)).sqrt();
                Element::ComplexPoles { natural_frequency: w / square.sqrt(), damping_ratio }
            }
            ElementPattern::NotchHere { pole_damping_ratio } => Element::Notch {
                natural_frequency: w,
                zero_damping_ratio: r * pole_damping_ratio,
                pole_damping_ratio,
            },
            _ => return None,
        };
        (least < r && r < greatest && is_sound(&element)).then_some(element)
    }

    /// The element with the required phase, at any magnitude.
    pub(super) fn of_phase(self, change: &ElementTarget) -> Option<Element> {
        let &ElementTarget { frequency: w, turn, .. } = change;
        self.reach(w, Some(turn)).raise_db?;
        let element = match self {
            ElementPattern::RealPole => Element::RealPole { frequency: w / portable::tan(-turn) },
            ElementPattern::RealZero => Element::RealZero { frequency: w / portable::tan(turn) },
            ElementPattern::RollOff { damping_ratio } => {
                let u = relative_frequency(damping_ratio, -turn);
                Element::ComplexPoles { natural_frequency: w / u, damping_ratio }
            }
            _ => return None,
        };
        is_sound(&element).then_some(element)
    }

    /// The element with two numbers for two conditions.
    fn of_both(self, change: &ElementTarget) -> Option<Element> {
        let &ElementTarget { frequency: w, ratio: r, turn } = change;
        let e = Complex64::new(r * portable::cos(turn), r * portable::sin(turn));
        let element = match self {
            ElementPattern::Lead | ElementPattern::Lag => {
                let [x, y] = corners(change);
                Element::LeadLag { zero_frequency: w / x, pole_frequency: w / y }
            }
            ElementPattern::FurtherNotch { natural_frequency } => {
                let [x, y] = corners(change);
                let u = w / natural_frequency;
                let half = (1.0 - u) * (1.0 + u) / (2.0 * u);
                Element::Notch {
                    natural_frequency,
                    zero_damping_ratio: x * half,
                    pole_damping_ratio: y * half,
                }
            }
            ElementPattern::ComplexZeros => {
                let (natural_frequency, damping_ratio) = pair(w, e)?;
                Element::ComplexZeros { natural_frequency, damping_ratio }
            }
            ElementPattern::ComplexPoles => {
                let (natural_frequency, damping_ratio) = pair(w, 1.0 / e)?;
                Element::ComplexPoles { natural_frequency, damping_ratio }
            }
            ElementPattern::ProportionalIntegral => {
                Element::ProportionalIntegral { proportional_gain: e.re, integral_gain: -w * e.im }
            }
            _ => return None,
        };
        is_sound(&element).then_some(element)
    }
}

/// Coordinates x and y of a first-order pair.
///
/// ```text
/// (1 + j x)/(1 + j y) = r e^(j theta):    x = (r - cos theta)/sin theta,    y = (cos theta - 1/r)/sin theta
/// ```
fn corners(change: &ElementTarget) -> [f64; 2] {
    let &ElementTarget { ratio: r, turn, .. } = change;
    let (cosine, sine) = (portable::cos(turn), portable::sin(turn));
    [(r - cosine) / sine, (cosine - 1.0 / r) / sine]
}

/// Natural frequency and damping of a second-order pair.
///
/// ```text
/// 1 - u^2 + 2 j zeta u = z,  u = w/w_n:    u = sqrt(1 - Re z),    zeta = Im z/(2 u)
/// ```
fn pair(w: f64, z: Complex64) -> Option<(f64, f64)> {
    let square = 1.0 - z.re;
    if square > 0.0 { Some((w / square.sqrt(), z.im / (2.0 * square.sqrt()))) } else { None }
}

/// Relative frequency u = w/w_n at which a pair of poles lags by psi.
///
/// ```text
/// u^2 sin psi + 2 zeta u cos psi - sin psi = 0,    the positive root
/// ```
fn relative_frequency(damping_ratio: f64, psi: f64) -> f64 {
    let (cosine, sine) = (damping_ratio * portable::cos(psi), portable::sin(psi));
    let root = portable::hypot(cosine, sine);
    // the form of the root without a difference of nearly equal numbers
    if cosine > 0.0 { sine / (root + cosine) } else { (root - cosine) / sine }
}

fn magnitude_of_pair(u: f64, damping_ratio: f64) -> f64 {
    1.0 / portable::hypot((1.0 - u) * (1.0 + u), 2.0 * damping_ratio * u)
}

/// The greatest magnitude of a pair of poles.
fn peak(damping_ratio: f64) -> f64 {
    let square = damping_ratio * damping_ratio;
    if square >= 0.5 {
        1.0
    } else {
        0.5 / (damping_ratio * ((1.0 - damping_ratio) * (1.0 + damping_ratio)).sqrt())
    }
}

/// True if the value is strictly between the ends, or equal to them if they coincide.
fn within(value: f64, [low, high]: [f64; 2]) -> bool {
    if low == high { (value - low).abs() <= TOLERANCE } else { low < value && value < high }
}

/// True if the transfer function is still valid after rounding.
fn is_sound(element: &Element) -> bool {
    element.transfer_function().is_ok_and(|function| {
        let roots = function.zeros().iter().chain(function.poles());
        function.gain() > 0.0 && roots.into_iter().all(|root| root.is_finite() && root.re <= 0.0)
    })
}
