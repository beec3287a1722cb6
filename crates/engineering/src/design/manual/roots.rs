//! A law by its roots: real ones, pairs, and notches.

use num_complex::Complex64;
use phea_dynamics::controller::{Compensator, Element};
use phea_dynamics::linear::{TimeDomain, TransferFunction};
use phea_dynamics::order::sort_by_number;
use phea_dynamics::portable;

use super::{ManualGap, ManualPart};

/// Roots with s^2/w^2 + 2 D s/w + 1 = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) frequency: f64,
    pub(super) damping: f64,
}

/// Law k (s/z + 1) .../(s (s/p + 1) ...): every factor except the integrators has unit gain at zero
/// frequency.
#[derive(Clone, Debug, Default)]
pub(super) struct Roots {
    pub(super) gain: f64,
    pub(super) integrators: usize,
    /// Corners of real zeros and poles, rad/s, in ascending order.
    pub(super) zeros: Vec<f64>,
    pub(super) poles: Vec<f64>,
    /// Complex zeros.
    pub(super) zero_pairs: Vec<Pair>,
    pub(super) pole_pairs: Vec<Pair>,
    /// Notches that the law states explicitly.
    pub(super) notches: Vec<ManualPart>,
}

impl Roots {
    /// Roots of a continuous law that is stable and of minimum phase, except for integrators.
    pub(super) fn of(law: &Compensator) -> Result<Roots, ManualGap> {
        let mut roots = Roots { gain: 1.0, ..Roots::default() };
        for stage in law.stages.iter().filter(|stage| stage.enabled) {
            roots.take_in(&stage.element)?;
        }
        sort_by_number(&mut roots.zeros, |zero| *zero);
        sort_by_number(&mut roots.poles, |pole| *pole);
        sort_by_number(&mut roots.zero_pairs, |pair| pair.frequency);
        sort_by_number(&mut roots.pole_pairs, |pair| pair.frequency);
        if roots.gain == 0.0 || !roots.gain.is_finite() { Err(ManualGap::NotRational) } else { Ok(roots) }
    }

    fn take_in(&mut self, element: &Element) -> Result<(), ManualGap> {
        match *element {
            Element::Gain(gain) => self.gain *= gain,
            Element::Integrator => self.integrators += 1,
            Element::Differentiator => return Err(ManualGap::Origin),
            Element::RealPole { frequency } => self.poles.push(left(frequency)?),
            Element::RealZero { frequency } => self.zeros.push(left(frequency)?),
            Element::ComplexPoles { natural_frequency, damping_ratio } => {
                pair(natural_frequency, damping_ratio, &mut self.poles, &mut self.pole_pairs)?;
            }
            Element::ComplexZeros { natural_frequency, damping_ratio } => {
                pair(natural_frequency, damping_ratio, &mut self.zeros, &mut self.zero_pairs)?;
            }
            Element::LeadLag { zero_frequency, pole_frequency } => {
                self.zeros.push(left(zero_frequency)?);
                self.poles.push(left(pole_frequency)?);
            }
            Element::Notch { natural_frequency, zero_damping_ratio, pole_damping_ratio } => {
                left(natural_frequency)?;
                left(pole_damping_ratio)?;
                self.notches.push(ManualPart::Notch {
                    frequency_rad_per_s: natural_frequency,
                    pole_frequency_rad_per_s: natural_frequency,
                    zero_damping_ratio,
                    pole_damping_ratio,
                });
            }
            Element::ProportionalIntegral { .. }
            | Element::ProportionalIntegralDerivative { .. }
            | Element::General(_) => {
                self.take_in_function(&element.transfer_function().map_err(|_| ManualGap::NotRational)?)?;
            }
        }
        Ok(())
    }

    /// Adds the roots of a function: g prod(s - z)/prod(s - p) has the gain g prod(-z)/prod(-p)
    /// once its factors have unit gain.
    fn take_in_function(&mut self, function: &TransferFunction) -> Result<(), ManualGap> {
        if function.domain() != TimeDomain::Continuous {
            return Err(ManualGap::Sampled);
        }
        if function.dead_time_s() != 0.0 {
            return Err(ManualGap::NotRational);
        }
        self.gain *= function.gain();
        for (roots, is_pole) in [(function.zeros(), false), (function.poles(), true)] {
            for root in roots.iter().filter(|root| root.im >= 0.0) {
                self.take_in_root(*root, is_pole)?;
            }
        }
        Ok(())
    }

