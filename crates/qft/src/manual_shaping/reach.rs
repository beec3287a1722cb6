//! What one more element can do to the loop at one frequency.

use num_complex::Complex64;
use phea_dynamics::controller::Element;
use phea_dynamics::frequency::decibels;
use phea_dynamics::portable;

/// Which element is to be solved for, and its numbers that are not free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElementPattern {
    /// k > 0: the magnitude alone.
    Gain,
    /// 1/(s/p + 1): magnitude or phase.
    RealPole,
    /// s/z + 1: magnitude or phase.
    RealZero,
    /// (s/z + 1)/(s/p + 1), z < p: both.
    Lead,
    /// (s/z + 1)/(s/p + 1), z > p: both.
    Lag,
    /// 1/(s^2/w^2 + 2 zeta s/w + 1): both.
    ComplexPoles,
    /// s^2/w^2 + 2 zeta s/w + 1: both.
    ComplexZeros,
    /// 1/(s^2/w^2 + 2 zeta s/w + 1) of this damping: magnitude or phase.
    RollOff {
        /// zeta
        damping_ratio: f64,
    },
    /// K_p + K_i/s: both.
    ProportionalIntegral,
    /// A notch at the frequency of the point, of this width: the magnitude alone.
    NotchHere {
        /// zeta_p
        pole_damping_ratio: f64,
    },
    /// A notch at another frequency, its depth and width free: both.
    NotchBeside {
        /// w, rad/s
        natural_frequency: f64,
    },
}

/// The changes of the loop at one frequency that a pattern can achieve. Ends are excluded, unless
/// both are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Range of the change of phase, degrees.
    pub turn_deg: [f64; 2],
    /// Range of the change of magnitude at the wanted change of phase, dB; `None` where that phase
    /// is out of reach.
    pub raise_db: Option<[f64; 2]>,
}

/// What an element must be at one frequency: E = r e^(j theta).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElementTarget {
    /// w, rad/s
    pub(super) frequency: f64,
    /// r
    pub(super) ratio: f64,
    /// theta in (-pi, pi], rad
    pub(super) turn: f64,
}

/// Whether two magnitudes, or angles in rad, are practically equal.
const TOLERANCE: f64 = 1e-9;

impl ElementPattern {
    /// Whether magnitude or phase alone determines it.
    pub(super) fn has_one_number(self) -> bool {
        use ElementPattern::{Gain, NotchHere, RealPole, RealZero, RollOff};
        matches!(self, Gain | RealPole | RealZero | RollOff { .. } | NotchHere { .. })
    }

    /// Whether it does not change the phase.
    pub(super) fn keeps_phase(self) -> bool {
        matches!(self, ElementPattern::Gain | ElementPattern::NotchHere { .. })
    }

    /// What it can achieve; the magnitudes are those at this change of phase, or at any if none is
    /// given.
    pub(super) fn reach(self, frequency: f64, turn: Option<f64>) -> Reach {
        let (back, ahead) = ([-90.0, 0.0], [0.0, 90.0]);
        let turn_deg = match self {
            ElementPattern::Gain | ElementPattern::NotchHere { .. } => [0.0, 0.0],
            ElementPattern::RealPole | ElementPattern::Lag | ElementPattern::ProportionalIntegral => back,
            ElementPattern::RealZero | ElementPattern::Lead => ahead,
            ElementPattern::ComplexPoles | ElementPattern::RollOff { .. } => [-180.0, 0.0],
            ElementPattern::ComplexZeros => [0.0, 180.0],
            ElementPattern::NotchBeside { natural_frequency } if frequency < natural_frequency => back,
            ElementPattern::NotchBeside { .. } => ahead,
        };
        let raise_db = match turn {
            Some(turn) if !within(turn.to_degrees(), turn_deg) => None,
            turn => Some(self.raise(turn).map(decibels)),
        };
        Reach { turn_deg, raise_db }
    }

    /// Least and greatest ratio of magnitudes at a change of phase that can be reached.
    fn raise(self, turn: Option<f64>) -> [f64; 2] {
        let whole = [0.0, f64::INFINITY];
        let cosine = turn.map_or(1.0, portable::cos);
        match (self, turn) {
            (ElementPattern::Gain | ElementPattern::ProportionalIntegral, _) => whole,
            (ElementPattern::NotchHere { .. }, _) => [0.0, 1.0],
            (ElementPattern::Lag | ElementPattern::NotchBeside { .. }, _) => [0.0, cosine],
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

    /// The element with E(jw) = r e^(j theta); `None` where there is none.
    pub(super) fn through(self, change: &ElementTarget) -> Option<Element> {
        let reach = self.reach(change.frequency, Some(change.turn));
        let ratio_db = decibels(change.ratio);
        if !reach.raise_db.is_some_and(|range| within(ratio_db, range)) {
            return None;
        }
        if self.keeps_phase() {
            return self.of_magnitude(change);
        }
        if self.has_one_number() {
            return self.of_phase(change);
        }
        self.of_both(change)
    }

    /// The element whose magnitude is right, whatever its phase.
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

    /// The element whose phase is right, whatever its magnitude.
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

    /// Two numbers for two conditions.
    fn of_both(self, change: &ElementTarget) -> Option<Element> {
        let &ElementTarget { frequency: w, ratio: r, turn } = change;
        let e = Complex64::new(r * portable::cos(turn), r * portable::sin(turn));
        let element = match self {
            ElementPattern::Lead | ElementPattern::Lag => {
                let [x, y] = corners(change);
                Element::LeadLag { zero_frequency: w / x, pole_frequency: w / y }
            }
            ElementPattern::NotchBeside { natural_frequency } => {
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

/// x and y of a first-order pair.
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

/// u = w/w_n at which a pair of poles lags by psi.
///
/// ```text
/// u^2 sin psi + 2 zeta u cos psi - sin psi = 0,    the positive root
/// ```
fn relative_frequency(damping_ratio: f64, psi: f64) -> f64 {
    let (cosine, sine) = (damping_ratio * portable::cos(psi), portable::sin(psi));
    let root = portable::hypot(cosine, sine);
    // of the two forms of the root, the one without a difference of nearly equal numbers
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

/// Inside the ends, or equal to them where they coincide.
fn within(value: f64, [low, high]: [f64; 2]) -> bool {
    if low == high { (value - low).abs() <= TOLERANCE } else { low < value && value < high }
}

/// Whether a valid transfer function remained after rounding.
fn is_sound(element: &Element) -> bool {
    element.transfer_function().is_ok_and(|function| {
        let roots = function.zeros().iter().chain(function.poles());
        function.gain() > 0.0 && roots.into_iter().all(|root| root.is_finite() && root.re <= 0.0)
    })
}