    fn take_in_root(&mut self, root: Complex64, is_pole: bool) -> Result<(), ManualGap> {
        if root == Complex64::ZERO {
            self.integrators += 1;
            return if is_pole { Ok(()) } else { Err(ManualGap::Origin) };
        }
        let size = portable::magnitude(root);
        let constant = if root.im > 0.0 { size * size } else { left(-root.re)? };
        self.gain = if is_pole { self.gain / constant } else { self.gain * constant };
        let (single, pairs) = match is_pole {
            true => (&mut self.poles, &mut self.pole_pairs),
            false => (&mut self.zeros, &mut self.zero_pairs),
        };
        match root.im > 0.0 {
            true => pair(size, -root.re / size, single, pairs),
            false => {
                single.push(-root.re);
                Ok(())
            }
        }
    }

    /// Pair of poles nearest to these zeros, within a factor, removed from the others.
    pub(super) fn poles_near(&mut self, zeros: Pair, factor: f64) -> Option<Pair> {
        let distance = |pair: &Pair| portable::ln(pair.frequency / zeros.frequency).abs();
        let nearest = self
            .pole_pairs
            .iter()
            .enumerate()
            .filter(|(_, pair)| distance(pair) <= portable::ln(factor))
            .min_by(|(_, one), (_, other)| distance(one).total_cmp(&distance(other)));
        let (place, _) = nearest?;
        Some(self.pole_pairs.remove(place))
    }

    /// Real pole nearest to this zero, removed from the others.
    pub(super) fn pole_nearest(&mut self, zero: f64) -> Option<f64> {
        let distance = |pole: &f64| portable::ln(pole / zero).abs();
        let each = self.poles.iter().enumerate();
        let (place, _) = each.min_by(|(_, one), (_, other)| distance(one).total_cmp(&distance(other)))?;
        Some(self.poles.remove(place))
    }

    pub(super) fn slowest_zero(&mut self) -> Option<f64> {
        (!self.zeros.is_empty()).then(|| self.zeros.remove(0))
    }

    /// PID of positive terms from two zeros, the integrator and a real pole, removed from the
    /// others.
    ///
    /// ```text
    /// k (s^2/w^2 + 2 D s/w + 1)/(s (T_f s + 1)) = K_p + k/s + K_d s/(T_f s + 1)
    /// K_p = k (2 D/w - T_f),      K_d = k/w^2 - K_p T_f
    /// ```
    pub(super) fn pid(&mut self) -> Option<ManualPart> {
        let [square, linear] = match (self.zero_pairs.as_slice(), self.zeros.as_slice()) {
            ([pair, ..], _) => [1.0 / (pair.frequency * pair.frequency), 2.0 * pair.damping / pair.frequency],
            ([], [slow, next, ..]) => [1.0 / (slow * next), 1.0 / slow + 1.0 / next],
            _ => return None,
        };
        let filter_time_s = 1.0 / self.poles.last()?;
        let fraction = linear - filter_time_s;
        let derivative = square - fraction * filter_time_s;
        if !(fraction > 0.0 && derivative > 0.0) {
            return None;
        }
        self.poles.pop();
        match self.zero_pairs.is_empty() {
            true => drop(self.zeros.drain(..2)),
            false => drop(self.zero_pairs.remove(0)),
        }
        Some(ManualPart::ProportionalIntegralDerivative {
            gain: self.gain * fraction,
            integral_time_s: fraction,
            derivative_time_s: derivative / fraction,
            filter_time_s,
        })
    }
}

/// A number, which must be positive.
fn left(number: f64) -> Result<f64, ManualGap> {
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err(ManualGap::NotMinimumPhase) }
}

/// Adds a pair, or two real roots if the damping ratio is 1 or more.
///
/// ```text
/// s = -w (D +- sqrt(D^2 - 1)),       the product of both is w^2
/// ```
fn pair(frequency: f64, damping: f64, single: &mut Vec<f64>, pairs: &mut Vec<Pair>) -> Result<(), ManualGap> {
    let (frequency, damping) = (left(frequency)?, left(damping)?);
    if damping < 1.0 {
        pairs.push(Pair { frequency, damping });
        return Ok(());
    }
    let fast = frequency * (damping + ((damping - 1.0) * (damping + 1.0)).sqrt());
    single.extend([frequency * frequency / fast, fast]);
    Ok(())
}
